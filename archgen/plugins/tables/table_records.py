"""Find headings and rows of totals in a table, and turn the rest into records; what is left out is accounted for."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from archgen.plugin.findings import Severity
from archgen.plugin.importing import Span
from archgen.plugins.tables import table_cells
from archgen.plugins.tables.imported_project import ImportedComponent, ImportedProject
from archgen.plugins.tables.table_cells import (
    KEY_BY_HEADING,
    TARGETS,
    TOTAL_WORDS,
    HeadingMap,
    TableCell,
    TableHeadings,
    TableRow,
    TableSheet,
    fold_heading,
    make_error,
)

_NUMBER_PATTERN = re.compile(r"[-+]?[0-9][0-9 .,'\u2019]*(?:[%\u20ac$\u00a3]|[A-Za-z]{1,3})?\Z")
_SHOWN_ROWS, _SHOWN_CELLS = 3, 8


@dataclass(slots=True)
class TableReport:
    """What was found in one table: its headings (of each part that has its own), its records, all of its cells."""

    name: str
    headings: list[TableHeadings] = field(default_factory=list)
    records: list[TableRecord] = field(default_factory=list)
    cells: list[TableCell] = field(default_factory=list)
    placeholders: list[TableCell] = field(default_factory=list)
    """The cells that say nothing yet."""
    unknown_cells: dict[Span, list[TableCell]] = field(default_factory=dict)
    """The cells below each heading that is not known, by the heading's place."""


def read_reports(
    project: ImportedProject, file: str, sheets: Sequence[TableSheet], heading_map: HeadingMap
) -> list[TableReport]:
    """Read the tables of one file. An error where none of them has known headings."""
    filled_sheets = [sheet for sheet in sheets if any(sheet.rows)]
    reports = [_read_report(project, sheet, heading_map) for sheet in filled_sheets]
    if reports and not any(report.headings for report in reports):
        first_sheet = filled_sheets[0]
        seen, help_line = _describe_unknown(first_sheet, heading_map)
        place = Span.of_file(file if first_sheet.name == file else first_sheet.name)
        message = f"no row has headings that archgen knows; the first rows are: {seen}"
        project.diagnostics.append(make_error("missing-key", message, place, help_line))
    else:
        for sheet, report in zip(filled_sheets, reports, strict=True):
            if not report.headings:
                _report_unknown_table(project, sheet, report, heading_map)
    return reports


def _report_unknown_table(
    project: ImportedProject, sheet: TableSheet, report: TableReport, heading_map: HeadingMap
) -> None:
    """Report a table without known headings beside others that have them."""
    _, help_line = _describe_unknown(sheet, heading_map)
    count = f"{len(report.cells)} cells were" if len(report.cells) > 1 else "cell was"
    message = f"no row of this table has headings that archgen knows: its {count} not taken"
    project.add_warning("missing-key", message, Span.of_file(sheet.name), help_line)
    for cell in report.cells:
        project.ledger.list_cell(cell, "its table has no headings that archgen knows")


def _describe_unknown(sheet: TableSheet, heading_map: HeadingMap) -> tuple[str, str]:
    """Return the first rows of a table in words, and how to map the row that looks most like headings."""
    rows = [row for row in sheet.rows[:50] if row]
    shown = ["`" + " | ".join(cell.quotation for cell in list(row.values())[:_SHOWN_CELLS]) + "`" for row in rows]

    def weigh_row(row: TableRow) -> tuple[int, int]:
        known = [table_cells.key_of_heading(cell.one_line, heading_map) for cell in row.values()]
        return sum(key is not None for key in known), len(row)

    likely_row = max(rows, key=weigh_row)
    unknown = [cell for cell in likely_row.values() if not table_cells.key_of_heading(cell.one_line, heading_map)]
    hints = [
        table_cells.write_map_option(cell.one_line, table_cells.suggest_meaning(cell.one_line))
        for cell in unknown[:_SHOWN_CELLS]
    ]
    help_line = (
        f"say what the columns mean if they matter: {' '.join(hints)}; a MEANING is one of: {', '.join(TARGETS)}"
    )
    return ", ".join(shown[:_SHOWN_ROWS]), help_line


