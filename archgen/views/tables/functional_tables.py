"""Tables of the functional level: groups, connections, conceptual types, chains of effect, and coordinate frames."""

from __future__ import annotations

from collections.abc import Iterable

from archgen.diagnostics import order_naturally
from archgen.model.architecture import Architecture, Chain, View
from archgen.model.component import Connection
from archgen.model.component_nesting import find_component
from archgen.model.coordinate_frames import Frame
from archgen.model.graph_search import find_reachable
from archgen.model.message_types import ConceptualType
from archgen.model.port_media import label_of_medium, name_medium
from archgen.model.selector_evaluation import evaluate_selector
from archgen.views import element_references, inline_text
from archgen.views.elements import port_tables, type_fields
from archgen.views.elements.frame_users import NOBODY, index_frame_ports, list_shown_frames
from archgen.views.elements.functional_level import describe_purpose
from archgen.views.lookup import Lookup
from archgen.views.shapes import Column, Inlines, Table, Text, make_columns


def make_group_table(lookup: Lookup) -> Table | None:
    """List the shown groups with owners, size and purpose."""
    architecture = lookup.architecture
    rows = tuple(
        (
            inline_text.to_inlines(inline_text.group_link(architecture, name)),
            inline_text.owner_links(architecture, architecture.groups[name].owners),
            inline_text.to_inlines(str(len(architecture.groups[name].components))),
            describe_purpose(architecture.groups[name].description),
        )
        for name in lookup.shown_groups()
    )
    columns = (Column("Group", 1.1), Column("Owner"), Column("Components", 0.6, "right"), Column("Purpose", 2.5))
    return Table("table:groups", "Groups of components", columns, rows) if rows else None


def make_connection_table(
    lookup: Lookup,
    selected_connections: Iterable[Connection],
    anchor: str = "table:connections",
    caption: str = "All connections",
) -> Table | None:
    """List connections: input, source, type, message and number of edges."""
    architecture = lookup.architecture
    rows = tuple(
        (
            inline_text.port_link(architecture, architecture.inputs[connection.input]),
            inline_text.describe_source(architecture, connection),
            _type_cell(lookup, connection),
            _message_cell(lookup, connection),
            inline_text.to_inlines(str(len(connection.outputs))),
        )
        for connection in selected_connections
    )
    columns = make_columns(
        ("Input", 1.6), ("Comes from", 1.6), ("Type", 1.2), ("Message", 1.6), ("Edges", 0.5, "right")
    )
    return Table(anchor, caption, columns, rows, wide=True) if rows else None


def _type_cell(lookup: Lookup, connection: Connection) -> Inlines:
    names = dict.fromkeys(lookup.architecture.outputs[output].type for output in connection.outputs)
    return inline_text.join_inlines(inline_text.type_link(name) for name in names)


def _message_cell(lookup: Lookup, connection: Connection) -> Inlines:
    """Return the messages that a connection carries."""
    architecture = lookup.architecture
    outputs = [architecture.outputs[output] for output in connection.outputs]
    cells: dict[str, Inlines] = {}
    for output in outputs:
        name = architecture.message_of(output)
        # What is no ROS has a remark in place of a message, hence neither code nor a link.
        remark = label_of_medium(output)
        link = (element_references.message_link(name),) if name else inline_text.UNKNOWN_INLINES
        cells[remark or name or ""] = (Text(remark),) if remark else link
    return inline_text.join_inlines(cells.values())


def make_view_table(lookup: Lookup, view: View) -> list[Table]:
    """List the connections between the components that a view of the project shows; nothing where it shows nodes."""
    architecture = lookup.architecture
    shown = evaluate_selector(view.show, architecture)[0].components if view.level == "functional" else ()
    connections = [
        each
        for each in architecture.connections
        if architecture.inputs[each.input].component in shown
        and any(architecture.outputs[output].component in shown for output in each.outputs)
    ]
    table = make_connection_table(lookup, connections, f"table:flows/{view.id}", f"{view.title}: what flows")
    return [table] if table else []


