"""Do the topics and services of nodes agree with the interfaces of their components?"""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from archgen.diagnostic import Diagnostic, Label, Severity
from archgen.source import NOWHERE

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture
    from archgen.model.node import Endpoint, Flow
    from archgen.source import Span


_EVERY_NODE = re.compile(
    r".*/((describe|list|get|set)_parameters|get_parameter_types|set_parameters_atomically|get_type_description"
    r"|change_state|get_(state|available_states|available_transitions|transition_graph)"
    r"|get_logger_levels|set_logger_levels|(un)?load_node|list_nodes)"
)
"""Services of every ROS 2 node (parameters, life cycle, loggers) and container: a design does not list them."""


@dataclass(slots=True)
class _Traffic:
    """Writers and readers of topics and services, and the outputs that inputs name; shared topics are left out."""

    writers: dict[tuple[str, Flow], list[Endpoint]] = field(default_factory=lambda: defaultdict(list))
    readers: list[Endpoint] = field(default_factory=list)
    names_of: dict[str, set[str]] = field(default_factory=lambda: defaultdict(set))
    """The names of topics or services that each output is published under, by output id."""
    named: dict[str, set[str]] = field(default_factory=lambda: defaultdict(set))
    """The ids of all outputs that a component's inputs name, by component id."""
    sources: dict[str, set[str]] = field(default_factory=lambda: defaultdict(set))
    """The ids of the outputs that an input names, by input id."""


def _traffic(architecture: Architecture) -> _Traffic:
    traffic = _Traffic()
    shared = {(topic.name, topic.flow) for topic in architecture.topics.values() if topic.shared}
    for endpoint in architecture.endpoints:
        if (endpoint.name, endpoint.flow) in shared or endpoint.name in architecture.shared_topics:
            continue
        if endpoint.use in {"publishes", "serves"}:
            traffic.writers[endpoint.name, endpoint.flow].append(endpoint)
            if endpoint.port:
                traffic.names_of[endpoint.port].add(endpoint.name)
        else:
            traffic.readers.append(endpoint)
    for edge in architecture.edges:
        traffic.sources[edge.input].add(edge.output)
        traffic.named[architecture.inputs[edge.input].component].add(edge.output)
    return traffic


def unnamed_source(architecture: Architecture) -> Iterator[Diagnostic]:
    """A topic that a component reads also carries an output that none of the component's inputs names.

    Why: Who reads a topic receives all that is published there, from everybody. The design shows fewer sources than the
    robot has: two publishers of one command topic are the usual case.

    Bad:
        groups:
          driving:
            components:
              planner: {outputs: {command: geometry_msgs/msg/Twist}}
              joystick: {outputs: {command: {type: geometry_msgs/msg/Twist, external: The operator's tablet}}}
              base: {inputs: {command: planner.command}}
        nodes:
          planner: {implements: planner, publishes: {command: /cmd_vel}}
          joystick: {implements: joystick, publishes: {command: /cmd_vel}}
          base: {implements: base}

    Good:
        groups:
          driving:
            components:
              planner: {outputs: {command: geometry_msgs/msg/Twist}}
              joystick: {outputs: {command: geometry_msgs/msg/Twist}}
              base: {inputs: {command: [planner.command, joystick.command]}}
        nodes:
          planner: {implements: planner, publishes: {command: /cmd_vel}}
          joystick: {implements: joystick, publishes: {command: /cmd_vel}}
          base: {implements: base}
    """
    traffic = _traffic(architecture)
    # Several nodes and ports of a component may read one topic: one finding for each component and topic.
    told = set[tuple[str, str]]()
    for reader in traffic.readers:
        if reader.port is None or reader.component is None or (reader.component, reader.name) in told:
            continue
        extra = [
            writer
            for writer in traffic.writers.get((reader.name, reader.flow), ())
            if writer.port
            and writer.component != reader.component
            and writer.port not in traffic.named[reader.component]
            and writer.port not in architecture.suspects
        ]
        if extra:
            told.add((reader.component, reader.name))
            outputs = list(dict.fromkeys(f"`{writer.port}`" for writer in extra))
            yield Diagnostic(
                "unnamed-source",
                f"`{reader.name}` also brings {' and '.join(outputs)}, which no input of `{reader.component}` names",
                _place(architecture, reader),
                labels=tuple(Label(_place(architecture, writer), "published here") for writer in extra[:3]),
                help="name it in `from` of the input, or publish it on a topic of its own",
                element=reader.component,
            )


