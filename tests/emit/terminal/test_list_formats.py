"""Lists as columns, CSV and JSON."""

from __future__ import annotations

import json

import pytest

from archgen.emit.terminal.list_formats import format_columns, format_csv, format_json_rows


def test_columns_are_aligned_and_nothing_stands_behind_the_last() -> None:
    assert format_columns(["id", "title"], [["camera", "C"], ["arm", ""]]) == "id      title\ncamera  C\narm\n"


def test_cells_of_several_lines_stay_on_one_and_control_nothing() -> None:
    assert format_columns(["a"], [["x\ny"], ["\x1b[2J"], ["::error::"]]) == "a\nx; y\n␛[2J\n\\::error::\n"


@pytest.mark.parametrize(
    ("cell", "written"),
    [
        ("plain", "plain"),
        ("a,b", '"a,b"'),
        ('say "x"', '"say ""x"""'),
        ("=1+1", "'=1+1"),
        (" @x", "' @x"),
        ("-3", "'-3"),
        ("a\n=b", '"a\n=b"'),
        ("\tx", "'␉x"),
        ("a\n::error::", '"a\n\\::error::"'),
    ],
)
def test_no_cell_is_a_formula_or_a_command(cell: str, written: str) -> None:
    assert format_csv(["a"], [[cell]]) == f"a\r\n{written}\r\n"


def test_json_is_a_list_of_objects() -> None:
    assert json.loads(format_json_rows(["a", "b"], [["1", "2"]])) == [{"a": "1", "b": "2"}]
