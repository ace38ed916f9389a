"""Rate and gap of what inputs fire: any of several, all of several, every n-th, throttled; each with its reasons."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from fractions import Fraction

from archgen.timing.analysis import Reason
from archgen.timing.pacing import Beat, Paces, trigger_place
from archgen.timing.propagate import arrival, is_kept, renewed
from archgen.timing.sums import UNBOUNDED, known, largest, smallest, times, total, unknown
from archgen.timing.system import Activity, Arc
from archgen.timing.ticks import SECOND
from archgen.timing.value import ZERO, Cause, Value


def fired(found: Paces, activity: Activity) -> tuple[Beat, list[Reason]]:
    """Return rate, gap and reasons of an event-driven activity."""
    inputs = found.state.triggers.inputs[activity.id]
    if not inputs:
        return (unknown(activity.id), unknown(activity.id)), [
            Reason("event-driven, but no input fires it", activity.at)
        ]
    beat, reasons = _all(found, activity, inputs) if activity.mode == "all" else _any(found, activity, inputs)
    # In this order: `every` counts triggers, `throttle` acts on what `every` lets through, `jitter` delays what fires
    # at last. The event model (event_propagation) is made in the same order.
    if activity.every > 1:
        beat = times(beat[0], Fraction(1, activity.every)), times(beat[1], activity.every)
        reasons.append(Reason(f"one in {activity.every} fires it", activity.places.get("every", activity.at)))
    if activity.throttle:
        beat = _throttled(found, activity, beat)
        gap = activity.throttle * found.state.system.tick
        place = activity.places.get("throttle", activity.at)
        reasons.append(Reason("throttled: at least {0} apart", place, (gap,)))
    if activity.jitter:
        beat = beat[0], total((beat[1], found.time(activity.jitter)))
    return beat, reasons


def _arriving(found: Paces, arc: Arc) -> Beat:
    """Return what an arc brings: the rate and gap of its producer's output, over a link."""
    pace = found.outputs.get((arc.source, arc.output))
    if pace is None:
        return unknown(arc.source), unknown(arc.source)
    if arc.worst is None:
        return pace.rate, total((pace.gap, unknown(arc.link or arc.source)))
    # A link leaves the rate alone, and widens the gap by the difference of its latencies.
    later = arc.worst - (arc.best or 0)
    return pace.rate, total((pace.gap, found.time(later))) if later else pace.gap


def _input(found: Paces, activity: Activity, key: str, arcs: tuple[Arc, ...]) -> tuple[Beat, list[Reason]]:
    """Return rate, gap and reasons of what arrives at an input: any of its sources fires it."""
    if len(arcs) == 1 and key not in found.state.system.external.get(activity.id, ()):
        rate, gap = _arriving(found, arcs[0])
        return (rate, smallest((gap,))), [_brings(key, arcs[0], (rate, gap))]
    beats = [_arriving(found, arc) for arc in arcs]
    # Only where one source arrives on several topics does the topic have to be named.
    twice = len(arcs) > 1 and len({arc.source for arc in arcs}) < len(arcs)
    told_ = [
        _brings(key, arc, beat, f" on {arc.topic}" if twice else "") for arc, beat in zip(arcs, beats, strict=True)
    ]
    if not arcs or key in found.state.system.external.get(activity.id, ()):
        beats.append((unknown(key), unknown(key)))
        told_.append(Reason(f"how often {key} brings something is not known", activity.at))
    return (total(rate for rate, _ in beats), smallest(gap for _, gap in beats)), told_


def _brings(key: str, arc: Arc, beat: Beat, where: str = "") -> Reason:
    """Return the reason for what an arc brings to an input."""
    rate, gap = beat
    if gap.value is None or not known(gap):
        return Reason("{0} brings {1} from {2}{3}", arc.at, (key, rate, arc.source, where))
    return Reason("{0} brings {1} from {2}{3}, at most {4} apart", arc.at, (key, rate, arc.source, where, gap.value))


