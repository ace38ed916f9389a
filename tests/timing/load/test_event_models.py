"""Event models on their way from an activity to the next: in ticks, worked out by hand."""

from __future__ import annotations

from dataclasses import replace

import pytest

from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load import event_models
from archgen.timing.load.event_streams import EventStream
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.load.thread_work import OVERLOAD_CAUSE, WorstResponse
from archgen.timing.system.timing_system import Activity, Arc
from archgen.timing.system.trigger_graph import find_triggers
from tests.simulation.systems import arc, event, system, timed

SOURCE = timed("s", 100, 9, bcet=2, jitter=7)
LINK = arc("s", "t", best=1, worst=4)


def prepare(*activities: Activity, arcs: tuple[Arc, ...] = (LINK,)) -> PropagationState:
    """Return what is known when the source responds within 12 ticks."""
    made = system(activities, arcs)
    state = PropagationState(made, find_triggers(made))
    state.event_models["s"] = (EventStream(100, 7),)
    state.responses["s"] = WorstResponse(12, "host")
    return state


def test_what_is_written_is_the_model_of_a_periodic_activity() -> None:
    assert event_models.activation_model(prepare(SOURCE, event("t", 1, "s")), "s") == (EventStream(100, 7),)


def test_an_output_leaves_up_to_response_less_best_case_later() -> None:
    state = prepare(SOURCE, event("t", 1, "s"))
    leaving = event_models.leaving_model(state, LINK)
    assert not isinstance(leaving, UnknownCause)
    assert [(each.period, each.jitter) for each in leaving] == [(100, 7 + 12 - 2)]


@pytest.mark.parametrize(
    ("way", "jitter"),
    [
        (LINK, 17 + 4 - 1),
        (replace(LINK, best=None), 17 + 4),
        (replace(LINK, best=4), 17),
    ],
)
def test_a_link_adds_what_it_varies_by(way: Arc, jitter: int) -> None:
    arriving = event_models.arriving_model(prepare(SOURCE, event("t", 1, "s")), way)
    assert not isinstance(arriving, UnknownCause)
    assert [each.jitter for each in arriving] == [jitter]


def test_what_arrives_fires_an_event_driven_activity() -> None:
    state = prepare(SOURCE, event("t", 1, "s"))
    fired = event_models.activation_model(state, "t")
    assert fired == event_models.arriving_model(state, LINK)
    thinned = event_models.activation_model(prepare(SOURCE, event("t", 1, "s", every=3)), "t")
    assert not isinstance(thinned, UnknownCause)
    assert [each.period for each in thinned] == [300]


def test_a_link_without_latency_is_named_as_the_cause() -> None:
    state = prepare(SOURCE, event("t", 1, "s"))
    assert event_models.arriving_model(state, replace(LINK, worst=None, link="lan")) == UnknownCause(("lan",))
    assert event_models.arriving_model(state, replace(LINK, worst=None)) == UnknownCause(
        ("s", "t"), ("no link joins their hosts",)
    )


def test_behind_an_overload_the_output_is_unbounded() -> None:
    state = prepare(SOURCE, event("t", 1, "s"))
    state.responses["s"] = WorstResponse(None, "unknown", OVERLOAD_CAUSE)
    leaving = event_models.leaving_model(state, LINK)
    assert isinstance(leaving, UnknownCause)
    assert leaving.notes == ("unbounded",)


def test_an_activity_that_nothing_reaches_has_no_model() -> None:
    state = prepare(SOURCE, event("t", 1), arcs=())
    assert event_models.activation_model(state, "t") == UnknownCause(("t",))


def test_what_was_sent_once_stands_on_its_input() -> None:
    once = Activity("o", "o", None, "once", wcet=1, bcet=1)
    state = prepare(SOURCE, once, event("t", 1, "s", "o", mode="all"), arcs=(LINK, kept := arc("o", "t")))
    assert event_models.is_always_present(state.system, (kept,))
    assert not event_models.is_always_present(state.system, (LINK,))
    assert event_models.find_renewed_inputs(state.system, {"s": (LINK,), "o": (kept,)}) == {"s": (LINK,)}
