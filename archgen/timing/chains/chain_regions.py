"""Which activities the elements of a chain stand for, and through which regions a path through them leads."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture, Waypoint
from archgen.timing.chains.cost_network import CostNetwork
from archgen.timing.chains.path_search import RouteRegion
from archgen.timing.system.timing_system import TimingSystem

__all__ = ["ChainPoint", "RouteRegion", "lay_out_between", "lay_out_chain", "resolve_points"]


@dataclass(frozen=True, slots=True)
class ChainPoint:
    """What an element of a chain stands for: activities, and the output by which it is left (None: any)."""

    activities: tuple[str, ...]
    output: str | None = None


def resolve_points(
    system: TimingSystem, architecture: Architecture, waypoints: Sequence[Waypoint]
) -> tuple[ChainPoint, ...]:
    """Return the activities of each element."""
    of_node: dict[str, list[str]] = {}
    of_component: dict[str, list[str]] = {}
    for activity in system.activities.values():
        of_node.setdefault(activity.node, []).append(activity.id)
        node = architecture.nodes.get(activity.node)
        for component in _component_ids(activity.component, node.implements if node else ()):
            of_component.setdefault(component, []).append(activity.id)
    chain_points: list[ChainPoint] = []
    for point in waypoints:
        if point.kind == "node":
            activity_ids = [point.id] if point.id in system.activities else of_node.get(point.id, [])
            chain_points.append(ChainPoint(tuple(activity_ids)))
        elif point.kind == "component":
            # A composed component is the worst way through its leaves.
            leaves = architecture.leaves_of(point.id)
            chain_points.append(ChainPoint(tuple(each for leaf in leaves for each in of_component.get(leaf, ()))))
        else:
            output = architecture.outputs.get(point.id)
            owners = of_component.get(output.component, []) if output else []
            publishing = [name for name in owners if point.id in system.activities[name].outputs]
            chain_points.append(ChainPoint(tuple(publishing or owners), point.id))
    return tuple(chain_points)


def _component_ids(own_name: str | None, implemented_ids: Sequence[str]) -> tuple[str, ...]:
    """Return the complete ids of the components that an activity belongs to."""
    if own_name is None:
        # An activity's component may be the last part of an id only (see `name_activities`).
        return tuple(implemented_ids[:1])
    return tuple(component for component in implemented_ids if own_name in {component, component.rpartition(".")[2]})


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
    """Return the region of an element."""
    members = frozenset(network.vertex_of[name] for name in point.activities)
    if point.output is None:
        return RouteRegion(members, inside=len(members) > 1)
    # An element that is an output is left by that output only, and at once: no moving on inside the region.
    leave = frozenset(arc_index for arc_index, arc in enumerate(network.arcs) if arc.output == point.output)
    return RouteRegion(members, inside=False, leaving_arcs=leave)


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
