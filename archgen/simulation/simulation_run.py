"""One run of a plan with one seed: its random numbers, its state, and its pending events.

The start-up of a run: until everything that fires an activity has sent once, its gaps say nothing of later ones.

Where any of several sources fires, the gap is that of the most frequent one, from its first message on. So the bounds of
gaps, and all that rests on them, count from there, and what was seen before is not held against them.
"""

from __future__ import annotations

from collections.abc import Collection
from random import Random
from typing import TYPE_CHECKING, Literal

from archgen.model.graph_search import find_strong_components
from archgen.simulation.executor_state import (
    CallbackStates,
    ExecutorStates,
    ProcessorStates,
    ResourceStates,
    ThreadStates,
    find_last_turn,
)
from archgen.simulation.run_state import CRITICAL_INTERVAL, ActivityStates, WireStates
from archgen.simulation.simulation_plan import ONCE, PERIODIC, SLOT_SAMPLED, SimulationPlan

if TYPE_CHECKING:
    from archgen.simulation.schedule_log import ScheduleLog

ThreadState = Literal["ready", "runs", "awaits", "uses"]
"""What a thread with something to do is at: it waits for a core or has one, it waits for a resource or uses it."""
JOB_END, SAMPLE_ARRIVAL, ACTIVITY_RELEASE = range(3)
"""The order of events at one moment; two bits of the heap's keys."""
CLOCK_TICK, LATE_TICK, HELD_FIRING = range(3)
"""Kinds of releases: a clock tick, a tick that jitter delayed, and an activation by data that jitter held back."""
NO_WIRE, ALL_WIRES, LOAD_ONLY = -1, -2, -3
"""What fired a job where no single wire did: a clock, all inputs together, or nothing (it only loads its host)."""


class SimulationRun:
    """One run with one seed. Read `activities`, `wires`, `processors` and `event_count` when it is over."""

    def __init__(
        self, plan: SimulationPlan, seed: int, watched: Collection[int] = (), logged: Collection[int] = ()
    ) -> None:
        dice = Random(seed)  # noqa: S311 - dice, not secrets
        self.plan = plan
        self.draw_share = dice.random
        self.is_critical = seed % CRITICAL_INTERVAL == 0
        self.activities = ActivityStates(plan, dice, watched)
        self.wires = WireStates(plan, logged)
        self.start_up = AwaitedData(plan)
        last_turn = find_last_turn(seed)
        self.callbacks = CallbackStates(plan)
        self.executors = ExecutorStates(plan, dice, last_turn)
        self.threads = ThreadStates()
        self.processors = ProcessorStates(plan, dice, last_turn)
        self.resources = ResourceStates(plan, dice, last_turn)
        if self.is_critical:
            self.activities.phase = [0] * len(plan.activities)
        # Drawn for each run and activity: some runs see mostly the longest times, others mostly what lies below.
        shares = (1.0,) if self.is_critical else (0.9,) if last_turn is not None else (0.2, 0.6, 0.9)
        self.worst_share = [dice.choice(shares) for _ in plan.activities]
        self.publish_share = [dice.choice((0.1, 0.5, 0.9)) for _ in plan.activities]
        self.priority = [planned.priority for planned in plan.activities]
        self.calls = [planned.calls for planned in plan.activities]
        self.outputs = [
            # What is published once was delivered at the start, and never again.
            tuple(
                (index, output.wires, output.is_conditional, output.patience)
                for index, output in enumerate(planned.outputs)
                if planned.kind != ONCE
            )
            for planned in plan.activities
        ]
        self.heap: list[tuple[int, int, int]] = []
        """Events: key (time and order), subject, detail."""
        self.aged_wires = [
            tuple((wire, self.activities.job_ends[self.wires.source[wire]]) for wire in aged_wires)
            for aged_wires in self.wires.aged_wires
        ]
        """The wires of which the age of what is read is recorded, each with the ends of its source's jobs."""
        self.woken_executors: list[int] = []
        """Executors that got something to do at this moment, or a thread free."""
        self.changed_processors: set[int] = set()
        """Processors with a free core or a newly ready thread at this moment."""
        self.changed_resources: set[int] = set()
        """Resources that somebody left at this moment, or waits for."""
        self.sequence = 0
        self.log: ScheduleLog | None = None
        """Notes what threads do, where somebody wants to see it; `now` is the time then."""
        self.now = 0
        self.answer_wires = [plan.answers.get(wire_index, -1) for wire_index in range(len(plan.wires))]
        self.event_count = 0

    def draw_time(self, activity: int, low: int, spread: int) -> int:
        """Draw a time between `low` and `low + spread`; the extremes are drawn more often than what lies between."""
        drawn = self.draw_share()
        share = self.worst_share[activity]
        if drawn < share:
            return low + spread
        # One random number is used twice: rescaled to 0..1, its lower half means the shortest time.
        remainder = (drawn - share) / (1.0 - share)
        return low if remainder < 0.5 else low + int((remainder - 0.5) * 2.0 * (spread + 1))  # noqa: PLR2004 - half of the rest


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