def _read_report(project: ImportedProject, sheet: TableSheet, heading_map: HeadingMap) -> TableReport:
    """Turn the rows below headings into records, and account for all other cells."""
    report = TableReport(sheet.name, placeholders=sheet.placeholders)
    for cell in sheet.placeholders:
        project.ledger.omit_cell(cell, "says nothing yet")
    headings: TableHeadings | None = None
    cells_above: dict[str, Any] = {}
    rows_above: list[TableRow] = []
    follows_gap = False
    for row in sheet.rows:
        if not row:
            follows_gap = True
            continue
        new_headings = _read_headings(row, headings, heading_map, follows_gap=follows_gap)
        follows_gap = False
        if new_headings:
            headings, cells_above = new_headings, {}
            report.headings.append(headings)
            continue
        report.cells += [cell for cell in row.values() if cell.span not in project.ledger.cells]
        for column, cell in row.items():
            project.ledger.add_cell(cell, headings.key_by_column.get(column, "") if headings else "")
        if headings is None:
            rows_above.append(row)
        elif not _skip_row(project, headings, row):
            _read_row(project, report, headings, (row, cells_above))
    if headings:
        _report_rows_above(project, rows_above)
    for known_headings in report.headings:
        _report_unknown_columns(project, report, known_headings)
    return report


def _read_headings(
    row: TableRow, headings: TableHeadings | None, heading_map: HeadingMap, *, follows_gap: bool
) -> TableHeadings | None:
    """Read a row as headings; below other headings it must be complete, or stand below a blank row."""
    if headings is None:
        return table_cells.read_headings(row, heading_map)
    complete_headings = table_cells.read_new_headings(row, heading_map)
    if complete_headings or not follows_gap:
        return complete_headings
    new_headings = table_cells.read_headings(row, heading_map)
    # Three known words: a row of data below a blank line may hold two by chance.
    return new_headings if new_headings and len(new_headings.key_by_column) > 2 else None  # noqa: PLR2004 - as above


def _skip_row(project: ImportedProject, headings: TableHeadings, row: TableRow) -> bool:
    """Return whether a row repeats the headings, or holds totals; account for its cells."""
    if {column: cell.one_line for column, cell in row.items()} == {
        column: cell.one_line for column, cell in headings.cells.items()
    }:
        for cell in row.values():
            project.ledger.omit_cell(cell, "repeats the headings")
        return True
    if headings.kind or not _is_total(headings, row):
        return False
    first_cell, *other_cells = row.values()
    message = f"`{first_cell.quotation}` begins a row of totals, which was not taken"
    project.reject_cell("wrong-value", message, first_cell, "take the row out; or name the element otherwise")
    for cell in other_cells:
        project.ledger.list_cell(cell, "it stands in a row of totals")
    return True


def _is_total(headings: TableHeadings, row: TableRow) -> bool:
    """Return whether a row holds a word such as `Summe` and besides only numbers."""
    words = {
        column: cell
        for column, cell in row.items()
        if not (_NUMBER_PATTERN.match(cell.one_line) or cell.text.startswith("="))
    }
    if len(words) != 1:
        return False
    column, cell = next(iter(words.items()))
    text, mark, rest = cell.one_line.partition(":")
    if fold_heading(text) not in TOTAL_WORDS and text.strip() not in {"\u03a3", "\u2211"}:
        return False
    # A component may be called `Sum`, and have a rate: a total is marked, or has numbers where no number belongs.
    number_keys = {headings.key_by_column.get(other) for other in row if other != column}
    if mark:
        return not rest or rest.strip()[0].isdigit()
    return bool(number_keys - {"rate", "period", "requirement", "id"})


