"""Make the boxes of the implementation level: nodes, and the topics, services and actions between them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from archgen.frozen import dataclass, replace
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint, Node, Qos, Topic
from archgen.model.port_media import ROS, key_of_channel, label_of_carrier, name_medium, name_on_medium
from archgen.views.graph_shapes import Box
from archgen.views.graphs import element_boxes
from archgen.views.lookup import Lookup
from archgen.views.timing_words import format_short_timing

BoxSide = Literal["left", "right"]


@dataclass(frozen=True, slots=True)
class NodeFlow:
    """What runs from one node to another over a topic; a service or action from client to server."""

    tail: str
    head: str
    topic: Topic
    sentence: str


def node_box(lookup: Lookup, node: Node, *, is_subject: bool = False) -> Box:
    """Return the box of a node, with its kind, status, rate and host where it is the subject."""
    return Box(
        node.id,
        node.id,
        _node_lines(lookup, node) if is_subject else (),
        style="node",
        emphasis="subject" if is_subject else "normal",
        status=node.status,
        ref=f"node:{node.id}",
        tooltip="\n".join([f"{node.full_name}", node.title, *_node_lines(lookup, node)]),
        badge=element_boxes.worst_severity(lookup, node.id),
    )


def neighbour_node_box(lookup: Lookup, node: Node, side: BoxSide) -> Box:
    """Return the box of a node that is not the subject: grey, at one side."""
    box = node_box(lookup, node)
    return replace(box, id=f"{'<' if side == 'left' else '>'}{node.id}", emphasis="neighbour", side=side, badge=None)


def _node_lines(lookup: Lookup, node: Node) -> tuple[str, ...]:
    kinds = " ".join(node.kinds) if node.kinds != ("node",) else ""
    timings = dict.fromkeys(format_short_timing(timing) for timing in node.timing.values())
    host = lookup.architecture.hosts.get(node.host or "")
    words = [[kinds, node.status or ""], list(timings), [host.title if host else ""]]
    return tuple(line for line in (" · ".join(word for word in row if word) for row in words) if line)


def topic_box(topic: Topic, endpoints: Iterable[Endpoint] = ()) -> Box:
    """Return the box of a topic, service or action: name, message, and the quality of service where it is not the
    default.
    """
    if topic.medium != ROS:
        return _draw_channel(topic)
    qos = dict.fromkeys(said for endpoint in endpoints for said in [_describe_qos(endpoint.qos)] if said)
    message = topic.messages or (("message open",) if topic.flow == "topic" else ())
    return Box(
        f"topic {topic.name}",
        topic.name,
        (*message[:3], *qos),
        style=topic.flow,
        ref=f"topic:{topic.name}",
        tooltip="\n".join([topic.name, *topic.messages, *topic.types]),
    )


def _draw_channel(channel: Topic) -> Box:
    """Return the box of what is no ROS: name, type, and the medium in brackets."""
    name, medium = name_on_medium(channel), f"({name_medium(channel.medium)})"
    lines = (*channel.types[:3], medium)
    return Box(
        f"topic {channel.name}",
        name,
        lines,
        style=channel.flow,
        ref=f"channel:{key_of_channel(channel)}",
        tooltip="\n".join((name, *channel.types, medium)),
    )


def _describe_qos(qos: Qos) -> str:
    """Describe in few words what differs from the default."""
    words = ["best effort"] if qos.reliability == "best_effort" else []
    words += ["latched"] if qos.durability == "transient_local" else []
    words += ["keep all"] if qos.history == "keep_all" else []
    words += [f"deadline {qos.deadline}"] if qos.deadline else []
    return ", ".join(words)


def list_node_flows(architecture: Architecture) -> tuple[NodeFlow, ...]:
    """Return all that runs between two nodes: each pair of a writer and a reader of a topic, once."""
    flows: dict[tuple[str, str, str], NodeFlow] = {}
    for _, topic in architecture.list_carriers():
        for writer in topic.writers:
            for reader in topic.readers:
                if writer.node == reader.node:
                    continue
                ends = (writer.node, reader.node) if topic.flow == "topic" else (reader.node, writer.node)
                sentence = f"{ends[0]} → {label_of_carrier(topic)} → {ends[1]}"
                flows.setdefault((*ends, topic.name), NodeFlow(*ends, topic, sentence))
    return tuple(flows.values())
