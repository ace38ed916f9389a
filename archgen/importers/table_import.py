"""Import tables of components and connections as plain data of the language.

Two shapes are read, in one table or in several: a row for each component (its group, what it does, its inputs and
outputs), and a row for each connection (from, to, what flows). A table below another one has headings of its own.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any

from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.source_span import SourceTexts, Span
from archgen.importers import (
    column_headings,
    connection_rows,
    declaration_rows,
    language_data,
    node_rows,
    port_lists,
    row_records,
    table_cells,
)
from archgen.importers.column_headings import TableHeadings
from archgen.importers.imported_project import ImportedProject
from archgen.importers.row_records import TableRecord
from archgen.importers.table_cells import TableRow


@dataclass(frozen=True, slots=True)
class ImportResult:
    """What was imported: `data` by the language's sections (empty where nothing could be imported), and diagnostics."""

    data: Mapping[str, Any]
    diagnostics: tuple[Diagnostic, ...]
    sources: SourceTexts


def import_tables(files: Sequence[tuple[str, bytes]], distro: str | None) -> ImportResult:
    """Import tables given as (name, bytes). Messages are looked up for the distribution."""
    project, sources = ImportedProject(), SourceTexts()
    records: list[TableRecord] = []
    for name, data in files:
        text, diagnostics = table_cells.decode_table(name, data)
        project.diagnostics.extend(diagnostics)
        sources.add_text(name, text)
        if text:
            records += _read_records(project, name, text)
    _import_records(project, records)
    has_errors = any(diagnostic.severity is Severity.ERROR for diagnostic in project.diagnostics)
    sections = {} if has_errors else language_data.build_language_data(project, distro)
    if not sections and not has_errors:
        file_span = Span.of_file(files[0][0])
        help_line = "a row names a component, or connects two"
        empty = Diagnostic("missing-key", "no row names a component", file_span, Severity.ERROR, help=help_line)
        project.diagnostics.append(empty)
    # In the order in which the files were given, then by place: the passes found them in another order.
    sorted_diagnostics = sorted(
        project.diagnostics,
        key=lambda diagnostic: (
            [file_name for file_name, _ in files].index(diagnostic.span.file),
            diagnostic.sort_key[1:],
        ),
    )
    return ImportResult(sections, tuple(sorted_diagnostics), sources)


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


def _read_records(project: ImportedProject, name: str, text: str) -> list[TableRecord]:
    """Return the rows below headings."""
    declared_separator, text = table_cells.read_separator(text)
    try:
        diagnostics: list[Diagnostic] = []
        separator = declared_separator or _guess_separator(name, text)
        table = list(table_cells.read_rows(name, text, separator, diagnostics))
    except table_cells.TableTooLargeError as error:
        project.diagnostics.append(error.diagnostic)
        return []
    project.diagnostics.extend(diagnostics)
    records = list(_records_below_headings(project, table))
    if not records and not any(map(column_headings.read_headings, table)):
        message = "no row has headings that archgen knows"
        help_line = "name the columns: Group, Component, Description, Inputs, Outputs; or From, Output, To, Input, Type"
        project.diagnostics.append(
            Diagnostic("missing-key", message, Span.of_file(name), Severity.ERROR, help=help_line)
        )
    return records


def _guess_separator(name: str, text: str) -> str:
    """Guess the separator: the one with which most headings are recognised in the first rows, else the one with most
    cells.
    """
    # The first 50 rows decide, and they may be long: a cut keeps four trial parses cheap.
    beginning = text[:100_000]

    def weight(mark: str) -> tuple[int, int]:
        table: list[TableRow] = []
        with contextlib.suppress(table_cells.TableTooLargeError):
            table.extend(islice(table_cells.read_rows(name, beginning, mark, []), 50))
        known = (column_headings.read_headings(row) for row in table)
        return max((len(found.key_by_column) for found in known if found), default=0), max(map(len, table), default=0)

    return max(",;\t|", key=weight)


def _records_below_headings(project: ImportedProject, table: Sequence[TableRow]) -> Iterator[TableRecord]:
    """Yield the records below each row of headings, and report what is lost."""
    headings: TableHeadings | None = None
    cells_above: dict[str, Any] = {}
    lost_cells: dict[int, int] = {}
    for row in table:
        # Later headings must be complete, else a row of data could be taken for headings.
        new_headings = (
            column_headings.read_headings(row) if headings is None else column_headings.read_new_headings(row)
        )
        if new_headings:
            _report_unknown_columns(project, headings, lost_cells)
            headings, cells_above, lost_cells = new_headings, {}, {}
        elif headings is None:
            _report_lost_row(project, row, "stands above the headings")
        else:
            for column in row:
                if column not in headings.key_by_column:
                    lost_cells[column] = lost_cells.get(column, 0) + 1
                    if column not in headings.unknown_columns and not headings.kind:
                        cell = row[column]
                        project.add_warning(
                            "unknown-key",
                            "this cell stands below no heading and was not taken",
                            cell.span,
                            "give its column a heading",
                        )
            record = row_records.read_record(headings, row, cells_above)
            if record:
                yield record
            else:
                _report_lost_row(project, row, "says nothing below headings that archgen knows")
    _report_unknown_columns(project, headings, lost_cells)


def _report_lost_row(project: ImportedProject, row: TableRow, reason: str) -> None:
    first = row[min(row)]
    project.add_warning(
        "wrong-value", f"this row {reason} and was not taken", first.span, "if it matters, put it below known headings"
    )


def _report_unknown_columns(
    project: ImportedProject, headings: TableHeadings | None, lost_cells: Mapping[int, int]
) -> None:
    """Report once for each column that its cells were not imported."""
    for column, cell in headings.unknown_columns.items() if headings else ():
        count = lost_cells.get(column, 0)
        if count:
            lost_phrase = f"{count} cells below it were" if count > 1 else "the cell below it was"
            help_line = "rename the column if it is one of: " + ", ".join(
                dict.fromkeys(column_headings.KEY_BY_HEADING.values())
            )
            project.add_warning(
                "unknown-key",
                f"the column `{cell.one_line}` is not known, or is the second of its kind: {lost_phrase} not taken",
                cell.span,
                help_line,
            )
