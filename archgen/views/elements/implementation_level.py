"""The implementation level in documents: a node, its endpoints, its parameters and where it runs."""

from __future__ import annotations

import shlex

from archgen.derivation.wire.wire_names import list_written_remaps
from archgen.model.component_nesting import find_component
from archgen.model.node import Endpoint, Node
from archgen.model.port_media import ROS
from archgen.views import element_references, inline_text, requirement_servers, timing_words
from archgen.views.elements.annotation_facts import list_annotation_facts
from archgen.views.elements.parameter_blocks import make_effective_table
from archgen.views.lookup import Lookup
from archgen.views.shapes import Block, Column, Fact, Figure, Inlines, Markdown, Paragraph, Table, Text, show_facts
from archgen.views.start_phrases import describe_override, describe_start, list_running_facts
from archgen.views.timing import element_timing

_USE_ORDER = {"subscribes": 0, "publishes": 1, "serves": 2, "calls": 3}
"""Endpoints are listed in the direction of the data: inputs, outputs, then services and actions."""
_LANGUAGE_TITLES = {"python": "Python", "cpp": "C++"}


def make_implementation_blocks(lookup: Lookup, component_id: str) -> tuple[Block, ...]:
    """Return the figure of a component's nodes with their neighbours."""
    title = find_component(lookup.architecture, component_id).title
    return (
        Figure(
            f"figure:implementation/{component_id}",
            f"implementation/{component_id}",
            f"{title}: implementation",
            f"The nodes that implement {title} with their topics, services and actions.",
        ),
    )


def make_node_blocks(lookup: Lookup, node: Node) -> tuple[Block, ...]:
    """Describe a node: facts, endpoints and parameters."""
    blocks: list[Block] = []
    if not node.written:
        blocks.append(
            Paragraph(
                inline_text.to_inlines("Nobody has decided yet which node implements this: a planned one stands in."),
                "note",
            )
        )
    blocks.append(show_facts(list_node_facts(lookup, node)))
    if node.description:
        blocks.append(Markdown(node.description))
    endpoints = lookup.endpoints_of.get(node.id, ())
    if endpoints:
        blocks.append(_endpoint_table(node, endpoints))
    else:
        blocks.append(Paragraph(inline_text.to_inlines(Text("It uses no topic, service or action.", muted=True))))
    if table := make_effective_table(lookup, node):
        blocks.append(table)
    return tuple(blocks)


def list_node_facts(lookup: Lookup, node: Node) -> list[Fact]:
    """Return a node's facts, without those that have no value."""
    architecture = lookup.architecture
    kind = ", ".join(inline_text.NODE_KIND_WORDS[kind] for kind in node.kinds)
    components = [architecture.components[name] for name in node.implements]
    requirement_ids = dict.fromkeys(use.text for each in components for use in each.requirements if use.is_id)
    words = describe_start(node)
    groups = timing_words.format_callback_groups(node)
    parts = (
        f"{node.threads} thread{'s' if node.threads > 1 else ''}" if node.threads else "",
        f"in the order {node.scheduling}" if node.scheduling else "",
        "reentrant" if node.reentrant else "",
        f"mutually exclusive in groups ({groups})" if groups else "",
    )
    facts = [
        Fact(
            "implements", "Implements", inline_text.join_inlines((inline_text.component_link(c),) for c in components)
        ),
        Fact(
            "requirements",
            "Requirements",
            inline_text.join_inlines(requirement_servers.judged_link(lookup, each) for each in requirement_ids),
        ),
        Fact("ros_name", "ROS name", () if node.is_program else inline_text.to_code(node.full_name)),
        Fact("kind", "Kind, status", inline_text.to_inlines(f"{kind}, ", *inline_text.value_or_unknown(node.status))),
        Fact("package", "Package", (*inline_text.value_or_unknown(node.package), *_program_parts(node))),
        Fact("", "Command", inline_text.to_code(shlex.join(node.command))),
        Fact("", "Arguments", inline_text.to_code(shlex.join(node.arguments))),
        Fact("", "Language", inline_text.to_inlines(_LANGUAGE_TITLES.get(node.language or ""))),
        Fact("", "Remaps", _remap_facts(lookup, node)),
        Fact("", "Start", (Text(words), Text(" ("), Text("the plan", ref="page:start_up"), Text(")")) if words else ()),
        *(
            Fact("", name.capitalize(), inline_text.to_inlines(text))
            for name, text in list_running_facts(lookup.endpoints_of.get(node.id, ()))
            if not text.startswith("unknown")  # of most nodes of a design; cards say so
        ),
        Fact("owner", "Owner", inline_text.owner_links(architecture, node.owners) if node.owners else ()),
        Fact("host", "Runs on", location_cell(lookup, node)),
        Fact("activity", "Callbacks", inline_text.to_inlines(", ".join(part for part in parts if part))),
        Fact(
            "", "Parameter files", inline_text.join_inlines((Text(name, code=True),) for name in node.parameter_files)
        ),
        Fact("", "Tags", inline_text.to_inlines(", ".join(node.tags))),
        Fact("links", "Links", inline_text.link_urls(node.urls.items(), lookup.repository)),
        *(Fact("", *row) for row in list_annotation_facts(lookup, node)),
    ]
    for component, timing in node.timing.items():
        # One timing for each activity; the key is "" for a node that implements no component.
        is_one_of_several = len(node.timing) > 1 and bool(component)
        title = f"Timing of {component.rsplit('.', 1)[-1]}" if is_one_of_several else "Timing"
        sentence = timing_words.format_timing_sentence(timing)
        facts.append(Fact("activity" if is_one_of_several else "timing", title, inline_text.to_inlines(sentence)))
    facts += element_timing.make_node_facts(lookup, node)
    return [fact for fact in facts if fact.value]


