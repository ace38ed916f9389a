"""What archgen says about a mistake: the diagnostic, its severity, and the rule it belongs to."""

from __future__ import annotations

import enum
import inspect
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from archgen.frozen import dataclass
from archgen.source import Span

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping


class Severity(enum.StrEnum):
    """How much a finding matters. `off` stands only in settings, never on a diagnostic."""

    OFF = "off"
    NOTE = "note"
    WARNING = "warning"
    ERROR = "error"


class Label(NamedTuple):
    """A secondary place that helps to understand a diagnostic."""

    span: Span
    text: str


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding.

    `severity` None means the rule's own; `settle` replaces it. `element` is the id of the element concerned
    (`group.component`, a node's id, a type's name, ...), where there is one.
    """

    rule: str
    message: str
    span: Span
    severity: Severity | None = None
    labels: tuple[Label, ...] = ()
    help: str | None = None
    element: str | None = None

    @property
    def key(self) -> tuple[str, int, int, str, str]:
        """Sort by file, line, column, rule, message."""
        return (self.span.file, self.span.line, self.span.column, self.rule, self.message)


@dataclass(frozen=True, slots=True)
class Rule:
    """A kind of finding: its name, its severity where nobody says otherwise, its page.

    `doc` is Markdown: a summary sentence, then the sections `Why`, `Bad` and `Good` (see CONTRIBUTING.md). `fixed`
    rules (reading and linking) cannot be ignored or switched off: what comes after them rests on them.
    """

    name: str
    severity: Severity
    doc: str
    fixed: bool = False

    @classmethod
    def of(cls, function: Callable[..., object], severity: Severity) -> Rule:
        """Make the rule that a function judges: its name and its docstring are the function's."""
        return cls(function.__name__.replace("_", "-"), severity, inspect.cleandoc(function.__doc__ or ""))


def settle(
    diagnostics: Iterable[Diagnostic], rules: Mapping[str, Rule], settings: Mapping[str, Severity]
) -> tuple[Diagnostic, ...]:
    """Give each diagnostic its severity, drop what is switched off, and sort.

    A rule that chose a severity of its own for one finding keeps it, unless the project sets the rule.
    """
    settled = set[Diagnostic]()
    for diagnostic in diagnostics:
        rule = rules[diagnostic.rule]
        severity = diagnostic.severity or rule.severity
        if not rule.fixed:
            severity = settings.get(diagnostic.rule, severity)
        if severity is not Severity.OFF:
            settled.add(replace(diagnostic, severity=severity))
    return tuple(sorted(settled, key=lambda d: d.key))
