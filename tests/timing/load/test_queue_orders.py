"""Responses of queues, task by task: durations in ticks, worked out by hand."""

from __future__ import annotations

import pytest

from archgen.timing.load.busy_windows import SearchBudget
from archgen.timing.load.event_streams import EventStream
from archgen.timing.load.queue_orders import (
    QueueBound,
    QueuedTask,
    bound_edf,
    bound_fifo,
    bound_non_preemptive,
    bound_rounds,
    find_end,
    find_lead,
    find_start,
    list_arrivals,
)


def task(cost: int, period: int, jitter: int = 0, **rest: int) -> QueuedTask:
    """Make a task that waits in a queue."""
    return QueuedTask("t", cost, (EventStream(period, jitter),))._replace(**rest)  # type: ignore[arg-type]


def ignore(_: int) -> None:
    """Spend nothing."""


def response_of(bound: QueueBound | None) -> int | None:
    return None if bound is None else bound.response


def test_windows_are_closed() -> None:
    """What comes every 10 ticks comes twice in a window of 10, both ends included."""
    assert [task(1, 10).count_until(time) for time in (-1, 0, 9, 10, 20)] == [0, 1, 1, 2, 3]


def test_only_one_stream_says_how_far_apart_activations_are() -> None:
    streams = (EventStream(10, 3),)
    assert [QueuedTask("t", 1, each).min_spacing for each in (streams, streams * 2, ())] == [7, 0, 0]


@pytest.mark.parametrize(("busy_period", "response"), [(2, 7), (3, 11), (14, 11)])
def test_fifo_looks_at_each_arrival_within_the_busy_period(busy_period: int, response: int) -> None:
    """At 0 there are 1 + 6. Two ticks later the second of 6 may come: 1 + 2 x 6 - 2."""
    budget = SearchBudget()
    assert response_of(bound_fifo([task(1, 10), task(6, 20, 18)], busy_period, budget)) == response
    assert budget.spent_terms == {2: 2, 3: 4, 14: 6}[busy_period]


def test_what_takes_no_time_waits_for_nobody_in_the_order_of_arrival() -> None:
    assert response_of(bound_fifo([task(0, 10)], 1, SearchBudget())) == 0


@pytest.mark.parametrize(
    ("first", "response"),
    [
        # A round is 2 + 3 + 2 x 5 = 15: the one under way, and its own, within which none comes again.
        (task(2, 31), 30),
        # Two wait at 30: three rounds.
        (task(2, 30), 45),
        (task(2, 30, depth=2), 45),
        # One is too many for the queue: who knows which is overwritten.
        (task(2, 30, depth=1), None),
        # More come than are worked off.
        (task(2, 15), None),
        (task(2, 16), 15 * 17),
        # Of ticks one waits, at whatever load.
        (task(2, 1, is_timer=True), 30),
    ],
)
def test_rounds(first: QueuedTask, response: int | None) -> None:
    tasks = [first, task(3, 100), task(5, 100, entities=2)]
    assert response_of(bound_rounds(first, tasks, SearchBudget())) == response


def test_what_is_not_preempted() -> None:
    """The example of Davis et al. in half units: the third task's second activation is the longest, 7."""
    tasks = [task(2, 5, priority=3), task(2, 7, priority=2), task(2, 7, priority=1)]
    assert [response_of(bound_non_preemptive(each, tasks, 14, SearchBudget())) for each in tasks] == [4, 6, 7]
    assert response_of(bound_non_preemptive(tasks[2], tasks, 7, SearchBudget())) == 6


@pytest.mark.parametrize(
    ("other", "response"),
    [
        (task(3, 100, priority=1), 5),  # as urgent: before it
        (task(3, 100, priority=0), 5),  # has just begun
        (task(3, 100), 5),  # without a priority: the same
        (task(3, 6, 3, priority=1), 8),  # comes at 0 and at 3, where this would begin
        (task(3, 6, 3, priority=0), 5),  # just one may have begun
    ],
)
def test_another_task_beside_one_of_two_ticks(other: QueuedTask, response: int) -> None:
    own = task(2, 100, priority=1)
    assert response_of(bound_non_preemptive(own, [own, other], 50, SearchBudget())) == response


def test_without_a_priority_nothing_is_known() -> None:
    own = task(2, 100)
    assert response_of(bound_non_preemptive(own, [own], 50, SearchBudget())) is None


