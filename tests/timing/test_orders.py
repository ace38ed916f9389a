"""Orders that can be written, held against published figures. Periods, execution times and deadlines are in ms.

`crate`: the tests of B. Brandenburg's response-time-analysis, whose figures are whole numbers of a unit of time: there what
blocks has begun a whole unit before, here an instant before.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import get_args

import pytest

from archgen.emit.terminal import timing_text
from archgen.timing.analysis import Analysis
from archgen.timing.figures.timing_values import ResponseTier
from archgen.timing.load import host_loads
from archgen.views.timing import timing_tables
from tests.timing.sketches import analyse_sketch

MS = 10**6
Task = tuple[float, float] | tuple[float, float, float]
"""Execution time, period, and deadline; the first of several is the most urgent by priority."""


def analyse_queue(tasks: Sequence[Task], order: str, place: str) -> Analysis:
    """Analyse tasks on one core, each a thread of its own (`core`), or in one thread (`thread`), in an order."""
    nodes = {}
    for at, (cost, period, *deadline) in enumerate(tasks):
        written_deadline = "".join(f", deadline: {value} ms" for value in deadline)
        head = f"t{at} {'@pc' if place == 'core' else '+box'}"
        nodes[head] = f"period: {period} ms, wcet: {cost} ms, priority: {len(tasks) - at}{written_deadline}"
    if place == "core":
        return analyse_sketch(nodes, rest=f"hosts: {{pc: {{cores: 1, scheduling: {order}}}}}")
    box = f"containers: {{box: {{threads: 1, host: pc, scheduling: {order}}}}}"
    return analyse_sketch(nodes, rest=f"hosts: {{pc: {{cores: 1}}}}\n{box}")


def responses_of(tasks: Sequence[Task], order: str, place: str) -> list[float]:
    """Return the responses in ms."""
    found = analyse_queue(tasks, order, place).responses.values()
    return [float((response.worst.value or 0) / MS) for response in found]


FIFO_SET: list[Task] = [(79, 120), (11, 34), (1, 190)]
FIFO_DEADLINES: list[Task] = [(79, 120, 50), (11, 34, 100), (1, 190, 120)]
BLASS_SET: list[Task] = [(10, 100), (230, 10000), (190, 1000)]


@pytest.mark.parametrize(
    ("tasks", "order", "place", "expected"),
    [
        # R. Davis, A. Burns, R. Bril, J. Lukkien, Controller Area Network (CAN) schedulability analysis: refuted,
        # revisited and revised, Real-Time Systems 35, 2007: the second instance of the third message takes 3.5 ms.
        ([(1, 2.5), (1, 3.5), (1, 3.5)], "non_preemptive", "core", [2, 3, 3.5]),
        ([(1, 2.5), (1, 3.5), (1, 3.5)], "non_preemptive", "thread", [2, 3, 3.5]),
        # crate, fp_np_rta_1: 54, 74, 75.
        ([(20, 70), (20, 80), (35, 200)], "non_preemptive", "core", [55, 75, 75]),
        # crate: FIFO on one processor.
        (FIFO_SET, "fifo", "core", [91, 91, 91]),
        (FIFO_SET, "fifo", "thread", [91, 91, 91]),
        # crate, edf_rta_fully_preemptive_ex1 and ex2.
        (FIFO_DEADLINES, "edf", "core", [79, 101, 121]),
        (
            [(1, 5, 5), (100, 1000, 1000), (2, 10, 10), (5, 20, 45), (10, 50, 50)],
            "edf",
            "core",
            [1, 694, 3, 22, 27],
        ),
        # crate, edf_rta_nonpreemptive_same_deadlines, _different_deadlines (89, 90, 121), _improved_bound (14, 15).
        ([(79, 120, 100), (11, 34, 100), (1, 190, 100)], "edf", "thread", [91, 91, 91]),
        (FIFO_DEADLINES, "edf", "thread", [90, 91, 121]),
        ([(5, 20, 29), (10, 20, 30)], "edf", "thread", [15, 15]),
        # T. Blass et al., A ROS 2 response-time analysis exploiting starvation freedom and execution-time variance,
        # RTSS 2021: 530, 440, 440 (round robin) and 430, 449, 449 (busy window). Any order: 470.
        (BLASS_SET, "ros2_executor", "thread", [470, 470, 470]),
        (BLASS_SET, "round_robin", "thread", [470, 470, 470]),
        (BLASS_SET, "fifo", "thread", [430, 430, 430]),
    ],
)
def test_published_figures(tasks: list[Task], order: str, place: str, expected: list[float]) -> None:
    assert responses_of(tasks, order, place) == expected


@pytest.mark.parametrize("order", ["non_preemptive", "fifo", "edf", "ros2_executor", "round_robin"])
def test_no_order_is_above_the_bound_of_any_order(order: str) -> None:
    tasks: list[Task] = [(3, 20), (7, 35), (11, 60), (2, 90)]
    any_order = responses_of(tasks, "round_robin", "thread")
    assert all(one <= other for one, other in zip(responses_of(tasks, order, "thread"), any_order, strict=True))


def test_what_comes_rarely_waits_for_two_rounds_of_the_executor() -> None:
    """Seven jobs of `a` may come at once. In each round one of them works: `b` waits for one round, and works in the next."""
    nodes = {"a +box": "period: 10 ms, jitter: 60 ms, wcet: 6 ms", "b +box": "period: 1 s, wcet: 2 ms"}
    rest = "hosts: {pc: {cores: 1}}\ncontainers: {box: {threads: 1, host: pc, scheduling: ORDER}}"
    in_rounds = analyse_sketch(nodes, rest=rest.replace("ORDER", "ros2_executor")).responses["b"]
    assert (in_rounds.worst.value, in_rounds.tier) == (16 * MS, "ros2_executor")
    any_order = analyse_sketch(nodes, rest=rest.replace("ORDER", "round_robin")).responses["b"]
    assert (any_order.worst.value, any_order.tier) == (98 * MS, "executor")


def test_a_tier_says_which_order_bounds() -> None:
    assert {response.tier for response in analyse_queue(FIFO_SET, "fifo", "core").responses.values()} == {"fifo"}
    assert {response.tier for response in analyse_queue(FIFO_SET, "fixed_priority", "core").responses.values()} == {
        "priorities"
    }


def test_a_thread_with_an_order_and_a_core_to_itself_keeps_its_tier() -> None:
    nodes = {
        "a +box": "period: 20 ms, wcet: 1 ms",
        "b +box": "period: 90 ms, wcet: 8 ms",
        "c @pc": "period: 9 ms, wcet: 1 ms",
    }
    rest = "hosts: {pc: {cores: 2}}\ncontainers: {box: {threads: 1, host: pc, scheduling: fifo}}"
    tiers = {name: response.tier for name, response in analyse_sketch(nodes, rest=rest).responses.items()}
    assert tiers == {"a": "executor", "b": "executor", "c": "cores"}  # 9 ms in any order as well
    nodes["a +box"], nodes["b +box"] = (
        "period: 20 ms, jitter: 40 ms, wcet: 4 ms",
        "period: 90 ms, wcet: 8 ms, priority: 1",
    )
    found = analyse_sketch(nodes, rest=rest.replace("fifo", "non_preemptive")).responses
    assert (found["b"].worst.value, found["b"].tier) == (12 * MS, "non_preemptive")


def test_every_tier_has_words_wherever_it_is_shown() -> None:
    tables = (host_loads._TIER_SENTENCES, timing_text._TIERS, timing_tables.TIER_WORDS)  # noqa: SLF001 - they are it
    assert all(set(table) == set(get_args(ResponseTier)) for table in tables)


def test_priorities_do_not_count_on_a_core_of_another_order() -> None:
    """Round robin may let the most urgent one wait for all others."""
    assert responses_of([(1, 10), (2, 20)], "fixed_priority", "core") == [1, 3]
    assert responses_of([(1, 10), (2, 20)], "round_robin", "core") == [3, 3]
    # Of a thread too: its callbacks never preempt one another.
    assert responses_of([(1, 10), (2, 20)], "non_preemptive", "thread") == [3, 3]


def test_callbacks_that_fire_one_another_keep_to_the_order() -> None:
    """In a thread that takes the most urgent first, `a` waits for the longest of the others, and not for `b` and `c`."""
    nodes = {
        "a +box": "period: 20 ms, wcet: 1 ms, bcet: 1 ms, priority: 9",
        "b +box": "period: 100 ms, wcet: 10 ms, bcet: 10 ms, priority: 5",
        "c +box": "behaviour: event, wcet: 8 ms, bcet: 8 ms, priority: 4",
    }
    rest = "hosts: {pc: {cores: 1}}\ncontainers: {box: {threads: 1, host: pc, scheduling: ORDER}}"
    in_order = analyse_sketch(nodes, "b>c", rest.replace("ORDER", "non_preemptive")).responses
    assert (in_order["a"].worst.value, in_order["a"].tier) == (11 * MS, "non_preemptive")
    any_order = analyse_sketch(nodes, "b>c", rest.replace("ORDER", "round_robin")).responses
    assert any_order["a"].worst.value == 19 * MS


@pytest.mark.parametrize(
    ("deadline", "verdict"),
    [("", "schedulable"), (", deadline: 30 ms", "schedulable"), (", deadline: 20 ms", "undecided")],
)
def test_the_verdict_of_a_host_holds_responses_against_deadlines(deadline: str, verdict: str) -> None:
    """Both take 25 ms at most, in any order, once in 100 ms."""
    nodes = {f"{name} @pc": f"period: 100 ms, wcet: {cost} ms{deadline}" for name, cost in (("a", 10), ("b", 15))}
    assert analyse_sketch(nodes, rest="hosts: {pc: {cores: 1}}").hosts["pc"].verdict == verdict
