"""What an order makes of the ways on a core: in ticks, worked out by hand."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.busy_windows import SearchBudget
from archgen.timing.load.event_streams import EventStream, EventStreams
from archgen.timing.load.inner_triggers import InnerTriggers
from archgen.timing.load.level_cascades import EntryWay, EventOrigin
from archgen.timing.load.queue_orders import QueuedTask
from archgen.timing.load.queue_responses import CoreQueue, OrderedCore
from archgen.timing.load.thread_work import WorstResponse

ENTRY = EventOrigin("activity", "a")
OFTEN = (EventStream(100),)


def way(steps: str, delay: int | None, entry: EventOrigin = ENTRY, **rest: int) -> EntryWay:
    """Make a way of steps of one letter each."""
    return EntryWay(entry, None, tuple(steps), delay=delay, **rest)


def order_core(
    ways_to: Mapping[str, tuple[EntryWay, ...]],
    model: EventStreams | UnknownCause = OFTEN,
    *,
    silent: str = "",
) -> OrderedCore:
    """Return a thread in the order of arrival: `a`, which takes 3, fires `b`, which takes 5."""
    inner_triggers = InnerTriggers(("a", "b"), frozenset({"a"}), {}, {}, {}, frozenset(), frozenset(silent))
    queue = CoreQueue("fifo", is_core=False, tasks=(QueuedTask("a", 3, ()), QueuedTask("b", 5, ())))
    return OrderedCore(queue, inner_triggers, lambda _: model, dict(ways_to))


@pytest.mark.parametrize(
    ("ways", "model"),
    [
        ((way("a", 20),), (EventStream(100),)),
        # Up to 20 later, and at least 4 later: those of 16 ticks.
        ((way("ab", 50, best_before=4),), (EventStream(100, 16),)),
        ((way("ab", 50, best_before=20),), (EventStream(100),)),
        ((way("ab", 50, best_before=30),), (EventStream(100),)),
        # Twice each time.
        ((way("a", 20, multiplicity=2),), (EventStream(100, 0, 0, 1, 2),)),
        ((way("a", 20), way("ab", 50)), (EventStream(100), EventStream(100, 20))),
        ((way("b", 50, EventOrigin("activity", "b")),), UnknownCause(("b",))),  # behind a gate
        ((way("b", 50, EventOrigin("arc", 0)),), (EventStream(100),)),
    ],
)
def test_activations_come_behind_the_steps_before(
    ways: tuple[EntryWay, ...], model: EventStreams | UnknownCause
) -> None:
    assert order_core({"a": (way("a", 20),), "b": ways}).find_activation_model("b") == model


def test_activations_behind_what_is_not_known_are_not_known() -> None:
    unknown = UnknownCause(("b",))
    assert order_core({"a": (way("a", None),), "b": (way("ab", 50),)}).find_activation_model("b") == unknown
    ways_to = {"a": (way("a", 20),), "b": (way("ab", 50),)}
    assert order_core(ways_to, UnknownCause(("far",))).find_activation_model("b") == unknown
    assert order_core(ways_to, silent="b").find_activation_model("b") == ()


def test_the_step_before_is_that_of_the_same_entry() -> None:
    far = EventOrigin("arc", 0)
    ways_to = {"a": (way("a", 90, far), way("a", 20)), "b": (way("ab", 50),)}
    assert order_core(ways_to).find_activation_model("b") == (EventStream(100, 20),)


def test_an_order_limits_responses_and_no_ways() -> None:
    """Each waits for 3 + 5 at most."""
    ways_to = {"a": (way("a", 20),), "b": (way("ab", 50),)}
    core = order_core(ways_to)
    responses = {"a": WorstResponse(12, "executor"), "b": WorstResponse(6, "executor")}
    core.limit(responses, 1, SearchBudget())
    assert responses == {"a": WorstResponse(8, "fifo"), "b": WorstResponse(6, "executor")}
    assert core.ways_to == ways_to


def test_an_order_that_bounds_nothing_limits_nothing() -> None:
    ways_to = {"a": (way("a", 20),), "b": (way("ab", 50),)}
    core = order_core(ways_to, UnknownCause(("far",)))
    responses = {"a": WorstResponse(12, "executor"), "b": WorstResponse(60, "executor")}
    core.limit(responses, 1, SearchBudget())
    assert (core.ways_to, responses["a"].value, responses["b"].value) == (ways_to, 12, 60)
