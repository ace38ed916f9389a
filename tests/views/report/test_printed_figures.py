"""Figures on paper: real signs, three significant digits, one unit in a column."""

from __future__ import annotations

import pytest

from archgen.views.report.printed_figures import print_inlines, print_section_figures, print_text
from archgen.views.shapes import Column, Section, Table, Text, make_columns


@pytest.mark.parametrize(
    ("text", "printed"),
    [
        ("<= 10.004 Hz · >= 99.96 ms", "≤ 10.1\u202fHz · ≥ 99.9\u202fms"),
        (
            "7954.667 ms, 7045.333 ms before the deadline of 15 s",
            "7.96\u202fs, 7.05\u202fs before the deadline of 15\u202fs",
        ),
        ("0.0024 Hz · 416.667 s", "0.0024\u202fHz · 417\u202fs"),
        ("execution 50 us to 200 us", "execution 50\u202fµs to 200\u202fµs"),
        ("120000 ms", "120\u202fs"),
        ("1.511 MB, 99.84 %", "1.51\u202fMB, 99.8\u202f%"),
        ("version 2.1 of 12 seconds, R-40, 10.0.0.1 ms", "version 2.1 of 12 seconds, R-40, 10.0.0.1 ms"),
    ],
)
def test_figures_in_text(text: str, printed: str) -> None:
    assert print_text(text) == printed


def test_a_column_of_times_has_one_unit_in_its_heading() -> None:
    cells = ("15 s", "20 ms", "350 ms", ">= 3000 ms", "unknown")
    table = Table("t", "Times", (Column("Deadline", 1, "right"),), tuple(((Text(cell),),) for cell in cells))
    (printed,) = print_section_figures(Section("s", "S", (table,))).blocks
    assert isinstance(printed, Table)
    assert printed.columns[0].title == "Deadline, ms"
    assert [row[0][0].text for row in printed.rows] == ["15000", "20", "350", "≥ 3000", "unknown"]


@pytest.mark.parametrize(
    ("text", "runs"),
    [
        (
            "`calm` and *wrap*, **not** 2*3*4",
            [("calm", "code"), (" and ", ""), ("wrap", "i"), (", ", ""), ("not", "b"), (" 2*3*4", "")],
        ),
        ("a * b * c", [("a * b * c", "")]),
        ("call_state of `a.b", [("call_state of `a.b", "")]),
    ],
)
def test_markdown_in_cells_is_set(text: str, runs: list[tuple[str, str]]) -> None:
    printed = print_inlines((Text(text),))
    assert [
        (run.text, "code" if run.code else "i" if run.emphasis else "b" if run.strong else "") for run in printed
    ] == runs


def test_code_stays_as_it_is_written() -> None:
    table = Table("t", "Names", (Column("Name"),), (((Text("wait <= 10.004 ms", code=True),),),))
    (printed,) = print_section_figures(Section("s", "S", (table,))).blocks
    assert isinstance(printed, Table)
    assert printed.rows[0][0][0].text == "wait <= 10.004 ms"


def test_times_that_are_nothing_have_the_unit_of_their_column() -> None:
    rows = tuple(((Text(cell),),) for cell in ("0 ms", "20 ms", "0 ms"))
    (printed,) = print_section_figures(
        Section("s", "S", (Table("t", "T", (Column("Link", 1, "right"),), rows),))
    ).blocks
    assert isinstance(printed, Table)
    assert printed.columns[0].title == "Link, ms"
    assert [row[0][0].text for row in printed.rows] == ["0", "20", "0"]


def test_all_times_of_a_table_have_one_unit_and_three_digits() -> None:
    rows = tuple(
        ((Text(wait),), (Text(answer),)) for wait, answer in (("2.05 ms", "0.3 ms"), ("1503.2 ms", "<= 40 ms"))
    )
    table = Table("t", "T", make_columns(("Waits", 1, "right"), ("Responds", 1, "right")), rows)
    printed = print_section_figures(Section("s", "S", (table,))).blocks[0]
    assert isinstance(printed, Table)
    assert [column.title for column in printed.columns] == ["Waits, ms", "Responds, ms"]
    cells = [[cell[0].text for cell in row] for row in printed.rows]
    # As 1.51 s, which a sentence says of it.
    assert cells == [["2.05", "0.3"], ["1510", "≤ 40"]]
