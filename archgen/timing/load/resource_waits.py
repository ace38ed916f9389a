"""How long an activation waits for a GPU, or another resource that works on one use at a time, and uses it.

- In the order of arrival: when a use is asked for, each thread elsewhere has asked for at most one, and none that comes
  later goes before.
- In any order: while a use waits the resource is busy, so that it is done as soon as all uses of others are that can fall
  into that time. They are of activations that came in it, or up to their own response before.
- By priority, never preempted: of those in any order only the ones that are as urgent, and once the longest of the others.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from heapq import nlargest

from archgen.frozen import NamedTuple
from archgen.model.declared_timing import SchedulingOrder
from archgen.timing.figures.timing_values import UnknownCause, sum_fractions, unite_causes
from archgen.timing.load.busy_windows import (
    DemandFunction,
    DivergedError,
    SearchBudget,
    longest_busy_period,
    longest_wait_for_turn,
)
from archgen.timing.load.event_streams import EventStreams, max_arrivals
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.load.thread_work import DIVERGED_CAUSE, OVERLOAD_CAUSE, work_utilisation
from archgen.timing.system.timing_system import Activity, TimingSystem


class Competitor(NamedTuple):
    """Another activity that uses a resource: how long, how often, and how long before it may have been activated."""

    name: str
    worst: int
    streams: EventStreams
    response: int


def find_users(system: TimingSystem, resource_id: str) -> tuple[str, ...]:
    """Return the activities that use a resource again and again."""
    return tuple(
        activity.id
        for activity in system.activities.values()
        if resource_id in activity.uses and activity.behaviour != "once"
    )


def _look_up_users(state: PropagationState, resource_id: str) -> tuple[str, ...]:
    if resource_id not in state.resource_users:
        state.resource_users[resource_id] = find_users(state.system, resource_id)
    return state.resource_users[resource_id]


def find_use_times(state: PropagationState, name: str, budget: SearchBudget) -> int | UnknownCause:
    """Return how long an activation waits for all resources and uses them, and waits for the world outside, in ticks."""
    times = [find_use_time(state, name, resource_id, budget) for resource_id in state.system.activities[name].uses]
    causes = [time for time in times if isinstance(time, UnknownCause)]
    own_wait = state.system.activities[name].wait
    return (
        unite_causes(causes)
        if causes
        else sum((time for time in times if not isinstance(time, UnknownCause)), own_wait)
    )


def find_use_time(state: PropagationState, name: str, resource_id: str, budget: SearchBudget) -> int | UnknownCause:
    """Return how long an activation waits for a resource and uses it, in ticks, or why that is not bounded."""
    order = _find_order(state.system, resource_id)
    if find_load(state, resource_id) > 1:
        return OVERLOAD_CAUSE
    users = tuple([user for user in _look_up_users(state, resource_id) if state.event_models[user] != ()])
    if order == "fifo" and (resource_id, users) not in state.turn_times:
        state.turn_times[resource_id, users] = bound_in_turn(state.system, resource_id, users)
    in_turn = state.turn_times[resource_id, users].get(name) if order == "fifo" else None
    if in_turn is not None:
        return in_turn
    try:
        return _bound_by_arrivals(state, name, resource_id, budget)
    except DivergedError:
        return DIVERGED_CAUSE


def find_load(state: PropagationState, resource_id: str) -> Fraction:
    """Return the share of a resource that is used in the long run; what is not known of it counts as nothing."""
    users = _look_up_users(state, resource_id)
    models = tuple([state.event_models[user] for user in users])
    known_models, load = state.resource_loads.get(resource_id, ((), Fraction(0)))
    if known_models != models:
        loads = [
            work_utilisation(state.system.activities[user].uses[resource_id].worst, model)
            for user, model in zip(users, models, strict=True)
            if not isinstance(model, UnknownCause)
        ]
        load = sum_fractions(loads)
        state.resource_loads[resource_id] = models, load
    return load


def _find_order(system: TimingSystem, resource_id: str) -> SchedulingOrder | None:
    return system.resources[resource_id].order if resource_id in system.resources else None


def thread_key(activity: Activity) -> str:
    """Return what runs an activity: its executor, or itself."""
    return activity.executor or activity.id


def find_turn_times(system: TimingSystem) -> dict[str, int | None]:
    """Return how long each activation waits where each use comes in the order of arrival; None where one does not."""
    in_turn = {
        resource_id: bound_in_turn(system, resource_id, find_users(system, resource_id))
        if _find_order(system, resource_id) == "fifo"
        else {}
        for resource_id in dict.fromkeys(key for activity in system.activities.values() for key in activity.uses)
    }
    times_of = {
        activity.id: [activity.wait, *(in_turn[resource_id].get(activity.id) for resource_id in activity.uses)]
        for activity in system.activities.values()
        if activity.suspends
    }
    return {name: None if None in times else sum(each or 0 for each in times) for name, times in times_of.items()}


def bound_in_turn(system: TimingSystem, resource_id: str, users: Iterable[str]) -> dict[str, int | None]:
    """Return how long each use takes with one of each other thread before it; None where any number may ask at once."""
    processes: dict[str, dict[str | None, int]] = {}
    for user in users:
        activity = system.activities[user]
        groups = processes.setdefault(thread_key(activity), {})
        groups[_group_of(activity)] = max(groups.get(_group_of(activity), 0), activity.uses[resource_id].worst)
    times = {key: _sum_longest(groups, _count_threads(system, key)) for key, groups in processes.items()}
    boundless_keys = [key for key, time in times.items() if time is None]
    total = sum(time or 0 for time in times.values())
    bounds: dict[str, int | None] = {}
    for user in users:
        own = system.activities[user]
        key, group = thread_key(own), _group_of(own)
        threads = _count_threads(system, key)
        rest = {each: time for each, time in processes[key].items() if each != group or group is None}
        beside = _sum_longest(rest, None if threads is None else threads - 1)
        is_bounded = beside is not None and all(each == key for each in boundless_keys)
        own_time = own.uses[resource_id].worst
        bounds[user] = total - (times[key] or 0) + (beside or 0) + own_time if is_bounded else None
    return bounds


def _group_of(activity: Activity) -> str | None:
    """Return what an activity excludes: without executors itself."""
    return activity.callback_group if activity.executor else activity.id


def _sum_longest(groups: Mapping[str | None, int], threads: int | None) -> int | None:
    """Return how long the longest uses take that so many threads may ask for at once; None where any number may."""
    concurrent = [time for group, time in groups.items() if group is not None]
    if None in groups:
        if threads is None:
            return None
        concurrent += [groups[None]] * threads
    return sum(concurrent if threads is None else nlargest(threads, concurrent))


def _count_threads(system: TimingSystem, key: str) -> int | None:
    """Return the threads of an executor; None where there is one for each member."""
    return system.executors[key].threads if key in system.executors else 1


def _bound_by_arrivals(
    state: PropagationState, name: str, resource_id: str, budget: SearchBudget
) -> int | UnknownCause:
    """Return how long a use takes with all others before it that may come, or of those as urgent by priority."""
    rivals = find_rivals(state, (name,), resource_id)
    if isinstance(rivals, UnknownCause):
        return rivals
    own_use = state.system.activities[name].uses[resource_id].worst
    start = own_use + rivals.blocking
    if rivals.share >= 1:
        return DIVERGED_CAUSE
    demand = DemandFunction(lambda window: start + rivals.work_within(window), 2 * len(rivals.competitors))
    return (longest_busy_period if own_use else longest_wait_for_turn)(demand, budget, start)


class Rivals(NamedTuple):
    """What may use a resource while some activities wait for it, and the longest use that is less urgent (`blocking`)."""

    competitors: tuple[Competitor, ...]
    blocking: int

    @property
    def share(self) -> Fraction:
        """Return how much of the resource they take in the long run."""
        return sum_fractions(work_utilisation(each.worst, each.streams) for each in self.competitors)

    def work_within(self, window: int) -> int:
        """Return for how long they may use it in a window: of what came in it, or up to their response before."""
        return sum(
            [worst * max_arrivals(streams, window + response) for _, worst, streams, response in self.competitors]
        )


def find_rivals(state: PropagationState, own_ids: Sequence[str], resource_id: str) -> Rivals | UnknownCause:
    """Return what may use a resource before some activities that wait for it, or why that is not known."""
    system = state.system
    waiting = [activity for name in own_ids if resource_id in (activity := system.activities[name]).uses]
    by_priority = _find_order(system, resource_id) == "fixed_priority"
    lowest = min(map(_rank_priority, waiting), default=-1)
    waiting_keys = {thread_key(activity) for activity in waiting}
    competitors: list[Competitor] = []
    blocking = 0
    for user in _look_up_users(state, resource_id):
        other, model = system.activities[user], state.event_models[user]
        is_own = user in own_ids and not (len(own_ids) == 1 and other.executor and other.callback_group is None)
        is_mate = thread_key(other) in waiting_keys and all(_never_overlap(system, each, other) for each in waiting)
        if model == () or is_own or is_mate:
            continue
        worst = other.uses[resource_id].worst
        if by_priority and _rank_priority(other) < lowest:
            blocking = max(blocking, worst)
            continue
        response = state.work_ends.get(user, state.responses.get(user))
        if isinstance(model, UnknownCause):
            return model
        if response is None or response.value is None:
            return DIVERGED_CAUSE if response is None or not response.cause.missing else response.cause
        competitors.append(Competitor(user, worst, model, response.value))
    return Rivals(tuple(competitors), blocking)


def _rank_priority(activity: Activity) -> int:
    return -1 if activity.priority is None else activity.priority


def _never_overlap(system: TimingSystem, first: Activity, second: Activity) -> bool:
    """Whether two activities never run at the same time: one thread, or one callback group."""
    key = thread_key(first)
    if key != thread_key(second):
        return False
    is_same_group = first.callback_group is not None and first.callback_group == second.callback_group
    return is_same_group or _count_threads(system, key) == 1
