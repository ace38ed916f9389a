"""What `archgen init --from` says of each table at the end: its headings, and every cell that has no finding of its own."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from archgen.plugin.findings import make_visible
from archgen.plugins.tables.column_headings import write_map_option

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from archgen.plugin.importing import Span
    from archgen.plugins.tables.cell_ledger import CellLedger
    from archgen.plugins.tables.column_headings import TableHeadings
    from archgen.plugins.tables.table_records import TableReport


def render_import_summary(ledger: CellLedger, tables: Iterable[TableReport]) -> Iterator[str]:
    """Yield the lines of the summary, a paragraph for each table."""
    for table in tables:
        yield make_visible(f"{table.name}: {_count_cells(ledger, table)}")
        for headings in table.headings:
            yield f"  headings: {', '.join(_describe_headings(headings))}"
        for cell in table.cells:
            reason = ledger.listed.get(cell.span)
            if reason:
                yield f"  not taken: {make_visible(f'{_place_of(table, cell.span)} `{cell.one_line}`: {reason}')}"


def _count_cells(ledger: CellLedger, table: TableReport) -> str:
    """Count the cells by what became of them; a cell of which only a part was taken counts as not taken."""
    counts: Counter[str] = Counter()
    for cell in table.cells:
        omission = ledger.omissions.get(cell.span)
        counts["not taken" if cell.span in ledger.reasons else omission or "taken"] += 1
    counts["says nothing yet"] += len(table.placeholders)
    parts = [f"{counts.pop(kind, 0)} {kind}" for kind in ("taken", "not taken")]
    parts += [f"{count} left out ({reason})" for reason, count in counts.items() if count]
    total = len(table.cells) + len(table.placeholders)
    return f"{total} cell{'s' * (total != 1)} below headings: {', '.join(parts)}"


def _describe_headings(headings: TableHeadings) -> Iterator[str]:
    """Yield each heading and what it was taken for."""
    for column, cell in sorted(headings.cells.items()):
        key = headings.key_by_column.get(column)
        unit = headings.unit_by_key.get(key, "") if key else ""
        if key:
            yield make_visible(f"{cell.one_line} = {key}{f' in {unit}' if unit else ''}")
        elif headings.kind:
            yield make_visible(f"{cell.one_line} follows from the rest")
        else:
            yield make_visible(f"{cell.one_line} is not taken ({write_map_option(cell.one_line, None)})")


def _place_of(table: TableReport, span: Span) -> str:
    """Return a cell's line and column, or its address where it has one of its own."""
    # The cells of a workbook or document are files of their own to a finding: `parts.xlsx [Sheet] B7`.
    return f"{span.line}:{span.column}" if span.file == table.name else span.file.removeprefix(table.name).strip()
