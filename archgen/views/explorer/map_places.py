"""Find the place of every box: of groups and hosts on the map, and of components and nodes inside of them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping

from archgen.frozen import dataclass
from archgen.model.flow_graph import FlowGraph, build_node_graph
from archgen.views.explorer.column_layout import Place, place_in_columns
from archgen.views.graphs.component_flows import list_flows
from archgen.views.lookup import Lookup

NO_HOME = ""
"""The group or host of nodes that have none."""
Path = tuple[str, ...]
"""What is around an element, the outermost first (a group or host, then composed components), and the element itself."""


@dataclass(frozen=True, slots=True)
class MapPlaces:
    """The place of everything inside of what is directly around it, by its path; that of a group or host is on the map."""

    components: Mapping[Path, Place]
    nodes_by_group: Mapping[Path, Place]
    nodes_by_host: Mapping[Path, Place]


def find_places(
    lookup: Lookup,
    component_paths: Mapping[str, Path],
    node_groups: Mapping[str, str],
    node_hosts: Mapping[str, str],
    node_ids: Collection[str],
) -> MapPlaces:
    """Find the places of what is shown: of components by their paths, of nodes by their group and host."""
    component_flows = [(flow.tail, flow.head) for flow in list_flows(lookup.architecture)]
    node_flows = _list_pairs(build_node_graph(lookup.architecture))
    grouped_nodes = {node: (node_groups.get(node, NO_HOME), node) for node in node_ids}
    hosted_nodes = {node: (node_hosts.get(node, NO_HOME), node) for node in node_ids}
    return MapPlaces(
        _place_paths(component_flows, component_paths),
        _place_paths(node_flows, grouped_nodes),
        # Without a host there is no map of hosts: all nodes would lie in one frame.
        _place_paths(node_flows, hosted_nodes) if node_hosts else {},
    )


def _list_pairs(graph: FlowGraph) -> list[tuple[str, str]]:
    return [(tail, head) for tail, heads in graph.successors.items() for head in heads]


def _place_paths(flows: Iterable[tuple[str, str]], paths: Mapping[str, Path]) -> dict[Path, Place]:
    """Place what stands side by side by all that flows between it, whatever is at the ends inside."""
    weights: dict[Path, dict[tuple[str, str], int]] = defaultdict(lambda: defaultdict(int))
    for tail, head in flows:
        if tail != head and tail in paths and head in paths:
            around, *ends = _split_paths(paths[tail], paths[head])
            weights[around][ends[0], ends[1]] += 1
    members: dict[Path, dict[str, None]] = defaultdict(dict)
    for path in paths.values():
        for depth, name in enumerate(path):
            members[path[:depth]][name] = None
    places: dict[Path, Place] = {}
    for around, names in members.items():
        inner_places = place_in_columns(list(names), weights[around], is_inner=bool(around))
        places |= {(*around, name): place for name, place in inner_places.items()}
    return places


def _split_paths(tail_path: Path, head_path: Path) -> tuple[Path, str, str]:
    """Return what is around both ends of a flow, and which two things in there it joins."""
    depth = next(at for at, (one, other) in enumerate(zip(tail_path, head_path, strict=False)) if one != other)
    return tail_path[:depth], tail_path[depth], head_path[depth]
