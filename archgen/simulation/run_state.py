"""The state of activities and wires in one run: lists indexed by small integers, made from a plan and a seed.

A seed also decides what a plan leaves open, such as phases and how often extremes are drawn.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Collection
from random import Random
from typing import Any

from archgen.simulation.simulation_plan import (
    ONCE,
    PERIODIC,
    REENTRANT,
    SLOT_SAMPLED,
    PlannedActivity,
    SimulationPlan,
)
from archgen.simulation.time_matching import make_matcher

CRITICAL_INTERVAL = 4
"""Every so many seeds everything starts at once and always takes its longest: the critical instant of the textbooks."""

Job = tuple[int, int, Any, int]
"""Activation time, the wire that fired the job (-1 for none, -2 for all inputs together, -3 for load only), the number of
the producer's job (a tuple, one for each input, where all fired it together), and its place in the order of arrival.
"""


class ActivityStates:
    """The state of every activity, by its number. Times are in units, -1 means never."""

    def __init__(self, plan: SimulationPlan, dice: Random, watched: Collection[int]) -> None:
        activities = plan.activities
        count = len(activities)
        self.period = [planned.period for planned in activities]
        self.jitter = [planned.jitter for planned in activities]
        self.shortest_time = [planned.bcet + sum(use[1] for use in planned.uses) for planned in activities]
        self.time_spread = [planned.wcet - planned.bcet for planned in activities]
        self.joint_callback = [planned.joint_callback for planned in activities]
        self.clock_callback = [planned.clock_callback for planned in activities]
        self.declared_response = [planned.declared_response for planned in activities]
        self.is_gated = [planned.every > 1 or planned.throttle > 0 for planned in activities]
        # The order of all draws in this module is part of the result: the same seed must give the same figures.
        self.phase = [dice.randrange(planned.period) if planned.kind == PERIODIC else 0 for planned in activities]
        self.every_counter = [dice.randrange(planned.every) for planned in activities]
        self.last_activation = [-1] * count
        """When it was last activated, its start-up aside."""
        self.last_passed = [-1] * count
        """When its gates last let an activation through, before jitter."""
        self.filled_slots = [sum(1 << slot for slot in planned.constant_slots) for planned in activities]
        self.started = [0] * count
        self.finished = [0] * count
        self.waiting_requests: list[list[int]] = [[] for _ in activities]
        """Requests that wait for the next activation of a periodic server."""
        self.accepted_requests: list[list[tuple[int, list[int]]]] = [[] for _ in activities]
        """Jobs, and the requests that are answered at their end."""
        self.call_remainders = [
            [dice.randrange(calls_per_job.denominator) for calls_per_job, _ in planned.calls] for planned in activities
        ]
        self.held_firings: list[deque[tuple[int, Any]]] = [deque() for _ in activities]
        """Activations by data that jitter holds back: wire, and number as in `Job`."""
        self.held_until = [0] * count
        self.declared_jobs: list[deque[tuple[int, int, int]]] = [deque() for _ in activities]
        """Activation, wire that fired it, and number of each running job."""
        self.declared_end = [0] * count
        self.worst_response = [0] * count
        self.best_response = [-1] * count
        self.end_gap = [0] * count
        """The longest time between two ends."""
        self.activation_gap = [0] * count
        self.last_end = [-1] * count
        self.last_published = [[-1] * len(planned.outputs) for planned in activities]
        self.output_silence = [[0] * len(planned.outputs) for planned in activities]
        """The longest time between two publications, by output."""
        recorded = recorded_sources(plan)
        self.is_watched = [index in watched or index in recorded for index in range(count)]
        self.matchers = [
            None if planned.within is None else make_matcher(planned.match_depths, planned.within)
            for planned in activities
        ]
        self.fused_age = [-1] * count
        """The largest time since the oldest stamp among matched samples, when a job starts."""
        self.fused_spread = [-1] * count
        """The largest time between the stamps of matched samples."""
        self.job_starts: list[list[int]] = [[] for _ in activities]
        self.job_activations: list[list[int]] = [[] for _ in activities]
        self.job_ends: list[list[int]] = [[] for _ in activities]


class WireStates:
    """The state of every wire, queue and link, by its number. Times are in units."""

    def __init__(self, plan: SimulationPlan, logged: Collection[int]) -> None:
        wires = plan.wires
        self.target = [wire.target for wire in wires]
        self.slot = [wire.slot for wire in wires]
        self.best_latency = [wire.best for wire in wires]
        self.latency_spread = [wire.worst - wire.best for wire in wires]
        self.queue = [wire.queue for wire in wires]
        self.depth = [wire.depth for wire in wires]
        self.link = [wire.link for wire in wires]
        self.transmission = [wire.transmission for wire in wires]
        self.declared_latency = [wire.declared_latency for wire in wires]
        self.is_direct = [wire.worst == 0 and wire.link < 0 for wire in wires]
        self.is_request = [wire.is_request for wire in wires]
        self.callback = [wire.callback for wire in wires]
        self.source = plan.wire_sources
        overtaken = _find_overtaken(plan)
        self.keeps_order = [source not in overtaken for source in plan.wire_sources]
        """Whether samples of a source never overtake one another."""
        self.newest_job = [-1] * len(wires)
        """The producer's job whose sample the reader has, or had when it last started."""
        self.rivals = _find_rivals(plan)
        """The wires of which samples are kept in the same memory, by wire: the last sample of any of them is there."""
        self.arrived_job = [-1] * len(wires)
        """The same for a sample that waits until the other inputs have arrived."""
        self.last_arrival = [0] * len(wires)
        """When the last sample arrives: samples keep their order."""
        self.sent_count = 0
        self.waiting_count = [0] * len(plan.queues)
        self.drop_count = [0] * len(plan.queues)
        self.link_free = [0] * len(plan.links)
        self.link_wait = [0] * len(plan.links)
        self.link_busy = [0] * len(plan.links)
        logs: list[list[int]] = [[] for _ in wires]
        self.source_log = logs
        self.is_noted = [wire.is_selective and wire_index in logged for wire_index, wire in enumerate(wires)]
        self.forwarded_jobs: list[list[int]] = [[] for _ in wires]
        """The jobs of the source that sent something, for wires with `is_noted`."""
        self.logged_wires = [
            tuple(wire_index for wire_index in planned.wires if wire_index in logged) for planned in plan.activities
        ]
        self.aged_wires = [
            tuple(
                wire_index
                for wire_index in planned.wires
                if plan.wires[wire_index].slot == SLOT_SAMPLED
                and plan.wires[wire_index].queue >= 0
                and plan.activities[plan.wire_sources[wire_index]].kind != ONCE
            )
            for planned in plan.activities
        ]
        """The wires of sampled inputs that are sent again and again."""
        self.largest_age = [-1] * len(wires)
        """The longest time from sending a sample to the start of a job that reads it."""
        self.sampled_queues = [_sampled_queues(plan, planned) for planned in plan.activities]


