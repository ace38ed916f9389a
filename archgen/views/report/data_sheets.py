"""One page a component, each partner's apart: what it is, what it takes in and gives out, its chains, what is open."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice

from archgen.grouping import group_pairs
from archgen.model.component import Component
from archgen.views import inline_text
from archgen.views.element_readers import list_reliance
from archgen.views.elements.functional_level import (
    make_functionality_block,
    make_performance_blocks,
    make_requirement_blocks,
)
from archgen.views.elements.parameter_blocks import make_parameter_blocks
from archgen.views.elements.port_tables import PortCells, list_port_cells
from archgen.views.lookup import Lookup
from archgen.views.pages import report_outline
from archgen.views.pages.report_outline import DocumentEdition
from archgen.views.report import front_pages
from archgen.views.report.condensed_blocks import condense_node_facts, set_small
from archgen.views.report.printed_figures import print_section_figures
from archgen.views.report.report_drawings import make_report_drawings
from archgen.views.sequences.sequence_blocks import link_use_cases
from archgen.views.shapes import (
    Block,
    Bullets,
    FactRow,
    Figure,
    Inlines,
    Outline,
    Paragraph,
    Section,
    Table,
    Text,
    drop_empty_columns,
    make_columns,
    show_known,
)
from archgen.views.tables import finding_tables
from archgen.views.timing.flow_tables import (
    FlowRow,
    list_activities,
    list_flow_rows,
    list_time_left,
    make_chain_share_table,
)

Sheets = list[tuple[str, Component]]
"""Components with the numbers of their sheets: `7.3`."""
_MAX_PICTURE_ROWS = 8
"""With more rows in its tables a sheet has no room for a picture."""
_MAX_ROWS = 12
"""With more flows a sheet has no room for what the site and the workbook say of a component beside them."""
_MAX_FINDINGS = 5
_RELIANCE = "What rests on it"


def number_sheets(lookup: Lookup) -> Mapping[str, Sheets]:
    """Return the data sheets by the title of the partner whose they are; what nobody owns comes last."""
    partners = lookup.architecture.partners
    owned: dict[str, list[Component]] = {name: [] for name in (*partners, "")}
    for component in lookup.nested_components():
        if component.id in lookup.architecture.components:
            owner = component.owner if component.owner in partners else ""
            owned[owner or ""].append(component)
    titles = {name: partner.title for name, partner in partners.items()}
    titles[""] = "Without a partner" if partners else "Components"
    present = [(titles[name], components) for name, components in owned.items() if components]
    return {
        title: [(f"{chapter}.{at}", component) for at, component in enumerate(components, 1)]
        for chapter, (title, components) in enumerate(present, 1)
    }


def make_data_sheets(lookup: Lookup, edition: DocumentEdition) -> Outline:
    """Make the outline of the data sheets, a chapter for each partner."""
    drawings = make_report_drawings(lookup, edition.drawings, shows_ros=False)
    edition = dataclasses.replace(edition, drawings=drawings)
    sections = tuple(
        Section(
            f"sheets:{title}",
            title,
            (),
            tuple(
                _make_sheet(lookup, edition, component, is_first=at == 0) for at, (_, component) in enumerate(sheets)
            ),
            page_break=True,
        )
        for title, sheets in number_sheets(lookup).items()
    )
    return Outline(
        title=lookup.architecture.project.title,
        subtitle="Data sheets of the components",
        front_sections=tuple(map(print_section_figures, front_pages.make_front_sections(lookup, edition, None))),
        facts=front_pages.make_title_facts(lookup, edition),
        notices=report_outline.make_notices(lookup, edition),
        sections=tuple(map(print_section_figures, sections)),
        properties=front_pages.list_properties(lookup, edition),
        lists=(),
        has_large_paper=False,
        has_narrow_margins=True,
    )


def _make_sheet(lookup: Lookup, edition: DocumentEdition, component: Component, *, is_first: bool) -> Section:
    blocks = tuple(_list_blocks(lookup, edition, component))
    return Section(f"component:{component.id}", component.title, blocks, page_break=not is_first)


def _list_blocks(lookup: Lookup, edition: DocumentEdition, component: Component) -> Iterator[Block]:
    nodes = lookup.nodes_of.get(component.id, ()) if edition.level == "implementation" else ()
    activities = list_activities(lookup, nodes, component.id)
    tables = list(_list_flow_tables(lookup, component, list_flow_rows(lookup, activities)))
    is_full = sum(len(table.rows) for table in tables) > _MAX_ROWS
    yield make_functionality_block(component)
    left_out = ("Takes part in", "Performance", _RELIANCE) if is_full else ()
    time_left = inline_text.join_lines(list_time_left(lookup, activities))
    facts = (*_list_facts(lookup, component), ("How long it may take", time_left))
    yield show_known(fact for fact in facts if fact[0] not in left_out)
    if chains := make_chain_share_table(lookup, component.id, component.title, activities):
        tables.append(set_small(chains))
    tables += [set_small(each) for each in make_parameter_blocks(component) if isinstance(each, Table)]
    name = f"components/{component.id}"
    if name in edition.drawings and sum(len(table.rows) for table in tables) <= _MAX_PICTURE_ROWS:
        drawing = edition.drawings[name]
        yield Figure(f"figure:{name}", drawing.id, drawing.title, drawing.alt, numbered=False)
    for table in tables:
        yield Paragraph(inline_text.to_inlines(Text(table.caption, strong=True)))
        yield table
    if findings := lookup.findings_of.get(component.id, ()):
        items = tuple(
            (*finding_tables.finding_chip(each), Text(" "), *inline_text.message_to_inlines(each.message))
            for each in findings[:_MAX_FINDINGS]
        )
        yield Paragraph(inline_text.to_inlines(Text("Open", strong=True)))
        yield Bullets(items)
        if len(findings) > _MAX_FINDINGS:
            yield Paragraph(inline_text.to_inlines(f"{len(findings) - _MAX_FINDINGS} more stand in the workbook."))
    changes = edition.changes.changes_by_page.get(f"component:{component.id}", ()) if edition.changes else ()
    if changes and edition.changes:
        words = "; ".join(change.text for change in changes[:_MAX_FINDINGS])
        lead = Text(f"Since {edition.changes.since}: ", strong=True)
        yield Paragraph((lead, *inline_text.message_to_inlines(f"{words}.")))


def _list_facts(lookup: Lookup, component: Component) -> Iterator[FactRow]:
    """Yield what a component is, where its nodes run and how fast they are, and what it serves."""
    architecture = lookup.architecture
    group = inline_text.to_inlines(architecture.groups[component.group].title)
    words = ", ".join(filter(None, (component.role, component.status)))
    yield (
        "Group, owner",
        (
            *group,
            Text(", "),
            *inline_text.owner_links(architecture, component.owners),
            Text(f"; {words}" if words else ""),
        ),
    )
    for node in lookup.nodes_of.get(component.id, ()):
        yield from condense_node_facts(lookup, node, component)
    yield "Takes part in", link_use_cases(lookup, component.id)
    items = [block for block in make_requirement_blocks(lookup, component) if isinstance(block, Bullets)]
    # By their ids, where they have some: the deliverable has their words.
    runs = (item[:1] if item[0].ref else item for block in items for item in block.items)
    yield "Requirements", inline_text.join_inlines(runs)
    for table in make_performance_blocks(component):
        if isinstance(table, Table):
            yield "Performance", inline_text.join_lines(map(_phrase_row, table.rows))
    # In a line: a sheet is a page, and its table names who reads from it.
    yield _RELIANCE, inline_text.join_inlines(islice(list_reliance(lookup, component, 1), 2), "; ")


def _phrase_row(row: Sequence[Inlines]) -> Inlines:
    return inline_text.join_inlines((cell for cell in row if cell and cell != inline_text.UNKNOWN_INLINES), ", ")


def _list_flow_tables(
    lookup: Lookup, component: Component, rows: tuple[Sequence[FlowRow], Sequence[FlowRow]]
) -> Iterator[Table]:
    """Yield the tables of inputs and outputs. A flow stands at its port, whichever way its requests run."""
    taken, given = (group_pairs((row.port, row) for row in each) for each in rows)
    for kind, own, other in (("input", taken, given), ("output", given, taken)):
        ports = component.inputs if kind == "input" else component.outputs
        others = component.outputs if kind == "input" else component.inputs
        crossing = {name: other.pop(name) for name in ports if name in other and name not in own}
        staying = {name: each for name, each in own.items() if name in ports or name not in others}
        if table := _make_flow_table(lookup, component, kind, staying | crossing):
            yield table


def _make_flow_table(lookup: Lookup, component: Component, kind: str, flows: dict[str, list[FlowRow]]) -> Table | None:
    """List the ports with a row for each flow, as the page of the component has it; a port without a flow with its ends."""
    cells: list[tuple[Inlines, ...]] = []
    for port in list_port_cells(lookup, component, "input" if kind == "input" else "output"):
        own = flows.pop(port.name[0].text, [])
        cells += [_write_flow(port, row, is_first=at == 0) for at, row in enumerate(own)]
        if not own:
            cells.append(
                (port.name, port.type, port.ends, (), (), (), () if port.medium[0].text == "digital" else port.medium)
            )
    cells += [
        ((Text("internal" if name.startswith("/") else name, muted=True),), *_write_figures(row, row.type))
        for name, own in flows.items()
        for row in own
    ]
    words = ("Takes in", "From") if kind == "input" else ("Gives out", "To")
    columns = make_columns(
        ("Port", 1),
        ("Type, topic", 2.1),
        (words[1], 1.9),
        ("Rate", 0.7, "right"),
        ("Gap ≤", 0.65, "right"),
        ("Age ≤", 0.65, "right"),
        ("How it is read", 2),
    )
    table = Table(f"table:{kind}s/{component.id}", words[0], columns, tuple(cells), numbered=False, dense=True)
    return drop_empty_columns(table) if cells else None


def _write_flow(port: PortCells, row: FlowRow, *, is_first: bool) -> tuple[Inlines, ...]:
    return (port.name if is_first else (), *_write_figures(row, row.type or port.type))


def _write_figures(row: FlowRow, type_cell: Inlines) -> tuple[Inlines, ...]:
    # The message is that of the type: the topic alone stands below it.
    topic = row.topic[:1]
    what = inline_text.join_lines((type_cell, topic))
    reading = inline_text.to_inlines(row.reading)
    return what, row.other, row.rate, row.gap, row.age, reading
