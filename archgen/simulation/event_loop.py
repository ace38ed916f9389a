"""Process the events of one run of a plan, from a heap; times are integers in the plan's unit.

At one moment jobs end first, then samples arrive, then activities are released; when all of that has happened, threads
are dispatched to cores. The inner loop is written for speed: it works on lists indexed by small integers and creates no
objects but tuples.

Of threads that are dispatched a smaller urgency key is more urgent; ties are broken by the order in which they became ready.
"""

from __future__ import annotations

from collections.abc import Collection
from fractions import Fraction
from heapq import heapify, heappop, heappush

from archgen.simulation.executor_state import BY_DEADLINE, FAVOURED_OTHERS, FIXED_RANKS
from archgen.simulation.job_activation import deliver_sample, enqueue_sample, fire_activity, passes_gate, read_inputs
from archgen.simulation.job_completion import complete_callback, end_thread, finish_declared_job
from archgen.simulation.simulation_plan import ONCE, PERIODIC, SimulationPlan
from archgen.simulation.simulation_run import (
    ACTIVITY_RELEASE,
    ALL_WIRES,
    CLOCK_TICK,
    HELD_FIRING,
    JOB_END,
    LATE_TICK,
    LOAD_ONLY,
    NO_WIRE,
    SAMPLE_ARRIVAL,
    SimulationRun,
)
from archgen.simulation.thread_scheduling import (
    feed_threads,
    grant_resource,
    leave_resource,
    let_others_compute,
    plan_steps,
)


def dispatch_threads(run: SimulationRun, now: int) -> None:
    """Let woken executors choose what to do, give out idle resources, then the cores of every changed processor."""
    processors = run.processors
    while run.woken_executors:
        feed_threads(run, run.woken_executors.pop())
    while run.changed_resources:
        grant_resource(run, now, run.changed_resources.pop())
    while run.changed_processors:
        processor = run.changed_processors.pop()
        ready, running = processors.ready[processor], processors.running[processor]
        if processors.has_masks[processor]:
            _assign_allowed_cores(run, now, processor)
            continue
        while ready:
            if len(running) < processors.cores[processor]:
                _start_thread(run, now, heappop(ready)[2], running)
            elif not processors.is_preemptive[processor] or not _preempt_least_urgent(run, now, ready, running):
                break


def _assign_allowed_cores(run: SimulationRun, now: int, processor: int) -> None:
    """Assign cores where some threads may use only some of them, the most urgent first."""
    threads, processors = run.threads, run.processors
    running = processors.running[processor]
    candidates = sorted(processors.ready[processor])
    # Preemptive: all cores are given out anew, running threads included. Otherwise running threads keep theirs.
    if processors.is_preemptive[processor]:
        candidates = sorted([*candidates, *((threads.urgency[t], threads.ready_order[t], t) for t in running)])
        thread_by_core: dict[int, int] = {}
    else:
        thread_by_core = {threads.last_core[t]: t for t in running}
    all_cores = range(processors.cores[processor])
    for _, _, thread in candidates:
        allowed_cores = threads.allowed_cores[thread] or all_cores
        # A thread that is running prefers the core it has, so that it is not moved without need.
        cores = [threads.last_core[thread], *allowed_cores] if thread in running else allowed_cores
        core = next((candidate for candidate in cores if candidate not in thread_by_core), None)
        if core is not None:
            thread_by_core[core] = thread
    _apply_assignment(run, now, processor, thread_by_core)


def _apply_assignment(run: SimulationRun, now: int, processor: int, thread_by_core: dict[int, int]) -> None:
    """Take threads that lost their core off it, and start those that got one."""
    threads = run.threads
    running, ready = run.processors.running[processor], run.processors.ready[processor]
    for thread in [t for t in running if t not in thread_by_core.values()]:
        running.remove(thread)
        _interrupt_thread(run, now, thread)
        ready.append((threads.urgency[thread], threads.ready_order[thread], thread))
    for core, thread in thread_by_core.items():
        threads.last_core[thread] = core
        if thread not in running:
            ready.remove((threads.urgency[thread], threads.ready_order[thread], thread))
            _start_thread(run, now, thread, running)


