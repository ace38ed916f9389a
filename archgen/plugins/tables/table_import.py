"""Import tables of components and connections as plain data of the language.

Two shapes are read, in one table or in several: a row for each component (its group, what it does, its inputs and
outputs), and a row for each connection (from, to, what flows). A table below another one has headings of its own.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from archgen.plugin.findings import Diagnostic, Severity
from archgen.plugin.importing import ImportedTables, SourceTexts, Span
from archgen.plugins.tables import (
    connection_rows,
    declaration_rows,
    language_data,
    node_rows,
    port_lists,
    table_files,
    table_records,
)
from archgen.plugins.tables.cell_ledger import CellLedger, CellUse
from archgen.plugins.tables.column_headings import HeadingMap
from archgen.plugins.tables.import_summary import render_import_summary
from archgen.plugins.tables.imported_project import ImportedProject
from archgen.plugins.tables.row_records import TableRecord
from archgen.plugins.tables.table_cells import TableCell
from archgen.plugins.tables.table_records import TableReport


@dataclass(frozen=True, slots=True)
class TableImport:
    """What was imported: `data` by the language's sections (empty where nothing could be imported), and diagnostics.

    `ledger` says what became of each cell, `tables` what each table's headings were taken for.
    """

    data: Mapping[str, Any]
    diagnostics: tuple[Diagnostic, ...]
    sources: SourceTexts
    ledger: CellLedger
    tables: tuple[TableReport, ...]


def read_tables(files: Sequence[tuple[str, bytes]], distro: str, heading_map: HeadingMap) -> ImportedTables:
    """Import tables given as (name, bytes), with what is to be said of them."""
    imported = import_tables(files, distro, heading_map)
    summary = tuple(render_import_summary(imported.ledger, imported.tables)) if imported.data else ()
    return ImportedTables(imported.data, imported.diagnostics, imported.sources, summary)


def import_tables(
    files: Sequence[tuple[str, bytes]], distro: str | None, heading_map: HeadingMap | None = None
) -> TableImport:
    """Import tables given as (name, bytes). Messages are looked up for the distribution."""
    project, sources = ImportedProject(), SourceTexts()
    heading_map = heading_map or {}
    reports: list[TableReport] = []
    for name, data in files:
        sheets = table_files.read_sheets(name, data, heading_map, project.diagnostics, sources)
        reports += table_records.read_reports(project, name, sheets, heading_map)
    records = [record for report in reports for record in report.records]
    table_records.report_unused_map(project, reports, heading_map, files[0][0])
    _import_records(project, records)
    has_errors = any(diagnostic.severity is Severity.ERROR for diagnostic in project.diagnostics)
    sections = {} if has_errors else language_data.build_language_data(project, distro)
    if not sections and not has_errors:
        file_span = Span.of_file(files[0][0])
        help_line = "a row names a component, or connects two"
        empty = Diagnostic("missing-key", "no row names a component", file_span, Severity.ERROR, help=help_line)
        project.diagnostics.append(empty)
    if sections:
        _account_for_rest(project, records, sections)
    diagnostics = _sort_diagnostics(project, [name for name, _ in files], reports)
    return TableImport(sections, diagnostics, sources, project.ledger, tuple(reports))


def _import_records(project: ImportedProject, records: Sequence[TableRecord]) -> None:
    """Import records in passes: declarations first, so that connections may name elements declared below them."""
    for record in records:
        declaration_rows.import_declaration(project, record)
    # A table of connections alone declares no component: then each name is new, and none is a slip.
    project.is_complete = any(project.all_components())
    for record in records:
        port_lists.import_outputs(project, record)
    for record in records:
        connection_rows.import_connection(project, record)
    for record in records:
        port_lists.import_inputs(project, record)
    for record in records:
        node_rows.import_node_row(project, record)


def _account_for_rest(project: ImportedProject, records: Sequence[TableRecord], sections: Mapping[str, Any]) -> None:
    """Report what nothing was said about: cells without an account, and those that did not get into the data."""
    ledger = project.ledger
    for record in records:
        for cell in record.cells.values():
            if record.is_lost and not ledger.has_account(cell):
                ledger.list_cell(cell, "its row was not taken")
            elif record.has_exact_ids and not ledger.has_account(cell):
                ledger.omit_cell(cell, "follows from the rest")
    for cell, use in list(ledger.prove_uses(sections)):
        project.reject_cell("wrong-value", _explain_loss(ledger, cell, use), cell, "if it matters, write it by hand")


def _explain_loss(ledger: CellLedger, cell: TableCell, use: CellUse | None) -> str:
    key = ledger.key_by_cell.get(cell.span, "cell").replace("_", " ")
    if use is None:
        return f"`{cell.quotation}` was not taken: a row like this one has no place for it ({key})"
    return (
        f"`{cell.quotation}` was not taken as {use.key} of `{use.element[-1]}`: another row or cell says it otherwise"
    )


def _sort_diagnostics(
    project: ImportedProject, file_names: Sequence[str], reports: Sequence[TableReport]
) -> tuple[Diagnostic, ...]:
    """Sort by file, table and place: the passes found them in another order."""
    # Each cell of a workbook is a place of its own, in the order in which it was read.
    places = list(file_names)
    for report in reports:
        headings = [cell for known_headings in report.headings for cell in known_headings.cells.values()]
        places += [report.name, *(cell.span.file for cell in (*headings, *report.cells))]
    number_by_place = {place: number for number, place in reversed(list(enumerate(dict.fromkeys(places))))}
    last = len(number_by_place)
    return tuple(
        sorted(
            project.diagnostics,
            key=lambda diagnostic: (number_by_place.get(diagnostic.span.file, last), diagnostic.sort_key[1:]),
        )
    )
