"""Topics, services and actions that another partner's node uses under a name that no longer exists."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Container, Iterable, Iterator, Mapping

from archgen.compare.losses.change_context import ChangeContext, PartnerLoss, tick_name, tick_sorted_names
from archgen.compare.losses.lost_connections import find_component_renames
from archgen.model.node import Endpoint, FlowKind

TopicKey = tuple[str, FlowKind]


def find_renamed_topics(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find names that disappeared while other partners' nodes use them: their programs do not follow the files."""
    old_endpoints, new_endpoints = context.offered_endpoints
    topics_by_port: dict[str, set[TopicKey]] = defaultdict(set)
    lasting_topics_by_port: dict[str, set[TopicKey]] = defaultdict(set)
    for (node, port), ends in new_endpoints.items():
        topics = list_known_names(ends)
        topics_by_port[port] |= topics
        new_node = context.after.nodes.get(node)
        if new_node is None or new_node.status != "planned" or ("node", node) in context.versions.elements_before:
            lasting_topics_by_port[port] |= topics
    readers = list_topic_readers(context)
    for node, port in sorted(old_endpoints):
        if port and ("output", port) not in context.versions.elements_after:
            continue  # the connection itself is gone
        old_topics = list_known_names(old_endpoints[node, port])
        # A new node that is only planned keeps no topic alive which the program that had it gives another name.
        new_topics = (lasting_topics_by_port if (node, port) in new_endpoints else topics_by_port)[port]
        indices = _find_causes(context, node, port) if old_topics - new_topics else []
        for name, flow in sorted(old_topics - new_topics):
            own_topics = list_known_names(new_endpoints.get((node, port), ()))
            replacements = sorted(
                new_name for new_name, new_flow in (new_topics if port else own_topics) - old_topics if new_flow == flow
            )
            users = [
                endpoint
                for endpoint in readers.get((name, flow), ())
                if (not port or not endpoint.sources or _reads_output(context, endpoint, port))
                and not _follows_by_launch(context, endpoint, new_topics)
            ]
            new_name_note = (
                f"it is {tick_sorted_names(replacements)} now"
                if replacements
                else "nobody offers it under that name any more"
            )
            yield from context.losses_of_readers(
                indices, group_users(context, users), f"takes the {flow} {tick_name(name)} from", f"; {new_name_note}"
            )


def list_known_names(endpoints: Iterable[Endpoint]) -> set[TopicKey]:
    """Return what endpoints use, as far as its name is known."""
    return {(endpoint.name, endpoint.flow) for endpoint in endpoints if endpoint.name is not None}


def list_topic_readers(context: ChangeContext) -> Mapping[TopicKey, list[Endpoint]]:
    """Return the readers of each name in the first version that can be broken: those of real nodes."""
    readers: dict[TopicKey, list[Endpoint]] = defaultdict(list)
    for endpoint in context.before.endpoints:
        node = context.before.nodes[endpoint.node]
        if endpoint.use in {"publishes", "serves"} or node.status == "planned":
            continue
        if node.written and (
            endpoint.port is None or context.needs_source(context.matched_ids.common_id("input", endpoint.port))
        ):
            for key in list_known_names([endpoint]):
                readers[key].append(endpoint)
    return readers


def _follows_by_launch(context: ChangeContext, endpoint: Endpoint, topics: Container[TopicKey]) -> bool:
    """Whether a reader's program is as it was, and what starts it gives it the new name, too."""
    return any(
        each.program_name is not None
        and each.program_name == endpoint.program_name
        and each.name != each.program_name
        and (each.name, each.flow) in topics
        for each in context.find_new_ends(endpoint)
    )


def _reads_output(context: ChangeContext, endpoint: Endpoint, output_id: str) -> bool:
    return output_id in {context.matched_ids.common_id("output", source) for source in endpoint.sources}


def group_users(context: ChangeContext, users: Iterable[Endpoint]) -> Mapping[str, set[str]]:
    """Return the nodes of endpoints by the partner who owns them."""
    nodes_by_partner: dict[str, set[str]] = defaultdict(set)
    for endpoint in users:
        node = context.before.nodes[endpoint.node]
        if node.owner:
            nodes_by_partner[context.matched_ids.common_id("partner", node.owner)].add(
                context.matched_ids.common_id("node", endpoint.node)
            )
    return dict(sorted(nodes_by_partner.items()))


def _find_causes(context: ChangeContext, node_id: str, port_id: str) -> list[int]:
    """Return the indices of the change that renamed a topic: at the port, the node, or the elements its name is made
    of.
    """
    component_id = port_id.rpartition(".")[0]
    group_id = component_id.partition(".")[0]
    # From the most specific cause to the most general; the first that changed at all is blamed.
    candidate_indices = (
        context.port_change_indices(node_id, port_id, "topic"),
        context.change_indices("node", node_id, "name", "namespace"),
        context.indices_by_change_kind("node", node_id, "renamed", "removed"),
        context.indices_by_change_kind("output", port_id, "renamed"),
        find_component_renames(context, component_id),
        context.indices_by_change_kind("group", group_id, "renamed"),
        context.change_indices("node", node_id),
        context.change_indices("output", port_id, "medium"),
        context.change_indices("output", port_id),
    )
    return next((indices for indices in candidate_indices if indices), [])