def _remap_facts(lookup: Lookup, node: Node) -> Inlines:
    """Return the names that become others when the node starts, those of its ports first."""
    ends = lookup.endpoints_of.get(node.id, ())
    port_names = {each.own_name: each.label for each in ends if each.own_name and each.program_name != each.name}
    port_names |= {each.evidence["name"].rule.partition(":=")[0]: each.label for each in ends if each.is_moved}
    others = {own_name: name for own_name, name in list_written_remaps(node).items() if own_name not in port_names}
    known_names = {each.name for each in ends}
    return inline_text.join_inlines(
        (
            Text(own_name, code=True),
            Text(" is "),
            inline_text.topic_link(name) if name in known_names else Text(name, code=True),
        )
        for own_name, name in (port_names | others).items()
    )


def _program_parts(node: Node) -> Inlines:
    """Return the executable and the plugin of a node, each after a comma."""
    parts = (("executable", node.executable), ("plugin", node.plugin))
    return tuple(part for name, value in parts if value for part in (Text(f", {name} "), Text(value, code=True)))


def location_cell(lookup: Lookup, node: Node) -> Inlines:
    """Return the host of a node, and the container whose process it shares."""
    host = inline_text.host_link(lookup.architecture, node.host)
    if not node.container:
        return host
    container = lookup.architecture.containers.get(node.container)
    title = container.title if container else node.container
    return (*host, Text(", in the process "), Text(title, ref=f"container:{node.container}"))


def _endpoint_table(node: Node, endpoints: tuple[Endpoint, ...]) -> Table:
    rows = tuple(
        (
            inline_text.to_inlines(endpoint.use),
            (*inline_text.name_carrier(endpoint), *((Text(" internal", muted=True),) if endpoint.internal else ())),
            _name_content(endpoint),
            inline_text.to_code((endpoint.port or "").rpartition(".")[2]),
            _qos_content(endpoint),
        )
        for endpoint in sorted(endpoints, key=lambda e: _USE_ORDER[e.use])
    )
    columns = (Column("Use", 0.7), Column("Name", 1.9), Column("Message", 2.0), Column("Port", 0.8), Column("QoS", 1.3))
    return Table(f"table:endpoints/{node.id}", f"{node.id}: topics, services and actions", columns, rows)


def _qos_content(endpoint: Endpoint) -> Inlines:
    words = describe_override(endpoint)
    remark = (Text(f" {words}", muted=True),) if words else ()
    return (*inline_text.format_qos_cell(endpoint), *remark)


def _name_content(endpoint: Endpoint) -> Inlines:
    """Return the message of an endpoint; over another medium than ROS, the type."""
    if endpoint.medium != ROS and endpoint.type:
        return inline_text.type_link(endpoint.type)
    return (element_references.message_link(endpoint.message),) if endpoint.message else inline_text.UNKNOWN_INLINES
