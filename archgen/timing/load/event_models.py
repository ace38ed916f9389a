"""Event models of what is activated, sent, arrives and leaves, from what is known so far of the activities before it.

Figures of inputs that are matched by time: how long their messages take, and how far apart they are.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction

from archgen.frozen import NamedTuple
from archgen.timing.figures.timing_values import UNLINKED_NOTE, UnknownCause, unite_causes
from archgen.timing.load.event_streams import (
    EventStream,
    EventStreams,
    collapse_streams,
    combine_all_of,
    delay_streams,
    keep_events_apart,
    merge_streams,
    streams_of_calls,
    take_every_nth,
    throttle_streams,
    written_streams,
)
from archgen.timing.load.level_cascades import EntryWay
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.load.thread_work import DIVERGED_CAUSE
from archgen.timing.system.thread_pools import is_reentrant
from archgen.timing.system.timing_system import (
    Activity,
    Arc,
    TimingSystem,
    best_response,
    calls_per_activation,
    find_request,
    is_taken_answer,
)


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


_DOWNSTREAM_WORDS = {"overload": "unbounded"}
"""What a note becomes for those who read the output: what reads from an overload is not overloaded itself."""


def activation_model(state: PropagationState, name: str) -> EventStreams | UnknownCause:
    """Return the event model of an activity's activations, from what fires it."""
    activity = state.system.activities[name]
    written_model = written_streams(activity)
    if written_model is not None:
        return written_model
    if name in state.triggers.never_firing:
        return ()
    if name in state.triggers.unknown_rates:
        return UnknownCause((name,), ("a ring of triggers",))
    if activity.behaviour == "event":
        return _event_driven_model(state, activity)
    if activity.behaviour == "on_demand" and state.triggers.requests[name]:
        return _merge_models(request_models(state, name))
    return UnknownCause((name,))


def _event_driven_model(state: PropagationState, activity: Activity) -> EventStreams | UnknownCause:
    """Return the event model of an event-driven activity: what its inputs fire, and the calls that it serves."""
    inputs = state.triggers.inputs[activity.id]
    request_streams = tuple(request_models(state, activity.id))
    if not inputs and not request_streams:
        return UnknownCause((activity.id,))
    data_model = _fired_model(state, activity, inputs) if inputs else ()
    if isinstance(data_model, UnknownCause):
        return data_model
    # Calls are not thinned: `every`, `throttle` and `jitter` are about triggers.
    fired_streams = (
        delay_streams(throttle_streams(take_every_nth(data_model, activity.every), activity.throttle), activity.jitter)
        if data_model
        else ()
    )
    return _merge_models((fired_streams, *request_streams))


def _fired_model(
    state: PropagationState, activity: Activity, inputs: Mapping[str, tuple[Arc, ...]]
) -> EventStreams | UnknownCause:
    """Return the event model of what triggers fire, before `every`, `throttle` and `jitter`."""
    if activity.mode == "any":
        return _merge_models(input_model(state, activity, key, arcs) for key, arcs in inputs.items())
    # A match uses up what was sent once as well: with that there is no second one.
    needed_inputs = [
        key for key, arcs in inputs.items() if activity.mode == "match" or not is_always_present(state.system, arcs)
    ]
    if not needed_inputs:
        renewed_inputs = find_renewed_inputs(state.system, inputs)
        return (
            _merge_models(input_model(state, activity, key, arcs) for key, arcs in renewed_inputs.items())
            if renewed_inputs
            else ()
        )
    input_models = {
        # An input that closes a ring: how often it comes rests on this activity itself. The others bound the rate.
        key: UnknownCause((activity.id,))
        if (activity.id, key) in state.triggers.open_inputs
        else input_model(state, activity, key, inputs[key])
        for key in needed_inputs
    }
    known_models = {key: streams for key, streams in input_models.items() if not isinstance(streams, UnknownCause)}
    # One input on which nothing ever comes is enough for all-of never to fire.
    if any(not streams for streams in known_models.values()):
        return ()
    if not known_models:
        return unite_causes(cause for cause in input_models.values() if isinstance(cause, UnknownCause))
    if activity.mode == "match":
        return combine_matched(state, activity, inputs, known_models)
    return combine_all_of(list(known_models.values()), complete=len(known_models) == len(input_models))


