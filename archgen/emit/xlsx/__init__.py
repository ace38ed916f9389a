"""Excel: all tables of an outline as the sheets of one workbook. `write_workbook` is all that others need.

Tables of one kind (the ports of each component) share a sheet, with the section that each stands in as the first column.
XlsxWriter is an extra: without it there is a `XlsxWriterError`.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterable, Iterator, Mapping
from datetime import datetime
from typing import Any

from archgen.emit.office_package import STAMP, replace_forbidden, sign_package
from archgen.frozen import dataclass, field
from archgen.views.shapes import Facts, Inlines, Outline, Section, Table

_MAX_NAME = 31
_MAX_CELL = 32_767
"""Characters that a cell of Excel holds; XlsxWriter leaves out longer texts."""
_FORBIDDEN_NAME = re.compile(r"[\[\]:*?/\\]")
_NUMBER = re.compile(r"-?[0-9]{1,15}(?:\.[0-9]{1,9})?")
_MIN_WIDTH, _MAX_WIDTH = 8, 60
_PLACE = "Section"


class XlsxWriterError(Exception):
    """The library that writes workbooks is not installed; the text says how to get it."""


@dataclass(slots=True)
class SheetContent:
    """A sheet before it is written: its title, its columns in the order of their first table, and rows by column."""

    title: str
    columns: dict[str, bool] = field(default_factory=dict)
    """Whether the figures of a column are numbers, by its heading."""
    rows: list[Mapping[str, Inlines | str]] = field(default_factory=list)


def write_workbook(outline: Outline) -> bytes:
    """Return the tables of an outline as a workbook, the same bytes for the same tables."""
    try:
        import xlsxwriter
    except ImportError:
        raise XlsxWriterError("writing .xlsx needs the library XlsxWriter: `pip install XlsxWriter`") from None
    stream = io.BytesIO()
    # Text that begins with = + - or @ is text: from a stranger's project it must never run as a formula.
    options = {"in_memory": True, "strings_to_formulas": False, "strings_to_urls": False, "strings_to_numbers": False}
    workbook = xlsxwriter.Workbook(stream, options)
    workbook.set_properties({"title": replace_forbidden(outline.title), "created": datetime(*STAMP[:3])})  # noqa: DTZ001 - no clock
    names: set[str] = set()
    for content in collect_sheets(outline):
        base = _FORBIDDEN_NAME.sub(" ", replace_forbidden(content.title)).strip("' ")[:_MAX_NAME] or "Table"
        name, number = base, 1
        while name.casefold() in names:
            number += 1
            suffix = f" {number}"
            name = base[: _MAX_NAME - len(suffix)] + suffix
        names.add(name.casefold())
        _write_sheet(workbook, content, name)
    if not names:
        workbook.add_worksheet("No tables")
    workbook.close()
    return sign_package(stream.getvalue())


def collect_sheets(outline: Outline) -> tuple[SheetContent, ...]:
    """Return the sheets of an outline: a first one with all facts, then the tables, those of one kind together."""
    facts = SheetContent("Facts", dict.fromkeys((_PLACE, "Name", "Value"), False))
    sheets: dict[str, SheetContent] = {}
    for section, title in _walk_sections(outline.sections, ""):
        for block in section.blocks:
            if isinstance(block, Facts):
                facts.rows += [{_PLACE: title, "Name": name, "Value": value} for name, value in block.rows]
            elif isinstance(block, Table):
                _add_table(sheets, block, title)
    return (*((facts,) if facts.rows else ()), *sheets.values())


def _walk_sections(sections: Iterable[Section], path: str) -> Iterator[tuple[Section, str]]:
    for section in sections:
        title = f"{path} / {section.title}" if path else section.title
        yield section, title
        yield from _walk_sections(section.sections, title)


def _add_table(sheets: dict[str, SheetContent], table: Table, place: str) -> None:
    kind = table.kind
    title = kind.removeprefix("table:").replace("_", " ").capitalize()
    sheet = sheets.setdefault(kind, SheetContent(title, {_PLACE: False}))
    for column in table.columns:
        sheet.columns[column.title] = sheet.columns.get(column.title, True) and column.align == "right"
    for row in table.rows:
        cells = {column.title: cell for column, cell in zip(table.columns, row, strict=False)}
        sheet.rows.append({_PLACE: place, **cells})


def _write_sheet(workbook: Any, content: SheetContent, name: str) -> None:  # noqa: ANN401 - the library has no types
    sheet = workbook.add_worksheet(name)
    heading = workbook.add_format({"bold": True, "bottom": 1, "bg_color": "#EEF2F5"})
    wrapped = workbook.add_format({"text_wrap": True, "valign": "top"})
    for at, (title, is_number) in enumerate(content.columns.items()):
        texts = [_join_text(row.get(title, "")) for row in content.rows]
        sheet.write_string(0, at, replace_forbidden(title), heading)
        for line, text in enumerate(texts, start=1):
            if is_number and _NUMBER.fullmatch(text):
                sheet.write_number(line, at, float(text), wrapped)
            elif text:
                sheet.write_string(line, at, text, wrapped)
        longest = max((len(line) for text in (title, *texts) for line in text.split("\n")), default=0)
        sheet.set_column(at, at, min(max(longest + 2, _MIN_WIDTH), _MAX_WIDTH))
    sheet.freeze_panes(1, 0)
    sheet.autofilter(0, 0, max(len(content.rows), 1), len(content.columns) - 1)


def _join_text(cell: Inlines | str) -> str:
    text = (
        cell if isinstance(cell, str) else "".join(f"\n{part.text}" if part.line_break else part.text for part in cell)
    )
    return replace_forbidden(text)[:_MAX_CELL]
