"""The beat of what inputs fire: any of several, all of several, every n-th, throttled; each with its reasons."""

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
    """Give the beat of an event-driven activity."""
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
        gap = activity.throttle * found.state.system.tick
        place = activity.places.get("throttle", activity.at)
        reasons.append(Reason("throttled: at least {0} apart", place, (gap,)))
    if activity.jitter:
        beat = beat[0], total((beat[1], found.time(activity.jitter)))
    return beat, reasons


def _arriving(found: Paces, arc: Arc) -> Beat:
    """Give what an arc brings: its producer's output, over a link."""
    pace = found.outputs.get((arc.source, arc.output))
    if pace is None:
        return unknown(arc.source), unknown(arc.source)
    if arc.worst is None:
        return pace.rate, total((pace.gap, unknown(arc.link or arc.source)))
    later = arc.worst - (arc.best or 0)
    return pace.rate, total((pace.gap, found.time(later))) if later else pace.gap


def _input(found: Paces, activity: Activity, key: str, arcs: tuple[Arc, ...]) -> tuple[Beat, list[Reason]]:
    """Give what arrives at an input: any of its sources fires it."""
    if len(arcs) == 1 and key not in found.state.system.external.get(activity.id, ()):
        rate, gap = _arriving(found, arcs[0])
        return (rate, smallest((gap,))), [_brings(key, arcs[0], (rate, gap))]
    beats = [_arriving(found, arc) for arc in arcs]
    twice = len(arcs) > 1 and len({arc.source for arc in arcs}) < len(arcs)
    told_ = [
        _brings(key, arc, beat, f" on {arc.topic}" if twice else "") for arc, beat in zip(arcs, beats, strict=True)
    ]
    if not arcs or key in found.state.system.external.get(activity.id, ()):
        beats.append((unknown(key), unknown(key)))
        told_.append(Reason(f"how often {key} brings something is not known", activity.at))
    return (total(rate for rate, _ in beats), smallest(gap for _, gap in beats)), told_


def _brings(key: str, arc: Arc, beat: Beat, where: str = "") -> Reason:
    rate, gap = beat
    if gap.value is None or not known(gap):
        return Reason("{0} brings {1} from {2}{3}", arc.at, (key, rate, arc.source, where))
    return Reason("{0} brings {1} from {2}{3}, at most {4} apart", arc.at, (key, rate, arc.source, where, gap.value))


def _any(found: Paces, activity: Activity, inputs: Mapping[str, tuple[Arc, ...]]) -> tuple[Beat, list[Reason]]:
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
        sent = found.state.events[arcs[0].source] if len(arcs) == 1 else ()
        if sent and not isinstance(sent, Cause) and sent[0].jitter:
            return False  # it never gets less on its way
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
