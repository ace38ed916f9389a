"""The functional level in documents: what groups and components are for, what they read and what they publish."""

from __future__ import annotations

import re
from fractions import Fraction

from archgen.model.component import Component, Group, Input, Output
from archgen.views import inline_text
from archgen.views.elements.parameter_blocks import make_parameter_blocks
from archgen.views.lookup import Lookup
from archgen.views.shapes import (
    Block,
    Bullets,
    Column,
    Facts,
    Figure,
    Inlines,
    Markdown,
    Paragraph,
    Table,
    Text,
    drop_empty_columns,
)
from archgen.views.timing import element_timing


def make_group_blocks(lookup: Lookup, group: Group) -> tuple[Block, ...]:
    """Describe a group: its owner, its purpose, its picture and its components."""
    components = lookup.shown_components(group.id)
    blocks: list[Block] = [Facts(tuple(_group_facts(lookup, group)))]
    if group.description:
        blocks.append(Markdown(group.description))
    blocks.append(
        # The figure is always named; site and report drop the figures that were not drawn (`keep_drawn`).
        Figure(
            f"figure:groups/{group.id}",
            f"groups/{group.id}",
            f"{group.title}: components and neighbours",
            f"The components of {group.title} with the flows between them and to neighbouring components.",
        )
    )
    if components:
        blocks.append(
            make_component_table(lookup, f"table:components/{group.id}", f"Components of {group.title}", components)
        )
    else:
        blocks.append(Paragraph(inline_text.to_inlines(Text("This group has no components yet.", muted=True))))
    return tuple(blocks)


def _group_facts(lookup: Lookup, group: Group) -> list[tuple[str, Inlines]]:
    rows = [("Owner", inline_text.owner_links(lookup.architecture, group.owners))]
    rows.append(("Components", inline_text.to_inlines(str(len(group.components)))))
    if group.tags:
        rows.append(("Tags", inline_text.to_inlines(", ".join(group.tags))))
    if group.urls:
        rows.append(("Links", inline_text.link_urls(group.urls.items())))
    return rows


def make_component_table(lookup: Lookup, anchor: str, caption: str, components: list[Component]) -> Table:
    """List components with their purpose, role and nodes."""
    rows = tuple(
        (
            inline_text.to_inlines(inline_text.component_link(component)),
            inline_text.value_or_unknown(first_sentence(component.functionality)),
            inline_text.value_or_unknown(component.role),
            inline_text.join_inlines((inline_text.node_link(node),) for node in lookup.nodes_of.get(component.id, ()))
            or inline_text.UNKNOWN_INLINES,
        )
        for component in components
    )
    columns = (Column("Component", 1.1), Column("Purpose", 2.4), Column("Role", 0.6), Column("Nodes", 1.1))
    return Table(anchor, caption, columns, rows)


def first_sentence(markdown: str | None) -> str | None:
    """Return the first sentence of a Markdown text without its emphasis marks; None for no text."""
    if not markdown:
        return None
    line = " ".join(markdown.split("\n\n")[0].split())
    # A full stop counts only before a blank or the end, so that "0.5 m" and "ROS2.x" stay whole.
    end = next((i for i, c in enumerate(line) if c in ".!?" and line[i + 1 : i + 2] in {"", " "}), len(line) - 1)
    return line[: end + 1].replace("**", "").replace("`", "")


def make_component_blocks(lookup: Lookup, component: Component) -> tuple[Block, ...]:
    """Describe a component: facts, functionality, picture, requirements, performance, ports, parameters, operations."""
    blocks: list[Block] = [
        Facts(tuple(_component_facts(lookup, component))),
        Markdown(component.functionality)
        if component.functionality
        else Paragraph(inline_text.to_inlines(Text("What it does is not described yet.", muted=True))),
    ]
    if component.description:
        blocks.append(Markdown(component.description))
    blocks.append(
        Figure(
            f"figure:components/{component.id}",
            f"components/{component.id}",
            f"{component.title}: inputs and outputs",
            f"{component.title} with its inputs at the left and its outputs at the right.",
        )
    )
    blocks += _requirement_blocks(lookup, component)
    blocks += _performance_blocks(component)
    blocks += _input_blocks(lookup, component)
    blocks += _output_blocks(lookup, component)
    blocks += make_parameter_blocks(component)
    return tuple(blocks)


