"""Publishers that offer less than another partner's subscriber requests.

If the subscriber alone requests more, its own partner cuts it off: nobody else loses anything.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping

from archgen.analyses.qos_compatibility import QosConflict, find_qos_conflicts
from archgen.compare.losses.change_context import ChangeContext, PartnerLoss
from archgen.compare.losses.loss_wording import tick_name
from archgen.compare.matched_ids import MatchedIds
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint, Topic
from archgen.model.ros_distro import is_ros_1

_OfferChange = tuple[tuple[int, ...], str, str]
"""The indices of the changes, what is offered on which topic now, and what its readers asked for."""
WriterKey = tuple[str, str]
"""A written node and its port (a topic's name for internal ones), by common ids."""


def find_weakened_publishers(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find publishers whose offer no longer satisfies what a subscriber asked for before the change.

    What the subscriber asks for now does not matter: otherwise a branch could lower both sides at once.
    """
    if is_ros_1(context.before.distro):
        return
    new_writers = _writers_by_key(context.after, MatchedIds())
    nodes_by_cause: dict[_OfferChange, dict[str, dict[str, None]]] = {}
    for topic in context.before.topics.values():
        for old_writer, reader in _matching_pairs(context.before, topic):
            if reader.port and not context.needs_source(context.matched_ids.common_id("input", reader.port)):
                continue
            owner = context.before.nodes[reader.node].owner
            for writer in new_writers.get(_writer_key(old_writer, context.matched_ids), ()) if owner else ():
                # Nearly all offers are as they were: only the others are judged.
                clashes = _find_clashes(writer, reader) if writer.qos != old_writer.qos else ()
                if clashes:
                    cause = _describe_clashes(context, writer, clashes)
                    partner = context.matched_ids.common_id("partner", owner or "")
                    nodes = nodes_by_cause.setdefault(cause, {}).setdefault(partner, {})
                    nodes[context.matched_ids.common_id("node", reader.node)] = None
    for (indices, offer, request), nodes_by_partner in nodes_by_cause.items():
        reason_template = f"offers {offer}, where {{}} for {request}: nothing arrives any more"
        yield from context.shared_losses(indices, nodes_by_partner, reason_template, "asks", "wire")


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
    port = matched_ids.common_id("output", endpoint.port) if endpoint.port else endpoint.label
    return matched_ids.common_id("node", endpoint.node), port


def _describe_clashes(context: ChangeContext, writer: Endpoint, clashes: tuple[QosConflict, ...]) -> _OfferChange:
    indices = context.port_change_indices(writer.node, writer.port or "", "qos") or context.change_indices(
        "node", writer.node
    )
    offered = " and ".join(clash.offered for clash in clashes)
    requested = " and ".join(clash.requested for clash in clashes)
    return tuple(indices), f"{offered} on {tick_name(writer.label)}", requested


def _find_clashes(writer: Endpoint, reader: Endpoint) -> tuple[QosConflict, ...]:
    return tuple(find_qos_conflicts(writer.qos, reader.qos))
