"""Tables across the architecture: connections, types, requirements, hosts, chains, topics, findings.

Each function returns None where there would be no rows, because a `Table` without rows must not exist.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.diagnostic import Diagnostic, Severity, phrase_severity_counts
from archgen.model.architecture import Chain
from archgen.model.component import Connection
from archgen.model.component_nesting import find_component
from archgen.model.deployment import Link
from archgen.model.graph_search import find_reachable
from archgen.model.message_types import ConceptualType
from archgen.model.node import Topic
from archgen.model.port_media import ROS, label_of_medium, name_medium
from archgen.views import element_references, inline_text
from archgen.views.elements import promise_words
from archgen.views.elements.functional_level import first_sentence
from archgen.views.lookup import Lookup
from archgen.views.shapes import Column, Inlines, Status, Table, Text
from archgen.views.tables import type_fields

_SEVERITY_STATES: Mapping[Severity, Status] = {
    Severity.ERROR: "error",
    Severity.WARNING: "warning",
    Severity.NOTE: "note",
    Severity.OFF: "note",
}


def make_group_table(lookup: Lookup) -> Table | None:
    """List the shown groups with owners, size and purpose."""
    architecture = lookup.architecture
    rows = tuple(
        (
            inline_text.to_inlines(inline_text.group_link(architecture, name)),
            inline_text.owner_links(architecture, architecture.groups[name].owners),
            inline_text.to_inlines(str(len(architecture.groups[name].components))),
            inline_text.value_or_unknown(first_sentence(architecture.groups[name].description)),
        )
        for name in lookup.shown_groups()
    )
    columns = (Column("Group", 1.1), Column("Owner"), Column("Components", 0.6, "right"), Column("Purpose", 2.5))
    return Table("table:groups", "Groups of components", columns, rows) if rows else None


def make_connection_table(
    lookup: Lookup, selected_connections: Iterable[Connection], anchor: str = "table:connections"
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
    columns = (
        Column("Input", 1.6),
        Column("Comes from", 1.6),
        Column("Type", 1.2),
        Column("Message", 1.6),
        Column("Edges", 0.5, "right"),
    )
    return Table(anchor, "All connections", columns, rows, wide=True) if rows else None


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


def shown_connections(lookup: Lookup) -> list[Connection]:
    """Return the connections with at least one end in scope."""
    architecture = lookup.architecture
    return [
        connection
        for connection in architecture.connections
        if lookup.scope.shows_component(architecture.inputs[connection.input].component)
        or any(lookup.scope.shows_component(architecture.outputs[output].component) for output in connection.outputs)
    ]


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
        for conceptual_type in sorted(shown_types(lookup), key=lambda each: each.name.casefold())
    )
    columns = (
        Column("Conceptual type", 1.3),
        Column("ROS message", 1.9),
        Column("Size", 0.6, "right"),
        Column("Outputs", 0.5, "right"),
        Column("Remarks", 1.6),
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


def make_finding_table(
    lookup: Lookup, findings: Iterable[Diagnostic], anchor: str = "table:open_points"
) -> Table | None:
    """List findings with their help, who owns what they are about, their place and their rule; errors first."""
    rows = tuple(
        (
            severity_chip(finding),
            inline_text.join_lines(_finding_lines(lookup, finding)),
            element_references.owner_cell(lookup.architecture, finding.element),
            element_references.place_cell(lookup, finding),
            inline_text.to_inlines(Text(finding.rule, ref=f"rule:{finding.rule}")),
        )
        for finding in sorted(findings, key=lambda each: -each.effective_severity.rank)
    )
    columns = (
        Column("Severity", 0.6),
        Column("Finding", 3),
        Column("Owner", 0.8),
        Column("Place", 1.3),
        Column("Rule", 1),
    )
    return Table(anchor, "Open points", columns, rows) if rows else None


_RULE_STATES: Mapping[str, tuple[str, Status]] = {
    "uncovered-requirement": ("uncovered", "uncovered"),
    "unjustified-component": ("unjustified", "uncovered"),
    "unjustified-node": ("unjustified", "uncovered"),
    "unread-output": ("unread", "warning"),
}
"""Rules whose findings are states of their own; the others show how serious they are."""


def finding_chip(finding: Diagnostic) -> Inlines:
    """Return the state that a finding tells as a chip: the rule's own word, else its severity."""
    severity = finding.effective_severity
    if severity is Severity.WARNING and finding.rule in _RULE_STATES:
        word, status = _RULE_STATES[finding.rule]
        return (Text(word, status=status),)
    return severity_chip(finding)


def severity_chip(finding: Diagnostic) -> Inlines:
    """Return how serious a finding is, as a chip."""
    severity = finding.effective_severity
    return (Text(severity, strong=severity is Severity.ERROR, status=_SEVERITY_STATES[severity]),)


def _finding_lines(lookup: Lookup, finding: Diagnostic) -> list[Inlines]:
    """Return the message of a finding and, muted, its help."""
    lines = (
        element_references.link_message(lookup.architecture, finding),
        element_references.link_help(lookup.architecture, finding),
    )
    return [line for line in lines if line]


