"""Rows of CSV that are safe to open in a spreadsheet, to print in a terminal and in a workflow."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable

from archgen.diagnostics import defuse_command, make_visible


def write_csv_rows(rows: Iterable[Iterable[str]]) -> str:
    """Return RFC 4180. A cell that a spreadsheet would take for a formula gets an apostrophe in front.

    It may be printed in a terminal or in a workflow: what either would obey is made visible.
    """
    out = io.StringIO()
    csv.writer(out).writerows([_defuse_formula(cell) for cell in row] for row in rows)
    return out.getvalue()


def _defuse_formula(cell: str) -> str:
    # Nearly all cells of a matrix are empty or a number.
    if not cell or (cell.isascii() and cell.isalnum()):
        return cell
    # Line by line: a cell may hold line ends, and each line of it may look like a command.
    visible_cell = "\n".join(defuse_command(make_visible(line)) for line in cell.split("\n"))
    # The characters that OWASP names for CSV injection.
    return (
        f"'{visible_cell}"
        if cell.lstrip()[:1] in {"=", "+", "-", "@"} or cell[:1] in {"\t", "\r", "\n"}
        else visible_cell
    )