def shown_connections(lookup: Lookup) -> list[Connection]:
    """Return the connections with at least one end in scope."""
    architecture = lookup.architecture
    return [
        connection
        for connection in architecture.connections
        if lookup.scope.shows_component(architecture.inputs[connection.input].component)
        or any(lookup.scope.shows_component(architecture.outputs[output].component) for output in connection.outputs)
    ]


def make_chain_table(lookup: Lookup, selected_chains: Iterable[Chain]) -> Table | None:
    """List chains of effect with their deadlines."""
    architecture = lookup.architecture
    chain_list = list(selected_chains)
    rows = tuple(
        (
            inline_text.to_inlines(Text(chain.title, ref=f"chain:{chain.id}")),
            inline_text.join_inlines((waypoint_link(lookup, point.kind, point.id) for point in chain.through), " → "),
            inline_text.to_inlines(chain.deadline_text)
            if chain.deadline_shares
            else inline_text.quantity_to_inlines(chain.deadline),
            inline_text.join_inlines(
                inline_text.requirement_link(architecture, name)[:1] for name in chain.requirements
            ),
        )
        for chain in chain_list
    )
    columns = (Column("Chain"), Column("Through", 3), Column("Deadline", 0.7, "right"), Column("Requirements", 0.8))
    # Rows take references only in this table. Where timing judged the chains, `make_bound_table` replaces it, and each
    # chain has a section with this anchor; anchors must be unique in a document.
    anchors = tuple(f"chain:{chain.id}" for chain in chain_list)
    return Table("table:chains", "Chains of effect and their deadlines", columns, rows, anchors) if rows else None


def waypoint_link(lookup: Lookup, kind: str, element_id: str) -> Inlines:
    """Link to one element of a chain: a node, a component or an output."""
    architecture = lookup.architecture
    if kind == "node":
        return (inline_text.node_link(architecture.nodes[element_id]),)
    if kind == "component":
        return (inline_text.component_link(find_component(architecture, element_id)),)
    output = architecture.outputs.get(element_id)
    holder, _, name = element_id.rpartition(".")
    return inline_text.port_link(architecture, output or architecture.shells[holder].outputs[name])


def make_frame_table(lookup: Lookup) -> Table | None:
    """List the frames in the order of the files; None where there is none."""
    architecture, frames = lookup.architecture, list_shown_frames(lookup)
    ports_by_frame = index_frame_ports(architecture)
    rows = tuple(
        (
            _name_cell(frame),
            link_declared_frame(architecture, frame.parent) if frame.parent is not None else _mute_words("a root"),
            link_writer(architecture, frame) if frame.parent is not None else (),
            _rate_cell(frame),
            inline_text.join_inlines(
                inline_text.port_id_link(architecture, port) for port in ports_by_frame.get(frame.id, ())
            ),
        )
        for frame in frames
    )
    columns = make_columns(
        ("Frame", 1.2), "Placed in", ("Written by", 1.2), ("Rate", 0.6, "right"), ("Data in it", 1.8)
    )
    # Frames have no page of their own: references to one lead to its row.
    anchors = tuple(f"frame:{frame.id}" for frame in frames)
    return Table("table:frames", "Frames", columns, rows, row_anchors=anchors) if rows else None


def link_declared_frame(architecture: Architecture, name: str) -> Inlines:
    """Link to a frame by its name; one that nobody declares is a plain text."""
    return (Text(name, ref=f"frame:{name}" if name in architecture.frames else None, code=True),)


def link_writer(architecture: Architecture, frame: Frame) -> Inlines:
    """Link to who writes a frame."""
    if frame.by is None:
        return _mute_words(NOBODY)
    if frame.by_kind == "node":
        return (inline_text.node_link(architecture.nodes[frame.by]),)
    component = architecture.components.get(frame.by)
    return (inline_text.component_link(component) if component else Text(frame.by, code=True),)


def _name_cell(frame: Frame) -> Inlines:
    name = Text(frame.id, code=True)
    return (name, Text(f" {frame.title}")) if frame.title != frame.id else (name,)