def _any(found: Paces, activity: Activity, inputs: Mapping[str, tuple[Arc, ...]]) -> tuple[Beat, list[Reason]]:
    """Return rate and gap of any-of: the sum of the rates, and the smallest gap."""
    several = len(inputs) > 1
    reasons = (
        [Reason("fired by any of its triggers: rates add up, the smallest gap counts", trigger_place(activity))]
        if several
        else []
    )
    beats: list[Beat] = []
    for key, arcs in inputs.items():
        beat, more = _input(found, activity, key, arcs)
        beats.append(beat)
        reasons += more
    return (total(rate for rate, _ in beats), smallest(gap for _, gap in beats)), reasons


def _all(found: Paces, activity: Activity, inputs: Mapping[str, tuple[Arc, ...]]) -> tuple[Beat, list[Reason]]:
    """Return rate and gap of all-of: the smallest rate, and the largest gap."""
    reasons = [
        Reason(
            "fires when all of its triggers have something new: with the smallest rate, and the largest gap",
            trigger_place(activity),
        )
    ]
    beats: dict[str, Beat] = {}
    for key, arcs in inputs.items():
        if is_kept(found.state.system, arcs):
            reasons.append(Reason(f"{key} is sent once and kept: it is always there", activity.at))
            continue
        beats[key], more = _input(found, activity, key, arcs)
        reasons += more
        # An input that closes a ring rests on this very activity: the others decide, and it counts as unknown.
        if (activity.id, key) in found.state.triggers.open:
            beats[key] = unknown(activity.id), unknown(activity.id)
    if not beats:
        # Everything is always there: then what feeds such an input again fires, as with any-of.
        fed = renewed(found.state.system, inputs)
        beat, more = _any(found, activity, fed) if fed else ((ZERO, UNBOUNDED), [])
        return beat, reasons + more
    return (_slowest(found, activity, beats, inputs), largest(gap for _, gap in beats.values())), reasons


def _slowest(
    found: Paces, activity: Activity, beats: Mapping[str, Beat], inputs: Mapping[str, tuple[Arc, ...]]
) -> Value:
    """Return the smallest rate: exact where all inputs are strictly periodic, else an upper bound."""
    rates = [rate for rate, _ in beats.values()]
    known = [rate for rate in rates if rate.value is not None and rate.complete]
    if not known:
        return largest(replace(rate, value=None, complete=False) for rate in rates)
    least = min(known, key=lambda rate: rate.value or Fraction(0))
    # An unknown input may be slower still: what is known bounds the rate from above.
    if len(known) < len(rates):
        missing = tuple(dict.fromkeys(m for rate in rates if rate not in known for m in rate.missing))
        return replace(least, complete=False, missing=missing, side="at most")
    if len(rates) == 1 or _strict(found, activity, ((key, inputs[key]) for key in beats)):
        return least
    # With jitter an input may miss its partner: all-of then fires less often than the slower input comes.
    return replace(least, side="at most")


def _strict(found: Paces, activity: Activity, inputs: Iterable[tuple[str, tuple[Arc, ...]]]) -> bool:
    """Whether all inputs are strictly periodic, without jitter or smallest distance."""
    for key, arcs in inputs:
        sent = found.state.events[arcs[0].source] if len(arcs) == 1 else ()
        if sent and not isinstance(sent, Cause) and sent[0].jitter:
            return False  # jitter only grows on the way: no need to follow it
        events = arrival(found.state, activity, key, arcs)
        if isinstance(events, Cause) or len(events) != 1 or events[0].jitter or events[0].distance:
            return False
    return True


def _throttled(found: Paces, activity: Activity, beat: Beat) -> Beat:
    """Return the rate and gap that a throttle lets through: whole multiples of a period, where there is one."""
    rate, gap = beat
    tick = found.state.system.tick
    least = activity.throttle * tick
    # The gap becomes less than q + g: after the throttle's time the next trigger is at most one gap away.
    wider = total((gap, Value(least))) if gap.value is not None else gap
    if not rate.value:
        return rate, wider
    # With a known event model of one stream, `throttle_streams` has rounded the period up already. Where that model is
    # unknown but the rate exact, its triggers are assumed to come regularly, and the assumption is stated.
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
