"""Which activities the elements of a chain stand for, and through which regions a path through them leads."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture, Waypoint
from archgen.timing.network import Network
from archgen.timing.paths import Region
from archgen.timing.system import System

__all__ = ["Point", "Region", "chain_route", "free_route", "points"]


@dataclass(frozen=True, slots=True)
class Point:
    """What an element of a chain stands for: activities, and the output by which it is left (None: any)."""

    activities: tuple[str, ...]
    output: str | None = None


def points(system: System, architecture: Architecture, through: Sequence[Waypoint]) -> tuple[Point, ...]:
    """Return the activities of each element."""
    of_node: dict[str, list[str]] = {}
    of_component: dict[str, list[str]] = {}
    for activity in system.activities.values():
        of_node.setdefault(activity.node, []).append(activity.id)
        node = architecture.nodes.get(activity.node)
        for component in _components(activity.component, node.implements if node else ()):
            of_component.setdefault(component, []).append(activity.id)
    made: list[Point] = []
    for point in through:
        if point.kind == "node":
            own = [point.id] if point.id in system.activities else of_node.get(point.id, [])
            made.append(Point(tuple(own)))
        elif point.kind == "component":
            made.append(Point(tuple(of_component.get(point.id, ()))))
        else:
            output = architecture.outputs.get(point.id)
            owners = of_component.get(output.component, []) if output else []
            publishing = [name for name in owners if point.id in system.activities[name].outputs]
            made.append(Point(tuple(publishing or owners), point.id))
    return tuple(made)


def _components(own: str | None, implemented: Sequence[str]) -> tuple[str, ...]:
    """Return the complete ids of the components that an activity belongs to."""
    if own is None:
        # An activity's component may be the last part of an id only (see `name_activities`).
        return tuple(implemented[:1])
    return tuple(component for component in implemented if own in {component, component.rpartition(".")[2]})


def chain_route(network: Network, through: Sequence[Point]) -> tuple[Region, ...]:
    """Lay a chain out: neighbours that an arc joins are joined by it, others by all paths between them."""
    regions = [_region(network, point) for point in through]
    if not regions or not all(region.members for region in regions):
        return ()
    made = [regions[0]]
    for before, after in pairwise(regions):
        if not _joined(network, before, after):
            # A region without members is every vertex that the chain does not name.
            made.append(Region(None))
        made.append(after)
    return tuple(made)


def free_route(network: Network, ends: Sequence[Point]) -> tuple[Region, ...]:
    """Lay out all paths between two elements, direct ones and others."""
    first, last = (_region(network, point) for point in ends)
    return (first, Region(None, optional=True), last) if first.members and last.members else ()


def _region(network: Network, point: Point) -> Region:
    """Return the region of an element."""
    members = frozenset(network.index[name] for name in point.activities)
    if point.output is None:
        return Region(members, inside=len(members) > 1)
    # An element that is an output is left by that output only, and at once: no moving on inside the region.
    leave = frozenset(at for at, arc in enumerate(network.arcs) if arc.output == point.output)
    return Region(members, inside=False, leave=leave)


def _joined(network: Network, before: Region, after: Region) -> bool:
    """Whether a step leads from one region to another, or both hold one activity."""
    here, there = before.members or frozenset(), after.members or frozenset()
    if here & there:
        return True
    graph, _ = network.graph("bound")
    hops = (hop for vertex in here for hop in graph[vertex] if before.leave is None or hop.arc in before.leave)
    return any(hop.target in there for hop in hops)
