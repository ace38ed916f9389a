"""How often activities are activated and outputs published: rates and largest gaps, each with its reasons."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction

from archgen.source import Span
from archgen.timing.analysis import Pace, Reason, Response
from archgen.timing.arithmetic import NEVER, UNBOUNDED, because, largest, smallest, times, total, unknown
from archgen.timing.propagate import State, arrival, is_kept, renewed
from archgen.timing.response import Cause
from archgen.timing.streams import Streams, single
from archgen.timing.system import Activity, Arc
from archgen.timing.ticks import SECOND
from archgen.timing.value import UNKNOWN, ZERO, Value
from archgen.timing.words import duration, told

Beat = tuple[Value, Value]
"""A rate and the largest gap."""


@dataclass(slots=True)
class Paces:
    """The paces found so far."""

    state: State
    responses: Mapping[str, Response]
    of: dict[str, Pace] = field(default_factory=dict)
    outputs: dict[tuple[str, str], Pace] = field(default_factory=dict)
    derived: dict[str, Pace] = field(default_factory=dict)


def paces(state: State, responses: Mapping[str, Response]) -> Paces:
    """Find the pace of every activity and output, sources first; last what the inputs of those give that state their own."""
    found = Paces(state, responses)
    later: list[Activity] = []
    for name in state.triggers.order:
        activity = state.system.activities[name]
        if activity.period is not None and activity.behaviour != "periodic":
            later.append(activity)
            pace, asked = _stated(found, activity), None
            beat = pace.rate, pace.gap
        else:
            beat, asked, reasons = _beat(found, activity)
            pace = _pace(found, activity, beat, asked, tuple(reasons))
        found.of[name] = pace
        for key in activity.outputs:
            found.outputs[name, key] = _output(found, activity, key, beat, asked)
    for activity in later:
        beat, asked, reasons = _beat(found, activity)
        found.derived[activity.id] = _pace(found, activity, beat, asked, tuple(reasons))
    return found


def _pace(found: Paces, activity: Activity, beat: Beat, asked: Value | None, reasons: tuple[Reason, ...]) -> Pace:
    rate, gap = beat
    everything = rate if asked is None else asked if activity.behaviour == "on_demand" else total((rate, asked))
    jitter, distance = _shape(found, found.state.events[activity.id])
    return Pace(activity.behaviour, everything, gap, jitter, distance, activity.period is None, reasons)


def _stated(found: Paces, activity: Activity) -> Pace:
    """Give the pace that an element states although its inputs fire it."""
    beat = _periodic(found, activity)
    jitter, distance = _shape(found, found.state.events[activity.id])
    reasons = (_periodic_reason(found, activity),)
    return Pace(activity.behaviour, *beat, jitter, distance, inferred=False, reasons=reasons)


def _shape(found: Paces, events: Streams | Cause) -> tuple[Value, Value]:
    if isinstance(events, Cause):
        return because(events), because(events)
    if not events:
        return ZERO, UNBOUNDED
    tick = found.state.system.tick
    one = single(events)
    distance = one.spacing if len(events) == 1 else 0
    return Value(one.jitter * tick), Value(distance * tick)


def _beat(found: Paces, activity: Activity) -> tuple[Beat, Value | None, list[Reason]]:
    """Give rate and gap of what an activity does by itself or for its inputs, and the rate of the calls that it answers."""
    state = found.state
    if activity.behaviour not in {"event", "on_demand"}:
        beat, reason = _by_itself(found, activity)
        return beat, None, [reason]
    calls = state.triggers.requests[activity.id]
    asked = total(_call(found, arc) for arc in calls) if calls else None
    reasons = [_called(found, arc) for arc in calls]
    if activity.id in state.triggers.never:
        return (NEVER, UNBOUNDED), asked, [Reason("what it waits for never comes", _trigger_place(activity))]
    if activity.id in state.triggers.unknown:
        return _in_ring(state, activity), asked, [Reason("it lies in a ring of triggers", _trigger_place(activity))]
    if activity.behaviour == "on_demand":
        reasons = reasons or [Reason("on demand, and nobody is known to call it", activity.at)]
        return (asked or unknown(activity.id), unknown(activity.id)), asked, reasons
    beat, more = _event(found, activity)
    return beat, asked, more + reasons


def _by_itself(found: Paces, activity: Activity) -> tuple[Beat, Reason]:
    if activity.behaviour == "periodic":
        return _periodic(found, activity), _periodic_reason(found, activity)
    if activity.behaviour == "once":
        return (ZERO, UNBOUNDED), Reason("published once, at the start", activity.at)
    return (unknown(activity.id), unknown(activity.id)), Reason("nothing says when it runs", activity.at)


def _in_ring(state: State, activity: Activity) -> Beat:
    endless = any(activity.id in ring for ring in state.triggers.endless)
    value = UNBOUNDED if endless else replace(unknown(activity.id), assumptions=("a ring of triggers",))
    return value, unknown(activity.id)


def _periodic(found: Paces, activity: Activity) -> Beat:
    if activity.period is None:
        return unknown(activity.id), unknown(activity.id)
    tick = found.state.system.tick
    return Value(SECOND / (activity.period * tick)), Value((activity.period + activity.jitter) * tick)


def _periodic_reason(found: Paces, activity: Activity) -> Reason:
    if activity.period is None:
        return Reason("periodic, but neither a period nor a rate is written", activity.at)
    tick = found.state.system.tick
    later = f", up to {duration(activity.jitter * tick)} later" if activity.jitter else ""
    place = activity.places.get("period", activity.places.get("rate", activity.at))
    return Reason(f"every {duration(activity.period * tick)}{later}, as written", place)


def _trigger_place(activity: Activity) -> Span:
    return activity.places.get("trigger", activity.at)


def _call(found: Paces, arc: Arc) -> Value:
    calls = found.state.system.activities[arc.source].calls.get(arc.output, Fraction(1))
    caller = found.of.get(arc.source)
    return times(caller.rate, calls) if caller else unknown(arc.source)


def _called(found: Paces, arc: Arc) -> Reason:
    caller = found.state.system.activities[arc.source]
    calls = caller.calls.get(arc.output, Fraction(1))
    each = "once" if calls == 1 else f"{float(calls):g} times"
    place = caller.places.get("calls", arc.at) if arc.output in caller.calls else arc.at
    return Reason(f"called by {arc.source}, {each} for each activation: {told(_call(found, arc), 'Hz')}", place)


def _arriving(found: Paces, arc: Arc) -> Beat:
    """Give what an arc brings: its producer's output, over a link."""
    pace = found.outputs.get((arc.source, arc.output))
    if pace is None:
        return unknown(arc.source), unknown(arc.source)
    if arc.worst is None:
        return pace.rate, total((pace.gap, unknown(arc.link or arc.source)))
    later = (arc.worst - (arc.best or 0)) * found.state.system.tick
    return pace.rate, total((pace.gap, Value(later))) if later else pace.gap


