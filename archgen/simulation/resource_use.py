"""Let threads use resources, one at a time. Who waits for a resource keeps its thread and leaves its core."""

from __future__ import annotations

from heapq import heappop, heappush

from archgen.simulation.executor_state import (
    BY_DEADLINE,
    BY_PRIORITY,
    FAVOURED_OTHERS,
    FIXED_RANKS,
    LAST_FIRST,
    RANDOM_ORDER,
)
from archgen.simulation.simulation_run import JOB_END, SimulationRun
from archgen.simulation.thread_scheduling import queue_thread

_LARGEST_KEY = 1 << 61


def plan_steps(run: SimulationRun, thread: int, activity: int, execution_time: int) -> int:
    """Divide the execution time of a job at random between the resources that it uses; return the part before the first."""
    uses = run.resources.uses[activity]
    cuts = sorted(int(run.draw_share() * (execution_time + 1)) for _ in uses)
    ends = [*cuts[1:], execution_time]
    steps = [
        (resource, run.draw_time(activity, shortest, longest - shortest), end - cut)
        for (resource, shortest, longest), cut, end in zip(uses, cuts, ends, strict=True)
    ]
    run.threads.later_steps[thread] = steps[::-1]
    return cuts[0]


def enter_resource(run: SimulationRun, now: int, thread: int) -> None:
    """Let a thread wait for the resource that comes next in its job."""
    resource, use_time, run.threads.time_left[thread] = run.threads.later_steps[thread].pop()
    run.sequence += 1
    heappush(run.resources.queue[resource], (_draw_urgency(run, now, thread, resource), run.sequence, thread, use_time))
    run.changed_resources.add(resource)


def grant_resource(run: SimulationRun, now: int, resource: int) -> None:
    """Give an idle resource to the most urgent of those that wait for it."""
    queue = run.resources.queue[resource]
    if queue and run.resources.user[resource] < 0:
        _, _, thread, use_time = heappop(queue)
        run.resources.user[resource] = thread
        heappush(run.heap, (now + use_time << 2 | JOB_END, -1 - len(run.plan.activities) - resource, 0))


def leave_resource(run: SimulationRun, resource: int) -> None:
    """End a use: the thread goes on with the rest of its job as soon as it has a core."""
    queue_thread(run, run.resources.user[resource])
    run.resources.user[resource] = -1
    run.changed_resources.add(resource)


def _draw_urgency(run: SimulationRun, now: int, thread: int, resource: int) -> int:
    """Return how urgent a use is; the smallest comes first."""
    order, activity = run.resources.order[resource], run.callbacks.activity[run.threads.callback[thread]]
    planned = run.plan.activities[activity]
    if order == BY_PRIORITY:
        return 0 if planned.priority is None else -1 - planned.priority
    if order == BY_DEADLINE:
        return _LARGEST_KEY if planned.deadline is None else run.threads.job_activation[thread] + planned.deadline
    if order == LAST_FIRST:
        return -run.sequence
    if order == RANDOM_ORDER:
        return int(run.draw_share() * _LARGEST_KEY)
    if order == FIXED_RANKS:
        return run.processors.rank[activity]
    return now + (_LARGEST_KEY if order == FAVOURED_OTHERS and activity == run.resources.victim[resource] else 0)
