"""How often an activity works by itself, for its inputs, or for its callers: rate and largest gap."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from archgen.timing.analysis import Reason
from archgen.timing.fired import fired
from archgen.timing.pacing import Beat, Paces, trigger_place
from archgen.timing.propagate import State
from archgen.timing.sums import NEVER, UNBOUNDED, times, total, unknown
from archgen.timing.system import Activity, Arc
from archgen.timing.ticks import SECOND
from archgen.timing.value import ZERO, Value


def beat_of(found: Paces, activity: Activity) -> tuple[Beat, Value | None, list[Reason]]:
    """Return an activity's rate and gap, by itself or from its inputs; the rate of the calls it answers; the reasons.

    The rate of calls is None where it serves none. Calls have no largest gap: nobody promises to call.
    """
    state = found.state
    if activity.behaviour not in {"event", "on_demand"}:
        beat, reason = _by_itself(found, activity)
        return beat, None, [reason]
    calls = state.triggers.requests[activity.id]
    asked = total(_call(found, arc) for arc in calls) if calls else None
    reasons = [_called(found, arc) for arc in calls]
    if activity.id in state.triggers.never:
        return (NEVER, UNBOUNDED), asked, [Reason("what it waits for never comes", trigger_place(activity))]
    if activity.id in state.triggers.unknown:
        return _in_ring(state, activity), asked, [Reason("it lies in a ring of triggers", trigger_place(activity))]
    # On demand, calls are all that it does: its rate is theirs, and its gap is unknown.
    if activity.behaviour == "on_demand":
        reasons = reasons or [Reason("on demand, and nobody is known to call it", activity.at)]
        return (asked or unknown(activity.id), unknown(activity.id)), asked, reasons
    beat, more = fired(found, activity)
    return beat, asked, more + reasons


def _by_itself(found: Paces, activity: Activity) -> tuple[Beat, Reason]:
    """Return rate and gap of what is neither event-driven nor on demand, and the reason."""
    if activity.behaviour == "periodic":
        return periodic(found, activity), periodic_reason(found, activity)
    if activity.behaviour == "once":
        # It works at the start only; all figures hold from when that is over.
        return (ZERO, UNBOUNDED), Reason("published once, at the start", activity.at)
    return (unknown(activity.id), unknown(activity.id)), Reason("nothing says when it runs", activity.at)


def _in_ring(state: State, activity: Activity) -> Beat:
    """Return rate and gap of an activity in a ring of triggers: unbounded where it runs for ever, else unknown."""
    endless = any(activity.id in ring for ring in state.triggers.endless)
    value = UNBOUNDED if endless else replace(unknown(activity.id), assumptions=("a ring of triggers",))
    return value, unknown(activity.id)


def periodic(found: Paces, activity: Activity) -> Beat:
    """Return rate and gap (T + J) of an activity that states its period itself."""
    if activity.period is None:
        return unknown(activity.id), unknown(activity.id)
    # Many activities share few periods: the same value objects are used again, and compare equal at once.
    key = activity.period, activity.jitter
    beat = found.beats.get(key)
    if beat is None:
        rate = Value(SECOND / (activity.period * found.state.system.tick))
        beat = found.beats[key] = rate, found.time(activity.period + activity.jitter)
    return beat


def periodic_reason(found: Paces, activity: Activity) -> Reason:
    """Return the reason for a stated period, and where it is written."""
    if activity.period is None:
        return Reason("periodic, but neither a period nor a rate is written", activity.at)
    tick = found.state.system.tick
    place = activity.places.get("period", activity.places.get("rate", activity.at))
    if activity.jitter:
        parts = activity.period * tick, activity.jitter * tick
        return Reason("every {0}, up to {1} later, as written", place, parts)
    return Reason("every {0}, as written", place, (activity.period * tick,))


def _call(found: Paces, arc: Arc) -> Value:
    """Return the rate of calls along an arc."""
    calls = found.state.system.activities[arc.source].calls.get(arc.output, Fraction(1))
    caller = found.of.get(arc.source)
    return times(caller.rate, calls) if caller else unknown(arc.source)


def _called(found: Paces, arc: Arc) -> Reason:
    """Return the reason for calls along an arc."""
    caller = found.state.system.activities[arc.source]
    calls = caller.calls.get(arc.output, Fraction(1))
    each = "once" if calls == 1 else f"{float(calls):g} times"
    place = caller.places.get("calls", arc.at) if arc.output in caller.calls else arc.at
    return Reason("called by {0}, {1} for each activation: {2}", place, (arc.source, each, _call(found, arc)))
