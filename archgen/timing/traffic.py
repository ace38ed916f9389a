"""What topics and links carry: bytes per second, and how much can wait in front of a link."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from heapq import heapify, heapreplace

from archgen.timing.analysis import LinkLoad, Pace, TopicLoad
from archgen.timing.pacing import Paces
from archgen.timing.propagate import State
from archgen.timing.queueing import longest
from archgen.timing.sending import sent
from archgen.timing.streams import Streams, eta
from archgen.timing.sums import UNBOUNDED, because, kept, times, total, unknown
from archgen.timing.system import Arc, System
from archgen.timing.ticks import SECOND
from archgen.timing.value import ZERO, Cause, Value, summed

_MOST = 50_000
"""Most arrivals in one busy period of a link that are followed; beyond, nothing is said of its backlog."""
Outputs = Mapping[tuple[str, str], Pace]


def topic_loads(system: System, outputs: Outputs) -> dict[str, TopicLoad]:
    """Return what is published on each topic, and what all its readers receive."""
    reading: dict[str, list[Arc]] = defaultdict(list)
    for arc in system.arcs:
        if arc.role == "data":
            reading[arc.topic].append(arc)
    return {name: _topic(system, name, writers, reading[name], outputs) for name, writers in system.writers.items()}


def _topic(
    system: System, name: str, writers: Iterable[tuple[str, str]], readers: Iterable[Arc], outputs: Outputs
) -> TopicLoad:
    """Return the load of one topic."""
    size = system.sizes.get(name)
    written = [outputs[writer].rate for writer in writers]
    read = [outputs[arc.source, arc.output].rate for arc in readers]
    published = _bytes(name, size, written)
    return TopicLoad(
        unknown(name) if size is None else Value(Fraction(size)),
        published,
        published if written == read else _bytes(name, size, read),
    )


def _bytes(name: str, size: int | None, rates: Sequence[Value]) -> Value:
    """Return the traffic of messages of one size at some rates."""
    rate = rates[0] if len(rates) == 1 else total(rates)
    # Before the size is asked for: what is never sent is no traffic, of whatever size.
    if rate.value == 0 and rate.complete:
        return ZERO
    if size is None or rate.value is None:
        return unknown(name) if size is None else rate
    return kept(rate, _product(*rate.value.as_integer_ratio(), size))


@lru_cache(1 << 12)
def _product(often: int, per: int, size: int) -> Fraction:
    """Return numerator * size / denominator, cached: many topics share a rate and a message size."""
    return Fraction(often * size, per)


def link_loads(state: State, found: Paces) -> dict[str, LinkLoad]:
    """Return the traffic of each link; calls and answers count as well.

    Each reader on another host has its own copy sent.
    """
    crossing: dict[str, list[Arc]] = {link: [] for link in state.system.bandwidths}
    for arc in state.system.arcs:
        if arc.link is not None:
            crossing[arc.link].append(arc)
    return {link: _link(state, link, arcs, found) for link, arcs in crossing.items()}


def _link(state: State, link: str, arcs: Sequence[Arc], found: Paces) -> LinkLoad:
    """Return the load of one link."""
    by_topic: dict[str, list[Value]] = defaultdict(list)
    for arc in arcs:
        by_topic[arc.topic].append(_carried(found, arc))
    parts = {topic: total(several) for topic, several in by_topic.items()}
    traffic = total(parts.values())
    bandwidth = state.system.bandwidths[link]
    share = times(traffic, 1 / bandwidth) if bandwidth else unknown(link)
    waits = longest(state, link, arcs)
    queueing = because(waits) if isinstance(waits, Cause) else Value(waits * state.system.tick)
    return LinkLoad(traffic, share, _burst(state, arcs, bandwidth), queueing, tuple(parts.items()))


def _carried(found: Paces, arc: Arc) -> Value:
    """Return the traffic along an arc, cached for data by output, topic and size."""
    if arc.role != "data":
        return _bytes(arc.topic, arc.size, (_rate(found, arc),))
    key = arc.source, arc.output, arc.topic, arc.size
    known = found.carried.get(key)
    if known is None:
        known = found.carried[key] = _bytes(arc.topic, arc.size, (_rate(found, arc),))
    return known


def _rate(found: Paces, arc: Arc) -> Value:
    """Return how often something is sent along an arc: an answer as often as its client asks."""
    if arc.role == "data":
        return found.outputs[arc.source, arc.output].rate
    client, asked = (arc.source, arc.output) if arc.role == "request" else (arc.target, arc.input)
    return times(found.of[client].rate, found.state.system.activities[client].calls.get(asked, Fraction(1)))


def _burst(state: State, arcs: Sequence[Arc], bandwidth: Fraction | None) -> Value:
    """Return the most bytes that can wait in front of a link, over its longest busy period."""
    missing: dict[str, None] = {}
    known: list[tuple[int, Streams]] = []
    for arc in arcs:
        events = sent(state, arc)
        if isinstance(events, Cause):
            missing |= dict.fromkeys(events.missing or (arc.source,))
        elif arc.size is None:
            missing |= dict.fromkeys((arc.topic,) if events else ())
        else:
            known.append((arc.size, events))
    if missing or bandwidth is None:
        # Not all is known: what all come with at once at the start is a bound from below.
        first = Fraction(sum(size * eta(events, 1) for size, events in known))
        return Value(first, complete=False, missing=tuple(missing), side="at least")
    return _backlog(known, bandwidth * state.system.tick / SECOND)


def _backlog(known: Sequence[tuple[int, Streams]], speed: Fraction) -> Value:
    """Return the largest backlog of a busy period in which everything comes as early as it can.

    `speed` is in bytes per tick.
    """
    several = [(stream, size * stream.size) for size, events in known if size for stream in events]
    sent, whole = summed((size * stream.ratio[0], stream.ratio[1] * stream.size) for stream, size in several)
    fast, per = speed.as_integer_ratio()
    if sent * per >= fast * whole:
        return UNBOUNDED
    # All first batches come together, at 0; bytes are counted in parts of 1/`speed_denominator`. Arrivals are taken
    # from a heap in order of time. `arrived_bytes` counts all that has come, and speed_numerator * time is what was
    # sent by then; the busy period ends where nothing is left.
    waiting = most = per * sum(size for _, size in several)
    number = sum(stream.size for stream, _ in several)
    coming = [(stream.time_of(1), place, 1) for place, (stream, _) in enumerate(several)]
    heapify(coming)
    while coming:
        at, place, k = coming[0]
        if at and waiting <= fast * at:
            break
        stream, size = several[place]
        number += stream.size
        if number > _MOST:
            return Value(None, assumptions=("diverged",))
        waiting += size * per
        most = max(most, waiting - fast * at)
        heapreplace(coming, (stream.time_of(k + 1), place, k + 1))
    return Value(Fraction(most, per))
