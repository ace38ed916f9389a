"""Rate and gap of what inputs fire: any of several, all of several, every n-th, throttled; each with its reasons.

All rests on the rates found so far.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction
from math import ceil

from archgen.diagnostics.source_span import Span
from archgen.frozen import dataclass, field, replace
from archgen.timing.analysis import EventPace, MatchFigures, Reason, ResponseTime
from archgen.timing.figures.figure_wording import format_duration
from archgen.timing.figures.tick_unit import NS_PER_SECOND
from archgen.timing.figures.timing_values import (
    NO_MATCH_NOTE,
    UNBOUNDED_VALUE,
    ZERO_VALUE,
    TimingValue,
    UnknownCause,
    add_values,
    is_known_bound,
    largest_value,
    multiply_value,
    name_missing_element,
    smallest_value,
    unknown_value,
)
from archgen.timing.load.event_models import (
    MatchedInput,
    MatchWindows,
    find_match_windows,
    find_matched_input,
    find_renewed_inputs,
    has_same_source,
    input_model,
    is_always_present,
    queue_length,
)
from archgen.timing.load.event_streams import max_arrivals
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.system.thread_pools import may_skip_ticks
from archgen.timing.system.timing_system import Activity, Arc, best_response

RateAndGap = tuple[TimingValue, TimingValue]
"""A rate in Hz, and the largest gap in ns."""


@dataclass(slots=True)
class RateTable:
    """The rates found so far. It is filled by `find_rates`, sources first, and by link_traffic."""

    state: PropagationState
    responses: Mapping[str, ResponseTime]
    paces: dict[str, EventPace] = field(default_factory=dict)
    outputs: dict[tuple[str, str], EventPace] = field(default_factory=dict)
    derived: dict[str, EventPace] = field(default_factory=dict)
    matches: dict[str, MatchFigures] = field(default_factory=dict)
    """What is sure of the matches of those whose inputs are matched by time."""
    written_rates: dict[tuple[int, int], RateAndGap] = field(default_factory=dict)
    """Rate and gap by period and jitter (ticks)."""
    duration_values: dict[int, TimingValue] = field(default_factory=dict)
    """Durations in ns by ticks."""

    output_traffic: dict[tuple[str, str, str, int | None], TimingValue] = field(default_factory=dict)
    """Traffic in B/s by activity, output key, topic, and message size."""

    def duration_value(self, ticks: int) -> TimingValue:
        """Return a duration in ns."""
        duration = self.duration_values.get(ticks)
        if duration is None:
            numerator, denominator = self.state.system.tick.as_integer_ratio()
            duration = self.duration_values[ticks] = TimingValue(Fraction(ticks * numerator, denominator))
        return duration


def trigger_span(activity: Activity) -> Span:
    """Return where it is written what fires an activity."""
    return activity.places.get("trigger", activity.at)


def find_triggered_rate(rates: RateTable, activity: Activity) -> tuple[RateAndGap, list[Reason]]:
    """Return rate, gap and reasons of an event-driven activity."""
    inputs = rates.state.triggers.inputs[activity.id]
    if not inputs:
        return (unknown_value(activity.id), unknown_value(activity.id)), [
            Reason("event-driven, but no input fires it", activity.at)
        ]
    find_rate = {"any": _any_of_rate, "all": _all_of_rate, "match": _matched_rate}[activity.mode]
    rate_and_gap, reasons = find_rate(rates, activity, inputs)
    # In this order: `every` counts triggers, `throttle` acts on what `every` lets through, `jitter` delays what fires
    # at last. The event model (event_propagation) is made in the same order.
    if activity.every > 1:
        rate_and_gap = (
            multiply_value(rate_and_gap[0], Fraction(1, activity.every)),
            multiply_value(rate_and_gap[1], activity.every),
        )
        reasons.append(Reason(f"one in {activity.every} fires it", activity.places.get("every", activity.at)))
    if activity.throttle:
        rate_and_gap = _throttled_rate(rates, activity, rate_and_gap)
        gap = activity.throttle * rates.state.system.tick
        span = activity.places.get("throttle", activity.at)
        reasons.append(Reason("throttled: at least {0} apart", span, (gap,)))
    if activity.jitter:
        rate_and_gap = rate_and_gap[0], add_values((rate_and_gap[1], rates.duration_value(activity.jitter)))
    return rate_and_gap, reasons


def _arriving_rate(rates: RateTable, arc: Arc) -> RateAndGap:
    """Return what an arc brings: the rate and gap of its producer's output, over a link."""
    pace = rates.outputs.get((arc.source, arc.output))
    if pace is None:
        return unknown_value(arc.source), unknown_value(arc.source)
    if arc.worst is None:
        return pace.rate, add_values((pace.gap, unknown_value(arc.link or arc.source)))
    # A link leaves the rate alone, and widens the gap by the difference of its latencies.
    spread = arc.worst - (arc.best or 0)
    return pace.rate, add_values((pace.gap, rates.duration_value(spread))) if spread else pace.gap


