"""A baseline: which findings it knows, which of its entries are cured, and how it is written."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from archgen.diagnostics.finding_identity import identify_finding
from archgen.syntax import yaml_writer

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from archgen.diagnostics.diagnostic import Diagnostic, Rule
    from archgen.diagnostics.finding_identity import BaselineEntry

_FILE_HEADER = """\
# Findings that this project knows of: `archgen check --baseline` keeps them quiet, and only new ones count.
# Written by `archgen check --update-baseline`, which also settles conflicts in it: it writes the file anew.
"""


def divide_by_baseline(
    findings: Iterable[Diagnostic], baseline_entries: Iterable[BaselineEntry], rules: Mapping[str, Rule]
) -> tuple[tuple[Diagnostic, ...], tuple[Diagnostic, ...], tuple[BaselineEntry, ...]]:
    """Return the findings that are new, those that are known, and the entries that are cured, with how many of each.

    Read and link errors are always new: nobody knows what is behind them.
    """
    baseline_entries = tuple(baseline_entries)
    remaining = Counter[object]()
    for entry in baseline_entries:
        remaining[entry.identity] += entry.occurrences
    new_findings, known_findings = [], []
    for finding in findings:
        # Identity leaves out lines and parts of the message (docs/decisions/0005-known-findings.md).
        finding_identity = identify_finding(finding)
        # Counted, not just looked up: a second finding alike is new.
        if remaining[finding_identity] > 0 and not rules[finding.rule].fixed:
            remaining[finding_identity] -= 1
            known_findings.append(finding)
        else:
            new_findings.append(finding)
    cured_entries = []
    for entry in reversed(baseline_entries):  # of several alike the last ones go
        cured_count = min(entry.occurrences, remaining[entry.identity])
        remaining[entry.identity] -= cured_count
        if cured_count:
            cured_entries.append(entry._replace(occurrences=cured_count))
    return tuple(new_findings), tuple(known_findings), tuple(reversed(cured_entries))


def format_baseline(findings: Iterable[Diagnostic], rules: Mapping[str, Rule]) -> str:
    """Return the text of a baseline that knows these findings, sorted, without those that no baseline may know."""
    # Sorted by content and not by place: moving lines does not change the file.
    counts = Counter(
        (finding.rule, finding.element or "", finding.message) for finding in findings if not rules[finding.rule].fixed
    )
    if not counts:
        return f"{_FILE_HEADER}archgen_baseline: 1\nfindings: []\n"
    lines = (line for entry_key, count in sorted(counts.items()) for line in _entry_lines(*entry_key, count))
    return "\n".join((f"{_FILE_HEADER}archgen_baseline: 1\nfindings:", *lines, ""))


def _entry_lines(rule: str, element: str, message: str, count: int) -> Iterator[str]:
    """Yield the lines of one entry; empty keys are left out, so that a diff shows what matters."""
    yield f"  - rule: {yaml_writer.format_scalar(rule)}"
    if element:
        yield f"    element: {yaml_writer.format_scalar(element)}"
    yield f"    message: {yaml_writer.format_scalar(message)}"
    if count > 1:
        yield f"    count: {count}"
