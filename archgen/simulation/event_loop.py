"""Process the events of one run of a plan, from a heap; times are integers in the plan's unit.

At one moment jobs end first, then samples arrive, then activities are released; when all of that has happened, threads
are dispatched to cores. The inner loop is written for speed: it works on lists indexed by small integers and creates no
objects but tuples.
"""

from __future__ import annotations

from collections.abc import Collection
from fractions import Fraction
from heapq import heapify, heappop, heappush

from archgen.simulation.core_dispatch import dispatch_threads
from archgen.simulation.job_activation import deliver_sample, enqueue_sample, fire_activity, passes_gate
from archgen.simulation.job_completion import end_thread, finish_declared_job
from archgen.simulation.resource_use import leave_resource
from archgen.simulation.simulation_plan import ONCE, PERIODIC, SimulationPlan
from archgen.simulation.simulation_run import (
    ACTIVITY_RELEASE,
    ALL_WIRES,
    CLOCK_TICK,
    HELD_FIRING,
    LATE_TICK,
    NO_WIRE,
    SAMPLE_ARRIVAL,
    SimulationRun,
)

MAX_WAITING_EVENTS = 2_000_000
"""The most events that may wait on the heap: far more than any system that settles has."""
MAX_IDLE_ROUNDS = 100_000
"""The most dispatches at one moment, which is what jobs that take no time cause."""


class EventFloodError(Exception):
    """Each event causes more than one other, so that the simulation would never end. `gave_up_at` is the simulated time
    in ns.
    """

    def __init__(self, gave_up_at: Fraction) -> None:
        super().__init__(gave_up_at)
        self.gave_up_at = gave_up_at


def run_plan(
    plan: SimulationPlan, seed: int, horizon: int, watched: Collection[int] = (), logged: Collection[int] = ()
) -> SimulationRun:
    """Run a plan with a seed up to `horizon` (in units) and return the finished run.

    The jobs of the `watched` activities are recorded, and which samples they read on the `logged` wires.
    """
    run = SimulationRun(plan, seed, watched, logged)
    process_events(run, horizon)
    return run


def process_events(run: SimulationRun, horizon: int) -> None:
    """Process all events up to `horizon` (in units). Raise EventFloodError if they multiply without end."""
    _prepare_start(run)
    # A key holds the time in its upper bits and the order within a moment in its lowest two, so that comparing one
    # integer orders two events.
    heap = run.heap
    now = event_count = dispatch_rounds = 0
    while heap:
        key = heap[0][0]
        if key >> 2 > now:
            # All events of this moment are processed: dispatch before time goes on. A job that takes no time ends at
            # this very moment, so the heap is looked at again.
            if run.woken_executors or run.changed_processors or run.changed_resources:
                dispatch_threads(run, now)
                dispatch_rounds += 1
                if dispatch_rounds > MAX_IDLE_ROUNDS:
                    raise EventFloodError(now * run.plan.unit)
                continue
            now = key >> 2
            if now > horizon:
                break
            run.now = now
            dispatch_rounds = 0
            if len(heap) > MAX_WAITING_EVENTS:
                raise EventFloodError(now * run.plan.unit)
        _, subject, detail = heappop(heap)
        event_count += 1
        order = key & 3
        if order == SAMPLE_ARRIVAL:
            deliver_sample(run, now, subject, detail)
        elif order == ACTIVITY_RELEASE:
            _release_activity(run, now, subject, detail)
        elif subject >= 0:
            end_thread(run, now, subject, detail)
        else:
            _end_without_thread(run, now, -1 - subject)
    # Job starts and direct deliveries skip the heap, and count as events too.
    run.event_count = event_count + sum(run.activities.started) + run.wires.sent_count


def _end_without_thread(run: SimulationRun, now: int, subject: int) -> None:
    """End a job with a declared response, which belongs to an activity and not to a thread, or the use of a resource."""
    activity_count = len(run.plan.activities)
    if subject < activity_count:
        finish_declared_job(run, now, subject)
    else:
        leave_resource(run, subject - activity_count)


def _prepare_start(run: SimulationRun) -> None:
    """Deliver what is published once, and schedule the first tick of every periodic activity."""
    for activity, planned in enumerate(run.plan.activities):
        if planned.kind == ONCE:
            for output in planned.outputs:
                for wire in output.wires:
                    run.wires.newest_job[wire] = run.wires.arrived_job[wire] = 0
                    if run.activities.matchers[run.wires.target[wire]] is not None and run.wires.slot[wire] >= 0:
                        deliver_sample(run, 0, wire, 0)
        elif planned.kind == PERIODIC:
            run.heap.append((run.activities.phase[activity] << 2 | ACTIVITY_RELEASE, activity, CLOCK_TICK))
    heapify(run.heap)


def _release_activity(run: SimulationRun, now: int, activity: int, release_kind: int) -> None:
    """Handle a release: a clock tick, a tick delayed by jitter, or an activation by data that jitter held back."""
    activities = run.activities
    if release_kind == HELD_FIRING:
        wire, sample = activities.held_firings[activity].popleft()
        if wire == ALL_WIRES:
            fire_activity(run, now, activity, wire, sample)
        else:
            enqueue_sample(run, now, wire, sample)
        return
    if release_kind == CLOCK_TICK:
        # RELEASE, at, TICK)) | The next tick follows from the nominal time, not from the delayed one: jitter does not
        # accumulate.
        heappush(run.heap, (now + activities.period[activity] << 2 | ACTIVITY_RELEASE, activity, CLOCK_TICK))
        jitter = activities.jitter[activity]
        if jitter:
            delay = run.draw_time(activity, 0, jitter)
            if delay:
                heappush(run.heap, (now + delay << 2 | ACTIVITY_RELEASE, activity, LATE_TICK))
                return
    if not activities.is_gated[activity] or passes_gate(run, now, activity):
        fire_activity(run, now, activity, NO_WIRE, 0)
