"""Cards of both levels: groups, components with their ports, component types; nodes, and what they exchange."""

from __future__ import annotations

import shlex
from collections.abc import Iterator

from archgen.diagnostics import Span
from archgen.model.component import Component, ComponentType, Group, Input, Output
from archgen.model.node import Endpoint, Node, Topic
from archgen.model.port_media import ROS, name_medium, name_on_medium, uses_ros, word_of_medium
from archgen.views import inline_text, timing_words
from archgen.views.elements import promise_words
from archgen.views.elements.annotation_facts import (
    ElementCard,
    drop_empty_lists,
    format_fact,
    known_facts,
    list_finding_lines,
)
from archgen.views.elements.parameter_blocks import list_effective_lines, list_operation_lines, list_parameter_lines
from archgen.views.lookup import Lookup
from archgen.views.start_phrases import describe_override, describe_start, list_running_facts
from archgen.views.timing.element_timing import make_whole_fact
from archgen.views.timing.flow_tables import list_flow_lines


def make_group_card(_lookup: Lookup, group: Group) -> ElementCard:
    """Make the card of a group."""
    facts = [
        ("owner", ", ".join(group.owners) or "?"),
        ("tags", ", ".join(group.tags)),
        ("description", group.description or ""),
    ]
    component_lines = tuple(f"{c.name}: {c.title}" for c in group.components.values())
    return ElementCard("group", group.id, group.title, group.at, known_facts(facts), (("components", component_lines),))


def make_component_card(lookup: Lookup, component: Component) -> ElementCard:
    """Make the card of a component that holds no others."""
    facts = _list_component_facts(component, component.role or "?", timing_words.format_short_timing(component.timing))
    architecture = lookup.architecture
    inputs = tuple(_describe_input(lookup, port) for port in component.inputs.values())
    outputs = tuple(
        f"{port.name} ({port.type or '?'}){_mark_deprecated(port)} -> {', '.join(_list_readers(lookup, port)) or 'nobody'}"
        for port in component.outputs.values()
    )
    nodes = tuple(
        f"{node.id} ({architecture.nodes[node.id].at if node.written else 'still to be decided'})"
        for node in lookup.nodes_of.get(component.id, ())
    )
    lists = (
        ("inputs", inputs),
        ("outputs", outputs),
        *drop_empty_lists(*list_flow_lines(lookup, component)),
        *_list_setting_lists(component),
        ("nodes", nodes),
        ("findings", tuple(list_finding_lines(lookup, component.id))),
    )
    return ElementCard("component", component.id, component.title, component.at, known_facts(facts), lists)


def _list_component_facts(component: Component, role: str, timing: str, way: str = "") -> list[tuple[str, str]]:
    """Return the facts that components have in common, those that hold others too."""
    type_text = component.component_type or ""
    return [
        ("group", component.group),
        ("parent", component.parent or ""),
        ("is", f"exactly {type_text}" if component.is_reference else type_text),
        ("owner", ", ".join(component.owners) or "?"),
        ("role", role),
        ("functionality", " ".join((component.functionality or "?").split())),
        ("requirements", "; ".join(use.text for use in component.requirements)),
        ("timing", timing),
        ("worst way", way),
        ("tags", ", ".join(component.tags)),
    ]