def _input_rate(
    rates: RateTable, activity: Activity, key: str, arcs: tuple[Arc, ...]
) -> tuple[RateAndGap, list[Reason]]:
    """Return rate, gap and reasons of what arrives at an input: any of its sources fires it."""
    if len(arcs) == 1 and key not in rates.state.system.external_inputs.get(activity.id, ()):
        rate, gap = _arriving_rate(rates, arcs[0])
        return (rate, smallest_value((gap,))), [_arrival_reason(key, arcs[0], (rate, gap))]
    arriving_rates = [_arriving_rate(rates, arc) for arc in arcs]
    # Only where one source arrives on several topics does the topic have to be named.
    is_ambiguous = len(arcs) > 1 and len({arc.source for arc in arcs}) < len(arcs)
    reasons = [
        _arrival_reason(key, arc, arriving_rate, f" on {arc.topic}" if is_ambiguous else "")
        for arc, arriving_rate in zip(arcs, arriving_rates, strict=True)
    ]
    if not arcs or key in rates.state.system.external_inputs.get(activity.id, ()):
        arriving_rates.append((unknown_value(key), unknown_value(key)))
        reasons.append(Reason(f"how often {key} brings something is not known", activity.at))
    return (add_values(rate for rate, _ in arriving_rates), smallest_value(gap for _, gap in arriving_rates)), reasons


def _arrival_reason(key: str, arc: Arc, rate_and_gap: RateAndGap, topic_text: str = "") -> Reason:
    """Return the reason for what an arc brings to an input."""
    rate, gap = rate_and_gap
    if gap.value is None or not is_known_bound(gap):
        return Reason("{0} brings {1} from {2}{3}", arc.at, (key, rate, arc.source, topic_text))
    return Reason(
        "{0} brings {1} from {2}{3}, at most {4} apart", arc.at, (key, rate, arc.source, topic_text, gap.value)
    )


def _any_of_rate(
    rates: RateTable, activity: Activity, inputs: Mapping[str, tuple[Arc, ...]]
) -> tuple[RateAndGap, list[Reason]]:
    """Return rate and gap of any-of: the sum of the rates, and the smallest gap."""
    has_several = len(inputs) > 1
    reasons = (
        [Reason("fired by any of its triggers: rates add up, the smallest gap counts", trigger_span(activity))]
        if has_several
        else []
    )
    input_rates: list[RateAndGap] = []
    for key, arcs in inputs.items():
        input_rate, input_reasons = _input_rate(rates, activity, key, arcs)
        input_rates.append(input_rate)
        reasons += input_reasons
    return (add_values(rate for rate, _ in input_rates), smallest_value(gap for _, gap in input_rates)), reasons


