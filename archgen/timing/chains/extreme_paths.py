"""The ways of a chain on which data takes longest or shortest, and what they bound."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from archgen.diagnostics.common_wording import join_first
from archgen.frozen import NamedTuple, replace
from archgen.timing.chains.cost_network import CostNetwork, PathAim
from archgen.timing.chains.path_search import CostedPath, PathSet, RouteRegion, find_paths
from archgen.timing.figures.timing_values import (
    UNKNOWN_VALUE,
    TimingValue,
    is_boundless,
    is_known_bound,
    list_assumptions,
    sum_bounds,
)
from archgen.timing.system.timing_system import Arc


class ExtremePath(NamedTuple):
    """The extreme path of a route: in which view of the network, and what it bounds all paths by."""

    view: CostNetwork
    path: CostedPath
    value: TimingValue


def find_aimed_paths(network: CostNetwork, regions: Sequence[RouteRegion], aim: PathAim) -> PathSet:
    """Return the paths of a route, with the extreme one for an aim first."""
    graph, start_costs = network.cost_graph(aim)
    return find_paths(graph, start_costs, regions, longest=aim != "best")


def find_extreme_value(network: CostNetwork, regions: Sequence[RouteRegion], aim: PathAim) -> TimingValue:
    """Return the extreme figure of a route for an aim."""
    extreme_path = find_extreme_path(network, regions, aim)
    return extreme_path.value if extreme_path else UNKNOWN_VALUE


def find_extreme_path(network: CostNetwork, regions: Sequence[RouteRegion], aim: PathAim) -> ExtremePath | None:
    """Return the extreme path of a route for an aim, in the view of the network in which it bounds best."""
    if not regions:
        return None
    extreme_paths: list[ExtremePath] = []
    for view in network.list_views() if aim != "best" else (network,):
        path_set = find_aimed_paths(view, regions, aim)
        path = next(path_set.best_paths(), None)
        if path is None:
            return None
        extreme_paths.append(ExtremePath(view, path, _bound_path_set(view, path_set, path, aim, regions)))
    return min(extreme_paths, key=_bound_order)


def _bound_order(extreme_path: ExtremePath) -> tuple[bool, bool, Fraction, bool]:
    """Sort key: known bounds before sums with gaps, these before what has no bound; the smallest first.

    Of equal ones that by runs: where a step elsewhere loses its bound, the terms of all others stay what they were.
    """
    view, _, bound = extreme_path
    return is_boundless(bound), not is_known_bound(bound), bound.value or Fraction(0), not view.runs


def sum_path(network: CostNetwork, path: CostedPath, aim: PathAim) -> TimingValue:
    """Return the sum of a path's costs for an aim."""
    cost_values = list(network.start_costs(network.names[path.start], aim))
    for arc_index in path.arcs:
        cost_values += network.step_costs(network.arcs[arc_index], aim)
    return sum_bounds(cost_values, "at least" if aim == "best" else "at most")


def _bound_path_set(
    network: CostNetwork,
    path_set: PathSet,
    path: CostedPath,
    aim: PathAim,
    regions: Sequence[RouteRegion],
) -> TimingValue:
    """Return the extreme path's sum; it bounds all paths only where the costs of the others are known too."""
    value = sum_path(network, path, aim)
    if path_set.cut_arcs:
        value = replace(
            value,
            assumptions=(
                *value.assumptions,
                _cut_arcs_text([network.arcs[arc_index] for arc_index in path_set.cut_arcs]),
            ),
        )
    if aim == "best" or is_boundless(value):
        return value
    path_arcs = path.arcs if path_set.path_count == 1 else tuple(path_set.arcs_on_paths())
    other_arcs = dict.fromkeys((*path_arcs, *_list_parallel_arcs(network, path_arcs, regions)))
    if len(other_arcs) == len(path.arcs):
        return value
    # Costs of unknown figures count as 0 in the network, so that a path with a gap may seem shorter than it is: if any
    # arc on any path lacks a figure, the bound is open.
    other_costs = sum_bounds(
        [part for arc_index in other_arcs for part in network.step_costs(network.arcs[arc_index], aim)]
    )
    if other_costs.complete:
        return value
    missing = tuple(dict.fromkeys((*value.missing, *other_costs.missing)))
    own = {*value.assumptions, *list_assumptions(other_costs)}
    assumptions = (*value.assumptions, *(text for text in other_costs.assumptions if text not in own))
    return replace(value, complete=False, missing=missing, assumptions=assumptions, side="at least")


def _list_parallel_arcs(
    network: CostNetwork, path_arcs: Sequence[int], regions: Sequence[RouteRegion]
) -> Iterator[int]:
    """Yield the arcs that lead as those of a path do: a path has only one of them, the longest that is known."""
    left_by = {vertex: each.leaving_arcs for each in regions if each.leaving_arcs for vertex in each.members or ()}
    for arc_index in path_arcs:
        for other_index in network.list_parallel(arc_index):
            leaving_arcs = left_by.get(network.vertex_of[network.arcs[other_index].source])
            if leaving_arcs is None or other_index in leaving_arcs:
                yield other_index


def _cut_arcs_text(arcs: Sequence[Arc]) -> str:
    pairs = [f"{arc.source} > {arc.target}" for arc in arcs]
    return f"the loops are large: ways that go back along {join_first(pairs, 3)} are left out"