def _component_facts(lookup: Lookup, component: Component) -> list[tuple[str, Inlines]]:
    """Return the facts above a component's description."""
    architecture = lookup.architecture
    rows = [
        ("Group", inline_text.to_inlines(inline_text.group_link(architecture, component.group))),
        ("Owner", inline_text.owner_links(architecture, component.owners)),
        ("Role", inline_text.value_or_unknown(component.role)),
    ]
    timing = inline_text.format_timing_sentence(component.timing)
    if timing:
        rows.append(("Timing", inline_text.to_inlines(timing)))
    nodes = lookup.nodes_of.get(component.id, ())
    if rate := element_timing.make_rate_fact(lookup, nodes, component.id):
        rows.append(("Rate", rate))
    rows.append(
        (
            "Implemented by",
            inline_text.join_inlines((inline_text.node_link(node),) for node in nodes) or inline_text.UNKNOWN_INLINES,
        )
    )
    if written_frames := lookup.frames_of.get(component.id):
        rows.append(("Writes the frames", inline_text.join_inlines(_link_frame(frame.id) for frame in written_frames)))
    if component.tags:
        rows.append(("Tags", inline_text.to_inlines(", ".join(component.tags))))
    if component.urls:
        rows.append(("Links", inline_text.link_urls(component.urls.items())))
    return rows


def _link_frame(name: str) -> Inlines:
    return (Text(name, ref=f"frame:{name}", code=True),)


def _requirement_blocks(lookup: Lookup, component: Component) -> list[Block]:
    # `requirements: []` states that there are none, a missing key that nobody knows yet; inputs and outputs likewise.
    if not component.requirements:
        message = "It serves no requirement." if component.requirements_known else "Its requirements are not known yet."
        return [Paragraph(inline_text.to_inlines(Text("Requirements. ", strong=True), Text(message, muted=True)))]
    items = tuple(
        inline_text.requirement_link(lookup.architecture, use.text) if use.is_id else inline_text.to_inlines(use.text)
        for use in component.requirements
    )
    return [Paragraph(inline_text.to_inlines(Text("Requirements", strong=True))), Bullets(items)]


def _performance_blocks(component: Component) -> list[Block]:
    if not component.performance:
        return [
            Paragraph(inline_text.to_inlines(Text("Performance. ", strong=True), Text("Not known yet.", muted=True)))
        ]
    rows = tuple(
        (
            inline_text.to_inlines(indicator.title),
            _accuracy_cell(indicator.accuracy),
            inline_text.quantity_to_inlines(indicator.execution_time),
        )
        for indicator in component.performance
    )
    columns = (Column("Indicator"), Column("Accuracy", 1.5), Column("Execution time"))
    return [Table(f"table:performance/{component.id}", f"{component.title}: performance", columns, rows)]


def _accuracy_cell(accuracy: str | None) -> Inlines:
    """Return an accuracy as it was written; one that is a share sorts by it."""
    percentage = re.match(r"([0-9]+(?:\.[0-9]+)?) ?%", accuracy or "", re.ASCII)
    if accuracy is None or percentage is None:
        return inline_text.value_or_unknown(accuracy)
    return (Text(accuracy, sort_number=str(Fraction(percentage[1]) / 100)),)


def _input_blocks(lookup: Lookup, component: Component) -> list[Block]:
    if not component.inputs:
        message = "It has no inputs." if component.inputs_known else "Its inputs are not known yet."
        return [Paragraph(inline_text.to_inlines(Text("Inputs. ", strong=True), Text(message, muted=True)))]
    rows = tuple(
        (
            _port_name(port),
            _source_cell(lookup, port),
            _input_type_cell(lookup, port),
            _medium_cell(port),
            _remarks_cell(lookup, port),
        )
        for port in component.inputs.values()
    )
    columns = (Column("Input"), Column("From", 1.9), Column("Type", 1.2), Column("Medium", 0.8), Column("Remarks", 1.3))
    table = Table(f"table:inputs/{component.id}", f"{component.title}: inputs", columns, rows)
    return [drop_empty_columns(table)]


