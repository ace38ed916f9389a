"""Response times in ns with their reasons, and the load of hosts against the bounds of Liu and Layland (1973)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from typing import Literal

from archgen.timing.analysis import EventPace, HostLoad, Reason, ResponseTime, RunResponse
from archgen.timing.figures.tick_unit import NS_PER_SECOND
from archgen.timing.figures.timing_values import ZERO_VALUE, TimingValue
from archgen.timing.figures.value_arithmetic import add_values, is_boundless, replace_figure, unknown_value
from archgen.timing.load.event_models import PropagationState
from archgen.timing.load.thread_work import WorstResponse
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.thread_pools import name_lane
from archgen.timing.system.timing_system import Activity, TimingSystem

_BILLION = 10**9
_LOG_2 = Fraction(693_147_180, _BILLION)
"""ln 2, the bound for any number of elements, rounded down."""
_MANY_TASKS = 64
_ONE_CORE_ONLY = TimingValue(None, assumptions=("one core only",))
HostVerdict = Literal["schedulable", "overload", "undecided", "unknown"]
_TIER_SENTENCES = {
    "declared": "declared as the worst case",
    "dedicated": "its own queue, on a core of its own",
    "host": "the longest time for which all work on {0} can keep it busy, in whatever order",
    "priorities": "everything of its priority or a higher one on {0}, over all activations of the busy period",
    "executor": "all work of its executor on {0}, in whatever order",
    "non_preemptive": "everything of its priority or a higher one on {0}, and the longest that may just have begun",
    "fifo": "all that may have come to {0} before it",
    "ros2_executor": "the round of its executor on {0} that is under way, and the one in which its turn comes",
    "edf": "all that may have an earlier deadline on {0}",
    "fixed_priority": "everything of its priority or a higher one on {0}",
    "round_robin": "the longest time for which all work on {0} can keep it busy, in whatever order",
    "cores": "its own work, and a share of all other work on the {1} cores of {0}",
    "unknown": "no execution time is written",
}
_OWN_CORE_SENTENCE = "its own work: {0} has no more threads than cores"
_OPEN_CORES_SENTENCE = "nobody wrote how many cores {0} has"


def build_response_times(state: PropagationState, resources: Iterable[ProcessingResource]) -> dict[str, ResponseTime]:
    """Return the best and worst response of every activity, in ns."""
    resource_of = {name: resource for resource in resources for name in resource.members}
    return {
        name: _build_response_time(state, name, state.responses[name], resource_of.get(name))
        for name in state.system.activities
    }


def _build_response_time(
    state: PropagationState, name: str, worst_response: WorstResponse, resource: ProcessingResource | None
) -> ResponseTime:
    """Return one activity's response, with the tier's sentence as its reason."""
    activity, tick = state.system.activities[name], state.system.tick
    best = unknown_value(name) if activity.bcet is None else TimingValue(activity.bcet * tick)
    sentence = _TIER_SENTENCES[worst_response.tier]
    if resource is not None and resource.undisturbed and worst_response.tier == "cores":
        sentence = _OWN_CORE_SENTENCE
    if resource is not None and worst_response.tier == "unknown" and activity.wcet is not None:
        sentence = _OPEN_CORES_SENTENCE
    sentence_arguments = (_cores_text(resource), resource.cores) if resource else ("", 1)
    span = activity.places.get("response" if worst_response.tier == "declared" else "wcet", activity.at)
    return ResponseTime(
        best,
        _worst_value(activity, worst_response, tick, resource),
        worst_response.tier,
        (Reason(sentence, span, sentence_arguments),),
    )


def build_run_responses(state: PropagationState, responses: Mapping[str, ResponseTime]) -> dict[str, RunResponse]:
    """Return how long runs take, for each activity to which one leads from another of its core."""
    runs: dict[str, RunResponse] = {}
    for name, ways in state.ways_to.items():
        delays = [way.delay for way in ways if way.delay is not None]
        arcs = state.run_arcs.get(name, ())
        if len(delays) == len(ways) and arcs and responses[name].tier != "declared":
            runs[name] = RunResponse(replace(responses[name].worst, value=max(delays) * state.system.tick), arcs)
    return runs


def build_storing_waits(state: PropagationState) -> dict[str, TimingValue]:
    """Return how long a message may wait to be stored while its reader is activated, in ns, by reader."""
    return {name: _build_storing_wait(state, name, wait) for name, wait in state.storing_waits.items()}


def _build_storing_wait(state: PropagationState, name: str, wait: WorstResponse) -> TimingValue:
    """Return one reader's wait, with what is missing; a declared response says that what it reads is stored in time."""
    if wait.value is not None:
        return TimingValue(wait.value * state.system.tick) if wait.value else ZERO_VALUE
    if state.responses[name].value is None:
        return ZERO_VALUE  # the response says what is missing: to say it twice makes it no worse
    if state.system.activities[name].response is not None:
        return TimingValue(Fraction(0), assumptions=(f"what {name} reads is stored in time",))
    missing = wait.cause.missing
    return TimingValue(None, not missing, missing, wait.cause.notes)


