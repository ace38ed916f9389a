"""The parts of a busy window, by hand: demand, what is carried in, lower bounds, budgets, and where searches begin."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.timing.load.busy_windows import (
    NO_DEMAND,
    ActivityWork,
    DemandFunction,
    DivergedError,
    GrowingLoad,
    SearchBudget,
    add_demands,
    find_worst_activation,
    longest_busy_period,
    subtract_demand,
)
from archgen.timing.load.event_streams import EventStream
from archgen.timing.load.level_cascades import EventOrigin, GateRule
from archgen.timing.load.work_terms import CountFormulas, EventCount

WHOLE = 2**64
PLAIN, LATE = EventStream(10), EventStream(10, 25)
APART = EventStream(10, 25, 4)
MANY = EventStream(10, 5, 0, 3, 2)


@pytest.mark.parametrize(
    ("works", "window", "demand", "term_count"),
    [
        ([], 5, 0, 1),
        ([ActivityWork(3, (PLAIN,))], 10, 3, 2),
        ([ActivityWork(3, (PLAIN,))], 11, 6, 2),
        ([ActivityWork(3, (PLAIN,)), ActivityWork(4, (PLAIN,))], 11, 14, 2),  # equal streams are one term
        ([ActivityWork(3, (PLAIN, LATE))], 1, 3 + 9, 3),
        ([ActivityWork(3, (APART,))], 5, 6, 3),
        ([ActivityWork(3, (APART,)), ActivityWork(1, (APART,))], 5, 8, 3),
        ([ActivityWork(3, (MANY,))], 1, 3 * 2 * 2, 3),  # ceil(6 * 3 / 10) pairs
        ([ActivityWork(3, (EventStream(10, 0, 0, 1, 2),))], 11, 12, 2),
        ([ActivityWork(0, (PLAIN,))], 100, 0, 1),
    ],
)
def test_demand_is_the_sum_of_all_events_in_a_window(
    works: list[ActivityWork], window: int, demand: int, term_count: int
) -> None:
    function = GrowingLoad(works).demand_function()
    assert (function.within(window), function.term_count) == (demand, term_count)


@pytest.mark.parametrize(
    ("stream", "rate", "offset"),
    [
        (EventStream(8), 3 * WHOLE // 8, 0),
        (EventStream(8, 4), 3 * WHOLE // 8, 3 * WHOLE // 2),
        (EventStream(8, 4, 2), 3 * WHOLE // 8, 0),  # a distance takes the offset, not the rate
        (EventStream(8, 4, 16), 3 * WHOLE // 16, 0),
        (EventStream(8, 4, 0, 2, 2), 3 * WHOLE // 2, 6 * WHOLE),
    ],
)
def test_the_lower_bound_is_the_average(stream: EventStream, rate: int, offset: int) -> None:
    function = GrowingLoad([ActivityWork(3, (stream,))]).demand_function()
    assert (function.scaled_rate, function.scaled_offset) == (rate, offset)
    load = GrowingLoad([ActivityWork(3, (stream,))])
    load.add_work([ActivityWork(5, (EventStream(4),))])
    both = load.demand_function()
    assert (both.scaled_rate, both.scaled_offset) == (rate + 5 * WHOLE // 4, offset)
    # The lower bound lies below the demand at every window.
    for length in range(1, 80):
        assert both.scaled_rate * length + both.scaled_offset <= both.within(length) * WHOLE


def test_demands_are_added_and_subtracted() -> None:
    seven, three = DemandFunction(lambda t: 7 * t, 2, 70, 700), DemandFunction(lambda t: 3 * t, 1, 30, 300)
    total, rest = add_demands(seven, three), subtract_demand(seven, three)
    assert (total.within(2), *total[1:]) == (20, 3, 100, 1000)
    assert (rest.within(2), *rest[1:]) == (8, 3, 40, 400)
    assert (NO_DEMAND.within(9), NO_DEMAND[1:]) == (0, (0, 0, 0))


def test_a_search_spends_its_own_part_of_the_budget(monkeypatch: pytest.MonkeyPatch) -> None:
    from archgen.timing.load import busy_windows

    monkeypatch.setattr(busy_windows, "_MAX_TERMS_PER_SEARCH", 10)
    budget = SearchBudget(25)
    spend = budget.start_search()
    spend(10)
    with pytest.raises(DivergedError):
        spend(1)
    second = budget.start_search()  # 14 are left, of which it may spend 10
    second(10)
    third = budget.start_search()
    third(4)
    with pytest.raises(DivergedError):
        third(1)
    with pytest.raises(DivergedError):
        budget.start_search()(1)


def test_a_step_costs_its_terms_and_an_activation_eight() -> None:
    """Two looks (at 1, then at 1 + 2) of two terms and one for the sum each, and eight for the activation."""
    work = ActivityWork(1, (EventStream(100),))
    interference = GrowingLoad([ActivityWork(2, (EventStream(50),))]).demand_function()
    for term_count, ends in ((2 * 3 + 8, True), (2 * 3 + 8 - 1, False)):
        budget = SearchBudget(term_count)
        if ends:
            assert find_worst_activation(work, interference, budget).response == 3
        else:
            with pytest.raises(DivergedError):
                find_worst_activation(work, interference, budget)


def test_the_busy_period_is_the_first_moment_without_work() -> None:
    """3 each 10 and 4 each 6: 7, then 3 + 8 = 11, then 6 + 8 = 14, then 6 + 12 = 18 and nothing more comes before 18."""
    load = GrowingLoad([ActivityWork(3, (EventStream(10),)), ActivityWork(4, (EventStream(6),))]).demand_function()
    assert longest_busy_period(load, SearchBudget()) == 18
    assert longest_busy_period(load, SearchBudget(), 18) == 18
    assert longest_busy_period(load._replace(scaled_rate=0, scaled_offset=0), SearchBudget()) == 18
    assert longest_busy_period(load, SearchBudget(), 30) == 30
    assert longest_busy_period(NO_DEMAND, SearchBudget()) == 0
    assert longest_busy_period(GrowingLoad([ActivityWork(1, (PLAIN,))]).demand_function(), SearchBudget()) == 1
    assert longest_busy_period(GrowingLoad([ActivityWork(2, (PLAIN,))]).demand_function(), SearchBudget()) == 2


def test_a_response_counts_from_the_activation() -> None:
    """25 late: three come at once and the fourth at 5; of the first three the last is done at 12 when the fourth came."""
    assert find_worst_activation(ActivityWork(4, (LATE,)), NO_DEMAND, SearchBudget()).response == 12
    assert find_worst_activation(ActivityWork(1, (LATE,)), NO_DEMAND, SearchBudget()).response == 3
    assert (
        find_worst_activation(ActivityWork(10, (PLAIN,)), NO_DEMAND, SearchBudget()).response == 10
    )  # just done when the next comes
    assert find_worst_activation(ActivityWork(7, ()), NO_DEMAND, SearchBudget()).response == 7
    assert find_worst_activation(ActivityWork(0, (PLAIN,)), NO_DEMAND, SearchBudget()).response == 0


def test_the_worst_activation_is_not_the_first() -> None:
    """J. Lehoczky, RTSS 1990: C = 26 each 70 above C = 62 each 100: the jobs end at 114, 202, 316, 404, 518, 606 and 694,
    and come each 100: 114, 102, 116, 104, 118, 106, 94.
    """
    interference = GrowingLoad([ActivityWork(26, (EventStream(70),))]).demand_function()
    assert find_worst_activation(ActivityWork(62, (EventStream(100),)), interference, SearchBudget()).response == 118


@pytest.mark.parametrize(
    ("every", "calls", "count"),
    [
        (1, Fraction(1), EventCount(5, "5")),
        (2, Fraction(1), EventCount(3, "ceil((5) / 2)")),
        (1, Fraction(1, 2), EventCount(3, "ceil(0.5 x (5))")),
    ],
)
def test_what_a_gate_lets_through_is_written_as_it_is_counted(every: int, calls: Fraction, count: EventCount) -> None:
    rule = GateRule(({EventOrigin("activity", "s"): 1},), every, calls=calls)
    assert CountFormulas(Fraction(10**6)).count_gate(rule, [EventCount(5, "5")], 10) == count


@pytest.mark.parametrize(
    ("streams", "window", "count"),
    [
        ((PLAIN,), 25, EventCount(2, "floor(25 ms / 10 ms)")),
        ((PLAIN,), 9, EventCount(0, "floor(9 ms / 10 ms)")),
        ((EventStream(10, 5),), 25, EventCount(3, "floor((25 ms + 5 ms) / 10 ms)")),
        ((APART,), 5, EventCount(1, "floor(5 ms / 4 ms)")),
        ((PLAIN, EventStream(20)), 25, EventCount(4, "4")),  # of several streams the number alone
    ],
)
def test_the_event_that_ends_a_window_is_not_counted(
    streams: tuple[EventStream, ...], window: int, count: EventCount
) -> None:
    assert CountFormulas(Fraction(10**6)).count_held_jobs(streams, window) == count
