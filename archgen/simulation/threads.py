"""Threads: what each does next, as executors and containers choose it, and how urgent that is."""

from __future__ import annotations

from heapq import heappush

from archgen.simulation.run import Run
from archgen.simulation.state import FIFO, LAST_FIRST, LOTTERY

_LATER = 1 << 61


def choose(run: Run, thread: int) -> None:
    """Let an idle thread take up its next job, if there is one, and queue for a core."""
    threads, steps = run.threads, run.steps
    at = _next(run, thread) if threads.shared[thread] else threads.members[thread][0]
    if at < 0 or not steps.pending[at]:
        return
    if threads.pool[thread] >= 0 and not _enter(run, thread):
        return
    threads.idle[thread] = False
    threads.current[thread] = at
    threads.left[thread] = -1
    processor = threads.processor[thread]
    run.sequence += 1
    priority = run.priority[at]
    key = _turn(run, at, thread, processor) if priority is None else -1 - priority
    threads.key[thread], threads.order[thread] = key, run.sequence
    heappush(threads.ready[processor], (key, run.sequence, thread))
    run.touched.add(processor)


def _turn(run: Run, at: int, thread: int, processor: int) -> int:
    """Give the place of a thread without a priority among its like; whoever has one comes first, below zero."""
    scheduler = run.threads.scheduler[processor]
    if scheduler == FIFO:
        return run.steps.pending[at][0][0]
    if scheduler == LAST_FIRST:
        return _LATER - run.sequence
    return int(run.random() * _LATER) if scheduler == LOTTERY else run.threads.rank[thread]


def _enter(run: Run, thread: int) -> bool:
    """Take one of a container's threads, or wait for one."""
    threads = run.threads
    pool = threads.pool[thread]
    if threads.free[pool]:
        threads.free[pool] -= 1
        return True
    if not threads.queued[thread]:
        threads.queued[thread] = True
        threads.queue[pool].append(thread)
    return False


def leave(run: Run, pool: int) -> None:
    """Give one of a container's threads to who waits longest for it."""
    threads = run.threads
    threads.free[pool] += 1
    if threads.queue[pool]:
        thread = threads.queue[pool].popleft()
        threads.queued[thread] = False
        run.awake.insert(0, thread)


def _next(run: Run, thread: int) -> int:
    """Choose a callback as a single-threaded executor does: it sees who is ready, and serves all of these first."""
    steps, threads = run.steps, run.threads
    turns = threads.round[thread]
    while turns:
        at = turns.popleft()
        if steps.pending[at]:
            return at
    members = [at for at in threads.members[thread] if steps.pending[at]]
    clocks = [at for at in members if steps.period[at]]
    turns.extend(clocks)
    for at in members:
        if not steps.period[at]:
            turns.extend([at] * len({wire for _, wire, _ in steps.pending[at]}))
    return turns.popleft() if turns else -1
