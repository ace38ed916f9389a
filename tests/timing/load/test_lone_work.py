"""What has a core of its own is found once for equal work, and a budget is spent on it as if it were searched each time."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest

from archgen.timing.load import lone_work
from archgen.timing.load.busy_windows import (
    NO_DEMAND,
    ActivityWork,
    DivergedError,
    GrowingLoad,
    SearchBudget,
    longest_busy_period,
    worst_response,
)
from archgen.timing.load.event_streams import EventStream
from archgen.timing.load.storing_waits import find_core_waits
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.timing_system import Activity, TimingSystem


def make_work(seed: int) -> ActivityWork:
    chance = random.Random(seed)  # noqa: S311 - the same work each time
    streams = tuple(
        EventStream(chance.randrange(5, 60), chance.choice((0, 0, 3, 70)), chance.choice((0, 0, 2)))
        for _ in range(chance.randrange(4))
    )
    return ActivityWork(chance.randrange(5), streams)


@pytest.mark.parametrize("seed", range(30))
@pytest.mark.parametrize("in_order", [True, False])
def test_a_response_and_its_cost_are_those_of_a_search(seed: int, *, in_order: bool) -> None:
    work = make_work(seed)
    searched = SearchBudget()
    try:
        ticks: int | None = (
            worst_response(work, NO_DEMAND, searched)
            if in_order
            else longest_busy_period(GrowingLoad((work,)).demand_function(), searched)
        )
    except DivergedError:
        ticks = None
    for _ in range(2):
        budget = SearchBudget()
        if ticks is None:
            with pytest.raises(DivergedError):
                lone_work.find_lone_response(work, budget, in_order=in_order)
        else:
            assert lone_work.find_lone_response(work, budget, in_order=in_order).response == ticks
        assert budget.spent_terms == searched.spent_terms


@pytest.mark.parametrize("priority", [None, 3])
@pytest.mark.parametrize("seed", range(30))
def test_a_wait_is_that_on_a_core_with_nothing_else(seed: int, priority: int | None) -> None:
    work = make_work(seed)
    activity = Activity("a", "a", None, "event", wcet=work.cost, priority=priority)
    system = TimingSystem(Fraction(1), {"a": activity}, (), {}, {})
    models = {"a": work.streams}
    core = ProcessingResource("a", None, 1, (("a",),))
    for terms in (1, 5, 40, 1_000_000):
        searched = SearchBudget(terms)
        expected = find_core_waits(system, core, models, ("a",), searched)["a"]
        for _ in range(2):
            budget = SearchBudget(terms)
            assert lone_work.find_lone_wait(system, "a", models, budget) == expected
            assert budget.spent_terms == searched.spent_terms


def test_what_is_known_is_paid_for_and_diverges_where_a_search_would() -> None:
    work = ActivityWork(2, (EventStream(10),))
    searched = SearchBudget()
    lone_work.find_lone_response(work, searched, in_order=True)
    whole = SearchBudget(100)
    part = whole.open_part(searched.spent_terms)
    lone_work.find_lone_response(work, part, in_order=True)
    assert (part.spent_terms, whole.spent_terms) == (searched.spent_terms, searched.spent_terms)
    with pytest.raises(DivergedError):
        lone_work.find_lone_response(work, part, in_order=True)
    with pytest.raises(DivergedError):
        lone_work.find_lone_response(work, SearchBudget(1_000, 1), in_order=True)
