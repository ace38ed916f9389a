"""The shape ExplorerMap: plain rows that the page of the explorer reads; and the rows of what flows.

Rows refer to one another by their position in the other table. The page knows the order of the fields; it is written down
here, and in `assets/explorer/data.js`, which reads them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from archgen.diagnostics import Span
from archgen.frozen import dataclass, field
from archgen.model import flow_graph
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Input, Output
from archgen.model.component_nesting import list_surrounding
from archgen.model.port_media import ROS, label_of_medium, name_on_medium
from archgen.timing.analysis import EventPace
from archgen.views.element_references import place_run
from archgen.views.explorer.column_layout import Path
from archgen.views.graphs.drawn_level import flow_style, list_flows, warn_of_outputs
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.search.search_entry import join_entry_parts, to_plain_text
from archgen.views.timing import value_format

Row = tuple[object, ...]
"""Texts, numbers and tuples of them."""
LINKED_TABLES = frozenset({"groups", "hosts", "components", "shells", "nodes", "topics", "chains", "requirements"})
"""Tables whose first field is an anchor: a site writes the address of its page there."""


@dataclass(frozen=True, slots=True)
class ExplorerMap:
    """The tables of an explorer, by name. Those of an element start with its anchor and its id.

    The places of nodes are those by group and by host; `written in` is file and line, with their address if they have one.

    | table | fields |
    |---|---|
    | `keys` | key, value: what selectors look for |
    | `names` | key, value, title: how people call a value |
    | `types` | name, message |
    | `groups` | anchor, id, title, owners, summary, place among components, place among nodes, written in |
    | `ways` | group, group, places of the lane in each column between them: the lines between groups, none where they are too many |
    | `hosts` | anchor, id, title, line, summary, place, written in |
    | `components` | anchor, id, title, group, line, summary, keys, period, progress, severity, place, written in |
    | `shells` | anchor, id, title, group, shell around, components directly inside, line, summary, keys, severity, place, written in |
    | `nodes` | anchor, id, title, components, group, host, line, summary, keys, period, severity, places, written in |
    | `topics` | anchor, name, flow, and the medium where it is no ROS |
    | `outputs` | component, name, type, note |
    | `inputs` | component, name, type, note, marks (1 optional, 2 joined by autoconnect) |
    | `rims` | shell, is it an output, name, type, note, marks, ports behind it, outputs that feed it: of composed components |
    | `flows` | style, input, outputs, and the medium where it is no ROS: between components |
    | `extra` | tail, head: what feeds a component of which no output is known yet |
    | `links` | tail, head, topic: between nodes |
    | `activities` | id, node, components; wait, response (ns) and reason as the first of a way |
    | `steps` | activity, activity, is it a call; link, wait, response (ns; null: unknown, in brackets: a part) and reason |
    | `chains` | anchor, id, title, status, words, components, nodes |
    | `requirements` | anchor, id, title, components |
    | `findings` | kind (0 component, 1 node, 2 shell), element, severity, message |
    """

    tables: Mapping[str, tuple[Row, ...]] = field(default_factory=dict)


_MAX_SUMMARY = 280
"""Letters of a description that the panel shows; the element's page has all of it."""


def list_path(architecture: Architecture, component: Component) -> Path:
    """Return what is around one of the architecture's `components` on the map, and itself."""
    # What is not designed yet of a composed one stands inside of its frame, under the same id.
    own_frame = (component.id,) if component.id in architecture.shells else ()
    return (component.group, *list_surrounding(architecture, component.id), *own_frame, component.id)


def list_passed_leaves(architecture: Architecture, kind: str, element_id: str) -> Iterable[str]:
    """Return what a chain passes that leads through an element: what gives an output, all that is inside of a component."""
    if kind == "output":
        return [port.rpartition(".")[0] for port in architecture.leaf_ports_of(kind, element_id)]
    return architecture.leaves_of(element_id)


