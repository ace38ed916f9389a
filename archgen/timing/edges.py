"""How producers and consumers fit together: samples lost and read again, beats, queues."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace
from fractions import Fraction

from archgen.frozen import dataclass
from archgen.timing.analysis import EdgePace, Pace, Response
from archgen.timing.propagate import State, arriving
from archgen.timing.sending import left
from archgen.timing.streams import eta
from archgen.timing.sums import because, total
from archgen.timing.system import Arc, System
from archgen.timing.ticks import SECOND
from archgen.timing.value import ZERO, Cause, Value

_ONE = Value(Fraction(1))


@dataclass(frozen=True, slots=True)
class Known:
    """What edges are judged by, and figures that many of them share."""

    state: State
    paces: Mapping[str, Pace]
    outputs: Mapping[tuple[str, str], Pace]
    responses: Mapping[str, Response]
    windows: dict[tuple[str, bool], int | Value] = field(default_factory=dict)
    """Time (ticks) in which messages gather, by reader and whether it is fired by each message."""
    fits: dict[tuple[tuple[int, int], tuple[int, int], int], tuple[Fraction, Fraction, Value]] = field(
        default_factory=dict
    )
    """Loss, rereads and beat, by both rates (as ratios) and the number of messages read at once."""
    counts: dict[int, Value] = field(default_factory=dict)
    """Values of queue lengths."""
    dropped: dict[str, Value] = field(default_factory=dict)
    """Loss by reader, where messages fire it."""


def edge_paces(known: Known, *, judging: bool = False) -> tuple[EdgePace, ...]:
    """Compare what is sent with what is read, along every arc that carries data, or those that a rule may judge."""
    system = known.state.system
    arcs = (arc for arc in system.arcs if arc.role == "data" and (not judging or _judged(system, arc)))
    return tuple(_edge(known, arc) for arc in arcs)


def _judged(system: System, arc: Arc) -> bool:
    """Whether the rules on lost samples and short queues look at an arc at all."""
    target = system.activities[arc.target]
    # Must name no fewer arcs than analyses/timing looks at: what is left out here is never reported.
    return (target.mode == "all" and arc.input in target.triggers) or (
        arc.depth_written and (target.behaviour == "periodic" or fires(system, arc))
    )


def fires(system: System, arc: Arc) -> bool:
    """Whether each message on an arc fires its reader (before `every` and `throttle`)."""
    target = system.activities[arc.target]
    alone = target.mode == "any" or target.triggers == (arc.input,)
    return target.behaviour == "event" and arc.input in target.triggers and alone


def _edge(known: Known, arc: Arc) -> EdgePace:
    """Return how the two ends of an arc fit together."""
    if known.state.system.activities[arc.source].behaviour == "once":
        return EdgePace(arc, ZERO, _ONE, ZERO, _ONE)
    is_fired = fires(known.state.system, arc)
    queue = _queue(known, arc, is_fired=is_fired)
    if is_fired:
        if arc.target not in known.dropped:
            known.dropped[arc.target] = _dropped(known, arc.target)
        return EdgePace(arc, known.dropped[arc.target], _ONE, ZERO, queue)
    sent, read = known.outputs[arc.source, arc.output].rate, known.paces[arc.target].rate
    if sent.value is None or read.value is None or not (sent.complete and read.complete):
        why = _either(sent, read)
        return EdgePace(arc, why, why, why, queue)
    if sent.value == read.value and not sent.assumptions and not read.assumptions:
        return EdgePace(arc, ZERO, _ONE, ZERO, queue)
    loss, again, beat = _fit(known, sent.value, read.value, _at_once(known, arc))
    # A beat is the difference of two rates: one that is only bounded says nothing of it.
    if sent.side != "exact" or read.side != "exact":
        beat = ZERO
    return EdgePace(arc, _like(loss, sent, read), _like(again, sent, read), beat, queue)


def _fit(known: Known, sent: Fraction, read: Fraction, at_once: int) -> tuple[Fraction, Fraction, Value]:
    """Return the share of samples lost, how often each is read, and the beat."""
    key = sent.as_integer_ratio(), read.as_integer_ratio(), at_once
    fit = known.fits.get(key)
    if fit is None:
        each = read / sent if sent else Fraction(1)
        # Reading `at_once` messages at a time loses none as long as that many reads keep up with what is sent.
        loss, again = max(1 - at_once * each, Fraction(0)), max(each, Fraction(1))
        fit = known.fits[key] = loss, again, _beat(sent, read)
    return fit


def _at_once(known: Known, arc: Arc) -> int:
    """Return how many messages a reader takes at a time: the newest only, or all of a queue that somebody asked for."""
    polls = known.state.system.activities[arc.target].behaviour == "periodic"
    return arc.depth if polls and arc.depth_written and arc.depth else 1


def _dropped(known: Known, reader: str) -> Value:
    """Return the share of triggers that `every` and `throttle` leave out."""
    system = known.state.system
    target = system.activities[reader]
    if not target.throttle:
        return ZERO if target.every == 1 else Value(1 - Fraction(1, target.every))
    firing = [a for a in system.into.get(target.id, ()) if a.role == "data" and fires(system, a)]
    sent, read = total(known.outputs[a.source, a.output].rate for a in firing), known.paces[target.id].rate
    if not sent.value or read.value is None or not (sent.complete and read.complete):
        return _either(sent, read) if sent.value is None or read.value is None else ZERO
    return _like(max(1 - read.value / sent.value, Fraction(0)), sent, read)


def _either(sent: Value, read: Value) -> Value:
    """Return the unknown value that names what is missing of either rate."""
    return total(
        replace(one, value=None, side="exact") for one in (sent, read) if one.value is None or not one.complete
    )


def _like(value: Fraction, sent: Value, read: Value) -> Value:
    """Return a figure with the assumptions of the rates that it rests on."""
    said = (*sent.assumptions, *read.assumptions)
    return Value(value, assumptions=tuple(dict.fromkeys(said)) if said else ())


def _beat(sent: Fraction, read: Fraction) -> Value:
    """Return the time (ns) from one slip of two clocks to the next, 0 where they never slip.

    It is 1 / |fast - n slow|, with n slow nearest to fast.
    """
    if not sent or not read:
        return ZERO
    fast, slow = max(sent, read), min(sent, read)
    apart = abs(fast - round(fast / slow) * slow)
    return Value(SECOND / apart) if apart else ZERO


def _queue(known: Known, arc: Arc, *, is_fired: bool) -> Value:
    """Return how many messages can wait: what comes until the reader has been through once more, eta-plus(gap + R)."""
    events = left(known.state, arc)
    # Without the link's latency nothing is known of arrivals: `arriving_model` returns the cause that names the link.
    if events and arc.worst is None:
        events = arriving(known.state, arc, known.state.events[arc.source])
    if isinstance(events, Cause):
        return because(events)
    window = known.windows.get((arc.target, is_fired))
    if window is None:
        window = known.windows[arc.target, is_fired] = _window(known, arc.target, is_fired=is_fired)
    if isinstance(window, Value):
        return window
    most = eta(events, window, (arc.worst or 0) - (arc.best or 0))
    found = known.counts.get(most)
    if found is None:
        found = known.counts[most] = Value(Fraction(most))
    return found


def _window(known: Known, reader: str, *, is_fired: bool) -> int | Value:
    """Return how long (in ticks) messages can gather before a reader."""
    response = known.responses[reader].worst
    # A reader that each message fires lets them wait for one response; any other for its gap as well.
    waiting = response if is_fired else total((known.paces[reader].gap, response))
    if waiting.value is None or not waiting.complete:
        return replace(waiting, value=None, side="exact")
    (above, below), tick = waiting.value.as_integer_ratio(), known.state.system.tick
    return max(-(-above * tick.denominator // (below * tick.numerator)), 1)
