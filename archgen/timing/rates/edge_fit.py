"""How producers and consumers fit together: samples lost and read again, beats, queues."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from archgen.frozen import dataclass, field, replace
from archgen.timing.analysis import EdgeFit, EventPace, ResponseTime
from archgen.timing.figures.tick_unit import NS_PER_SECOND
from archgen.timing.figures.timing_values import ZERO_VALUE, TimingValue, UnknownCause, add_values, value_of_cause
from archgen.timing.load.event_models import arriving_model, sample_model
from archgen.timing.load.event_streams import max_arrivals
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.system.timing_system import Arc, TimingSystem

_ONE = TimingValue(Fraction(1))


@dataclass(frozen=True, slots=True)
class EdgeContext:
    """What edges are judged by, and figures that many of them share."""

    state: PropagationState
    paces: Mapping[str, EventPace]
    outputs: Mapping[tuple[str, str], EventPace]
    responses: Mapping[str, ResponseTime]
    reader_windows: dict[tuple[str, bool], int | TimingValue] = field(default_factory=dict)
    """Time (ticks) in which messages gather, by reader and whether it is fired by each message."""
    fits: dict[tuple[tuple[int, int], tuple[int, int], int], tuple[Fraction, Fraction, TimingValue]] = field(
        default_factory=dict
    )
    """Loss, rereads and beat, by both rates (as ratios) and the number of messages read at once."""
    count_values: dict[int, TimingValue] = field(default_factory=dict)
    """Values of queue lengths."""
    dropped_shares: dict[str, TimingValue] = field(default_factory=dict)
    """Loss by reader, where messages fire it."""


def find_edge_fits(context: EdgeContext, *, judging: bool) -> tuple[EdgeFit, ...]:
    """Compare what is sent with what is read, along every arc that carries data, or those that a rule may judge."""
    system = context.state.system
    arcs = (arc for arc in system.arcs if arc.role == "data" and (not judging or _is_judged(system, arc)))
    return tuple(_fit_edge(context, arc) for arc in arcs)


def _is_judged(system: TimingSystem, arc: Arc) -> bool:
    """Whether the rules on lost samples and short queues look at an arc at all."""
    target = system.activities[arc.target]
    # Must name no fewer arcs than analyses/timing looks at: what is left out here is never reported.
    return (target.mode == "all" and arc.input in target.triggers) or (
        arc.depth_written and (target.behaviour == "periodic" or fires_each_time(system, arc))
    )


def fires_each_time(system: TimingSystem, arc: Arc) -> bool:
    """Whether each message on an arc fires its reader (before `every` and `throttle`)."""
    target = system.activities[arc.target]
    is_alone = target.mode == "any" or target.triggers == (arc.input,)
    return target.behaviour == "event" and arc.input in target.triggers and is_alone


def _fit_edge(context: EdgeContext, arc: Arc) -> EdgeFit:
    """Return how the two ends of an arc fit together."""
    if context.state.system.activities[arc.source].behaviour == "once":
        return EdgeFit(arc, ZERO_VALUE, _ONE, ZERO_VALUE, _ONE)
    is_fired = fires_each_time(context.state.system, arc)
    queue = _needed_queue(context, arc, is_fired=is_fired)
    if is_fired:
        if arc.target not in context.dropped_shares:
            context.dropped_shares[arc.target] = _dropped_share(context, arc.target)
        return EdgeFit(arc, context.dropped_shares[arc.target], _ONE, ZERO_VALUE, queue)
    sent_rate, read_rate = context.outputs[arc.source, arc.output].rate, context.paces[arc.target].rate
    if sent_rate.value is None or read_rate.value is None or not (sent_rate.complete and read_rate.complete):
        unknown_rate = _unknown_of_either(sent_rate, read_rate)
        return EdgeFit(arc, unknown_rate, unknown_rate, unknown_rate, queue)
    if sent_rate.value == read_rate.value and not sent_rate.assumptions and not read_rate.assumptions:
        return EdgeFit(arc, ZERO_VALUE, _ONE, ZERO_VALUE, queue)
    loss, rereads, beat = _compare_rates(context, sent_rate.value, read_rate.value, _messages_at_once(context, arc))
    # A beat is the difference of two rates: one that is only bounded says nothing of it.
    if sent_rate.side != "exact" or read_rate.side != "exact":
        beat = ZERO_VALUE
    return EdgeFit(
        arc,
        _with_assumptions(loss, sent_rate, read_rate),
        _with_assumptions(rereads, sent_rate, read_rate),
        beat,
        queue,
    )


def _compare_rates(
    context: EdgeContext, sent_rate: Fraction, read_rate: Fraction, at_once: int
) -> tuple[Fraction, Fraction, TimingValue]:
    """Return the share of samples lost, how often each is read, and the beat."""
    key = sent_rate.as_integer_ratio(), read_rate.as_integer_ratio(), at_once
    fit = context.fits.get(key)
    if fit is None:
        reads_per_message = read_rate / sent_rate if sent_rate else Fraction(1)
        # Reading `at_once` messages at a time loses none as long as that many reads keep up with what is sent.
        loss, rereads = max(1 - at_once * reads_per_message, Fraction(0)), max(reads_per_message, Fraction(1))
        fit = context.fits[key] = loss, rereads, _beat_period(sent_rate, read_rate)
    return fit


def _messages_at_once(context: EdgeContext, arc: Arc) -> int:
    """Return how many messages a reader takes at a time: the newest only, or all of a queue that somebody asked for."""
    is_polling = context.state.system.activities[arc.target].behaviour == "periodic"
    return arc.depth if is_polling and arc.depth_written and arc.depth else 1


def _dropped_share(context: EdgeContext, reader: str) -> TimingValue:
    """Return the share of triggers that `every` and `throttle` leave out."""
    system = context.state.system
    target = system.activities[reader]
    if not target.throttle:
        return ZERO_VALUE if target.every == 1 else TimingValue(1 - Fraction(1, target.every))
    firing_arcs = [
        firing_arc
        for firing_arc in system.arcs_into.get(target.id, ())
        if firing_arc.role == "data" and fires_each_time(system, firing_arc)
    ]
    sent_rate = add_values(context.outputs[firing_arc.source, firing_arc.output].rate for firing_arc in firing_arcs)
    read_rate = context.paces[target.id].rate
    if not sent_rate.value or read_rate.value is None or not (sent_rate.complete and read_rate.complete):
        return (
            _unknown_of_either(sent_rate, read_rate)
            if sent_rate.value is None or read_rate.value is None
            else ZERO_VALUE
        )
    return _with_assumptions(max(1 - read_rate.value / sent_rate.value, Fraction(0)), sent_rate, read_rate)


def _unknown_of_either(sent_rate: TimingValue, read_rate: TimingValue) -> TimingValue:
    """Return the unknown value that names what is missing of either rate."""
    return add_values(
        replace(rate, value=None, side="exact")
        for rate in (sent_rate, read_rate)
        if rate.value is None or not rate.complete
    )


def _with_assumptions(value: Fraction, sent_rate: TimingValue, read_rate: TimingValue) -> TimingValue:
    assumptions = (*sent_rate.assumptions, *read_rate.assumptions)
    return TimingValue(value, assumptions=tuple(dict.fromkeys(assumptions)) if assumptions else ())


def _beat_period(sent_rate: Fraction, read_rate: Fraction) -> TimingValue:
    """Return the time (ns) from one slip of two clocks to the next, 0 where they never slip.

    It is 1 / |fast - n slow|, with n slow nearest to fast.
    """
    if not sent_rate or not read_rate:
        return ZERO_VALUE
    fast, slow = max(sent_rate, read_rate), min(sent_rate, read_rate)
    slip_rate = abs(fast - round(fast / slow) * slow)
    return TimingValue(NS_PER_SECOND / slip_rate) if slip_rate else ZERO_VALUE


def _needed_queue(context: EdgeContext, arc: Arc, *, is_fired: bool) -> TimingValue:
    """Return how many messages can wait: what comes until the reader has been through once more, eta-plus(gap + R)."""
    event_model = sample_model(context.state, arc)
    # Without the link's latency nothing is known of arrivals: `arriving_model` returns the cause that names the link.
    if event_model and arc.worst is None:
        event_model = arriving_model(context.state, arc)
    if isinstance(event_model, UnknownCause):
        return value_of_cause(event_model)
    window = context.reader_windows.get((arc.target, is_fired))
    if window is None:
        window = context.reader_windows[arc.target, is_fired] = _reader_window(context, arc.target, is_fired=is_fired)
    if isinstance(window, TimingValue):
        return window
    queue_length = max_arrivals(event_model, window, (arc.worst or 0) - (arc.best or 0))
    count_value = context.count_values.get(queue_length)
    if count_value is None:
        count_value = context.count_values[queue_length] = TimingValue(Fraction(queue_length))
    return count_value


def _reader_window(context: EdgeContext, reader: str, *, is_fired: bool) -> int | TimingValue:
    """Return how long (in ticks) messages can gather before a reader."""
    response = context.responses[reader].worst
    # A reader that each message fires lets them wait for one response; any other for its gap as well.
    waiting = response if is_fired else add_values((context.paces[reader].gap, response))
    if waiting.value is None or not waiting.complete:
        return replace(waiting, value=None, side="exact")
    (numerator, denominator), tick = waiting.value.as_integer_ratio(), context.state.system.tick
    return max(-(-numerator * tick.denominator // (denominator * tick.numerator)), 1)
