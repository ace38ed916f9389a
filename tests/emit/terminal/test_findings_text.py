"""Tests of findings as text: gutters, marks, labels, tabs, wide characters, long lines, hostile text, colour."""

from __future__ import annotations

import io
import re
import unicodedata
from collections.abc import Mapping

import pytest
from hypothesis import given
from hypothesis import strategies as st

from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.diagnostics.source_span import NO_SPAN, SourceTexts, Span
from archgen.emit.terminal.findings_text import format_summary, render_finding_text, render_findings_text, wants_colour


def _sources(**files: str) -> SourceTexts:
    sources = SourceTexts()
    for name, text in files.items():
        sources.add_text(f"{name}.yaml", text)
    return sources


def _shown(diagnostic: Diagnostic, sources: SourceTexts, *, width: int = 120) -> str:
    return "\n".join(render_finding_text(diagnostic, sources, width=width))


def _at(line: int, column: int, end: int, *, file: str = "a.yaml", end_line: int = 0) -> Span:
    return Span(file, line, column, end_line or line, end)


def test_a_finding_shows_its_places_with_aligned_gutters() -> None:
    sources = _sources(a="a:\n  - object_recogniton.objects\n", b="\n" * 11 + "    object_recognition:\n")
    diagnostic = Diagnostic(
        "unknown-reference",
        "no component or output named `object_recogniton.objects`",
        _at(2, 5, 30),
        Severity.ERROR,
        (Label(_at(12, 5, 23, file="b.yaml"), "declared here"),),
        "did you mean `object_recognition.objects`?",
    )
    assert _shown(diagnostic, sources) == (
        "error[unknown-reference]: no component or output named `object_recogniton.objects`\n"
        "  --> a.yaml:2:5\n"
        "    2 |   - object_recogniton.objects\n"
        "      |     ^^^^^^^^^^^^^^^^^^^^^^^^^\n"
        "  --> b.yaml:12:5\n"
        "   12 |     object_recognition:\n"
        "      |     ------------------ declared here\n"
        "   = help: did you mean `object_recognition.objects`?"
    )


def test_a_label_on_the_same_line_stands_below_the_same_quote() -> None:
    sources = _sources(a="left: 1, right: 2\n")
    diagnostic = Diagnostic("r", "m", _at(1, 10, 15), Severity.WARNING, (Label(_at(1, 1, 5), "first"),))
    assert _shown(diagnostic, sources) == (
        "warning[r]: m\n  --> a.yaml:1:10\n   1 | left: 1, right: 2\n     |          ^^^^^\n     | ---- first"
    )


def test_tabs_wide_and_combining_characters_keep_marks_in_place() -> None:
    sources = _sources(a="\tx: 日本 e\u0301 wrong\n")
    diagnostic = Diagnostic("r", "m", _at(1, 11, 16), Severity.NOTE)
    line, marks = _shown(diagnostic, sources).splitlines()[2:]
    assert line == "   1 |     x: 日本 e\u0301 wrong"
    assert marks == "     |" + " " * 15 + "^^^^^"


@pytest.mark.parametrize(
    ("span", "line", "marks"),
    [
        (_at(1, 1, 5), "key: xxxxxxxxxxxxxxxxxxxxxxx…", "^^^^"),
        (_at(1, 206, 210), "…xxxxxxxxxxx HERE yyyyyyyyyyy…", "             ^^^^"),
        (_at(1, 411, 414), "…yyyyyyyyyyyyyyyyyyyyyyyyyend", "                          ^^^"),
        (_at(1, 6, 400), "key: xxxxxxxxxxxxxxxxxxxxxxx…", "     ^^^^^^^^^^^^^^^^^^^^^^^"),
    ],
)
def test_long_lines_are_cut_round_the_mark(span: Span, line: str, marks: str) -> None:
    text = "key: " + "x" * 199 + " HERE " + "y" * 200 + "end"
    shown = _shown(Diagnostic("r", "m", span, Severity.NOTE), _sources(a=text), width=37).splitlines()[2:]
    assert shown == [f"   1 | {line}", f"     | {marks}"]
    assert all(len(text) <= 37 for text in shown)


def test_a_line_of_a_million_characters_is_quick_and_short() -> None:
    sources = _sources(a="x" * 1_000_000 + "!" + "y" * 1_000_000)
    shown = _shown(Diagnostic("r", "m", _at(1, 1_000_001, 1_000_002), Severity.NOTE), sources)
    assert "x!y" in shown
    assert max(map(len, shown.splitlines())) <= 120


