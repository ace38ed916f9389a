"""An element's card: what `archgen show` prints for one element of any kind."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from archgen.diagnostics.source_span import Span
from archgen.model.architecture import Architecture, UseCase
from archgen.model.component import Component, ComponentType, Group, Input, Output
from archgen.model.deployment import Container
from archgen.model.made_elements import find_made_element
from archgen.model.node import Endpoint, Node, Topic
from archgen.model.parameter import format_parameter
from archgen.model.port_media import ROS, name_medium, name_on_medium, uses_ros, word_of_medium
from archgen.views import inline_text
from archgen.views.elements import promise_words
from archgen.views.elements.annotation_facts import list_annotation_lines
from archgen.views.elements.frame_users import list_frame_users
from archgen.views.elements.parameter_blocks import (
    list_effective_lines,
    list_operation_lines,
    list_parameter_lines,
)
from archgen.views.elements.requirement_facts import list_requirement_facts, list_requirement_parts
from archgen.views.lookup import Lookup
from archgen.views.requirement_servers import describe_chain_state
from archgen.views.sequences.step_words import describe_total, list_step_lines
from archgen.views.start_phrases import describe_start
from archgen.views.tables.type_fields import list_field_lines
from archgen.views.timing.element_timing import make_whole_fact

_COMPONENT_KINDS = frozenset({"component", "composed"})
_NAMED_AFTER_COMPONENTS = frozenset({"node", "frame"})


@dataclass(frozen=True, slots=True)
class ElementCard:
    """Kind, id and title of an element, where it is defined, its facts, and lists below subheadings."""

    kind: str
    id: str
    title: str
    span: Span
    facts: tuple[tuple[str, str], ...]
    lists: tuple[tuple[str, tuple[str, ...]], ...] = ()


def _elements_by_kind(architecture: Architecture) -> dict[str, Mapping[str, Any]]:
    """Return all elements by kind; the keys appear as headings of cards."""
    a = architecture
    return {
        # An id that several kinds share is found in this order.
        "group": a.groups,
        "composed": {shell_id: shell for shell_id, shell in a.shells.items() if shell_id not in a.components},
        "component": a.components,
        "component type": a.component_types,
        "output": {**{port.id: port for each in a.shells.values() for port in each.outputs.values()}, **a.outputs},
        "input": {**{port.id: port for each in a.shells.values() for port in each.inputs.values()}, **a.inputs},
        "node": a.nodes,
        "topic": a.topics,
        "channel": _name_channels(a),
        "type": a.types,
        "requirement": a.requirements,
        "use case": a.use_cases,
        "partner": a.partners,
        "host": a.hosts,
        "container": a.containers,
        "resource": a.resources,
        "link": a.links,
        "frame": a.frames,
        "chain": a.chains,
        "view": a.views,
        "policy": a.policies,
        "variant": a.variants,
    }


def _name_channels(architecture: Architecture) -> Mapping[str, Topic]:
    """Return what runs over other media by the names that are written; what has none is called after its output."""
    channels: dict[str, Topic] = {}
    for key, channel in architecture.channels.items():
        name = name_on_medium(channel)
        if name not in architecture.outputs:
            channels[key if name in channels or name in architecture.topics else name] = channel
    return channels


def kinds_by_id(lookup: Lookup) -> dict[str, list[str]]:
    """Return each element's id with the kinds of element that have it."""
    result: dict[str, list[str]] = {}
    for kind, elements in _elements_by_kind(lookup.architecture).items():
        for element_id in elements:
            result.setdefault(element_id, []).append(kind)
    return result


def find_elements(lookup: Lookup, name: str) -> list[tuple[str, str]]:
    """Find the elements that a name may mean, as (kind, id) pairs.

    Full ids win; then ids that end in the name; then titles of groups and components, ignoring case. A node or a frame
    does not hide the components of its name: most nodes that nobody wrote are called after theirs.
    """
    kinds_of = kinds_by_id(lookup)
    if name in kinds_of:
        has_component_name = _NAMED_AFTER_COMPONENTS.issuperset(kinds_of[name])
        components = _list_components_called(name, kinds_of) if has_component_name else ()
        return [*components, *((kind, name) for kind in kinds_of[name])]
    folded_name = name.casefold()
    # `.` ends a group or component in an id, `/` a namespace in a topic or node: `scan` finds `/lidar/scan`.
    suffix_matches = [
        (kind, key) for key, kinds in kinds_of.items() if key.endswith((f".{name}", f"/{name}")) for kind in kinds
    ]
    if suffix_matches:
        return suffix_matches
    return [
        (kind, key)
        for key, kinds in kinds_of.items()
        for kind in kinds
        if _element_title(lookup, kind, key).casefold() == folded_name
    ]


