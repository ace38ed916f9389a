"""Publishers that offer less than another partner's subscriber requests.

If the subscriber alone requests more, its own partner cuts it off: nobody else loses anything.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping

from archgen.analyses.qos_compatibility import QosConflict, find_qos_conflicts
from archgen.compare.losses.change_context import ChangeContext, PartnerLoss, tick_name
from archgen.compare.matched_ids import MatchedIds
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint, Topic
from archgen.model.ros_distro import is_ros_1

WriterKey = tuple[str, str]
"""A written node and its port (a topic's name for internal ones), by common ids."""


def find_weakened_publishers(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find publishers whose offer no longer satisfies what a subscriber asked for before the change.

    What the subscriber asks for now does not matter: otherwise a branch could lower both sides at once.
    """
    if is_ros_1(context.before.distro):
        return
    new_writers = _writers_by_key(context.after, MatchedIds())
    for topic in context.before.topics.values():
        for old_writer, reader in _matching_pairs(context.before, topic):
            if reader.port and not context.needs_source(context.matched_ids.common_id("input", reader.port)):
                continue
            for writer in new_writers.get(_writer_key(old_writer, context.matched_ids), ()):
                # Nearly all offers are as they were: only the others are judged.
                clashes = _find_clashes(writer, reader) if writer.qos != old_writer.qos else ()
                if clashes:
                    yield from _lost_publishers(context, writer, reader, clashes)


def _matching_pairs(architecture: Architecture, topic: Topic) -> Iterator[tuple[Endpoint, Endpoint]]:
    """Yield the publishers and subscribers of a topic that understand each other, those of written nodes."""
    if topic.flow != "topic":
        return
    for writer in topic.writers:
        for reader in topic.readers:
            if (
                architecture.nodes[writer.node].written
                and architecture.nodes[reader.node].written
                and not _find_clashes(writer, reader)
            ):
                yield writer, reader


def _writers_by_key(architecture: Architecture, matched_ids: MatchedIds) -> Mapping[WriterKey, list[Endpoint]]:
    writers: dict[WriterKey, list[Endpoint]] = defaultdict(list)
    for endpoint in architecture.endpoints:
        if endpoint.use == "publishes" and architecture.nodes[endpoint.node].written:
            writers[_writer_key(endpoint, matched_ids)].append(endpoint)
    return writers


def _writer_key(endpoint: Endpoint, matched_ids: MatchedIds) -> WriterKey:
    port = matched_ids.common_id("output", endpoint.port) if endpoint.port else endpoint.name
    return matched_ids.common_id("node", endpoint.node), port


def _lost_publishers(
    context: ChangeContext, writer: Endpoint, reader: Endpoint, clashes: tuple[QosConflict, ...]
) -> Iterator[PartnerLoss]:
    owner = context.before.nodes[reader.node].owner
    if not owner:
        return
    partner = context.matched_ids.common_id("partner", owner)
    indices = context.port_change_indices(writer.node, writer.port or "", "qos") or context.change_indices(
        "node", writer.node
    )
    offered = " and ".join(clash.offered for clash in clashes)
    requested = " and ".join(clash.requested for clash in clashes)
    reader_node = context.matched_ids.common_id("node", reader.node)
    request_note = f"where `{reader_node}` of {partner} asks for {requested}: it receives nothing any more"
    yield from context.losses_of_partner(
        indices, partner, f"offers {offered} on {tick_name(writer.name)}, {request_note}"
    )


def _find_clashes(writer: Endpoint, reader: Endpoint) -> tuple[QosConflict, ...]:
    return tuple(find_qos_conflicts(writer.qos, reader.qos))
