"""How often activities are activated and outputs published: rates and largest gaps, each with its reasons."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction

from archgen.timing.analysis import Pace, Reason, Response
from archgen.timing.beats import beat_of, periodic, periodic_reason
from archgen.timing.pacing import Beat, Paces
from archgen.timing.propagate import State
from archgen.timing.streams import Streams, single
from archgen.timing.sums import UNBOUNDED, because, boundless, total, unknown
from archgen.timing.system import Activity
from archgen.timing.value import UNKNOWN, ZERO, Cause, Value


def paces(state: State, responses: Mapping[str, Response]) -> Paces:
    """Find the pace of every activity and output, sources first.

    Last comes what the inputs would give those activities that state a period of their own (`RateTable.derived`).
    """
    found = Paces(state, responses)
    # Looked at after the loop, since they do not wait for their inputs in the order, which may come later in it.
    later: list[Activity] = []
    for name in state.triggers.order:
        activity = state.system.activities[name]
        if activity.period is not None and activity.behaviour != "periodic":
            later.append(activity)
            pace, asked = _stated(found, activity), None
            beat = pace.rate, pace.gap
        else:
            beat, asked, reasons = beat_of(found, activity)
            pace = _pace(found, activity, beat, asked, tuple(reasons))
        found.of[name] = pace
        _publish(found, activity, beat, asked)
    for activity in later:
        beat, asked, reasons = beat_of(found, activity)
        found.derived[activity.id] = _pace(found, activity, beat, asked, tuple(reasons))
    return found


def _pace(found: Paces, activity: Activity, beat: Beat, asked: Value | None, reasons: tuple[Reason, ...]) -> Pace:
    """Return the pace of an activity; calls that it answers count as activations."""
    rate, gap = beat
    everything = rate if asked is None else asked if activity.behaviour == "on_demand" else total((rate, asked))
    jitter, distance = _shape(found, found.state.events[activity.id])
    return Pace(activity.behaviour, everything, gap, jitter, distance, activity.period is None, reasons)


def _stated(found: Paces, activity: Activity) -> Pace:
    """Return the pace that an activity states although its inputs fire it."""
    beat = periodic(found, activity)
    jitter, distance = _shape(found, found.state.events[activity.id])
    reasons = (periodic_reason(found, activity),)
    return Pace(activity.behaviour, *beat, jitter, distance, inferred=False, reasons=reasons)


def _shape(found: Paces, events: Streams | Cause) -> tuple[Value, Value]:
    """Return jitter and smallest gap of an event model, in ns."""
    if isinstance(events, Cause):
        return because(events), because(events)
    if not events:
        return ZERO, UNBOUNDED
    one = single(events)
    # The spacing of a collapsed stream says nothing of the streams it was made of.
    distance = one.spacing if len(events) == 1 else 0
    return found.time(one.jitter), found.time(distance)


def _publish(found: Paces, activity: Activity, beat: Beat, asked: Value | None) -> None:
    """Find how often each output is published: at each activation, R - B later, unless it is conditional."""
    pace, name = found.of[activity.id], activity.id
    spread = _spread(found, activity) if activity.outputs else ZERO
    shape = _shifted(found, activity, pace, spread) if activity.outputs else (ZERO, ZERO)
    # Made once for all plain outputs: they are equal.
    usual: Pace | None = None
    if asked is not None and activity.behaviour == "event":
        beat = total((beat[0], asked)), beat[1]  # a call activates it as well, and publishes
    for key in activity.outputs:
        serves = (name, key) in found.state.system.served
        now = (asked or unknown(name), unknown(name)) if serves else beat
        if key in activity.conditional:
            found.outputs[name, key] = _conditional(found, activity, key, pace, (now[0], spread))
        elif serves:
            found.outputs[name, key] = _later(pace, now, spread, shape)
        else:
            usual = usual or _later(pace, beat, spread, shape)
            found.outputs[name, key] = usual


def _shifted(found: Paces, activity: Activity, pace: Pace, spread: Value) -> tuple[Value, Value]:
    """Return jitter and smallest gap of what comes up to `spread` later; in ticks, where everything is known."""
    events, worst = found.state.events[activity.id], found.state.responses[activity.id].value
    if isinstance(events, Cause) or not events or worst is None:
        return total((pace.jitter, spread)), _closer(pace, spread)
    more = max(worst - (activity.bcet or 0), 0)
    one = single(events)
    distance = one.spacing if len(events) == 1 else 0
    return found.time(one.jitter + more), found.time(max(distance - more, 0))


def _later(pace: Pace, beat: Beat, spread: Value, shape: tuple[Value, Value]) -> Pace:
    """Return the pace of what comes up to `spread` later than it might."""
    rate, gap = beat
    if spread.value == 0:
        return Pace(pace.behaviour, rate, gap, pace.jitter, pace.distance, pace.inferred)
    gap = gap if gap.value is None else total((gap, spread))
    return Pace(pace.behaviour, rate, gap, *shape, pace.inferred)


def _conditional(found: Paces, activity: Activity, key: str, pace: Pace, sent: Beat) -> Pace:
    """Return the pace of a conditional output: between never and the given rate, with the promised gap, if any."""
    rate, spread = sent
    promised = activity.max_gaps.get(key)
    gap = UNBOUNDED if promised is None else _promise(found.time(promised), pace.gap, spread)
    note = "conditional: between none and this"
    upper = replace(rate, side="at most", assumptions=(*rate.assumptions, note)) if rate.value is not None else rate
    place = activity.places.get("outputs", activity.at)
    return replace(pace, rate=upper, gap=gap, distance=ZERO, reasons=(Reason(f"{key} is conditional", place),))


def _promise(promised: Value, gap: Value, spread: Value) -> Value:
    """Return the gap that an output promises, unless the activity's own gap is larger.

    Nothing is sent more often than its activity works.
    """
    done = spread if boundless(spread) else total((gap, spread))
    if boundless(spread) or (done.value is not None and done.value > (promised.value or 0)):
        return done
    return replace(promised, assumptions=("promised",))


def _spread(found: Paces, activity: Activity) -> Value:
    """Return how much later than the earliest an output can be, R - B. A best case that nobody wrote counts as 0."""
    ticks = found.state.responses[activity.id].value
    if ticks is None:
        return replace(found.responses[activity.id].worst, value=None)
    return found.time(max(ticks - (activity.bcet or 0), 0))


def _closer(pace: Pace, spread: Value) -> Value:
    """Return the smallest gap, reduced by a spread."""
    if pace.distance.value is None:
        return UNKNOWN if not pace.distance.complete else pace.distance
    return ZERO if spread.value is None else Value(max(pace.distance.value - spread.value, Fraction(0)))