def _all_of_rate(
    rates: RateTable, activity: Activity, inputs: Mapping[str, tuple[Arc, ...]]
) -> tuple[RateAndGap, list[Reason]]:
    """Return rate and gap of all-of: the smallest rate, and the largest gap."""
    reasons = [
        Reason(
            "fires when all of its triggers have something new: with the smallest rate, and the largest gap",
            trigger_span(activity),
        )
    ]
    input_rates: dict[str, RateAndGap] = {}
    for key, arcs in inputs.items():
        if is_always_present(rates.state.system, arcs):
            reasons.append(Reason(f"{key} is sent once and kept: it is always there", activity.at))
            continue
        input_rates[key], input_reasons = _input_rate(rates, activity, key, arcs)
        reasons += input_reasons
        # An input that closes a ring rests on this very activity: the others decide, and it counts as unknown.
        if (activity.id, key) in rates.state.triggers.open_inputs:
            input_rates[key] = unknown_value(activity.id), unknown_value(activity.id)
    if not input_rates:
        # Everything is always there: then what feeds such an input again fires, as with any-of.
        renewed_inputs = find_renewed_inputs(rates.state.system, inputs)
        rate_and_gap, input_reasons = (
            _any_of_rate(rates, activity, renewed_inputs) if renewed_inputs else ((ZERO_VALUE, UNBOUNDED_VALUE), [])
        )
        return rate_and_gap, reasons + input_reasons
    return (
        _slowest_rate(rates, activity, input_rates, inputs),
        largest_value(gap for _, gap in input_rates.values()),
    ), reasons


def _matched_rate(
    rates: RateTable, activity: Activity, inputs: Mapping[str, tuple[Arc, ...]]
) -> tuple[RateAndGap, list[Reason]]:
    """Return rate and gap of matches: at most the smallest rate, and the gap within which one is sure."""
    figures = rates.matches[activity.id] = find_match(rates, activity, inputs)
    reasons = [match_reason(rates, activity, figures)]
    input_rates: dict[str, RateAndGap] = {}
    for key, arcs in inputs.items():
        input_rates[key], input_reasons = _input_rate(rates, activity, key, arcs)
        reasons += input_reasons
        if (activity.id, key) in rates.state.triggers.open_inputs:
            input_rates[key] = unknown_value(activity.id), unknown_value(activity.id)
    slowest = _slowest_rate(rates, activity, input_rates, inputs)
    if slowest.value is not None and slowest.complete and not has_same_source(rates.state, inputs):
        slowest = replace(slowest, side="at most")
    return (slowest, figures.gap), reasons


def _slowest_rate(
    rate_table: RateTable,
    activity: Activity,
    input_rates: Mapping[str, RateAndGap],
    inputs: Mapping[str, tuple[Arc, ...]],
) -> TimingValue:
    """Return the smallest rate: exact where all inputs are strictly periodic, else an upper bound."""
    all_rates = [rate for rate, _ in input_rates.values()]
    known_rates = [rate for rate in all_rates if rate.value is not None and rate.complete]
    if not known_rates:
        return largest_value(replace(rate, value=None, complete=False) for rate in all_rates)
    slowest = min(known_rates, key=lambda rate: rate.value or Fraction(0))
    # An unknown input may be slower still: what is known bounds the rate from above.
    if len(known_rates) < len(all_rates):
        missing = tuple(dict.fromkeys(m for rate in all_rates if rate not in known_rates for m in rate.missing))
        return replace(slowest, complete=False, missing=missing, side="at most")
    if len(all_rates) == 1 or _is_strictly_periodic(rate_table, activity, ((key, inputs[key]) for key in input_rates)):
        return slowest
    # With jitter an input may miss its partner: all-of then fires less often than the slower input comes.
    return replace(slowest, side="at most")


