"""Tables and lines on a terminal: as wide as it is, with every word; in a pipe one line for each row."""

from __future__ import annotations

import io
from collections import Counter

import pytest

from archgen.diagnostics import text_columns
from archgen.diagnostics.safe_text import measure_width
from archgen.diagnostics.text_columns import align_rows, find_width, format_table, wrap_line

ROWS = [("id", "what"), ("perception.object_recognition", "finds objects on the table")]


def test_without_a_width_each_row_is_one_line() -> None:
    assert list(align_rows(ROWS)) == [
        "  id                             what",
        "  perception.object_recognition  finds objects on the table",
    ]


def test_a_text_goes_on_in_its_column() -> None:
    assert list(align_rows(ROWS, 58)) == [
        "  id                             what",
        "  perception.object_recognition  finds objects on the",
        "                                 table",
    ]


def test_a_text_without_room_goes_below() -> None:
    assert list(align_rows(ROWS, 45)) == [
        "  id                             what",
        "  perception.object_recognition",
        "      finds objects on the table",
    ]


def test_a_row_whose_text_is_empty_stays_alone() -> None:
    assert list(align_rows([("perception.object_recognition", "")], 30)) == ["  perception.object_", "  recognition"]


def test_names_break_after_their_separators() -> None:
    assert list(align_rows([("perception.object_recognition", "7")], 26)) == [
        "  perception.object_",
        "  recognition",
        "      7",
    ]


def test_a_table_that_is_too_wide_becomes_a_list_of_cells() -> None:
    table = [("perception.object_recognition", "Object Recognition of the Table", "sensing.rgbd_camera.rgbd", "")]
    assert list(format_table(("id", "title", "inputs", "remarks"), table, 50)) == [
        "perception.object_recognition",
        "  title:    Object Recognition of the Table",
        "  inputs:   sensing.rgbd_camera.rgbd",
    ]


def test_figures_are_set_flush_right() -> None:
    assert list(format_table(("of", "n", "note"), [("a", "7", "x"), ("b", "12", "")], has_figures=True)) == [
        "of   n  note",
        "a    7  x",
        "b   12",
    ]


def test_wide_characters_count_twice() -> None:
    assert wrap_line("視覚 視覚 視覚", 9) == ["視覚 視覚", "    視覚"]


@pytest.mark.parametrize("width", range(20, 130, 7))
def test_no_line_is_wider_than_the_terminal_and_no_letter_is_lost(width: int) -> None:
    rows = [("a" * 70, "b.c" * 20, "5", "Words of many lengths in a sentence " * 3), ("x", "", "17", "")]
    written = Counter("".join(map("".join, rows)).replace(" ", ""))
    for lines in (
        list(align_rows(rows, width)),
        list(format_table(("first", "second", "third", "fourth"), rows, width)),
        wrap_line("  " + " ".join(map(" ".join, rows)), width),
    ):
        assert max(map(len, lines)) <= width
        assert Counter("".join(lines)) >= written


@pytest.mark.parametrize(
    ("columns", "width"), [("60", 60), ("7", 20), ("", None), ("0", None), ("wide", None), ("-3", None)]
)
def test_columns_says_how_wide_a_pipe_is_taken_to_be(
    columns: str, width: int | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", columns)
    assert find_width(io.StringIO()) == width


def test_a_long_word_is_measured_once_however_wide_the_terminal_is(monkeypatch: pytest.MonkeyPatch) -> None:
    measured: list[int] = []

    def measure(text: str) -> int:
        measured.append(len(text))
        return measure_width(text)

    monkeypatch.setattr(text_columns, "measure_width", measure)
    lines = wrap_line("漢" * 5000 + "." * 5000, 100)
    assert "".join(lines).replace(" ", "") == "漢" * 5000 + "." * 5000
    assert all(measure_width(line) <= 100 for line in lines)
    assert sum(measured) <= 10 * 10_000


def test_a_column_of_a_long_cell_gives_in_at_once() -> None:
    assert text_columns._shrink_columns([10**12, 1], 40) == [39, 1]  # noqa: SLF001 - it must not try each width
