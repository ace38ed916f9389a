"""An element's card: what `archgen show` prints for one element of any kind: of both levels, of other kinds the fields that
they have.
"""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from archgen.compare.kinds import PLAIN_KINDS
from archgen.diagnostics import Span
from archgen.frozen import replace
from archgen.language.language_tables import KEYS
from archgen.model.architecture import UseCase, find_made_element
from archgen.model.component import Component, ComponentType, Group, Input, Output
from archgen.model.node import Endpoint, Node, Topic
from archgen.model.parameter import format_parameter
from archgen.model.port_media import ROS, name_medium, name_on_medium, uses_ros, word_of_medium
from archgen.model.requirement import Requirement, Verification
from archgen.views import inline_text, requirement_servers, timing_words
from archgen.views.elements import port_tables
from archgen.views.elements.annotation_facts import (
    ElementCard,
    drop_empty_lists,
    format_fact,
    known_facts,
    list_annotation_lines,
    list_finding_lines,
)
from archgen.views.elements.element_names import elements_by_kind
from archgen.views.elements.frame_users import list_frame_users
from archgen.views.elements.parameter_blocks import list_effective_lines, list_operation_lines, list_parameter_lines
from archgen.views.elements.type_fields import list_field_lines
from archgen.views.lookup import Lookup
from archgen.views.requirement_servers import describe_chain_state
from archgen.views.sequences.sequence_charts import explain_total, list_step_lines
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
    timing = timing_words.format_short_timing(component.timing)
    facts = _list_component_facts(lookup, component, component.role or "?", timing)
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


def _list_component_facts(
    lookup: Lookup, component: Component, role: str, timing: str, way: str = ""
) -> list[tuple[str, str]]:
    """Return the facts that components have in common, those that hold others too."""
    type_text = component.component_type or ""
    return [
        ("group", component.group),
        ("parent", component.parent or ""),
        ("is", f"exactly {type_text}" if component.is_reference else type_text),
        ("owner", ", ".join(component.owners) or "?"),
        ("role", role),
        ("functionality", " ".join((component.functionality or "?").split())),
        ("requirements", "; ".join(_judge_requirement(lookup, use.text) for use in component.requirements)),
        ("timing", timing),
        ("worst way", way),
        ("tags", ", ".join(component.tags)),
    ]


def _judge_requirement(lookup: Lookup, text: str) -> str:
    """Return what a component names as its requirement, with the state of one that has an id."""
    is_id = text in lookup.architecture.requirements
    return f"{text} ({lookup.requirement_trace.judge(text)})" if is_id else text


