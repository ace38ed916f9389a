"""Do the topics and services of nodes agree with the interfaces of their components, each in the section that fits its message?"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping
from functools import cached_property

from archgen.diagnostics import NO_SPAN, Diagnostic, Label, Severity, Span
from archgen.model.architecture import Architecture
from archgen.model.message_types import flow_of
from archgen.model.node import Endpoint, FlowKind, PortUse
from archgen.model.port_media import is_physical

_STANDARD_SERVICES = re.compile(
    r".*/((describe|list|get|set)_parameters|get_parameter_types|set_parameters_atomically|get_type_description"
    r"|change_state|get_(state|available_states|available_transitions|transition_graph)"
    r"|get_logger_levels|set_logger_levels|(un)?load_node|list_nodes)"
)
"""Services of every ROS 2 node (parameters, life cycle, loggers) and container: a design does not list them."""


class _TopicUsers:
    """Writers and readers of topics and services, and the outputs that inputs name; shared topics are left out."""

    def __init__(self, architecture: Architecture) -> None:
        self._architecture = architecture
        self.writers: dict[tuple[str, FlowKind], list[Endpoint]] = {}
        self.readers: list[Endpoint] = []
        shared_topics = {(topic.name, topic.flow) for topic in architecture.topics.values() if topic.shared}
        for endpoint in architecture.endpoints:
            if endpoint.name is None:
                continue
            key = (endpoint.name, endpoint.flow)
            if key in shared_topics or endpoint.name in architecture.shared_topics:
                continue
            if endpoint.use not in {"publishes", "serves"}:
                self.readers.append(endpoint)
            elif key in self.writers:
                self.writers[key].append(endpoint)
            else:
                self.writers[key] = [endpoint]

    @cached_property
    def topics_by_output(self) -> Mapping[str, set[str]]:
        """The names of topics or services that each output is published under, by output id."""
        topics_by_output: dict[str, set[str]] = defaultdict(set)
        for writers in self.writers.values():
            for writer in writers:
                if writer.port:
                    topics_by_output[writer.port].add(writer.label)
        return topics_by_output

    @cached_property
    def left_names(self) -> frozenset[tuple[str | None, str | None]]:
        """The names that rules took outputs away from, each behind the output."""
        writers = (each for named in self.writers.values() for each in named)
        return frozenset((each.port, each.program_name) for each in writers if each.is_moved)

    @cached_property
    def outputs_by_component(self) -> Mapping[str, set[str]]:
        """The ids of all outputs that a component's inputs name, by component id."""
        outputs_by_component: dict[str, set[str]] = defaultdict(set)
        for edge in self._architecture.edges:
            outputs_by_component[self._architecture.inputs[edge.input].component].add(edge.output)
        return outputs_by_component

    @cached_property
    def outputs_by_input(self) -> Mapping[str, set[str]]:
        """The ids of the outputs that an input names, by input id."""
        outputs_by_input: dict[str, set[str]] = defaultdict(set)
        for edge in self._architecture.edges:
            outputs_by_input[edge.input].add(edge.output)
        return outputs_by_input


def unnamed_source(architecture: Architecture) -> Iterator[Diagnostic]:
    """A topic that a component reads also carries an output that none of the component's inputs names."""
    topic_users = _TopicUsers(architecture)
    # Several nodes and ports of a component may read one topic: one finding for each component and topic.
    reported_pairs = set[tuple[str, str]]()
    for reader in topic_users.readers:
        if reader.port is None or reader.component is None or (reader.component, reader.label) in reported_pairs:
            continue
        extra_writers = [
            writer
            for writer in topic_users.writers.get((reader.label, reader.flow), ())
            if writer.port
            and writer.component != reader.component
            and writer.port not in topic_users.outputs_by_component[reader.component]
            and writer.port not in architecture.suspected_ids
        ]
        if extra_writers:
            reported_pairs.add((reader.component, reader.label))
            outputs = list(dict.fromkeys(f"`{writer.port}`" for writer in extra_writers))
            yield Diagnostic(
                "unnamed-source",
                f"`{reader.label}` also brings {' and '.join(outputs)}, which no input of `{reader.component}` names",
                find_endpoint_span(architecture, reader),
                labels=tuple(
                    Label(find_endpoint_span(architecture, writer), "published here") for writer in extra_writers[:3]
                ),
                help="name it in `from` of the input, or publish it on a topic of its own",
                element=reader.component,
            )