def _read_row(
    project: ImportedProject,
    report: TableReport,
    headings: TableHeadings,
    row_and_above: tuple[TableRow, dict[str, Any]],
) -> None:
    """Turn a row into a record; cells outside of known columns are not taken."""
    row, cells_above = row_and_above
    for column, cell in row.items():
        if column in headings.key_by_column:
            continue
        heading = headings.cells.get(column)
        if headings.kind:
            project.ledger.omit_cell(cell, "follows from the rest")
        elif heading:
            report.unknown_cells.setdefault(heading.span, []).append(cell)
            project.ledger.list_cell(cell, f"its column `{heading.quotation}` was not taken")
        else:
            message = f"`{cell.quotation}` stands below no heading and was not taken"
            project.reject_cell("unknown-key", message, cell, "give its column a heading")
    record = read_record(project, headings, row, cells_above)
    if record:
        report.records.append(record)
        return
    lost_cells = [cell for cell in row.values() if not project.ledger.has_account(cell)]
    if lost_cells:
        message = (
            f"`{lost_cells[0].quotation}`: this row says nothing below headings that archgen knows and was not taken"
        )
        help_line = "if it matters, put it below known headings"
        project.reject_cell("wrong-value", message, lost_cells[0], help_line)
        for cell in lost_cells[1:]:
            project.ledger.list_cell(cell, "its row was not taken")


def _report_rows_above(project: ImportedProject, rows: Sequence[TableRow]) -> None:
    for row in rows:
        for cell in row.values():
            message = f"`{cell.quotation}` stands above the headings and was not taken"
            project.reject_cell("wrong-value", message, cell, "if it matters, put it below known headings")


def _report_unknown_columns(project: ImportedProject, report: TableReport, headings: TableHeadings) -> None:
    """Report once for each column that its cells were not taken; the summary lists them."""
    for column, heading in headings.unknown_columns.items():
        count = len(report.unknown_cells.get(heading.span, ()))
        if not count:
            continue
        lost_phrase = f"{count} cells below it were" if count > 1 else "the cell below it was"
        first_column = headings.first_columns.get(column)
        if first_column is not None:
            first_heading, key = headings.cells[first_column].quotation, headings.key_by_column[first_column]
            message = f"the column `{heading.quotation}` means {key} like `{first_heading}`: {lost_phrase} not taken"
        else:
            message = f"the column `{heading.quotation}` is not known: {lost_phrase} not taken"
        guess = None if first_column is not None else table_cells.suggest_meaning(heading.one_line)
        option = table_cells.write_map_option(heading.one_line, guess)
        help_line = f"{f'did you mean {guess}? ' if guess else ''}{option} takes it"
        help_line += f"; a MEANING is one of: {', '.join(TARGETS)}"
        project.add_warning("unknown-key", message, heading.span, help_line)


def report_unused_map(
    project: ImportedProject, reports: Sequence[TableReport], heading_map: HeadingMap, file: str
) -> None:
    """Report headings that the user maps and that no table has."""
    present = {
        spelling
        for report in reports
        for headings in report.headings
        for cell in headings.cells.values()
        for spelling in table_cells.list_spellings(cell.one_line)
    }
    for heading, key in heading_map.items():
        if heading not in present and not any(d.severity is Severity.ERROR for d in project.diagnostics):
            message = f"no table has the heading that --map takes for {key} (`{heading}`)"
            project.add_warning("unknown-key", message, Span.of_file(file), "write it as it stands in the table")


_KIND_SPELLINGS = {
    "connection": "connection; signal; signal flow; link; flow; edge; data flow; interface; arrow; Verbindung; Verknüpfung; Datenfluss; liaison; lien; "
    "connexion; flux; conexión; enlace; flujo",
    "component": "function; Funktion; fonction; función",
}
_KIND_BY_WORD = {fold_heading(word): kind for kind, words in _KIND_SPELLINGS.items() for word in words.split(";")}
_ROW_KINDS = ("component", "group", "node", "requirement", "type", "message")
"""The meanings of columns that also say what a row is: a row `Komponente` is a component."""


