"""Let threads use resources, one at a time. Who waits for a resource keeps its thread and leaves its core."""

from __future__ import annotations

from heapq import heappop, heappush

from archgen.simulation.executor_state import BY_PRIORITY
from archgen.simulation.simulation_plan import OUTSIDE
from archgen.simulation.simulation_run import JOB_END, SimulationRun
from archgen.simulation.thread_scheduling import draw_urgency, queue_thread


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
    if resource == OUTSIDE:
        _wait_outside(run, now, thread, use_time)
        return
    run.sequence += 1
    activity, order = run.callbacks.activity[run.threads.callback[thread]], run.resources.order[resource]
    if order == BY_PRIORITY:
        priority = run.priority[activity]
        urgency = 0 if priority is None else -1 - priority
    else:
        urgency = draw_urgency(run, order, activity, now, run.resources.victim[resource])
    heappush(run.resources.queue[resource], (urgency, run.sequence, thread, use_time))
    run.changed_resources.add(resource)
    if run.log is not None:
        run.log.enter_state(run, thread, "awaits", resource)


def _wait_outside(run: SimulationRun, now: int, thread: int, wait_time: int) -> None:
    """Let a thread wait for the world outside, no longer than the declared response allows."""
    activity = run.callbacks.activity[run.threads.callback[thread]]
    end = run.threads.job_activation[thread] + (run.activities.declared_response[activity] or 0)
    wait_end = max(min(now + wait_time, end - run.threads.time_left[thread]), now)
    subject = -1 - len(run.plan.activities) - len(run.plan.resources) - thread
    heappush(run.heap, (wait_end << 2 | JOB_END, subject, 0))


def grant_resource(run: SimulationRun, now: int, resource: int) -> None:
    """Give an idle resource to the most urgent of those that wait for it."""
    queue = run.resources.queue[resource]
    if queue and run.resources.user[resource] < 0:
        _, _, thread, use_time = heappop(queue)
        run.resources.user[resource] = thread
        if run.log is not None:
            run.log.enter_state(run, thread, "uses", resource)
        heappush(run.heap, (now + use_time << 2 | JOB_END, -1 - len(run.plan.activities) - resource, 0))


def leave_resource(run: SimulationRun, resource: int) -> None:
    """End a use, or a wait outside: the thread goes on with the rest of its job as soon as it has a core."""
    if resource >= len(run.plan.resources):
        queue_thread(run, resource - len(run.plan.resources))
        return
    queue_thread(run, run.resources.user[resource])
    run.resources.user[resource] = -1
    run.changed_resources.add(resource)
