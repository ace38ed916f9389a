"""The state of one run: lists by small integers, made from a plan and a seed.

A seed also decides what a plan leaves open: phases, how often extremes are drawn, and the scheduler of every processor
without written priorities, since the bounds hold for each that leaves no core idle while somebody waits.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Collection
from random import Random
from typing import Any

from archgen.simulation.plan import PERIODIC, SAMPLED, Plan, Step

FIFO, LAST_FIRST, LOTTERY, RANKS = range(4)
"""Schedulers: first come first served, last come first served, at random, and ranks drawn once, preemptively."""
CRITICAL = 4
"""One seed in so many starts everything at once and takes the longest always: the textbooks' critical instant."""

Job = tuple[int, int, Any]
"""When it was fired, the wire that fired it (-1 for none, -2 for all of several, -3 for load alone), and the number of
the producer's job (for all of several: of each)."""


class Steps:
    """What is kept for each activity, by its number."""

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
        self.phase = [dice.randrange(step.period) if step.kind == PERIODIC else 0 for step in steps]
        self.turn = [dice.randrange(step.every) for step in steps]
        self.fired = [-1] * count
        """When it was fired last."""
        self.let_through = [-1] * count
        """When data fired it last, jitter not counted."""
        self.mask = [sum(1 << slot for slot in step.kept) for step in steps]
        self.pending: list[deque[Job]] = [deque() for _ in steps]
        self.started = [0] * count
        self.finished = [0] * count
        self.acted = [0] * count
        """When the running job was fired."""
        self.request = [-1] * count
        """The request that the running job answers."""
        self.asked: list[list[int]] = [[] for _ in steps]
        """Requests that wait for the next activation of a server that is periodic."""
        self.taken: list[list[int]] = [[] for _ in steps]
        """Those that are answered at the next end."""
        self.due = [[dice.randrange(number.denominator) for number, _ in step.calls] for step in steps]
        self.held: list[deque[tuple[int, Any]]] = [deque() for _ in steps]
        """What fired an activity that is not a clock, and is held back by its jitter: wire, and number as in a job."""
        self.held_until = [0] * count
        self.promises: list[deque[Job]] = [deque() for _ in steps]
        self.promise_end = [0] * count
        self.worst = [0] * count
        self.best = [-1] * count
        self.gap = [0] * count
        """The largest time between two ends."""
        self.firing_gap = [0] * count
        self.end = [-1] * count
        self.published = [[-1] * len(step.outputs) for step in steps]
        self.silence = [[0] * len(step.outputs) for step in steps]
        """The largest time between two publications of an output."""
        self.watched = [at in watched for at in range(count)]
        self.starts: list[list[int]] = [[] for _ in steps]
        self.firings: list[list[int]] = [[] for _ in steps]
        self.ends: list[list[int]] = [[] for _ in steps]


class Wires:
    """What is kept for each arc, queue and link, by its number."""

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
        """The producer's job whose sample the reader has, or had at its last start."""
        self.arrived = [-1] * len(wires)
        """The same, of what waits until all are there."""
        self.last = [0] * len(wires)
        """When the last sample arrives: they keep their order."""
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
        """The jobs of the source that sent something on the noted ones."""
        self.logged = [tuple(e for e in step.wires if e in logged) for step in plan.steps]
        self.sampled = [_sampled(plan, step) for step in plan.steps]


def _sampled(plan: Plan, step: Step) -> tuple[int, ...]:
    """Give the queues that a job empties at its start."""
    kept = [plan.wires[e] for e in step.wires if plan.wires[e].slot == SAMPLED]
    return tuple(dict.fromkeys(wire.queue for wire in kept if wire.queue >= 0))


class Threads:
    """What is kept for each thread and processor, by its number."""

    def __init__(self, plan: Plan, dice: Random) -> None:
        count = len(plan.threads)
        self.processor = list(plan.threads)
        self.members = [tuple(dice.sample(members, len(members))) for members in plan.members]
        self.shared = [len(members) > 1 for members in plan.members]
        self.round: list[deque[int]] = [deque() for _ in range(count)]
        """Who is ready, as the executor last saw it."""
        self.affinity = list(plan.affinity)
        pinned = {plan.threads[at] for at, core in enumerate(plan.affinity) if core >= 0}
        self.mixed = [at in pinned for at in range(len(plan.processors))]
        """Whether some of a processor's threads must have a core of their own choice."""
        self.core = [-1] * count
        self.pool = list(plan.pool_of_thread)
        self.free = list(plan.pools)
        self.queue: list[deque[int]] = [deque() for _ in plan.pools]
        """Who waits for a thread of its container."""
        self.queued = [False] * count
        self.idle = [True] * count
        self.current = [-1] * count
        self.key = [0] * count
        self.order = [0] * count
        self.left = [-1] * count
        """Execution that is left, -1 before the start."""
        self.until = [0] * count
        self.version = [0] * count
        self.rank = dice.sample(range(count), count)
        self.cores = [processor.cores for processor in plan.processors]
        self.scheduler = [dice.choice((FIFO, LAST_FIRST, LOTTERY, RANKS)) for _ in plan.processors]
        ranked = {plan.threads[step.thread] for step in plan.steps if step.priority is not None}
        self.preemptive = [at in ranked or chosen == RANKS for at, chosen in enumerate(self.scheduler)]
        self.ready: list[list[tuple[int, int, int]]] = [[] for _ in plan.processors]
        self.running: list[list[int]] = [[] for _ in plan.processors]
        self.busy = [0] * len(plan.processors)
