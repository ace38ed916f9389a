"""Make the boxes of the implementation level: nodes, and the topics, services and actions between them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Literal

from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint, Node, Qos, Topic
from archgen.views.graphs import boxes
from archgen.views.index import Index
from archgen.views.shapes import Box
from archgen.views.words import short_timing

Side = Literal["left", "right"]


@dataclass(frozen=True, slots=True)
class Pass:
    """What runs from one node to another over a topic; a service or action from client to server."""

    tail: str
    head: str
    topic: Topic
    sentence: str


def node(view: Index, item: Node, *, subject: bool = False) -> Box:
    """Return the box of a node, with its kind, status, rate and host where it is the subject."""
    return Box(
        item.id,
        item.id,
        _lines(view, item) if subject else (),
        style="node",
        emphasis="subject" if subject else "normal",
        status=item.status,
        ref=f"node:{item.id}",
        tooltip="\n".join([f"{item.full_name}", item.title, *_lines(view, item)]),
        badge=boxes.badge(view, item.id),
    )


def neighbour(view: Index, item: Node, side: Side) -> Box:
    """Return the box of a node that is not the subject: grey, at one side."""
    found = node(view, item)
    return replace(found, id=f"{'<' if side == 'left' else '>'}{item.id}", emphasis="neighbour", side=side, badge=None)


def _lines(view: Index, item: Node) -> tuple[str, ...]:
    kinds = " ".join(item.kinds) if item.kinds != ("node",) else ""
    timings = dict.fromkeys(short_timing(timing) for timing in item.timing.values())
    host = view.architecture.hosts.get(item.host or "")
    words = [[kinds, item.status or ""], list(timings), [host.title if host else ""]]
    return tuple(line for line in (" · ".join(word for word in row if word) for row in words) if line)


def topic(item: Topic, used: Iterable[Endpoint] = ()) -> Box:
    """Return the box of a topic, service or action: name, message, and the quality of service where it is not the
    default.
    """
    qos = dict.fromkeys(said for endpoint in used for said in [_qos(endpoint.qos)] if said)
    message = item.messages or (("message open",) if item.flow == "topic" else ())
    return Box(
        f"topic {item.name}",
        item.name,
        (*message[:3], *qos),
        style=item.flow,
        ref=f"topic:{item.name}",
        tooltip="\n".join([item.name, *item.messages, *item.types]),
    )


def _qos(qos: Qos) -> str:
    """Describe in few words what differs from the default."""
    words = ["best effort"] if qos.reliability == "best_effort" else []
    words += ["latched"] if qos.durability == "transient_local" else []
    words += ["keep all"] if qos.history == "keep_all" else []
    words += [f"deadline {qos.deadline}"] if qos.deadline else []
    return ", ".join(words)


def passes(architecture: Architecture) -> tuple[Pass, ...]:
    """Return all that runs between two nodes: each pair of a writer and a reader of a topic, once."""
    found: dict[tuple[str, str, str], Pass] = {}
    for item in architecture.topics.values():
        for writer in item.writers:
            for reader in item.readers:
                if writer.node == reader.node:
                    continue
                ends = (writer.node, reader.node) if item.flow == "topic" else (reader.node, writer.node)
                said = f"{ends[0]} → {item.name} → {ends[1]}"
                found.setdefault((*ends, item.name), Pass(*ends, item, said))
    return tuple(found.values())