def _output_blocks(lookup: Lookup, component: Component) -> list[Block]:
    if not component.outputs:
        message = "It has no outputs." if component.outputs_known else "Its outputs are not known yet."
        return [Paragraph(inline_text.to_inlines(Text("Outputs. ", strong=True), Text(message, muted=True)))]
    rows = tuple(
        (
            _port_name(port),
            inline_text.type_link(port.type),
            _reader_cell(lookup, port),
            _medium_cell(port),
            _remarks_cell(lookup, port),
        )
        for port in component.outputs.values()
    )
    columns = (Column("Output"), Column("Type", 1.2), Column("To", 1.9), Column("Medium", 0.8), Column("Remarks", 1.3))
    table = Table(f"table:outputs/{component.id}", f"{component.title}: outputs", columns, rows)
    return [drop_empty_columns(table)]


def _port_name(port: Input | Output) -> Inlines:
    return inline_text.to_inlines(Text(port.name, code=True))


def _source_cell(lookup: Lookup, port: Input) -> Inlines:
    """Return the sources of an input, one on each line, with partners other than the component's own."""
    sources = [
        (
            *inline_text.describe_source(lookup.architecture, connection),
            *_other_owners(lookup, port.component, connection.outputs),
        )
        for connection in port.connections
    ]
    if port.external:
        sources.append(inline_text.to_inlines(Text("outside: ", muted=True), port.external))
    return inline_text.join_lines(sources) or inline_text.UNKNOWN_INLINES


def _other_owners(lookup: Lookup, component_id: str, output_ids: tuple[str, ...]) -> Inlines:
    """Return the owners of the outputs who do not own the component, in brackets; empty where there are none."""
    architecture = lookup.architecture
    own_partners = architecture.components[component_id].owners
    owners = dict.fromkeys(
        p for o in output_ids for p in architecture.components[architecture.outputs[o].component].owners
    )
    # Only a flow that crosses from one partner to another names them: the component's own are in its facts.
    other_partners = [owner for owner in owners if owner not in own_partners]
    return (
        (
            Text(" ("),
            *inline_text.join_inlines(inline_text.partner_link(architecture, o) for o in other_partners),
            Text(")"),
        )
        if other_partners
        else ()
    )


def _input_type_cell(lookup: Lookup, port: Input) -> Inlines:
    """Return the types of an input: its own first, then those of the outputs it reads."""
    outputs = (lookup.architecture.outputs[o] for connection in port.connections for o in connection.outputs)
    types = dict.fromkeys([port.type, *(output.type for output in outputs)] if port.type else (o.type for o in outputs))
    return (
        inline_text.join_inlines(inline_text.type_link(name) for name in types if name) or inline_text.UNKNOWN_INLINES
    )


def _reader_cell(lookup: Lookup, port: Output) -> Inlines:
    """Return the readers of an output, one on each line."""
    architecture = lookup.architecture
    readers = [architecture.inputs[connection.input] for connection in lookup.readers_of.get(port.id, ())]
    cells = [
        (*inline_text.port_link(architecture, reader), *_reader_owners(lookup, port, reader)) for reader in readers
    ]
    if port.external:
        cells.append(inline_text.to_inlines(Text("outside: ", muted=True), port.external))
    return inline_text.join_lines(cells) or inline_text.to_inlines(Text("nobody yet", muted=True))


def _reader_owners(lookup: Lookup, port: Output, reader: Input) -> Inlines:
    """Return the owners of a reader who do not own the output's component, in brackets."""
    architecture = lookup.architecture
    own_partners = architecture.components[port.component].owners
    other_partners = [owner for owner in architecture.components[reader.component].owners if owner not in own_partners]
    return (
        (
            Text(" ("),
            *inline_text.join_inlines(inline_text.partner_link(architecture, o) for o in other_partners),
            Text(")"),
        )
        if other_partners
        else ()
    )


def _medium_cell(port: Input | Output) -> Inlines:
    return inline_text.to_inlines("physical" if port.physical else "digital")


def _remarks_cell(lookup: Lookup, port: Input | Output) -> Inlines:
    optional = "optional" if isinstance(port, Input) and port.optional else ""
    # Only what is written of the port itself: the table of types would say the rest again and again.
    name = port.frame
    is_known = name in lookup.architecture.frames
    frame = (Text("in the frame "), *(_link_frame(name) if is_known else (Text(name, code=True),))) if name else ()
    parts = [inline_text.to_inlines(optional), frame, inline_text.to_inlines(port.description or "")]
    return inline_text.join_inlines((part for part in parts if any(run.text for run in part)), "; ")
