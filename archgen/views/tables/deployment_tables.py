"""Tables of what the system runs on and talks over: hosts, links and topics."""

from __future__ import annotations

from collections.abc import Sequence

from archgen.model.component_nesting import find_component
from archgen.model.deployment import Link
from archgen.model.node import Topic
from archgen.model.port_media import ROS, name_medium
from archgen.views import element_references, inline_text
from archgen.views.lookup import Lookup
from archgen.views.shapes import Column, Inlines, Table, Text


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
    with_owners = any(link.owner for link in architecture.links.values())
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
            *((inline_text.partner_link(architecture, link.owner) if link.owner else (),) if with_owners else ()),
            *((inline_text.to_inlines(name_medium(link.protocol or "")),) if with_protocol else ()),
            inline_text.quantity_to_inlines(link.bandwidth),
            _latency_cell(link),
        )
        for link in lookup.architecture.links.values()
    )
    protocol_columns = (*((Column("Owner"),) if with_owners else ()), *((Column("Protocol"),) if with_protocol else ()))
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
    is_ros = any(topic.medium == ROS for topic in selected_topics)
    content = Column("Message" if is_ros else "Type", 1.6, key="carried")
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
