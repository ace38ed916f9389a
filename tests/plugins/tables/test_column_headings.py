"""What the columns of a table mean."""

from __future__ import annotations

import pytest

from archgen.diagnostics.source_span import NO_SPAN
from archgen.plugins.tables.table_cells import TableCell, TableHeadings, read_headings, read_new_headings


def _row(text: str) -> dict[int, TableCell]:
    return {at: TableCell(word.strip(), NO_SPAN) for at, word in enumerate(text.split(",")) if word.strip()}


def _keys(text: str) -> list[str] | None:
    headings = read_headings(_row(text))
    return list(headings.key_by_column.values()) if headings is not None else None


@pytest.mark.parametrize(
    ("row", "keys"),
    [
        ("Component, Inputs, Outputs", ["component", "input", "output"]),
        ("ComponentName, data_type", ["component", "type"]),
        ("From component, To component, Message", ["from", "to", "message"]),
        ("Name, Purpose", ["component", "functionality"]),
        ("Name, Description", ["component", "functionality"]),
        ("From, To, Description", ["from", "to", "description"]),
        ("ID, Title", ["id", "component"]),
        ("Node, Name, Package", ["node", "title", "package"]),
        ("Component (C++), Rate [Hz]", ["component", "rate"]),
    ],
)
def test_headings_are_known_in_the_spellings_of_teams(row: str, keys: list[str]) -> None:
    assert _keys(row) == keys


@pytest.mark.parametrize("row", ["Component", "Rate, Type", "Camera, input, left, right, 3", ""])
def test_a_row_of_data_is_no_row_of_headings(row: str) -> None:
    assert _keys(row) is None


def test_the_first_of_two_columns_counts_and_the_rest_is_unknown() -> None:
    headings = read_headings(_row("Component, Outputs, Provides, Colour"))
    assert headings is not None
    assert headings.key_by_column == {0: "component", 1: "output"}
    assert [cell.text for cell in headings.unknown_columns.values()] == ["Provides", "Colour"]


def test_units_stand_in_brackets() -> None:
    headings = read_headings(_row("Component, Period (ms), Rate [Hz]"))
    assert headings is not None
    assert headings.unit_by_key == {"period": "ms", "rate": "Hz"}


def test_a_table_of_archgen_list_is_known_by_all_its_columns() -> None:
    headings = read_headings(_row("id,title,owner,components,place"))
    assert headings is not None
    assert (headings.kind, headings.key_by_column) == ("group", {0: "group", 1: "title", 2: "owner"})


@pytest.mark.parametrize(("row", "new"), [("Component, Outputs", True), ("Component, Outputs, Colour", False)])
def test_new_headings_in_the_middle_must_all_be_known(row: str, new: bool) -> None:  # noqa: FBT001
    assert isinstance(read_new_headings(_row(row)), TableHeadings) is new