def test_a_span_over_several_lines_is_marked_to_the_end_of_its_first() -> None:
    diagnostic = Diagnostic("r", "m", _at(1, 4, 3, end_line=2), Severity.NOTE)
    assert _shown(diagnostic, _sources(a="a: [1,\n 2]\n")).splitlines()[2:] == ["   1 | a: [1,", "     |    ^^^"]


def test_places_without_text_are_named_but_not_quoted() -> None:
    sources = _sources(a="one\n")
    assert _shown(Diagnostic("r", "m", Span.of_file("a.yaml"), Severity.NOTE), sources) == "note[r]: m\n  --> a.yaml"
    assert _shown(Diagnostic("r", "m", _at(7, 1, 2), Severity.NOTE), sources) == "note[r]: m\n  --> a.yaml:7:1"
    assert _shown(Diagnostic("r", "m", NO_SPAN, Severity.NOTE), sources) == "note[r]: m"


def test_nothing_in_a_file_reaches_the_terminal_as_a_command() -> None:
    sources = _sources(a="a: \x1b[31m\u202ered\x07 \x9b2J\n")
    diagnostic = Diagnostic("r", "m\n\x1b]0;x\x07", _at(1, 1, 2), Severity.NOTE, help="\r\u2028x\x7f")
    shown = _shown(diagnostic, sources)
    assert shown == (
        "note[r]: m␊␛]0;x␇\n  --> a.yaml:1:1\n   1 | a: ␛[31m\ufffdred␇ \ufffd2J\n     | ^\n   = help: ␍\ufffdx␡"
    )


def test_findings_end_with_a_summary() -> None:
    findings = [Diagnostic("r", "m", NO_SPAN, severity) for severity in (Severity.ERROR, Severity.NOTE, Severity.NOTE)]
    assert list(render_findings_text(findings, SourceTexts()))[-2:] == ["", "1 error, 2 notes"]
    assert format_summary([]) == "no findings"


def test_colour_changes_nothing_but_colour() -> None:
    sources = _sources(a="left: 1\n")
    diagnostic = Diagnostic("r", "m", _at(1, 1, 5), Severity.ERROR, (Label(_at(1, 7, 8), "here"),), "do")
    plain = list(render_findings_text([diagnostic], sources))
    coloured = list(render_findings_text([diagnostic], sources, colour=True))
    assert coloured[0] == "\x1b[1;31merror[r]\x1b[0m: \x1b[1mm\x1b[0m"
    assert [re.sub("\x1b\\[[0-9;]*m", "", line) for line in coloured] == plain


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize(
    ("stream", "environment", "colour"),
    [
        (_Terminal(), {}, True),
        (_Terminal(), {"NO_COLOR": "1"}, False),
        (_Terminal(), {"NO_COLOR": ""}, True),
        (_Terminal(), {"TERM": "dumb"}, False),
        (_Terminal(), {"FORCE_COLOR": ""}, True),
        (io.StringIO(), {}, False),
        (io.StringIO(), {"FORCE_COLOR": "0"}, False),
        (io.StringIO(), {"FORCE_COLOR": "1"}, True),
        (io.StringIO(), {"FORCE_COLOR": "1", "NO_COLOR": "1"}, False),
    ],
)
def test_who_wants_colour(stream: io.StringIO, environment: Mapping[str, str], colour: bool) -> None:  # noqa: FBT001
    assert wants_colour(stream, environment) is colour


@given(
    text=st.text(max_size=300),
    spans=st.lists(st.tuples(*[st.integers(1, 400)] * 4), min_size=1, max_size=4),
    width=st.integers(1, 200),
)
def test_any_text_with_any_spans_prints(text: str, spans: list[tuple[int, int, int, int]], width: int) -> None:
    places = [Span("a.yaml", min(line % 4 + 1, end), column, end, last) for line, column, end, last in spans]
    diagnostic = Diagnostic(
        "r", text, places[0], Severity.NOTE, tuple(Label(place, text) for place in places[1:]), text
    )
    for line in render_findings_text([diagnostic], _sources(a=text), width=width):
        joined = line.replace("\u200c", "").replace("\u200d", "")
        assert {unicodedata.category(c) for c in joined}.isdisjoint({"Cc", "Cf", "Cs", "Zl", "Zp"})