def _event(found: Paces, activity: Activity) -> tuple[Beat, list[Reason]]:
    inputs = found.state.triggers.inputs[activity.id]
    if not inputs:
        return (unknown(activity.id), unknown(activity.id)), [
            Reason("event-driven, but no input fires it", activity.at)
        ]
    beat, reasons = _all(found, activity, inputs) if activity.mode == "all" else _any(found, activity, inputs)
    if activity.every > 1:
        beat = times(beat[0], Fraction(1, activity.every)), times(beat[1], activity.every)
        reasons.append(Reason(f"one in {activity.every} fires it", activity.places.get("every", activity.at)))
    if activity.throttle:
        beat = _throttled(found, activity, beat)
        gap = duration(activity.throttle * found.state.system.tick)
        reasons.append(Reason(f"throttled: at least {gap} apart", activity.places.get("throttle", activity.at)))
    if activity.jitter:
        beat = beat[0], total((beat[1], Value(activity.jitter * found.state.system.tick)))
    return beat, reasons


def _input(found: Paces, activity: Activity, key: str, arcs: tuple[Arc, ...]) -> tuple[Beat, list[Reason]]:
    """Give what arrives at an input: any of its sources fires it."""
    beats = [_arriving(found, arc) for arc in arcs]
    told_ = [
        Reason(f"{key} brings {told(rate, 'Hz')} from {arc.source}", arc.at)
        for arc, (rate, _) in zip(arcs, beats, strict=True)
    ]
    if not arcs or key in found.state.system.external.get(activity.id, ()):
        beats.append((unknown(key), unknown(key)))
        told_.append(Reason(f"how often {key} brings something is not known", activity.at))
    return (total(rate for rate, _ in beats), smallest(gap for _, gap in beats)), told_


def _any(found: Paces, activity: Activity, inputs: Mapping[str, tuple[Arc, ...]]) -> tuple[Beat, list[Reason]]:
    several = len(inputs) > 1
    reasons = [Reason("fired by any of its triggers", _trigger_place(activity))] if several else []
    beats: list[Beat] = []
    for key, arcs in inputs.items():
        beat, more = _input(found, activity, key, arcs)
        beats.append(beat)
        reasons += more
    return (total(rate for rate, _ in beats), smallest(gap for _, gap in beats)), reasons


