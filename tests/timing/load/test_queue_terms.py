"""How responses in queues come about: by hand, in ms."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.busy_windows import SearchBudget
from archgen.timing.load.core_terms import explain_queue_bound
from archgen.timing.load.event_streams import EventStream, EventStreams
from archgen.timing.load.queue_orders import QueuedTask
from archgen.timing.load.queue_responses import CoreQueue, QueueOrder
from archgen.timing.load.work_terms import CountFormulas

A = QueuedTask("a", 3, (), priority=2, deadline=20)
B = QueuedTask("b", 5, (), priority=1, deadline=90)
C = QueuedTask("c", 2, (), priority=3, deadline=30)
LATE = QueuedTask("late", 4, ())
"""Without a priority, and without a deadline."""
BURST = (EventStream(20, 19),)
"""Two may come within 1 ms."""
MODELS: dict[str, EventStreams | UnknownCause] = {
    "a": (EventStream(10),),
    "b": (EventStream(40),),
    "c": (EventStream(20, 5),),
    "late": (EventStream(100),),
}


def explain(queue: CoreQueue, name: str, models: dict[str, EventStreams | UnknownCause]) -> list[str]:
    """Return the response that the analysis finds, and the work that gives it."""
    bound = queue.bound_responses(models.__getitem__, 1000, SearchBudget())[name]
    working = explain_queue_bound(bound, CountFormulas(Fraction(10**6)))
    assert (working.is_consistent, working.is_queue, working.value) == (True, True, bound.response)
    assert all(term.events.formula == str(term.events.number) for term in working.terms if term.reason == "its own")
    terms = [
        f"{term.events.number} x {' + '.join(f'{cost} {part}' for part, cost in term.parts)}, {term.reason}"
        for term in working.terms
    ]
    return [f"{working.window} - {working.arrival} = {bound.response}", *terms]


@pytest.mark.parametrize(
    ("order", "is_core", "name", "lines"),
    [
        (
            "fifo",
            False,
            "b",
            [
                "10 - 0 = 10",
                "1 x 3 a, those that come until 0 ms",
                "1 x 5 b, those that come until 0 ms",
                "1 x 2 c, those that come until 0 ms",
            ],
        ),
        (
            "non_preemptive",
            True,
            "a",
            [
                "10 - 0 = 10",
                "1 x 5 b, which may just have begun",
                "1 x 3 a, its own",
                "1 x 2 c, those that come until 7 ms",
            ],
        ),
        (
            "non_preemptive",
            True,
            "b",
            [
                "10 - 0 = 10",
                "1 x 5 b, its own",
                "1 x 3 a, those that come until 5 ms",
                "1 x 2 c, those that come until 5 ms",
            ],
        ),
        ("non_preemptive", True, "c", ["7 - 0 = 7", "1 x 5 b, which may just have begun", "1 x 2 c, its own"]),
        ("edf", True, "a", ["3 - 0 = 3", "1 x 3 a, its own"]),
        (
            "edf",
            True,
            "b",
            [
                "10 - 0 = 10",
                "1 x 5 b, its own",
                "1 x 3 a, those that come until 9 ms",
                "1 x 2 c, those that come until 9 ms",
            ],
        ),
        ("edf", True, "c", ["5 - 0 = 5", "1 x 2 c, its own", "1 x 3 a, those that come until 4 ms"]),
        ("edf", False, "a", ["8 - 0 = 8", "1 x 3 a, its own", "1 x 5 b, which may just have begun"]),
        (
            "edf",
            False,
            "b",
            [
                "10 - 0 = 10",
                "1 x 5 b, its own",
                "1 x 3 a, those that come until 5 ms",
                "1 x 2 c, those that come until 5 ms",
            ],
        ),
        (
            "ros2_executor",
            False,
            "c",
            ["30 - 0 = 30", "3 x 3 a + 5 b + 2 c, in each round"],
        ),
    ],
)
def test_the_work_before_the_end_of_an_activation_is_listed(
    order: QueueOrder,
    is_core: bool,  # noqa: FBT001
    name: str,
    lines: list[str],
) -> None:
    assert explain(CoreQueue(order, is_core, (A, B, C)), name, MODELS) == lines


@pytest.mark.parametrize(
    ("order", "is_core", "lines"),
    [
        ("fifo", False, ["11 - 1 = 10", "2 x 3 a, those that come until 1 ms", "1 x 5 b, those that come until 1 ms"]),
        ("non_preemptive", True, ["11 - 1 = 10", "1 x 5 b, which may just have begun", "2 x 3 a, its own"]),
        ("edf", True, ["6 - 1 = 5", "2 x 3 a, its own"]),
        ("edf", False, ["11 - 1 = 10", "2 x 3 a, its own", "1 x 5 b, which may just have begun"]),
    ],
)
def test_the_second_of_two_that_come_together_waits_for_the_first(
    order: QueueOrder,
    is_core: bool,  # noqa: FBT001
    lines: list[str],
) -> None:
    assert explain(CoreQueue(order, is_core, (A, B)), "a", MODELS | {"a": BURST}) == lines


def test_what_has_no_priority_or_deadline_is_behind_all_by_priority_and_may_be_first_by_deadlines() -> None:
    tasks = (A, LATE)
    assert explain(CoreQueue("non_preemptive", is_core=True, tasks=tasks), "a", MODELS) == [
        "7 - 0 = 7",
        "1 x 4 late, which may just have begun",
        "1 x 3 a, its own",
    ]
    assert explain(CoreQueue("edf", is_core=True, tasks=tasks), "a", MODELS) == [
        "7 - 0 = 7",
        "1 x 3 a, its own",
        "1 x 4 late, those that come until 6 ms",
    ]


def test_of_one_priority_each_may_be_first() -> None:
    equal = B._replace(priority=2)
    assert explain(CoreQueue("non_preemptive", is_core=True, tasks=(A, equal)), "a", MODELS) == [
        "8 - 0 = 8",
        "1 x 3 a, its own",
        "1 x 5 b, those that come until 5 ms",
    ]


def test_of_one_deadline_each_may_be_first() -> None:
    equal = B._replace(deadline=20)
    assert explain(CoreQueue("edf", is_core=False, tasks=(A, equal)), "a", MODELS) == [
        "8 - 0 = 8",
        "1 x 3 a, its own",
        "1 x 5 b, those that come until 0 ms",
    ]
