"""Do the selectors of views and policies select something?"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from archgen.diagnostic import Diagnostic, Severity
from archgen.model.selector import Selecting
from archgen.model.selector_words import Problem

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture
    from archgen.source import Span


class Written(NamedTuple):
    """A selector written in the project: its view or policy (as a phrase, and by id), its text and its span."""

    whose: str
    element: str
    text: str
    at: Span


def written_selectors(architecture: Architecture) -> Iterator[Written]:
    """Yield all selectors of views and policies, except empty ones."""
    for view in architecture.views.values():
        if view.show:
            yield Written(f"the view `{view.id}`", view.id, view.show, view.show_at)
    for policy in architecture.policies.values():
        for text, at in ((policy.forbid_from, policy.from_at), (policy.forbid_to, policy.to_at)):
            if text:
                yield Written(f"the policy `{policy.id}`", policy.id, text, at)


def wrong_selector(architecture: Architecture) -> Iterator[Diagnostic]:
    """A selector in a view or policy cannot be read, or names what is not there.

    Why: The view would show nothing, the policy forbid nothing. A path that names nothing is an error; a key (`tag:safety`)
    or a wildcard that nothing fits yet is a warning.

    Bad:
        groups:
          sensing:
            components:
              camera: {outputs: {image: sensor_msgs/msg/Image}}
              screen: {inputs: {image: camera.image}}
        nodes:
          camera: {implements: camera}
          screen: {implements: screen}
        views:
          eyes: {show: "camra+1"}

    Good:
        groups:
          sensing:
            components:
              camera: {outputs: {image: sensor_msgs/msg/Image}}
              screen: {inputs: {image: camera.image}}
        nodes:
          camera: {implements: camera}
          screen: {implements: screen}
        views:
          eyes: {show: "camera+1"}
    """
    # One evaluator for all selectors: its look-ups (paths, graphs) are made once, when first needed.
    selecting = Selecting(architecture)
    for written in written_selectors(architecture):
        for problem in selecting.select(written.text)[1]:
            if problem.severity == "warning" and "finding:" in written.text[problem.start : problem.end]:
                continue  # rules see no findings yet, so `finding:` selects nothing here
            if _is_lost(architecture, written.text[problem.start : problem.end]):
                continue  # it may be declared in what could not be read, which is reported already
            yield Diagnostic(
                "wrong-selector",
                f"in the selector of {written.whose}: {problem.message}",
                _place(written, problem),
                severity=Severity.WARNING if problem.severity == "warning" else None,
                help=problem.help,
                element=written.element,
            )


def empty_view(architecture: Architecture) -> Iterator[Diagnostic]:
    """A view shows nothing, though all that its selector names is there.

    Why: The selector takes away all that it names, or asks for ways between elements that nothing joins. The picture stays
    empty.

    Bad:
        groups:
          sensing:
            components:
              camera: {outputs: {image: sensor_msgs/msg/Image}}
              screen: {inputs: {image: camera.image}}
        nodes:
          camera: {implements: camera}
          screen: {implements: screen}
        views:
          eyes: {show: "screen..camera"}

    Good:
        groups:
          sensing:
            components:
              camera: {outputs: {image: sensor_msgs/msg/Image}}
              screen: {inputs: {image: camera.image}}
        nodes:
          camera: {implements: camera}
          screen: {implements: screen}
        views:
          eyes: {show: "camera..screen"}
    """
    selecting = Selecting(architecture)
    for view in architecture.views.values():
        if not view.show or not architecture.components:
            continue
        selection, problems = selecting.select(view.show)
        if not problems and not selection.components and not selection.nodes:
            yield Diagnostic(
                "empty-view",
                f"the view `{view.id}` shows nothing",
                view.show_at,
                help="see what a selector selects with `archgen list SELECTOR`",
                element=view.id,
            )


def _is_lost(architecture: Architecture, path: str) -> bool:
    """Whether something that a path, key or pattern names may be in what could not be read."""
    # The last two parts of a path are the element's key and its parent's.
    return not architecture.lost.isdisjoint(path.split(".")[-2:]) or (
        architecture.partial and ("*" in path or ":" in path)
    )


def _place(written: Written, problem: Problem) -> Span:
    """Return the span of the part of a selector that a problem is about, else of the whole selector."""
    at = written.at
    # The span includes quotes if there are any: it is longer than the text by 0 or 2 columns. Anything else (escapes,
    # several lines) does not map to columns of the text.
    quotes = at.end_column - at.column - len(written.text)
    if at.line != at.end_line or quotes not in {0, 2}:
        return at
    start = at.column + quotes // 2
    return at._replace(column=start + problem.start, end_column=start + max(problem.end, problem.start + 1))


RULES = (
    (wrong_selector, Severity.ERROR),
    (empty_view, Severity.WARNING),
)
