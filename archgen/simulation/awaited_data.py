"""The start-up of a run: until everything that fires an activity has sent once, its gaps say nothing of later ones.

Where any of several sources fires, the gap is that of the most frequent one, from its first message on. So the bounds of
gaps, and all that rests on them, count from there, and what was seen before is not held against them.
"""

from __future__ import annotations

from archgen.model.graph_search import find_strong_components
from archgen.simulation.simulation_plan import PERIODIC, SLOT_SAMPLED, SimulationPlan


class AwaitedData:
    """What each activity of a run still awaits; `first_counted` is the number of its first activation behind that, or -1."""

    def __init__(self, plan: SimulationPlan) -> None:
        """Begin with nothing sent."""
        self.awaited_wires = find_awaited_wires(plan)
        self.first_counted = [-1 if awaited else 0 for awaited in self.awaited_wires]
        self.activation_count = [0] * len(plan.activities)

    def note_sample(self, source: int, target: int, wire: int, sample: int) -> None:
        """Note that a wire has brought something: it is awaited no more, if its source's start-up was over by then."""
        if 0 <= self.first_counted[source] <= sample:
            self.awaited_wires[target].discard(wire)


def find_awaited_wires(plan: SimulationPlan) -> list[set[int]]:
    """Return the wires that must have brought something before the gaps of each activity count.

    Not those that may stay silent for ever, nor those of rings, of which each would wait for the other.
    """
    awaited_wires: list[set[int]] = [set() for _ in plan.activities]
    ring_of = _find_rings(plan)
    fired_activities = {wire.target for wire in plan.wires if wire.slot != SLOT_SAMPLED}
    for number, wire in enumerate(plan.wires):
        source = plan.wire_sources[number]
        is_working = source in fired_activities or plan.activities[source].kind == PERIODIC
        is_sure = is_working and not wire.is_selective
        if wire.slot != SLOT_SAMPLED and is_sure and ring_of[source] != ring_of[wire.target]:
            awaited_wires[wire.target].add(number)
    return awaited_wires


def _find_rings(plan: SimulationPlan) -> dict[int, int]:
    """Return a number for each activity, which those have in common that fire one another round a ring."""
    targets: list[list[int]] = [[] for _ in plan.activities]
    for number, wire in enumerate(plan.wires):
        if wire.slot != SLOT_SAMPLED:
            targets[plan.wire_sources[number]].append(wire.target)
    rings = find_strong_components(range(len(plan.activities)), targets.__getitem__)
    return {activity: number for number, ring in enumerate(rings) for activity in ring}
