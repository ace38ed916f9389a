"""The end of a long list of findings, and text that keeps to a terminal's width."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.source_span import NO_SPAN, SourceTexts
from archgen.emit.terminal.findings_summary import LONG_LIST, WAITING_SENTENCE, render_rule_table
from archgen.emit.terminal.findings_text import render_findings_text


def _findings(count: int) -> list[Diagnostic]:
    return [
        *(Diagnostic("unread-output", f"{number}", NO_SPAN, Severity.WARNING) for number in range(count - 2)),
        Diagnostic("missing-detail", "m", NO_SPAN, Severity.NOTE),
        Diagnostic("unknown-reference", "m", NO_SPAN, Severity.ERROR),
    ]


def test_more_findings_than_fit_end_with_a_table_by_rule() -> None:
    assert list(render_rule_table(_findings(LONG_LIST))) == []
    lines = list(render_findings_text(_findings(LONG_LIST + 1), SourceTexts(), is_waiting=True))
    assert lines[-9:] == [
        "rule               severity  findings",
        "unknown-reference  error     1",
        "unread-output      warning   19",
        "missing-detail     note      1",
        "",
        "`archgen explain RULE` says what a rule asks for, and why",
        "",
        WAITING_SENTENCE,
        "1 error, 19 warnings, 1 note",
    ]