def is_always_present(system: TimingSystem, arcs: Iterable[Arc]) -> bool:
    """Whether something sent once stands on an input, so that it is always there."""
    return any(system.activities[arc.source].behaviour == "once" for arc in arcs)


def find_renewed_inputs(system: TimingSystem, inputs: Mapping[str, tuple[Arc, ...]]) -> dict[str, tuple[Arc, ...]]:
    """Return the inputs that something feeds beside what is sent once: where everything is always there, they fire."""
    return {
        key: arcs
        for key, arcs in inputs.items()
        if any(system.activities[arc.source].behaviour != "once" for arc in arcs)
    }


def input_model(
    state: PropagationState, activity: Activity, key: str, arcs: tuple[Arc, ...]
) -> EventStreams | UnknownCause:
    """Return the event model of what arrives at one input."""
    if not arcs or key in state.system.external_inputs.get(activity.id, ()):
        return UnknownCause((key,))
    return _merge_models(arriving_model(state, arc) for arc in arcs)


def request_models(state: PropagationState, name: str) -> Iterator[EventStreams | UnknownCause]:
    """Yield the event models of the calls that arrive: they may come at any time while their caller runs."""
    for arc in state.triggers.requests[name]:
        yield arriving_model(state, arc)


def arriving_model(state: PropagationState, arc: Arc) -> EventStreams | UnknownCause:
    """Return the event model of what comes over an arc: behind its source's response and a link."""
    leaving = leaving_model(state, arc)
    if isinstance(leaving, UnknownCause) or not leaving:
        return leaving
    if arc.worst is None:
        return UnknownCause((arc.link,)) if arc.link else UnknownCause((arc.source, arc.target), (UNLINKED_NOTE,))
    return delay_streams(leaving, arc.worst - (arc.best or 0))


def leaving_model(state: PropagationState, arc: Arc) -> EventStreams | UnknownCause:
    """Return the event model of what its source sends on an arc (data or a call), before any link."""
    if is_taken_answer(arc):
        return answer_model(state, arc)
    source, event_model = state.system.activities[arc.source], state.event_models[arc.source]
    calls = calls_per_activation(source, arc) if arc.role == "request" else None
    if isinstance(event_model, UnknownCause) or not event_model or (calls is not None and calls <= 0):
        return () if calls is not None and calls <= 0 else event_model
    response = state.responses[arc.source]
    bounded_ways = (
        (state.host_ways_to.get(arc.source, ()), state.transaction_ways.get(arc.source, ()))
        if source.response is None
        else ()
    )
    if arc.source in state.settled_ids and source.response is None:
        known_ways = state.transaction_ways.get(arc.source, ())
        return _stream_ways(state, source, known_ways, calls) if known_ways else DIVERGED_CAUSE
    if response.value is None:
        notes = (_DOWNSTREAM_WORDS.get(note, note) for note in response.cause.notes)
        return UnknownCause(response.cause.missing, tuple(notes))
    # What a declared response says goes for its output, whatever may be computed.
    ways = state.ways_to.get(arc.source, ()) if source.response is None else ()
    if (len(ways) == 1 and len(ways[0].steps) == 1) or any(way.delay is None for way in ways):
        ways = ()
    # Up to R - B later than activations.
    leaving = (
        _stream_ways(state, source, ways, calls)
        if ways
        else _complete_streams(state, source, event_model, calls, response.value)
    )
    # Over many cores delays add up on the way, while the host, or the way as a whole, bounds all of them together.
    others = [_stream_ways(state, source, each, calls) for each in bounded_ways if each]
    models = [model for model in (leaving, *others) if not isinstance(model, UnknownCause)]
    return min(models, key=lambda streams: max((stream.jitter for stream in streams), default=0), default=leaving)