def _list_setting_lists(holder: Component | ComponentType) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the parameters and the operations of what has such."""
    return drop_empty_lists(
        ("parameters", tuple(list_parameter_lines(holder))), ("operations", tuple(list_operation_lines(holder)))
    )


def make_composed_card(lookup: Lookup, shell: Component) -> ElementCard:
    """Make the card of a component that holds components: its ports, with what stands behind them, and what is inside."""
    architecture = lookup.architecture
    way = "".join(run.text for run in make_whole_fact(lookup, shell.id))
    facts = _list_component_facts(shell, "", timing_words.format_timing_sentence(shell.timing), way)
    inputs = tuple(
        f"{_describe_input(lookup, port)} => {', '.join(architecture.shell_ports[f'input {port.id}']) or 'nobody inside'}"
        for port in shell.inputs.values()
    )
    outputs = tuple(
        f"{port.name} ({port.type or '?'}){_mark_deprecated(port)} <= {', '.join(architecture.shell_ports[f'output {port.id}']) or '?'}"
        f"{' (autoconnect)' if port.is_made else ''}"
        for port in shell.outputs.values()
    )
    lists = (
        ("inputs", inputs),
        ("outputs", outputs),
        ("components", shell.children),
        *_list_setting_lists(shell),
        ("findings", tuple(list_finding_lines(lookup, shell.id))),
    )
    return ElementCard("composed", shell.id, shell.title, shell.at, known_facts(facts), lists)


def make_component_type_card(lookup: Lookup, component_type: ComponentType) -> ElementCard:
    """Make the card of a component type."""
    architecture = lookup.architecture
    facts = [
        ("is", component_type.base or ""),
        ("generic", ", ".join(component_type.generic)),
        ("abstract", "yes" if component_type.is_abstract else ""),
        ("owner", component_type.owner or ""),
        *promise_words.list_card_facts(component_type),
        ("functionality", " ".join((component_type.functionality or "").split())),
    ]
    instances = tuple(
        each.id
        for each in (*architecture.shells.values(), *architecture.components.values())
        if each.type_name == component_type.id
    )
    lists = (
        ("inputs", tuple(f"{name} ({kind or '?'})" for name, kind in component_type.inputs.items())),
        ("outputs", tuple(f"{name} ({kind or '?'})" for name, kind in component_type.outputs.items())),
        ("components", component_type.components),
        *_list_setting_lists(component_type),
        *drop_empty_lists(
            ("frames", tuple(f"{frame.id} in {frame.parent or 'nothing'}" for frame in component_type.frames))
        ),
        ("instances", tuple(dict.fromkeys(instances))),
        ("findings", tuple(list_finding_lines(lookup, component_type.id))),
    )
    return ElementCard(
        "component type", component_type.id, component_type.title, component_type.at, known_facts(facts), lists
    )


def _describe_input(lookup: Lookup, port: Input) -> str:
    sources = "; ".join(_describe_sources(lookup, port)) or "?"
    # Outputs come with their types.
    type_note = f" ({port.type})" if port.type and f"({port.type})" not in sources else ""
    return f"{port.name}{type_note} <- {sources}"


def _describe_sources(lookup: Lookup, port: Input) -> Iterator[str]:
    """Describe where an input gets its data: connections with their types, then what is outside."""
    for connection in port.connections:
        wildcard = "" if connection.kind == "output" else ".*"
        types = dict.fromkeys(lookup.architecture.outputs[output].type or "?" for output in connection.outputs)
        yield f"{connection.target}{wildcard} ({', '.join(types)})"
    if port.external:
        yield f"outside: {port.external}"


def _list_readers(lookup: Lookup, port: Output) -> list[str]:
    """Return who reads an output."""
    readers = [
        connection.input
        for leaf in lookup.architecture.leaf_ports_of("output", port.id)
        for connection in lookup.readers_of.get(leaf, ())
    ]
    return readers + ([f"outside: {port.external}"] if port.external else [])


def _mark_deprecated(port: Output) -> str:
    return " (deprecated)" if port.deprecated else ""


def make_port_card(lookup: Lookup, port: Input | Output) -> ElementCard:
    """Make the card of an input or an output."""
    facts = [
        ("component", port.component),
        ("type", port.type or ("?" if isinstance(port, Output) else "")),
        ("frame", lookup.architecture.frame_of(port) or ""),
        ("medium", word_of_medium(port)),
        ("description", port.description or ""),
    ]
    if isinstance(port, Output):
        facts.append(("message", lookup.architecture.message_of(port) or ("?" if uses_ros(port) else "")))
        facts += promise_words.list_card_facts(port)
        readers = ("readers", tuple(_list_readers(lookup, port)))
        return ElementCard("output", port.id, port.name, port.at, known_facts(facts), (readers,))
    facts.append(("freshness", format_fact(port.freshness)))
    return ElementCard(
        "input",
        port.id,
        port.name,
        port.at,
        known_facts(facts),
        (("sources", tuple(_describe_sources(lookup, port))),),
    )


def make_node_card(lookup: Lookup, node: Node) -> ElementCard:
    """Make the card of a node."""
    endpoints = lookup.endpoints_of.get(node.id, ())
    facts = [
        ("implements", ", ".join(node.implements)),
        ("owner", ", ".join(node.owners) or "?"),
        ("ROS name", "" if node.is_program else node.full_name),
        ("kind", ", ".join(node.kinds)),
        ("status", node.status or "?"),
        ("package", node.package or "?"),
        ("executable", node.executable or ""),
        ("command", shlex.join(node.command)),
        ("start", describe_start(node)),
        *list_running_facts(endpoints),
        ("host", node.host or "?"),
        ("container", node.container or ""),
        ("threads", format_fact(node.threads)),
        ("scheduling", node.scheduling or ""),
        ("callback_groups", timing_words.format_callback_groups(node)),
        ("reentrant", "yes" if node.reentrant else ""),
        (
            "timing",
            "; ".join(filter(None, (timing_words.format_short_timing(timing) for timing in node.timing.values()))),
        ),
    ]
    lines = tuple(
        f"{inline_text.ENDPOINT_USE_WORDS[endpoint.use]} {_describe_endpoint(endpoint)}{_describe_move(endpoint)}"
        f"{_tell_qos(endpoint)}"
        for endpoint in endpoints
    )
    lists = (
        ("topics, services and actions", lines),
        *drop_empty_lists(*list_flow_lines(lookup, node)),
        *drop_empty_lists(("parameters", tuple(list_effective_lines(lookup, node)))),
        ("findings", tuple(list_finding_lines(lookup, node.id))),
    )
    return ElementCard("node", node.id, node.title, node.at, known_facts(facts), lists)


def _describe_endpoint(endpoint: Endpoint) -> str:
    """Return the name of what a node uses with its message; over another medium than ROS, with its type."""
    if endpoint.medium == ROS:
        return f"{endpoint.label} ({endpoint.message or '?'})"
    return f"{name_on_medium(endpoint)} ({name_medium(endpoint.medium)}: {endpoint.type or '?'})"


def _tell_qos(endpoint: Endpoint) -> str:
    """Return the quality of service of a topic's end, also where nobody wrote one, with what overrides it."""
    if endpoint.flow != "topic" or endpoint.medium != ROS:
        return ""
    return ", ".join(filter(None, (f"; {inline_text.format_qos(endpoint.qos)}", describe_override(endpoint))))


