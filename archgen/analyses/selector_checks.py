"""Do the selectors of views and policies select something?"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.model.selector_evaluation import SelectorEvaluator
from archgen.model.selector_parser import SelectorProblem

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.diagnostics.source_span import Span
    from archgen.model.architecture import Architecture


class WrittenSelector(NamedTuple):
    """A selector written in the project: its view or policy (as a phrase, and by id), its text and its span."""

    owner_phrase: str
    element: str
    text: str
    span: Span


def list_written_selectors(architecture: Architecture) -> Iterator[WrittenSelector]:
    """Yield all selectors of views and policies, except empty ones."""
    for view in architecture.views.values():
        if view.show:
            yield WrittenSelector(f"the view `{view.id}`", view.id, view.show, view.show_at)
    for policy in architecture.policies.values():
        selectors = [(policy.forbid_from, policy.from_at), (policy.forbid_to, policy.to_at)]
        if policy.require:
            selectors += [
                (policy.require.of, policy.require.of_at),
                (policy.require.inputs_from, policy.require.from_at),
            ]
        for text, span in selectors:
            if text:
                yield WrittenSelector(f"the policy `{policy.id}`", policy.id, text, span)


def wrong_selector(architecture: Architecture) -> Iterator[Diagnostic]:
    """A selector in a view or policy cannot be read, or names what is not there."""
    # One evaluator for all selectors: its look-ups (paths, graphs) are made once, when first needed.
    evaluator = SelectorEvaluator(architecture)
    for written_selector in list_written_selectors(architecture):
        for problem in evaluator.evaluate(written_selector.text)[1]:
            if problem.severity == "warning" and "finding:" in written_selector.text[problem.start : problem.end]:
                continue  # rules see no findings yet, so `finding:` selects nothing here
            if _may_be_unread(architecture, written_selector.text[problem.start : problem.end]):
                continue  # it may be declared in what could not be read, which is reported already
            yield Diagnostic(
                "wrong-selector",
                f"in the selector of {written_selector.owner_phrase}: {problem.message}",
                _problem_span(written_selector, problem),
                severity=Severity.WARNING if problem.severity == "warning" else None,
                help=problem.help,
                element=written_selector.element,
            )


def empty_view(architecture: Architecture) -> Iterator[Diagnostic]:
    """A view shows nothing, though all that its selector names is there."""
    evaluator = SelectorEvaluator(architecture)
    for view in architecture.views.values():
        if not view.show or not architecture.components:
            continue
        selection, problems = evaluator.evaluate(view.show)
        if not problems and not selection.components and not selection.nodes:
            yield Diagnostic(
                "empty-view",
                f"the view `{view.id}` shows nothing",
                view.show_at,
                help="see what a selector selects with `archgen list SELECTOR`",
                element=view.id,
            )


def _may_be_unread(architecture: Architecture, path: str) -> bool:
    """Whether something that a path, key or pattern names may be in what could not be read."""
    # The last two parts of a path are the element's key and its parent's.
    return not architecture.unread_keys.isdisjoint(path.split(".")[-2:]) or (
        architecture.partial and ("*" in path or ":" in path)
    )


def _problem_span(written_selector: WrittenSelector, problem: SelectorProblem) -> Span:
    """Return the span of the part of a selector that a problem is about, else of the whole selector."""
    span = written_selector.span
    # The span includes quotes if there are any: it is longer than the text by 0 or 2 columns. Anything else (escapes,
    # several lines) does not map to columns of the text.
    quote_width = span.end_column - span.column - len(written_selector.text)
    if span.line != span.end_line or quote_width not in {0, 2}:
        return span
    start = span.column + quote_width // 2
    return span._replace(column=start + problem.start, end_column=start + max(problem.end, problem.start + 1))


RULES = (
    (wrong_selector, Severity.ERROR),
    (empty_view, Severity.WARNING),
)
