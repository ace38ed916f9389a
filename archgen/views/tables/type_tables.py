"""Tables of conceptual types: the messages that carry them, their sizes, what else is said of them."""

from __future__ import annotations

from archgen.diagnostics import order_naturally
from archgen.model.graph_search import find_reachable
from archgen.model.message_types import ConceptualType
from archgen.model.port_media import name_medium
from archgen.views import element_references, inline_text
from archgen.views.elements import promise_words, type_fields
from archgen.views.lookup import Lookup
from archgen.views.shapes import Inlines, Table, Text, make_columns
from archgen.views.tables.functional_tables import shown_connections


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
            (*inline_text.type_link(conceptual_type.name), *promise_words.write_badge(conceptual_type)),
            message_cell(lookup, conceptual_type),
            size_cell(lookup, conceptual_type),
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


def size_cell(lookup: Lookup, conceptual_type: ConceptualType) -> Inlines:
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
    life = promise_words.list_text_remarks(conceptual_type)
    content = type_fields.describe_content(conceptual_type)
    return "; ".join(part for part in (*life, comment, planned_remark, frame_remark, *content, *inner_messages) if part)
