"""Import tables of components and connections as plain data of the language.

Two shapes are read, in one table or in several: a row for each component (its group, what it does, its inputs and
outputs), and a row for each connection (from, to, what flows). A table below another one has headings of its own.

What `archgen init --from` says of each table at the end: its headings, and every cell that has no finding of its own.

Turn the imported project into data of the language: short forms, shortest references, and nothing that would be an
error.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from archgen.plugin.findings import Diagnostic, Severity, make_visible
from archgen.plugin.importing import ImportedTables, SourceTexts, Span, title_from_id
from archgen.plugin.ros import full_message_name, load_interfaces
from archgen.plugins.tables import connection_rows, declaration_rows, port_lists, table_files, table_records
from archgen.plugins.tables.imported_project import (
    UNSORTED,
    ImportedComponent,
    ImportedGroup,
    ImportedInput,
    ImportedProject,
)
from archgen.plugins.tables.table_cells import (
    CellLedger,
    CellUse,
    HeadingMap,
    TableCell,
    TableHeadings,
    write_map_option,
)
from archgen.plugins.tables.table_records import TableRecord, TableReport


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
    sections = {} if has_errors else build_language_data(project, distro)
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
        declaration_rows.import_node_row(project, record)


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


def build_language_data(project: ImportedProject, distro: str | None) -> dict[str, Any]:
    """Return the sections that a table says something about; empty where there is no component."""
    groups = {name: group for name, group in project.groups.items() if group.components}
    _report_left_out(project, groups)
    if not groups:
        return {}
    # Changes outputs and `wrong_messages`, so it must come before anything is written.
    _check_messages(project, distro)
    id_counts = Counter(component.id for component in project.all_components())
    # A reference may leave out its group only where no other component, and no group, has that id.
    unique_ids = {name for name, count in id_counts.items() if count == 1 and name not in project.groups}
    sections: dict[str, Any] = {
        "groups": {name: _group_data(group, unique_ids) for name, group in groups.items()},
        "nodes": {name: _node_data(node) for name, node in project.nodes.items()},
        "types": _type_data(project),
        "requirements": project.requirements,
        "partners": project.partners,
    }
    return {key: value for key, value in sections.items() if value}


def _report_left_out(project: ImportedProject, groups: dict[str, ImportedGroup]) -> None:
    """Report groups without components, and how many components no group was named for."""
    for name, group in project.groups.items():
        if name not in groups:
            project.add_warning(
                "missing-key", f"the group `{group.name}` has no component and was not taken", group.span, "add one"
            )
            project.ledger.list_element(group.path, "its group has no component")
    if UNSORTED in groups:
        count = len(groups[UNSORTED].components)
        message = (
            f"{count} {'components stand' if count > 1 else 'component stands'} in no group: look for `{UNSORTED}`"
        )
        project.add_note(message, groups[UNSORTED].span, "a column `Group` sorts them; or move them by hand")


def _group_data(group: ImportedGroup, unique_ids: set[str]) -> dict[str, Any]:
    data: dict[str, Any] = {"title": "To be sorted" if group.id == UNSORTED else group.name, **group.values}
    owners = dict.fromkeys(component.values.get("owner") for component in group.components.values())
    # An owner that all components share is written once, at the group.
    shared = next(iter(owners)) if len(owners) == 1 else None
    if shared and "owner" not in data:
        data["owner"] = shared
    data["components"] = {
        name: _component_data(component, unique_ids, data.get("owner")) for name, component in group.components.items()
    }
    return data


def _component_data(component: ImportedComponent, unique_ids: set[str], owner: object) -> dict[str, Any]:
    data: dict[str, Any] = {}
    has_no_content = not (
        component.inputs
        or component.outputs
        or component.declared_empty
        or {"functionality", "role"} & set(component.values)
    )
    if has_no_content or component.name not in (component.id, title_from_id(component.id)):
        data["title"] = component.name
    keys = dict(component.values)
    if keys.get("owner") == owner:
        keys.pop("owner", None)
    timing = keys.pop("timing", None)
    data |= {"functionality": keys.pop("functionality", None), **keys}
    if component.requirements:
        data["requirements"] = component.requirements
    data["inputs"] = {name: _input_data(port, component, unique_ids) for name, port in component.inputs.items()} or (
        {} if "inputs" in component.declared_empty else None
    )
    data["outputs"] = dict(component.outputs) or ({} if "outputs" in component.declared_empty else None)
    return data | ({"timing": timing} if timing else {})


def _input_data(port: ImportedInput, reader: ImportedComponent, unique_ids: set[str]) -> Any:  # noqa: ANN401 - short or long form
    paths = [_shortest_reference(path, reader, unique_ids) for path in port.sources]
    source: Any = paths[0] if len(paths) == 1 else paths or None
    if port.description is None and (source is not None or port.type is None):
        return source
    data = {"from": source, "type": port.type if source is None else None, "description": port.description}
    return {key: value for key, value in data.items() if value is not None}


def _shortest_reference(path: tuple[str, ...], reader: ImportedComponent, unique_ids: set[str]) -> str:
    """Write a reference as short as it can be without being ambiguous."""
    if len(path) == 3 and path[1] in unique_ids and path[1] != reader.id:  # noqa: PLR2004 - group, component, output
        return ".".join(path[1:])
    return ".".join(path)


def _node_data(node: dict[str, object]) -> dict[str, object]:
    implements = node["implements"]
    implemented = implements[0] if isinstance(implements, list) and len(implements) == 1 else implements
    return {"implements": implemented, **{key: value for key, value in node.items() if key != "implements"}}


def _type_data(project: ImportedProject) -> dict[str, str | None]:
    """Return the message of each type; None where the message does not exist."""
    return {name: message if message not in project.wrong_messages else None for name, message in project.types.items()}


def _check_messages(project: ImportedProject, distro: str | None) -> None:
    """Report messages that do not exist, and mark them: written down they would be errors."""
    known_interfaces, _ = load_interfaces(distro)
    written = {message for message in project.types.values() if message}
    written |= {
        type_name
        for component in project.all_components()
        for type_name in component.outputs.values()
        if type_name and full_message_name(type_name)
    }
    for message in sorted(written):
        if known_interfaces.status_of(message) == "wrong":
            nearest = known_interfaces.find_nearest(message)
            help_line = f"did you mean `{nearest}`?" if nearest else "look the name up"
            text = f"{known_interfaces.distro or 'ROS'} has no message `{message}`: it was not taken"
            first_cell, *other_cells = project.message_cells[message]
            project.reject_cell("unknown-message", text, first_cell, help_line)
            for cell in other_cells:
                project.ledger.list_cell(cell, f"there is no message `{message}`")
            project.wrong_messages.add(message)
    for component in project.all_components():
        component.outputs = {
            name: None if type_name in project.wrong_messages else type_name
            for name, type_name in component.outputs.items()
        }
