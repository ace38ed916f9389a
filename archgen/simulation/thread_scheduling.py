"""Choose what the threads of an executor do next, and how urgent that is on their host.

Threads use resources one at a time. Who waits for a resource keeps its thread and leaves its core.
"""

from __future__ import annotations

from heapq import heappop, heappush

from archgen.simulation.executor_state import (
    BY_DEADLINE,
    BY_PRIORITY,
    FAVOURED_OTHERS,
    FIRST_FIRST,
    FIXED_RANKS,
    LAST_FIRST,
    LEAST_SERVED,
    RANDOM_ORDER,
    TAKE_TURNS,
    WAIT_SET,
)
from archgen.simulation.simulation_plan import OUTSIDE
from archgen.simulation.simulation_run import JOB_END, SimulationRun

LARGEST_KEY = 1 << 61


def feed_threads(run: SimulationRun, executor: int) -> None:
    """Let the free threads of an executor take callbacks, as long as some are ready."""
    executors, callbacks, threads = run.executors, run.callbacks, run.threads
    while executors.free_count[executor] and executors.waiting_count[executor]:
        callback = executors.only_callback[executor]
        if callback < 0:
            callback = _next_callback(run, executor)
            if callback < 0:
                return
        executors.free_count[executor] -= 1
        callbacks.claim_count[callback] += 1
        callbacks.is_group_busy[callbacks.group[callback]] = True
        idle_threads = executors.idle_threads[executor]
        thread = idle_threads.pop() if idle_threads else threads.add_thread()
        activity = callbacks.activity[callback]
        threads.callback[thread] = callback
        threads.time_left[thread] = -1
        threads.processor[thread] = run.processors.of_activity[activity]
        threads.allowed_cores[thread] = run.processors.allowed_cores[activity]
        # The job that a thread has taken on is the oldest that no other thread has.
        threads.job_activation[thread] = callbacks.pending[callback][callbacks.claim_count[callback] - 1][0]
        queue_thread(run, thread)


def queue_thread(run: SimulationRun, thread: int) -> None:
    """Let a thread wait for a core."""
    threads, processors = run.threads, run.processors
    executors, executor = run.executors, run.callbacks.executor[threads.callback[thread]]
    if executors.is_serial[executor]:
        if executors.computing_thread[executor] not in (-1, thread):
            executors.held_threads[executor].append(thread)
            return
        executors.computing_thread[executor] = thread
    processor = threads.processor[thread]
    activity = run.callbacks.activity[threads.callback[thread]]
    run.sequence += 1
    priority = run.priority[activity]
    victim = processors.victim[processor]
    # The heap pops the smallest key first, and a larger priority is more urgent.
    if priority is not None and processors.uses_priority[processor]:
        urgency = -1 - priority
    else:
        scheduler = processors.scheduler[processor]
        if scheduler == LEAST_SERVED:
            threads.served[thread] = max(threads.served[thread], processors.least_served[processor])
        urgency = (
            threads.served[thread]
            if scheduler == LEAST_SERVED
            else draw_urgency(run, scheduler, activity, threads.job_activation[thread], victim)
        )
    order = run.sequence
    if victim == activity and processors.scheduler[processor] == FAVOURED_OTHERS:
        # Of equal priorities too it comes last.
        order += LARGEST_KEY
    threads.urgency[thread], threads.ready_order[thread] = urgency, order
    heappush(processors.ready[processor], (urgency, order, thread))
    if run.log is not None:
        run.log.enter_state(run, thread, "ready")
    run.changed_processors.add(processor)


def let_others_compute(run: SimulationRun, thread: int) -> None:
    """Let another thread of a process compute, where one does at a time and this one has stopped."""
    executors, executor = run.executors, run.callbacks.executor[run.threads.callback[thread]]
    if not executors.is_serial[executor]:
        return
    executors.computing_thread[executor] = -1
    held_threads = executors.held_threads[executor]
    if held_threads:
        queue_thread(run, held_threads.pop(int(run.draw_share() * len(held_threads))))


def draw_urgency(run: SimulationRun, order: int, activity: int, since: int, victim: int) -> int:
    """Return how urgent something is that waits since a moment, by an order without priorities: the smallest comes first,
    none is below 0. `victim` comes last where its neighbours are favoured.
    """
    if order == FIRST_FIRST:
        return since
    if order == LAST_FIRST:
        return LARGEST_KEY - run.sequence
    if order == RANDOM_ORDER:
        return int(run.draw_share() * LARGEST_KEY)
    if order == FIXED_RANKS:
        return run.processors.rank[activity]
    if order == BY_DEADLINE:
        deadline = run.plan.activities[activity].deadline
        return LARGEST_KEY if deadline is None else since + deadline
    return int(order == FAVOURED_OTHERS and activity == victim)


def _next_callback(run: SimulationRun, executor: int) -> int:
    """Choose the next callback of an executor; -1 for none."""
    callbacks, executors = run.callbacks, run.executors
    pending, members = callbacks.pending, executors.callbacks[executor]
    if not executors.excludes[executor]:
        # One thread: nothing else of this executor runs now.
        ready = [callback for callback in members if pending[callback]]
    else:
        ready = [
            callback
            for callback in members
            if len(pending[callback]) > callbacks.claim_count[callback]
            and (callbacks.group[callback] < 0 or not callbacks.is_group_busy[callbacks.group[callback]])
        ]
    order = executors.order[executor]
    if order == WAIT_SET:
        return _next_of_wait_set(run, executor, ready)
    if not ready:
        return -1
    if order == TAKE_TURNS:
        return _next_in_turn(run, executor, ready)
    if len(ready) == 1:
        return ready[0]
    return min(ready, key=lambda callback: _callback_key(run, executor, order, callback))


def _next_of_wait_set(run: SimulationRun, executor: int, ready: list[int]) -> int:
    """Choose as an executor of rclcpp does: it serves each callback that it last saw ready once, then looks again."""
    wait_set = run.executors.wait_set[executor]
    if not ready:
        return -1
    for callback in tuple(wait_set):
        if callback in ready:
            wait_set.remove(callback)
            return callback
    # What is left was served meanwhile, or belongs to a group that is busy: the new wait set is made without it.
    wait_set.clear()
    wait_set.extend(ready)
    return wait_set.popleft()


def _next_in_turn(run: SimulationRun, executor: int, ready: list[int]) -> int:
    """Choose the first ready callback after the one that was served last, going round."""
    last_turn = run.executors.last_turn[executor]
    chosen = next((callback for callback in sorted(ready) if callback > last_turn), min(ready))
    run.executors.last_turn[executor] = chosen
    return chosen


def _callback_key(run: SimulationRun, executor: int, order: int, callback: int) -> tuple[float, float]:
    """Return how urgent a ready callback is within its executor; the smallest comes first."""
    callbacks = run.callbacks
    job = callbacks.pending[callback][callbacks.claim_count[callback]]
    activity = callbacks.activity[callback]
    if order == LAST_FIRST:
        return (-job[3], 0)
    if order == RANDOM_ORDER:
        return (run.draw_share(), 0)
    if order == FIXED_RANKS:
        return (run.executors.ranks[callback], 0)
    if order == BY_PRIORITY:
        priority = run.priority[activity]
        return (1 if priority is None else -priority, job[3])
    if order == BY_DEADLINE:
        deadline = run.plan.activities[activity].deadline
        return (LARGEST_KEY if deadline is None else job[0] + deadline, job[3])
    return (int(order == FAVOURED_OTHERS and activity == run.executors.victim[executor]), job[3])


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
