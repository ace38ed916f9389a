"""What is sent along an arc, before any link: samples, requests, answers, each with its event model."""

from __future__ import annotations

from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.event_models import answer_model, leaving_model
from archgen.timing.load.event_streams import EventStreams
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.system.timing_system import Arc


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