def unaccounted_topic(architecture: Architecture) -> Iterator[Diagnostic]:
    """A node uses a topic or service that no component's interface accounts for."""
    topic_users = _TopicUsers(architecture)
    for reader in topic_users.readers:
        if not architecture.nodes[reader.node].implements:
            continue  # `unjustified-node` reports the node as a whole
        finding = (
            _judge_internal_reader(architecture, topic_users, reader)
            if reader.internal
            else _judge_written_topic(architecture, topic_users, reader)
        )
        if finding:
            yield finding


def _judge_internal_reader(architecture: Architecture, topic_users: _TopicUsers, reader: Endpoint) -> Diagnostic | None:
    """Return a finding if an internal topic or service is not provided by a node of the reader's own component."""
    writers = topic_users.writers.get((reader.label, reader.flow), [])
    own_components = set(architecture.nodes[reader.node].implements)
    foreign_writers = [w for w in writers if own_components.isdisjoint(architecture.nodes[w.node].implements)]
    flow_noun = "topic" if reader.flow == "topic" else reader.flow
    if foreign_writers:
        foreign_writer = foreign_writers[0]
        message = f"the internal {flow_noun} `{reader.label}` comes from `{foreign_writer.node}`, which is no node of `{min(own_components)}`"
        cure = (
            f"name `{foreign_writer.port}` in an input"
            if foreign_writer.port
            else "make it an output there and an input here"
        )
        return _report_unaccounted(architecture, reader, message, cure, foreign_writers)
    if writers or (reader.flow == "service" and _STANDARD_SERVICES.fullmatch(reader.label)):
        return None
    verb = "publishes" if reader.flow == "topic" else "serves"
    message = f"`{reader.node}` uses the internal {flow_noun} `{reader.label}`, and no node of its component {verb} it"
    return _report_unaccounted(
        architecture, reader, message, "what comes from another component or from outside is an input", []
    )


def _judge_written_topic(architecture: Architecture, topic_users: _TopicUsers, reader: Endpoint) -> Diagnostic | None:
    """Return a finding if the topic that a node names for an input is none of its sources' topics."""
    if not reader.name_written or reader.port is None or architecture.inputs[reader.port].external:
        return None
    expected_names = sorted(
        {name for output in topic_users.outputs_by_input[reader.port] for name in topic_users.topics_by_output[output]}
    )
    writers = topic_users.writers.get((reader.label, reader.flow), [])
    if not expected_names or reader.label in expected_names or any(w.port for w in writers):
        return None  # nothing to compare with, correct, or another output's topic, which `unnamed-source` reports
    source_ids = {
        name for output in topic_users.outputs_by_input[reader.port] for name in (output, output.rpartition(".")[0])
    }
    if any((output, reader.name) in topic_users.left_names for output in topic_users.outputs_by_input[reader.port]):
        return None  # a rule took the source away from there: `remapped-away` tells it
    if not architecture.suspected_ids.isdisjoint(source_ids):
        return None  # the node of a source names its topic in an entry that could not be resolved: reported already
    entry = architecture.inputs[reader.port]
    expected_list = " and ".join(f"`{name}`" for name in expected_names)
    message = f"no source of `{entry.name}` publishes on `{reader.label}`: they use {expected_list}"
    cure = f"write `{expected_names[0]}`, or leave the topic out" if len(expected_names) == 1 else "leave the topic out"
    return _report_unaccounted(architecture, reader, message, cure, writers)


