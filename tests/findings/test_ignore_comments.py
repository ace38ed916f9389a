"""Tests of ignore comments, and of settings that name no rule."""

from __future__ import annotations

from typing import NamedTuple

from archgen.diagnostics.diagnostic import Diagnostic, Rule, Severity
from archgen.diagnostics.source_span import Span
from archgen.findings.ignore_comments import LineSet, apply_ignores
from archgen.findings.rule_table import check_rule_settings, index_rules

_RULES = index_rules(
    [
        Rule("unread-output", Severity.WARNING, ""),
        Rule("unfed-input", Severity.WARNING, ""),
        Rule("unknown-reference", Severity.ERROR, "", fixed=True),
        Rule("unused-ignore", Severity.WARNING, ""),
        Rule("unknown-rule", Severity.WARNING, ""),
    ]
)


class _Ignore(NamedTuple):
    rules: tuple[str, ...]
    why: str
    span: Span


def _line(number: int) -> Span:
    return Span("a.yaml", number, 1, number, 9)


def _ignore(line: int, *rules: str) -> _Ignore:
    return _Ignore(rules, "", Span("a.yaml", line, 20, line, 40))


def _left(diagnostics: list[Diagnostic], *ignores: _Ignore, first: dict[str, LineSet] | None = None) -> list[str]:
    found = apply_ignores(diagnostics, ignores, _RULES, first or {})
    return [f"{d.span.line} {d.rule}: {d.message}{f' ({d.help})' if d.help else ''}" for d in found]


def test_a_comment_silences_its_line_only() -> None:
    findings = [Diagnostic("unread-output", "here", _line(3)), Diagnostic("unread-output", "there", _line(4))]
    assert _left(findings, _ignore(3, "unread-output")) == ["4 unread-output: there"]


def test_a_comment_on_the_elements_first_line_silences_what_stands_below() -> None:
    findings = [Diagnostic("unread-output", "m", _line(9), element="g.c"), Diagnostic("unfed-input", "m", _line(9))]
    first: dict[str, LineSet] = {"g.c": frozenset({("a.yaml", 5)})}
    assert _left(findings, _ignore(5, "unread-output"), first=first) == ["9 unfed-input: m"]


def test_a_comment_that_silences_nothing_is_a_finding_for_each_name() -> None:
    findings = [Diagnostic("unread-output", "m", _line(3))]
    assert _left(findings, _ignore(3, "unread-output", "unfed-input"), _ignore(7, "unread-output")) == [
        (
            "3 unused-ignore: nothing here is `unfed-input`"
            " (take it out, or put it at the end of the line that the finding points at)"
        ),
        (
            "7 unused-ignore: nothing here is `unread-output`"
            " (take it out, or put it at the end of the line that the finding points at)"
        ),
    ]


def test_reading_and_linking_cannot_be_ignored() -> None:
    findings = [Diagnostic("unknown-reference", "m", _line(3))]
    assert _left(findings, _ignore(3, "unknown-reference")) == [
        "3 unknown-reference: m",
        (
            "3 unused-ignore: `unknown-reference` cannot be ignored: what comes after reading and linking rests on it"
            " (mend what it reports, and take the comment out)"
        ),
    ]


def test_after_errors_in_reading_no_comment_is_called_unused() -> None:
    findings = [Diagnostic("unknown-reference", "m", _line(3))]
    assert _left(findings, _ignore(7, "unread-output")) == ["3 unknown-reference: m"]


def test_a_name_that_is_no_rule_is_guessed() -> None:
    assert _left([], _ignore(3, "unread-outputs")) == [
        "3 unknown-rule: there is no rule `unread-outputs` to ignore (did you mean `unread-output`?)"
    ]


def test_settings_name_rules_that_can_be_set() -> None:
    settings = [("unread-output", _line(1)), ("unfed-inputs", _line(2)), ("unknown-reference", _line(3))]
    assert [f"{d.span.line} {d.message} ({d.help})" for d in check_rule_settings(settings, _RULES)] == [
        "2 there is no rule `unfed-inputs` (did you mean `unfed-input`?)",
        "3 `unknown-reference` is always an error: what comes after reading and linking rests on it (take this line out)",
    ]


def test_a_comment_without_a_rule_says_how_it_is_written() -> None:
    assert _left([], _ignore(3)) == [
        (
            "3 unused-ignore: this comment names no rule"
            " (name the rule in brackets: `# archgen: ignore[unread-output] why`)"
        )
    ]
