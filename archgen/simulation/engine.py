"""One run of a plan: events on a heap, in units of time that are integers.

At one moment ends come first, then arrivals, then releases; when all of them are done, threads are given to cores. The
inner loop is written for speed: it works on lists by small integers and makes no objects but tuples.
"""

from __future__ import annotations

from collections.abc import Collection
from fractions import Fraction
from heapq import heapify, heappop, heappush

from archgen.simulation.arriving import deliver, enqueue
from archgen.simulation.cores import dispatch
from archgen.simulation.ending import ended, keep_promise
from archgen.simulation.firing import fire, passes
from archgen.simulation.plan import KEPT, PERIODIC, Plan
from archgen.simulation.run import ARRIVAL, HELD, LATE, NOBODY, RELEASE, SEVERAL, TICK, Run

MOST_WAITING = 2_000_000
"""Events that may wait: far more than any system that comes to rest has."""
MOST_ROUNDS = 100_000
"""Jobs of one thread, one after the other, that may take no time at all."""


class FloodError(Exception):
    """Each event makes more than one other: the simulation would never end. `at` is when it was given up, in ns."""

    def __init__(self, at: Fraction) -> None:
        super().__init__(at)
        self.at = at


def go(plan: Plan, seed: int, horizon: int, watched: Collection[int] = (), logged: Collection[int] = ()) -> Run:
    """Run a plan by a seed until a moment; note the jobs of the watched steps, and what they read on the logged wires."""
    run = Run(plan, seed, watched, logged)
    play(run, horizon)
    return run


def play(run: Run, horizon: int) -> None:
    """Play what was drawn until a moment."""
    _begin(run)
    heap = run.heap
    now = popped = rounds = 0
    while heap:
        key = heap[0][0]
        if key >> 2 > now:
            if run.awake or run.touched:
                dispatch(run, now)
                rounds += 1
                if rounds > MOST_ROUNDS:
                    raise FloodError(now * run.plan.unit)
                continue
            now = key >> 2
            if now > horizon:
                break
            rounds = 0
            if len(heap) > MOST_WAITING:
                raise FloodError(now * run.plan.unit)
        _, what, which = heappop(heap)
        popped += 1
        order = key & 3
        if order == ARRIVAL:
            deliver(run, now, what, which)
        elif order == RELEASE:
            _release(run, now, what, which)
        elif what >= 0:
            ended(run, now, what, which)
        else:
            keep_promise(run, now, -1 - what)
    run.events = popped + sum(run.steps.started) + run.wires.sent


def _begin(run: Run) -> None:
    """Publish what is published once, and set the clocks."""
    for at, step in enumerate(run.plan.steps):
        if step.kind == KEPT:
            for output in step.outputs:
                for wire in output.wires:
                    run.wires.newest[wire] = run.wires.arrived[wire] = 0
        elif step.kind == PERIODIC:
            run.heap.append((run.steps.phase[at] << 2 | RELEASE, at, TICK))
    heapify(run.heap)


def _release(run: Run, now: int, at: int, what: int) -> None:
    """Let a clock tick, or let through what was held back by jitter."""
    steps = run.steps
    if what == HELD:
        wire, sample = steps.held[at].popleft()
        if wire == SEVERAL:
            fire(run, now, at, wire, sample)
        else:
            enqueue(run, now, wire, sample)
        return
    if what == TICK:
        heappush(run.heap, (now + steps.period[at] << 2 | RELEASE, at, TICK))
        jitter = steps.jitter[at]
        if jitter:
            delay = run.between(at, 0, jitter)
            if delay:
                heappush(run.heap, (now + delay << 2 | RELEASE, at, LATE))
                return
    if not steps.gated[at] or passes(run, now, at):
        fire(run, now, at, NOBODY, 0)