def _rate_cell(frame: Frame) -> Inlines:
    if frame.parent is None:
        return ()
    return _mute_words("static") if frame.static else inline_text.quantity_to_inlines(frame.rate)


def _mute_words(words: str) -> Inlines:
    return (Text(words, muted=True),)


def shown_types(lookup: Lookup) -> list[ConceptualType]:
    """Return the types that shown ports use or read, and those in their fields; without a scope all, used or not."""
    architecture = lookup.architecture
    if lookup.scope.components is None:
        return list(architecture.types.values())
    used = {output.type for output in architecture.outputs.values() if lookup.scope.shows_component(output.component)}
    used |= {port.type for port in architecture.inputs.values() if lookup.scope.shows_component(port.component)}
    for connection in shown_connections(lookup):
        used |= {architecture.outputs[output].type for output in connection.outputs}
    held_types = {
        each.name: [field.element_type for _, field in each.list_fields()] for each in architecture.types.values()
    }
    used |= find_reachable(held_types, filter(None, used)).keys()
    # In the order of the type mapping, not of the ports.
    return [conceptual_type for conceptual_type in architecture.types.values() if conceptual_type.name in used]


def make_type_table(lookup: Lookup) -> Table | None:
    """List conceptual types with the messages that carry them."""
    rows = tuple(
        (
            (*inline_text.type_link(conceptual_type.name), *port_tables.write_badge(conceptual_type)),
            message_cell(lookup, conceptual_type),
            _size_cell(lookup, conceptual_type),
            inline_text.to_inlines(str(len(lookup.outputs_of_type.get(conceptual_type.name, ())))),
            inline_text.to_inlines(describe_mapping(conceptual_type)),
        )
        for conceptual_type in sorted(shown_types(lookup), key=lambda each: order_naturally(each.name))
    )
    columns = make_columns(
        ("Conceptual type", 1.3),
        ("ROS message", 1.9),
        ("Size", 0.9, "right"),
        ("Outputs", 0.5, "right"),
        ("Remarks", 1.6),
    )
    return Table("table:types", "Mapping of conceptual types to ROS messages", columns, rows) if rows else None


def _size_cell(lookup: Lookup, conceptual_type: ConceptualType) -> Inlines:
    """Return the message size of a type; empty where it is not known."""
    size = lookup.format_size(conceptual_type)
    if not size:
        return ()
    byte_count = (
        conceptual_type.size.value if conceptual_type.size else lookup.message_size(conceptual_type.message, None).bytes
    )
    return (Text(size, sort_number=str(byte_count)),)


def message_cell(lookup: Lookup, conceptual_type: ConceptualType) -> Inlines:
    """Return the message of a type, or that it needs none, or that it is not known yet."""
    if conceptual_type.message:
        return inline_text.to_inlines(element_references.message_link(conceptual_type.message))
    if conceptual_type.generic:
        return inline_text.to_inlines(Text("none: generic", muted=True))
    return (
        inline_text.to_inlines(Text(f"none: {', '.join(map(name_medium, other_media))}", muted=True))
        if (other_media := lookup.other_types.get(conceptual_type.name))
        else inline_text.UNKNOWN_INLINES
    )


def describe_mapping(conceptual_type: ConceptualType) -> str:
    """Describe the rest of a type's mapping on one line: comment, status, parts of a service or action."""
    inner_messages = [
        f"{label}: {name}"
        for label, name in (
            ("request", conceptual_type.request),
            ("response", conceptual_type.response),
            ("feedback", conceptual_type.feedback),
        )
        if name
    ]
    planned_remark = "message is planned" if conceptual_type.status == "planned" else ""
    frame_remark = f"in the frame {conceptual_type.frame}" if conceptual_type.frame else ""
    comment = " ".join((conceptual_type.comment or "").split())
    life = port_tables.list_text_remarks(conceptual_type)
    content = type_fields.describe_content(conceptual_type)
    return "; ".join(part for part in (*life, comment, planned_remark, frame_remark, *content, *inner_messages) if part)