def test_alone_what_takes_two_ticks_responds_in_two() -> None:
    own = task(2, 100, priority=1, deadline=100)
    assert response_of(bound_non_preemptive(own, [own], 2, SearchBudget())) == 2
    assert response_of(bound_edf(own, [own], 2, SearchBudget(), preemptive=True)) == 2
    assert response_of(bound_edf(own, [own], 2, SearchBudget(), preemptive=False)) == 2


def test_what_takes_no_time_waits_for_what_has_begun() -> None:
    own = task(0, 100, priority=1)
    assert response_of(bound_non_preemptive(own, [own, task(3, 100)], 0, SearchBudget())) == 3


@pytest.mark.parametrize(("preemptive", "responses"), [(True, [79, 101, 121]), (False, [90, 91, 121])])
def test_the_earliest_deadline_first(preemptive: bool, responses: list[int]) -> None:  # noqa: FBT001
    tasks = [task(79, 120, deadline=50), task(11, 34, deadline=100), task(1, 190, deadline=120)]
    assert [
        response_of(bound_edf(each, tasks, 237, SearchBudget(), preemptive=preemptive)) for each in tasks
    ] == responses


@pytest.mark.parametrize(
    ("own", "other", "preemptive", "response"),
    [
        (task(3, 100), task(5, 100, deadline=9), True, None),  # nobody knows its own deadline
        (task(3, 100, deadline=9), task(5, 100), True, 8),  # one that nobody knows may be the earlier one
        (task(3, 100, deadline=9), task(5, 100), False, 8),
        (task(3, 100, deadline=9), task(5, 100, deadline=10), True, 3),
        (task(3, 100, deadline=9), task(5, 100, deadline=10), False, 8),  # has begun
        (task(3, 100, deadline=9), task(5, 100, deadline=9), False, 8),  # comes first, and once
        (task(0, 100, deadline=50), task(5, 100, deadline=40), True, 5),  # takes no time, and waits for its turn
        (task(0, 100, deadline=50), task(5, 100, deadline=51), True, 0),
        # Three of 2 in 8 ticks, at 0, 3 and 6, as long as their deadline is not after its own: at most 3 after it comes.
        (task(4, 100, deadline=9), task(2, 3, deadline=6), True, 8),
        (task(4, 100, deadline=9), task(2, 3), True, 12),
    ],
)
def test_one_other_deadline(own: QueuedTask, other: QueuedTask, preemptive: bool, response: int | None) -> None:  # noqa: FBT001
    assert response_of(bound_edf(own, [own, other], 1, SearchBudget(), preemptive=preemptive)) == response


def test_how_much_later_another_may_come() -> None:
    assert [find_lead(each, 50) for each in (task(1, 9, deadline=30), task(1, 9, deadline=70), task(1, 9))] == [
        20,
        -20,
        None,
    ]


@pytest.mark.parametrize(
    ("limit", "end", "start"),
    [
        (None, 7, 11),  # the second comes at 7: after what ends then, and before what begins then
        (7, 7, 11),
        (6, 7, 7),
        (-1, 3, 3),
    ],
)
def test_three_ticks_of_work_and_four_of_another_every_seven(limit: int | None, end: int, start: int) -> None:
    limits = [(task(4, 7), limit)]
    assert (find_end(3, limits, ignore), find_start(3, limits, ignore)) == (end, start)


def test_each_look_at_a_limit_is_spent() -> None:
    spent: list[int] = []
    find_end(3, [(task(4, 7), None)], spent.append)
    find_start(3, [(task(4, 7), -1)] * 2, spent.append)
    assert spent == [2, 2, 3]


@pytest.mark.parametrize(
    ("end", "arrivals"),
    [(0, [0]), (8, [0]), (9, [0, 8]), (20, [0, 8, 10]), (21, [0, 8, 10, 20]), (31, [0, 8, 10, 20, 30])],
)
def test_instants_at_which_something_comes(end: int, arrivals: list[int]) -> None:
    """Every 10 ticks, and every 12, 4 earlier; at 20 both. What has no events comes never."""
    shifted_tasks = [(task(1, 10), 0), (task(1, 12), 4), (QueuedTask("silent", 1, ()), 0)]
    assert list(list_arrivals(end, shifted_tasks)) == arrivals


def test_a_shift_may_go_to_later() -> None:
    assert list(list_arrivals(20, [(task(1, 10), -5)])) == [0, 5, 15]
