"""Inputs that are matched by time: how often they are, how old what is used may be, and how long a message waits."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from fractions import Fraction
from math import ceil

from archgen.timing.analysis import MatchFigures, Reason
from archgen.timing.figures.figure_wording import format_duration
from archgen.timing.figures.timing_values import TimingValue, UnknownCause
from archgen.timing.figures.value_arithmetic import (
    NO_MATCH_NOTE,
    add_values,
    is_known_bound,
    name_missing_element,
    unknown_value,
)
from archgen.timing.load.event_models import input_model
from archgen.timing.load.event_streams import max_arrivals
from archgen.timing.load.match_delays import find_matched_input, has_same_source, queue_length
from archgen.timing.load.match_windows import MatchedInput, MatchWindows, find_match_windows
from archgen.timing.rates.rate_table import RateTable, trigger_span
from archgen.timing.system.thread_pools import may_skip_ticks
from archgen.timing.system.timing_system import Activity, Arc, best_response

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
