"""The load of GPUs and other resources that work on one use at a time, and how long each use waits and takes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from fractions import Fraction
from typing import Literal

from archgen.timing.analysis import EventPace, Reason, ResourceLoad
from archgen.timing.figures.tick_unit import NS_PER_SECOND
from archgen.timing.figures.timing_values import TimingValue, UnknownCause
from archgen.timing.figures.value_arithmetic import add_values, multiply_value, value_of_cause
from archgen.timing.load.busy_windows import SearchBudget
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.load.resource_waits import find_use_time, find_users
from archgen.timing.system.timing_system import Activity, TimingSystem


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
    """Return the share of a resource that an activity takes."""
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