def answer_model(state: PropagationState, answer: Arc) -> EventStreams | UnknownCause:
    """Return the answers to one client: as many as it asked for, each at most as much later as the server needs."""
    server, response = state.system.activities[answer.source], state.responses[answer.source]
    request = find_request(state.system, answer)
    request_model = leaving_model(state, request)
    if isinstance(request_model, UnknownCause) or not request_model:
        return request_model
    if response.value is None:
        return response.cause
    if request.worst is None:
        return UnknownCause((request.link or request.source,))
    # A best latency that is not written is 0, as everywhere: the least there can be, so that the spread is a bound.
    spread = max(response.value - best_response(server), 0) + request.worst - (request.best or 0)
    # A periodic server looks for calls when it runs: an answer waits up to one more of its gaps.
    if server.behaviour in {"event", "on_demand"}:
        return delay_streams(request_model, spread)
    return (
        UnknownCause((server.id,))
        if server.period is None
        else delay_streams(request_model, spread + server.period + server.jitter)
    )


def _stream_ways(
    state: PropagationState, source: Activity, ways: Iterable[EntryWay], calls: Fraction | None
) -> EventStreams | UnknownCause:
    """Return the event model of completions, or of calls, by the ways on which events reach their source."""
    streams: list[EventStream] = []
    for way in ways:
        entering = entering_model(state, way)
        if isinstance(entering, UnknownCause):
            return entering
        entering = streams_of_calls(entering, Fraction(way.multiplicity)) if way.multiplicity > 1 else entering
        streams += delay_streams(
            entering if calls is None else streams_of_calls(entering, calls),
            max((way.delay or 0) - way.best_before - _best_case(source, calls), 0),
        )
    return _keep_completions_apart(state, source, merge_streams(streams), calls)


def entering_model(state: PropagationState, way: EntryWay) -> EventStreams | UnknownCause:
    """Return the event model of what enters a core by a way."""
    if way.entry_arc is not None:
        # Looked up, for each of several ways back may lead to several ways on the core before, and so on.
        known_model = state.entering_models.get(id(way.entry_arc.arc))
        return arriving_model(state, way.entry_arc.arc) if known_model is None else known_model
    return state.event_models[str(way.entry.key)]


def _complete_streams(
    state: PropagationState, source: Activity, streams: EventStreams, calls: Fraction | None, response: int
) -> EventStreams:
    """Return the event model of completions, or of calls: up to R - B later than activations."""
    sent = streams if calls is None else streams_of_calls(streams, calls)
    sent = delay_streams(sent, max(response - _best_case(source, calls), 0))
    return _keep_completions_apart(state, source, sent, calls)


def _best_case(source: Activity, calls: Fraction | None) -> int:
    """Return how long after its activation something leaves at the earliest: a call as soon as its caller starts."""
    return best_response(source) if calls is None else 0


def _keep_completions_apart(
    state: PropagationState, source: Activity, streams: EventStreams, calls: Fraction | None
) -> EventStreams:
    """Keep completions at least B apart, where one activation ends before the next begins."""
    # A declared response may rest on several executions at once: its completions are not known to be B apart.
    if source.response is not None or is_reentrant(state.system, source):
        return streams
    return keep_events_apart(streams, _best_case(source, calls))


def _merge_models(models: Iterable[EventStreams | UnknownCause]) -> EventStreams | UnknownCause:
    """Merge event models: any of them fires. One unknown makes all unknown."""
    causes: list[UnknownCause] = []
    streams: list[EventStream] = []
    for model in models:
        if isinstance(model, UnknownCause):
            causes.append(model)
        else:
            streams += model
    return unite_causes(causes) if causes else merge_streams(streams)


def sent_model(state: PropagationState, arc: Arc) -> EventStreams | UnknownCause:
    """Return the event model of what is sent along an arc, at its source."""
    if arc.role == "answer":
        return answer_model(state, arc)
    return sample_model(state, arc) if arc.role == "data" else leaving_model(state, arc)


def sample_model(state: PropagationState, arc: Arc) -> EventStreams | UnknownCause:
    """Return the event model of the samples that leave an arc's source.

    Cached by source in the state, so it must be asked only once propagation is done.
    """
    model = state.leaving_models.get(arc.source)
    if model is None:
        model = state.leaving_models[arc.source] = leaving_model(state, arc)
    return model
