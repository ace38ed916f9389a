"""The implementation level in documents: a node, its endpoints, its parameters and where it runs."""

from __future__ import annotations

from archgen.model.node import Endpoint, Node
from archgen.views import timing_of, words
from archgen.views.index import Index
from archgen.views.shapes import Block, Column, Facts, Figure, Inlines, Markdown, Paragraph, Table, Text

_ORDER = {"subscribes": 0, "publishes": 1, "serves": 2, "calls": 3}
"""Endpoints are listed in the direction of the data: inputs, outputs, then services and actions."""
_LABELS = {"subscribes": "subscribes", "publishes": "publishes", "serves": "serves", "calls": "calls"}


def implementation_blocks(view: Index, component: str) -> tuple[Block, ...]:
    """Return the figure of a component's nodes with their neighbours."""
    title = view.architecture.components[component].title
    return (
        Figure(
            f"figure:implementation/{component}",
            f"implementation/{component}",
            f"{title}: implementation",
            f"The nodes that implement {title} with their topics, services and actions.",
        ),
    )


def node_blocks(view: Index, node: Node) -> tuple[Block, ...]:
    """Describe a node: facts, endpoints and parameters."""
    blocks: list[Block] = []
    if not node.written:
        blocks.append(
            Paragraph(words.text("Nobody has decided yet which node implements this: a planned one stands in."), "note")
        )
    blocks.append(Facts(tuple(_facts(view, node))))
    if node.description:
        blocks.append(Markdown(node.description))
    endpoints = view.endpoints_of.get(node.id, ())
    if endpoints:
        blocks.append(_endpoint_table(node, endpoints))
    else:
        blocks.append(Paragraph(words.text(Text("It uses no topic, service or action.", muted=True))))
    if node.parameters:
        blocks.append(_parameter_table(node))
    return tuple(blocks)


def _facts(view: Index, node: Node) -> list[tuple[str, Inlines]]:
    """Return a node's facts, without those that have no value."""
    found = view.architecture
    kind = ", ".join(words.KINDS[kind] for kind in node.kinds)
    rows = [
        ("Implements", words.joined((words.component_link(found.components[c]),) for c in node.implements)),
        ("ROS name", words.text(Text(node.full_name, code=True))),
        ("Kind, status", words.text(f"{kind}, ", *words.maybe(node.status))),
        ("Package", (*words.maybe(node.package), *_program(node))),
        ("Owner", words.owner_links(found, node.owners) if node.owners else ()),
        ("Runs on", _place(node)),
        ("Parameter files", words.joined((Text(name, code=True),) for name in node.parameter_files)),
        ("Tags", words.text(", ".join(node.tags)) if node.tags else ()),
        ("Links", words.urls(node.urls.items())),
    ]
    for component, timing in node.timing.items():
        # One timing for each activity; the key is "" for a node that implements no component.
        name = f"Timing of {component.rsplit('.', 1)[-1]}" if len(node.timing) > 1 and component else "Timing"
        said = words.timing_sentence(timing)
        rows.append((name, words.text(said) if said else ()))
    rows += timing_of.node_facts(view, node)
    return [(name, value) for name, value in rows if value]


def _program(node: Node) -> Inlines:
    """Return the executable and the plugin of a node, each after a comma."""
    parts = (("executable", node.executable), ("plugin", node.plugin))
    return tuple(part for name, value in parts if value for part in (Text(f", {name} "), Text(value, code=True)))


def _place(node: Node) -> Inlines:
    """Return the host of a node, and the container whose process it shares."""
    host = _linked(node.host, "host") or words.UNKNOWN
    return (*host, Text(", in the process "), *_linked(node.container, "container")) if node.container else host


def _linked(name: str | None, kind: str) -> Inlines:
    """Link to an element by its id; empty for None."""
    return words.text(Text(name, ref=f"{kind}:{name}")) if name else ()


def _endpoint_table(node: Node, endpoints: tuple[Endpoint, ...]) -> Table:
    rows = tuple(
        (
            words.text(_LABELS[endpoint.use]),
            words.text(words.topic_link(endpoint.name), *_internal(endpoint)),
            words.text(Text(endpoint.message, code=True)) if endpoint.message else words.UNKNOWN,
            words.text(Text(endpoint.port.rsplit(".", 1)[-1], code=True)) if endpoint.port else (),
            words.qos_cell(endpoint.qos) if endpoint.flow == "topic" else (),
        )
        for endpoint in sorted(endpoints, key=lambda e: _ORDER[e.use])
    )
    columns = (Column("Use", 0.7), Column("Name", 1.9), Column("Message", 2.0), Column("Port", 0.8), Column("QoS", 1.3))
    return Table(f"table:endpoints/{node.id}", f"{node.id}: topics, services and actions", columns, rows)


def _internal(endpoint: Endpoint) -> Inlines:
    return (Text(" internal", muted=True),) if endpoint.internal else ()


def _parameter_table(node: Node) -> Table:
    rows = tuple((words.text(Text(name, code=True)), words.text(Text(value, code=True))) for name, value in _flat(node))
    columns = (Column("Parameter"), Column("Value"))
    return Table(f"table:parameters/{node.id}", f"{node.id}: parameters", columns, rows)


def _flat(node: Node) -> list[tuple[str, str]]:
    """Return nested parameters as (dotted name, text) pairs, as `ros2 param list` shows them."""
    rows: list[tuple[str, str]] = []
    # A stack taken from its end: it is filled in reverse, so that parameters keep the order of the file.
    rest: list[tuple[str, object]] = list(node.parameters.items())[::-1]
    while rest:
        name, value = rest.pop()
        # An empty mapping has no leaf to show, so it is written as a value.
        if isinstance(value, dict) and value:
            rest += [(f"{name}.{key}", item) for key, item in reversed(list(value.items()))]
        else:
            rows.append((name, _value(value)))
    return rows


def _value(value: object) -> str:
    """Format a parameter in YAML's spelling."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return f"[{', '.join(_value(item) for item in value)}]"
    return "" if value is None else str(value)
