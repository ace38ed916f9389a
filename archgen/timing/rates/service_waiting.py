"""How long the callers of a service wait: each may find the calls of all others before its own."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction

from archgen.frozen import replace
from archgen.timing.analysis import EventPace, ResponseTime, ServiceLoad
from archgen.timing.figures.timing_values import TimingValue, add_values, is_known_bound, multiply_value, unknown_value
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.system.timing_system import Activity, Arc, calls_per_activation

ONE_CALL_ASSUMPTION = "callers call again only when they have been answered"
"""The assumption under which K callers have at most K calls waiting."""


def find_service_loads(
    state: PropagationState, paces: Mapping[str, EventPace], responses: Mapping[str, ResponseTime]
) -> dict[str, ServiceLoad]:
    """Return for each server how long an answer takes, and what becomes of callers that wait for all of theirs."""
    requests_by_server: dict[str, list[Arc]] = {}
    for arc in state.system.arcs:
        if arc.role == "request":
            requests_by_server.setdefault(arc.target, []).append(arc)
    loads: dict[str, ServiceLoad] = {}
    for server, arcs in requests_by_server.items():
        callers = tuple(dict.fromkeys(arc.source for arc in arcs))
        worst = _answer_time(
            state, state.system.activities[server], len(callers), paces[server], responses[server].worst
        )
        waits = {
            caller: _waiting_time(state, worst, [arc for arc in arcs if arc.source == caller]) for caller in callers
        }
        synchronous = {caller: add_values((responses[caller].worst, wait)) for caller, wait in waits.items()}
        loads[server] = ServiceLoad(callers, worst, waits, synchronous)
    return loads


def _answer_time(
    state: PropagationState, server: Activity, callers: int, pace: EventPace, response: TimingValue
) -> TimingValue:
    """Return the longest time to an answer: the server's response to all that is asked, and never less than K C."""
    tick = state.system.tick
    if server.behaviour not in {"event", "on_demand"}:  # it looks for calls when it runs, at worst one gap later
        response = add_values((pace.gap, response))
    if server.response is not None or server.wcet is None:
        return response if server.response is not None else unknown_value(server.id)
    one_each = TimingValue(callers * server.wcet * tick)
    if is_known_bound(response) and response.value is not None:
        return response if response.value >= (one_each.value or 0) else replace(response, value=one_each.value)
    # Its response is unbounded or unknown, but on a core of its own only the other callers' calls lie before one: K C,
    # as long as each of them waits for its answer.
    if server.host is None and server.behaviour in {"event", "on_demand"}:
        return replace(one_each, assumptions=("assuming a dedicated core", ONE_CALL_ASSUMPTION))
    return response


def _waiting_time(state: PropagationState, worst: TimingValue, arcs: Iterable[Arc]) -> TimingValue:
    """Return how long one activation of a caller waits for all answers, the links both ways included."""
    durations: list[TimingValue] = []
    for arc in arcs:
        call_ratio = calls_per_activation(state.system.activities[arc.source], arc)
        # A fraction of a call per activation means a whole one in some activations.
        call_count = -(-call_ratio.numerator // call_ratio.denominator)
        answer = next(
            back_arc
            for back_arc in state.system.arcs_from[arc.target]
            if back_arc.role == "answer" and back_arc.target == arc.source
        )
        durations += [
            multiply_value(duration, call_count)
            for duration in (worst, _link_time(state, arc), _link_time(state, answer))
        ]
    return add_values(durations)


def _link_time(state: PropagationState, arc: Arc) -> TimingValue:
    """Return the worst latency of an arc, in ns."""
    return (
        unknown_value(arc.link or arc.source)
        if arc.worst is None
        else TimingValue(Fraction(arc.worst * state.system.tick))
    )
