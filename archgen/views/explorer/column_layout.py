"""Place boxes in columns so that most flows run to the right, are short, and cross little: of groups, hosts, and inside of them."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping, Sequence
from itertools import pairwise

from archgen.frozen import dataclass
from archgen.grouping import group_pairs
from archgen.model.flow_graph import FlowGraph, build_node_graph
from archgen.model.graph_search import find_strong_components
from archgen.views.graphs.drawn_level import list_flows
from archgen.views.graphs.group_columns import spread_apart
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


FlowWeights = Mapping[tuple[str, str], int]
"""How much flows from one item to another."""
Place = tuple[int, float]
"""A column from 0, and the height of the middle in steps of one box, 0 in the middle of the column."""

_SAME_COLUMN_COST = 3.5
_BACKWARD_COST = 3.0
_CROWDED_COST = 0.5
"""What a flow costs that stays in its column, or runs back, in columns of length; and a box too many in a column, in the
flows of a box.
"""
_MAX_STEP = 2
"""An item is tried in so many columns to the left and to the right at once: in all of them it would take too long."""
_SWEEPS = 8


def place_in_columns(items: Sequence[str], weights: FlowWeights, *, is_inner: bool = False) -> dict[str, Place]:
    """Place items. Those without a flow fill the shortest columns from below.

    `is_inner`: the items lie in a frame among others, which is to be less wide than a whole map.
    """
    linked_ids = {end for ends in weights for end in ends if ends[0] != ends[1]}
    linked_items = [item for item in items if item in linked_ids]
    flows = {ends: weight for ends, weight in weights.items() if ends[0] != ends[1]}
    column_count = _choose_column_count(len(items), is_inner=is_inner)
    successors = group_pairs(flows)
    ordered: list[str] = []
    for component in find_strong_components(linked_items, lambda item: successors[item]):
        ordered += component if len(component) == 1 else _sort_loop(component, flows)
    columns = _cut_evenly(_sort_by_layer(ordered, flows), column_count)
    columns = _shorten_flows(columns, flows) if linked_items else columns
    columns = _order_columns(columns, flows)
    heights = _align_heights(columns, flows)
    for item in (item for item in items if item not in linked_ids):
        shortest = min([column for column in columns if column or not linked_items], key=len)
        heights[item] = max((heights[other] for other in shortest), default=-1.0) + 1
        shortest.append(item)
    filled_columns = [column for column in columns if column]
    return {item: (number, round(heights[item], 2)) for number, column in enumerate(filled_columns) for item in column}


def _choose_column_count(item_count: int, *, is_inner: bool) -> int:
    """Return the number of columns that makes a map as wide as a screen, and what is inside of a frame half as wide again
    as high. A box with the way to the next one is three to four times as wide as high.
    """
    count = math.sqrt(0.42 * item_count) + 0.6 if is_inner else math.sqrt(0.55 * item_count) + 1.4
    return max(1, min(item_count, round(count)))


def _sort_loop(members: Sequence[str], flows: FlowWeights) -> list[str]:
    """Sort items that feed one another: sinks last, sources first, else what gives most more than it takes
    (Eades, Lin and Smyth, 1993).
    """
    member_set = set(members)
    outgoing: dict[str, dict[str, int]] = {item: {} for item in members}
    incoming: dict[str, dict[str, int]] = {item: {} for item in members}
    for (tail, head), weight in flows.items():
        if tail in member_set and head in member_set:
            outgoing[tail][head] = incoming[head][tail] = weight
    remaining, first_items, last_items = dict.fromkeys(members), list[str](), list[str]()
    while remaining:
        sink = next((item for item in remaining if not outgoing[item]), None)
        chosen = sink or max(
            remaining, key=lambda item: math.fsum(outgoing[item].values()) - math.fsum(incoming[item].values())
        )
        (last_items if sink else first_items).append(chosen)
        del remaining[chosen]
        for head in outgoing.pop(chosen):
            del incoming[head][chosen]
        for tail in incoming.pop(chosen):
            del outgoing[tail][chosen]
    return first_items + last_items[::-1]


def _sort_by_layer(ordered: Sequence[str], flows: FlowWeights) -> list[str]:
    """Sort by the longest way from a start, so that neighbours in the order seldom feed one another."""
    position = {item: index for index, item in enumerate(ordered)}
    layer = dict.fromkeys(ordered, 0)
    sources = group_pairs((head, tail) for tail, head in flows if position[tail] < position[head])
    for item in ordered:
        layer[item] = max((layer[source] + 1 for source in sources[item]), default=0)
    return sorted(ordered, key=lambda item: (layer[item], position[item]))


def _cut_evenly(ordered: Sequence[str], column_count: int) -> list[list[str]]:
    """Cut an order into columns whose sizes differ by one at most."""
    bounds = [round(len(ordered) * number / column_count) for number in range(column_count + 1)]
    return [list(ordered[start:end]) for start, end in pairwise(bounds)]


def _shorten_flows(columns: Sequence[Sequence[str]], flows: FlowWeights) -> list[list[str]]:
    """Move single items to other columns while that makes flows shorter, or turns them to the right."""
    column_of = {item: number for number, column in enumerate(columns) for item in column}
    sizes = [len(column) for column in columns]
    target_size = len(column_of) / max(1, len(columns))
    links: dict[str, list[tuple[str, float, bool]]] = {item: [] for item in column_of}
    for (tail, head), weight in flows.items():
        # As widths of arrows: ten flows are not ten times as long a line.
        weight_root = math.sqrt(weight)
        links[tail].append((head, weight_root, True))
        links[head].append((tail, weight_root, False))
    crowd_cost = _CROWDED_COST * math.fsum(weight for ends in links.values() for _, weight, _ in ends) / len(links)

    def cost(item: str, column: int) -> float:
        crowd = max(0.0, sizes[column] + (column_of[item] != column) - target_size)
        total = crowd_cost * crowd * crowd
        for other, weight, is_forward in links[item]:
            span = (column_of[other] - column) * (1 if is_forward else -1)
            total += weight * (_SAME_COLUMN_COST if span == 0 else span if span > 0 else _BACKWARD_COST - span)
        return total

    for _ in range(_SWEEPS):
        moved = False
        for item in links:
            near = range(max(0, column_of[item] - _MAX_STEP), min(len(columns), column_of[item] + _MAX_STEP + 1))
            best_column = min(near, key=lambda column, item=item: cost(item, column))  # type: ignore[misc]
            if cost(item, best_column) < cost(item, column_of[item]) - 1e-9:
                sizes[column_of[item]] -= 1
                sizes[best_column] += 1
                column_of[item] = best_column
                moved = True
        if not moved:
            break
    return [[item for item in column_of if column_of[item] == number] for number in range(len(columns))]


def _list_neighbours(flows: FlowWeights) -> dict[str, list[tuple[str, int]]]:
    """Return what each item has a flow with, in either direction, and how much."""
    neighbours: dict[str, list[tuple[str, int]]] = defaultdict(list)
    for (tail, head), weight in flows.items():
        neighbours[tail].append((head, weight))
        neighbours[head].append((tail, weight))
    return neighbours


def _order_columns(columns: Sequence[Sequence[str]], flows: FlowWeights) -> list[list[str]]:
    """Order each column by the middle of what its items have flows with, forth and back, and keep the best order."""
    neighbours = _list_neighbours(flows)
    current = [list(column) for column in columns]
    best, best_length = current, math.inf
    for sweep in range(_SWEEPS):
        heights = {item: index - (len(column) - 1) / 2 for column in current for index, item in enumerate(column)}
        length = math.fsum(abs(heights[tail] - heights[head]) * weight for (tail, head), weight in flows.items())
        if length < best_length:
            best, best_length = [list(column) for column in current], length
        for column in current if sweep % 2 == 0 else reversed(current):
            middles = {item: _mean_height(neighbours[item], heights, heights[item]) for item in column}
            column.sort(key=middles.__getitem__)
            heights |= {item: index - (len(column) - 1) / 2 for index, item in enumerate(column)}
    return best


def _align_heights(columns: Sequence[Sequence[str]], flows: FlowWeights) -> dict[str, float]:
    """Move items up and down towards what they have flows with, one step of a box apart, so that lines get level."""
    neighbours = _list_neighbours(flows)
    heights = {item: index - (len(column) - 1) / 2 for column in columns for index, item in enumerate(column)}
    for _ in range(4):
        for column in columns:
            wishes = [_mean_height(neighbours[item], heights, heights[item]) * 0.5 for item in column]
            heights |= dict(zip(column, spread_apart(wishes, [1.0] * len(wishes)), strict=True))
    return heights


def _mean_height(neighbours: Iterable[tuple[str, int]], heights: Mapping[str, float], default: float) -> float:
    pairs = list(neighbours)
    total = math.fsum(weight for _, weight in pairs)
    return math.fsum(heights[item] * weight for item, weight in pairs) / total if total else default
