"""Through which regions a path leads that goes through the elements of a chain."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from archgen.timing.chains.cost_network import CostNetwork
from archgen.timing.chains.element_index import ChainPoint
from archgen.timing.chains.path_search import RouteRegion
from archgen.timing.system.timing_system import TimingSystem


def lay_out_chain(network: CostNetwork, chain_points: Sequence[ChainPoint]) -> tuple[RouteRegion, ...]:
    """Lay a chain out: neighbours that an arc joins are joined by it, others by all paths between them."""
    regions = [_build_region(network, point) for point in chain_points]
    if not regions or not all(region.members for region in regions):
        return ()
    regions_in_order = [regions[0]]
    for before, after in pairwise(regions):
        if not _are_joined(network, before, after):
            # A region without members is every vertex that the chain does not name.
            regions_in_order.append(RouteRegion(None))
        regions_in_order.append(after)
    return tuple(regions_in_order)


def lay_out_between(network: CostNetwork, end_points: Sequence[ChainPoint]) -> tuple[RouteRegion, ...]:
    """Lay out all paths between two elements, direct ones and others."""
    first, last = (_build_region(network, point) for point in end_points)
    return (first, RouteRegion(None, optional=True), last) if first.members and last.members else ()


def _build_region(network: CostNetwork, point: ChainPoint) -> RouteRegion:
    members = frozenset(network.vertex_of[name] for name in point.activities)
    if point.output is None:
        return RouteRegion(members, inside=len(members) > 1)
    # An element that is an output is left by that output only, and at once: no moving on inside the region.
    return RouteRegion(members, inside=False, leaving_arcs=frozenset(network.list_arcs(point.output)))


def _are_joined(network: CostNetwork, first_region: RouteRegion, second_region: RouteRegion) -> bool:
    """Whether a step leads from one region to another, or both hold one activity."""
    first_members, second_members = first_region.members or frozenset(), second_region.members or frozenset()
    if first_members & second_members:
        return True
    graph, _ = network.cost_graph("bound")
    hops = (
        hop
        for vertex in first_members
        for hop in graph[vertex]
        if first_region.leaving_arcs is None or hop.arc in first_region.leaving_arcs
    )
    return any(hop.target in second_members for hop in hops)


def is_fired_by_samples(system: TimingSystem, name: str, start_ids: Sequence[str]) -> bool:
    """Whether all that fires one of the first activities of a chain are samples of others of them.

    Then nothing is as old since its activation as it is since the sample before that.
    """
    activity, arcs = system.activities[name], system.arcs_into.get(name, ())
    if any(arc.role == "request" for arc in arcs) or not activity.triggers:
        return False
    outside_inputs = system.external_inputs.get(name, ())
    for key in activity.triggers:
        sources = [arc.source for arc in arcs if arc.role == "data" and arc.input == key]
        is_sampled = all(
            source in start_ids and system.activities[source].behaviour == "periodic" for source in sources
        )
        if not sources or not is_sampled or key in outside_inputs:
            return False
    return True
