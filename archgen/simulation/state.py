"""The state of one run: lists indexed by small integers, made from a plan and a seed.

A seed also decides what a plan leaves open: phases, how often extremes are drawn, and the scheduler of every processor
without written priorities, since the bounds hold for any scheduler that leaves no core idle while a thread waits.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Collection
from random import Random
from typing import Any

from archgen.simulation.plan import PERIODIC, SAMPLED, Plan, Step

FIFO, LAST_FIRST, LOTTERY, RANKS = range(4)
"""Schedulers: first come first served, last come first served, random, and ranks drawn once, preemptive."""
CRITICAL = 4
"""Every so many seeds everything starts at once and always takes its longest: the critical instant of the textbooks."""

Job = tuple[int, int, Any]
"""Activation time, the wire that fired the job (-1 for none, -2 for all inputs together, -3 for load only), and the
number of the producer's job (a tuple, one for each input, where all fired it together).
"""


class Steps:
    """The state of every activity, by its number. Times are in units, -1 means never."""

    def __init__(self, plan: Plan, dice: Random, watched: Collection[int]) -> None:
        steps = plan.steps
        count = len(steps)
        self.period = [step.period for step in steps]
        self.jitter = [step.jitter for step in steps]
        self.shortest = [step.bcet for step in steps]
        self.spread = [step.wcet - step.bcet for step in steps]
        self.thread = [step.thread for step in steps]
        self.promised = [step.promised for step in steps]
        self.gated = [step.every > 1 or step.throttle > 0 for step in steps]
        # The order of all draws in this module is part of the result: the same seed must give the same figures.
        self.phase = [dice.randrange(step.period) if step.kind == PERIODIC else 0 for step in steps]
        self.turn = [dice.randrange(step.every) for step in steps]
        self.fired = [-1] * count
        """When it was last activated."""
        self.let_through = [-1] * count
        """When its gates last let an activation through, before jitter."""
        self.mask = [sum(1 << slot for slot in step.kept) for step in steps]
        self.pending: list[deque[Job]] = [deque() for _ in steps]
        self.started = [0] * count
        self.finished = [0] * count
        self.acted = [0] * count
        """When the running job was activated."""
        self.request = [-1] * count
        """What fired the running job: a wire, or a negative number as in `Job`."""
        self.asked: list[list[int]] = [[] for _ in steps]
        """Requests that wait for the next activation of a periodic server."""
        self.taken: list[list[int]] = [[] for _ in steps]
        """Requests that are answered at the next end."""
        self.due = [[dice.randrange(number.denominator) for number, _ in step.calls] for step in steps]
        self.held: list[deque[tuple[int, Any]]] = [deque() for _ in steps]
        """Activations by data that jitter holds back: wire, and number as in `Job`."""
        self.held_until = [0] * count
        self.promises: list[deque[Job]] = [deque() for _ in steps]
        self.promise_end = [0] * count
        self.worst = [0] * count
        self.best = [-1] * count
        self.gap = [0] * count
        """The longest time between two ends."""
        self.firing_gap = [0] * count
        self.end = [-1] * count
        self.published = [[-1] * len(step.outputs) for step in steps]
        self.silence = [[0] * len(step.outputs) for step in steps]
        """The longest time between two publications, by output."""
        self.watched = [at in watched for at in range(count)]
        self.starts: list[list[int]] = [[] for _ in steps]
        self.firings: list[list[int]] = [[] for _ in steps]
        self.ends: list[list[int]] = [[] for _ in steps]


class Wires:
    """The state of every wire, queue and link, by its number. Times are in units."""

    def __init__(self, plan: Plan, logged: Collection[int]) -> None:
        wires = plan.wires
        self.target = [wire.target for wire in wires]
        self.slot = [wire.slot for wire in wires]
        self.best = [wire.best for wire in wires]
        self.spread = [wire.worst - wire.best for wire in wires]
        self.queue = [wire.queue for wire in wires]
        self.depth = [wire.depth for wire in wires]
        self.link = [wire.link for wire in wires]
        self.transmission = [wire.transmission for wire in wires]
        self.limit = [wire.limit for wire in wires]
        self.direct = [wire.worst == 0 and wire.link < 0 for wire in wires]
        self.request = [wire.request for wire in wires]
        self.newest = [-1] * len(wires)
        """The producer's job whose sample the reader has, or had when it last started."""
        self.arrived = [-1] * len(wires)
        """The same for a sample that waits until the other inputs have arrived."""
        self.last = [0] * len(wires)
        """When the last sample arrives: samples keep their order."""
        self.sent = 0
        self.waiting = [0] * len(plan.queues)
        self.drops = [0] * len(plan.queues)
        self.link_free = [0] * len(plan.links)
        self.link_wait = [0] * len(plan.links)
        self.link_busy = [0] * len(plan.links)
        logs: list[list[int]] = [[] for _ in wires]
        self.log = logs
        self.noted = [wire.selective and e in logged for e, wire in enumerate(wires)]
        self.passed: list[list[int]] = [[] for _ in wires]
        """The jobs of the source that sent something, for wires with `is_noted`."""
        self.logged = [tuple(e for e in step.wires if e in logged) for step in plan.steps]
        self.sampled = [_sampled(plan, step) for step in plan.steps]


def _sampled(plan: Plan, step: Step) -> tuple[int, ...]:
    """Return the queues that a job empties when it starts."""
    kept = [plan.wires[e] for e in step.wires if plan.wires[e].slot == SAMPLED]
    return tuple(dict.fromkeys(wire.queue for wire in kept if wire.queue >= 0))


class Threads:
    """The state of every thread, pool and processor, by its number. Times are in units."""

    def __init__(self, plan: Plan, dice: Random) -> None:
        count = len(plan.threads)
        self.processor = list(plan.threads)
        self.members = [tuple(dice.sample(members, len(members))) for members in plan.members]
        self.shared = [len(members) > 1 for members in plan.members]
        self.round: list[deque[int]] = [deque() for _ in range(count)]
        """The callbacks that the executor saw ready when it last looked."""
        self.affinity = list(plan.affinity)
        pinned = {plan.threads[at] for at, core in enumerate(plan.affinity) if core >= 0}
        self.mixed = [at in pinned for at in range(len(plan.processors))]
        """Whether some threads of a processor are pinned to one of its cores."""
        self.core = [-1] * count
        self.pool = list(plan.pool_of_thread)
        self.free = list(plan.pools)
        self.queue: list[deque[int]] = [deque() for _ in plan.pools]
        """The threads that wait for a free thread of their container."""
        self.queued = [False] * count
        self.idle = [True] * count
        self.current = [-1] * count
        self.key = [0] * count
        self.order = [0] * count
        self.left = [-1] * count
        """Execution time that is left; -1 before the job starts."""
        self.until = [0] * count
        self.version = [0] * count
        self.rank = dice.sample(range(count), count)
        self.cores = [processor.cores for processor in plan.processors]
        self.scheduler = [dice.choice((FIFO, LAST_FIRST, LOTTERY, RANKS)) for _ in plan.processors]
        # One written priority makes the whole processor preemptive, as the analysis assumes.
        ranked = {plan.threads[step.thread] for step in plan.steps if step.priority is not None}
        self.preemptive = [at in ranked or chosen == RANKS for at, chosen in enumerate(self.scheduler)]
        self.ready: list[list[tuple[int, int, int]]] = [[] for _ in plan.processors]
        self.running: list[list[int]] = [[] for _ in plan.processors]
        self.busy = [0] * len(plan.processors)
