"""Diagnostics, their severities, and the rules that they belong to."""

from __future__ import annotations

import enum
import inspect
from collections import Counter
from typing import TYPE_CHECKING

from archgen.diagnostics.natural_order import NaturalOrder, order_naturally
from archgen.diagnostics.source_span import Span
from archgen.frozen import NamedTuple, dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from archgen.diagnostics.rule_options import RuleOption


class Severity(enum.StrEnum):
    """How serious a finding is. `off` occurs only in settings, never on a diagnostic."""

    # From the least to the most serious: severities compare by this order, and not as the texts that they are.
    OFF = "off"
    NOTE = "note"
    WARNING = "warning"
    ERROR = "error"

    @property
    def rank(self) -> int:
        """The place in the order of severities: the more serious, the greater."""
        return _SEVERITY_RANKS[self]

    # All four, since a text has all four: one that is left out would compare letters.
    def __lt__(self, other: str) -> bool:
        return self.rank < other.rank if isinstance(other, Severity) else NotImplemented

    def __le__(self, other: str) -> bool:
        return self.rank <= other.rank if isinstance(other, Severity) else NotImplemented

    def __gt__(self, other: str) -> bool:
        return self.rank > other.rank if isinstance(other, Severity) else NotImplemented

    def __ge__(self, other: str) -> bool:
        return self.rank >= other.rank if isinstance(other, Severity) else NotImplemented


_SEVERITY_RANKS = {severity: rank for rank, severity in enumerate(Severity)}


class Label(NamedTuple):
    """A secondary span that helps to understand a diagnostic."""

    span: Span
    text: str


class AskedName(NamedTuple):
    """What a name that means nothing should have named: somebody may have written the title of such an element."""

    kind: str
    """`partner`, `host`, `container`; `part` for what a dotted path can name."""
    is_list: bool = False
    """Whether the text may be several names: then only a whole title is a better guess."""


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """A finding.

    `severity` None means the rule's default, which `settle_diagnostics` fills in. `element` is the id of the element
    that the finding is about (`group.component`, a node's id, a type's name, ...), if any.
    """

    rule: str
    message: str
    span: Span
    severity: Severity | None = None
    labels: tuple[Label, ...] = ()
    help: str | None = None
    element: str | None = None
    asked_name: AskedName | None = None
    variants: tuple[str, ...] = ()
    """The variants in which it holds, `base` for the project itself; empty where it holds in all that were judged."""
    absent_variants: tuple[str, ...] = ()
    """The variants in which it does not hold, where it holds in some."""

    @property
    def effective_severity(self) -> Severity:
        """The severity; one that is not settled counts as an error, so that it does not vanish."""
        return self.severity or Severity.ERROR

    @property
    def sort_key(self) -> tuple[NaturalOrder, int, int, str, str]:
        """The sort key: file, line, column, rule, message."""
        return (order_naturally(self.span.file), self.span.line, self.span.column, self.rule, self.message)


@dataclass(frozen=True, slots=True)
class Rule:
    """A kind of finding: its name, its default severity, what it finds.

    `doc` is one sentence: the page of a rule is docs/rules/NAME.md, which is read where it is shown. A rule of another
    package has no page there, and may have all of it in `doc`: the sentence, then `Why:`, `Bad:` and `Good:`. `fixed`
    rules (reading and linking) cannot be ignored or switched off: all later stages rely on them.
    """

    name: str
    severity: Severity
    doc: str
    fixed: bool = False
    options: tuple[RuleOption, ...] = ()
    setting: str = ""
    """The line of archgen.yaml that sets the severity, where no comment can, or where it is no entry below `rules`."""
    origin: str = ""
    """The package that brings it, with its version, where it does not ship."""

    @classmethod
    def from_function(
        cls, function: Callable[..., object], severity: Severity, options: tuple[RuleOption, ...] = ()
    ) -> Rule:
        """Make a rule from the function that implements it: `doc` is the function's docstring."""
        doc = inspect.cleandoc(function.__doc__ or "")
        return cls(function.__name__.replace("_", "-"), severity, doc, options=options)


def read_rules(table: str) -> tuple[Rule, ...]:
    """Read rules from lines `SEVERITY NAME: SENTENCE`; `fixed` in the place of the severity is an error that is a fixed rule."""
    rules = []
    for line in table.split("\n"):
        if line and not line.startswith("#"):
            head, _, doc = line.partition(": ")
            severity, _, name = head.partition(" ")
            is_fixed = severity == "fixed"
            rules.append(Rule(name, Severity.ERROR if is_fixed else Severity(severity), doc, fixed=is_fixed))
    return tuple(rules)


_NEW_RULE_NAMES = {"unactivated-node": "silent-node"}
"""What rules are called by now that had another name: settings, comments and baselines may still have that."""


def name_rule(written_name: str) -> str:
    """Return what a rule is called that is written under this name, or under the one that it once had."""
    return _NEW_RULE_NAMES.get(written_name, written_name)


def diagnose_repetition(  # noqa: PLR0913 - what a diagnostic has
    rule: str, message: str, span: Span, first_span: Span, *, help_line: str | None = None, element: str | None = None
) -> Diagnostic:
    """Report what is written a second time; a label shows the first place."""
    labels = (Label(first_span, "first written here"),)
    return Diagnostic(rule, message, span, labels=labels, help=help_line, element=element)


def settle_diagnostics(
    diagnostics: Iterable[Diagnostic], rules: Mapping[str, Rule], settings: Mapping[str, Severity]
) -> tuple[Diagnostic, ...]:
    """Return the diagnostics with their effective severities, without duplicates and those switched off, sorted.

    The severity is the project's setting for the rule (ignored for fixed rules), else the diagnostic's own, else the
    rule's default.
    """
    # A mapping, since a set would give those that sort alike in the order of their hashes.
    settled_diagnostics: dict[Diagnostic, None] = {}
    for diagnostic in diagnostics:
        rule = rules[diagnostic.rule]
        severity = diagnostic.severity or rule.severity
        if not rule.fixed:
            severity = settings.get(diagnostic.rule, severity)
        if severity is not Severity.OFF:
            settled_diagnostics[replace(diagnostic, severity=severity)] = None
    return tuple(sorted(settled_diagnostics, key=lambda d: d.sort_key))


def count_by_severity(diagnostics: Iterable[Diagnostic]) -> Mapping[Severity, int]:
    """Count diagnostics by severity; all three are there, errors first."""
    counts = Counter(diagnostic.effective_severity for diagnostic in diagnostics)
    return {severity: counts[severity] for severity in (Severity.ERROR, Severity.WARNING, Severity.NOTE)}


def phrase_severity_counts(diagnostics: Iterable[Diagnostic]) -> list[str]:
    """Count diagnostics by severity in words, errors first: `1 error`, `2 warnings`; severities without any are left
    out.
    """
    return [
        f"{count} {severity}{'s' * (count != 1)}" for severity, count in count_by_severity(diagnostics).items() if count
    ]


def sort_gravest_first(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return diagnostics with the gravest first; those of one severity keep their order."""
    return sorted(diagnostics, key=lambda diagnostic: diagnostic.effective_severity, reverse=True)
