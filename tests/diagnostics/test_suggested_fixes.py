"""The edits that follow from the words of a help."""

from __future__ import annotations

import pytest

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import SourceTexts, Span
from archgen.diagnostics.suggested_fixes import TextEdit, apply_edits, suggest_fix


def fix_line(line: str, marked: str, message: str, help_line: str) -> tuple[str, bool] | None:
    """Do what a help about a part of a line says; return the line, and whether it is certain."""
    sources = SourceTexts()
    sources.add_text("a.yaml", line)
    start = line.index(marked) + 1
    span = Span("a.yaml", 1, start, 1, start + len(marked))
    fix = suggest_fix(Diagnostic("unknown-key", message, span, help=help_line), sources)
    return (apply_edits(line, fix.edits), fix.is_certain) if fix else None


@pytest.mark.parametrize(
    ("line", "marked", "message", "help_line", "fixed"),
    [
        ("a: {Titel: x}", "Titel", "a component has no key `Titel`", "did you mean `title`?", ("a: {title: x}", False)),
        ("Title: x", "Title", "no key `Title`", "did you mean `title`?", ("title: x", True)),
        ("host: 'pc-1'", "'pc-1'", "no host named `pc-1`", "did you mean `pc_1`?", ("host: 'pc_1'", True)),
        (
            "rate: 5 hz  # as measured",
            "5 hz",
            "no unit `hz`",
            "write `5 Hz`; case counts",
            ("rate: 5 Hz  # as measured", True),
        ),
        ("rate: 20 ms", "20 ms", "`rate` has no unit `ms`", "write `period: 20 ms`", ("period: 20 ms", False)),
        ("nodes: 1", "nodes", "elements of `hosts`", "write `hosts:` instead of `nodes:`", ("hosts: 1", False)),
        ("a: @b", "@", "text cannot begin with `@`", 'put the text in quotes: "..."', ('a: "@b"', True)),
        ("a: [1, 2", "[", "this `[` is not closed", "write `]` at its end", ("a: [1, 2]", False)),
        (
            "backends: [ros2_launch, 'xmi'] # both",
            "backends",
            "`backends` is a list",
            "`backends` is keyed by id: write `{ros2_launch: {}, xmi: {}}` instead of a list",
            ("backends: {ros2_launch: {}, xmi: {}} # both", False),
        ),
        (
            "backends: [a, b]",
            "backends",
            "`backends` is a list",
            "`backends` is keyed by id: write `{a: {}, c: {}}` instead of a list",
            None,
        ),
        ("  - a: b", "a", "an entry is a mapping", "take the `- ` away: `outputs` is keyed by id", ("  a: b", False)),
        # What leaves something to people, or is about something else than its place says.
        ("wcet: 20", "20", "`20` has no unit", "write `20 s` or `20 ms`, whichever is meant; a duration ...", None),
        ("a: {b: @c}", "@", "text cannot begin with `@`", 'put the text in quotes: "..."', None),
        ("a: b", "a", "nothing is called `c`", "did you mean `d`?", None),
        ("rate: 5", "rate", "a component has no key `rate`", "write it as `nodes: {NODE: {rate: ...}}`", None),
        ("a: b", "a", "keep one", "keep one of them", None),
    ],
)
def test_edits_of_one_line(
    line: str, marked: str, message: str, help_line: str, fixed: tuple[str, bool] | None
) -> None:
    assert fix_line(line, marked, message, help_line) == fixed


def test_edits_keep_line_ends_and_do_not_disturb_each_other() -> None:
    spans = (Span("f", 1, 1, 1, 2), Span("f", 2, 3, 2, 4), Span("f", 2, 1, 2, 2), Span("f", 3, 2, 3, 2))
    assert apply_edits("abc\r\ndef\rghi", [TextEdit(span, "XX") for span in spans]) == "XXbc\r\nXXeXX\rgXXhi"


def test_a_finding_without_a_place_has_no_fix() -> None:
    assert suggest_fix(Diagnostic("a", "b", Span("gone", 1, 1, 1, 2), help="did you mean `c`?"), SourceTexts()) is None
