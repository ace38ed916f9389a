"""How often activities are activated and outputs published: rates and largest gaps, each with its reasons."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from archgen.frozen import replace
from archgen.timing.analysis import EventPace, Reason, ResponseTime
from archgen.timing.figures.tick_unit import NS_PER_SECOND
from archgen.timing.figures.timing_values import (
    NEVER_FIRES,
    UNBOUNDED_VALUE,
    UNKNOWN_VALUE,
    ZERO_VALUE,
    TimingValue,
    UnknownCause,
    add_values,
    is_boundless,
    multiply_value,
    unknown_value,
    value_of_cause,
)
from archgen.timing.load.event_streams import EventStreams, collapse_streams
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.rates.triggered_rates import RateAndGap, RateTable, find_triggered_rate, trigger_span
from archgen.timing.system.thread_pools import may_skip_ticks
from archgen.timing.system.timing_system import Activity, Arc, best_response


def find_rates(state: PropagationState, responses: Mapping[str, ResponseTime]) -> RateTable:
    """Find the pace of every activity and output, sources first.

    Last comes what the inputs would give those activities that state a period of their own (`RateTable.derived`).
    """
    rates = RateTable(state, responses)
    # Looked at after the loop, since they do not wait for their inputs in the order, which may come later in it.
    stated_activities: list[Activity] = []
    for name in state.triggers.order:
        activity = state.system.activities[name]
        if activity.period is not None and activity.behaviour != "periodic":
            stated_activities.append(activity)
            pace, call_rate = _stated_pace(rates, activity), None
            rate_and_gap = pace.rate, pace.gap
        else:
            rate_and_gap, call_rate, reasons = find_rate_and_gap(rates, activity)
            pace = _build_pace(rates, activity, rate_and_gap, call_rate, tuple(reasons))
        rates.paces[name] = pace
        _find_output_paces(rates, activity, rate_and_gap, call_rate)
    for activity in stated_activities:
        rate_and_gap, call_rate, reasons = find_rate_and_gap(rates, activity)
        rates.derived[activity.id] = _build_pace(rates, activity, rate_and_gap, call_rate, tuple(reasons))
    return rates


def _build_pace(
    rates: RateTable,
    activity: Activity,
    rate_and_gap: RateAndGap,
    call_rate: TimingValue | None,
    reasons: tuple[Reason, ...],
) -> EventPace:
    """Return the pace of an activity; calls that it answers count as activations."""
    rate, gap = rate_and_gap
    total_rate = (
        rate if call_rate is None else call_rate if activity.behaviour == "on_demand" else add_values((rate, call_rate))
    )
    jitter, distance = _event_shape(rates, rates.state.event_models[activity.id])
    return EventPace(activity.behaviour, total_rate, gap, jitter, distance, activity.period is None, reasons)


def _stated_pace(rates: RateTable, activity: Activity) -> EventPace:
    """Return the pace that an activity states although its inputs fire it."""
    rate_and_gap = periodic_rate(rates, activity)
    jitter, distance = _event_shape(rates, rates.state.event_models[activity.id])
    reasons = (periodic_reason(rates, activity),)
    return EventPace(activity.behaviour, *rate_and_gap, jitter, distance, inferred=False, reasons=reasons)


def _event_shape(rates: RateTable, event_model: EventStreams | UnknownCause) -> tuple[TimingValue, TimingValue]:
    """Return jitter and smallest gap of an event model, in ns."""
    if isinstance(event_model, UnknownCause):
        return value_of_cause(event_model), value_of_cause(event_model)
    if not event_model:
        return ZERO_VALUE, UNBOUNDED_VALUE
    stream = collapse_streams(event_model)
    # The spacing of a collapsed stream says nothing of the streams it was made of.
    distance = stream.min_spacing if len(event_model) == 1 else 0
    return rates.duration_value(stream.jitter), rates.duration_value(distance)


def _find_output_paces(
    rates: RateTable, activity: Activity, rate_and_gap: RateAndGap, call_rate: TimingValue | None
) -> None:
    """Find how often each output is published: at each activation, R - B later, unless it is conditional."""
    pace, name = rates.paces[activity.id], activity.id
    spread = _response_spread(rates, activity) if activity.outputs else ZERO_VALUE
    shape = _delayed_shape(rates, activity, pace, spread) if activity.outputs else (ZERO_VALUE, ZERO_VALUE)
    # Made once for all plain outputs: they are equal.
    usual_pace: EventPace | None = None
    if call_rate is not None and activity.behaviour == "event":
        rate_and_gap = (
            add_values((rate_and_gap[0], call_rate)),
            rate_and_gap[1],
        )  # a call activates it as well, and publishes
    for key in activity.outputs:
        is_served = (name, key) in rates.state.system.served_outputs
        output_rate = (call_rate or unknown_value(name), unknown_value(name)) if is_served else rate_and_gap
        if key in activity.conditional:
            rates.outputs[name, key] = _conditional_pace(rates, activity, key, pace, (output_rate[0], spread))
        elif is_served:
            rates.outputs[name, key] = _delayed_pace(pace, output_rate, spread, shape)
        else:
            usual_pace = usual_pace or _delayed_pace(pace, rate_and_gap, spread, shape)
            rates.outputs[name, key] = usual_pace


def _delayed_shape(
    rates: RateTable, activity: Activity, pace: EventPace, spread: TimingValue
) -> tuple[TimingValue, TimingValue]:
    """Return jitter and smallest gap of what comes up to `spread` later; in ticks, where everything is known."""
    event_model, delay = rates.state.event_models[activity.id], _longest_delay(rates, activity)
    if isinstance(event_model, UnknownCause) or not event_model or delay is None:
        return add_values((pace.jitter, spread)), _unsure_distance(pace)
    stream = collapse_streams(event_model)
    distance = stream.min_spacing if len(event_model) == 1 else 0
    return rates.duration_value(stream.jitter + delay), rates.duration_value(max(distance - delay, 0))


def _delayed_pace(
    pace: EventPace, rate_and_gap: RateAndGap, spread: TimingValue, shape: tuple[TimingValue, TimingValue]
) -> EventPace:
    """Return the pace of what comes up to `spread` later than it might."""
    rate, gap = rate_and_gap
    if spread.value == 0:
        return EventPace(pace.behaviour, rate, gap, pace.jitter, pace.distance, pace.inferred)
    gap = gap if gap.value is None else add_values((gap, spread))
    return EventPace(pace.behaviour, rate, gap, *shape, pace.inferred)


def _conditional_pace(
    rates: RateTable, activity: Activity, key: str, pace: EventPace, rate_and_spread: RateAndGap
) -> EventPace:
    """Return the pace of a conditional output: between never and the given rate, with the promised gap, if any."""
    rate, spread = rate_and_spread
    promised_ticks = activity.max_gaps.get(key)
    gap = (
        UNBOUNDED_VALUE
        if promised_ticks is None
        else _promised_gap(rates.duration_value(promised_ticks), pace.gap, spread)
    )
    note = "conditional: between none and this"
    upper_rate = (
        replace(rate, side="at most", assumptions=(*rate.assumptions, note)) if rate.value is not None else rate
    )
    span = activity.places.get("outputs", activity.at)
    return replace(
        pace, rate=upper_rate, gap=gap, distance=ZERO_VALUE, reasons=(Reason(f"{key} is conditional", span),)
    )


def _promised_gap(promised_gap: TimingValue, gap: TimingValue, spread: TimingValue) -> TimingValue:
    """Return the gap that an output promises, unless the activity's own gap is larger.

    Nothing is sent more often than its activity works.
    """
    completion_gap = spread if is_boundless(spread) else add_values((gap, spread))
    if is_boundless(spread) or (completion_gap.value is not None and completion_gap.value > (promised_gap.value or 0)):
        return completion_gap
    return replace(promised_gap, assumptions=("promised",))


def _response_spread(rates: RateTable, activity: Activity) -> TimingValue:
    """Return how much later than the earliest an output can be, in ns, or what is missing of it."""
    delay = _longest_delay(rates, activity)
    return replace(rates.responses[activity.id].worst, value=None) if delay is None else rates.duration_value(delay)


def _longest_delay(rates: RateTable, activity: Activity) -> int | None:
    """Return R - B in ticks, None where there is no response. A best case that nobody wrote counts as 0."""
    worst = rates.state.responses[activity.id].value
    return None if worst is None else max(worst - best_response(activity), 0)


def _unsure_distance(pace: EventPace) -> TimingValue:
    """Return the smallest gap of what comes later by an unknown time: none, unless nothing or who knows what comes."""
    if pace.distance.value is None:
        return UNKNOWN_VALUE if not pace.distance.complete else pace.distance
    return ZERO_VALUE


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
    calling = rates.state.system.activities[arc.source]
    # Of a caller of whose timing nothing is written, one call for each message that it reads would be a mere guess.
    if calling.behaviour_inferred and not calling.places:
        return unknown_value(arc.source)
    call_count = calling.calls.get(arc.output, Fraction(1))
    caller = rates.paces.get(arc.source)
    return multiply_value(caller.rate, call_count) if caller else unknown_value(arc.source)


def _call_reason(rates: RateTable, arc: Arc) -> Reason:
    caller = rates.state.system.activities[arc.source]
    call_count = caller.calls.get(arc.output, Fraction(1))
    count_text = "once" if call_count == 1 else f"{float(call_count):g} times"
    span = caller.places.get("calls", arc.at) if arc.output in caller.calls else arc.at
    return Reason("called by {0}, {1} for each activation: {2}", span, (arc.source, count_text, _call_rate(rates, arc)))