def _describe_move(endpoint: Endpoint) -> str:
    """Return what a launch makes of the name that the program says, with the place of the rule; nothing where it is the same."""
    if not endpoint.is_moved:
        return ""
    at = endpoint.evidence["name"].at
    place = f" by {at.file}:{at.line}" if at.line else ""
    return f"; says `{endpoint.program_name}`, is on `{endpoint.label}`{place}"


def make_topic_card(lookup: Lookup, topic: Topic) -> ElementCard:
    """Make the card of a topic, service or action."""
    facts = [
        ("message", ", ".join(topic.messages) or "?"),
        ("types", ", ".join(topic.types)),
        ("size", lookup.format_size(topic)),
    ]
    endpoints_by_role = (("from", topic.writers), ("to", topic.readers))
    lists = tuple(
        (name, tuple(f"{endpoint.node} ({inline_text.format_qos(endpoint.qos)})" for endpoint in endpoints))
        for name, endpoints in endpoints_by_role
    )
    # Nothing declares a topic by itself: its first endpoint that stands in a file has to do.
    span = next(
        (endpoint.at for endpoint in (*topic.writers, *topic.readers) if endpoint.at.file), Span("", 0, 0, 0, 0)
    )
    return ElementCard(topic.flow, topic.name, topic.name, span, known_facts(facts), lists)


def make_channel_card(lookup: Lookup, channel: Topic) -> ElementCard:
    """Make the card of what nodes exchange over another medium."""
    facts = [
        ("medium", name_medium(channel.medium)),
        ("types", ", ".join(channel.types)),
        ("size", lookup.format_size(channel)),
    ]
    users = (*channel.writers, *channel.readers)
    lists = tuple(
        (role, tuple(dict.fromkeys(endpoint.node for endpoint in endpoints)))
        for role, endpoints in (("from", channel.writers), ("to", channel.readers))
    )
    span = next((each.at for each in users if each.at.file), Span("", 0, 0, 0, 0))
    name = name_on_medium(channel)
    return ElementCard(channel.flow, name, name, span, known_facts(facts), lists)
