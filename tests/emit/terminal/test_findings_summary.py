"""The end of a long list of findings, and text that keeps to a terminal's width."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.source_span import NO_SPAN, SourceTexts, Span
from archgen.emit.terminal.findings_text import LONG_LIST, WAITING_SENTENCE, render_findings_text, render_summary_tables


def _findings(count: int) -> list[Diagnostic]:
    return [
        *(Diagnostic("unread-output", f"{number}", NO_SPAN, Severity.WARNING) for number in range(count - 2)),
        Diagnostic("missing-detail", "m", NO_SPAN, Severity.NOTE),
        Diagnostic("unknown-reference", "m", NO_SPAN, Severity.ERROR),
    ]


def test_more_findings_than_fit_end_with_a_table_by_rule() -> None:
    assert list(render_summary_tables(_findings(LONG_LIST))) == []
    lines = list(render_findings_text(_findings(LONG_LIST + 1), SourceTexts(), is_waiting=True))
    assert lines[-9:] == [
        "rule               severity  findings",
        "unknown-reference  error     1",
        "unread-output      warning   7",
        "missing-detail     note      1",
        "",
        "`archgen explain RULE` says what a rule asks for, and why",
        "",
        WAITING_SENTENCE,
        "1 error, 7 warnings, 1 note",
    ]


def test_files_follow_the_rules_the_worst_first() -> None:
    found = [
        Diagnostic("unread-output", str(line), Span("a.yaml", line, 1, line, 2), Severity.WARNING)
        for line in range(1, 7)
    ]
    found += [Diagnostic("missing-detail", "m", Span("c.yaml", 1, 1, 1, 2), Severity.NOTE) for _ in range(2)]
    found.append(Diagnostic("unknown-reference", "m", Span("b.yaml", 1, 1, 1, 2), Severity.ERROR))
    lines = list(render_summary_tables(found))
    assert [line.split() for line in lines[lines.index("") + 1 : -2]] == [
        ["file", "errors", "warnings", "notes"],
        ["b.yaml", "1"],
        ["a.yaml", "6"],
        ["c.yaml", "2"],
    ]