def _cores_text(resource: ProcessingResource | None) -> str:
    """Return the words for the cores whose work is counted."""
    if resource is None or not resource.joined:
        return resource.id if resource else ""
    return f"{resource.id} and on those that wait with it for a container's threads (one of them works while any waits)"


def _worst_value(
    activity: Activity, worst_response: WorstResponse, tick: Fraction, resource: ProcessingResource | None
) -> TimingValue:
    """Return the worst response with what it assumes, or what is missing."""
    notes = list(worst_response.cause.notes)
    if worst_response.tier == "declared":
        notes.append("assumed")
    elif resource is None:
        notes += ["assuming a dedicated core"] if activity.wcet is not None and activity.host is None else []
    else:
        notes += resource.assumptions
    assumptions = tuple(dict.fromkeys(notes))
    if worst_response.value is not None:
        return TimingValue(worst_response.value * tick, assumptions=assumptions)
    unknown_worst = TimingValue(None, not worst_response.cause.missing, worst_response.cause.missing, assumptions)
    if not worst_response.cause.missing or is_boundless(unknown_worst):
        return unknown_worst
    # Figures of others are missing: its own execution time is still a bound from below.
    own_work = None if activity.wcet is None else activity.wcet * tick
    return TimingValue(
        own_work, complete=False, missing=worst_response.cause.missing, assumptions=assumptions, side="at least"
    )


def find_host_loads(
    system: TimingSystem,
    resources: Iterable[ProcessingResource],
    paces: Mapping[str, EventPace],
    outputs: Mapping[tuple[str, str], EventPace],
    responses: Mapping[str, ResponseTime],
) -> dict[str, HostLoad]:
    """Return the load of every host, resource by resource."""
    shares = {
        name: _add_storing_share(system, name, activity_share(system, name, pace), outputs)
        for name, pace in paces.items()
        if name in system.activities
    }
    by_host: dict[str, list[ProcessingResource]] = {host: [] for host in system.cores}
    for resource in resources:
        if resource.host is not None:
            by_host.setdefault(resource.host, []).append(resource)
    return {
        host: _build_host_load(system, host, host_resources, shares, paces, responses)
        for host, host_resources in by_host.items()
    }


def activity_share(system: TimingSystem, name: str, pace: EventPace) -> TimingValue:
    """Return the share of a core that an activity takes."""
    activity = system.activities[name]
    if activity.behaviour == "once" or pace.rate.value == 0 or activity.wcet == 0:
        return TimingValue(Fraction(0))
    if activity.wcet is None:
        return unknown_value(name)
    if pace.rate.value is None:
        return pace.rate
    # One Fraction from four integers: each product of two Fractions would be reduced to lowest terms on its own.
    (rate_numerator, rate_denominator), (tick_numerator, tick_denominator) = (
        pace.rate.value.as_integer_ratio(),
        system.tick.as_integer_ratio(),
    )
    return replace_figure(
        pace.rate,
        Fraction(rate_numerator * activity.wcet * tick_numerator, rate_denominator * tick_denominator * NS_PER_SECOND),
    )


def _add_storing_share(
    system: TimingSystem, name: str, share: TimingValue, outputs: Mapping[tuple[str, str], EventPace]
) -> TimingValue:
    """Return the share of a core that an activity takes, with the callbacks that store its inputs."""
    storing = system.activities[name].storing
    if not any(callback.wcet for callback in storing.values()):
        return share
    storing_shares = [
        replace_figure(pace.rate, pace.rate.value * storing[arc.input].wcet * system.tick / NS_PER_SECOND)
        if (pace := outputs[arc.source, arc.output]).rate.value is not None
        else pace.rate
        for arc in system.arcs_into.get(name, ())
        if arc.role == "data" and arc.input in storing and storing[arc.input].wcet
    ]
    return add_values((share, *storing_shares))


def _build_host_load(
    system: TimingSystem,
    host: str,
    host_resources: list[ProcessingResource],
    share_of: Mapping[str, TimingValue],
    paces: Mapping[str, EventPace],
    responses: Mapping[str, ResponseTime],
) -> HostLoad:
    """Return the load of one host."""
    shares = {name: share_of[name] for resource in host_resources for name in resource.members}
    loads = tuple(
        (resource.id, resource.cores, add_values(shares[name] for name in resource.members))
        for resource in host_resources
        if not resource.missing
    )
    is_open = any(resource.missing for resource in host_resources)
    # Of one thread, or of threads that are all pinned, it does not matter how many cores there are.
    cores = None if is_open else system.cores.get(host) or sum(count for _, count, _ in loads) or None
    verdict = _judge_host(system, loads, tuple(shares), paces, responses)
    # Elements that add nothing to the load are no tasks in the sense of the bound, which falls with their number.
    working = sum(1 for utilisation in shares.values() if utilisation.value != 0)
    return HostLoad(
        utilisation=add_values(shares.values()),
        cores=cores,
        rate_monotonic_bound=TimingValue(rate_monotonic_bound(working)) if cores == 1 else _ONE_CORE_ONLY,
        verdict="unknown" if is_open and verdict != "overload" else verdict,
        activity_shares=tuple(shares.items()),
        core_loads=loads,
        earliest_deadline_bound=TimingValue(Fraction(1)) if cores == 1 else _ONE_CORE_ONLY,
    )


