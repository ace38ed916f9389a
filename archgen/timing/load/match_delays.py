"""Figures of inputs that are matched by time: how long their messages take, and how far apart they are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from archgen.frozen import NamedTuple
from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.event_streams import EventStream, EventStreams, collapse_streams, delay_streams
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.system.timing_system import Activity, Arc, best_response


class MatchedInput(NamedTuple):
    """An input that is matched, in ticks: the largest gap between the times of its messages, and how long they take."""

    gap: int
    best: int
    worst: int


class MatchWindows(NamedTuple):
    """What is sure of matched inputs, in ticks.

    `ages` are from the time of a message until the activation that uses it. `waits`, by input, are from the arrival of a
    message until an activation that uses it or a newer one, None where no match is sure. `gap` is the largest between two
    activations, None where no match is sure; `needed_within` is the least `within` for which one is.
    """

    ages: tuple[int, ...]
    waits: tuple[int, ...] | None
    gap: int | None
    needed_within: int


def find_match_windows(inputs: Sequence[MatchedInput], within: int, *, same_source: bool) -> MatchWindows:
    """Return what is sure of matched inputs; `same_source`: each message has its partners of the very same job."""
    if same_source or len(inputs) == 1:
        latest = max(each.worst for each in inputs)
        spread = latest - max(each.best for each in inputs)
        return MatchWindows(
            (latest,) * len(inputs),
            tuple(latest - each.best for each in inputs),
            max(each.gap for each in inputs) + spread,
            0,
        )
    proof = max(each.gap + each.worst for each in inputs)
    needed_within = sorted(each.gap for each in inputs)[-2]
    ages = (within + proof,) * len(inputs)
    # Equal times of different sources are a coincidence, however often they send.
    if within < needed_within or within == 0:
        return MatchWindows(ages, None, None, needed_within)
    reaches = [_latest_pivot(inputs, index, within) + proof for index in range(len(inputs))]
    return MatchWindows(
        ages,
        tuple(reach - each.best for reach, each in zip(reaches, inputs, strict=True)),
        min(each.gap + reach - each.best for reach, each in zip(reaches, inputs, strict=True)),
        needed_within,
    )


def _latest_pivot(inputs: Sequence[MatchedInput], index: int, within: int) -> int:
    """Return how much later than a message of an input the pivot of the first set is that holds it or a newer one."""
    other_gap = max(each.gap for number, each in enumerate(inputs) if number != index)
    return other_gap + max(within, inputs[index].gap)


DEFAULT_QUEUE = 10
"""How many messages of an input wait for those with which they are matched, where no depth is written."""


def has_same_source(state: PropagationState, inputs: Mapping[str, tuple[Arc, ...]]) -> bool:
    """Whether each message has its partners of the very same job: all inputs come from one activity that sends all."""
    arcs = [arc for input_arcs in inputs.values() for arc in input_arcs]
    if len(arcs) != len(inputs) or len({arc.source for arc in arcs}) != 1:
        return False
    source = state.system.activities[arcs[0].source]
    model = state.event_models[source.id]
    if isinstance(model, UnknownCause) or len(model) != 1 or not model[0].min_spacing:
        # Two jobs that begin at the same moment give the same time to different messages.
        return False
    return not any(arc.output in source.conditional for arc in arcs)


def find_matched_input(state: PropagationState, arcs: tuple[Arc, ...], gap: int | None) -> MatchedInput | None:
    """Return the figures of an input; None where they are not known, or where it has several sources."""
    # The messages of several sources may come in another order than that of their times.
    if len(arcs) != 1 or gap is None:
        return None
    arc, source = arcs[0], state.system.activities[arcs[0].source]
    response = state.responses[source.id].value
    is_reentrant = bool(source.executor) and source.callback_group is None
    if response is None or arc.worst is None or is_reentrant:
        return None
    best = min(best_response(source), response)
    return MatchedInput(gap, best + (arc.best or 0), response + arc.worst)


def find_stamp_gap(state: PropagationState, arc: Arc) -> int | None:
    """Return the largest gap (ticks) between the activations of a source at which it sends, where it is plain to see.

    That is so for what has a period of its own, and for what such a source fires, message by message.
    """
    gap, seen = 0, set[str]()
    while arc.source not in seen:
        seen.add(arc.source)
        source = state.system.activities[arc.source]
        if arc.role != "data" or arc.output in source.conditional:
            return None
        if source.period is not None:
            return gap + source.period + source.jitter
        firing_arcs = [each for arcs in state.triggers.inputs[source.id].values() for each in arcs]
        if source.every > 1 or source.throttle or len(firing_arcs) != 1 or source.id in state.triggers.never_firing:
            return None
        arc = firing_arcs[0]
        before = state.system.activities[arc.source]
        response = state.responses[before.id].value if before.id in state.responses else None
        if response is None or arc.worst is None or arc.input in state.system.external_inputs.get(source.id, ()):
            return None
        gap += source.jitter + max(response - best_response(before), 0) + arc.worst - (arc.best or 0)
    return None


def combine_matched(
    state: PropagationState,
    activity: Activity,
    inputs: Mapping[str, tuple[Arc, ...]],
    models: Mapping[str, EventStreams],
) -> EventStreams:
    """Return the event model of matches: each uses up one message of each input, which may have waited for a while.

    So there are in a window no more than come of an input in the window and the wait before it, nor more than come in the
    window and were in the input's queue. `models` are of the inputs that are known; each of them alone is a bound.
    """
    matched_inputs = [
        find_matched_input(state, arcs, find_stamp_gap(state, arcs[0]) if arcs else None) for arcs in inputs.values()
    ]
    known_inputs = [each for each in matched_inputs if each is not None]
    waits: dict[str, int] = {}
    if len(known_inputs) == len(inputs):
        windows = find_match_windows(known_inputs, activity.within or 0, same_source=has_same_source(state, inputs))
        waits = {key: age - each.best for key, age, each in zip(inputs, windows.ages, known_inputs, strict=True)}
    candidates: list[EventStream] = []
    for key, streams in models.items():
        stream = collapse_streams(streams)
        queue_wait = -(-queue_length(inputs[key]) * stream.period // (stream.events_per_period * stream.batch_size))
        candidates += delay_streams((stream,), min(waits.get(key, queue_wait), queue_wait))
    return (min(candidates, key=lambda stream: (stream.max_rate, stream.jitter)),)


def queue_length(arcs: tuple[Arc, ...]) -> int:
    """Return how many messages of an input wait: as many as its reader keeps, 10 where nothing is written."""
    return max((arc.depth or DEFAULT_QUEUE for arc in arcs), default=DEFAULT_QUEUE)