def _list_setting_lists(holder: Component | ComponentType) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the parameters and the operations of what has such."""
    return drop_empty_lists(
        ("parameters", tuple(list_parameter_lines(holder))), ("operations", tuple(list_operation_lines(holder)))
    )


def _make_composed_card(lookup: Lookup, shell: Component) -> ElementCard:
    """Make the card of a component that holds components: its ports, with what stands behind them, and what is inside."""
    architecture = lookup.architecture
    way = "".join(run.text for run in make_whole_fact(lookup, shell.id))
    facts = _list_component_facts(lookup, shell, "", timing_words.format_timing_sentence(shell.timing), way)
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


def _make_component_type_card(lookup: Lookup, component_type: ComponentType) -> ElementCard:
    """Make the card of a component type."""
    architecture = lookup.architecture
    facts = [
        ("is", component_type.base or ""),
        ("generic", ", ".join(component_type.generic)),
        ("abstract", "yes" if component_type.is_abstract else ""),
        ("owner", component_type.owner or ""),
        *port_tables.list_card_facts(component_type),
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
        facts += port_tables.list_card_facts(port)
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


def _make_channel_card(lookup: Lookup, channel: Topic) -> ElementCard:
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


_CARD_KEYS = (
    *("message", "size", "comment", "description", "use_cases", "host", "cores", "address", "threads", "scheduling"),
    "discovery_server",
    *("connects", "devices", "owner", "protocol", "bandwidth", "frame", "parent", "by", "rate", "deadline", "show"),
    *("of", "without", "drop"),
)
"""One list of field names for all kinds that say which; those that an element lacks are empty and dropped."""


def make_use_case_card(lookup: Lookup, use_case: UseCase) -> ElementCard:
    """Make the card of a use case."""
    facts = [
        ("description", " ".join((use_case.description or "").split())),
        ("actors", ", ".join(f"{actor.id} ({actor.title})" for actor in use_case.actors.values())),
        ("time", explain_total(lookup, use_case.id)),
    ]
    requirement_ids = tuple(r.id for r in lookup.architecture.requirements.values() if use_case.id in r.use_cases)
    lists = (
        *drop_empty_lists(("steps", tuple(list_step_lines(lookup, use_case)))),
        ("requirements", requirement_ids),
        *drop_empty_lists(("findings", tuple(list_finding_lines(lookup, use_case.id)))),
    )
    return ElementCard("use case", use_case.id, use_case.title, use_case.at, known_facts(facts), lists)


def make_generic_card(lookup: Lookup, kind: str, element_id: str) -> ElementCard:
    """Make the card of a kind without a card of its own: fields that exist, and who uses the element."""
    architecture = lookup.architecture
    element = elements_by_kind(architecture)[kind][element_id]
    facts = [
        (
            key,
            lookup.format_size(element)
            if kind == "type" and key == "size"
            else format_fact(getattr(element, key, None)),
        )
        for key in ([key for key in KEYS[kind] if key != "title"] if kind in PLAIN_KINDS else _CARD_KEYS)
    ]
    lists: list[tuple[str, tuple[str, ...]]] = []
    if kind == "type":
        facts += port_tables.list_card_facts(element)
        facts += [("values", format_fact(element.values)), ("generic", format_fact(element.generic))]
        field_lines = tuple(list_field_lines(element))
        lists += [("fields", field_lines)] if field_lines else []
        lists.append(("produced by", tuple(output.id for output in lookup.outputs_of_type.get(element_id, ()))))
    elif kind == "requirement":
        requirement = architecture.requirements[element_id]
        facts += _list_requirement_facts(lookup, requirement)
        lists += _list_requirement_parts(lookup, requirement)
    elif kind == "partner":
        facts += [("contact", element.contact or ""), ("reviewers", ", ".join(element.reviewers))]
        ownable_elements = (
            ("groups", architecture.groups),
            ("components", architecture.components),
            ("nodes", architecture.nodes),
        )
        lists += [
            (kind, owned_ids)
            for kind, elements in ownable_elements
            if (owned_ids := tuple(item.id for item in elements.values() if element_id in item.owners))
        ]
    elif kind in {"host", "container"}:
        if kind == "host":
            facts.append(("scheduling", timing_words.format_core_orders(element)))
        else:
            is_named = element.name is not None or element.namespace != "/"
            facts += [
                ("ROS name", element.full_name if is_named else ""),
                ("package", element.package or ""),
                ("executable", element.executable or ""),
                ("parameters", format_parameter(element.parameters) if element.parameters else ""),
            ]
        # `kind` names the node's field here: `Node.host` or `Node.container`.
        lists.append(
            ("nodes", tuple(node.id for node in architecture.nodes.values() if getattr(node, kind) == element_id))
        )
    elif kind == "resource":
        lists.append(("used by", tuple(node.id for node in architecture.nodes_using(element_id))))
    elif kind == "frame":
        facts.append(("static", "yes" if element.static else ""))
        lists += list_frame_users(architecture, element)
    elif kind == "variant":
        lists.append(("changes", tuple(f"{change.path}: {change.value}" for change in element.changes)))
    elif kind == "chain":
        chain = architecture.chains[element_id]
        facts += [("state", describe_chain_state(lookup, chain)), ("requirements", "; ".join(chain.requirements))]
        lists.append(("through", tuple(point.id for point in chain.through)))
    return ElementCard(
        kind, element_id, getattr(element, "title", element_id), element.at, known_facts(facts), tuple(lists)
    )


def _list_requirement_facts(lookup: Lookup, requirement: Requirement) -> Iterator[tuple[str, str]]:
    """Yield the facts of a requirement by their keys; empty where nothing is known."""
    yield "state", lookup.requirement_trace.judge(requirement.id)
    yield "parent", ", ".join(requirement.parents)
    for key in ("kind", "priority", "rationale", "source"):
        yield key, " ".join((getattr(requirement, key) or "").split())
    yield "tags", ", ".join(requirement.tags)


def _list_requirement_parts(lookup: Lookup, requirement: Requirement) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the lists below a requirement's card: its parts, what serves it, what verifies it."""
    parts = lookup.requirement_trace.parts.get(requirement.id, ())
    if parts:
        yield "parts", tuple(_name_part(lookup, part) for part in parts)
    yield "served by", tuple(requirement_servers.list_server_words(lookup, requirement))
    verifiers = [_name_verification(lookup, each) for each in requirement.verified_by]
    verifiers += filter(None, [requirement_servers.describe_part_verification(lookup, requirement)])
    if verifiers or lookup.requirement_trace.is_verification_told:
        yield "verified by", tuple(verifiers)


