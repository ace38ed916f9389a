"""How long the callers of a service wait: each may find the calls of all others before its own."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from fractions import Fraction

from archgen.timing.analysis import Pace, Response, ServiceLoad
from archgen.timing.propagate import State
from archgen.timing.sending import calls
from archgen.timing.sums import known, times, total, unknown
from archgen.timing.system import Activity, Arc
from archgen.timing.value import Value

ONE_BY_ONE = "callers call again only when they have been answered"
"""The assumption under which K callers have at most K calls waiting."""


def service_loads(state: State, paces: Mapping[str, Pace], responses: Mapping[str, Response]) -> dict[str, ServiceLoad]:
    """Return for each server how long an answer takes, and what becomes of callers that wait for all of theirs."""
    asked: dict[str, list[Arc]] = {}
    for arc in state.system.arcs:
        if arc.role == "request":
            asked.setdefault(arc.target, []).append(arc)
    found: dict[str, ServiceLoad] = {}
    for server, arcs in asked.items():
        callers = tuple(dict.fromkeys(arc.source for arc in arcs))
        worst = _answer(state, state.system.activities[server], len(callers), paces[server], responses[server].worst)
        waits = {caller: _waiting(state, worst, [arc for arc in arcs if arc.source == caller]) for caller in callers}
        synchronous = {caller: total((responses[caller].worst, wait)) for caller, wait in waits.items()}
        found[server] = ServiceLoad(callers, worst, waits, synchronous)
    return found


def _answer(state: State, server: Activity, callers: int, pace: Pace, response: Value) -> Value:
    """Return the longest time to an answer: the server's response to all that is asked, and never less than K C."""
    tick = state.system.tick
    if server.behaviour not in {"event", "on_demand"}:  # it looks for calls when it runs, at worst one gap later
        response = total((pace.gap, response))
    if server.response is not None or server.wcet is None:
        return response if server.response is not None else unknown(server.id)
    one_each = Value(callers * server.wcet * tick)
    if known(response) and response.value is not None:
        return response if response.value >= (one_each.value or 0) else replace(response, value=one_each.value)
    # Its response is unbounded or unknown, but on a core of its own only the other callers' calls lie before one: K C,
    # as long as each of them waits for its answer.
    if server.host is None and server.behaviour in {"event", "on_demand"}:
        return replace(one_each, assumptions=("assuming a dedicated core", ONE_BY_ONE))
    return response


def _waiting(state: State, worst: Value, arcs: Iterable[Arc]) -> Value:
    """Return how long one activation of a caller waits for all answers, the links both ways included."""
    parts: list[Value] = []
    for arc in arcs:
        made = calls(state.system.activities[arc.source], arc)
        # A fraction of a call per activation means a whole one in some activations.
        number = -(-made.numerator // made.denominator)
        answer = next(a for a in state.system.out_of[arc.target] if a.role == "answer" and a.target == arc.source)
        parts += [times(one, number) for one in (worst, _way(state, arc), _way(state, answer))]
    return total(parts)


def _way(state: State, arc: Arc) -> Value:
    """Return the worst latency of an arc, in ns."""
    return unknown(arc.link or arc.source) if arc.worst is None else Value(Fraction(arc.worst * state.system.tick))
