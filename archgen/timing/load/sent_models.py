"""What is sent along an arc, before any link: samples, requests, answers, each with its event model."""

from __future__ import annotations

from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.event_models import leaving_model
from archgen.timing.load.event_streams import EventStreams, delay_streams
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.system.timing_system import Arc, best_response


def sent_model(state: PropagationState, arc: Arc) -> EventStreams | UnknownCause:
    """Return the event model of what is sent along an arc, at its source."""
    if arc.role == "answer":
        return _answer_model(state, arc)
    return sample_model(state, arc) if arc.role == "data" else leaving_model(state, arc)


def sample_model(state: PropagationState, arc: Arc) -> EventStreams | UnknownCause:
    """Return the event model of the samples that leave an arc's source.

    Cached by source in the state, so it must be asked only once propagation is done.
    """
    model = state.leaving_models.get(arc.source)
    if model is None:
        model = state.leaving_models[arc.source] = leaving_model(state, arc)
    return model


def _answer_model(state: PropagationState, answer: Arc) -> EventStreams | UnknownCause:
    """Return the answers to one client: as many as it asked for, each at most as much later as the server needs."""
    server, response = state.system.activities[answer.source], state.responses[answer.source]
    incoming_arcs = state.system.arcs_into.get(server.id, ())
    request = next(
        incoming
        for incoming in incoming_arcs
        if incoming.role == "request" and incoming.source == answer.target and incoming.topic == answer.topic
    )
    request_model = sent_model(state, request)
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