def _list_components_called(name: str, kinds_of: Mapping[str, Sequence[str]]) -> Iterator[tuple[str, str]]:
    for element_id, kinds in kinds_of.items():
        if element_id.endswith(f".{name}"):
            yield from ((kind, element_id) for kind in kinds if kind in _COMPONENT_KINDS)


def _element_title(lookup: Lookup, kind: str, element_id: str) -> str:
    """Return the title of a group or component, the id of anything else."""
    architecture = lookup.architecture
    if kind == "group":
        return architecture.groups[element_id].title
    if kind == "composed":
        return architecture.shells[element_id].title
    return architecture.components[element_id].title if kind == "component" else element_id


def make_card(lookup: Lookup, kind: str, element_id: str) -> ElementCard:
    """Make the card of one element."""
    make_kind_card = _CARD_MAKERS.get(kind)
    if make_kind_card is None:
        card = _generic_card(lookup, kind, element_id)
    else:
        card = make_kind_card(lookup, _elements_by_kind(lookup.architecture)[kind][element_id])
    further_facts = (
        tuple(_list_further_facts(lookup, kind, element_id)) if kind not in {"topic", "channel", "variant"} else ()
    )
    if (made := find_made_element(lookup.architecture.made_elements, card.span)) is not None:
        further_facts = (*further_facts, ("origin", str(made)))
    return replace(card, facts=(*card.facts, *further_facts)) if further_facts else card


def _list_further_facts(lookup: Lookup, kind: str, element_id: str) -> Iterator[tuple[str, str]]:
    """Yield what elements of several kinds may say: status, contact, picture, documents, properties, hints."""
    element = _elements_by_kind(lookup.architecture)[kind][element_id]
    if kind in {"component", "composed", "component type"}:
        yield from _known_facts([(key, _format_fact(getattr(element, key))) for key in ("status", "contact", "image")])
    if kind in {"input", "output"} and element.urls:
        yield "urls", ", ".join(f"{name}: {address}" for name, address in element.urls.items())
    yield from list_annotation_lines(element)


def _group_card(_lookup: Lookup, group: Group) -> ElementCard:
    facts = [
        ("owner", ", ".join(group.owners) or "?"),
        ("tags", ", ".join(group.tags)),
        ("description", group.description or ""),
    ]
    component_lines = tuple(f"{c.name}: {c.title}" for c in group.components.values())
    return ElementCard(
        "group", group.id, group.title, group.at, _known_facts(facts), (("components", component_lines),)
    )


def _component_card(lookup: Lookup, component: Component) -> ElementCard:
    facts = [
        ("group", component.group),
        *_list_origin_facts(component),
        ("owner", ", ".join(component.owners) or "?"),
        ("role", component.role or "?"),
        ("functionality", " ".join((component.functionality or "?").split())),
        ("requirements", "; ".join(use.text for use in component.requirements)),
        ("timing", inline_text.format_short_timing(component.timing)),
        ("tags", ", ".join(component.tags)),
    ]
    architecture = lookup.architecture
    inputs = tuple(
        f"{port.name} <- {'; '.join(_describe_sources(lookup, port)) or '?'}" for port in component.inputs.values()
    )
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
        *_drop_empty_lists(
            ("parameters", tuple(list_parameter_lines(component))),
            ("operations", tuple(list_operation_lines(component))),
        ),
        ("nodes", nodes),
        ("findings", tuple(_format_findings(lookup, component.id))),
    )
    return ElementCard("component", component.id, component.title, component.at, _known_facts(facts), lists)


def _list_origin_facts(component: Component) -> list[tuple[str, str]]:
    """Return what a component stands in, and what it is made from."""
    type_text = component.component_type or ""
    return [("parent", component.parent or ""), ("is", f"exactly {type_text}" if component.is_reference else type_text)]


