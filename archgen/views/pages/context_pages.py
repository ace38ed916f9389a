"""The site's pages around components and nodes: topics, types, use cases."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator

from archgen.diagnostics import order_naturally
from archgen.model.component import Component, Input, Output
from archgen.model.component_nesting import find_component
from archgen.model.message_types import ConceptualType, flow_of
from archgen.model.node import Endpoint, Node, Topic
from archgen.model.port_media import ROS, describe_way, key_of_channel, name_medium, name_on_medium
from archgen.views import inline_text, timing_words
from archgen.views.element_references import message_link
from archgen.views.elements import type_fields
from archgen.views.elements.annotation_facts import list_annotation_facts
from archgen.views.elements.implementation_level import location_cell
from archgen.views.elements.port_tables import list_topic_facts, write_deprecation
from archgen.views.lookup import Lookup
from archgen.views.sequences.sequence_blocks import make_sequence_blocks
from archgen.views.shapes import (
    Block,
    Bullets,
    Column,
    Facts,
    Inlines,
    Markdown,
    Page,
    Paragraph,
    Section,
    Table,
    Text,
    drop_empty_columns,
    make_columns,
    show_known,
)
from archgen.views.tables import deployment_tables, functional_tables, requirement_tables
from archgen.views.timing import element_timing

FigureFilter = Callable[[Iterable[Block]], tuple[Block, ...]]
"""Drops the figures that were not drawn."""
HOME_CRUMB = ("Overview", "page:index")
_FLOW_ORDER = {"topic": 0, "service": 1, "action": 2}
_CHANNEL_TITLES = {"topic": "Data", "service": "Calls", "action": "Actions"}
_FLOW_TITLES = {"topic": "Topic", "service": "Service", "action": "Action"}


def make_context_pages(lookup: Lookup, keep_drawn: FigureFilter) -> Iterator[Page]:
    """Make a page for each type and use case."""
    for conceptual_type in sorted(functional_tables.shown_types(lookup), key=lambda each: order_naturally(each.name)):
        yield _type_page(lookup, conceptual_type)
    for name in lookup.architecture.use_cases:
        yield _use_case_page(lookup, name, keep_drawn)


def make_page(section: Section, folder: str, crumb: tuple[str, str] | None, lead: str) -> Page:
    """Make a page below a folder; its name is the anchor without the kind before the colon."""
    crumbs = (HOME_CRUMB, crumb) if crumb else (HOME_CRUMB,)
    path = f"{folder}/{make_page_slug(section.subject)}.html"
    return Page(path, section.anchor, section.title, folder, section, crumbs, lead)


def make_page_slug(name: str) -> str:
    """Turn a name into a file name that every system takes: lower case, words joined by hyphens."""
    # Different names may give the same slug; `_make_paths_distinct` numbers such pages.
    return re.sub(r"[^a-z0-9._-]+", "-", name.lower()).strip("-.") or "-"


def make_topic_pages(lookup: Lookup) -> Iterator[Page]:
    """Make a page for each topic, service and action that a shown node uses, then for what runs over other media."""
    for topic in shown_topics(lookup):
        yield _topic_page(lookup, topic)
    for channel in _list_shown_channels(lookup):
        yield _channel_page(lookup, channel)


def shown_topics(lookup: Lookup) -> list[Topic]:
    """Return the topics, services and actions that a shown node uses."""
    # Each kind by name: nobody finds `/scan/front` by eye in the order of the files.
    return _sort_shown(lookup, lookup.architecture.topics.values())


def _sort_shown(lookup: Lookup, carriers: Iterable[Topic]) -> list[Topic]:
    return [
        topic
        for topic in sorted(carriers, key=lambda each: (_FLOW_ORDER[each.flow], order_naturally(each.name)))
        if any(lookup.scope.shows_node(endpoint.node) for endpoint in (*topic.writers, *topic.readers))
    ]


def make_topic_tables(lookup: Lookup) -> Iterator[Table]:
    """List topics, services and actions, each kind in a table of its own; then what nodes exchange over other media."""
    for flow, title in (("topic", "Topics"), ("service", "Services"), ("action", "Actions")):
        flow_topics = [topic for topic in shown_topics(lookup) if topic.flow == flow]
        table = deployment_tables.make_topic_table(lookup, flow_topics, f"table:{flow}s", title)
        if table:
            yield table
    channels = _list_shown_channels(lookup)
    if table := deployment_tables.make_topic_table(lookup, channels, "table:channels", "Over other media than ROS"):
        yield table


def _list_shown_channels(lookup: Lookup) -> list[Topic]:
    return _sort_shown(lookup, lookup.architecture.channels.values())


def _channel_page(lookup: Lookup, channel: Topic) -> Page:
    """Make the page of what nodes exchange over another medium: what it is, who uses it, and over which links it may go."""
    architecture, medium = lookup.architecture, name_medium(channel.medium)
    hosts = dict.fromkeys(architecture.nodes[each.node].host for each in (*channel.writers, *channel.readers))
    links = [each for each in architecture.links.values() if each.protocol == channel.medium]
    facts: list[tuple[str, Inlines]] = [
        ("Medium", inline_text.to_inlines(medium)),
        ("Type", inline_text.join_inlines(inline_text.type_link(name) for name in channel.types)),
        ("Size", inline_text.to_inlines(lookup.format_size(channel))),
        ("Hosts", inline_text.join_inlines(inline_text.host_link(architecture, each) for each in hosts if each)),
        ("Links", inline_text.join_inlines((Text(each.title, ref=f"link:{each.id}"),) for each in links)),
    ]
    blocks: list[Block] = [show_known(facts)]
    writer, reader = ("Server", "Client") if channel.flow != "topic" else ("Sender", "Reader")
    blocks += _endpoint_blocks(lookup, channel, channel.writers, writer)
    blocks += _endpoint_blocks(lookup, channel, channel.readers, reader)
    crumb = ("Topics, services and actions", "page:topics")
    section = Section(f"channel:{key_of_channel(channel)}", name_on_medium(channel), tuple(blocks))
    return make_page(section, "channels", crumb, f"{_CHANNEL_TITLES[channel.flow]} {describe_way(channel.medium)}")


def _topic_page(lookup: Lookup, topic: Topic) -> Page:
    facts: list[tuple[str, Inlines]] = [
        (
            "Message",
            inline_text.join_inlines((message_link(message),) for message in topic.messages)
            or inline_text.UNKNOWN_INLINES,
        ),
        ("Type", inline_text.join_inlines(inline_text.type_link(name) for name in topic.types)),
        ("Size", inline_text.to_inlines(lookup.format_size(topic))),
        *element_timing.make_traffic_facts(lookup, topic.name),
        *list_topic_facts(lookup.architecture, topic),
    ]
    blocks: list[Block] = [show_known(facts)]
    writer, reader = ("Server", "Client") if topic.flow != "topic" else ("Publisher", "Subscriber")
    blocks += _endpoint_blocks(lookup, topic, topic.writers, writer) + _endpoint_blocks(
        lookup, topic, topic.readers, reader
    )
    crumb = ("Topics, services and actions", "page:topics")
    return make_page(
        Section(f"topic:{topic.name}", topic.name, tuple(blocks)), f"{topic.flow}s", crumb, _FLOW_TITLES[topic.flow]
    )


def _endpoint_blocks(lookup: Lookup, topic: Topic, endpoints: tuple[Endpoint, ...], role: str) -> list[Block]:
    if not endpoints:
        return [Paragraph(inline_text.to_inlines(Text(f"{role}s. ", strong=True), Text("None.", muted=True)))]
    rows: tuple[tuple[Inlines, ...], ...] = tuple(
        (
            inline_text.to_inlines(inline_text.node_link(lookup.architecture.nodes[endpoint.node])),
            (
                inline_text.to_inlines(inline_text.component_link(lookup.architecture.components[endpoint.component]))
                if endpoint.component
                else ()
            ),
            # Ports by their own names: the component is in the column before.
            inline_text.to_code((endpoint.port or "").rpartition(".")[2]),
            inline_text.format_qos_cell(endpoint),
        )
        for endpoint in endpoints
    )
    columns: tuple[Column, ...] = (Column(role), Column("Component", 1.3), Column("Port"), Column("QoS", 1.5))
    if topic.medium != ROS:
        columns, rows = columns[:-1], tuple(row[:-1] for row in rows)
    return [Table(f"table:{role.lower()}s/{topic.name}", f"{role}s", columns, rows)]


def make_node_table(
    lookup: Lookup, nodes: list[Node], component: Component | None = None, host_id: str | None = None
) -> list[Block]:
    """List nodes with what they implement, package, status, host and timing; empty for no nodes.

    On the page of a `component`, that component itself is left out of the list of implemented ones; on a host's page
    there is no column for the host.
    """
    if not nodes:
        return []
    architecture, own_id = lookup.architecture, component.id if component else None
    rows = tuple(
        (
            inline_text.to_inlines(inline_text.node_link(node)),
            inline_text.join_inlines(
                (inline_text.component_link(architecture.components[c]),) for c in node.implements if c != own_id
            ),
            inline_text.value_or_unknown(node.package),
            inline_text.value_or_unknown(node.status),
            location_cell(lookup, node) if host_id is None else (),
            _timing_cell(node, is_short=component is None),
        )
        for node in nodes
    )
    columns = make_columns(
        ("Node", 1.2),
        ("Implements too" if component and not component.children else "Implements", 1.5),
        ("Package", 1.3),
        ("Status", 0.7),
        ("Host", 0.8),
        "Timing",
    )
    name, caption = (component.id, f"Nodes of {component.title}") if component else ("all", "Nodes")
    return [drop_empty_columns(Table(f"table:nodes/{name}", caption, columns, rows))]


def _timing_cell(node: Node, *, is_short: bool) -> Inlines:
    """Return the timing of all components that a node implements, in short or with cores and priorities."""
    write = timing_words.format_short_timing if is_short else timing_words.format_timing_sentence
    summary = "; ".join(filter(None, map(write, node.timing.values())))
    return (Text(summary, sort_number=_shortest_period(node)),) if summary else ()


def _shortest_period(node: Node) -> str | None:
    """Return the shortest period of a node in ns, as the number that tables sort by; None where none is written."""
    periods = [timing.period.value for timing in node.timing.values() if timing.period]
    periods += [10**9 / timing.rate.value for timing in node.timing.values() if timing.rate and timing.rate.value]
    return str(min(periods)) if periods else None


def _type_page(lookup: Lookup, conceptual_type: ConceptualType) -> Page:
    facts = [
        ("Message", functional_tables.message_cell(lookup, conceptual_type)),
        ("Size", _size_cell(lookup, conceptual_type)),
        ("Deprecated", write_deprecation(lookup.architecture, "type", conceptual_type)),
        ("Remarks", inline_text.to_inlines(functional_tables.describe_mapping(conceptual_type))),
        *list_annotation_facts(lookup, conceptual_type),
    ]
    blocks: list[Block] = [show_known(facts)]
    architecture = lookup.architecture
    blocks += type_fields.make_field_tables(architecture, conceptual_type)
    producing_outputs = lookup.outputs_of_type.get(conceptual_type.name, ())
    if producing_outputs:
        blocks += [
            Paragraph(inline_text.to_inlines(Text("Produced by", strong=True))),
            Bullets(tuple(_link_port_and_owners(lookup, output) for output in producing_outputs)),
        ]
    reading_inputs = dict.fromkeys(
        c.input for output in producing_outputs for c in lookup.readers_of.get(output.id, ())
    )
    if reading_inputs:
        blocks += [
            Paragraph(inline_text.to_inlines(Text("Read by", strong=True))),
            Bullets(tuple(_link_port_and_owners(lookup, architecture.inputs[name]) for name in reading_inputs)),
        ]
    section = Section(f"type:{conceptual_type.name}", conceptual_type.name, tuple(blocks))
    return make_page(section, "types", ("Types", "page:types"), "Conceptual type")


def _link_port_and_owners(lookup: Lookup, port: Input | Output) -> Inlines:
    """Return a link to a port, with the partners whom a change of its type concerns."""
    link = inline_text.port_link(lookup.architecture, port)
    owners = find_component(lookup.architecture, port.component).owners
    if not owners:
        return link
    return (*link, Text(" ("), *inline_text.owner_links(lookup.architecture, owners), Text(")"))


def _size_cell(lookup: Lookup, conceptual_type: ConceptualType) -> Inlines:
    """Return the message size of a type, or why it is not known."""
    if size := lookup.format_size(conceptual_type):
        return inline_text.to_inlines(size)
    # Services and actions have no single size, and without a message the row above already says so.
    if conceptual_type.message is None or flow_of(conceptual_type.message) != "topic":
        return ()
    return inline_text.to_inlines(
        Text(f"unknown: {lookup.message_size(conceptual_type.message, None).why.replace('`', '')}", muted=True)
    )


def _use_case_page(lookup: Lookup, use_case_id: str, keep_drawn: FigureFilter) -> Page:
    use_case = lookup.architecture.use_cases[use_case_id]
    serving_requirements = [r for r in lookup.architecture.requirements.values() if use_case_id in r.use_cases]
    table = requirement_tables.make_requirement_table(lookup, serving_requirements)
    blocks: list[Block] = [Facts(facts)] if (facts := tuple(list_annotation_facts(lookup, use_case))) else []
    blocks += [Markdown(use_case.description)] if use_case.description else []
    blocks += keep_drawn(make_sequence_blocks(lookup, use_case))
    blocks += [table] if table else []
    crumb = ("Requirements and use cases", "page:requirements")
    title = use_case_id if use_case.title == use_case_id else f"{use_case_id} {use_case.title}"
    return make_page(Section(f"use_case:{use_case_id}", title, tuple(blocks)), "use_cases", crumb, "Use case")
