"""Choose what each thread does next, as executors and containers do, and how urgent that is."""

from __future__ import annotations

from heapq import heappush

from archgen.simulation.run import Run
from archgen.simulation.state import FIFO, LAST_FIRST, LOTTERY

_LATER = 1 << 61


def choose(run: Run, thread: int) -> None:
    """Let an idle thread take its next job, if it has one, and queue the thread for a core."""
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
    # The heap pops the smallest key first, and a larger priority is more urgent.
    key = _turn(run, at, thread, processor) if priority is None else -1 - priority
    threads.key[thread], threads.order[thread] = key, run.sequence
    heappush(threads.ready[processor], (key, run.sequence, thread))
    run.touched.add(processor)


def _turn(run: Run, at: int, thread: int, processor: int) -> int:
    """Return the urgency of a thread without a written priority: at least 0, so after all threads that have one."""
    scheduler = run.threads.scheduler[processor]
    if scheduler == FIFO:
        return run.steps.pending[at][0][0]
    if scheduler == LAST_FIRST:
        return _LATER - run.sequence
    return int(run.random() * _LATER) if scheduler == LOTTERY else run.threads.rank[thread]


def _enter(run: Run, thread: int) -> bool:
    """Take one of a container's threads, or wait for one; return whether one was free."""
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
    """Return one of a container's threads to its pool, and wake the thread that has waited longest for one."""
    threads = run.threads
    threads.free[pool] += 1
    if threads.queue[pool]:
        thread = threads.queue[pool].popleft()
        threads.queued[thread] = False
        # `woken_threads` is a stack: at its bottom the thread comes after those that woke by themselves at this moment.
        run.awake.insert(0, thread)


def _next(run: Run, thread: int) -> int:
    """Choose the next callback as a ROS 2 single-threaded executor does: it serves all that it last saw ready."""
    steps, threads = run.steps, run.threads
    turns = threads.round[thread]
    while turns:
        at = turns.popleft()
        if steps.pending[at]:
            return at
    members = [at for at in threads.members[thread] if steps.pending[at]]
    # The wait set of rclcpp lists timers before subscriptions.
    clocks = [at for at in members if steps.period[at]]
    turns.extend(clocks)
    for at in members:
        if not steps.period[at]:
            # One turn for each subscription with data, not for each sample.
            turns.extend([at] * len({wire for _, wire, _ in steps.pending[at]}))
    return turns.popleft() if turns else -1
