"""The graph of a running robot as what was observed: the nodes of a dump with what they use, each with its line."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from archgen.plugin.importing import (
    ForeignFileError,
    ObservationOptions,
    ObservedEndpoint,
    ObservedNode,
    ObservedRobot,
    Span,
    read_bounded,
)
from archgen.plugin.model import FlowKind, UseKind, parse_quantity
from archgen.plugin.ros import full_message_name
from archgen.plugins.ros.running_graph.dump_lines import (
    MAX_DUMP_BYTES,
    USES,
    RunningGraph,
    RunningNode,
    read_dump_lines,
)
from archgen.plugins.ros.running_graph.ros_1_dump import read_ros_1_dump
from archgen.plugins.ros.running_graph.ros_2_dump import read_ros_2_dump
from archgen.plugins.ros.workspace.program_reading import flatten_parameters

_ROS_1 = re.compile(rb"^(?:\$ ros(?:node|topic|service|param) |Node \[/|Publications:)", re.MULTILINE)
_HEAD_BYTES = 1_000_000
_DURATIONS = ("deadline", "lifespan", "lease_duration")


def observe_graph(path: Path, _options: ObservationOptions) -> ObservedRobot | None:
    """Read a dump of ROS 1 or ROS 2; None for what is no text. Raise ForeignFileError where there is no node in it."""
    if not path.is_file():
        return None
    head = read_bounded(path, MAX_DUMP_BYTES)[:_HEAD_BYTES]
    if b"\0" in head:
        return None
    is_ros_1 = _ROS_1.search(head) is not None
    graph = RunningGraph(is_ros_1=is_ros_1)
    (read_ros_1_dump if is_ros_1 else read_ros_2_dump)(read_dump_lines([path]), graph)
    if not graph.nodes:
        words = "there is no node in it"
        help_line = "give what `archgen conform --recorder` records on the robot, or what `ros2 node info NAME` prints of each node"
        raise ForeignFileError(words, Span.of_file(path.name), help_line)
    nodes = tuple(
        ObservedNode(
            node.full_name,
            node.count,
            flatten_parameters(node.parameters) if node.parameters else None,
            # Of a node that is only listed nobody asked what it uses.
            has_known_uses=any(node.uses.values()),
            state=node.state,
            host=node.host,
            at=node.span,
        )
        for node in graph.nodes.values()
    )
    endpoints = tuple(each for node in graph.nodes.values() for each in _list_endpoints(graph, node))
    unseen: frozenset[UseKind] = frozenset({"calls"} if is_ros_1 else ())
    unread = tuple(f"{note.span}: {note.message}" for note in graph.notes if note.fate == "not taken")
    return ObservedRobot(
        str(path),
        "graph",
        nodes,
        endpoints,
        unseen_uses=unseen,
        has_all_parameters=not is_ros_1,
        unread=unread,
    )


def read_recorder() -> str:
    """Return the program that records the graph of a running robot: a file that needs nothing of archgen."""
    return Path(__file__).with_name("graph_recorder.py").read_text(encoding="utf-8")


def _list_endpoints(graph: RunningGraph, node: RunningNode) -> Iterator[ObservedEndpoint]:
    for use in USES:
        for name, own_message in node.uses[use].items():
            message = full_message_name(own_message or graph.messages.get(name, "")) or None
            flow: FlowKind = "topic" if use in {"publishes", "subscribes"} else "service"
            if message is not None and "/action/" in message:
                flow = "action"
            qos = _read_qos(node.qos.get((use, name), {}))
            at = node.places.get((use, name), node.span)
            yield ObservedEndpoint(node.full_name, use, flow, name, message, qos, at=at)


def _read_qos(said: Mapping[str, Any]) -> dict[str, Any]:
    """Return the policies that are on the wire, which queues are not."""
    qos = {policy: value for policy, value in said.items() if policy not in {"history", "depth"}}
    return {key: parse_quantity(each, "duration") if key in _DURATIONS and each else each for key, each in qos.items()}
