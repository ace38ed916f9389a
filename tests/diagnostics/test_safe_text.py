"""What may move a terminal's cursor, hide or reorder text, or command a workflow, before it is printed."""

from __future__ import annotations

import json

import pytest

from archgen.diagnostics.text_columns import defuse_command, format_json, make_visible, measure_width


@pytest.mark.parametrize(
    ("text", "visible"),
    [
        ("plain", "plain"),
        ("größer 機械", "größer 機械"),
        ("a\x1b[2Jb", "a␛[2Jb"),
        ("a\tb\nc", "a␉b␊c"),
        ("\x7f", "␡"),
        ("\x9b2J", "\ufffd2J"),
        ("exe\u202egpj", "exe\ufffdgpj"),
        ("a\u2028b", "a\ufffdb"),
        ("\ud800", "\ufffd"),
        ("क्\u200dष", "क्\u200dष"),
    ],
)
def test_what_does_not_print_is_replaced_and_scripts_keep_their_joiners(text: str, visible: str) -> None:
    assert make_visible(text) == visible


@pytest.mark.parametrize(
    ("line", "printed"),
    [("::error::x", "\\::error::x"), ("  ::set", "  \\::set"), ("a ::error", "a ::error"), (":x", ":x"), ("", "")],
)
def test_no_line_begins_as_a_workflow_command(line: str, printed: str) -> None:
    assert defuse_command(line) == printed


@pytest.mark.parametrize("text", ["a", "größer", "\x1b[2J", "\x7f", "\u202e", "\x9b", "a\u200db", '"quoted"\n'])
def test_json_prints_nothing_odd_and_reads_back_the_same(text: str) -> None:
    printed = format_json({"text": text})
    assert json.loads(printed) == {"text": text}
    assert [line for line in printed.splitlines() if make_visible(line) != line] == []


def test_json_leaves_letters_as_they_are() -> None:
    assert format_json("ö") == '"ö"\n'


@pytest.mark.parametrize(
    ("text", "columns"), [("abc", 3), ("機械", 4), ("e\u0301", 1), ("a\u200db", 2), ("\uff21", 2), ("", 0)]
)
def test_wide_characters_take_two_columns_and_combining_ones_none(text: str, columns: int) -> None:
    assert measure_width(text) == columns
