"""Which responses the order of a queue bounds: in ticks, worked out by hand."""

from __future__ import annotations

from dataclasses import replace

import pytest

from archgen.model.declared_timing import SchedulingOrder
from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.busy_windows import SearchBudget
from archgen.timing.load.event_streams import EventStream, EventStreams
from archgen.timing.load.queue_orders import QueuedTask
from archgen.timing.load.queue_responses import CoreQueue, QueueOrder, find_core_queue
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.timing_system import Activity, Executor, ResourceUse
from tests.simulation.systems import event, stores, system, timed

A = QueuedTask("a", 3, (), priority=2, deadline=50)
B = QueuedTask("b", 5, (), priority=1, deadline=90)
MODELS: dict[str, EventStreams | UnknownCause] = {"a": (EventStream(100),), "b": (EventStream(200),)}


def bound(queue: CoreQueue, models: dict[str, EventStreams | UnknownCause], budget: int = 1000) -> dict[str, int]:
    """Return the responses in a busy period of 20 ticks."""
    bounds = queue.bound_responses(models.__getitem__, 20, SearchBudget(budget))
    return {name: each.response for name, each in bounds.items()}


@pytest.mark.parametrize(
    ("order", "is_core", "responses"),
    [
        ("fifo", False, {"a": 8, "b": 8}),
        ("fifo", True, {"a": 8, "b": 8}),
        ("non_preemptive", True, {"a": 8, "b": 8}),
        ("edf", True, {"a": 3, "b": 8}),
        ("edf", False, {"a": 8, "b": 8}),
        ("ros2_executor", False, {"a": 8 + 8, "b": 8 + 8}),
    ],
)
def test_each_order_has_a_bound_of_its_own(order: QueueOrder, is_core: bool, responses: dict[str, int]) -> None:  # noqa: FBT001
    assert bound(CoreQueue(order, is_core, (A, B)), MODELS) == responses


def test_what_is_alone_or_unknown_has_no_bound() -> None:
    queue = CoreQueue("fifo", is_core=False, tasks=(A, B))
    assert bound(queue, MODELS | {"b": UnknownCause(("b",))}) == {}
    assert bound(queue, MODELS | {"b": ()}) == {}
    assert bound(replace(queue, tasks=(A,)), MODELS) == {}
    assert bound(queue, MODELS, budget=0) == {}


def test_one_of_three_that_is_unknown_leaves_none_a_bound() -> None:
    queue = CoreQueue("fifo", is_core=False, tasks=(A, B, QueuedTask("c", 1, ())))
    assert bound(queue, MODELS | {"c": UnknownCause(("c",))}) == {}
    assert bound(queue, MODELS | {"c": ()}) == {}


def test_what_takes_no_time_need_not_be_known() -> None:
    tasks = (A, B, QueuedTask("c", 0, ()))
    queue = CoreQueue("fifo", is_core=False, tasks=tasks)
    assert bound(queue, MODELS | {"c": UnknownCause(("c",))}) == {"a": 8, "b": 8}
    assert bound(queue, MODELS | {"c": ()}) == {"a": 8, "b": 8}
    assert bound(queue, MODELS | {"c": (EventStream(300),)}) == {"a": 8, "b": 8, "c": 8}


@pytest.mark.parametrize(("period", "is_bounded"), [(7, False), (8, True)])
def test_several_callbacks_have_a_bound_where_no_two_wait_at_once(period: int, is_bounded: bool) -> None:  # noqa: FBT001
    """`b` responds within 8 ticks. On a thread the order of arrival is that of all callbacks."""
    models = MODELS | {"b": (EventStream(100 + period, 100),)}
    queue = CoreQueue("fifo", is_core=True, tasks=(A, B._replace(entities=2)))
    assert ("b" in queue.bound_responses(models.__getitem__, 1, SearchBudget())) is is_bounded
    in_thread = replace(queue, is_core=False)
    assert "b" in in_thread.bound_responses(models.__getitem__, 1, SearchBudget())


