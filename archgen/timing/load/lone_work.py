"""What has a core of its own: the figures rest on its execution time and its events only, so equal ones are found once.

Many activities of a project are alike in these, and in each of its variants nearly all are what they were.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

from archgen.timing.load.busy_windows import (
    NO_DEMAND,
    ActivityWork,
    DivergedError,
    GrowingLoad,
    SearchBudget,
    WorstActivation,
    find_worst_activation,
    longest_busy_period,
    longest_wait_for_turn,
)
from archgen.timing.load.event_streams import EventStreams
from archgen.timing.load.storing_waits import find_core_waits, hold_before_activation
from archgen.timing.load.thread_work import DIVERGED_CAUSE, EventModels, WorstResponse, find_work, work_utilisation
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.timing_system import TimingSystem

_MAX_TERMS = 10_000
"""Searches that look at more are not remembered: their budget decides whether they end."""


class _FoundActivation(NamedTuple):
    """What takes longest, and how many terms its searches looked at."""

    worst: WorstActivation
    terms: int


class _FoundTime(NamedTuple):
    """A time in ticks, and how many terms its searches looked at."""

    ticks: int
    terms: int


def find_lone_response(work: ActivityWork, budget: SearchBudget, *, in_order: bool) -> WorstActivation:
    """Return what takes longest; `in_order` where activations begin in the order in which they come.

    Raises DivergedError where the budget does not suffice.
    """
    found = _find_response(work.cost, work.streams, in_order)
    if found is not None and budget.repeat_searches(found.terms):
        return found.worst
    return _search_response(work, budget, in_order=in_order)


def find_lone_wait(system: TimingSystem, name: str, event_models: EventModels, budget: SearchBudget) -> WorstResponse:
    """Return how long a message to an activity with a core of its own may wait to be stored while it is activated."""
    work = find_work(system, name, event_models)
    found = _find_hold(work.cost, work.streams) if isinstance(work, ActivityWork) else None
    if found is not None and budget.repeat_searches(found.terms):
        return WorstResponse(found.ticks, "host")
    if not isinstance(work, ActivityWork) or work_utilisation(work.cost, work.streams) >= 1:
        own_core = ProcessingResource(name, None, 1, ((name,),))
        return find_core_waits(system, own_core, event_models, (name,), budget)[name]
    try:
        return WorstResponse(_search_hold(work, budget), "host")
    except DivergedError:
        return WorstResponse(None, "host", DIVERGED_CAUSE)


@lru_cache(1 << 14)
def _find_response(cost: int, streams: EventStreams, in_order: bool) -> _FoundActivation | None:  # noqa: FBT001 - a key of the cache
    budget = SearchBudget(_MAX_TERMS)
    try:
        return _FoundActivation(
            _search_response(ActivityWork(cost, streams), budget, in_order=in_order), budget.spent_terms
        )
    except DivergedError:
        return None


def _search_response(work: ActivityWork, budget: SearchBudget, *, in_order: bool) -> WorstActivation:
    if in_order:
        return find_worst_activation(work, NO_DEMAND, budget)
    return WorstActivation(0, 0, longest_busy_period(GrowingLoad((work,)).demand_function(), budget))


@lru_cache(1 << 14)
def _find_hold(cost: int, streams: EventStreams) -> _FoundTime | None:
    if work_utilisation(cost, streams) >= 1:
        return None
    budget = SearchBudget(_MAX_TERMS)
    try:
        return _FoundTime(_search_hold(ActivityWork(cost, streams), budget), budget.spent_terms)
    except DivergedError:
        return None


def _search_hold(work: ActivityWork, budget: SearchBudget) -> int:
    demand = GrowingLoad((work,)).demand_function()
    longest_wait = longest_wait_for_turn(demand, budget)
    return hold_before_activation(demand, work.cost, work.streams, longest_wait, budget)
