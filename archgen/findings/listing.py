"""Lists as text columns, CSV or JSON."""

from __future__ import annotations

import csv as csv_
import io
from collections.abc import Sequence

from archgen.findings.escape import json_text, plain_line, visible

Rows = Sequence[Sequence[str]]


def text(columns: Sequence[str], rows: Rows) -> str:
    """Return columns aligned for the terminal; control characters are made visible."""
    cleaned = [[visible(cell.replace("\n", "; ")) for cell in row] for row in [columns, *rows]]
    widths = [max(len(row[place]) for row in cleaned) for place in range(len(columns))]
    return "".join(
        plain_line("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()) + "\n"
        for row in cleaned
    )


def csv(columns: Sequence[str], rows: Rows) -> str:
    """Return RFC 4180. A cell that a spreadsheet would take for a formula gets an apostrophe in front.

    It may be printed in a terminal or in a workflow: what either would obey is made visible.
    """
    out = io.StringIO()
    writer = csv_.writer(out)
    writer.writerow(columns)
    writer.writerows([_harmless(cell) for cell in row] for row in rows)
    return out.getvalue()


def _harmless(cell: str) -> str:
    # Line by line: a cell may hold line ends, and each line of it may look like a command.
    shown = "\n".join(plain_line(visible(line)) for line in cell.split("\n"))
    # The characters that OWASP names for CSV injection.
    return f"'{shown}" if cell.lstrip()[:1] in {"=", "+", "-", "@"} or cell[:1] in {"\t", "\r", "\n"} else shown


def json(columns: Sequence[str], rows: Rows) -> str:
    """Return a list of objects."""
    return json_text([dict(zip(columns, row, strict=True)) for row in rows])