def _interrupt_thread(run: SimulationRun, now: int, thread: int) -> None:
    """Let a running thread keep what it has left to do."""
    threads = run.threads
    # Its end is already on the heap: the new version makes `end_thread` ignore it.
    threads.end_version[thread] += 1
    threads.time_left[thread] = threads.end_time[thread] - now + threads.time_after_slice[thread]
    threads.time_after_slice[thread] = 0
    if run.log is not None:
        run.log.enter_state(run, thread, "ready")


def _start_thread(run: SimulationRun, now: int, thread: int, running: list[int]) -> None:
    """Start or resume a thread at time `now`, and schedule its end, or that of its time slice."""
    threads = run.threads
    # -1: the job has not started yet. A preempted thread comes back with the time that it has left.
    remaining = threads.time_left[thread]
    if remaining < 0:
        remaining = _begin_callback(run, now, thread)
        if not remaining and run.callbacks.is_storing[threads.callback[thread]]:
            # Most samples are stored in no time: then the heap, which is the most expensive part, need not know.
            let_others_compute(run, thread)
            complete_callback(run, now, thread)
            if run.processors.ready[threads.processor[thread]]:
                run.changed_processors.add(threads.processor[thread])
            return
    if run.processors.has_slices:
        slice_time = run.processors.slice_time[threads.processor[thread]] or remaining
        if run.executors.is_serial[run.callbacks.executor[threads.callback[thread]]]:
            slice_time = min(slice_time, run.processors.switch_time)
        threads.time_after_slice[thread] = max(remaining - slice_time, 0)
        remaining = min(remaining, slice_time)
        processor = threads.processor[thread]
        run.processors.least_served[processor] = max(threads.served[thread], run.processors.least_served[processor])
        threads.served[thread] += remaining
    running.append(thread)
    if run.log is not None:
        run.log.enter_state(run, thread, "runs")
    threads.end_time[thread] = now + remaining
    heappush(run.heap, (now + remaining << 2 | JOB_END, thread, threads.end_version[thread]))


def _begin_callback(run: SimulationRun, now: int, thread: int) -> int:
    """Begin what a thread has taken on, and return how long it works until it ends or uses a resource."""
    threads, callbacks = run.threads, run.callbacks
    callback = threads.callback[thread]
    activity = callbacks.activity[callback]
    callbacks.claim_count[callback] -= 1
    run.executors.waiting_count[callbacks.executor[callback]] -= 1
    job = callbacks.pending[callback].popleft()
    wire = job[1]
    threads.job_activation[thread] = job[0]
    threads.firing_wire[thread] = wire
    if callbacks.is_storing[callback]:
        threads.job_number[thread] = job[2]
    else:
        # Calls are not counted in a queue: they never replace one another.
        if wire >= 0 and not run.wires.is_request[wire]:
            run.wires.waiting_count[run.wires.queue[wire]] -= 1
        # What only loads its host is no job of its own: that one has ended by its declared response.
        threads.job_number[thread] = -1 if wire == LOAD_ONLY else run.activities.started[activity]
        if wire != LOAD_ONLY:
            read_inputs(run, now, activity, job)
    spread = callbacks.time_spread[callback]
    remaining = callbacks.shortest_time[callback]
    if spread:
        remaining = run.draw_time(activity, remaining, spread)
    run.processors.busy_time[threads.processor[thread]] += remaining
    if run.resources.uses[activity] and not callbacks.is_storing[callback]:
        remaining = plan_steps(run, thread, activity, remaining)
    threads.time_left[thread] = remaining
    return remaining


def _preempt_least_urgent(run: SimulationRun, now: int, ready: list[tuple[int, int, int]], running: list[int]) -> bool:
    """Take the least urgent running thread off its core if a more urgent one is ready; return whether it did."""
    threads = run.threads
    least_urgent = max(running, key=lambda t: (threads.urgency[t], threads.ready_order[t]))
    urgency = ready[0][0]
    # Keys below zero are written priorities, which always preempt. Other threads preempt only under fixed ranks.
    if urgency >= threads.urgency[least_urgent] or (
        urgency >= 0
        and run.processors.scheduler[threads.processor[least_urgent]] not in (FIXED_RANKS, FAVOURED_OTHERS, BY_DEADLINE)
    ):
        return False
    running.remove(least_urgent)
    _interrupt_thread(run, now, least_urgent)
    heappush(ready, (threads.urgency[least_urgent], threads.ready_order[least_urgent], least_urgent))
    return True


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
