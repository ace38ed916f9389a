"""An element's card: what `archgen show` prints for one element of any kind."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from archgen.model.architecture import Architecture
from archgen.model.component import Component, Group, Input, Output
from archgen.model.node import Node, Topic
from archgen.source import Span
from archgen.views import words
from archgen.views.index import Index


@dataclass(frozen=True, slots=True)
class Card:
    """Kind, id and title of an element, where it is defined, its facts, and lists below subheadings."""

    sort: str
    id: str
    title: str
    at: Span
    facts: tuple[tuple[str, str], ...]
    lists: tuple[tuple[str, tuple[str, ...]], ...] = ()


def _sorts(architecture: Architecture) -> dict[str, Mapping[str, Any]]:
    """Return all elements by kind; the keys appear as headings of cards."""
    a = architecture
    return {
        # An id that several kinds share is found in this order.
        "group": a.groups,
        "component": a.components,
        "output": a.outputs,
        "input": a.inputs,
        "node": a.nodes,
        "topic": a.topics,
        "type": a.types,
        "requirement": a.requirements,
        "use case": a.use_cases,
        "partner": a.partners,
        "host": a.hosts,
        "container": a.containers,
        "link": a.links,
        "chain": a.chains,
        "view": a.views,
        "policy": a.policies,
    }


def ids(view: Index) -> dict[str, list[str]]:
    """Return each element's id with the kinds of element that have it."""
    result: dict[str, list[str]] = {}
    for sort, elements in _sorts(view.architecture).items():
        for name in elements:
            result.setdefault(name, []).append(sort)
    return result


def matches(view: Index, name: str) -> list[tuple[str, str]]:
    """Find the elements that a name may mean, as (kind, id) pairs.

    Full ids win; then ids that end in the name; then titles of groups and components, ignoring case.
    """
    known = ids(view)
    if name in known:
        return [(sort, name) for sort in known[name]]
    folded = name.casefold()
    # `.` ends a group or component in an id, `/` a namespace in a topic or node: `scan` finds `/lidar/scan`.
    ending = [(sort, key) for key, sorts in known.items() if key.endswith((f".{name}", f"/{name}")) for sort in sorts]
    if ending:
        return ending
    return [
        (sort, key) for key, sorts in known.items() for sort in sorts if _title(view, sort, key).casefold() == folded
    ]


def _title(view: Index, sort: str, name: str) -> str:
    """Return the title of a group or component, the id of anything else."""
    found = view.architecture
    if sort == "group":
        return found.groups[name].title
    return found.components[name].title if sort == "component" else name


def card(view: Index, sort: str, name: str) -> Card:
    """Make the card of one element."""
    found = view.architecture
    if sort == "group":
        return _group(found.groups[name])
    if sort == "component":
        return _component(view, found.components[name])
    if sort in {"input", "output"}:
        return _port(view, found.inputs[name] if sort == "input" else found.outputs[name])
    if sort == "node":
        return _node(view, found.nodes[name])
    if sort == "topic":
        return _topic(view, found.topics[name])
    return _other(view, sort, name)


def _group(group: Group) -> Card:
    facts = [
        ("owner", ", ".join(group.owners) or "?"),
        ("tags", ", ".join(group.tags)),
        ("description", group.description or ""),
    ]
    listed = tuple(f"{c.name}: {c.title}" for c in group.components.values())
    return Card("group", group.id, group.title, group.at, _shown(facts), (("components", listed),))


def _component(view: Index, component: Component) -> Card:
    facts = [
        ("group", component.group),
        ("owner", ", ".join(component.owners) or "?"),
        ("role", component.role or "?"),
        ("functionality", " ".join((component.functionality or "?").split())),
        ("requirements", "; ".join(use.text for use in component.requirements)),
        ("timing", words.short_timing(component.timing)),
        ("tags", ", ".join(component.tags)),
    ]
    found = view.architecture
    inputs = tuple(f"{port.name} <- {'; '.join(_sources(view, port)) or '?'}" for port in component.inputs.values())
    outputs = tuple(
        f"{port.name} ({port.type or '?'}) -> {', '.join(_readers(view, port)) or 'nobody'}"
        for port in component.outputs.values()
    )
    nodes = tuple(
        f"{node.id} ({found.nodes[node.id].at if node.written else 'still to be decided'})"
        for node in view.nodes_of.get(component.id, ())
    )
    lists = (
        ("inputs", inputs),
        ("outputs", outputs),
        ("nodes", nodes),
        ("findings", tuple(_findings(view, component.id))),
    )
    return Card("component", component.id, component.title, component.at, _shown(facts), lists)


def _sources(view: Index, port: Input) -> Iterator[str]:
    """Describe where an input gets its data: connections with their types, then what is outside."""
    for connection in port.connections:
        star = "" if connection.kind == "output" else ".*"
        types = dict.fromkeys(view.architecture.outputs[output].type or "?" for output in connection.outputs)
        yield f"{connection.target}{star} ({', '.join(types)})"
    if port.external:
        yield f"outside: {port.external}"