def _report_unaccounted(
    architecture: Architecture, reader: Endpoint, message: str, cure: str, writers: list[Endpoint]
) -> Diagnostic:
    labels = tuple(Label(find_endpoint_span(architecture, w), "published here") for w in writers[:3])
    return Diagnostic(
        "unaccounted-topic",
        message,
        find_endpoint_span(architecture, reader),
        labels=labels,
        help=cure,
        element=reader.node,
    )


def find_endpoint_span(architecture: Architecture, endpoint: Endpoint) -> Span:
    """Return the span of an endpoint, else of its port, else of its node."""
    if endpoint.at != NO_SPAN:
        return endpoint.at
    port = architecture.inputs.get(endpoint.port or "") or architecture.outputs.get(endpoint.port or "")
    return port.at if port else architecture.nodes[endpoint.node].at


# The section where an entry belongs, by the section where it is written: the direction (out, in) stays the same.
_TOPIC_SECTION = {"publishes": "publishes", "serves": "publishes", "subscribes": "subscribes", "calls": "subscribes"}
_SERVICE_SECTION = {"publishes": "serves", "serves": "serves", "subscribes": "calls", "calls": "calls"}
_FLOW_PHRASES: Mapping[FlowKind, str] = {"topic": "a topic", "service": "a service", "action": "an action"}


def wrong_section(architecture: Architecture) -> Iterator[Diagnostic]:
    """A node lists a service or action among its topics, a topic among its services, or a physical port at all."""
    nodes = [node for node in architecture.nodes.values() if node.uses]
    flows = _flows_of_ports(architecture) if nodes else {}
    for node in nodes:
        for use in node.uses:
            fault = _find_section_fault(architecture, flows, use)
            if fault:
                yield Diagnostic(
                    "wrong-section",
                    f"`{use.key}` of the node `{node.id}` {fault[0]}",
                    use.at,
                    help=fault[1],
                    element=node.id,
                )


def _find_section_fault(
    architecture: Architecture, flows: Mapping[str, set[FlowKind]], use: PortUse
) -> tuple[str, str] | None:
    """Return what is wrong with an entry and what to do about it, or None."""
    port = architecture.outputs.get(use.port or "") or architecture.inputs.get(use.port or "")
    if port and is_physical(port):
        return (
            f"is physical and does not stand below `{use.use}`",
            "leave it out: physical ports have neither topic nor message",
        )
    # A message that the node itself names outranks those of the port. An input may have sources of several kinds: then
    # any of their sections will do.
    actual_flows = {flow_of(use.message)} if use.message else flows.get(use.port or "", set())
    right_sections = {(_TOPIC_SECTION if flow == "topic" else _SERVICE_SECTION)[use.use] for flow in actual_flows}
    if not actual_flows or use.use in right_sections:
        return None
    flow_phrase = " and ".join(_FLOW_PHRASES[flow] for flow in ("topic", "service", "action") if flow in actual_flows)
    section_phrase = " or ".join(f"`{section}`" for section in sorted(right_sections))
    return f"is {flow_phrase}, but stands below `{use.use}`", f"move it to {section_phrase}"


def _flows_of_ports(architecture: Architecture) -> Mapping[str, set[FlowKind]]:
    """Return what flows through each port (topic, service, action) as far as messages are known, by port id."""
    flows: dict[str, set[FlowKind]] = defaultdict(set)
    for output in architecture.outputs.values():
        message = architecture.message_of(output)
        if message:
            flows[output.id].add(flow_of(message))
    for edge in architecture.edges:
        flows[edge.input] |= flows.get(edge.output, set())
    return flows


RULES = (
    (unnamed_source, Severity.WARNING),
    (unaccounted_topic, Severity.WARNING),
    (wrong_section, Severity.WARNING),
)
