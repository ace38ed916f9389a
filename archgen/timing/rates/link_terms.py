"""How the queueing of a link and its largest burst come about: which messages, how often, of which size."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import NamedTuple

from archgen.timing.figures import figure_wording
from archgen.timing.figures.tick_unit import NS_PER_SECOND
from archgen.timing.figures.timing_values import TimingValue, UnknownCause
from archgen.timing.load.event_streams import EventStreams
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.load.sent_models import sent_model
from archgen.timing.load.work_terms import CountFormulas, EventCount, WorkTerm, group_terms
from archgen.timing.rates.link_traffic import find_largest_backlog
from archgen.timing.system.timing_system import Arc


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