def unaccounted_topic(architecture: Architecture) -> Iterator[Diagnostic]:
    """A node uses a topic or service that no component's interface accounts for.

    Why: Data flows on the robot that the design does not show, or a name is misspelt and nothing flows. A topic that a
    reader writes must be one of its sources'. A topic in `internal` connects the nodes of one component; what comes from
    another component is an input. Topics that all nodes share (`/tf`, `ros: {shared_topics: [...]}`) are left out.

    Bad:
        groups:
          sensing:
            components:
              scanner: {outputs: {scan: sensor_msgs/msg/LaserScan}}
              mapper: {inputs: {scan: scanner.scan}}
        nodes:
          scan_driver: {implements: scanner, publishes: {scan: /scan}}
          mapper: {implements: mapper, subscribes: {scan: /scan_front}}

    Good:
        groups:
          sensing:
            components:
              scanner: {outputs: {scan: sensor_msgs/msg/LaserScan}}
              mapper: {inputs: {scan: scanner.scan}}
        nodes:
          scan_driver: {implements: scanner, publishes: {scan: /scan}}
          mapper: {implements: mapper, subscribes: {scan: /scan}}
    """
    traffic = _traffic(architecture)
    for reader in traffic.readers:
        if not architecture.nodes[reader.node].implements:
            continue  # `unjustified-node` reports the node as a whole
        found = (
            _foreign(architecture, traffic, reader)
            if reader.internal
            else _not_among_sources(architecture, traffic, reader)
        )
        if found:
            yield found


def _foreign(architecture: Architecture, traffic: _Traffic, reader: Endpoint) -> Diagnostic | None:
    """Return a finding if an internal topic or service is not provided by a node of the reader's own component."""
    writers = traffic.writers.get((reader.name, reader.flow), [])
    own = set(architecture.nodes[reader.node].implements)
    strangers = [w for w in writers if own.isdisjoint(architecture.nodes[w.node].implements)]
    what = "topic" if reader.flow == "topic" else reader.flow
    if strangers:
        other = strangers[0]
        message = f"the internal {what} `{reader.name}` comes from `{other.node}`, which is no node of `{min(own)}`"
        cure = f"name `{other.port}` in an input" if other.port else "make it an output there and an input here"
        return _unaccounted(architecture, reader, message, cure, strangers)
    if writers or (reader.flow == "service" and _EVERY_NODE.fullmatch(reader.name)):
        return None
    verb = "publishes" if reader.flow == "topic" else "serves"
    message = f"`{reader.node}` uses the internal {what} `{reader.name}`, and no node of its component {verb} it"
    return _unaccounted(
        architecture, reader, message, "what comes from another component or from outside is an input", []
    )


def _not_among_sources(architecture: Architecture, traffic: _Traffic, reader: Endpoint) -> Diagnostic | None:
    """Return a finding if the topic that a node names for an input is none of its sources' topics."""
    if not reader.name_written or reader.port is None or architecture.inputs[reader.port].external:
        return None
    expected = sorted({name for output in traffic.sources[reader.port] for name in traffic.names_of[output]})
    writers = traffic.writers.get((reader.name, reader.flow), [])
    if not expected or reader.name in expected or any(w.port for w in writers):
        return None  # nothing to compare with, correct, or another output's topic, which `unnamed-source` reports
    meant = {name for output in traffic.sources[reader.port] for name in (output, output.rpartition(".")[0])}
    if not architecture.suspects.isdisjoint(meant):
        return None  # the node of a source names its topic in an entry that could not be resolved: reported already
    entry = architecture.inputs[reader.port]
    listed = " and ".join(f"`{name}`" for name in expected)
    message = f"no source of `{entry.name}` publishes on `{reader.name}`: they use {listed}"
    cure = f"write `{expected[0]}`, or leave the topic out" if len(expected) == 1 else "leave the topic out"
    return _unaccounted(architecture, reader, message, cure, writers)


def _unaccounted(
    architecture: Architecture, reader: Endpoint, message: str, cure: str, writers: list[Endpoint]
) -> Diagnostic:
    labels = tuple(Label(_place(architecture, w), "published here") for w in writers[:3])
    return Diagnostic(
        "unaccounted-topic", message, _place(architecture, reader), labels=labels, help=cure, element=reader.node
    )


def _place(architecture: Architecture, endpoint: Endpoint) -> Span:
    """Return the span of an endpoint, else of its port, else of its node."""
    if endpoint.at != NOWHERE:
        return endpoint.at
    port = architecture.inputs.get(endpoint.port or "") or architecture.outputs.get(endpoint.port or "")
    return port.at if port else architecture.nodes[endpoint.node].at


RULES = (
    (unnamed_source, Severity.WARNING),
    (unaccounted_topic, Severity.WARNING),
)
