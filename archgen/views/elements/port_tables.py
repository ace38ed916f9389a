"""The ports of components in documents: where each input comes from, who reads each output, what it promises, and what
stands behind those of composed ones.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Literal

from archgen.frozen import NamedTuple
from archgen.model.architecture import Architecture
from archgen.model.component import Component, ComponentType, Connection, Input, Output
from archgen.model.component_nesting import find_component, find_relied_output
from archgen.model.deprecation_lookup import find_replacement
from archgen.model.message_types import ConceptualType
from archgen.model.node import Topic
from archgen.model.port_media import label_of_medium
from archgen.model.promise import Promise, describe_deprecation, format_range
from archgen.views import inline_text
from archgen.views.elements.annotation_facts import list_annotation_facts
from archgen.views.lookup import Lookup
from archgen.views.shapes import Block, Column, Inlines, Paragraph, Table, Text, drop_empty_columns
from archgen.views.type_names import type_page_link

_BADGE: Inlines = (Text(" "), Text("deprecated", status="warning"))


def describe_promise(promise: Promise | None) -> str:
    """Return what is promised on one line: `10 Hz, gaps up to 150 ms, 0 to 30 m`; empty for nothing."""
    if promise is None:
        return ""
    values = (
        str(promise.rate) if promise.rate else "",
        f"gaps up to {promise.max_gap}" if promise.max_gap else "",
        f"no older than {promise.max_age}" if promise.max_age else "",
        format_range(promise.range, promise.unit) if promise.range else f"in {promise.unit}" if promise.unit else "",
        f"in the frame {promise.frame}" if promise.frame else "",
    )
    return ", ".join(filter(None, values))


def list_card_facts(holder: Output | ConceptualType | ComponentType) -> Iterator[tuple[str, str]]:
    """Yield the facts of a card: promise, version, deprecation; what is not said is empty."""
    if isinstance(holder, Output):
        yield "promise", describe_promise(holder.promise)
    yield "version", holder.version or ""
    yield "deprecated", describe_deprecation(holder.deprecated) if holder.deprecated else ""


def list_text_remarks(holder: Output | ConceptualType | ComponentType) -> Iterator[str]:
    """Yield version and deprecation as plain text, for lists and search."""
    if holder.version:
        yield f"version {holder.version}"
    if holder.deprecated:
        yield f"deprecated ({describe_deprecation(holder.deprecated)})"


def write_badges(holder: Output | ConceptualType | ComponentType) -> Inlines:
    """Return what stands behind a name: its version, and a badge where it is going away."""
    version = (Text(f" version {holder.version}", muted=True),) if holder.version else ()
    return (*version, *write_badge(holder))


def write_badge(holder: Output | ConceptualType | ComponentType) -> Inlines:
    """Return a badge where something is going away."""
    return _BADGE if holder.deprecated else ()


def _write_remarks(architecture: Architecture, port: Output) -> Iterator[Inlines]:
    """Yield what is said of an output in the column of remarks."""
    if port.promise:
        yield inline_text.to_inlines(f"promised: {describe_promise(port.promise)}")
    if port.deprecated:
        yield write_deprecation(architecture, "output", port)


def write_deprecation(
    architecture: Architecture, kind: str, holder: Output | ConceptualType | ComponentType
) -> Inlines:
    """Return until when something may be used, and a link to what replaces it in the end."""
    deprecated = holder.deprecated
    if deprecated is None:
        return ()
    until = f"until {deprecated.until}" if deprecated.until else ""
    replacement = find_replacement(architecture, kind, deprecated)
    if replacement is None:
        return inline_text.to_inlines(f"deprecated {until}".rstrip())
    link: Inlines = (Text(replacement, code=True),)
    if kind == "type":
        link = inline_text.type_link(replacement)
    elif kind == "component_type":
        component_type = architecture.component_types.get(replacement)
        link = (type_page_link(component_type),) if component_type else link
    else:
        component = architecture.find_component(replacement.rpartition(".")[0])
        output = component.outputs.get(replacement.rpartition(".")[2]) if component else None
        if output is not None and isinstance(holder, Output):
            is_near = output.component == holder.component
            link = (Text(output.name, code=True),) if is_near else inline_text.port_link(architecture, output)
    return inline_text.to_inlines(f"deprecated {until}: use ".replace(" :", ":"), *link)


def list_topic_facts(architecture: Architecture, topic: Topic) -> Iterator[tuple[str, Inlines]]:
    """Yield what the outputs on a topic promise, their versions, and until when they may be used; nothing for none."""
    outputs = [
        output
        for name in dict.fromkeys(endpoint.port for endpoint in topic.writers if endpoint.port)
        if (output := architecture.outputs.get(name)) is not None
    ]
    described: tuple[tuple[str, Callable[[Output], Inlines]], ...] = (
        ("Promised", lambda each: inline_text.to_inlines(describe_promise(each.promise)) if each.promise else ()),
        ("Version", lambda each: inline_text.to_inlines(each.version)),
        ("Deprecated", lambda each: write_deprecation(architecture, "output", each)),
    )
    for name, describe in described:
        lines = [line for output in outputs if (line := describe(output))]
        yield name, inline_text.join_lines(dict.fromkeys(lines))


def _mark_source(lookup: Lookup, connection: Connection) -> Inlines:
    """Return a badge where what a connection names is going away."""
    architecture = lookup.architecture
    for output_id in connection.outputs:
        leaf = architecture.outputs.get(output_id)
        port = find_relied_output(architecture, connection, leaf) if leaf else None
        if port is not None and port.deprecated is not None:
            return _BADGE
    return ()


PortKind = Literal["input", "output"]


class PortCells(NamedTuple):
    """What documents say of a port: `ends` where an input comes from and who reads an output, `inside` what stands behind
    the port of a composed component.
    """

    name: Inlines
    ends: Inlines
    type: Inlines
    inside: Inlines
    medium: Inlines
    remarks: Inlines


def list_port_cells(lookup: Lookup, component: Component, kind: PortKind) -> list[PortCells]:
    """Return what is said of each input or output of a component, composed or not."""
    shell = lookup.architecture.shells.get(component.id)
    if kind == "input":
        return [
            PortCells(
                inline_text.to_code(port.name),
                _source_cell(lookup, port),
                _input_type_cell(lookup, port),
                _list_behind(lookup, kind, port) if shell else (),
                inline_text.to_inlines(label_of_medium(port) or "digital"),
                _remarks_cell(lookup, port),
            )
            for port in component.inputs.values()
        ]
    return [
        PortCells(
            inline_text.to_inlines(Text(port.name, code=True), *write_badges(port)),
            _outer_reader_cell(lookup, port) if shell else _reader_cell(lookup, port),
            inline_text.type_link(port.type),
            _list_behind(lookup, kind, port) if shell else (),
            inline_text.to_inlines(label_of_medium(port) or "digital"),
            _remarks_cell(lookup, port),
        )
        for port in component.outputs.values()
    ]


def make_port_blocks(lookup: Lookup, component: Component) -> Iterator[Block]:
    """Yield the tables of the inputs and the outputs of a component, a sentence in place of an empty one."""
    is_composed = component.id in lookup.architecture.shells
    ends, remarks = (1.6, 1.2) if is_composed else (1.9, 1.3)
    last = (Column("Medium", 0.8), Column("Remarks", remarks))
    inputs = list_port_cells(lookup, component, "input")
    columns = (Column("Input"), Column("From", ends), Column("Type", 1.2), Column("Read inside by", 1.6), *last)
    yield _make_port_block(component, "input", columns, inputs) or _say_missing(
        "input", is_known=component.inputs_known
    )
    outputs = [
        (each.name, each.type, each.inside, each.ends, each.medium, each.remarks)
        for each in list_port_cells(lookup, component, "output")
    ]
    columns = (Column("Output"), Column("Type", 1.2), Column("Given on from", 1.6), Column("To", ends), *last)
    yield _make_port_block(component, "output", columns, outputs) or _say_missing(
        "output", is_known=component.outputs_known
    )


def _make_port_block(
    component: Component, kind: PortKind, columns: tuple[Column, ...], rows: Sequence[tuple[Inlines, ...]]
) -> Table | None:
    table = Table(f"table:{kind}s/{component.id}", f"{component.title}: {kind}s", columns, tuple(map(tuple, rows)))
    return drop_empty_columns(table) if rows else None


def _say_missing(kind: PortKind, *, is_known: bool) -> Paragraph:
    message = f"It has no {kind}s." if is_known else f"Its {kind}s are not known yet."
    return Paragraph(inline_text.to_inlines(Text(f"{kind.capitalize()}s. ", strong=True), Text(message, muted=True)))


def _source_cell(lookup: Lookup, port: Input) -> Inlines:
    """Return the sources of an input, one on each line, with partners other than the component's own."""
    sources = [
        (
            *inline_text.describe_source(lookup.architecture, connection),
            *_mark_source(lookup, connection),
            *_other_owners(lookup, port.component, _list_owners(lookup.architecture, connection.outputs)),
        )
        for connection in port.connections
    ]
    if port.external:
        sources.append(inline_text.to_inlines(Text("outside: ", muted=True), port.external))
    return inline_text.join_lines(sources) or inline_text.UNKNOWN_INLINES


