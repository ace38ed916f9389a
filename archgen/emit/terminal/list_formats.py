"""Lists as text columns, CSV or JSON."""

from __future__ import annotations

from collections.abc import Sequence

from archgen.diagnostics import defuse_command, format_json
from archgen.diagnostics.text_columns import format_table

TextRows = Sequence[Sequence[str]]


def format_columns(columns: Sequence[str], rows: TextRows, width: int | None = None) -> str:
    """Return columns aligned for the terminal, no wider than it is; control characters are made visible."""
    cleaned_rows = [[cell.replace("\n", "; ") for cell in row] for row in rows]
    return "".join(f"{defuse_command(line)}\n" for line in format_table(columns, cleaned_rows, width))


def format_csv(columns: Sequence[str], rows: TextRows) -> str:
    """Return RFC 4180, safe to open in a spreadsheet and to print."""
    from archgen.emit.csv_rows import write_csv_rows

    return write_csv_rows([columns, *rows])


def format_json_rows(columns: Sequence[str], rows: TextRows) -> str:
    """Return a list of objects."""
    return format_json([dict(zip(columns, row, strict=True)) for row in rows])
