"""Blocks that stand apart on a page of the site, put together for paper: facts in one list, ports in one table."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from archgen.frozen import replace
from archgen.model.component import Component
from archgen.views import inline_text
from archgen.views.elements.functional_level import list_component_facts
from archgen.views.elements.port_tables import PortKind, list_port_cells
from archgen.views.lookup import Lookup
from archgen.views.shapes import (
    Block,
    Bullets,
    Column,
    Fact,
    FactRow,
    Facts,
    Figure,
    Inlines,
    Paragraph,
    Table,
    Text,
    drop_column,
    keep_columns,
)

_MIN_CONSTANT_ROWS = 3
"""From this many rows on, a column that says the same in all of them is said once, in the caption."""
_PORT_COLUMNS = (
    Column("Use", 0.3),
    Column("Port", 1.1),
    Column("Type", 1.2),
    Column("From / to", 2.0),
    Column("Inside", 1.4),
    Column("Medium", 0.7),
    Column("Remarks", 1.2),
)


def condense_component(lookup: Lookup, component: Component, blocks: Iterable[Block]) -> tuple[Block, ...]:
    """Put the blocks of a component together: text, facts, picture, one table of ports, what can be set and called."""
    texts: list[Block] = []
    figures: list[Block] = []
    rows: list[FactRow] = []
    last_tables: list[Block] = []
    pending_title = ""
    for block in blocks:
        match block:
            case Facts():
                rows += _list_printed_facts(lookup, component)
            case Figure():
                figures.append(block)
            case Table(kind="table:inputs" | "table:outputs"):
                pass
            case Table(kind="table:set" | "table:operations" | "table:components" as kind):
                is_inner = kind == "table:components"
                last_tables.append(drop_repeated_columns(drop_column(block, "nodes")) if is_inner else block)
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
    facts = [Facts(tuple(rows))] if rows else []
    return (*texts, *facts, *figures, *_make_port_tables(lookup, component), *last_tables)


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


def _list_printed_facts(lookup: Lookup, component: Component) -> Iterator[FactRow]:
    """Yield the facts of a component; its group is the chapter that it stands in, and its role stands beside its owner."""
    facts = list(list_component_facts(lookup, component))
    role = next((fact.value for fact in facts if fact.key == "role"), ())
    for fact in facts:
        if fact.key == "owner" and role:
            yield "Owner, role", (*fact.value, Text(", "), *role)
        elif fact.key not in {"group", "role"}:
            yield print_fact(fact)


def print_fact(fact: Fact) -> FactRow:
    """Return a fact as paper has it: nothing shows there that links lead elsewhere, and hosts have links too."""
    return "See also" if fact.key == "links" else fact.title, fact.value


def _make_port_tables(lookup: Lookup, component: Component) -> Iterator[Table]:
    """Yield inputs and outputs as one table, if there are any. A medium is said only where it is not digital."""
    uses: tuple[tuple[str, PortKind], ...] = (("in", "input"), ("out", "output"))
    rows = tuple(
        (
            inline_text.to_inlines(use),
            port.name,
            port.type,
            port.ends,
            port.inside,
            () if _join_texts(port.medium) == "digital" else port.medium,
            port.remarks,
        )
        for use, kind in uses
        for port in list_port_cells(lookup, component, kind)
    )
    if rows:
        table = Table(f"table:ports/{component.id}", f"Ports of {component.title}", _PORT_COLUMNS, rows)
        yield drop_repeated_columns(table, kept_columns=4)


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
    return replace(keep_columns(table, kept_indices), caption="; ".join((table.caption, *remarks)))


def _join_texts(cell: Inlines) -> str:
    return "".join(part.text for part in cell)