def _other_owners(lookup: Lookup, component_id: str, other_owners: Iterable[str]) -> Inlines:
    """Return those owners who do not own the component, in brackets; empty where there are none."""
    own_partners = find_component(lookup.architecture, component_id).owners
    # Only a flow that crosses from one partner to another names them: the component's own are in its facts.
    links = inline_text.join_inlines(
        inline_text.partner_link(lookup.architecture, owner)
        for owner in dict.fromkeys(other_owners)
        if owner not in own_partners
    )
    return (Text(" ("), *links, Text(")")) if links else ()


def _input_type_cell(lookup: Lookup, port: Input) -> Inlines:
    """Return the types of an input: its own first, then those of the outputs it reads."""
    outputs = (lookup.architecture.outputs[o] for connection in port.connections for o in connection.outputs)
    types = dict.fromkeys([port.type, *(output.type for output in outputs)] if port.type else (o.type for o in outputs))
    return (
        inline_text.join_inlines(inline_text.type_link(name) for name in types if name) or inline_text.UNKNOWN_INLINES
    )


def _list_owners(architecture: Architecture, output_ids: Iterable[str]) -> Iterator[str]:
    return (owner for o in output_ids for owner in architecture.components[architecture.outputs[o].component].owners)


def _reader_cell(lookup: Lookup, port: Output) -> Inlines:
    """Return the readers of an output, one on each line."""
    architecture = lookup.architecture
    readers = [architecture.inputs[connection.input] for connection in lookup.readers_of.get(port.id, ())]
    return _join_readers(
        port,
        [
            (
                *inline_text.port_link(architecture, reader),
                *_other_owners(lookup, port.component, architecture.components[reader.component].owners),
            )
            for reader in readers
        ],
    )


