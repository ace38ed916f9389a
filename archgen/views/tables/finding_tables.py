"""Tables of findings, their states as chips, and how many there are in words."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping

from archgen.diagnostics import Diagnostic, Severity, join_words, phrase_severity_counts
from archgen.views import element_references, inline_text
from archgen.views.lookup import Lookup
from archgen.views.shapes import Inlines, Status, Table, Text, make_columns

_SEVERITY_STATES: Mapping[Severity, Status] = {
    Severity.ERROR: "error",
    Severity.WARNING: "warning",
    Severity.NOTE: "note",
    Severity.OFF: "note",
}


def make_finding_table(
    lookup: Lookup, findings: Iterable[Diagnostic], anchor: str = "table:open_points"
) -> Table | None:
    """List findings with their help, who owns what they are about, their place and their rule; errors first."""
    rows = tuple(
        (
            severity_chip(finding),
            inline_text.join_lines(_finding_lines(lookup, finding)),
            element_references.answering_cell(lookup, finding.element, finding.span),
            element_references.place_cell(lookup, finding),
            inline_text.to_inlines(Text(finding.rule, ref=f"rule:{finding.rule}")),
        )
        for finding in sorted(findings, key=lambda each: -each.effective_severity.rank)
    )
    columns = make_columns(("Severity", 0.6), ("Finding", 3), ("Owner", 0.8), ("Place", 1.3), ("Rule", 1))
    return Table(anchor, "Open points", columns, rows) if rows else None


_MANY_FINDINGS = 40
"""Of more findings a table says first who has which."""


def make_owner_table(lookup: Lookup, findings: Iterable[Diagnostic]) -> Table | None:
    """Count many findings by who must act and by rule, those with most first; None for a few."""
    by_owner: dict[str, tuple[Inlines, Counter[str]]] = {}
    for finding in findings:
        who = element_references.answering_cell(lookup, finding.element, finding.span)
        # Whoever cannot be named is told by a question, which each finding asks for itself.
        names = tuple(run.text for run in who if run.ref)
        cell = who if names else (Text("nobody yet"),)
        by_owner.setdefault("".join(names), (cell, Counter()))[1][finding.rule] += 1
    if sum(counts.total() for _, counts in by_owner.values()) <= _MANY_FINDINGS:
        return None
    rows = tuple(
        (
            cell,
            (Text(str(counts.total()), sort_number=str(counts.total())),),
            inline_text.join_inlines(
                (Text(rule, ref=f"rule:{rule}"), Text(f" {count}", muted=True)) for rule, count in counts.most_common()
            ),
        )
        for cell, counts in sorted(by_owner.values(), key=lambda each: -each[1].total())
    )
    columns = make_columns(("Owner", 1), ("Points", 0.5, "right"), ("Of which rules", 4))
    return Table("table:points_by_owner", "By who must act", columns, rows)


_RULE_STATES: Mapping[str, tuple[str, Status]] = {
    "uncovered-requirement": ("uncovered", "uncovered"),
    "unjustified-component": ("unjustified", "uncovered"),
    "unjustified-node": ("unjustified", "uncovered"),
    "unread-output": ("unread", "warning"),
}
"""Rules whose findings are states of their own; the others show how serious they are."""


def finding_chip(finding: Diagnostic) -> Inlines:
    """Return the state that a finding tells as a chip: the rule's own word, else its severity."""
    severity = finding.effective_severity
    if severity is Severity.WARNING and finding.rule in _RULE_STATES:
        word, status = _RULE_STATES[finding.rule]
        return (Text(word, status=status),)
    return severity_chip(finding)


def severity_chip(finding: Diagnostic) -> Inlines:
    """Return how serious a finding is, as a chip."""
    severity = finding.effective_severity
    return (Text(severity, strong=severity is Severity.ERROR, status=_SEVERITY_STATES[severity]),)


def _finding_lines(lookup: Lookup, finding: Diagnostic) -> list[Inlines]:
    """Return the message of a finding and, muted, its help."""
    lines = (
        element_references.link_message(lookup.architecture, finding),
        element_references.link_help(lookup.architecture, finding),
    )
    return [line for line in lines if line]


def describe_severities(findings: Iterable[Diagnostic]) -> str:
    """Count findings in words: `1 error, 2 warnings and 3 notes`, or `nothing`."""
    return join_words(phrase_severity_counts(findings)) or "nothing"
