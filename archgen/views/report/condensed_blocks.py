"""Blocks that stand apart on a page of the site, put together for paper: facts in one list, ports in one table."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator, Sequence

from archgen.views import inline_text
from archgen.views.shapes import Block, Bullets, Column, Facts, Figure, Inlines, Paragraph, Table, Text

FactRow = tuple[str, Inlines]
_MIN_CONSTANT_ROWS = 3
"""From this many rows on, a column that says the same in all of them is said once, in the caption."""
_PORT_COLUMNS = (
    Column("Port", 1.1),
    Column("Type", 1.2),
    Column("From / to", 2.0),
    Column("Inside", 1.4),
    Column("Medium", 0.7),
    Column("Remarks", 1.2),
)
_MEDIUM = 4
"""The place of the medium among them."""


def condense_component(blocks: Iterable[Block], title: str, component_id: str) -> tuple[Block, ...]:
    """Put the blocks of a component together: text, facts, picture, one table of ports, what can be set and called."""
    texts: list[Block] = []
    figures: list[Block] = []
    rows: list[FactRow] = []
    port_tables: list[tuple[str, Table]] = []
    last_tables: list[Block] = []
    pending_title = ""
    for block in blocks:
        match block:
            case Facts():
                rows += block.rows
            case Figure():
                figures.append(block)
            case Table() if block.anchor.startswith(("table:inputs/", "table:outputs/")):
                port_tables.append(("in" if block.anchor.startswith("table:inputs/") else "out", block))
            case Table() if block.anchor.startswith(("table:set/", "table:operations/", "table:components/")):
                last_tables.append(drop_repeated_columns(block) if "components/" in block.anchor else block)
            case Table():
                rows.append(("Performance", inline_text.join_lines(_phrase_row(block, row) for row in block.rows)))
            case Bullets():
                rows.append((pending_title, inline_text.join_lines(block.items)))
            case Paragraph() if _is_title(block):
                pending_title = block.inlines[0].text
            case Paragraph() if (row := _read_fact(block)) is not None:
                rows.append(row)
            case _:
                texts.append(block)
    facts = Facts(tuple(_order_component_facts(rows)))
    ports = [_join_ports(port_tables, f"table:ports/{component_id}", f"Ports of {title}")] if port_tables else []
    return (*texts, *([facts] if facts.rows else []), *figures, *ports, *last_tables)


def _is_title(paragraph: Paragraph) -> bool:
    """Whether a paragraph is nothing but the title of the list that follows."""
    return len(paragraph.inlines) == 1 and paragraph.inlines[0].strong


def _read_fact(paragraph: Paragraph) -> FactRow | None:
    """Return a paragraph that begins with its title in bold as a fact: `Inputs`, "It has no inputs."."""
    first, *others = paragraph.inlines
    if not first.strong or not first.text.endswith(". "):
        return None
    return first.text.removesuffix(". "), tuple(others)


def _phrase_row(table: Table, row: Sequence[Inlines]) -> Inlines:
    """Write a row of a table as a phrase: `Response: 95 %, execution time 20 ms`."""
    name, *values = row
    parts = [
        inline_text.to_inlines(f"{column.title.lower()} ", *value)
        for column, value in zip(table.columns[1:], values, strict=True)
        if value and value != inline_text.UNKNOWN_INLINES
    ]
    return (*name, Text(": "), *inline_text.join_inlines(parts)) if parts else name


def _order_component_facts(rows: Sequence[FactRow]) -> Iterator[FactRow]:
    """Yield the facts of a component; its group is the chapter that it stands in, and its role stands beside its owner."""
    role = next((value for name, value in rows if name == "Role"), ())
    for name, value in rows:
        if name == "Owner" and role:
            yield "Owner, role", (*value, Text(", "), *role)
        elif name not in {"Group", "Role"}:
            yield name, value


def _join_ports(tables: Sequence[tuple[str, Table]], anchor: str, caption: str) -> Table:
    """Return inputs and outputs as one table. A medium is said only where it is not digital."""
    rows, anchors = [], []
    for use, table in tables:
        titles = {"Input": "Port", "Output": "Port", "From": "From / to", "To": "From / to"}
        titles |= {"Read inside by": "Inside", "Given on from": "Inside"}
        places = {titles.get(column.title, column.title): index for index, column in enumerate(table.columns)}
        row_anchors = (*table.row_anchors, *(None for _ in table.rows))
        for row, row_anchor in zip(table.rows, row_anchors, strict=False):
            cells = [row[places[column.title]] if column.title in places else () for column in _PORT_COLUMNS]
            cells[_MEDIUM] = () if _join_texts(cells[_MEDIUM]) == "digital" else cells[_MEDIUM]
            rows.append((inline_text.to_inlines(use), *cells))
            anchors.append(row_anchor)
    columns = (Column("Use", 0.3), *_PORT_COLUMNS)
    return drop_repeated_columns(Table(anchor, caption, columns, tuple(rows), tuple(anchors)), kept_columns=4)


def drop_repeated_columns(table: Table, kept_columns: int = 1) -> Table:
    """Drop columns that are empty, and those that say the same in each of several rows, which the caption says instead.

    The first `kept_columns` stay, whatever they say.
    """
    remarks, kept_indices = [], []
    for index, column in enumerate(table.columns):
        texts = list(dict.fromkeys(_join_texts(row[index]) for row in table.rows))
        if index < kept_columns or ((len(texts) > 1 or len(table.rows) < _MIN_CONSTANT_ROWS) and texts != [""]):
            kept_indices.append(index)
        elif texts != [""]:
            remarks.append(f"{column.title} of all: {texts[0]}")
    return dataclasses.replace(
        table,
        caption="; ".join((table.caption, *remarks)),
        columns=tuple(table.columns[index] for index in kept_indices),
        rows=tuple(tuple(row[index] for index in kept_indices) for row in table.rows),
    )


def _join_texts(cell: Inlines) -> str:
    return "".join(part.text for part in cell)
