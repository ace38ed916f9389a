"""The state of one run: lists indexed by small integers, made from a plan and a seed.

A seed also decides what a plan leaves open: phases, how often extremes are drawn, and the scheduler of every processor
without written priorities, since the bounds hold for any scheduler that leaves no core idle while a thread waits.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Collection
from random import Random
from typing import Any

from archgen.simulation.simulation_plan import PERIODIC, SLOT_SAMPLED, PlannedActivity, SimulationPlan

FIRST_FIRST, LAST_FIRST, RANDOM_ORDER, FIXED_RANKS = range(4)
"""Schedulers: first come first served, last come first served, random, and ranks drawn once, preemptive."""
CRITICAL_INTERVAL = 4
"""Every so many seeds everything starts at once and always takes its longest: the critical instant of the textbooks."""

Job = tuple[int, int, Any]
"""Activation time, the wire that fired the job (-1 for none, -2 for all inputs together, -3 for load only), and the
number of the producer's job (a tuple, one for each input, where all fired it together).
"""


class ActivityStates:
    """The state of every activity, by its number. Times are in units, -1 means never."""

    def __init__(self, plan: SimulationPlan, dice: Random, watched: Collection[int]) -> None:
        activities = plan.activities
        count = len(activities)
        self.period = [planned.period for planned in activities]
        self.jitter = [planned.jitter for planned in activities]
        self.shortest_time = [planned.bcet for planned in activities]
        self.time_spread = [planned.wcet - planned.bcet for planned in activities]
        self.thread = [planned.thread for planned in activities]
        self.declared_response = [planned.declared_response for planned in activities]
        self.is_gated = [planned.every > 1 or planned.throttle > 0 for planned in activities]
        # The order of all draws in this module is part of the result: the same seed must give the same figures.
        self.phase = [dice.randrange(planned.period) if planned.kind == PERIODIC else 0 for planned in activities]
        self.every_counter = [dice.randrange(planned.every) for planned in activities]
        self.last_activation = [-1] * count
        """When it was last activated."""
        self.last_passed = [-1] * count
        """When its gates last let an activation through, before jitter."""
        self.filled_slots = [sum(1 << slot for slot in planned.constant_slots) for planned in activities]
        self.pending: list[deque[Job]] = [deque() for _ in activities]
        self.started = [0] * count
        self.finished = [0] * count
        self.job_activation = [0] * count
        """When the running job was activated."""
        self.firing_wire = [-1] * count
        """What fired the running job: a wire, or a negative number as in `Job`."""
        self.waiting_requests: list[list[int]] = [[] for _ in activities]
        """Requests that wait for the next activation of a periodic server."""
        self.accepted_requests: list[list[int]] = [[] for _ in activities]
        """Requests that are answered at the next end."""
        self.call_remainders = [
            [dice.randrange(calls_per_job.denominator) for calls_per_job, _ in planned.calls] for planned in activities
        ]
        self.held_firings: list[deque[tuple[int, Any]]] = [deque() for _ in activities]
        """Activations by data that jitter holds back: wire, and number as in `Job`."""
        self.held_until = [0] * count
        self.declared_jobs: list[deque[Job]] = [deque() for _ in activities]
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
        self.is_watched = [index in watched for index in range(count)]
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
        self.newest_job = [-1] * len(wires)
        """The producer's job whose sample the reader has, or had when it last started."""
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
        self.sampled_queues = [_sampled_queues(plan, planned) for planned in plan.activities]


def _sampled_queues(plan: SimulationPlan, planned: PlannedActivity) -> tuple[int, ...]:
    """Return the queues that a job empties when it starts."""
    sampled_wires = [
        plan.wires[wire_index] for wire_index in planned.wires if plan.wires[wire_index].slot == SLOT_SAMPLED
    ]
    return tuple(dict.fromkeys(wire.queue for wire in sampled_wires if wire.queue >= 0))


class ThreadStates:
    """The state of every thread, pool and processor, by its number. Times are in units."""

    def __init__(self, plan: SimulationPlan, dice: Random) -> None:
        count = len(plan.threads)
        self.processor = list(plan.threads)
        self.members = [tuple(dice.sample(members, len(members))) for members in plan.thread_members]
        self.is_shared = [len(members) > 1 for members in plan.thread_members]
        self.executor_round: list[deque[int]] = [deque() for _ in range(count)]
        """The callbacks that the executor saw ready when it last looked."""
        self.affinity = list(plan.affinity)
        pinned_processors = {plan.threads[index] for index, core in enumerate(plan.affinity) if core >= 0}
        self.has_pinned = [index in pinned_processors for index in range(len(plan.processors))]
        """Whether some threads of a processor are pinned to one of its cores."""
        self.last_core = [-1] * count
        self.pool = list(plan.pool_of_thread)
        self.free_count = list(plan.pool_sizes)
        self.pool_queue: list[deque[int]] = [deque() for _ in plan.pool_sizes]
        """The threads that wait for a free thread of their container."""
        self.is_queued = [False] * count
        self.is_idle = [True] * count
        self.current_activity = [-1] * count
        self.urgency = [0] * count
        self.ready_order = [0] * count
        self.time_left = [-1] * count
        """Execution time that is left; -1 before the job starts."""
        self.end_time = [0] * count
        self.end_version = [0] * count
        self.rank = dice.sample(range(count), count)
        self.cores = [processor.cores for processor in plan.processors]
        self.scheduler = [dice.choice((FIRST_FIRST, LAST_FIRST, RANDOM_ORDER, FIXED_RANKS)) for _ in plan.processors]
        # One written priority makes the whole processor preemptive, as the analysis assumes.
        ranked = {plan.threads[planned.thread] for planned in plan.activities if planned.priority is not None}
        self.is_preemptive = [index in ranked or chosen == FIXED_RANKS for index, chosen in enumerate(self.scheduler)]
        self.ready: list[list[tuple[int, int, int]]] = [[] for _ in plan.processors]
        self.running: list[list[int]] = [[] for _ in plan.processors]
        self.busy_time = [0] * len(plan.processors)
