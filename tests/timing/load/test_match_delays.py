"""Figures of inputs that are matched by time: in ticks, from what is written beside them, worked out by hand."""

from __future__ import annotations

from dataclasses import replace

import pytest

from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.event_models import (
    MatchedInput,
    MatchWindows,
    combine_matched,
    find_match_windows,
    find_matched_input,
    find_stamp_gap,
    has_same_source,
    queue_length,
)
from archgen.timing.load.event_streams import EventStream, EventStreams
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.load.thread_work import WorstResponse
from archgen.timing.system.timing_system import Activity, Arc
from archgen.timing.system.trigger_graph import find_triggers
from tests.simulation.systems import arc, event, system, timed

SLOW, FAST = MatchedInput(100, 1, 5), MatchedInput(30, 2, 4)


@pytest.mark.parametrize(
    ("within", "windows"),
    [
        # A message of each input is 100 + 5 after any time. The pivot is 30 + 100 later for the slow one, 100 + 40 for
        # the fast one, and known 105 later; the fast one matches 30 + 243 after the one before at the latest.
        (40, MatchWindows((145, 145), (234, 243), 273, 30)),
        (30, MatchWindows((135, 135), (234, 233), 263, 30)),
        (29, MatchWindows((134, 134), None, None, 30)),
    ],
)
def test_two_inputs_of_different_sources(within: int, windows: MatchWindows) -> None:
    assert find_match_windows([SLOW, FAST], within, same_source=False) == windows


def test_messages_of_one_job_are_complete_with_the_last_of_them() -> None:
    """At most 5 after the job begins, and no earlier than 2."""
    assert find_match_windows([SLOW, FAST], 0, same_source=True) == MatchWindows((5, 5), (4, 3), 103, 0)
    assert find_match_windows([SLOW], 0, same_source=False) == MatchWindows((5,), (4,), 104, 0)


def test_equal_times_of_different_sources_are_no_match_that_is_sure() -> None:
    inputs = [MatchedInput(0, 0, 3), MatchedInput(0, 0, 5)]
    assert find_match_windows(inputs, 0, same_source=False) == MatchWindows((5, 5), None, None, 0)
    assert find_match_windows(inputs, 1, same_source=False).gap == 6


@pytest.mark.parametrize(("depths", "length"), [((), 10), ((3,), 3), ((3, 7), 7), ((None,), 10), ((3, None), 10)])
def test_messages_that_wait_for_a_match(depths: tuple[int | None, ...], length: int) -> None:
    assert queue_length(tuple(arc("s", "fuse", depth=depth) for depth in depths)) == length


def prepare(source: Activity, *activities: Activity, arcs: tuple[Arc, ...] = ()) -> PropagationState:
    """Return what is known when everything responds within 12 ticks."""
    made = system((source, *activities), arcs)
    state = PropagationState(made, find_triggers(made))
    state.responses = {name: WorstResponse(12, "host") for name in made.activities}
    return state


SOURCE = timed("s", 100, 9, bcet=2, jitter=7, outputs=("out",))
TO_FUSE = arc("s", "fuse", best=1, worst=4)


@pytest.mark.parametrize(
    ("source", "to_fuse", "response", "expected"),
    [
        (SOURCE, TO_FUSE, 12, MatchedInput(50, 2 + 1, 12 + 4)),
        (SOURCE, TO_FUSE, 1, MatchedInput(50, 1 + 1, 1 + 4)),  # what is declared may be less than the best case
        (SOURCE, replace(TO_FUSE, best=None), 12, MatchedInput(50, 2, 16)),
        (SOURCE, replace(TO_FUSE, worst=None), 12, None),
        (SOURCE, TO_FUSE, None, None),
        (replace(SOURCE, executor="e"), TO_FUSE, 12, None),  # reentrant: a message may overtake the one before
        (replace(SOURCE, executor="e", callback_group="g"), TO_FUSE, 12, MatchedInput(50, 3, 16)),
    ],
)
def test_how_long_the_messages_of_an_input_take(
    source: Activity, to_fuse: Arc, response: int | None, expected: MatchedInput | None
) -> None:
    state = prepare(source)
    state.responses["s"] = WorstResponse(response, "host")
    assert find_matched_input(state, (to_fuse,), 50) == expected


def test_messages_of_several_sources_and_rare_ones_have_no_figures() -> None:
    state = prepare(SOURCE)
    assert find_matched_input(state, (TO_FUSE, TO_FUSE), 50) is None
    assert find_matched_input(state, (TO_FUSE,), None) is None


@pytest.mark.parametrize(
    ("source", "to_fuse", "gap"),
    [
        (SOURCE, TO_FUSE, 107),
        (SOURCE, replace(TO_FUSE, role="answer"), None),
        (replace(SOURCE, conditional=frozenset({"out"})), TO_FUSE, None),
        (replace(SOURCE, conditional=frozenset({"other"})), TO_FUSE, 107),
    ],
)
def test_gaps_of_what_has_a_period(source: Activity, to_fuse: Arc, gap: int | None) -> None:
    assert find_stamp_gap(prepare(source), to_fuse) == gap


FILTER = event("f", 3, "s", jitter=2, outputs=("out",))


