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

EndpointKey = tuple[str, str, str]
"""A written node, its port (a topic's name for internal ones) and its use, by common ids."""


def find_weakened_publishers(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find pairs of publisher and subscriber that no longer match because of what is offered."""
    if is_ros_1(context.after.distro):
        return
    old_endpoints: Mapping[EndpointKey, list[Endpoint]] | None = None
    for topic in context.after.topics.values():
        for writer, reader in _incompatible_pairs(context.after, topic):
            # Built only when the first unmatched pair appears; most comparisons have none.
            old_endpoints = (
                _endpoints_by_key(context.before, context.matched_ids) if old_endpoints is None else old_endpoints
            )
            yield from _lost_publishers(context, topic.name, (writer, reader), old_endpoints)


def _incompatible_pairs(architecture: Architecture, topic: Topic) -> Iterator[tuple[Endpoint, Endpoint]]:
    if topic.flow != "topic":
        return
    for writer in topic.writers:
        for reader in topic.readers:
            if next(find_qos_conflicts(writer.qos, reader.qos), None) is None:
                continue
            if architecture.nodes[writer.node].written and architecture.nodes[reader.node].written:
                yield writer, reader


def _endpoints_by_key(architecture: Architecture, matched_ids: MatchedIds) -> Mapping[EndpointKey, list[Endpoint]]:
    endpoints: dict[EndpointKey, list[Endpoint]] = defaultdict(list)
    for endpoint in architecture.endpoints:
        endpoints[_endpoint_key(endpoint, matched_ids)].append(endpoint)
    return endpoints


def _endpoint_key(endpoint: Endpoint, matched_ids: MatchedIds) -> EndpointKey:
    kind = "output" if endpoint.use in {"publishes", "serves"} else "input"
    return (
        matched_ids.common_id("node", endpoint.node),
        matched_ids.common_id(kind, endpoint.port) if endpoint.port else endpoint.name,
        endpoint.use,
    )


def _lost_publishers(
    context: ChangeContext,
    topic_name: str,
    endpoint_pair: tuple[Endpoint, Endpoint],
    old_endpoints: Mapping[EndpointKey, list[Endpoint]],
) -> Iterator[PartnerLoss]:
    writer, reader = endpoint_pair
    old_writers, old_readers = (
        old_endpoints.get(_endpoint_key(endpoint, MatchedIds()), []) for endpoint in endpoint_pair
    )
    compatible_writers = [
        old_writer
        for old_writer in old_writers
        for old_reader in old_readers
        if old_writer.name == old_reader.name and not _find_clashes(old_writer, old_reader)
    ]
    if not compatible_writers or (reader.port and not context.needs_source(reader.port)):
        return
    # The new offer against the old request: what clashes here is the publisher's doing.
    new_clashes = next(
        (clash_list for old_reader in old_readers if (clash_list := _find_clashes(writer, old_reader))), ()
    )
    if not new_clashes:
        return
    partner = context.after.nodes[reader.node].owner
    indices = context.port_change_indices(writer.node, writer.port or "", "qos") or context.change_indices(
        "node", writer.node
    )
    offered = " and ".join(clash.offered for clash in new_clashes)
    requested = " and ".join(clash.requested for clash in new_clashes)
    if partner:
        request_note = f"where `{reader.node}` of {partner} asks for {requested}: it receives nothing any more"
        yield from context.losses_of_partner(
            indices, partner, f"offers {offered} on {tick_name(topic_name)}, {request_note}"
        )


def _find_clashes(writer: Endpoint, reader: Endpoint) -> tuple[QosConflict, ...]:
    return tuple(find_qos_conflicts(writer.qos, reader.qos))