def _name_part(lookup: Lookup, part_id: str) -> str:
    part = lookup.architecture.requirements[part_id]
    title = "" if part.title == part.id else f" {part.title}"
    return f"{part.id}{title} ({lookup.requirement_trace.judge(part_id)})"


def _name_verification(lookup: Lookup, verification: Verification) -> str:
    chain = lookup.architecture.chains.get(verification.text) if verification.kind == "chain" else None
    if chain:
        return f"the chain {requirement_servers.name_chain(lookup, chain)}"
    return f"the use case {verification.text}" if verification.kind == "use_case" else verification.text


def make_card(lookup: Lookup, kind: str, element_id: str) -> ElementCard:
    """Make the card of one element."""
    make_kind_card = _CARD_MAKERS.get(kind)
    if make_kind_card is None:
        card = make_generic_card(lookup, kind, element_id)
    else:
        card = make_kind_card(lookup, elements_by_kind(lookup.architecture)[kind][element_id])
    further_facts = (
        tuple(_list_further_facts(lookup, kind, element_id)) if kind not in {"topic", "channel", "variant"} else ()
    )
    if (made := find_made_element(lookup.architecture.made_elements, card.span)) is not None:
        further_facts = (*further_facts, ("origin", str(made)))
    return replace(card, facts=(*card.facts, *further_facts)) if further_facts else card


def _list_further_facts(lookup: Lookup, kind: str, element_id: str) -> Iterator[tuple[str, str]]:
    """Yield what elements of several kinds may say: status, contact, picture, documents, properties, hints."""
    element = elements_by_kind(lookup.architecture)[kind][element_id]
    if kind in {"component", "composed", "component type"}:
        yield from known_facts([(key, format_fact(getattr(element, key))) for key in ("status", "contact", "image")])
    if kind in {"input", "output"} and element.urls:
        yield "urls", ", ".join(f"{name}: {address}" for name, address in element.urls.items())
    yield from list_annotation_lines(element)


_CARD_MAKERS: Mapping[str, Callable[[Lookup, Any], ElementCard]] = {
    "group": make_group_card,
    "component": make_component_card,
    "composed": _make_composed_card,
    "component type": _make_component_type_card,
    "input": make_port_card,
    "output": make_port_card,
    "node": make_node_card,
    "topic": make_topic_card,
    "channel": _make_channel_card,
    "use case": make_use_case_card,
}
"""What makes the card of an element; other kinds have a list of fields."""
