"""How often an activity works by itself, for its inputs, or for its callers: rate and largest gap."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from archgen.timing.analysis import Reason
from archgen.timing.figures.tick_unit import NS_PER_SECOND
from archgen.timing.figures.timing_values import ZERO_VALUE, TimingValue
from archgen.timing.figures.value_arithmetic import (
    NEVER_FIRES,
    UNBOUNDED_VALUE,
    add_values,
    multiply_value,
    unknown_value,
)
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.rates.rate_table import RateAndGap, RateTable, trigger_span
from archgen.timing.rates.triggered_rates import find_triggered_rate
from archgen.timing.system.thread_pools import may_skip_ticks
from archgen.timing.system.timing_system import Activity, Arc


def find_rate_and_gap(rates: RateTable, activity: Activity) -> tuple[RateAndGap, TimingValue | None, list[Reason]]:
    """Return an activity's rate and gap, by itself or from its inputs; the rate of the calls it answers; the reasons.

    The rate of calls is None where it serves none. Calls have no largest gap: nobody promises to call.
    """
    state = rates.state
    if activity.behaviour not in {"event", "on_demand"}:
        (rate, gap), reason = _own_rate(rates, activity)
        if rate.value is not None and may_skip_ticks(state.system, activity, state.responses[activity.id].value):
            skipping = Reason("skips ticks: the rate is not kept", activity.places.get("wcet", activity.at))
            return (replace(rate, side="at most"), gap), None, [reason, skipping]
        return (rate, gap), None, [reason]
    requests = state.triggers.requests[activity.id]
    call_rate = add_values(_call_rate(rates, arc) for arc in requests) if requests else None
    reasons = [_call_reason(rates, arc) for arc in requests]
    if activity.id in state.triggers.never_firing:
        return (
            (NEVER_FIRES, UNBOUNDED_VALUE),
            call_rate,
            [Reason("what it waits for never comes", trigger_span(activity))],
        )
    if activity.id in state.triggers.unknown_rates:
        return _ring_rate(state, activity), call_rate, [Reason("it lies in a ring of triggers", trigger_span(activity))]
    # On demand, calls are all that it does: its rate is theirs, and its gap is unknown.
    if activity.behaviour == "on_demand":
        reasons = reasons or [Reason("on demand, and nobody is known to call it", activity.at)]
        return (call_rate or unknown_value(activity.id), unknown_value(activity.id)), call_rate, reasons
    rate_and_gap, fired_reasons = find_triggered_rate(rates, activity)
    return rate_and_gap, call_rate, fired_reasons + reasons


def _own_rate(rates: RateTable, activity: Activity) -> tuple[RateAndGap, Reason]:
    """Return rate and gap of what is neither event-driven nor on demand, and the reason."""
    if activity.behaviour == "periodic":
        return periodic_rate(rates, activity), periodic_reason(rates, activity)
    if activity.behaviour == "once":
        # It works at the start only; all figures hold from when that is over.
        return (ZERO_VALUE, UNBOUNDED_VALUE), Reason("published once, at the start", activity.at)
    return (unknown_value(activity.id), unknown_value(activity.id)), Reason("nothing says when it runs", activity.at)


def _ring_rate(state: PropagationState, activity: Activity) -> RateAndGap:
    """Return rate and gap of an activity in a ring of triggers: unbounded where it runs for ever, else unknown."""
    is_endless = any(activity.id in ring for ring in state.triggers.endless_rings)
    value = UNBOUNDED_VALUE if is_endless else replace(unknown_value(activity.id), assumptions=("a ring of triggers",))
    return value, unknown_value(activity.id)


def periodic_rate(rates: RateTable, activity: Activity) -> RateAndGap:
    """Return rate and gap (T + J) of an activity that states its period itself."""
    if activity.period is None:
        return unknown_value(activity.id), unknown_value(activity.id)
    # Many activities share few periods: the same value objects are used again, and compare equal at once.
    key = activity.period, activity.jitter
    rate_and_gap = rates.written_rates.get(key)
    if rate_and_gap is None:
        rate = TimingValue(NS_PER_SECOND / (activity.period * rates.state.system.tick))
        rate_and_gap = rates.written_rates[key] = rate, rates.duration_value(activity.period + activity.jitter)
    return rate_and_gap


def periodic_reason(rates: RateTable, activity: Activity) -> Reason:
    """Return the reason for a stated period, and where it is written."""
    if activity.period is None:
        return Reason("periodic, but neither a period nor a rate is written", activity.at)
    tick = rates.state.system.tick
    span = activity.places.get("period", activity.places.get("rate", activity.at))
    if activity.jitter:
        durations = activity.period * tick, activity.jitter * tick
        return Reason("every {0}, up to {1} later, as written", span, durations)
    return Reason("every {0}, as written", span, (activity.period * tick,))


def _call_rate(rates: RateTable, arc: Arc) -> TimingValue:
    """Return the rate of calls along an arc."""
    calling = rates.state.system.activities[arc.source]
    # Of a caller of whose timing nothing is written, one call for each message that it reads would be a mere guess.
    if calling.behaviour_inferred and not calling.places:
        return unknown_value(arc.source)
    call_count = calling.calls.get(arc.output, Fraction(1))
    caller = rates.paces.get(arc.source)
    return multiply_value(caller.rate, call_count) if caller else unknown_value(arc.source)


def _call_reason(rates: RateTable, arc: Arc) -> Reason:
    """Return the reason for calls along an arc."""
    caller = rates.state.system.activities[arc.source]
    call_count = caller.calls.get(arc.output, Fraction(1))
    count_text = "once" if call_count == 1 else f"{float(call_count):g} times"
    span = caller.places.get("calls", arc.at) if arc.output in caller.calls else arc.at
    return Reason("called by {0}, {1} for each activation: {2}", span, (arc.source, count_text, _call_rate(rates, arc)))
