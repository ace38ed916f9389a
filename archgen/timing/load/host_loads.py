"""Response times in ns with their reasons, and the load of hosts against the bounds of Liu and Layland (1973).

The load of GPUs and other resources that work on one use at a time, and how long each use waits and takes.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Literal

from archgen.frozen import replace
from archgen.timing.analysis import EventPace, HostLoad, Reason, ResourceLoad, ResponseTime, RunResponse
from archgen.timing.figures.figure_wording import format_share
from archgen.timing.figures.tick_unit import NS_PER_SECOND
from archgen.timing.figures.timing_values import (
    ZERO_VALUE,
    TimingValue,
    UnknownCause,
    add_values,
    is_boundless,
    multiply_value,
    replace_figure,
    unknown_value,
    value_of_cause,
)
from archgen.timing.load.busy_windows import SearchBudget
from archgen.timing.load.host_verdicts import HostJudge, rate_monotonic_bound
from archgen.timing.load.level_cascades import EntryWay
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.load.resource_waits import find_use_time, find_users
from archgen.timing.load.thread_work import WorstResponse
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.timing_system import Activity, Arc, TimingSystem, best_response


def find_resource_loads(state: PropagationState, paces: Mapping[str, EventPace]) -> dict[str, ResourceLoad]:
    """Return the load of each resource that is declared or used."""
    system = state.system
    resource_ids = dict.fromkeys(
        (*system.resources, *(key for activity in system.activities.values() for key in activity.uses))
    )
    budget = SearchBudget()
    notes = list_turn_notes(system)
    return {key: _build_load(state, paces, key, budget, (notes[key],) if key in notes else ()) for key in resource_ids}


def _build_load(
    state: PropagationState,
    paces: Mapping[str, EventPace],
    resource_id: str,
    budget: SearchBudget,
    notes: tuple[str, ...],
) -> ResourceLoad:
    system = state.system
    resource = system.resources.get(resource_id)
    users = find_users(system, resource_id)
    shares = {name: _find_share(system, system.activities[name], resource_id, paces[name]) for name in users}
    utilisation = add_values(shares.values())
    return ResourceLoad(
        resource.host if resource else None,
        resource.order if resource else None,
        utilisation,
        _judge_load(utilisation),
        tuple(shares.items()),
        {name: _find_wait(state, name, resource_id, budget, notes) for name in users},
    )


def list_turn_notes(system: TimingSystem) -> dict[str, str]:
    """Return what waits for each resource assume that several use, and of which nobody wrote the order."""
    user_counts = Counter(key for activity in system.activities.values() for key in activity.uses)
    return {
        each.id: f"{each.id} serves whoever came first"
        for each in system.resources.values()
        if each.is_order_assumed and user_counts[each.id] > 1
    }


def _find_share(system: TimingSystem, activity: Activity, resource_id: str, pace: EventPace) -> TimingValue:
    if pace.rate.value is None:
        return pace.rate
    use_time = activity.uses[resource_id].worst * system.tick
    return multiply_value(pace.rate, Fraction(use_time / NS_PER_SECOND))


def _judge_load(utilisation: TimingValue) -> Literal["bearable", "overload", "unknown"]:
    is_unbounded = utilisation.value is None and utilisation.complete
    if is_unbounded or (utilisation.value is not None and utilisation.value > 1):
        return "overload"
    return "unknown" if utilisation.value is None or not utilisation.complete else "bearable"


def _find_wait(
    state: PropagationState, name: str, resource_id: str, budget: SearchBudget, notes: tuple[str, ...]
) -> TimingValue:
    """Return the longest time from asking for a resource until being done with it, in ns; `notes` are what it assumes.

    Waiting is within the activation: where no bound of its own is found, that of the response less its execution time holds.
    """
    activity, tick = state.system.activities[name], state.system.tick
    time = find_use_time(state, name, resource_id, budget)
    response = state.responses[name]
    limit = None if response.value is None or activity.response is not None else response.value - (activity.bcet or 0)
    if isinstance(time, UnknownCause):
        return value_of_cause(time) if limit is None else TimingValue(limit * tick, assumptions=notes)
    return TimingValue((time if limit is None else min(time, limit)) * tick, assumptions=notes)


def explain_waits(load_of: Mapping[str, ResourceLoad], activity: Activity, tick: Fraction) -> tuple[Reason, ...]:
    """Return the reasons that the waits of an activity are: one for each resource, and one for what it waits beside that."""
    reasons: list[Reason] = []
    for resource_id, use in activity.uses.items():
        span = activity.places.get(f"uses {resource_id}", activity.places.get("uses", activity.at))
        wait = load_of[resource_id].waits.get(activity.id) if resource_id in load_of else None
        own = Fraction(use.worst * tick)
        if wait is None or wait.value is None:
            reasons.append(Reason("uses {0} for {1}, and waits for it besides", span, (resource_id, own)))
        else:
            rivals = [name for name, _ in load_of[resource_id].shares if name != activity.id]
            others = f", which {', '.join(rivals)} {'use' if len(rivals) > 1 else 'uses'} too" if rivals else ""
            reasons.append(
                Reason(
                    "waits for {0}{3}, and uses it for {1}: {2} at most", span, (resource_id, own, wait.value, others)
                )
            )
    if activity.wait:
        span, own_wait = activity.places.get("response", activity.at), Fraction(activity.wait * tick)
        reasons.append(
            Reason("waits for {0} in its callback, as its `response` says, and keeps its thread", span, (own_wait,))
        )
    return tuple(reasons)


_ONE_CORE_ONLY = TimingValue(None, assumptions=("one core only",))
_TIER_SENTENCES = {
    "declared": "declared as the worst case",
    "dedicated": "its own queue, on a core of its own",
    "host": "the longest time for which all work on {0} can keep it busy, in whatever order",
    "priorities": "everything of its priority or a higher one on {0}, over all activations of the busy period",
    "fair": "all work of its own thread, and of each other one on {0} no more than that and {2}",
    "executor": "all work of its executor on {0}, in whatever order",
    "non_preemptive": "everything of its priority or a higher one on {0}, and the longest that may just have begun",
    "fifo": "all that may have come to {0} before it",
    "ros2_executor": "the round of its executor on {0} that is under way, and the one in which its turn comes",
    "edf": "all that may have an earlier deadline on {0}",
    "cores": "all work of its own thread, and a share of all other work on the {1} cores of {0}",
    "whole host": "the longest time for which all work on {0} can keep one core busy (while anything waits there, one works)",
    "whole way": "its ways from the event on as wholes: own work, links, and what can hold up one event on all hosts there",
    "unknown": "no execution time is written",
}
_OWN_CORE_SENTENCE = "its own work: {0} has no more threads than cores"
_SHARED_SENTENCE = "other programs take {1} of each core of {0}: all execution times are that much longer there"
_OPEN_CORES_SENTENCE = "nobody wrote how many cores {0} has"


def build_response_times(state: PropagationState, resources: Iterable[ProcessingResource]) -> dict[str, ResponseTime]:
    """Return the best and worst response of every activity, in ns."""
    resource_of = {name: resource for resource in resources for name in resource.members}
    turn_notes = list_turn_notes(state.system)
    responses: dict[str, ResponseTime] = {}
    for name, activity in state.system.activities.items():
        response = _build_response_time(state, name, state.responses[name], resource_of.get(name))
        notes = [turn_notes[key] for key in activity.uses if key in turn_notes and response.tier != "declared"]
        worst = replace(response.worst, assumptions=(*response.worst.assumptions, *notes))
        responses[name] = replace(response, worst=worst) if notes else response
    return responses


def _build_response_time(
    state: PropagationState, name: str, worst_response: WorstResponse, resource: ProcessingResource | None
) -> ResponseTime:
    """Return one activity's response, with the tier's sentence as its reason."""
    activity, tick = state.system.activities[name], state.system.tick
    best = unknown_value(name) if activity.bcet is None else TimingValue(best_response(activity) * tick)
    sentence = _TIER_SENTENCES[worst_response.tier]
    if resource is not None and resource.undisturbed and worst_response.tier == "cores":
        sentence = _OWN_CORE_SENTENCE
    if resource is not None and worst_response.tier == "unknown" and activity.wcet is not None:
        sentence = _OPEN_CORES_SENTENCE
    sentence_arguments: tuple[str | int, ...] = (_cores_text(resource), resource.cores) if resource else ("", 1)
    if worst_response.tier == "whole host":
        sentence_arguments = (activity.host or "", 1)
    if share := state.system.fair_shares.get(activity.host or ""):
        sentence_arguments = (*sentence_arguments, share.figures)
    span = activity.places.get("response" if worst_response.tier == "declared" else "wcet", activity.at)
    reasons = [Reason(sentence, span, sentence_arguments)]
    if share and share.other_load:
        reasons.append(Reason(_SHARED_SENTENCE, span, (activity.host or "", format_share(share.other_load))))
    return ResponseTime(
        best,
        _worst_value(state.system, activity, worst_response, resource),
        worst_response.tier,
        tuple(reasons),
    )


def build_run_responses(
    state: PropagationState,
    responses: Mapping[str, ResponseTime],
    ways_to: Mapping[str, tuple[EntryWay, ...]],
    run_arcs: Mapping[str, tuple[Arc, ...]],
) -> dict[str, RunResponse]:
    """Return how long runs take, for each activity to which one leads from another of its core, or of another."""
    runs: dict[str, RunResponse] = {}
    for name, ways in ways_to.items():
        delays = [way.delay for way in ways if way.delay is not None]
        arcs = run_arcs.get(name, ())
        if len(delays) == len(ways) and arcs and responses[name].tier != "declared":
            step_notes = (note for way in ways for step in way.steps for note in responses[step].worst.assumptions)
            worst = responses[name].worst
            notes = tuple(dict.fromkeys((*worst.assumptions, *step_notes)))
            runs[name] = RunResponse(replace(worst, value=max(delays) * state.system.tick, assumptions=notes), arcs)
    return runs


def build_storing_waits(state: PropagationState) -> dict[str, TimingValue]:
    """Return how long a message may wait to be stored while its reader is activated, in ns, by reader."""
    return {name: _build_storing_wait(state, name, wait) for name, wait in state.storing_waits.items()}


def _build_storing_wait(state: PropagationState, name: str, wait: WorstResponse) -> TimingValue:
    """Return one reader's wait, with what is missing; a declared response stands in for it: what it reads is stored in time.

    It does not where all is known and nothing bounds the wait.
    """
    if wait.value is not None:
        notes = _list_fair_notes(state.system, state.system.activities[name], wait)
        return TimingValue(wait.value * state.system.tick, assumptions=notes) if wait.value else ZERO_VALUE
    if state.responses[name].value is None:
        return ZERO_VALUE  # the response says what is missing: to say it twice makes it no worse
    if state.system.activities[name].response is not None and wait.cause.missing:
        return TimingValue(Fraction(0), assumptions=(f"what {name} reads is stored in time",))
    missing = wait.cause.missing
    return TimingValue(None, not missing, missing, wait.cause.notes)


def _cores_text(resource: ProcessingResource | None) -> str:
    """Return the words for the cores whose work is counted."""
    if resource is None or not resource.joined:
        return resource.id if resource else ""
    return f"{resource.id} and on those that wait with it for a container's threads (one of them works while any waits)"


def _list_fair_notes(system: TimingSystem, activity: Activity, worst: WorstResponse) -> tuple[str, ...]:
    """Return what a figure assumes of how the threads of its host share the cores."""
    share = system.fair_shares.get(activity.host or "")
    return (share.assumption,) if worst.tier == "fair" and share is not None and share.assumption else ()


def _worst_value(
    system: TimingSystem, activity: Activity, worst_response: WorstResponse, resource: ProcessingResource | None
) -> TimingValue:
    """Return the worst response with what it assumes, or what is missing."""
    tick = system.tick
    notes = [*worst_response.cause.notes, *_list_fair_notes(system, activity, worst_response)]
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
        name: _add_storing_share(system, name, activity_share(system, name, pace), pace.rate, outputs)
        for name, pace in paces.items()
        if name in system.activities
    }
    by_host: dict[str, list[ProcessingResource]] = {host: [] for host in system.cores}
    for resource in resources:
        if resource.host is not None:
            by_host.setdefault(resource.host, []).append(resource)
    judge = HostJudge(system, paces, responses)
    return {host: _build_host_load(host, host_resources, shares, judge) for host, host_resources in by_host.items()}


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
    system: TimingSystem,
    name: str,
    share: TimingValue,
    own_rate: TimingValue,
    outputs: Mapping[tuple[str, str], EventPace],
) -> TimingValue:
    """Return the share of a core that an activity takes, with the callbacks that store its inputs and take answers."""
    activity = system.activities[name]
    storing_shares: list[TimingValue] = []
    for arc in system.arcs_into.get(name, ()) if activity.storing else ():
        callback = activity.storing.get(arc.input)
        if callback is None or not callback.wcet or arc.role == "request":
            continue
        # An answer comes for each call.
        is_answer = arc.role == "answer"
        rate = own_rate if is_answer else outputs[arc.source, arc.output].rate
        time = callback.wcet * (activity.calls.get(arc.input, 1) if is_answer else 1)
        storing_shares.append(multiply_value(rate, Fraction(time * system.tick / NS_PER_SECOND)))
    return add_values((share, *storing_shares)) if storing_shares else share


def _add_other_load(system: TimingSystem, host: str, core_count: int, shares: Iterable[TimingValue]) -> TimingValue:
    """Return the sum of shares of some cores, with what other programs take of them."""
    fair_share = system.fair_shares.get(host)
    load = add_values(shares)
    if fair_share is None or not fair_share.other_load:
        return load
    return add_values((load, TimingValue(fair_share.other_load * core_count)))


def _build_host_load(
    host: str, host_resources: list[ProcessingResource], share_of: Mapping[str, TimingValue], judge: HostJudge
) -> HostLoad:
    shares = {name: share_of[name] for resource in host_resources for name in resource.members}
    loads = tuple(
        (
            resource.id,
            resource.cores,
            _add_other_load(judge.system, host, resource.cores, [shares[name] for name in resource.members]),
        )
        for resource in host_resources
        if not resource.missing
    )
    is_open = any(resource.missing for resource in host_resources)
    # Of one thread, or of threads that are all pinned, it does not matter how many cores there are.
    cores = None if is_open else judge.system.cores.get(host) or sum(count for _, count, _ in loads) or None
    verdict = judge.judge_host(loads, tuple(shares))
    # Elements that add nothing to the load are no tasks in the sense of the bound, which falls with their number.
    working = sum(1 for utilisation in shares.values() if utilisation.value != 0)
    return HostLoad(
        utilisation=_add_other_load(judge.system, host, cores or 1, shares.values()),
        cores=cores,
        rate_monotonic_bound=TimingValue(rate_monotonic_bound(working)) if cores == 1 else _ONE_CORE_ONLY,
        verdict="unknown" if is_open and verdict != "overload" else verdict,
        activity_shares=tuple(shares.items()),
        core_loads=loads,
        earliest_deadline_bound=TimingValue(Fraction(1)) if cores == 1 else _ONE_CORE_ONLY,
        unproven=judge.find_unproven(shares),
    )