def _outer_reader_cell(lookup: Lookup, port: Output) -> Inlines:
    """Return the readers of a composed component's output that are outside of it, one on each line."""
    readers = {
        reader.id: reader
        for reader, connection in lookup.connections_at(port.component)
        if port.id in (connection.shell_port, *connection.outputs) and not reader.id.startswith(f"{port.component}.")
    }
    return _join_readers(port, [inline_text.port_link(lookup.architecture, reader) for reader in readers.values()])


def _join_readers(port: Output, lines: list[Inlines]) -> Inlines:
    outside = [inline_text.to_inlines(Text("outside: ", muted=True), port.external)] if port.external else []
    return inline_text.join_lines([*lines, *outside]) or inline_text.to_inlines(Text("nobody yet", muted=True))


def _list_behind(lookup: Lookup, kind: PortKind, port: Input | Output) -> Inlines:
    """Return what stands behind a port, each on a line."""
    lines = []
    for inner_id in lookup.architecture.shell_ports.get(f"{kind} {port.id}", ()):
        holder, _, name = inner_id.rpartition(".")
        if holder == port.component:
            words = "its own output " if kind == "input" else "its own input "
            lines.append(inline_text.to_inlines(Text(words, muted=True), Text(name, code=True)))
        else:
            component = find_component(lookup.architecture, holder)
            made_words = (Text(" (autoconnect)", muted=True),) if isinstance(port, Output) and port.is_made else ()
            lines.append((inline_text.component_link(component), Text(" · "), Text(name, code=True), *made_words))
    return inline_text.join_lines(lines) or inline_text.to_inlines(Text("nothing inside yet", muted=True))


def _remarks_cell(lookup: Lookup, port: Input | Output) -> Inlines:
    optional = "optional" if isinstance(port, Input) and port.optional else ""
    # Only what is written of the port itself: the table of types would say the rest again and again.
    name = port.frame
    is_known = name in lookup.architecture.frames
    link = inline_text.frame_link(name) if name and is_known else (Text(name or "", code=True),)
    frame = (Text("in the frame "), *link) if name else ()
    words = _write_remarks(lookup.architecture, port) if isinstance(port, Output) else ()
    fresh = f"no older than {port.freshness}" if isinstance(port, Input) and port.freshness else ""
    parts = [
        inline_text.to_inlines(optional),
        inline_text.to_inlines(fresh),
        frame,
        *words,
        inline_text.read_marks(port.description or ""),
        inline_text.link_urls(port.urls.items(), lookup.repository),
        *(facts for _, facts in list_annotation_facts(lookup, port)),
    ]
    return inline_text.join_inlines(filter(None, parts), "; ")
