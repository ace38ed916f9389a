"""Find the place of every box: of groups and hosts on the map, and of components and nodes inside of them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass

from archgen.model.flow_graph import FlowGraph, build_node_graph
from archgen.views.explorer.column_layout import Place, place_in_columns
from archgen.views.graphs.component_flows import list_flows
from archgen.views.lookup import Lookup

NO_HOME = ""
"""The group or host of nodes that have none."""


@dataclass(frozen=True, slots=True)
class MapPlaces:
    """Places by id: in the whole for groups and hosts, in their group or host for components and nodes."""

    groups: Mapping[str, Place]
    components: Mapping[str, Place]
    node_groups: Mapping[str, Place]
    nodes_by_group: Mapping[str, Place]
    hosts: Mapping[str, Place]
    nodes_by_host: Mapping[str, Place]


def find_places(
    lookup: Lookup,
    component_groups: Mapping[str, str],
    node_groups: Mapping[str, str],
    node_hosts: Mapping[str, str],
    node_ids: Collection[str],
) -> MapPlaces:
    """Find the places of what is shown; each mapping names the group or host of an element."""
    component_flows = [(flow.tail, flow.head) for flow in list_flows(lookup.architecture)]
    node_flows = _list_pairs(build_node_graph(lookup.architecture))
    groups, components = _place_homes(component_flows, component_groups)
    grouped_nodes = {node: node_groups.get(node, NO_HOME) for node in node_ids}
    hosted_nodes = {node: node_hosts.get(node, NO_HOME) for node in node_ids}
    groups_of_nodes, nodes_by_group = _place_homes(node_flows, grouped_nodes)
    # Without a host there is no map of hosts: all nodes would lie in one frame.
    hosts, nodes_by_host = _place_homes(node_flows, hosted_nodes) if node_hosts else ({}, {})
    return MapPlaces(groups, components, groups_of_nodes, nodes_by_group, hosts, nodes_by_host)


def _list_pairs(graph: FlowGraph) -> list[tuple[str, str]]:
    return [(tail, head) for tail, heads in graph.successors.items() for head in heads]


def _place_homes(
    flows: Iterable[tuple[str, str]], homes: Mapping[str, str]
) -> tuple[dict[str, Place], dict[str, Place]]:
    """Place groups or hosts by all that flows between them, and their members by what flows inside of each."""
    outer_weights: dict[tuple[str, str], int] = defaultdict(int)
    inner_weights: dict[str, dict[tuple[str, str], int]] = defaultdict(lambda: defaultdict(int))
    for tail, head in flows:
        if tail not in homes or head not in homes:
            continue
        if homes[tail] == homes[head]:
            inner_weights[homes[tail]][tail, head] += 1
        else:
            outer_weights[homes[tail], homes[head]] += 1
    members: dict[str, list[str]] = defaultdict(list)
    for element, home in homes.items():
        members[home].append(element)
    member_places: dict[str, Place] = {}
    for home, ids in members.items():
        member_places |= place_in_columns(ids, inner_weights[home], is_inner=True)
    return place_in_columns(list(members), outer_weights), member_places
