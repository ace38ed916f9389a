"""Dispatch threads to cores, and preempt the less urgent ones.

A smaller urgency key is more urgent; ties are broken by the order in which threads became ready.
"""

from __future__ import annotations

from heapq import heappop, heappush

from archgen.simulation.executor_state import BY_DEADLINE, FAVOURED_OTHERS, FIXED_RANKS
from archgen.simulation.job_activation import read_inputs
from archgen.simulation.job_completion import complete_callback
from archgen.simulation.resource_use import grant_resource, plan_steps
from archgen.simulation.simulation_run import JOB_END, LOAD_ONLY, SimulationRun
from archgen.simulation.thread_scheduling import feed_threads, let_others_compute


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
        if wire != LOAD_ONLY:
            threads.job_number[thread] = run.activities.started[activity]
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
