"""What topics and links carry: bytes per second, and how much can wait in front of a link."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from heapq import heapify, heapreplace

from archgen.frozen import NamedTuple
from archgen.timing.analysis import Analysis, EventPace, LinkLoad, TopicLoad
from archgen.timing.figures import figure_wording
from archgen.timing.figures.tick_unit import NS_PER_SECOND
from archgen.timing.figures.timing_values import (
    UNBOUNDED_VALUE,
    ZERO_VALUE,
    TimingValue,
    UnknownCause,
    add_values,
    multiply_value,
    replace_figure,
    sum_ratios,
    unknown_value,
    value_of_cause,
)
from archgen.timing.load.event_models import sent_model
from archgen.timing.load.event_streams import EventStreams, max_arrivals
from archgen.timing.load.link_queueing import longest_queueing
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.load.work_terms import CountFormulas, EventCount, WorkTerm, group_terms
from archgen.timing.rates.triggered_rates import RateTable
from archgen.timing.system.timing_system import Arc, TimingSystem

_MAX_ARRIVALS = 50_000
"""Most arrivals in one busy period of a link that are followed; beyond, nothing is said of its backlog."""
OutputPaces = Mapping[tuple[str, str], EventPace]


def find_topic_loads(system: TimingSystem, outputs: OutputPaces) -> dict[str, TopicLoad]:
    """Return what is published on each topic, and what all its readers receive."""
    reading_arcs: dict[str, list[Arc]] = defaultdict(list)
    for arc in system.arcs:
        if arc.role == "data":
            reading_arcs[arc.topic].append(arc)
    return {
        name: _build_topic_load(system, name, writers, reading_arcs[name], outputs)
        for name, writers in system.topic_writers.items()
    }


def _build_topic_load(
    system: TimingSystem, name: str, writers: Iterable[tuple[str, str]], readers: Iterable[Arc], outputs: OutputPaces
) -> TopicLoad:
    size = system.topic_sizes.get(name)
    write_rates = [outputs[writer].rate for writer in writers]
    read_rates = [outputs[arc.source, arc.output].rate for arc in readers]
    published = _bytes_per_second(name, size, write_rates)
    return TopicLoad(
        unknown_value(name) if size is None else TimingValue(Fraction(size)),
        published,
        published if write_rates == read_rates else _bytes_per_second(name, size, read_rates),
    )


def _bytes_per_second(name: str, size: int | None, rates: Sequence[TimingValue]) -> TimingValue:
    """Return the traffic of messages of one size at some rates."""
    rate = rates[0] if len(rates) == 1 else add_values(rates)
    # Before the size is asked for: what is never sent is no traffic, of whatever size.
    if rate.value == 0 and rate.complete:
        return ZERO_VALUE
    if size is None or rate.value is None:
        return unknown_value(name) if size is None else rate
    return replace_figure(rate, _multiply_ratio(*rate.value.as_integer_ratio(), size))


@lru_cache(1 << 12)
def _multiply_ratio(numerator: int, denominator: int, size: int) -> Fraction:
    """Return numerator * size / denominator, cached: many topics share a rate and a message size."""
    return Fraction(numerator * size, denominator)


def find_link_loads(state: PropagationState, rates: RateTable) -> dict[str, LinkLoad]:
    """Return the traffic of each link; calls and answers count as well.

    Each reader on another host has its own copy sent.
    """
    arcs_by_link: dict[str, list[Arc]] = {link: [] for link in state.system.bandwidths}
    for arc in state.system.arcs:
        if arc.link is not None:
            arcs_by_link[arc.link].append(arc)
    return {link: _build_link_load(state, link, arcs, rates) for link, arcs in arcs_by_link.items()}


def _build_link_load(state: PropagationState, link: str, arcs: Sequence[Arc], rates: RateTable) -> LinkLoad:
    by_topic: dict[str, list[TimingValue]] = defaultdict(list)
    for arc in arcs:
        by_topic[arc.topic].append(_arc_traffic(rates, arc))
    topic_traffic = {topic: add_values(arc_values) for topic, arc_values in by_topic.items()}
    traffic = add_values(topic_traffic.values())
    bandwidth = state.system.bandwidths[link]
    share = multiply_value(traffic, 1 / bandwidth) if bandwidth else unknown_value(link)
    queueing_ticks = longest_queueing(state, link, arcs)
    queueing = (
        value_of_cause(queueing_ticks)
        if isinstance(queueing_ticks, UnknownCause)
        else TimingValue(queueing_ticks * state.system.tick)
    )
    burst = _largest_burst(state, arcs, bandwidth)
    largest = max(((arc.size, arc.topic) for arc in arcs if arc.size), default=None)
    longest_sending = (largest[0] * NS_PER_SECOND / bandwidth, largest[1]) if bandwidth and largest else None
    return LinkLoad(traffic, share, burst, queueing, tuple(topic_traffic.items()), longest_sending)


def _arc_traffic(rates: RateTable, arc: Arc) -> TimingValue:
    """Return the traffic along an arc, cached for data by output, topic and size."""
    if arc.role != "data":
        return _bytes_per_second(arc.topic, arc.size, (_sending_rate(rates, arc),))
    key = arc.source, arc.output, arc.topic, arc.size
    arc_traffic = rates.output_traffic.get(key)
    if arc_traffic is None:
        arc_traffic = rates.output_traffic[key] = _bytes_per_second(arc.topic, arc.size, (_sending_rate(rates, arc),))
    return arc_traffic


def _sending_rate(rates: RateTable, arc: Arc) -> TimingValue:
    """Return how often something is sent along an arc: an answer as often as its client asks."""
    if arc.role == "data":
        return rates.outputs[arc.source, arc.output].rate
    client, request_key = (arc.source, arc.output) if arc.role == "request" else (arc.target, arc.input)
    return multiply_value(
        rates.paces[client].rate, rates.state.system.activities[client].calls.get(request_key, Fraction(1))
    )


def find_sending_rate(analysis: Analysis, arc: Arc) -> TimingValue:
    """Return how often something is sent along an arc of an analysed system."""
    if arc.role == "data":
        return analysis.outputs[arc.source, arc.output].rate
    client, key = (arc.source, arc.output) if arc.role == "request" else (arc.target, arc.input)
    return multiply_value(analysis.paces[client].rate, analysis.system.activities[client].calls.get(key, Fraction(1)))


def measure_arc_traffic(analysis: Analysis, arc: Arc) -> TimingValue:
    """Return what runs along an arc of an analysed system, in B/s; those of a link add up to its traffic."""
    return _bytes_per_second(arc.topic, arc.size, (find_sending_rate(analysis, arc),))


def _largest_burst(state: PropagationState, arcs: Sequence[Arc], bandwidth: Fraction | None) -> TimingValue:
    """Return the most bytes that can wait in front of a link, over its longest busy period."""
    missing: dict[str, None] = {}
    size_of: dict[int, tuple[int, EventStreams]] = {}
    for arc in arcs:
        event_model = sent_model(state, arc)
        if isinstance(event_model, UnknownCause):
            missing |= dict.fromkeys(event_model.missing or (arc.source,))
        elif arc.size is None:
            missing |= dict.fromkeys((arc.topic,) if event_model else ())
        else:
            # All readers of an output have its one event model.
            size, _ = size_of.get(id(event_model), (0, event_model))
            size_of[id(event_model)] = (size + arc.size, event_model)
    sized_models = list(size_of.values())
    if missing or bandwidth is None:
        # Not all is known: what all come with at once at the start is a bound from below.
        first_burst = Fraction(sum(size * max_arrivals(event_model, 1) for size, event_model in sized_models))
        return TimingValue(first_burst, complete=False, missing=tuple(missing), side="at least")
    return find_largest_backlog(sized_models, bandwidth * state.system.tick / NS_PER_SECOND).size


class Backlog(NamedTuple):
    """The most bytes that wait, and when that is, in ticks from the start of the busy period on."""

    size: TimingValue
    time: int


def find_largest_backlog(sized_models: Sequence[tuple[int, EventStreams]], speed: Fraction) -> Backlog:
    """Find the largest backlog of a busy period in which everything comes as early as it can.

    `speed` is in bytes per tick.
    """
    sized_streams = [
        (stream, size * stream.batch_size) for size, event_streams in sized_models if size for stream in event_streams
    ]
    sent_numerator, sent_denominator = sum_ratios(
        (size * stream.max_rate_ratio[0], stream.max_rate_ratio[1] * stream.batch_size)
        for stream, size in sized_streams
    )
    speed_numerator, speed_denominator = speed.as_integer_ratio()
    if sent_numerator * speed_denominator >= speed_numerator * sent_denominator:
        return Backlog(UNBOUNDED_VALUE, 0)
    # All first batches come together, at 0; bytes are counted in parts of 1/`speed_denominator`. Arrivals are taken
    # from a heap in order of time. `arrived_bytes` counts all that has come, and speed_numerator * time is what was
    # sent by then; the busy period ends where nothing is left.
    largest_time = 0
    arrived_bytes = largest_backlog = speed_denominator * sum(size for _, size in sized_streams)
    arrival_count = sum(stream.batch_size for stream, _ in sized_streams)
    next_arrivals = [(stream.earliest_time(1), position, 1) for position, (stream, _) in enumerate(sized_streams)]
    heapify(next_arrivals)
    while next_arrivals:
        time, position, k = next_arrivals[0]
        if time and arrived_bytes <= speed_numerator * time:
            break
        stream, size = sized_streams[position]
        arrival_count += stream.batch_size
        if arrival_count > _MAX_ARRIVALS:
            return Backlog(TimingValue(None, assumptions=("diverged",)), 0)
        arrived_bytes += size * speed_denominator
        if arrived_bytes - speed_numerator * time > largest_backlog:
            largest_backlog, largest_time = arrived_bytes - speed_numerator * time, time
        heapreplace(next_arrivals, (stream.earliest_time(k + 1), position, k + 1))
    return Backlog(TimingValue(Fraction(largest_backlog, speed_denominator)), largest_time)


class LinkWorking(NamedTuple):
    """What a link sends in its longest busy period (`window`), in ticks; and the burst, in bytes, that waits at `time`."""

    window: int
    terms: tuple[WorkTerm, ...]
    burst: int | Fraction
    time: int
    burst_terms: tuple[WorkTerm, ...]
    bandwidth: Fraction

    @property
    def is_consistent(self) -> bool:
        """Whether the terms add up to the window."""
        return sum(term.total for term in self.terms) == self.window


def work_out_link(state: PropagationState, link: str, queueing: TimingValue, burst: TimingValue) -> LinkWorking | None:
    """Return how a link's queueing (ns) and burst (B) come about; None where they are not known."""
    bandwidth, tick = state.system.bandwidths[link], state.system.tick
    if queueing.value is None or burst.value is None or not bandwidth:
        return None
    sent = list(_list_sent(state, [arc for arc in state.system.arcs if arc.link == link]))
    window = int(queueing.value / tick)
    ticks_numerator, ticks_denominator = (NS_PER_SECOND / (bandwidth * tick)).as_integer_ratio()
    formulas = CountFormulas(tick)
    terms = group_terms(
        WorkTerm(
            ((_name_message(arc, size), -(-size * ticks_numerator // ticks_denominator)),),
            formulas.count_events(streams, window),
        )
        for arc, size, streams in sent
    )
    backlog = find_largest_backlog([(size, streams) for _, size, streams in sent], bandwidth * tick / NS_PER_SECOND)
    burst_terms = group_terms(
        WorkTerm(((arc.topic, size),), _count_until(streams, backlog.time)) for arc, size, streams in sent
    )
    working = LinkWorking(window, terms, burst.value, backlog.time, burst_terms, bandwidth)
    return working if working.is_consistent else None


def _list_sent(state: PropagationState, arcs: Sequence[Arc]) -> Iterator[tuple[Arc, int, EventStreams]]:
    for arc in arcs:
        model = sent_model(state, arc)
        if not isinstance(model, UnknownCause) and arc.size:
            yield arc, arc.size, model


def _name_message(arc: Arc, size: int) -> str:
    return f"{arc.topic}[{figure_wording.format_size(Fraction(size))}]"


def _count_until(streams: EventStreams, time: int) -> EventCount:
    """Count the events that come up to a time (in ticks), the first ones at 0."""
    number = 0
    for stream in streams:
        batches = 1
        while stream.earliest_time(batches) <= time:
            batches += 1
        number += batches * stream.batch_size
    return EventCount(number, str(number))
