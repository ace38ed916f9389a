"""The end of a long list of findings: how many of each rule and in each file, so that nobody counts them on the screen."""

from __future__ import annotations

from collections import Counter, defaultdict
from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Severity

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from archgen.diagnostics.diagnostic import Diagnostic

LONG_LIST = 8
"""Beyond so many findings, about a screen, tables say how many there are of each rule and in each file."""
_MAX_FILES = 20
WAITING_SENTENCE = "timing, views and unused elements are judged once these errors are gone"
_SEVERITIES = (Severity.ERROR, Severity.WARNING, Severity.NOTE)


def render_summary_tables(findings: Sequence[Diagnostic], width: int | None = None) -> Iterator[str]:
    """Yield the lines of tables of the rules and the files of many findings, the worst first; few yield none."""
    if len(findings) <= LONG_LIST:
        return
    yield from _render_rule_table(findings, width)
    yield ""
    yield from _render_file_table(findings, width)
    yield "`archgen explain RULE` says what a rule asks for, and why"


def _render_rule_table(findings: Sequence[Diagnostic], width: int | None) -> Iterator[str]:
    from archgen.emit.terminal.list_formats import format_columns

    # Rules that a project or a finding gives several severities have a row for each of them.
    counts = Counter((finding.rule, finding.effective_severity) for finding in findings)
    ordered_counts = sorted(counts.items(), key=lambda item: (-item[0][1].rank, -item[1], item[0][0]))
    rows = [(rule, str(severity), str(count)) for (rule, severity), count in ordered_counts]
    yield from format_columns(("rule", "severity", "findings"), rows, width).splitlines()


def _render_file_table(findings: Sequence[Diagnostic], width: int | None) -> Iterator[str]:
    """Yield the lines of the table of files, and a blank one; none where all findings are in one file."""
    from archgen.emit.terminal.list_formats import format_columns

    counts: defaultdict[str, Counter[Severity]] = defaultdict(Counter)
    for finding in findings:
        if finding.span.file:
            counts[finding.span.file][finding.effective_severity] += 1
    if len(counts) < 2:  # noqa: PLR2004 - the excerpts name the only file
        return
    files = sorted(counts, key=lambda file: (*(-counts[file][severity] for severity in _SEVERITIES), file))
    rows = [(file, *(str(counts[file][severity] or "") for severity in _SEVERITIES)) for file in files]
    yield from format_columns(("file", "errors", "warnings", "notes"), rows[:_MAX_FILES], width).splitlines()
    if len(rows) > _MAX_FILES:
        yield f"and {len(rows) - _MAX_FILES} more files"
    yield ""