def _judge_host(
    system: TimingSystem,
    loads: tuple[tuple[str, int, TimingValue], ...],
    members: tuple[str, ...],
    paces: Mapping[str, EventPace],
    responses: Mapping[str, ResponseTime],
) -> HostVerdict:
    """Judge a host: overloaded, schedulable, undecided, or unknown."""
    if any(_exceeds_cores(load, cores) for _, cores, load in loads):
        return "overload"
    # The order matters. A load that is exactly full is bearable only where each response is proven to be within its
    # period; where a figure is missing nothing can be proven, so full counts as overload.
    is_full = any(load.value == cores for _, cores, load in loads)
    if any(not load.complete or load.value is None for _, _, load in loads):
        return "overload" if is_full else "unknown"
    if all(_is_done_in_time(system, name, paces[name], responses[name]) for name in members):
        return "schedulable"
    if is_full:
        return "overload"
    one_core = len(loads) == 1 and loads[0][1] == 1
    return "schedulable" if one_core and _fits_rate_monotonic(system, members, loads[0][2], paces) else "undecided"


def _exceeds_cores(load: TimingValue, cores: int) -> bool:
    """Whether a load is unbounded or above the number of cores."""
    is_unbounded = load.value is None and load.complete
    return is_unbounded or (load.value is not None and load.value > cores)


def _fits_rate_monotonic(
    system: TimingSystem, members: Iterable[str], load: TimingValue, paces: Mapping[str, EventPace]
) -> bool:
    """Whether priorities by rate are sure to do, and nobody wrote others.

    Jitter is not in Liu and Layland's bound: with it nothing is sure.
    """
    working_activities = [
        system.activities[name] for name in members if paces[name].rate.value and system.activities[name].wcet
    ]
    if any(paces[activity.id].jitter != ZERO_VALUE for activity in working_activities):
        return False
    # Nor is a thread of several, who do not preempt one another, another order, or a deadline before the next activation.
    lanes = {name_lane(system, activity) for activity in working_activities}
    is_plain = len(lanes) == len(working_activities) and all(
        activity.deadline is None or (activity.period is not None and activity.deadline >= activity.period)
        for activity in working_activities
    )
    orders = {system.host_orders.get(activity.host or "") for activity in working_activities}
    orders |= {order for (host, _), order in system.core_orders.items() if host in {a.host for a in working_activities}}
    if not is_plain or not orders <= {None, "fixed_priority"}:
        return False
    by_rate = sorted(working_activities, key=lambda activity: -(paces[activity.id].rate.value or 0))
    priorities = [activity.priority for activity in by_rate]
    is_by_rate = all(
        priority is not None and next_priority is not None and priority > next_priority
        for priority, next_priority in pairwise(priorities)
    )
    return (is_by_rate or not any(priority is not None for priority in priorities)) and is_below_rate_bound(
        load.value or Fraction(0), len(working_activities)
    )


def _is_done_in_time(system: TimingSystem, name: str, pace: EventPace, response: ResponseTime) -> bool:
    """Whether an activity is done by its deadline; before it is activated again, where none is written."""
    if pace.rate.value == 0:
        return True
    if response.worst.value is None or not response.worst.complete or not pace.rate.value:
        return False
    deadline = system.activities[name].deadline
    if deadline is not None:
        return response.worst.value <= deadline * system.tick
    (worst_numerator, worst_denominator), (rate_numerator, rate_denominator) = (
        response.worst.value.as_integer_ratio(),
        pace.rate.value.as_integer_ratio(),
    )
    # R <= 1 / rate, multiplied out.
    return worst_numerator * rate_numerator <= NS_PER_SECOND * worst_denominator * rate_denominator


@lru_cache(_MANY_TASKS)
def rate_monotonic_bound(task_count: int) -> Fraction:
    """Return n (2^(1/n) - 1), rounded down to nine decimals (ln 2 beyond 64 elements)."""
    if task_count > _MANY_TASKS:
        return _LOG_2
    if task_count < 1:
        return Fraction(1)
    # The n-th root by bisection in integers: no float, and surely rounded down.
    low, high = _BILLION, 2 * _BILLION
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if middle**task_count <= 2 * _BILLION**task_count else (low, middle)
    return Fraction(task_count * (low - _BILLION), _BILLION) if task_count > 1 else Fraction(1)


def is_below_rate_bound(utilisation: Fraction, task_count: int) -> bool:
    """Whether a utilisation is within the exact bound: U <= n (2^(1/n) - 1) where (1 + U/n)^n <= 2."""
    # ln 2 is below the bound for every n: stricter than need be, and without powers of large fractions.
    if task_count > _MANY_TASKS:
        return utilisation <= _LOG_2
    return task_count == 0 or (1 + utilisation / task_count) ** task_count <= 2  # noqa: PLR2004
