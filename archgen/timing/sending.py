"""What is sent along an arc, before any link: samples, requests, answers, each with its event model."""

from __future__ import annotations

from fractions import Fraction

from archgen.timing.propagate import State, leaving
from archgen.timing.streams import Streams, called, late
from archgen.timing.system import Activity, Arc
from archgen.timing.value import Cause


def sent(state: State, arc: Arc) -> Streams | Cause:
    """Return the event model of what is sent along an arc, at its source."""
    if arc.role == "answer":
        return _answers(state, arc)
    events = state.events[arc.source]
    if isinstance(events, Cause):
        return events
    if arc.role == "data":
        return left(state, arc)
    return leaving(state, arc, called(events, calls(state.system.activities[arc.source], arc)), from_start=True)


def left(state: State, arc: Arc) -> Streams | Cause:
    """Return the event model of the samples that leave an arc's source.

    Cached by source in the state, so it must be asked only once propagation is done.
    """
    found = state.left.get(arc.source)
    if found is None:
        found = state.left[arc.source] = leaving(state, arc, state.events[arc.source])
    return found


def calls(caller: Activity, request: Arc) -> Fraction:
    """Return how many calls a client makes in each of its activations."""
    return caller.calls.get(request.output, Fraction(1))


def _answers(state: State, answer: Arc) -> Streams | Cause:
    """Return the answers to one client: as many as it asked for, each at most as much later as the server needs."""
    server, response = state.system.activities[answer.source], state.responses[answer.source]
    asking = state.system.into.get(server.id, ())
    request = next(a for a in asking if a.role == "request" and a.source == answer.target and a.topic == answer.topic)
    asked = sent(state, request)
    if isinstance(asked, Cause) or not asked:
        return asked
    if response.value is None:
        return response.cause
    if request.best is None or request.worst is None:
        return Cause((request.link or request.source,))
    spread = max(response.value - (server.bcet or 0), 0) + request.worst - request.best
    # A periodic server looks for calls when it runs: an answer waits up to one more of its gaps.
    if server.behaviour in {"event", "on_demand"}:
        return late(asked, spread)
    return Cause((server.id,)) if server.period is None else late(asked, spread + server.period + server.jitter)