def make_host_table(lookup: Lookup) -> Table | None:
    """List hosts with their containers and the shown nodes."""
    architecture = lookup.architecture
    rows = tuple(
        (
            inline_text.to_inlines(Text(host.title, ref=f"host:{host.id}")),
            inline_text.count_to_inlines(host.cores),
            inline_text.join_inlines(
                inline_text.to_inlines(Text(container.title, ref=f"container:{container.id}"))
                for container in architecture.containers.values()
                if container.host == host.id
            ),
            inline_text.join_inlines(
                (inline_text.node_link(node),) for node in lookup.shown_nodes() if node.host == host.id
            ),
        )
        for host in architecture.hosts.values()
    )
    columns = (Column("Host"), Column("Cores", 0.5, "right"), Column("Containers"), Column("Nodes", 3))
    return Table("table:hosts", "Hosts and what runs on them", columns, rows) if rows else None


def make_link_table(lookup: Lookup) -> Table | None:
    """List the links between hosts and devices; with what is spoken on them, where one says it."""
    architecture = lookup.architecture
    with_protocol = any(link.protocol for link in architecture.links.values())
    with_devices = any(link.devices for link in architecture.links.values())
    rows = tuple(
        (
            inline_text.to_inlines(Text(link.title, ref=f"link:{link.id}")),
            inline_text.join_inlines(
                (
                    *(inline_text.host_link(architecture, host) for host in link.connects),
                    *(device_link(lookup, device) for device in link.devices),
                )
            ),
            *((inline_text.to_inlines(name_medium(link.protocol or "")),) if with_protocol else ()),
            inline_text.quantity_to_inlines(link.bandwidth),
            _latency_cell(link),
        )
        for link in lookup.architecture.links.values()
    )
    protocol_columns = (Column("Protocol"),) if with_protocol else ()
    columns = (Column("Link"), Column("Connects", 1.5), *protocol_columns, Column("Bandwidth"), Column("Latency"))
    # Links have no page or section of their own: references to one lead to its row.
    anchors = tuple(f"link:{name}" for name in lookup.architecture.links)
    caption = "Links between hosts and devices" if with_devices else "Links between hosts"
    return Table("table:links", caption, columns, rows, row_anchors=anchors) if rows else None


def device_link(lookup: Lookup, component_id: str) -> Inlines:
    """Return the title of a component that is a device on a link, linked where it is shown."""
    component = find_component(lookup.architecture, component_id)
    if not lookup.scope.shows_component(component_id):
        return inline_text.to_inlines(component.title)
    return (inline_text.component_link(component),)


def _latency_cell(link: Link) -> Inlines:
    """Return the latency of a link, from best to worst, sorted by the worst."""
    if not link.best and not link.worst:
        return inline_text.UNKNOWN_INLINES
    sort_number = str(link.worst.value) if link.worst else None
    return (Text(f"{link.best or '?'} to {link.worst or '?'}", sort_number=sort_number),)


def make_chain_table(lookup: Lookup, selected_chains: Iterable[Chain]) -> Table | None:
    """List chains of effect with their deadlines."""
    architecture = lookup.architecture
    chain_list = list(selected_chains)
    rows = tuple(
        (
            inline_text.to_inlines(Text(chain.title, ref=f"chain:{chain.id}")),
            inline_text.join_inlines((waypoint_link(lookup, point.kind, point.id) for point in chain.through), " → "),
            inline_text.quantity_to_inlines(chain.deadline),
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


def make_topic_table(lookup: Lookup, selected_topics: Sequence[Topic], anchor: str, caption: str) -> Table | None:
    """List topics, services, actions or channels of other media with writers and readers."""
    nodes = lookup.architecture.nodes
    rows = tuple(
        (
            inline_text.name_carrier(topic),
            _carried_cell(topic),
            # A node may have several endpoints on a topic; it is named once.
            inline_text.join_inlines(
                (inline_text.node_link(nodes[e]),) for e in dict.fromkeys(w.node for w in topic.writers)
            ),
            inline_text.join_inlines(
                (inline_text.node_link(nodes[e]),) for e in dict.fromkeys(r.node for r in topic.readers)
            ),
        )
        for topic in selected_topics
    )
    content = Column("Message" if any(topic.medium == ROS for topic in selected_topics) else "Type", 1.6)
    columns = (Column("Name", 1.5), content, Column("From", 1.2), Column("To", 1.5))
    return Table(anchor, caption, columns, rows) if rows else None


def _carried_cell(topic: Topic) -> Inlines:
    """Return the messages on a topic; over another medium, the types."""
    texts = (
        ((element_references.message_link(message),) for message in topic.messages)
        if topic.medium == ROS
        else map(inline_text.type_link, topic.types)
    )
    return inline_text.join_inlines(texts) or inline_text.UNKNOWN_INLINES


def describe_severities(findings: Iterable[Diagnostic]) -> str:
    """Count findings in words: `1 error, 2 warnings and 3 notes`, or `nothing`."""
    return join_words(phrase_severity_counts(findings)) or "nothing"