def recorded_sources(plan: SimulationPlan) -> frozenset[int]:
    """Return the activities whose times other activities need: when they sent what is read, or stamped what is matched."""
    return frozenset(
        plan.wire_sources[wire_index]
        for wire_index, wire in enumerate(plan.wires)
        if (wire.slot == SLOT_SAMPLED and wire.queue >= 0) or plan.activities[wire.target].within is not None
    )


def _find_rivals(plan: SimulationPlan) -> list[tuple[int, ...]]:
    """Return the wires that share the queue, and so the memory, of each wire."""
    members: dict[int, list[int]] = {}
    for index, wire in enumerate(plan.wires):
        members.setdefault(wire.queue, []).append(index)
    return [
        tuple(other for other in members[wire.queue] if other != index) if wire.queue >= 0 else ()
        for index, wire in enumerate(plan.wires)
    ]


def _find_overtaken(plan: SimulationPlan) -> frozenset[int]:
    """Return the activities of which a later job may end before an earlier one."""
    return frozenset(callback.activity for callback in plan.callbacks if callback.group == REENTRANT)


def _sampled_queues(plan: SimulationPlan, planned: PlannedActivity) -> tuple[int, ...]:
    """Return the queues that a job empties when it starts."""
    sampled_wires = [
        plan.wires[wire_index] for wire_index in planned.wires if plan.wires[wire_index].slot == SLOT_SAMPLED
    ]
    return tuple(dict.fromkeys(wire.queue for wire in sampled_wires if wire.queue >= 0))