@pytest.mark.parametrize(
    ("order", "is_core", "stores"), [("fifo", False, True), ("fifo", True, False), ("edf", False, False)]
)
def test_messages_are_stored_in_time_by_a_thread_in_the_order_of_arrival(
    order: QueueOrder,
    is_core: bool,  # noqa: FBT001
    stores: bool,  # noqa: FBT001
) -> None:
    assert CoreQueue(order, is_core).stores_in_time is stores


ON_CORE = ProcessingResource("pc:0", "pc", 1, (("a",), ("b",)), core_set=(0,))
"""Two threads on one core."""
IN_THREAD = ProcessingResource("e", "pc", 1, (("a", "b"),))
TIMER = timed("a", 100, 3, host="pc", deadline=50, executor="e", callback_group="g")
SERVER = event("b", 5, host="pc", executor="e", callback_group="h", behaviour="on_demand")


def find_queue(
    resource: ProcessingResource, timer: Activity = TIMER, threads: int | None = 1, order: SchedulingOrder = "fifo"
) -> CoreQueue | None:
    """Return the queue of a core in an order, or of a thread by deadlines."""
    made = system(
        (timer, SERVER),
        cores={"pc": 1},
        host_orders={"pc": order},
        executors={"e": Executor("e", threads, "pc", "edf")},
    )
    return find_core_queue(made, resource, {"a": 7, "b": None})


def test_what_waits_for_a_core_or_for_a_thread() -> None:
    tasks = (QueuedTask("a", 3, (), 7, 50, is_timer=True), QueuedTask("b", 5, (), None, None))
    assert find_queue(ON_CORE) == CoreQueue("fifo", is_core=True, tasks=tasks)
    assert find_queue(IN_THREAD) == CoreQueue("edf", is_core=False, tasks=tasks)


def test_a_thread_of_one_callback_has_a_queue_too() -> None:
    queue = find_queue(replace(IN_THREAD, units=(("a",),)))
    assert queue is not None
    assert [task.name for task in queue.tasks] == ["a"]


def test_what_has_no_deadline_is_to_end_with_its_period() -> None:
    queue = find_queue(ON_CORE, replace(TIMER, deadline=None))
    assert queue is not None
    assert queue.tasks[0].deadline == 100


@pytest.mark.parametrize(
    "rest",
    [
        {"cores": 2},
        {"joined": True},
        {"missing": ("cores",)},
        {"foreign_units": (("b",),)},
        {"units": ()},
        {"host": None},
        {"core_set": (0, 1)},
        {"core_set": ()},
    ],
)
def test_where_more_than_one_queue_decides_there_is_none(rest: dict[str, object]) -> None:
    assert find_queue(replace(ON_CORE, **rest)) is None  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("timer", "is_queued"),
    [
        (replace(TIMER, wcet=None), False),
        (replace(TIMER, behaviour="once"), False),
        (replace(TIMER, behaviour="once", wcet=0), True),
        (replace(TIMER, wcet=0), True),
        (replace(TIMER, uses={"gpu": ResourceUse(1, 1)}), False),
    ],
)
def test_what_waits_in_a_queue_has_an_execution_time_alone(timer: Activity, is_queued: bool) -> None:  # noqa: FBT001
    assert (find_queue(ON_CORE, timer) is not None) is is_queued
    assert (find_queue(IN_THREAD, timer) is not None) is is_queued


def test_several_threads_are_no_queue() -> None:
    assert find_queue(IN_THREAD, threads=2) is None
    assert find_queue(ON_CORE, replace(TIMER, callback_group=None), threads=3) is None
    assert find_queue(ON_CORE, replace(TIMER, callback_group=None), threads=None) is None
    assert find_queue(ON_CORE, threads=None) is not None


@pytest.mark.parametrize(
    ("order", "is_queued"), [("fifo", False), ("edf", False), ("non_preemptive", True), ("fixed_priority", False)]
)
def test_messages_to_be_stored_hold_up_a_thread_unless_it_keeps_the_core(
    order: SchedulingOrder,
    is_queued: bool,  # noqa: FBT001
) -> None:
    """A thread that stores a message takes its turn with that, before the activation that is due."""
    assert (find_queue(ON_CORE, replace(TIMER, storing={"x": stores()}), order=order) is not None) is is_queued
    assert (find_queue(ON_CORE, order=order) is not None) is (order != "fixed_priority")
