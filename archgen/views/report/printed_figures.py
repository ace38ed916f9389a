"""Figures as paper wants them: real signs, three significant digits, one unit in a column of times."""

from __future__ import annotations

import re
from collections.abc import Iterable
from decimal import Decimal

from archgen.frozen import replace
from archgen.views import inline_text
from archgen.views.shapes import Block, Bullets, Facts, Inlines, Paragraph, Section, Table, Text
from archgen.views.short_figures import QUANTITY, round_number, shorten_match, write_comparisons

_TIME_FACTORS = {"ns": Decimal(1), "us": Decimal(1000), "ms": Decimal(10**6), "s": Decimal(10**9)}
_TIME_CELL = re.compile(r"(>= |<= )?([0-9]+(?:\.[0-9]+)?) (ns|us|ms|s)")
_MIN_TIMES = 2
_THIN = "\u202f"
"""Between a figure and its unit, which must not part."""


def print_section_figures(section: Section) -> Section:
    """Return a section with its figures for paper, and those below it."""
    return replace(
        section,
        blocks=tuple(_print_block(block) for block in section.blocks),
        sections=tuple(print_section_figures(each) for each in section.sections),
    )


def _print_block(block: Block) -> Block:
    match block:
        case Paragraph():
            return replace(block, inlines=print_inlines(block.inlines))
        case Bullets():
            return replace(block, items=tuple(print_inlines(item) for item in block.items))
        case Facts():
            return replace(block, rows=tuple((name, print_inlines(value)) for name, value in block.rows))
        case Table():
            return _print_table(block)
        case _:
            return block


def print_inlines(inlines: Inlines) -> Inlines:
    """Return runs of text with real signs and three significant digits; code stays as it is written."""
    return tuple(
        part if part.code else replace(part, text=print_text(part.text, is_lower=part.is_lower))
        for part in inline_text.render_marks(inlines)
    )


def print_text(text: str, *, is_lower: bool = False) -> str:
    """Return text with real signs and three significant digits: `≤ 4.17 s` for `<= 4166.667 ms`."""
    return write_comparisons(QUANTITY.sub(lambda found: _print_quantity(found, is_lower=is_lower), text))


def _print_quantity(found: re.Match[str], *, is_lower: bool) -> str:
    sign, number, unit = shorten_match(found, is_lower=is_lower)
    return f"{sign}{number}{_THIN}{'µs' if unit == 'us' else unit}"


def _print_table(table: Table) -> Table:
    columns, cells_by_column = [], []
    table_unit = _choose_unit(table)
    for index, column in enumerate(table.columns):
        cells = [row[index] for row in table.rows]
        unit = table_unit if column.align == "right" and _list_times(cells) else ""
        columns.append(replace(column, title=f"{column.title}, {'µs' if unit == 'us' else unit}") if unit else column)
        cells_by_column.append(
            [tuple(_convert_text(part, unit) for part in cell) if unit else print_inlines(cell) for cell in cells]
        )
    rows = tuple(tuple(column[row] for column in cells_by_column) for row in range(len(table.rows)))
    return replace(table, columns=tuple(columns), rows=rows)


def _list_times(cells: Iterable[Inlines]) -> list[Decimal]:
    return [
        Decimal(found[2]) * _TIME_FACTORS[found[3]]
        for cell in cells
        for part in cell
        if (found := _TIME_CELL.fullmatch(part.text))
    ]


def _choose_unit(table: Table) -> str:
    """Return the unit of all columns of times, that of their middle value; empty where there are none."""
    places = [index for index, column in enumerate(table.columns) if column.align == "right"]
    times = _list_times(row[index] for row in table.rows for index in places)
    if len(times) < _MIN_TIMES:
        return ""
    # Nothing at all takes no time in any unit.
    lengths = sorted(time for time in times if time) or [_TIME_FACTORS["ms"]]
    middle = lengths[(len(lengths) - 1) // 2]
    return next((unit for unit in ("s", "ms", "us") if middle >= _TIME_FACTORS[unit]), "ns")


def _convert_text(part: Text, unit: str) -> Text:
    found = _TIME_CELL.fullmatch(part.text)
    if not found:
        return replace(part, text=print_text(part.text, is_lower=part.is_lower))
    sign = found[1] or ""
    value = Decimal(found[2]) * _TIME_FACTORS[found[3]] / _TIME_FACTORS[unit]
    rounding_sign = sign or (">" if part.is_lower else "<")
    # As many digits as where the same time stands in a larger unit: 1.51 s for 1503 ms is 1510 ms.
    scale = Decimal(1).scaleb(max(value.adjusted() - 2, 0)) if value and unit != "s" else Decimal(1)
    rounded = Decimal(round_number(value / scale, rounding_sign)) * scale
    return replace(part, text=write_comparisons(f"{sign}{rounded:f}"))
