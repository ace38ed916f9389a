"""Whether a host can do what runs there: against its cores, deadlines, and the bounds of Liu and Layland (1973)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from typing import Literal

from archgen.frozen import dataclass
from archgen.timing.analysis import EventPace, HostLoad, ResponseTime
from archgen.timing.figures.tick_unit import NS_PER_SECOND
from archgen.timing.figures.timing_values import ZERO_VALUE, TimingValue
from archgen.timing.system.core_placement import PREEMPTIVE_ORDERS
from archgen.timing.system.thread_pools import name_lane
from archgen.timing.system.timing_system import TimingSystem

_BILLION = 10**9
_LOG_2 = Fraction(693_147_180, _BILLION)
"""ln 2, the bound for any number of elements, rounded down."""
_MANY_TASKS = 64
HostVerdict = Literal["schedulable", "overload", "undecided", "unknown"]


@dataclass(frozen=True, slots=True)
class HostJudge:
    """Judges hosts by how often their activities work, and by their responses."""

    system: TimingSystem
    paces: Mapping[str, EventPace]
    responses: Mapping[str, ResponseTime]

    def judge_host(self, loads: tuple[tuple[str, int, TimingValue], ...], members: tuple[str, ...]) -> HostVerdict:
        """Judge a host: overloaded, schedulable, undecided, or unknown."""
        if any(_exceeds_cores(load, cores) for _, cores, load in loads):
            return "overload"
        # The order matters. A load that is exactly full is bearable only where each response is proven to be within its
        # period; where a figure is missing nothing can be proven, so full counts as overload.
        is_full = any(load.value == cores for _, cores, load in loads)
        if any(not load.complete or load.value is None for _, _, load in loads):
            return "overload" if is_full else "unknown"
        if not self.find_unproven(members):
            return "schedulable"
        if is_full:
            return "overload"
        one_core = len(loads) == 1 and loads[0][1] == 1
        fits = one_core and _fits_rate_monotonic(self.system, members, loads[0][2], self.paces)
        return "schedulable" if fits else "undecided"

    def find_unproven(self, members: Iterable[str]) -> tuple[str, ...]:
        """Return the activities that nothing proves to be done in time."""
        return tuple(
            name for name in members if not _is_done_in_time(self.system, name, self.paces[name], self.responses[name])
        )


def name_host_verdict(load: HostLoad) -> str:
    """Return what people read as the verdict on a host."""
    if load.verdict == "schedulable" and load.unproven:
        return "in time with priorities by rate"
    return {"schedulable": "in time", "overload": "overload", "undecided": "not proven in time"}.get(
        load.verdict, load.verdict
    )


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
    if not is_plain or not orders <= PREEMPTIVE_ORDERS:
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