def _composed_card(lookup: Lookup, shell: Component) -> ElementCard:
    """Make the card of a component that holds components: its ports, with what stands behind them, and what is inside."""
    architecture = lookup.architecture
    facts = [
        ("group", shell.group),
        *_list_origin_facts(shell),
        ("owner", ", ".join(shell.owners) or "?"),
        ("functionality", " ".join((shell.functionality or "?").split())),
        ("requirements", "; ".join(use.text for use in shell.requirements)),
        ("timing", inline_text.format_timing_sentence(shell.timing)),
        ("worst way", "".join(run.text for run in make_whole_fact(lookup, shell.id))),
        ("tags", ", ".join(shell.tags)),
    ]
    inputs = tuple(
        f"{port.name} <- {'; '.join(_describe_sources(lookup, port)) or '?'}"
        f" => {', '.join(architecture.shell_ports[f'input {port.id}']) or 'nobody inside'}"
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
        *_drop_empty_lists(
            ("parameters", tuple(list_parameter_lines(shell))), ("operations", tuple(list_operation_lines(shell)))
        ),
        ("findings", tuple(_format_findings(lookup, shell.id))),
    )
    return ElementCard("composed", shell.id, shell.title, shell.at, _known_facts(facts), lists)


def _component_type_card(lookup: Lookup, component_type: ComponentType) -> ElementCard:
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
        *_drop_empty_lists(
            ("parameters", tuple(list_parameter_lines(component_type))),
            ("operations", tuple(list_operation_lines(component_type))),
            ("frames", tuple(f"{frame.id} in {frame.parent or 'nothing'}" for frame in component_type.frames)),
        ),
        ("instances", tuple(dict.fromkeys(instances))),
        ("findings", tuple(_format_findings(lookup, component_type.id))),
    )
    return ElementCard(
        "component type", component_type.id, component_type.title, component_type.at, _known_facts(facts), lists
    )


