"""The terms of a figure: how much of what comes in a window, with the numbers put into the formula that counts it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction

from archgen.frozen import NamedTuple, dataclass, replace
from archgen.timing.figures import figure_wording
from archgen.timing.figures.tick_unit import NS_PER_SECOND
from archgen.timing.load.event_streams import EventStream, EventStreams, max_arrivals
from archgen.timing.load.inner_triggers import FiringArc
from archgen.timing.load.level_cascades import EventOrigin, GateRule


class EventCount(NamedTuple):
    """A number of events, and the formula that gives it: `ceil((24 ms + 1 ms) / 40 ms)`."""

    number: int
    formula: str


class WorkTerm(NamedTuple):
    """Work that comes so often: what each time does (names with ticks), and why so often."""

    parts: tuple[tuple[str, int], ...]
    events: EventCount
    reason: str = ""

    @property
    def total(self) -> int:
        """Return all of it, in ticks."""
        return self.events.number * sum(cost for _, cost in self.parts)


ONCE = EventCount(1, "1")


@dataclass(frozen=True, slots=True)
class CountFormulas:
    """Counts events in a window, as `max_arrivals` does, and says how. `tick` is in ns."""

    tick: Fraction

    def write_duration(self, ticks: int) -> str:
        """Write a duration."""
        return figure_wording.format_duration(ticks * self.tick)

    def count_events(self, streams: EventStreams, window: int, delay: int = 0) -> EventCount:
        """Count the events of streams in a window, of which each may come `delay` later."""
        return add_counts([self._count_stream(stream, window, delay) for stream in streams])

    def _count_stream(self, stream: EventStream, window: int, delay: int) -> EventCount:
        period, jitter, distance, per_period, batch = stream
        by_distance = -(-window // (distance - delay)) if distance > delay else None
        batches = -(-(window + jitter + delay) * per_period // period)
        if by_distance is not None and by_distance < batches:
            formula = f"ceil({self.write_duration(window)} / {self.write_duration(distance - delay)})"
        else:
            formula = self._write_periods([window, jitter, delay], period, per_period)
        number = max_arrivals((stream,), window, delay)
        return EventCount(number, formula if batch == 1 else f"{batch} x {formula}")

    def _write_periods(self, durations: Iterable[int], period: int, per_period: int) -> str:
        texts = [self.write_duration(duration) for duration in durations if duration] or ["0 ms"]
        span = texts[0] if len(texts) == 1 else f"({' + '.join(texts)})"
        times = f" x {per_period}" if per_period != 1 else ""
        period_text = self.write_duration(period)
        if period_text.startswith("~"):
            # A third of a second is a round number as a rate.
            rate = figure_wording.format_rate(NS_PER_SECOND / (period * self.tick))
            return f"ceil({span}{times} x {rate})"
        return f"ceil({span}{times} / {period_text})"

    def count_held_jobs(self, streams: EventStreams, window: int) -> EventCount:
        """Count the events of a window that ends with one more, which is not counted."""
        number = max(max_arrivals(streams, window + 1) - 1, 0)
        if len(streams) != 1 or streams[0].batch_size != 1 or streams[0].events_per_period != 1:
            return EventCount(number, str(number))
        period, jitter, distance, _, _ = streams[0]
        if distance and window // distance < (window + jitter) // period:
            return EventCount(number, f"floor({self.write_duration(window)} / {self.write_duration(distance)})")
        formula = self._write_periods([window, jitter], period, 1).removeprefix("ceil")
        return EventCount(number, f"floor{formula}")

    def count_until(self, streams: EventStreams, time: int) -> EventCount:
        """Count the events of a window with both of its ends."""
        number, before = max_arrivals(streams, time + 1), self.count_held_jobs(streams, time)
        return EventCount(number, f"{before.formula} + 1" if before.formula != str(before.number) else str(number))

    def count_gate(self, rule: GateRule, inputs: Sequence[EventCount], window: int) -> EventCount:
        """Count what a gate lets through, of the events at its inputs."""
        number = rule.count_leaving([count.number for count in inputs], window)
        if not number:
            return EventCount(0, "0")
        formulas = ", ".join(count.formula for count in inputs)
        formula = inputs[0].formula
        if len(inputs) > 1 or not rule.is_complete:
            fewest = f"min({formulas})" if len(inputs) > 1 else formula
            formula = f"min({fewest} + 1, max({formulas}, 0))" if rule.is_complete else f"{fewest} + 1"
        if rule.calls != 1:
            formula = f"ceil({figure_wording.format_number(rule.calls)} x ({formula}))"
        if rule.every > 1:
            formula = f"ceil(({formula}) / {rule.every})"
        if rule.throttle:
            formula = f"min({formula}, ceil({self.write_duration(window)} / {self.write_duration(rule.throttle)}))"
        return EventCount(number, formula)


def add_counts(counts: Sequence[EventCount]) -> EventCount:
    """Return the sum of some counts."""
    shown_counts = [count for count in counts if count.number]
    return EventCount(sum(count.number for count in counts), " + ".join(count.formula for count in shown_counts) or "0")


def multiply_count(count: EventCount, factor: int) -> EventCount:
    """Return a count so many times."""
    if factor == 1:
        return count
    return EventCount(count.number * factor, f"{factor} x ({count.formula})")


def group_terms(terms: Iterable[WorkTerm]) -> tuple[WorkTerm, ...]:
    """Put together what comes equally often for the same reason; what takes no time is left out."""
    parts_by_count: dict[tuple[EventCount, str], list[tuple[str, int]]] = {}
    for parts, count, reason in terms:
        working_parts = [(name, cost) for name, cost in parts if cost]
        if working_parts and count.number:
            parts_by_count.setdefault((count, reason), []).extend(working_parts)
    return tuple(WorkTerm(tuple(parts), count, reason) for (count, reason), parts in parts_by_count.items())


ANY_AMOUNT = 1 << 200
"""More work than comes in any window, in ticks: what nobody knows the amount of."""


class ThreadShare(NamedTuple):
    """What a thread beside a path may do in a window, and how much of it counts: no more than the time it lasts. In ticks."""

    unit: tuple[str, ...]
    work: int
    counted: int


@dataclass(frozen=True, slots=True)
class FigureWorking:
    """How a figure (ticks) comes about: it is `window - arrival - lead`, or the sum of `addends`.

    `window` is the least time in which all `terms` are done: those of the `activation`-th activation of the activity, where
    that is not 0, which comes `arrival` after the first. Of a run of `steps` whose last one starts `lead` after the event
    at the earliest, the rest is the last one's response.

    On several cores all of them may be busy beside the path for `blocked_time`, which is part of the window: with
    `shares`, what `beside_terms` make, and with what was `pending`, divided by the number of cores.
    """

    value: int
    window: int
    terms: tuple[WorkTerm, ...]
    activation: int = 0
    arrival: int = 0
    lead: int = 0
    steps: tuple[str, ...] = ()
    addends: tuple[FigureWorking, ...] = ()
    core_count: int = 1
    blocked_time: int = 0
    beside_terms: tuple[WorkTerm, ...] = ()
    shares: tuple[ThreadShare, ...] = ()
    pending: int = 0
    pending_terms: tuple[WorkTerm, ...] = ()
    unfinished: int = 0
    thread_wait: int = 0
    """How much of the terms is a wait for threads of a container: time, and not work of a core."""
    is_backlog: bool = False
    """Whether all cores may be busy with `beside_terms` and what was pending, less `unfinished` and the own terms."""
    leads: tuple[int, ...] = ()
    """On cores that are shared fairly: what no other thread is served before it beyond its own work."""
    core: int | None = None
    """The core that alone gives the figure of what may run on several."""
    is_joined: bool = False
    """Whether cores and the resources that their threads use are taken as one processor: each works while anything is pending."""
    is_queue: bool = False
    """Whether `window` is the work that comes before the end of an activation in a queue, itself included."""
    is_hold: bool = False
    """Whether `window` is the longest time in which there is so much to do, until an activation that is not counted."""

    @property
    def work(self) -> int:
        """Return what the terms add up to."""
        return sum(term.total for term in self.terms) + self.blocked_time

    @property
    def is_consistent(self) -> bool:
        """Whether the terms add up to the window, and the window to the figure."""
        if self.addends:
            return self.value == sum(working.value for working in self.addends) and all(
                working.is_consistent for working in self.addends
            )
        if self.is_hold and (self.core_count > 1 or self.leads):
            return self.work >= self.window == self.value
        # On several cores a longer window may ask for less: then the first one that is long enough is not all used.
        work = self.work
        is_whole = work == self.window or ((self.core_count > 1 or bool(self.leads)) and work < self.window)
        return is_whole and self.value == max(self.window - self.arrival - self.lead, 0)


def shorten_working(working: FigureWorking, lead: int) -> FigureWorking:
    """Return the working of what is left of a run from the earliest start of its last step on."""
    if not lead or working.addends:
        return working
    value = max(working.value - lead, 0)
    return replace(working, value=value, lead=working.lead + lead)


def describe_origin(origin: EventOrigin, entering_arcs: Sequence[FiringArc]) -> str:
    """Say of which events work comes."""
    if origin.kind == "arc":
        arc = entering_arcs[int(origin.key)].arc
        return f"events of {arc.topic} from {arc.source}"
    return f"events of {origin.key}"


def add_last_step(
    steps: tuple[str, ...], first: FigureWorking | None, last: FigureWorking | None
) -> Iterator[FigureWorking]:
    """Yield how the time of a run comes about as a sum: of the time to the step before the last one, and its response."""
    if first and last:
        yield FigureWorking(first.value + last.value, 0, (), steps=steps, addends=(first, last))


def choose_working(workings: Iterable[FigureWorking], value: int) -> FigureWorking | None:
    """Return the first working that gives a figure, and whose terms add up."""
    return next((each for each in workings if each.value == value and each.is_consistent), None)
