"""Dispatch threads to cores, and preempt the less urgent ones.

A smaller urgency key is more urgent; ties are broken by the order in which threads became ready.
"""

from __future__ import annotations

from heapq import heappop, heappush

from archgen.simulation.firing import read
from archgen.simulation.run import END, LOAD, Run
from archgen.simulation.state import RANKS
from archgen.simulation.threads import choose


def dispatch(run: Run, now: int) -> None:
    """Choose the next job of each woken thread, then give out the cores of every changed processor."""
    threads = run.threads
    while run.awake:
        thread = run.awake.pop()
        if threads.idle[thread]:
            choose(run, thread)
    while run.touched:
        processor = run.touched.pop()
        ready, running = threads.ready[processor], threads.running[processor]
        if threads.mixed[processor]:
            _assign(run, now, processor)
            continue
        while ready:
            if len(running) < threads.cores[processor]:
                _start(run, now, heappop(ready)[2], running)
            elif not threads.preemptive[processor] or not _preempt(run, now, ready, running):
                break


def _assign(run: Run, now: int, processor: int) -> None:
    """Assign cores where some threads are pinned and others are not, the most urgent first."""
    threads = run.threads
    running = threads.running[processor]
    wanted = sorted(threads.ready[processor])
    # Preemptive: all cores are given out anew, running threads included. Otherwise running threads keep theirs.
    if threads.preemptive[processor]:
        wanted = sorted([*wanted, *((threads.key[t], threads.order[t], t) for t in running)])
        taken: dict[int, int] = {}
    else:
        taken = {threads.core[t]: t for t in running}
    for _, _, thread in wanted:
        pin, last = threads.affinity[thread], threads.core[thread]
        # An unpinned thread that is running prefers the core it has, so that it is not moved without need.
        cores = [pin] if pin >= 0 else [*([last] if thread in running else []), *range(threads.cores[processor])]
        core = next((one for one in cores if one not in taken), None)
        if core is not None:
            taken[core] = thread
    _move(run, now, processor, taken)


def _move(run: Run, now: int, processor: int, taken: dict[int, int]) -> None:
    """Take threads that lost their core off it, and start those that got one."""
    threads = run.threads
    running, ready = threads.running[processor], threads.ready[processor]
    for thread in [t for t in running if t not in taken.values()]:
        running.remove(thread)
        # The job's end is already on the heap: the new version makes `end_thread` ignore it.
        threads.version[thread] += 1
        threads.left[thread] = threads.until[thread] - now
        ready.append((threads.key[thread], threads.order[thread], thread))
    for core, thread in taken.items():
        threads.core[thread] = core
        if thread not in running:
            ready.remove((threads.key[thread], threads.order[thread], thread))
            _start(run, now, thread, running)


def _start(run: Run, now: int, thread: int, running: list[int]) -> None:
    """Start or resume a thread at time `now`, and schedule the end of its job."""
    threads, steps = run.threads, run.steps
    left = threads.left[thread]
    # -1: the job has not started yet. A preempted thread comes back with the time that it has left.
    if left < 0:
        at = threads.current[thread]
        job = steps.pending[at].popleft()
        wire = job[1]
        # Calls are not counted in a queue: they never replace one another.
        if wire >= 0 and not run.wires.request[wire]:
            run.wires.waiting[run.wires.queue[wire]] -= 1
        steps.acted[at] = job[0]
        steps.request[at] = wire
        if wire != LOAD:
            read(run, now, at, job)
        spread = steps.spread[at]
        left = run.between(at, steps.shortest[at], spread) if spread else steps.shortest[at]
        run.threads.busy[threads.processor[thread]] += left
        threads.left[thread] = left
    running.append(thread)
    threads.until[thread] = now + left
    heappush(run.heap, (now + left << 2 | END, thread, threads.version[thread]))


def _preempt(run: Run, now: int, ready: list[tuple[int, int, int]], running: list[int]) -> bool:
    """Take the least urgent running thread off its core if a more urgent one is ready; return whether it did."""
    threads = run.threads
    last = max(running, key=lambda t: (threads.key[t], threads.order[t]))
    key = ready[0][0]
    # Keys below zero are written priorities, which always preempt. Other threads preempt only under fixed ranks.
    if key >= threads.key[last] or (key >= 0 and threads.scheduler[threads.processor[last]] != RANKS):
        return False
    running.remove(last)
    threads.version[last] += 1
    threads.left[last] = threads.until[last] - now
    heappush(ready, (threads.key[last], threads.order[last], last))
    return True