def list_places(lookup: Lookup, span: Span) -> Row:
    """Return file and line of an element, with its address where a repository is configured; empty for no place."""
    place = place_run(lookup, span)
    return tuple(filter(None, (place.text, place.url))) if place else ()


def shorten_description(*texts: str | None) -> str:
    """Return the begin of a description, on one line."""
    text = to_plain_text(*texts)
    return text if len(text) <= _MAX_SUMMARY else f"{text[:_MAX_SUMMARY].rsplit(' ', 1)[0]} …"


def describe_paces(paces: Iterable[EventPace | None]) -> str:
    """Return a short line on how often something happens: `15 Hz, event`, `2 activities`."""
    words = dict.fromkeys(_describe_pace(pace) for pace in paces if pace)
    texts = [word.replace("<=", "≤").replace(">=", "≥") for word in words if word != "?"]
    return texts[0] if len(texts) == 1 else count_noun(len(texts), "rate") if texts else ""


def _describe_pace(pace: EventPace) -> str:
    """Return a rate without its period, and the behaviour: a box is narrow."""
    first_line, *more_lines = value_format.format_box_lines(pace)
    # A long figure takes two lines, the period being the second; what is not periodic says so on the last one.
    behaviour = more_lines[-1:] if pace.behaviour != "periodic" else ()
    return ", ".join((first_line.partition(" · ")[0], *behaviour))


def find_shortest_step(paces: Iterable[EventPace | None]) -> str:
    """Return the step of the period scale that is shortest, `unknown` where nothing is known."""
    order = list(value_format.PERIOD_STEP_WORDS)
    return min((value_format.find_period_step(pace) for pace in paces), key=order.index, default="unknown")


_OPTIONAL, _MADE = 1, 2
_STYLES = ("data", "physical", "service", "action")

Numbers = Mapping[str, int]
"""The positions of elements in their table, by id."""


def make_flow_tables(
    lookup: Lookup, components: Numbers, nodes: Numbers, shells: Iterable[Component]
) -> dict[str, tuple[Row, ...]]:
    """Make the tables of ports, of flows between shown components, and of topics between shown nodes."""
    architecture = lookup.architecture
    types = {name: number for number, name in enumerate(architecture.types)}
    outputs = [port for port in architecture.outputs.values() if port.component in components]
    inputs = [port for port in architecture.inputs.values() if port.component in components]
    output_numbers = {port.id: number for number, port in enumerate(outputs)}
    input_numbers = {port.id: number for number, port in enumerate(inputs)}
    flows = tuple(_list_flow_rows(architecture, input_numbers, output_numbers))
    topics: dict[str, int] = {}
    links = tuple(_list_link_rows(architecture, nodes, topics))
    return {
        "outputs": tuple((*_port_row(port, components, types), warn_of_outputs(lookup, (port,))) for port in outputs),
        "inputs": tuple((*_port_row(port, components, types), _mark_input(port)) for port in inputs),
        "rims": tuple(_list_rim_rows(architecture, shells, types, {"input": input_numbers, "output": output_numbers})),
        "flows": flows,
        "extra": tuple(_list_extra_steps(architecture, components, flows, outputs, inputs)),
        "topics": tuple(_make_carrier_rows(architecture, topics)),
        "links": links,
    }


def _port_row(port: Input | Output, components: Numbers, types: Numbers) -> Row:
    note = join_entry_parts(port.external, label_of_medium(port))
    return (components[port.component], port.name, types.get(port.type or "", -1), note)


def _mark_input(port: Input) -> int:
    """Return what is special about an input, as bits. `autoconnect` joins only what has no source: all of it is made, or none."""
    is_made = bool(port.connections) and all(connection.is_made for connection in port.connections)
    return _OPTIONAL * port.optional + _MADE * is_made


