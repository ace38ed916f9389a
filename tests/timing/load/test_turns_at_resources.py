"""Turns at a resource: durations in ticks, worked out by hand."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

from archgen.model.declared_timing import SchedulingOrder
from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.busy_windows import SearchBudget
from archgen.timing.load.event_streams import EventStream
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.load.resource_waits import (
    Competitor,
    Rivals,
    bound_in_turn,
    find_load,
    find_rivals,
    find_turn_times,
    find_use_time,
    find_use_times,
    find_users,
)
from archgen.timing.load.thread_work import DIVERGED_CAUSE, OVERLOAD_CAUSE, WorstResponse
from archgen.timing.system.timing_system import Activity, Executor, ResourceUse, SharedResource, TimingSystem
from archgen.timing.system.trigger_graph import find_triggers
from tests.simulation.systems import system, timed


def user(name: str, use: int, place: str = "", priority: int | None = None) -> Activity:
    """Make what uses the GPU every 100 ticks: alone, in a container (`+box`), or in a process and group (`e/g`, `e/`)."""
    process, _, group = place.partition("/")
    container = place[1:] if place.startswith("+") else None
    executor = process if "/" in place else ""
    return timed(
        name,
        100,
        1,
        uses={"gpu": ResourceUse(use, use)},
        container=container,
        executor=executor,
        callback_group=group or None,
        priority=priority,
    )


def join(users: list[Activity], threads: int | None = 1, order: SchedulingOrder | None = "fifo") -> TimingSystem:
    """Return a system of users, `threads` those of the container `box` and of the process `e`."""
    return system(
        users,
        threads={"box": threads},
        executors={"e": Executor("e", threads, None)},
        resources={"gpu": SharedResource("gpu", "pc", order)},
    )


ALONE = [("a", 10, ""), ("b", 20, ""), ("c", 5, "")]
BOXED = [("a", 10, "+box"), ("b", 20, "+box"), ("d", 30, "+box"), ("c", 5, "")]
GROUPED = [("a", 10, "e/g"), ("b", 20, "e/g"), ("d", 7, "e/"), ("c", 5, "")]


@pytest.mark.parametrize(
    ("uses", "threads", "times"),
    [
        (ALONE, 1, {"a": 35, "c": 35}),
        # One member at a time, the longest, and none beside a member.
        (BOXED, 1, {"a": 10 + 5, "c": 5 + 30}),
        (BOXED, 2, {"a": 10 + 30 + 5, "d": 30 + 20 + 5, "c": 5 + 30 + 20}),
        (BOXED, None, {"a": 10 + 20 + 30 + 5, "c": 5 + 10 + 20 + 30}),
        # One of a group at a time; what is reentrant takes as many threads as there are.
        (GROUPED, 1, {"a": 10 + 5, "c": 5 + 20}),
        (GROUPED, 2, {"a": 10 + 7 + 5, "d": 7 + 20 + 5, "c": 5 + 20 + 7}),
        (GROUPED, 3, {"a": 10 + 7 + 7 + 5, "d": 7 + 20 + 7 + 5, "c": 5 + 20 + 7 + 7}),
        (GROUPED, None, {"a": None, "c": None}),
        (GROUPED[:2] + GROUPED[3:], None, {"a": 10 + 5, "c": 5 + 20}),
    ],
)
def test_one_use_of_each_other_thread_comes_before(
    uses: list[tuple[str, int, str]], threads: int | None, times: dict[str, int | None]
) -> None:
    made = join([user(*each) for each in uses], threads)
    names = find_users(made, "gpu")
    assert {name: bound_in_turn(made, "gpu", names)[name] for name in times} == times
    assert {name: find_turn_times(made)[name] for name in times} == times


def test_turns_are_known_in_the_order_of_arrival_alone() -> None:
    made = join([user(*each) for each in ALONE], order="fixed_priority")
    assert find_turn_times(made)["a"] is None
    assert find_turn_times(replace(made, resources={}))["a"] is None


def test_turns_at_two_resources_add_up() -> None:
    a, b = user("a", 10), user("b", 20)
    both = replace(a, uses={"gpu": ResourceUse(10, 10), "npu": ResourceUse(3, 3)})
    made = join([both, b])
    assert find_turn_times(made)["a"] is None
    made = replace(made, resources={key: SharedResource(key, "pc", "fifo") for key in ("gpu", "npu")})
    assert find_turn_times(made)["a"] == 10 + 20 + 3


def test_what_works_once_is_no_user() -> None:
    assert find_users(join([user("a", 10), replace(user("b", 20), behaviour="once")]), "gpu") == ("a",)


def prepare(made: TimingSystem, response: int = 40) -> PropagationState:
    """Return what is known when each comes every 100 ticks, and responds within some."""
    state = PropagationState(made, find_triggers(made))
    state.event_models = {name: (EventStream(100),) for name in made.activities}
    state.responses = {name: WorstResponse(response, "host") for name in made.activities}
    return state


@pytest.mark.parametrize(
    ("order", "name", "competitors", "blocking"),
    [
        ("fifo", "a", {20, 5}, 0),
        ("fixed_priority", "a", {20}, 5),
        ("fixed_priority", "b", set(), 10),  # the longest that is less urgent, once
        ("fixed_priority", "c", {10, 20}, 0),
    ],
)
def test_who_may_come_before(order: SchedulingOrder, name: str, competitors: set[int], blocking: int) -> None:
    made = join([user("a", 10, "", 2), user("b", 20, "", 3), user("c", 5)], order=order)
    rivals = find_rivals(prepare(made), (name,), "gpu")
    assert isinstance(rivals, Rivals)
    assert ({each.worst for each in rivals.competitors}, rivals.blocking) == (competitors, blocking)


def test_what_is_as_urgent_may_come_before() -> None:
    rivals = find_rivals(
        prepare(join([user("a", 10, "", 2), user("b", 20, "", 2)], order="fixed_priority")), "a", "gpu"
    )
    assert rivals == Rivals((Competitor("b", 20, (EventStream(100),), 40),), 0)


@pytest.mark.parametrize(
    ("uses", "threads", "own", "competitors"),
    [
        (BOXED, 1, ("a",), {5}),
        (BOXED, 2, ("a",), {20, 30, 5}),
        (GROUPED, 2, ("a",), {7, 5}),
        (GROUPED, 2, ("d",), {10, 20, 7, 5}),  # several of its own may wait at once
        (GROUPED, 2, ("a", "d"), {20, 5}),
    ],
)
def test_what_excludes_a_use_does_not_come_before_it(
    uses: list[tuple[str, int, str]], threads: int, own: tuple[str, ...], competitors: set[int]
) -> None:
    rivals = find_rivals(prepare(join([user(*each) for each in uses], threads)), own, "gpu")
    assert isinstance(rivals, Rivals)
    assert {each.worst for each in rivals.competitors} == competitors


def test_work_of_rivals_in_a_window() -> None:
    """Every 100 ticks, up to 50 later: twice in 51 ticks."""
    rivals = Rivals((Competitor("other", 20, (EventStream(100),), 50), Competitor("more", 5, (EventStream(10),), 0)), 7)
    assert [rivals.work_within(window) for window in (1, 50, 51)] == [25, 20 + 25, 40 + 30]
    assert rivals.share == Fraction(7, 10)


@pytest.mark.parametrize(
    ("order", "name", "time"),
    [
        # What came up to its response of 40 before: in 35 + 40 ticks one of each.
        (None, "a", 35),
        ("fixed_priority", "a", 35),
        ("fixed_priority", "b", 30),  # blocked by 10 once
        ("fifo", "c", 35),
    ],
)
def test_a_use_waits_for_all_that_may_come_before_it(order: SchedulingOrder | None, name: str, time: int) -> None:
    state = prepare(join([user("a", 10, "", 2), user("b", 20, "", 3), user("c", 5)], order=order))
    assert find_use_time(state, name, "gpu", SearchBudget()) == time
    assert find_use_times(state, name, SearchBudget()) == time


def test_uses_that_may_have_waited_long_come_more_often() -> None:
    """In 35 + 70 ticks two of each: 10 + 40 + 10, and still two in 60 + 70. In the order of arrival one of each."""
    uses = [user(*each) for each in ALONE]
    assert find_use_time(prepare(join(uses, order=None), 70), "a", "gpu", SearchBudget()) == 60
    assert find_use_time(prepare(join(uses), 70), "a", "gpu", SearchBudget()) == 35


def test_what_never_comes_takes_no_turn() -> None:
    state = prepare(join([user(*each) for each in ALONE]))
    state.event_models["b"] = ()
    assert find_use_time(state, "a", "gpu", SearchBudget()) == 15


def test_why_a_use_is_not_bounded() -> None:
    uses = [user(*each) for each in ALONE]
    unknown = UnknownCause(("b",))
    state = prepare(join(uses, order=None))
    state.event_models["b"] = unknown
    assert find_use_time(state, "a", "gpu", SearchBudget()) == unknown
    assert find_load(state, "gpu") == Fraction(15, 100)
    state = prepare(join(uses, order=None))
    state.responses["b"] = WorstResponse(None, "host")
    assert find_use_time(state, "a", "gpu", SearchBudget()) == DIVERGED_CAUSE
    state.responses["b"] = WorstResponse(None, "unknown", unknown)
    assert find_use_time(state, "a", "gpu", SearchBudget()) == unknown
    del state.responses["b"]
    assert find_use_time(state, "a", "gpu", SearchBudget()) == DIVERGED_CAUSE
    state.work_ends["b"] = WorstResponse(40, "host")
    assert find_use_time(state, "a", "gpu", SearchBudget()) == 35
    assert find_use_time(state, "a", "gpu", SearchBudget(0)) == DIVERGED_CAUSE


@pytest.mark.parametrize(
    ("uses", "order", "time"),
    [
        ((10, 60, 31), None, OVERLOAD_CAUSE),
        # In 460 + 40 ticks five of each other: 10 + 5 x 90.
        ((10, 59, 31), None, 460),
        ((10, 59, 31), "fifo", 100),
        # Nothing is left for what takes no time.
        ((0, 60, 40), None, DIVERGED_CAUSE),
        ((0, 60, 40), "fifo", 100),
    ],
)
def test_a_resource_that_is_full(
    uses: tuple[int, int, int], order: SchedulingOrder | None, time: int | UnknownCause
) -> None:
    state = prepare(join([user(name, use) for name, use in zip("abc", uses, strict=True)], order=order))
    assert find_use_time(state, "a", "gpu", SearchBudget()) == time


def test_what_cannot_end_is_not_searched_for() -> None:
    budget = SearchBudget()
    state = prepare(join([user(name, use) for name, use in zip("abc", (0, 60, 40), strict=True)], order=None))
    find_use_time(state, "a", "gpu", budget)
    assert budget.spent_terms == 0


def test_each_look_costs_two_terms_for_each_rival_and_one() -> None:
    """Looks at 10 + 20 + 5 and once more, each of two rivals."""
    budget = SearchBudget()
    assert find_use_time(prepare(join([user(*each) for each in ALONE], order=None)), "a", "gpu", budget) == 35
    assert budget.spent_terms == 2 * (2 * 2 + 1)