def _is_strictly_periodic(rates: RateTable, activity: Activity, inputs: Iterable[tuple[str, tuple[Arc, ...]]]) -> bool:
    """Whether all inputs are strictly periodic, without jitter or smallest distance."""
    for key, arcs in inputs:
        source_model = rates.state.event_models[arcs[0].source] if len(arcs) == 1 else ()
        if source_model and not isinstance(source_model, UnknownCause) and source_model[0].jitter:
            return False  # jitter only grows on the way: no need to follow it
        arrival_model = input_model(rates.state, activity, key, arcs)
        if (
            isinstance(arrival_model, UnknownCause)
            or len(arrival_model) != 1
            or arrival_model[0].jitter
            or arrival_model[0].distance
        ):
            return False
    return True


def _throttled_rate(rates: RateTable, activity: Activity, rate_and_gap: RateAndGap) -> RateAndGap:
    """Return the rate and gap that a throttle lets through: whole multiples of a period, where there is one."""
    rate, gap = rate_and_gap
    tick = rates.state.system.tick
    min_gap = activity.throttle * tick
    # The gap becomes less than q + g: after the throttle's time the next trigger is at most one gap away.
    wider_gap = add_values((gap, TimingValue(min_gap))) if gap.value is not None else gap
    if not rate.value:
        return rate, wider_gap
    # With a known event model of one stream, `throttle_streams` has rounded the period up already. Where that model is
    # unknown but the rate exact, its triggers are assumed to come regularly, and the assumption is stated.
    event_model = rates.state.event_models[activity.id]
    if (
        activity.period is None
        and not isinstance(event_model, UnknownCause)
        and len(event_model) == 1
        and event_model[0].events_per_period == 1
    ):
        stream = event_model[0]
        period = stream.period * tick
        if NS_PER_SECOND / period <= NS_PER_SECOND / min_gap:
            return replace(rate, value=min(rate.value, NS_PER_SECOND / period)), wider_gap
    elif isinstance(event_model, UnknownCause) and rate.side == "exact" and rate.complete:
        period = NS_PER_SECOND / rate.value
        period_count = -(-min_gap // period)
        note = "what fires it is taken to come regularly"
        return replace(
            rate, value=1 / (period_count * period) * NS_PER_SECOND, assumptions=(*rate.assumptions, note)
        ), wider_gap
    bound = min(rate.value, NS_PER_SECOND / min_gap)
    return replace(rate, value=bound, side="at most" if rate.complete else rate.side), wider_gap


Inputs = Mapping[str, tuple[Arc, ...]]


def find_match(rates: RateTable, activity: Activity, inputs: Inputs) -> MatchFigures:
    """Return what is sure of the matches of an activity's inputs."""
    gaps = {key: _find_stamp_gap(rates, activity, key, arcs) for key, arcs in inputs.items()}
    unknown_gaps = [gap for gap in gaps.values() if not is_known_bound(gap)]
    matched_inputs: list[MatchedInput] = []
    for key, arcs in inputs.items():
        gap = gaps[key]
        ticks = None if gap.value is None else ceil(gap.value / rates.state.system.tick)
        matched_input = find_matched_input(rates.state, arcs, ticks) if is_known_bound(gap) else None
        if matched_input is None and is_known_bound(gap):
            unknown_gaps.append(_lacking_delay(rates, arcs))
        elif matched_input is not None:
            matched_inputs.append(matched_input)
    if unknown_gaps:
        unknown = replace(add_values(replace(gap, value=None, side="exact") for gap in unknown_gaps), value=None)
        return MatchFigures(unknown, dict.fromkeys(inputs, unknown), dict.fromkeys(inputs, unknown))
    is_same_source = has_same_source(rates.state, inputs)
    windows = find_match_windows(matched_inputs, activity.within or 0, same_source=is_same_source)
    ages = {key: rates.duration_value(age) for key, age in zip(inputs, windows.ages, strict=True)}
    note = _explain_unsure(rates, activity, inputs, windows)
    if windows.waits is None or windows.gap is None or note:
        unsure = TimingValue(None, assumptions=("diverged", f"{NO_MATCH_NOTE}: {note}"))
        return MatchFigures(unsure, dict.fromkeys(inputs, unsure), ages)
    waits = {key: rates.duration_value(wait) for key, wait in zip(inputs, windows.waits, strict=True)}
    return MatchFigures(rates.duration_value(windows.gap), waits, ages)


def match_reason(rates: RateTable, activity: Activity, figures: MatchFigures) -> Reason:
    """Return the reason for how often an activity with matched inputs works."""
    within = Fraction((activity.within or 0) * rates.state.system.tick)
    if figures.gap.value is None:
        notes = [text for text in figures.gap.assumptions if text.startswith(NO_MATCH_NOTE)]
        text = f"; {notes[0]}" if notes else ""
        return Reason(
            "fires for messages of all its triggers that are at most {0} apart" + text,
            trigger_span(activity),
            (within,),
        )
    return Reason(
        "fires for messages of all its triggers that are at most {0} apart: with the smallest rate; a match is sure "
        "every {1} at the latest",
        trigger_span(activity),
        (within, figures.gap.value),
    )


def _find_stamp_gap(rates: RateTable, activity: Activity, key: str, arcs: tuple[Arc, ...]) -> TimingValue:
    """Return the largest gap between the times of an input's messages: the activations of its source."""
    is_outside = not arcs or key in rates.state.system.external_inputs.get(activity.id, ())
    if is_outside or (activity.id, key) in rates.state.triggers.open_inputs:
        return unknown_value(key if is_outside else activity.id)
    if len(arcs) > 1:
        text = f"{NO_MATCH_NOTE}: {key} of {activity.id} has several sources"
        return TimingValue(None, assumptions=("diverged", text))
    arc, source = arcs[0], rates.state.system.activities[arcs[0].source]
    pace = rates.paces.get(source.id)
    response = rates.state.responses[source.id].value
    if pace is None or not (arc.output in source.conditional or may_skip_ticks(rates.state.system, source, response)):
        return name_missing_element(pace.gap, source.id) if pace else unknown_value(source.id)
    # What is known is how far apart two messages are sent: each was activated between R and B before.
    sent_gap = name_missing_element(rates.outputs[source.id, arc.output].gap, source.id)
    if response is None or not is_known_bound(sent_gap):
        return sent_gap if response is not None else rates.responses[source.id].worst
    return add_values((sent_gap, rates.duration_value(max(response - best_response(source), 0))))


def _lacking_delay(rates: RateTable, arcs: Iterable[Arc]) -> TimingValue:
    """Return why nobody knows how long the messages of an input take."""
    for arc in arcs:
        worst = rates.responses[arc.source].worst
        if worst.value is None or not worst.complete:
            return replace(worst, value=None)
        if arc.worst is None:
            return unknown_value(arc.link or arc.source)
        return TimingValue(
            None, assumptions=("diverged", f"{NO_MATCH_NOTE}: {arc.source} works on several messages at once")
        )
    return unknown_value()


def _explain_unsure(rates: RateTable, activity: Activity, inputs: Inputs, windows: MatchWindows) -> str:
    """Say why no match is sure; empty where one is."""
    tick = rates.state.system.tick
    if windows.waits is None:
        if not activity.within:
            return f"messages of different sources have the same time at {activity.id} only by chance"
        needed_text = format_duration(Fraction(windows.needed_within * tick))
        return (
            f"{activity.id} matches what is at most {format_duration(Fraction(activity.within * tick))} apart; "
            f"`within: {needed_text}` would make matches sure, or inputs that come as often"
        )
    for (key, arcs), wait in zip(inputs.items(), windows.waits, strict=True):
        model = input_model(rates.state, activity, key, arcs)
        if isinstance(model, UnknownCause):
            return f"how many messages of {key} wait at {activity.id} is not known"
        needed_queue = max_arrivals(model, wait + 1)
        if needed_queue > queue_length(arcs):
            return (
                f"{activity.id} keeps {queue_length(arcs)} messages of {key}, and {needed_queue} may wait for their match "
                f"(`depth: {needed_queue}`)"
            )
    return ""