def _list_rim_rows(
    architecture: Architecture, shells: Iterable[Component], types: Numbers, leaf_numbers: Mapping[str, Numbers]
) -> Iterator[Row]:
    """Yield the ports of composed components, with the ports of leaves that stand behind each."""
    for number, shell in enumerate(shells):
        ports: tuple[Input | Output, ...] = (*shell.inputs.values(), *shell.outputs.values())
        for port in ports:
            kind = "input" if isinstance(port, Input) else "output"
            behind = architecture.leaf_ports_of(kind, port.id)
            numbers = tuple(leaf_numbers[kind][each] for each in behind if each in leaf_numbers[kind])
            marks = _mark_input(port) if isinstance(port, Input) else 0
            _, *values = _port_row(port, {shell.id: number}, types)
            yield (number, int(kind == "output"), *values, marks, numbers, _list_sources(port, leaf_numbers["output"]))


def _list_sources(port: Input | Output, outputs: Numbers) -> tuple[int, ...]:
    """Return the outputs that feed an input from outside."""
    connections = port.connections if isinstance(port, Input) else ()
    return tuple(outputs[each] for connection in connections for each in connection.outputs if each in outputs)


def _list_flow_rows(architecture: Architecture, inputs: Numbers, outputs: Numbers) -> Iterator[Row]:
    """Yield each flow between two shown components. It runs from its outputs, a call from the input to them."""
    for flow in list_flows(architecture):
        connection = flow.connection
        producer = flow.head if flow.style in {"service", "action"} else flow.tail
        numbers = tuple(
            outputs[output]
            for output in connection.outputs
            if output in outputs and architecture.outputs[output].component == producer
        )
        if numbers and connection.input in inputs:
            style = flow_style(
                architecture,
                next(name for name in connection.outputs if architecture.outputs[name].component == producer),
            )
            row = (_STYLES.index(style), inputs[connection.input], numbers)
            yield (*row, flow.medium) if flow.medium else row


def _list_extra_steps(
    architecture: Architecture, components: Numbers, flows: tuple[Row, ...], outputs: list[Output], inputs: list[Input]
) -> Iterator[Row]:
    """Yield the steps that selectors take and no flow shows: from components of which no output is known yet, ..."""
    known_steps = set()
    for style, reader, numbers, *_ in flows:
        for number in numbers:  # type: ignore[attr-defined]
            ends = (outputs[number].component, inputs[reader].component)  # type: ignore[call-overload]
            known_steps.add(ends)
            if style in {_STYLES.index("service"), _STYLES.index("action")}:
                known_steps.add(ends[::-1])
    for tail, heads in flow_graph.build_component_graph(architecture).successors.items():
        for head in heads:
            if tail in components and head in components and (tail, head) not in known_steps:
                yield (components[tail], components[head])


def _list_link_rows(architecture: Architecture, nodes: Numbers, topics: dict[str, int]) -> Iterator[Row]:
    """Yield what runs between two shown nodes over a topic, a call from client to server; add to `topics` which."""
    seen_links = set()
    for key, topic in architecture.list_carriers():
        for writer in topic.writers:
            for reader in topic.readers:
                # As in `model.flow_graph`: of a shared topic only what the reader's input names.
                if (topic.shared and writer.port not in reader.sources) or writer.node == reader.node:
                    continue
                ends = (writer.node, reader.node) if topic.flow == "topic" else (reader.node, writer.node)
                if ends[0] in nodes and ends[1] in nodes and (*ends, key) not in seen_links:
                    seen_links.add((*ends, key))
                    yield (nodes[ends[0]], nodes[ends[1]], topics.setdefault(key, len(topics)))


def _make_carrier_rows(architecture: Architecture, keys: Iterable[str]) -> Iterator[Row]:
    """Yield the rows of topics, and of what runs over other media."""
    carriers = dict(architecture.list_carriers())
    for key in keys:
        carrier = carriers[key]
        row = (f"topic:{key}" if carrier.medium == ROS else f"channel:{key}", name_on_medium(carrier), carrier.flow)
        yield (*row, label) if (label := label_of_medium(carrier)) else row