def _drop_empty_lists(*lists: tuple[str, tuple[str, ...]]) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the lists that hold something: of most elements these say nothing, and that is no news."""
    return (each for each in lists if each[1])


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


def _format_findings(lookup: Lookup, element_id: str) -> Iterator[str]:
    """Format the findings about an element."""
    for finding in lookup.findings_of.get(element_id, ()):
        yield f"{finding.severity}[{finding.rule}]: {finding.message}"


def _mark_deprecated(port: Output) -> str:
    return " (deprecated)" if port.deprecated else ""


def _port_card(lookup: Lookup, port: Input | Output) -> ElementCard:
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
        return ElementCard("output", port.id, port.name, port.at, _known_facts(facts), (readers,))
    facts.append(("freshness", _format_fact(port.freshness)))
    return ElementCard(
        "input",
        port.id,
        port.name,
        port.at,
        _known_facts(facts),
        (("sources", tuple(_describe_sources(lookup, port))),),
    )


def _node_card(lookup: Lookup, node: Node) -> ElementCard:
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
        ("host", node.host or "?"),
        ("container", node.container or ""),
        ("threads", _format_fact(node.threads)),
        ("scheduling", node.scheduling or ""),
        ("callback_groups", inline_text.format_callback_groups(node)),
        ("reentrant", "yes" if node.reentrant else ""),
        (
            "timing",
            "; ".join(filter(None, (inline_text.format_short_timing(timing) for timing in node.timing.values()))),
        ),
    ]
    lines = tuple(
        f"{inline_text.ENDPOINT_USE_WORDS[endpoint.use]} {_describe_endpoint(endpoint)}"
        for endpoint in lookup.endpoints_of.get(node.id, ())
    )
    lists = (
        ("topics, services and actions", lines),
        *_drop_empty_lists(("parameters", tuple(list_effective_lines(lookup, node)))),
        ("findings", tuple(_format_findings(lookup, node.id))),
    )
    return ElementCard("node", node.id, node.title, node.at, _known_facts(facts), lists)


def _describe_endpoint(endpoint: Endpoint) -> str:
    """Return the name of what a node uses with its message; over another medium than ROS, with its type."""
    if endpoint.medium == ROS:
        return f"{endpoint.name} ({endpoint.message or '?'})"
    return f"{name_on_medium(endpoint)} ({name_medium(endpoint.medium)}: {endpoint.type or '?'})"


def _topic_card(lookup: Lookup, topic: Topic) -> ElementCard:
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
    return ElementCard(topic.flow, topic.name, topic.name, span, _known_facts(facts), lists)


def _channel_card(lookup: Lookup, channel: Topic) -> ElementCard:
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
    return ElementCard(channel.flow, name, name, span, _known_facts(facts), lists)


def _use_case_card(lookup: Lookup, use_case: UseCase) -> ElementCard:
    facts = [
        ("description", " ".join((use_case.description or "").split())),
        ("actors", ", ".join(f"{actor.id} ({actor.title})" for actor in use_case.actors.values())),
        ("time", describe_total(lookup, use_case.id)),
    ]
    requirement_ids = tuple(r.id for r in lookup.architecture.requirements.values() if use_case.id in r.use_cases)
    lists = (
        *_drop_empty_lists(("steps", tuple(list_step_lines(lookup, use_case)))),
        ("requirements", requirement_ids),
        *_drop_empty_lists(("findings", tuple(_format_findings(lookup, use_case.id)))),
    )
    return ElementCard("use case", use_case.id, use_case.title, use_case.at, _known_facts(facts), lists)


def _generic_card(lookup: Lookup, kind: str, element_id: str) -> ElementCard:
    """Make the card of a kind without a card of its own: fields that exist, and who uses the element."""
    architecture = lookup.architecture
    element = _elements_by_kind(architecture)[kind][element_id]
    facts = [
        # One list of field names serves all these kinds; those that an element lacks are empty and dropped.
        (
            key,
            lookup.format_size(element)
            if kind == "type" and key == "size"
            else _format_fact(getattr(element, key, None)),
        )
        for key in (
            "message",
            "size",
            "comment",
            "description",
            "use_cases",
            "host",
            "cores",
            "threads",
            "scheduling",
            "connects",
            "devices",
            "protocol",
            "bandwidth",
            "frame",
            "parent",
            "by",
            "rate",
            "deadline",
            "show",
            "of",
            "without",
            "drop",
        )
    ]
    lists: list[tuple[str, tuple[str, ...]]] = []
    if kind == "type":
        facts += promise_words.list_card_facts(element)
        facts += [("values", _format_fact(element.values)), ("generic", _format_fact(element.generic))]
        field_lines = tuple(list_field_lines(element))
        lists += [("fields", field_lines)] if field_lines else []
        lists.append(("produced by", tuple(output.id for output in lookup.outputs_of_type.get(element_id, ()))))
    elif kind == "requirement":
        requirement = architecture.requirements[element_id]
        facts += list_requirement_facts(lookup, requirement)
        lists += list_requirement_parts(lookup, requirement)
    elif kind == "partner":
        facts += [("contact", element.contact or ""), ("reviewers", ", ".join(element.reviewers))]
        elements_by_kind = (
            ("groups", architecture.groups),
            ("components", architecture.components),
            ("nodes", architecture.nodes),
        )
        lists += [
            (kind, owned_ids)
            for kind, elements in elements_by_kind
            if (owned_ids := _owned_elements(elements.values(), element_id))
        ]
    elif kind in {"host", "container"}:
        if kind == "host":
            facts.append(("scheduling", inline_text.format_core_orders(element)))
        else:
            facts += _list_process_facts(element)
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
        kind, element_id, getattr(element, "title", element_id), element.at, _known_facts(facts), tuple(lists)
    )


def _list_process_facts(container: Container) -> list[tuple[str, str]]:
    """Return what is written of a container's own node and its program."""
    is_named = container.name is not None or container.namespace != "/"
    return [
        ("ROS name", container.full_name if is_named else ""),
        ("package", container.package or ""),
        ("executable", container.executable or ""),
        ("parameters", format_parameter(container.parameters) if container.parameters else ""),
    ]


def _owned_elements(elements: Iterable[Group | Component | Node], partner_id: str) -> tuple[str, ...]:
    """Return the ids of the elements that a partner owns, alone or with others."""
    return tuple(item.id for item in elements if partner_id in item.owners)


def _format_fact(value: object) -> str:
    """Format a field's value on one line."""
    if value is None:
        return ""
    return ", ".join(map(str, value)) if isinstance(value, tuple) else " ".join(str(value).split())


def _known_facts(facts: list[tuple[str, str]]) -> tuple[tuple[str, str], ...]:
    """Drop facts without a value."""
    return tuple((name, value) for name, value in facts if value)


_CARD_MAKERS: Mapping[str, Callable[[Lookup, Any], ElementCard]] = {
    "group": _group_card,
    "component": _component_card,
    "composed": _composed_card,
    "component type": _component_type_card,
    "input": _port_card,
    "output": _port_card,
    "node": _node_card,
    "topic": _topic_card,
    "channel": _channel_card,
    "use case": _use_case_card,
}
"""What makes the card of an element; other kinds have a list of fields."""