def _all(found: Paces, activity: Activity, inputs: Mapping[str, tuple[Arc, ...]]) -> tuple[Beat, list[Reason]]:
    reasons = [Reason("fires when all of its triggers have something new", _trigger_place(activity))]
    beats: dict[str, Beat] = {}
    for key, arcs in inputs.items():
        if is_kept(found.state.system, arcs):
            reasons.append(Reason(f"{key} is sent once and kept: it is always there", activity.at))
            continue
        beats[key], more = _input(found, activity, key, arcs)
        reasons += more
        if (activity.id, key) in found.state.triggers.open:
            beats[key] = unknown(activity.id), unknown(activity.id)
    if not beats:
        fed = renewed(found.state.system, inputs)
        beat, more = _any(found, activity, fed) if fed else ((ZERO, UNBOUNDED), [])
        return beat, reasons + more
    return (_slowest(found, activity, beats, inputs), largest(gap for _, gap in beats.values())), reasons


def _slowest(
    found: Paces, activity: Activity, beats: Mapping[str, Beat], inputs: Mapping[str, tuple[Arc, ...]]
) -> Value:
    """Give the smallest rate: exact where all inputs are strictly periodic, else an upper bound."""
    rates = [rate for rate, _ in beats.values()]
    known = [rate for rate in rates if rate.value is not None and rate.complete]
    if not known:
        return largest(replace(rate, value=None, complete=False) for rate in rates)
    least = min(known, key=lambda rate: rate.value or Fraction(0))
    if len(known) < len(rates):
        missing = tuple(dict.fromkeys(m for rate in rates if rate not in known for m in rate.missing))
        return replace(least, complete=False, missing=missing, side="at most")
    if len(rates) == 1 or _strict(found, activity, ((key, inputs[key]) for key in beats)):
        return least
    return replace(least, side="at most")


def _strict(found: Paces, activity: Activity, inputs: Iterable[tuple[str, tuple[Arc, ...]]]) -> bool:
    for key, arcs in inputs:
        events = arrival(found.state, activity, key, arcs)
        if isinstance(events, Cause) or len(events) != 1 or events[0].jitter or events[0].distance:
            return False
    return True


def _throttled(found: Paces, activity: Activity, beat: Beat) -> Beat:
    """Give the rate that a smallest gap lets through: whole multiples of a period, where there is one."""
    rate, gap = beat
    tick = found.state.system.tick
    least = activity.throttle * tick
    wider = total((gap, Value(least))) if gap.value is not None else gap
    if not rate.value:
        return rate, wider
    events = found.state.events[activity.id]
    if activity.period is None and not isinstance(events, Cause) and len(events) == 1 and events[0].number == 1:
        one = events[0]
        period = one.period * tick
        if SECOND / period <= SECOND / least:
            return replace(rate, value=min(rate.value, SECOND / period)), wider
    elif isinstance(events, Cause) and rate.side == "exact" and rate.complete:
        period = SECOND / rate.value
        steps = -(-least // period)
        note = "what fires it is taken to come regularly"
        return replace(rate, value=1 / (steps * period) * SECOND, assumptions=(*rate.assumptions, note)), wider
    bound = min(rate.value, SECOND / least)
    return replace(rate, value=bound, side="at most" if rate.complete else rate.side), wider


def _output(found: Paces, activity: Activity, key: str, beat: Beat, asked: Value | None) -> Pace:
    """Give how often an output is published: at each activation, R - B later, unless it is conditional."""
    pace = found.of[activity.id]
    serves = found.state.system.served
    rate, gap = (asked or unknown(activity.id), unknown(activity.id)) if (activity.id, key) in serves else beat
    if key in activity.conditional:
        return _conditional(found, activity, key, pace, rate)
    spread = _spread(found.responses[activity.id])
    if spread.value == 0:
        return Pace(pace.behaviour, rate, gap, pace.jitter, pace.distance, pace.inferred)
    gap = gap if gap.value is None else total((gap, spread))
    jitter = total((pace.jitter, spread))
    return Pace(pace.behaviour, rate, gap, jitter, _closer(pace, spread), pace.inferred)


def _conditional(found: Paces, activity: Activity, key: str, pace: Pace, rate: Value) -> Pace:
    promised = activity.max_gaps.get(key)
    gap = UNBOUNDED if promised is None else Value(promised * found.state.system.tick, assumptions=("promised",))
    note = "conditional: between none and this"
    upper = replace(rate, side="at most", assumptions=(*rate.assumptions, note)) if rate.value is not None else rate
    place = activity.places.get("outputs", activity.at)
    return replace(pace, rate=upper, gap=gap, distance=ZERO, reasons=(Reason(f"{key} is conditional", place),))


def _spread(response: Response) -> Value:
    """Give how much later than the earliest an output can be, R - B. A best case that nobody wrote is taken as 0."""
    best = response.best.value or Fraction(0)
    worst = response.worst
    if worst.value is None or not worst.complete:
        return replace(worst, value=None)
    return Value(max(worst.value - best, Fraction(0)))


def _closer(pace: Pace, spread: Value) -> Value:
    if pace.distance.value is None:
        return UNKNOWN if not pace.distance.complete else pace.distance
    return ZERO if spread.value is None else Value(max(pace.distance.value - spread.value, Fraction(0)))
