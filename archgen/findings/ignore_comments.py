"""Comments that silence findings: `# archgen: ignore[unread-output] why`."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from typing import Protocol

from archgen.conformance.conformance_rules import RULE_NAMES as ROBOT_RULES
from archgen.diagnostics import Diagnostic, Rule, Severity, Span, did_you_mean
from archgen.frozen import fields
from archgen.model.architecture import Architecture


class SilencingComment(Protocol):
    """A comment `# archgen: ignore[rule, other] why`. A protocol: the comments themselves come from the syntax."""

    @property
    def rules(self) -> tuple[str, ...]:
        """The names between the brackets."""

    @property
    def why(self) -> str:
        """What follows the brackets."""

    @property
    def span(self) -> Span:
        """The comment's span."""


LineSet = frozenset[tuple[str, int]]

UNUSED_IGNORE = Rule(
    "unused-ignore",
    Severity.WARNING,
    "A comment says to ignore a finding that is not there.",
)


def apply_ignores(  # noqa: PLR0913 - what the project says of its comments, by name
    diagnostics: Iterable[Diagnostic],
    ignores: Iterable[SilencingComment],
    rules: Mapping[str, Rule],
    first_lines: Mapping[str, LineSet],
    *,
    shared_files: frozenset[str] = frozenset(),
    is_complete: bool = True,
) -> Iterator[Diagnostic]:
    """Leave out what comments silence, and add what is wrong with the comments.

    This runs before findings are settled, so that a comment for a rule that is switched off counts as used. After read
    or link errors, or where rules wait for something (not `is_complete`), nobody knows what else would have been found:
    then no comment is called unused. Nor are those in `shared_files`: another project may need them.
    """
    ignores = tuple(ignores)
    ignores_by_line: dict[tuple[str, str, int], list[SilencingComment]] = defaultdict(list)
    for ignore in ignores:
        for name in ignore.rules:
            ignores_by_line[name, ignore.span.file, ignore.span.line].append(ignore)
    used_ignores: set[tuple[Span, str]] = set()
    has_read_errors = not is_complete
    # One pass: it yields what is left, and notes which comments silenced something.
    for diagnostic in diagnostics:
        rule = rules[diagnostic.rule]
        has_read_errors = has_read_errors or (rule.fixed and (diagnostic.severity or rule.severity) is Severity.ERROR)
        # A comment counts at the line of the finding, and at the first line of its element.
        lines = dict.fromkeys(
            ((diagnostic.span.file, diagnostic.span.line), *first_lines.get(diagnostic.element or "", ()))
        )
        matching_ignores = (
            [matching for file, line in lines for matching in ignores_by_line.get((diagnostic.rule, file, line), ())]
            if not rule.fixed
            else []
        )
        used_ignores.update((ignore.span, diagnostic.rule) for ignore in matching_ignores)
        # A fixed rule is never silenced, and its comment is reported below.
        if not matching_ignores:
            yield diagnostic
    for ignore in ignores:
        if ignore.span.file in shared_files:
            continue
        if not ignore.rules:
            help_text = "name the rule in brackets: `# archgen: ignore[unread-output] why`"
            yield Diagnostic("unused-ignore", "this comment names no rule", ignore.span, help=help_text)
        # Every finding has passed by now: only here is it known which comments were used.
        for name in dict.fromkeys(ignore.rules):
            yield from _check_ignore(
                ignore, name, rules, is_used=has_read_errors or (ignore.span, name) in used_ignores
            )


def _check_ignore(
    ignore: SilencingComment, name: str, rules: Mapping[str, Rule], *, is_used: bool
) -> Iterator[Diagnostic]:
    rule = rules.get(name)
    if rule is None:
        help_text = did_you_mean(name, (candidate.name for candidate in rules.values() if not candidate.fixed))
        yield Diagnostic("unknown-rule", f"there is no rule `{name}` to ignore", ignore.span, help=help_text)
    elif rule.fixed:
        message = f"`{name}` cannot be ignored: what comes after reading and linking rests on it"
        yield Diagnostic("unused-ignore", message, ignore.span, help="mend what it reports, and take the comment out")
    elif not is_used and name not in ROBOT_RULES:
        # Whether a robot has what the comment silences, `archgen conform` alone knows.
        message = f"nothing here is `{name}`"
        help_text = "take it out, or put it at the end of the line that the finding points at"
        yield Diagnostic("unused-ignore", message, ignore.span, help=help_text)


def find_first_lines(architecture: Architecture) -> Mapping[str, LineSet]:
    """Return the lines where each element begins, by the id that findings name; elements of several kinds may share one
    id.
    """
    lines_by_id: dict[str, set[tuple[str, int]]] = defaultdict(set)
    # Every mapping of elements with a place: one that a later kind brings is among them.
    for model_field in fields(architecture):
        elements = getattr(architecture, model_field.name)
        for key, element in elements.items() if isinstance(elements, Mapping) else ():
            if (place := getattr(element, "at", None)) is not None:
                lines_by_id[key].add((place.file, place.line))
    # A type that nobody declared has the lines of its ports: in `image: {type: Image}` its own may be another one.
    typed_ports = [(port.type, port.at) for port in architecture.inputs.values()] + [
        (port.type, port.at) for port in architecture.outputs.values()
    ]
    for name, span in typed_ports:
        if name is not None:
            lines_by_id[name].add((span.file, span.line))
    return {key: frozenset(lines) for key, lines in lines_by_id.items()}
