"""Every cell of a table is taken, shown as not taken, or left out for a reason; and what is taken stands in the YAML."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from archgen.diagnostics.source_span import Span
from archgen.plugins.tables import table_import
from archgen.plugins.tables.table_cells import CellLedger, CellUse, TableCell
from archgen.plugins.tables.table_import import render_import_summary
from archgen.start import project_plan, start_answers
from tests.property_sizes import count_examples
from tests.workbooks import make_workbook

HEADINGS = [
    "Group",
    "Component",
    "Title",
    "ID",
    "Description",
    "Purpose",
    "Owner",
    "Inputs",
    "Outputs",
    "From",
    "To",
    "Type",
    "Signal",
    "Message",
    "Node",
    "Package",
    "Topic",
    "Rate",
    "Period [ms]",
    "Requirement",
    "Role",
    "Status",
    "Kind",
    "From group",
    "To group",
    "Price",
    "Baugruppe",
    "Komponente",
    "Eingänge",
    "Sortie",
    "Tópico",
    "Von",
    "Nach",
]
CELLS = [
    "A",
    "B",
    "A b",
    "Größe",
    "Camera",
    "Scan",
    "Scan: Laser scan",
    "Scan from A",
    "Scan, Image",
    "sensor_msgs/Image",
    "sensor_msgs/Nothing",
    "/scan",
    "30",
    "12,5 Hz",
    "1.000",
    "alle 100 ms",
    "fast",
    "R-1",
    "R-1, R-2",
    "It sees, it hears",
    "component",
    "connection",
    "group",
    "Summe:",
    "Total",
    "tbd",
    "-",
    "keine",
    "none",
    "source",
    "Sensor",
    "planned",
    "geplant",
    "my_pkg",
    "=A1",
    "#REF!",
    "3D",
    "機械",
    "Lab A",
    "Lab A, Lab B",
    "Group",
    "Component",
]
FREE_TEXT = {"functionality", "description", "package"}


def _write_table(rows: list[list[str]]) -> bytes:
    return "\n".join(";".join(f'"{cell}"' for cell in row) for row in rows).encode()


def _read_yaml(imported: table_import.TableImport) -> dict[str, Any]:
    """Return what the files of the project say, read by another program than the one that wrote them."""
    answers = start_answers.add_partners(start_answers.collect_answers("r"), imported.data.get("partners", {}))
    merged: dict[str, Any] = {}
    for content in project_plan.imported_files(answers, imported.data).values():
        for section, value in yaml.safe_load(content).items():
            merged.setdefault(section, {}).update(value) if isinstance(value, dict) else merged.update({section: value})
    return merged


def _list_texts(value: object) -> Iterator[str]:
    if isinstance(value, dict):
        for key, inner in value.items():
            yield str(key)
            yield from _list_texts(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from _list_texts(inner)
    elif value is not None:
        yield str(value)


def _fold(text: str) -> str:
    return re.sub(r"\W", "", text.casefold().replace("_", ""))


def find_silent_losses(imported: table_import.TableImport) -> list[str]:
    """Return what is neither taken nor shown, and what is said to be taken and does not stand in the YAML."""
    ledger = imported.ledger
    printed = "\n".join(render_import_summary(imported.ledger, imported.tables))
    shown = {diagnostic.span for diagnostic in imported.diagnostics}
    project = _read_yaml(imported)
    losses = []
    for span, cell in ledger.cells.items():
        if span in ledger.reasons and span not in shown and f"`{cell.one_line}`: " not in printed:
            losses.append(f"{span}: {cell.text} is not shown")
        if not ledger.has_account(cell):
            losses.append(f"{span}: {cell.text} has no account")
    for span, uses in ledger.uses.items():
        for use in uses:
            element: Any = project
            for name in use.element:
                element = element.get(name, {}) if isinstance(element, dict) else {}
            texts = [_fold(text) for text in (*_list_texts(element), *use.element)]
            words = [use.words, *([ledger.cells[span].one_line] if use.key in FREE_TEXT else [])]
            losses += [f"{span}: {use}" for word in words if not any(_fold(word) in text for text in texts)]
    return losses


@settings(max_examples=count_examples(300), deadline=None)
@given(
    st.lists(st.sampled_from(HEADINGS), min_size=2, max_size=8, unique=True),
    st.lists(st.lists(st.sampled_from(["", *CELLS]), max_size=9), min_size=1, max_size=7),
)
def test_each_cell_of_any_table_is_taken_or_shown(headings: list[str], rows: list[list[str]]) -> None:
    imported = table_import.import_tables([("t.csv", _write_table([headings, *rows]))], "jazzy")
    if not imported.data:
        assert any(diagnostic.severity == "error" for diagnostic in imported.diagnostics)
        return
    in_headings = sum(len(known.cells) for table in imported.tables for known in table.headings)
    placeholders = sum(len(table.placeholders) for table in imported.tables)
    others = sum(len(table.cells) for table in imported.tables)
    assert in_headings + placeholders + others == len(headings) + sum(bool(cell) for row in rows for cell in row)
    assert find_silent_losses(imported) == []


@settings(max_examples=count_examples(60), deadline=None)
@given(
    st.lists(st.sampled_from(HEADINGS), min_size=2, max_size=8, unique=True),
    st.lists(st.lists(st.sampled_from(["", "0", *CELLS]), max_size=9), min_size=1, max_size=7),
)
def test_each_cell_of_any_workbook_is_taken_or_shown(headings: list[str], rows: list[list[str]]) -> None:
    written = [
        "".join(f'<c t="inlineStr"><is><t>{cell}</t></is></c>' if cell else "<c/>" for cell in row)
        for row in [headings, *rows]
    ]
    sheet = f"<sheetData>{''.join(f'<row>{cells}</row>' for cells in written)}</sheetData>"
    imported = table_import.import_tables([("t.xlsx", make_workbook({"S": sheet}))], "jazzy")
    if imported.data:
        assert find_silent_losses(imported) == []
        in_headings = sum(len(known.cells) for table in imported.tables for known in table.headings)
        others = sum(len(table.cells) + len(table.placeholders) for table in imported.tables)
        assert in_headings + others == len(headings) + sum(bool(cell) for row in rows for cell in row)


def test_what_is_said_to_be_taken_must_stand_in_the_data() -> None:
    ledger = CellLedger()
    kept, lost, forgotten = (
        TableCell(text, Span("t.csv", 2, column, 2, column + 1)) for column, text in enumerate("abc")
    )
    for cell in (kept, lost, forgotten):
        ledger.add_cell(cell)
    component = ("groups", "g", "components", "camera")
    ledger.take_cell(kept, "component", component, "camera")
    ledger.take_cell(lost, "functionality", component, "Looks")
    sections = {"groups": {"g": {"components": {"camera": {"functionality": "Sees"}}}}}
    assert list(ledger.prove_uses(sections)) == [
        (lost, CellUse("functionality", component, "Looks")),
        (forgotten, None),
    ]
