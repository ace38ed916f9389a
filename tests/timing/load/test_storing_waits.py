"""How long work may go on before an activation that is not part of it: in ticks, worked out by hand."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from archgen.timing.load.busy_windows import ActivityWork, DivergedError, GrowingLoad, SearchBudget
from archgen.timing.load.event_streams import EventStream
from archgen.timing.load.storing_waits import hold_before_activation, hold_beside_others, longest_busy_window


@pytest.mark.parametrize(
    ("work_within", "window", "looks"),
    [
        (lambda _: 5, 5, 2),  # five ticks of work last five
        (lambda window: window, 9, 1),
        (lambda window: window - 1, 0, 9),
        (lambda _: -3, 0, 1),
        (lambda window: 6 if window > 7 else 2, 2, 3),
    ],
)
def test_the_longest_window_that_its_work_fills(work_within: Callable[[int], int], window: int, looks: int) -> None:
    spent: list[int] = []
    assert longest_busy_window(work_within, 9, spent.append, 7) == window
    assert spent == [7] * looks


@pytest.mark.parametrize(
    ("own_cost", "own_stream", "other_cost", "busy_period", "hold"),
    [
        # The activation that comes is not part of it: only the 3 of the other.
        (2, EventStream(10), 3, 5, 3),
        # It comes 2 after the one before, which takes 8: four go on without a gap, and the fifth may come at 32.
        (8, EventStream(10, 8), 0, 40, 32),
        # At 10 it comes again: the first 5 and the 5 of the other last until then.
        (5, EventStream(10), 5, 15, 10),
        (4, EventStream(10), 5, 9, 5),
    ],
)
def test_work_until_an_activation(
    own_cost: int, own_stream: EventStream, other_cost: int, busy_period: int, hold: int
) -> None:
    own_streams = (own_stream,)
    works = [ActivityWork(own_cost, own_streams), ActivityWork(other_cost, (EventStream(1000),))]
    demand = GrowingLoad(works).demand_function()
    assert hold_before_activation(demand, own_cost, own_streams, busy_period, SearchBudget()) == hold
    # The same on several cores of which the others take as much.
    spend = SearchBudget().start_search()
    assert hold_beside_others(lambda _: other_cost, own_cost, own_streams, spend) == hold


def test_each_look_costs_the_terms_of_the_demand_and_one() -> None:
    """Two looks, at 5 and at 3, of two terms."""
    own_streams = (EventStream(10),)
    demand = GrowingLoad([ActivityWork(2, own_streams), ActivityWork(3, (EventStream(20),))]).demand_function()
    budget = SearchBudget()
    hold_before_activation(demand, 2, own_streams, 5, budget)
    assert budget.spent_terms == 2 * (demand.term_count + 1)
    with pytest.raises(DivergedError):
        hold_before_activation(demand, 2, own_streams, 5, SearchBudget(0))


def test_a_window_begins_as_soon_as_others_are_busy() -> None:
    """Others are busy for 2 ticks from the first one on; what is stored takes no time."""
    spend = SearchBudget().start_search()
    assert hold_beside_others(lambda window: min(window, 2), 0, (EventStream(10),), spend) == 2
    assert hold_beside_others(lambda _: 0, 0, (EventStream(10),), spend) == 0


def test_what_begins_later_does_not_hold_up_what_is_stored_at_once() -> None:
    """In the first tick nobody else works."""
    spent: list[int] = []
    assert hold_beside_others(lambda window: 2 if window > 1 else 0, 0, (EventStream(10),), spent.append) == 0
    assert spent == [1]