@dataclass(slots=True)
class TableRecord:
    """A row by the meaning of its columns. `kind` comes from the row or is guessed; with `has_exact_ids`, ids are
    paths.
    """

    kind: str
    cells: dict[str, TableCell]
    units: Mapping[str, str]
    has_exact_ids: bool = False
    component: ImportedComponent | None = None
    output_id: str = ""
    """The output of the component that a connection is about."""
    is_lost: bool = False
    """Whether the row as a whole could not be imported, which was reported."""
    output_ids: list[str] = field(default_factory=list)
    """The outputs that the row of a component lists."""

    def cell_below(self, key: str) -> TableCell | None:
        """Return the cell below a heading."""
        return self.cells.get(key)

    @property
    def first_cell(self) -> TableCell:
        """A cell to point at."""
        return next(iter(self.cells.values()))


def read_record(
    project: ImportedProject, headings: TableHeadings, row: TableRow, cells_above: dict[str, Any]
) -> TableRecord | None:
    """Read a row below headings; None where nothing in it can be imported.

    Merged cells leave all but the first empty: group, component and `from` are taken from above. `cells_above` is
    updated.
    """
    cells = {key: row[column] for column, key in sorted(headings.key_by_column.items()) if column in row}
    if not cells:
        return None
    kind = headings.kind or (_read_kind(project, cells["kind"]) if "kind" in cells else "")
    if not headings.kind:
        _fill_merged(headings, cells, cells_above)
        kind = kind or _guess_kind(headings, cells)
    return TableRecord(kind, cells, headings.unit_by_key, bool(headings.kind)) if kind else None


def _read_kind(project: ImportedProject, cell: TableCell) -> str:
    """Return what a cell says that its row is; empty where it says nothing that is known, which is reported."""
    key = KEY_BY_HEADING.get(fold_heading(cell.one_line), "")
    kind = _KIND_BY_WORD.get(fold_heading(cell.one_line)) or (key if key in _ROW_KINDS else "")
    if kind:
        project.ledger.take_cell(cell, "kind", ("groups",))
        return "type" if kind == "message" else kind
    message = f"`{cell.quotation}` is no kind of row and was not taken"
    help_line = "write component, connection, group, node, requirement or type; or map the column to what it means"
    project.reject_cell("wrong-value", message, cell, help_line)
    return ""


def _fill_merged(headings: TableHeadings, cells: dict[str, TableCell], cells_above: dict[str, TableCell]) -> None:
    # Below another group the component above no longer applies.
    """Fill the cells that merged cells left empty."""
    if "group" in cells and cells_above.get("group") != cells["group"]:
        for key in ("component", "from"):
            cells_above.pop(key, None)
    for key in ("group", "from_group", "component", "from"):
        if key in cells:
            cells_above[key] = cells[key]
        elif key in cells_above and key in headings and _continues_above(key, cells):
            cells[key] = cells_above[key]


def _continues_above(key: str, cells: Mapping[str, TableCell]) -> bool:
    """Return whether a row without this cell continues the one above."""
    if key == "group":
        return "component" in cells or "input" in cells or "output" in cells or "title" in cells
    if key == "component":
        return bool({"input", "output", "from", "to"} & set(cells)) and "title" not in cells and "id" not in cells
    return "to" in cells


def _guess_kind(headings: TableHeadings, cells: Mapping[str, TableCell]) -> str:
    """Guess what a row is about from the cells that it has; empty where that is not clear."""
    # The order matters: a row that connects may name a component, a group and a type as well.
    if "from" in cells or "to" in cells:
        return "connection"
    if "component" in cells:
        return "component"
    if "node" in cells:
        return "node"
    if "group" in cells and not {"from", "to"} <= set(headings.key_by_column.values()):
        return "group"
    if "type" in cells and "message" in cells:
        return "type"
    return "requirement" if "requirement" in cells and ({"title", "description"} & set(cells)) else ""
