"""Lists as text columns, CSV or JSON."""

from __future__ import annotations

import io
from collections.abc import Sequence

from archgen.diagnostics.safe_text import defuse_command, format_json, make_visible
from archgen.diagnostics.text_columns import format_table

TextRows = Sequence[Sequence[str]]


def format_columns(columns: Sequence[str], rows: TextRows, width: int | None = None) -> str:
    """Return columns aligned for the terminal, no wider than it is; control characters are made visible."""
    cleaned_rows = [[cell.replace("\n", "; ") for cell in row] for row in rows]
    return "".join(f"{defuse_command(line)}\n" for line in format_table(columns, cleaned_rows, width))


def format_csv(columns: Sequence[str], rows: TextRows) -> str:
    """Return RFC 4180. A cell that a spreadsheet would take for a formula gets an apostrophe in front.

    It may be printed in a terminal or in a workflow: what either would obey is made visible.
    """
    import csv

    out = io.StringIO()
    writer = csv.writer(out)
    writer.writerow(columns)
    writer.writerows([_defuse_formula(cell) for cell in row] for row in rows)
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


def format_json_rows(columns: Sequence[str], rows: TextRows) -> str:
    """Return a list of objects."""
    return format_json([dict(zip(columns, row, strict=True)) for row in rows])