@pytest.mark.parametrize(
    ("between", "to_filter", "response", "gap"),
    [
        # 107 of the source, 12 - 2 that it varies by, 4 - 1 of the link, and 2.
        (FILTER, arc("s", "f", best=1, worst=4), 12, 122),
        (FILTER, arc("s", "f", best=None, worst=4), 12, 123),
        (FILTER, arc("s", "f"), 1, 109),
        (FILTER, arc("s", "f", worst=None), 12, None),
        (FILTER, arc("s", "f"), None, None),
        (replace(FILTER, every=2), arc("s", "f"), 12, None),
        (replace(FILTER, throttle=50), arc("s", "f"), 12, None),
        (replace(FILTER, conditional=frozenset({"out"})), arc("s", "f"), 12, None),
    ],
)
def test_gaps_behind_a_filter(between: Activity, to_filter: Arc, response: int | None, gap: int | None) -> None:
    state = prepare(SOURCE, between, arcs=(to_filter,))
    state.responses["s"] = WorstResponse(response, "host")
    assert find_stamp_gap(state, arc("f", "fuse")) == gap


def test_gaps_of_a_filter_with_two_sources_or_one_outside_are_not_known() -> None:
    fired = replace(FILTER, triggers=("s", "t"))
    state = prepare(SOURCE, timed("t", 50, 1, outputs=("out",)), fired, arcs=(arc("s", "f"), arc("t", "f")))
    assert find_stamp_gap(state, arc("f", "fuse")) is None
    state = prepare(SOURCE, FILTER, arcs=(arc("s", "f"),))
    assert find_stamp_gap(state, arc("f", "fuse")) == 119
    state = replace(state, system=replace(state.system, external_inputs={"f": ("s",)}))
    assert find_stamp_gap(state, arc("f", "fuse")) is None


LEFT, RIGHT = replace(TO_FUSE, input="left"), replace(TO_FUSE, input="right", output="other")


@pytest.mark.parametrize(
    ("inputs", "model", "conditional", "expected"),
    [
        ({"left": (LEFT,), "right": (RIGHT,)}, (EventStream(100),), "", True),
        ({"left": (LEFT,)}, (EventStream(100),), "", True),
        ({"left": (LEFT,), "right": (RIGHT,)}, (EventStream(100), EventStream(100)), "", False),
        ({"left": (LEFT,), "right": (RIGHT,)}, (EventStream(100, 100),), "", False),  # two jobs may begin at once
        ({"left": (LEFT,), "right": (RIGHT,)}, UnknownCause(("s",)), "", False),
        ({"left": (LEFT,), "right": (RIGHT,)}, (EventStream(100),), "other", False),
        ({"left": (LEFT, LEFT), "right": (RIGHT,)}, (EventStream(100),), "", False),
        ({"left": (LEFT,), "right": (replace(RIGHT, source="t"),)}, (EventStream(100),), "", False),
    ],
)
def test_messages_of_the_very_same_job(
    inputs: dict[str, tuple[Arc, ...]],
    model: EventStreams | UnknownCause,
    conditional: str,
    expected: bool,  # noqa: FBT001
) -> None:
    state = prepare(replace(SOURCE, conditional=frozenset({conditional})), timed("t", 100, 1))
    state.event_models["s"] = model
    assert has_same_source(state, inputs) is expected


@pytest.mark.parametrize(
    ("depth", "known", "model"),
    [
        # A message of `a` matches when the set is complete, 40 + (100 + 5) after its time, and has come 1 after it.
        (None, ("a", "b"), EventStream(100, 144)),
        (None, ("b",), EventStream(30, 143)),
        # No more wait than the queue keeps.
        (1, ("a", "b"), EventStream(100, 100)),
        (1, ("b",), EventStream(30, 30)),
    ],
)
def test_matches_come_as_often_as_the_slower_input(
    depth: int | None, known: tuple[str, ...], model: EventStream
) -> None:
    models = {"a": (EventStream(100),), "b": (EventStream(30),)}
    fuse = event("fuse", 1, "a", "b", mode="match", within=40)
    inputs = {
        "a": (arc("a", "fuse", best=1, worst=5, depth=depth),),
        "b": (arc("b", "fuse", best=2, worst=4, depth=depth),),
    }
    state = prepare(timed("a", 100, 0), timed("b", 30, 0), fuse, arcs=(*inputs["a"], *inputs["b"]))
    state.responses = {name: WorstResponse(0, "host") for name in "ab"}
    assert combine_matched(state, fuse, inputs, {name: models[name] for name in known}) == (model,)
    state.responses["b"] = WorstResponse(None, "host")
    period = model.period
    queue_wait = (depth or 10) * period
    assert combine_matched(state, fuse, inputs, {name: models[name] for name in known}) == (
        EventStream(period, queue_wait),
    )


def test_a_full_queue_of_batches_is_as_old_as_it_takes_to_fill() -> None:
    """Six messages every 100 ticks, three at once, which is at most 50 sooner than one by one: ten come in 167."""
    fuse = event("fuse", 1, "a", mode="match", within=40)
    state = prepare(timed("a", 100, 0), fuse, arcs=(arc("a", "fuse"),))
    streams = (EventStream(100, events_per_period=2, batch_size=3),)
    inputs = {"a": (arc("a", "fuse", worst=None),)}
    assert combine_matched(state, fuse, inputs, {"a": streams}) == (EventStream(100, 50 + 167, 0, 6),)
