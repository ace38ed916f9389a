"""Endpoints that follow from coordinate frames: who writes one publishes `/tf`, of a static one `/tf_static`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from archgen.derivation.wire.remap_rules import NodeNames
from archgen.model.architecture import Architecture
from archgen.model.coordinate_frames import Frame
from archgen.model.node import Endpoint, Node, Qos
from archgen.model.runtime_facts import TRANSFORM_MESSAGE

# tf2_ros/qos.hpp: DynamicBroadcasterQoS and StaticBroadcasterQoS.
_QOS_BY_TOPIC = {"/tf": Qos(depth=100), "/tf_static": Qos(durability="transient_local", depth=1)}


def index_written_frames(architecture: Architecture) -> Mapping[str, tuple[Frame, ...]]:
    """Return the frames that each node writes, by node id.

    Of a component with several nodes nobody knows which one writes them: as with ports, each has to say what it carries.
    """
    if not architecture.frames:
        return {}
    writing_nodes: dict[tuple[str, str], list[str]] = {}
    for node in architecture.nodes.values():
        writing_nodes.setdefault(("node", node.id), []).append(node.id)
        for component in (*node.implements, *node.wholes):
            writing_nodes.setdefault(("component", component), []).append(node.id)
    frames_by_node: dict[str, tuple[Frame, ...]] = {}
    for frame in architecture.frames.values():
        nodes = writing_nodes.get((frame.by_kind, frame.by or ""), ())
        # A root is placed in nothing: there is nothing to write.
        if len(nodes) == 1 and frame.parent is not None:
            frames_by_node[nodes[0]] = (*frames_by_node.get(nodes[0], ()), frame)
    return frames_by_node


def derive_frame_endpoints(
    node: Node, distro: str | None, written_frames: Iterable[Frame], own_endpoints: Sequence[Endpoint]
) -> Iterator[Endpoint]:
    """Yield what a node publishes for its frames, less the topics that it names itself (in a namespace too)."""
    written_topics = {endpoint.label.rpartition("/")[2] for endpoint in own_endpoints if endpoint.use == "publishes"}
    first_frames: dict[str, Frame] = {}
    for frame in written_frames:
        if frame.topic.removeprefix("/") not in written_topics:
            first_frames.setdefault(frame.topic, frame)
    names = NodeNames(node, distro)
    for topic, frame in first_frames.items():
        wire = names.name_end(topic, None, "topic")
        yield Endpoint(
            node=node.id,
            use="publishes",
            name=wire.name,
            program_name=wire.program_name,
            evidence=wire.evidence,
            flow="topic",
            port=None,
            component=frame.by if frame.by in node.implements else next(iter(node.implements), None),
            message=TRANSFORM_MESSAGE,
            qos=_QOS_BY_TOPIC[topic],
            internal=True,
            at=frame.at,
        )
