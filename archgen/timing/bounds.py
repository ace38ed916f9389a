"""Response times in ns with their reasons, and the load of hosts against the bounds of Liu and Layland (1973)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from typing import Literal

from archgen.timing.analysis import HostLoad, Pace, Reason, Response
from archgen.timing.placement import Resource
from archgen.timing.propagate import State
from archgen.timing.sums import boundless, kept, total, unknown
from archgen.timing.system import Activity, System
from archgen.timing.threads import Found
from archgen.timing.ticks import SECOND
from archgen.timing.value import ZERO, Value

_DIGITS = 10**9
_LN_2 = Fraction(693_147_180, _DIGITS)
"""ln 2, the bound for any number of elements, rounded down."""
_MANY = 64
_ONE_CORE = Value(None, assumptions=("one core only",))
Verdict = Literal["schedulable", "overload", "undecided", "unknown"]
_WORDS = {
    "declared": "declared as the worst case",
    "dedicated": "its own queue, on a core of its own",
    "host": "the longest time for which all work on {0} can keep it busy, in whatever order",
    "priorities": "everything of its priority or a higher one on {0}, over all activations of the busy period",
    "executor": "all work of its executor on {0}, in whatever order",
    "cores": "its own work, and a share of all other work on the {1} cores of {0}",
    "unknown": "no execution time is written",
}


def all_responses(state: State, resources: Iterable[Resource]) -> dict[str, Response]:
    """Return the best and worst response of every activity, in ns."""
    where = {name: resource for resource in resources for name in resource.members}
    return {name: _response(state, name, state.responses[name], where.get(name)) for name in state.system.activities}


def _response(state: State, name: str, found: Found, resource: Resource | None) -> Response:
    """Return one activity's response, with the tier's sentence as its reason."""
    activity, tick = state.system.activities[name], state.system.tick
    best = unknown(name) if activity.bcet is None else Value(activity.bcet * tick)
    shared = (_where(resource), resource.cores) if resource else ("", 1)
    place = activity.places.get("response" if found.tier == "declared" else "wcet", activity.at)
    return Response(
        best, _worst(activity, found, tick, resource), found.tier, (Reason(_WORDS[found.tier], place, shared),)
    )


def _where(resource: Resource | None) -> str:
    """Return the words for the cores whose work is counted."""
    if resource is None or not resource.joined:
        return resource.id if resource else ""
    return f"{resource.id} and on those that wait with it for a container's threads (one of them works while any waits)"


def _worst(activity: Activity, found: Found, tick: Fraction, resource: Resource | None) -> Value:
    """Return the worst response with what it assumes, or what is missing."""
    said = list(found.cause.notes)
    if found.tier == "declared":
        said.append("assumed")
    elif resource is None:
        said += ["assuming a dedicated core"] if activity.wcet is not None and activity.host is None else []
    else:
        said += resource.assumptions
    assumptions = tuple(dict.fromkeys(said))
    if found.value is not None:
        return Value(found.value * tick, assumptions=assumptions)
    nothing = Value(None, not found.cause.missing, found.cause.missing, assumptions)
    if not found.cause.missing or boundless(nothing):
        return nothing
    # Figures of others are missing: its own execution time is still a bound from below.
    least = None if activity.wcet is None else activity.wcet * tick
    return Value(least, complete=False, missing=found.cause.missing, assumptions=assumptions, side="at least")


def host_loads(
    system: System, resources: Iterable[Resource], paces: Mapping[str, Pace], found: Mapping[str, Response]
) -> dict[str, HostLoad]:
    """Return the load of every host, resource by resource."""
    by_host: dict[str, list[Resource]] = {host: [] for host in system.cores}
    for resource in resources:
        if resource.host is not None:
            by_host.setdefault(resource.host, []).append(resource)
    return {host: _host(system, host, several, paces, found) for host, several in by_host.items()}


def share(system: System, name: str, pace: Pace) -> Value:
    """Return the share of a core that an activity takes."""
    activity = system.activities[name]
    if activity.behaviour == "once" or pace.rate.value == 0 or activity.wcet == 0:
        return Value(Fraction(0))
    if activity.wcet is None:
        return unknown(name)
    if pace.rate.value is None:
        return pace.rate
    # One Fraction from four integers: each product of two Fractions would be reduced to lowest terms on its own.
    (often, per), (tick, parts) = pace.rate.value.as_integer_ratio(), system.tick.as_integer_ratio()
    return kept(pace.rate, Fraction(often * activity.wcet * tick, per * parts * SECOND))


def _host(
    system: System, host: str, places: list[Resource], paces: Mapping[str, Pace], found: Mapping[str, Response]
) -> HostLoad:
    """Return the load of one host."""
    parts = {name: share(system, name, paces[name]) for place in places for name in place.members}
    loads = tuple((place.id, place.cores, total(parts[name] for name in place.members)) for place in places)
    cores = system.cores.get(host) or 1
    # Elements that add nothing to the load are no tasks in the sense of the bound, which falls with their number.
    working = sum(1 for part in parts.values() if part.value != 0)
    return HostLoad(
        utilisation=total(parts.values()),
        cores=cores,
        rate_monotonic_bound=Value(rate_monotonic_bound(working)) if cores == 1 else _ONE_CORE,
        verdict=_verdict(system, loads, tuple(parts), paces, found),
        parts=tuple(parts.items()),
        places=loads,
        earliest_deadline_bound=Value(Fraction(1)) if cores == 1 else _ONE_CORE,
    )


def _verdict(
    system: System,
    loads: tuple[tuple[str, int, Value], ...],
    members: tuple[str, ...],
    paces: Mapping[str, Pace],
    found: Mapping[str, Response],
) -> Verdict:
    """Judge a host: overloaded, schedulable, undecided, or unknown."""
    if any(_too_much(load, cores) for _, cores, load in loads):
        return "overload"
    # The order matters. A load that is exactly full is bearable only where each response is proven to be within its
    # period; where a figure is missing nothing can be proven, so full counts as overload.
    full = any(load.value == cores for _, cores, load in loads)
    if any(not load.complete or load.value is None for _, _, load in loads):
        return "overload" if full else "unknown"
    if all(_in_time(paces[name], found[name]) for name in members):
        return "schedulable"
    if full:
        return "overload"
    one_core = len(loads) == 1 and loads[0][1] == 1
    return "schedulable" if one_core and _below_bound(system, members, loads[0][2], paces) else "undecided"


def _too_much(load: Value, cores: int) -> bool:
    """Whether a load is unbounded or above the number of cores."""
    unbounded = load.value is None and load.complete
    return unbounded or (load.value is not None and load.value > cores)


def _below_bound(system: System, members: Iterable[str], load: Value, paces: Mapping[str, Pace]) -> bool:
    """Whether priorities by rate are sure to do, and nobody wrote others.

    Jitter is not in Liu and Layland's bound: with it nothing is sure.
    """
    working = [system.activities[name] for name in members if paces[name].rate.value and system.activities[name].wcet]
    if any(paces[activity.id].jitter != ZERO for activity in working):
        return False
    by_rate = sorted(working, key=lambda activity: -(paces[activity.id].rate.value or 0))
    written = [activity.priority for activity in by_rate]
    ordered = all(one is not None and two is not None and one > two for one, two in pairwise(written))
    return (ordered or not any(one is not None for one in written)) and is_below_bound(
        load.value or Fraction(0), len(working)
    )


def _in_time(pace: Pace, response: Response) -> bool:
    """Whether an activity is done before it is activated again."""
    if pace.rate.value == 0:
        return True
    if response.worst.value is None or not response.worst.complete or not pace.rate.value:
        return False
    (worst, parts), (often, per) = response.worst.value.as_integer_ratio(), pace.rate.value.as_integer_ratio()
    # R <= 1 / rate, multiplied out.
    return worst * often <= SECOND * parts * per


@lru_cache(_MANY)
def rate_monotonic_bound(number: int) -> Fraction:
    """Return n (2^(1/n) - 1), rounded down to nine decimals (ln 2 beyond 64 elements)."""
    if number > _MANY:
        return _LN_2
    if number < 1:
        return Fraction(1)
    # The n-th root by bisection in integers: no float, and surely rounded down.
    low, high = _DIGITS, 2 * _DIGITS
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if middle**number <= 2 * _DIGITS**number else (low, middle)
    return Fraction(number * (low - _DIGITS), _DIGITS) if number > 1 else Fraction(1)


def is_below_bound(utilisation: Fraction, number: int) -> bool:
    """Whether a utilisation is within the exact bound: U <= n (2^(1/n) - 1) where (1 + U/n)^n <= 2."""
    # ln 2 is below the bound for every n: stricter than need be, and without powers of large fractions.
    if number > _MANY:
        return utilisation <= _LN_2
    return number == 0 or (1 + utilisation / number) ** number <= 2  # noqa: PLR2004
