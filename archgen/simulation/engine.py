"""Process the events of one run of a plan, from a heap; times are integers in the plan's unit.

At one moment jobs end first, then samples arrive, then activities are released; when all of that has happened, threads
are dispatched to cores. The inner loop is written for speed: it works on lists indexed by small integers and creates no
objects but tuples.
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
"""The most events that may wait on the heap: far more than any system that settles has."""
MOST_ROUNDS = 100_000
"""The most dispatches at one moment, which is what jobs that take no time cause."""


class FloodError(Exception):
    """Each event causes more than one other, so that the simulation would never end. `gave_up_at` is the simulated time
    in ns.
    """

    def __init__(self, at: Fraction) -> None:
        super().__init__(at)
        self.at = at


def go(plan: Plan, seed: int, horizon: int, watched: Collection[int] = (), logged: Collection[int] = ()) -> Run:
    """Run a plan with a seed up to `horizon` (in units) and return the finished run.

    The jobs of the `watched` activities are recorded, and which samples they read on the `logged` wires.
    """
    run = Run(plan, seed, watched, logged)
    play(run, horizon)
    return run


def play(run: Run, horizon: int) -> None:
    """Process all events up to `horizon` (in units). Raise EventFloodError if they multiply without end."""
    _begin(run)
    # A key holds the time in its upper bits and the order within a moment in its lowest two, so that comparing one
    # integer orders two events.
    heap = run.heap
    now = popped = rounds = 0
    while heap:
        key = heap[0][0]
        if key >> 2 > now:
            # All events of this moment are processed: dispatch before time goes on. A job that takes no time ends at
            # this very moment, so the heap is looked at again.
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
        # A negative subject is the end of a job with a declared response, which belongs to an activity and not to a
        # thread.
        elif what >= 0:
            ended(run, now, what, which)
        else:
            keep_promise(run, now, -1 - what)
    # Job starts and direct deliveries skip the heap, and count as events too.
    run.events = popped + sum(run.steps.started) + run.wires.sent


def _begin(run: Run) -> None:
    """Deliver what is published once, and schedule the first tick of every periodic activity."""
    for at, step in enumerate(run.plan.steps):
        if step.kind == KEPT:
            for output in step.outputs:
                for wire in output.wires:
                    run.wires.newest[wire] = run.wires.arrived[wire] = 0
        elif step.kind == PERIODIC:
            run.heap.append((run.steps.phase[at] << 2 | RELEASE, at, TICK))
    heapify(run.heap)


def _release(run: Run, now: int, at: int, what: int) -> None:
    """Handle a release: a clock tick, a tick delayed by jitter, or an activation by data that jitter held back."""
    steps = run.steps
    if what == HELD:
        wire, sample = steps.held[at].popleft()
        if wire == SEVERAL:
            fire(run, now, at, wire, sample)
        else:
            enqueue(run, now, wire, sample)
        return
    if what == TICK:
        # RELEASE, at, TICK)) | The next tick follows from the nominal time, not from the delayed one: jitter does not
        # accumulate.
        heappush(run.heap, (now + steps.period[at] << 2 | RELEASE, at, TICK))
        jitter = steps.jitter[at]
        if jitter:
            delay = run.between(at, 0, jitter)
            if delay:
                heappush(run.heap, (now + delay << 2 | RELEASE, at, LATE))
                return
    if not steps.gated[at] or passes(run, now, at):
        fire(run, now, at, NOBODY, 0)
