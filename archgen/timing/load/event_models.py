"""Event models of what is activated, arrives and leaves, from what is known so far of the activities before it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from archgen.timing.figures.timing_values import UnknownCause, unite_causes
from archgen.timing.figures.value_arithmetic import UNLINKED_NOTE
from archgen.timing.load.event_streams import (
    EventStream,
    EventStreams,
    combine_all_of,
    delay_streams,
    keep_events_apart,
    merge_streams,
    streams_of_calls,
    take_every_nth,
    throttle_streams,
    written_streams,
)
from archgen.timing.load.thread_work import WorstResponse
from archgen.timing.system.timing_system import Activity, Arc, TimingSystem
from archgen.timing.system.trigger_graph import TriggerGraph

_ONE_CALL = Fraction(1)


_DOWNSTREAM_WORDS = {"overload": "unbounded"}
"""What a note becomes for those who read the output: what reads from an overload is not overloaded itself."""


@dataclass(slots=True)
class PropagationState:
    """What is known so far of each activity: its event model, and its worst response."""

    system: TimingSystem
    triggers: TriggerGraph
    event_models: dict[str, EventStreams | UnknownCause] = field(default_factory=dict)
    responses: dict[str, WorstResponse] = field(default_factory=dict)
    diverged: set[str] = field(default_factory=set)
    leaving_models: dict[str, EventStreams | UnknownCause] = field(default_factory=dict)
    """Event models of what leaves each activity; filled on demand by sent_models, once everything else is found."""


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
    needed_inputs = [key for key, arcs in inputs.items() if not is_always_present(state.system, arcs)]
    if not needed_inputs:
        renewed_inputs = find_renewed_inputs(state.system, inputs)
        return (
            _merge_models(input_model(state, activity, key, arcs) for key, arcs in renewed_inputs.items())
            if renewed_inputs
            else ()
        )
    input_models = [
        # An input that closes a ring: how often it comes rests on this activity itself. The others bound the rate.
        UnknownCause((activity.id,))
        if (activity.id, key) in state.triggers.open_inputs
        else input_model(state, activity, key, inputs[key])
        for key in needed_inputs
    ]
    known_models = [streams for streams in input_models if not isinstance(streams, UnknownCause)]
    # One input on which nothing ever comes is enough for all-of never to fire.
    if any(not streams for streams in known_models):
        return ()
    if not known_models:
        return unite_causes(cause for cause in input_models if isinstance(cause, UnknownCause))
    return combine_all_of(known_models, complete=len(known_models) == len(input_models))


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
    return _merge_models(arriving_model(state, arc, state.event_models[arc.source]) for arc in arcs)


def request_models(state: PropagationState, name: str) -> Iterator[EventStreams | UnknownCause]:
    """Yield the event models of the calls that arrive: they may come at any time while their caller runs."""
    for arc in state.triggers.requests[name]:
        event_model = state.event_models[arc.source]
        caller = state.system.activities[arc.source]
        if not isinstance(event_model, UnknownCause):
            yield arriving_model(
                state, arc, streams_of_calls(event_model, caller.calls.get(arc.output, _ONE_CALL)), from_start=True
            )
        else:
            yield event_model


def arriving_model(
    state: PropagationState, arc: Arc, event_model: EventStreams | UnknownCause, *, from_start: bool = False
) -> EventStreams | UnknownCause:
    """Return the event model behind a source's response and a link.

    With `from_start` the event may leave as soon as the source starts, not only after its best case.
    """
    if isinstance(event_model, UnknownCause) or not event_model:
        return event_model
    source, response = state.system.activities[arc.source], state.responses[arc.source]
    if response.value is None:
        return _downstream_cause(response.cause)
    if arc.worst is None:
        return UnknownCause((arc.link,)) if arc.link else UnknownCause((arc.source, arc.target), (UNLINKED_NOTE,))
    return delay_streams(
        _completion_streams(source, response.value, event_model, from_start=from_start), arc.worst - (arc.best or 0)
    )


def leaving_model(
    state: PropagationState, arc: Arc, event_model: EventStreams | UnknownCause, *, from_start: bool = False
) -> EventStreams | UnknownCause:
    """Return the event model behind a source's response, before any link."""
    if isinstance(event_model, UnknownCause) or not event_model:
        return event_model
    source, response = state.system.activities[arc.source], state.responses[arc.source]
    if response.value is None:
        return _downstream_cause(response.cause)
    return _completion_streams(source, response.value, event_model, from_start=from_start)


def _completion_streams(source: Activity, response: int, streams: EventStreams, *, from_start: bool) -> EventStreams:
    """Return the event model of completions: up to R - B later than activations, and at least B apart."""
    best_case = 0 if from_start else source.bcet or 0
    completed = delay_streams(streams, max(response - best_case, 0))
    # A declared response may rest on several executions at once: its completions are not known to be B apart.
    return keep_events_apart(completed, best_case) if source.response is None else completed


def _downstream_cause(cause: UnknownCause) -> UnknownCause:
    """Return the cause as those see it who read the output."""
    return UnknownCause(cause.missing, tuple(_DOWNSTREAM_WORDS.get(note, note) for note in cause.notes))


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
