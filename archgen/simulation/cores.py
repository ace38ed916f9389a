"""Cores: which threads have one at a moment, and who must leave for somebody more urgent."""

from __future__ import annotations

from heapq import heappop, heappush

from archgen.simulation.firing import read
from archgen.simulation.run import END, LOAD, Run
from archgen.simulation.state import RANKS
from archgen.simulation.threads import choose


def dispatch(run: Run, now: int) -> None:
    """Choose what each thread does next, and give threads to cores."""
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
    """Give cores to threads some of which must have a certain one, the most urgent first."""
    threads = run.threads
    running = threads.running[processor]
    wanted = sorted(threads.ready[processor])
    if threads.preemptive[processor]:
        wanted = sorted([*wanted, *((threads.key[t], threads.order[t], t) for t in running)])
        taken: dict[int, int] = {}
    else:
        taken = {threads.core[t]: t for t in running}
    for _, _, thread in wanted:
        pin, last = threads.affinity[thread], threads.core[thread]
        cores = [pin] if pin >= 0 else [*([last] if thread in running else []), *range(threads.cores[processor])]
        core = next((one for one in cores if one not in taken), None)
        if core is not None:
            taken[core] = thread
    _move(run, now, processor, taken)


def _move(run: Run, now: int, processor: int, taken: dict[int, int]) -> None:
    """Take threads off their cores that lost them, and start those that got one."""
    threads = run.threads
    running, ready = threads.running[processor], threads.ready[processor]
    for thread in [t for t in running if t not in taken.values()]:
        running.remove(thread)
        threads.version[thread] += 1
        threads.left[thread] = threads.until[thread] - now
        ready.append((threads.key[thread], threads.order[thread], thread))
    for core, thread in taken.items():
        threads.core[thread] = core
        if thread not in running:
            ready.remove((threads.key[thread], threads.order[thread], thread))
            _start(run, now, thread, running)


def _start(run: Run, now: int, thread: int, running: list[int]) -> None:
    threads, steps = run.threads, run.steps
    left = threads.left[thread]
    if left < 0:
        at = threads.current[thread]
        job = steps.pending[at].popleft()
        wire = job[1]
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
    """Take the least urgent running thread off its core, if a more urgent one waits."""
    threads = run.threads
    last = max(running, key=lambda t: (threads.key[t], threads.order[t]))
    key = ready[0][0]
    if key >= threads.key[last] or (key >= 0 and threads.scheduler[threads.processor[last]] != RANKS):
        return False
    running.remove(last)
    threads.version[last] += 1
    threads.left[last] = threads.until[last] - now
    heappush(ready, (threads.key[last], threads.order[last], last))
    return True
