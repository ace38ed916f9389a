"""Choose what each thread does next, as executors and containers do, and how urgent that is."""

from __future__ import annotations

from heapq import heappush

from archgen.simulation.run_state import FIRST_FIRST, LAST_FIRST, RANDOM_ORDER
from archgen.simulation.simulation_run import SimulationRun

_LARGEST_KEY = 1 << 61


def choose_job(run: SimulationRun, thread: int) -> None:
    """Let an idle thread take its next job, if it has one, and queue the thread for a core."""
    threads, activities = run.threads, run.activities
    activity = _next_callback(run, thread) if threads.is_shared[thread] else threads.members[thread][0]
    if activity < 0 or not activities.pending[activity]:
        return
    if threads.pool[thread] >= 0 and not _enter_pool(run, thread):
        return
    threads.is_idle[thread] = False
    threads.current_activity[thread] = activity
    threads.time_left[thread] = -1
    processor = threads.processor[thread]
    run.sequence += 1
    priority = run.priority[activity]
    # The heap pops the smallest key first, and a larger priority is more urgent.
    urgency = _draw_urgency(run, activity, thread, processor) if priority is None else -1 - priority
    threads.urgency[thread], threads.ready_order[thread] = urgency, run.sequence
    heappush(threads.ready[processor], (urgency, run.sequence, thread))
    run.changed_processors.add(processor)


def _draw_urgency(run: SimulationRun, activity: int, thread: int, processor: int) -> int:
    """Return the urgency of a thread without a written priority: at least 0, so after all threads that have one."""
    scheduler = run.threads.scheduler[processor]
    if scheduler == FIRST_FIRST:
        return run.activities.pending[activity][0][0]
    if scheduler == LAST_FIRST:
        return _LARGEST_KEY - run.sequence
    return int(run.draw_share() * _LARGEST_KEY) if scheduler == RANDOM_ORDER else run.threads.rank[thread]


def _enter_pool(run: SimulationRun, thread: int) -> bool:
    """Take one of a container's threads, or wait for one; return whether one was free."""
    threads = run.threads
    pool = threads.pool[thread]
    if threads.free_count[pool]:
        threads.free_count[pool] -= 1
        return True
    if not threads.is_queued[thread]:
        threads.is_queued[thread] = True
        threads.pool_queue[pool].append(thread)
    return False


def leave_pool(run: SimulationRun, pool: int) -> None:
    """Return one of a container's threads to its pool, and wake the thread that has waited longest for one."""
    threads = run.threads
    threads.free_count[pool] += 1
    if threads.pool_queue[pool]:
        thread = threads.pool_queue[pool].popleft()
        threads.is_queued[thread] = False
        # `woken_threads` is a stack: at its bottom the thread comes after those that woke by themselves at this moment.
        run.woken_threads.insert(0, thread)


def _next_callback(run: SimulationRun, thread: int) -> int:
    """Choose the next callback as a ROS 2 single-threaded executor does: it serves all that it last saw ready."""
    activities, threads = run.activities, run.threads
    executor_round = threads.executor_round[thread]
    while executor_round:
        activity = executor_round.popleft()
        if activities.pending[activity]:
            return activity
    members = [activity for activity in threads.members[thread] if activities.pending[activity]]
    # The wait set of rclcpp lists timers before subscriptions.
    timers = [activity for activity in members if activities.period[activity]]
    executor_round.extend(timers)
    for activity in members:
        if not activities.period[activity]:
            # One turn for each subscription with data, not for each sample.
            executor_round.extend([activity] * len({wire for _, wire, _ in activities.pending[activity]}))
    return executor_round.popleft() if executor_round else -1