def _readers(view: Index, port: Output) -> list[str]:
    """Return who reads an output."""
    readers = [connection.input for connection in view.readers.get(port.id, ())]
    return readers + ([f"outside: {port.external}"] if port.external else [])


def _findings(view: Index, element: str) -> Iterator[str]:
    """Format the findings about an element."""
    for finding in view.findings_of.get(element, ()):
        yield f"{finding.severity}[{finding.rule}]: {finding.message}"


def _port(view: Index, port: Input | Output) -> Card:
    facts = [
        ("component", port.component),
        ("type", port.type or ("?" if isinstance(port, Output) else "")),
        ("medium", "physical" if port.physical else "digital"),
        ("description", port.description or ""),
    ]
    if isinstance(port, Output):
        facts.append(("message", view.architecture.message(port) or ("" if port.physical else "?")))
        readers = ("readers", tuple(_readers(view, port)))
        return Card("output", port.id, port.name, port.at, _shown(facts), (readers,))
    return Card("input", port.id, port.name, port.at, _shown(facts), (("sources", tuple(_sources(view, port))),))


def _node(view: Index, node: Node) -> Card:
    facts = [
        ("implements", ", ".join(node.implements)),
        ("owner", ", ".join(node.owners) or "?"),
        ("ROS name", node.full_name),
        ("kind", ", ".join(node.kinds)),
        ("status", node.status or "?"),
        ("package", node.package or "?"),
        ("executable", node.executable or ""),
        ("host", node.host or "?"),
        ("container", node.container or ""),
        ("timing", "; ".join(filter(None, (words.short_timing(timing) for timing in node.timing.values())))),
    ]
    lines = tuple(
        f"{words.USES[end.use]} {end.name} ({end.message or '?'})" for end in view.endpoints_of.get(node.id, ())
    )
    lists = (("topics, services and actions", lines), ("findings", tuple(_findings(view, node.id))))
    return Card("node", node.id, node.title, node.at, _shown(facts), lists)


def _topic(view: Index, topic: Topic) -> Card:
    """Make the card of a topic, service or action."""
    facts = [
        ("message", ", ".join(topic.messages) or "?"),
        ("types", ", ".join(topic.types)),
        ("size", view.size(topic)),
    ]
    ends = (("from", topic.writers), ("to", topic.readers))
    lists = tuple((name, tuple(f"{end.node} ({words.qos_words(end.qos)})" for end in found)) for name, found in ends)
    # Nothing declares a topic by itself: its first endpoint that stands in a file has to do.
    at = next((end.at for end in (*topic.writers, *topic.readers) if end.at.file), Span("", 0, 0, 0, 0))
    return Card(topic.flow, topic.name, topic.name, at, _shown(facts), lists)


def _other(view: Index, sort: str, name: str) -> Card:
    """Make the card of a kind without a card of its own: fields that exist, and who uses the element."""
    found = view.architecture
    element = _sorts(found)[sort][name]
    facts = [
        # One list of field names serves all these kinds; those that an element lacks are empty and dropped.
        (key, view.size(element) if sort == "type" and key == "size" else _fact(getattr(element, key, None)))
        for key in (
            "message",
            "size",
            "comment",
            "description",
            "use_cases",
            "host",
            "cores",
            "threads",
            "connects",
            "bandwidth",
            "deadline",
            "show",
        )
    ]
    lists: list[tuple[str, tuple[str, ...]]] = []
    if sort == "type":
        lists.append(("produced by", tuple(output.id for output in view.outputs_of_type.get(name, ()))))
    elif sort == "requirement":
        lists.append(("served by", tuple(component.id for component in view.components_for.get(name, ()))))
    elif sort == "partner":
        facts += [("contact", element.contact or ""), ("reviewers", ", ".join(element.reviewers))]
        parts = (("groups", found.groups), ("components", found.components), ("nodes", found.nodes))
        lists += [(sort, owned) for sort, of in parts if (owned := _owned(of.values(), name))]
    elif sort in {"host", "container"}:
        # `kind` names the node's field here: `Node.host` or `Node.container`.
        lists.append(("nodes", tuple(node.id for node in found.nodes.values() if getattr(node, sort) == name)))
    elif sort == "chain":
        lists.append(("through", tuple(point.id for point in found.chains[name].through)))
    return Card(sort, name, getattr(element, "title", name), element.at, _shown(facts), tuple(lists))


def _owned(elements: Iterable[Group | Component | Node], partner: str) -> tuple[str, ...]:
    """Return the ids of the elements that a partner owns, alone or with others."""
    return tuple(each.id for each in elements if partner in each.owners)


def _fact(value: object) -> str:
    """Format a field's value on one line."""
    if value is None:
        return ""
    return ", ".join(map(str, value)) if isinstance(value, tuple) else " ".join(str(value).split())


def _shown(facts: list[tuple[str, str]]) -> tuple[tuple[str, str], ...]:
    """Drop facts without a value."""
    return tuple((name, value) for name, value in facts if value)
