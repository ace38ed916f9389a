"""Dispatch threads to cores, and preempt the less urgent ones.

A smaller urgency key is more urgent; ties are broken by the order in which threads became ready.
"""

from __future__ import annotations

from heapq import heappop, heappush

from archgen.simulation.job_activation import read_inputs
from archgen.simulation.run_state import FIXED_RANKS
from archgen.simulation.simulation_run import JOB_END, LOAD_ONLY, SimulationRun
from archgen.simulation.thread_scheduling import choose_job


def dispatch_threads(run: SimulationRun, now: int) -> None:
    """Choose the next job of each woken thread, then give out the cores of every changed processor."""
    threads = run.threads
    while run.woken_threads:
        thread = run.woken_threads.pop()
        if threads.is_idle[thread]:
            choose_job(run, thread)
    while run.changed_processors:
        processor = run.changed_processors.pop()
        ready, running = threads.ready[processor], threads.running[processor]
        if threads.has_pinned[processor]:
            _assign_pinned(run, now, processor)
            continue
        while ready:
            if len(running) < threads.cores[processor]:
                _start_thread(run, now, heappop(ready)[2], running)
            elif not threads.is_preemptive[processor] or not _preempt_least_urgent(run, now, ready, running):
                break


def _assign_pinned(run: SimulationRun, now: int, processor: int) -> None:
    """Assign cores where some threads are pinned and others are not, the most urgent first."""
    threads = run.threads
    running = threads.running[processor]
    candidates = sorted(threads.ready[processor])
    # Preemptive: all cores are given out anew, running threads included. Otherwise running threads keep theirs.
    if threads.is_preemptive[processor]:
        candidates = sorted([*candidates, *((threads.urgency[t], threads.ready_order[t], t) for t in running)])
        thread_by_core: dict[int, int] = {}
    else:
        thread_by_core = {threads.last_core[t]: t for t in running}
    for _, _, thread in candidates:
        pinned_core, last_core = threads.affinity[thread], threads.last_core[thread]
        # An unpinned thread that is running prefers the core it has, so that it is not moved without need.
        cores = (
            [pinned_core]
            if pinned_core >= 0
            else [*([last_core] if thread in running else []), *range(threads.cores[processor])]
        )
        core = next((candidate for candidate in cores if candidate not in thread_by_core), None)
        if core is not None:
            thread_by_core[core] = thread
    _apply_assignment(run, now, processor, thread_by_core)


def _apply_assignment(run: SimulationRun, now: int, processor: int, thread_by_core: dict[int, int]) -> None:
    """Take threads that lost their core off it, and start those that got one."""
    threads = run.threads
    running, ready = threads.running[processor], threads.ready[processor]
    for thread in [t for t in running if t not in thread_by_core.values()]:
        running.remove(thread)
        # The job's end is already on the heap: the new version makes `end_thread` ignore it.
        threads.end_version[thread] += 1
        threads.time_left[thread] = threads.end_time[thread] - now
        ready.append((threads.urgency[thread], threads.ready_order[thread], thread))
    for core, thread in thread_by_core.items():
        threads.last_core[thread] = core
        if thread not in running:
            ready.remove((threads.urgency[thread], threads.ready_order[thread], thread))
            _start_thread(run, now, thread, running)


def _start_thread(run: SimulationRun, now: int, thread: int, running: list[int]) -> None:
    """Start or resume a thread at time `now`, and schedule the end of its job."""
    threads, activities = run.threads, run.activities
    remaining = threads.time_left[thread]
    # -1: the job has not started yet. A preempted thread comes back with the time that it has left.
    if remaining < 0:
        activity = threads.current_activity[thread]
        job = activities.pending[activity].popleft()
        wire = job[1]
        # Calls are not counted in a queue: they never replace one another.
        if wire >= 0 and not run.wires.is_request[wire]:
            run.wires.waiting_count[run.wires.queue[wire]] -= 1
        activities.job_activation[activity] = job[0]
        activities.firing_wire[activity] = wire
        if wire != LOAD_ONLY:
            read_inputs(run, now, activity, job)
        spread = activities.time_spread[activity]
        remaining = (
            run.draw_time(activity, activities.shortest_time[activity], spread)
            if spread
            else activities.shortest_time[activity]
        )
        run.threads.busy_time[threads.processor[thread]] += remaining
        threads.time_left[thread] = remaining
    running.append(thread)
    threads.end_time[thread] = now + remaining
    heappush(run.heap, (now + remaining << 2 | JOB_END, thread, threads.end_version[thread]))


def _preempt_least_urgent(run: SimulationRun, now: int, ready: list[tuple[int, int, int]], running: list[int]) -> bool:
    """Take the least urgent running thread off its core if a more urgent one is ready; return whether it did."""
    threads = run.threads
    least_urgent = max(running, key=lambda t: (threads.urgency[t], threads.ready_order[t]))
    urgency = ready[0][0]
    # Keys below zero are written priorities, which always preempt. Other threads preempt only under fixed ranks.
    if urgency >= threads.urgency[least_urgent] or (
        urgency >= 0 and threads.scheduler[threads.processor[least_urgent]] != FIXED_RANKS
    ):
        return False
    running.remove(least_urgent)
    threads.end_version[least_urgent] += 1
    threads.time_left[least_urgent] = threads.end_time[least_urgent] - now
    heappush(ready, (threads.urgency[least_urgent], threads.ready_order[least_urgent], least_urgent))
    return True
