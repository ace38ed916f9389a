"""The ports of components in documents: where each input comes from, and who reads each output."""

from __future__ import annotations

from archgen.model.component import Component, Input, Output
from archgen.model.component_nesting import find_component
from archgen.model.port_media import label_of_medium
from archgen.views import inline_marks, inline_text
from archgen.views.elements import promise_words
from archgen.views.elements.annotation_facts import list_annotation_facts
from archgen.views.lookup import Lookup
from archgen.views.shapes import Block, Column, Inlines, Paragraph, Table, Text, drop_empty_columns


def make_input_blocks(lookup: Lookup, component: Component) -> list[Block]:
    """Return the table of a component's inputs, or a sentence that it has none."""
    if not component.inputs:
        message = "It has no inputs." if component.inputs_known else "Its inputs are not known yet."
        return [Paragraph(inline_text.to_inlines(Text("Inputs. ", strong=True), Text(message, muted=True)))]
    rows = tuple(
        (
            _port_name(port),
            make_source_cell(lookup, port),
            make_input_type_cell(lookup, port),
            _medium_cell(port),
            _remarks_cell(lookup, port),
        )
        for port in component.inputs.values()
    )
    columns = (Column("Input"), Column("From", 1.9), Column("Type", 1.2), Column("Medium", 0.8), Column("Remarks", 1.3))
    table = Table(f"table:inputs/{component.id}", f"{component.title}: inputs", columns, rows)
    return [drop_empty_columns(table)]


def make_output_blocks(lookup: Lookup, component: Component) -> list[Block]:
    """Return the table of a component's outputs, or a sentence that it has none."""
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
    badges = promise_words.write_badges(port) if isinstance(port, Output) else ()
    return inline_text.to_inlines(Text(port.name, code=True), *badges)


def make_source_cell(lookup: Lookup, port: Input) -> Inlines:
    """Return the sources of an input, one on each line, with partners other than the component's own."""
    sources = [
        (
            *inline_text.describe_source(lookup.architecture, connection),
            *promise_words.mark_source(lookup, connection),
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
    own_partners = find_component(architecture, component_id).owners
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


def make_last_cells(lookup: Lookup, port: Input | Output) -> tuple[Inlines, Inlines]:
    """Return the medium of a port, and the remarks on it."""
    return _medium_cell(port), _remarks_cell(lookup, port)


def make_input_type_cell(lookup: Lookup, port: Input) -> Inlines:
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
    return inline_text.to_inlines(label_of_medium(port) or "digital")


def _remarks_cell(lookup: Lookup, port: Input | Output) -> Inlines:
    optional = "optional" if isinstance(port, Input) and port.optional else ""
    # Only what is written of the port itself: the table of types would say the rest again and again.
    name = port.frame
    is_known = name in lookup.architecture.frames
    link = inline_text.frame_link(name) if name and is_known else (Text(name or "", code=True),)
    frame = (Text("in the frame "), *link) if name else ()
    words = promise_words.write_remarks(lookup.architecture, port) if isinstance(port, Output) else ()
    fresh = f"no older than {port.freshness}" if isinstance(port, Input) and port.freshness else ""
    parts = [
        inline_text.to_inlines(optional),
        inline_text.to_inlines(fresh),
        frame,
        *words,
        inline_marks.read_marks(port.description or ""),
        inline_text.link_urls(port.urls.items(), lookup.repository),
        *(facts for _, facts in list_annotation_facts(lookup, port)),
    ]
    return inline_text.join_inlines((part for part in parts if any(run.text for run in part)), "; ")
