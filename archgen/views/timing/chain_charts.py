"""Charts of chains: the terms of a chain against its deadline. Charts of hosts are in `load_charts`.

The run in which a chain was late: its way in red, what each thread did, and who held what, in ms.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction

from archgen.frozen import NamedTuple
from archgen.simulation.drawn_orders import describe_orders
from archgen.simulation.schedule_log import LateSchedule, TrackSpan
from archgen.timing.analysis import ChainResult, ChainVerdict
from archgen.timing.chains.chain_advice import describe_lateness, sum_known_parts
from archgen.timing.figures.figure_wording import format_duration
from archgen.timing.figures.timing_values import TimingValue, is_known_bound
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import BarSegment, Chart, ChartBar, SegmentKind
from archgen.views.shapes import Block, Figure, Paragraph, Text
from archgen.views.timing import chain_status, load_charts, value_format
from archgen.views.timing.load_charts import is_outside_scope, to_float
from archgen.views.timing.timing_lookup import TimingLookup


class _Piece(NamedTuple):
    """A stretch of a row, in ns."""

    start: Fraction
    end: Fraction
    kind: SegmentKind
    label: str
    tooltip: str


def make_late_run_charts(lookup: Lookup, timing_lookup: TimingLookup) -> Iterator[Chart]:
    """Yield the picture of the late run of each chain that has one."""
    for result in timing_lookup.chains:
        schedule = timing_lookup.late_runs.get(result.id)
        if schedule is not None and result.id in lookup.architecture.chains:
            yield _make_chart(lookup, result, schedule)


def make_late_run_figures(lookup: Lookup, timing_lookup: TimingLookup, result: ChainResult) -> tuple[Block, ...]:
    """Return the picture of a chain's late run, and how to see it again; empty where there is none."""
    schedule = timing_lookup.late_runs.get(result.id)
    if schedule is None or result.late_run is None:
        return ()
    name, title = f"chains/{result.id}.late", lookup.architecture.chains[result.id].title
    command = f"{result.late_run.write_command(result.id)} --trace late.json"
    lead = f"A simulated run in which it took {format_duration(result.late_run.longest)}; for https://ui.perfetto.dev:"
    figure = Figure(f"figure:{name}", name, f"{title}: a run in which it is late", describe_orders(schedule.orders))
    return Paragraph((Text(f"{lead} "), Text(command, code=True))), figure


def _make_chart(lookup: Lookup, result: ChainResult, schedule: LateSchedule) -> Chart:
    deadline = result.deadline.value if result.deadline else None
    title, way = lookup.architecture.chains[result.id].title, list(_list_way_pieces(schedule))
    return Chart(
        f"chains/{result.id}.late",
        f"{title}: a run in which it is late",
        "ms",
        (_draw_bar(schedule, "The chain", way, format_duration(schedule.longest)), *_list_rows(lookup, schedule)),
        limit=(to_float(deadline / _NS_PER_MS), f"deadline {format_duration(deadline)}") if deadline else None,
        conclusion=f"Late: {format_duration(schedule.longest)} in this run.",
        legend=("missed: works for the chain", "late_wait: keeps it waiting", "response: works", "other_load: waits"),
        notes=(describe_orders(schedule.orders),) if schedule.orders else (),
        alt=f"{title}: {'; '.join(piece.tooltip for piece in way)}.",
    )


def _list_way_pieces(schedule: LateSchedule) -> Iterator[_Piece]:
    """Yield the steps of the chain, each with who held it up."""
    for step in schedule.way:
        holders = [f"{name} {format_duration(time)}" for name, time in step.holders]
        tooltip = f"{step.words}, held up by {', '.join(holders)}" if holders else step.words
        label = f"held up by {holders[0]}" if holders and step.kind != "works" else step.words
        yield _Piece(step.start, step.end, "missed" if step.kind == "works" else "late_wait", label, tooltip)


def _list_rows(lookup: Lookup, schedule: LateSchedule) -> Iterator[ChartBar]:
    """Yield a row for each thread on the way, or of who held the chain up, and for each resource that they use; by host."""
    concerned = {step.activity for step in schedule.way} | {name for step in schedule.way for name, _ in step.holders}
    rows: dict[tuple[str, str], list[_Piece]] = {}
    for track in sorted(schedule.tracks, key=lambda track: track.host):
        if any(span.activity in concerned for span in track.spans):
            rows[track.host, track.name] = [_make_piece(span) for span in track.spans]
    used = {span.resource for track in schedule.tracks for span in track.spans if span.is_on_way and span.resource}
    for resource in sorted(used):
        spans = [
            span
            for track in schedule.tracks
            for span in track.spans
            if (span.resource, span.state) == (resource, "uses")
        ]
        rows["", resource] = [_make_piece(span) for span in sorted(spans, key=lambda span: span.start)]
    for (host, name), pieces in rows.items():
        title = lookup.architecture.hosts[host].title if host in lookup.architecture.hosts else host
        yield _draw_bar(schedule, f"{name} on {title}" if host else name, pieces)


def _make_piece(span: TrackSpan) -> _Piece:
    waits = span.state in {"ready", "awaits"}
    kind: SegmentKind = (
        ("late_wait" if waits else "missed") if span.is_on_way else "other_load" if waits else "response"
    )
    return _Piece(span.start, span.end, kind, span.activity, span.activity)


def _draw_bar(schedule: LateSchedule, title: str, pieces: Iterable[_Piece], value: str = "") -> ChartBar:
    """Draw what lies within the way, with gaps between."""
    time, last = schedule.way[0].start, schedule.way[-1].end
    segments: list[BarSegment] = []
    for piece in pieces:
        start, end = max(piece.start, time), min(piece.end, last)
        if end > start:
            if start > time:
                segments.append(BarSegment(to_float((start - time) / _NS_PER_MS), "gap"))
            tooltip = f"{piece.tooltip}: {format_duration(end - start)}"
            segments.append(BarSegment(to_float((end - start) / _NS_PER_MS), piece.kind, piece.label, tooltip))
            time = end
    return ChartBar(title, tuple(segments), value, strong=bool(value))


_NS_PER_MS = 10**6
_TERM_KINDS = ("sampling", "response", "link")
"""Kinds of term in the order in which they follow each other in time; fields of `Term`."""


def make_timing_charts(lookup: Lookup) -> tuple[Chart, ...]:
    """Make the charts of all chains and hosts with something in scope; none without a timing analysis."""
    timing_lookup = lookup.timing
    return (
        ()
        if timing_lookup is None
        else (*_make_chain_charts(lookup, timing_lookup), *load_charts.make_load_charts(lookup, timing_lookup))
    )


def _make_chain_charts(lookup: Lookup, timing_lookup: TimingLookup) -> Iterator[Chart]:
    """Yield the chart of each chain that runs through a shown activity."""
    for result in timing_lookup.chains:
        is_shown = lookup.scope.nodes is None or not all(
            is_outside_scope(lookup, timing_lookup, term.activity) for term in result.terms
        )
        if result.terms and is_shown and result.id in lookup.architecture.chains:
            yield make_chain_chart(lookup, timing_lookup, result)
    yield from make_late_run_charts(lookup, timing_lookup)


def make_chain_chart(lookup: Lookup, timing_lookup: TimingLookup, result: ChainResult) -> Chart:
    """Draw the terms of a chain's bound below each other, and their sum against the deadline."""
    title = lookup.architecture.chains[result.id].title
    deadline = result.deadline.value if result.deadline else None
    verdict_text = describe_chain_verdict(result, timing_lookup)
    term_bars = tuple(_make_term_bars(lookup, timing_lookup, result))
    length = None if result.best.value is None else to_float(result.best.value / _NS_PER_MS)
    segment = BarSegment(length, "best", "", f"best case: {value_format.display_lower_bound(result.best)}")
    return Chart(
        f"chains/{result.id}",
        f"{title}: how the time adds up",
        "ms",
        (
            *term_bars,
            _bound_bar(result),
            ChartBar("At the earliest", (segment,), value_format.display_lower_bound(result.best)),
        ),
        limit=(to_float(deadline / _NS_PER_MS), f"deadline {value_format.display_duration(TimingValue(deadline))}")
        if deadline
        else None,
        conclusion=verdict_text,
        legend=tuple(_legend_keys(result)),
        notes=(load_charts.OUTSIDE_NOTE,) if any(bar.is_outside for bar in term_bars) else (),
        alt=f"{title} runs through {', '.join(result.through)}. {verdict_text}",
    )


def _make_term_bars(lookup: Lookup, timing_lookup: TimingLookup, result: ChainResult) -> Iterator[ChartBar]:
    """Yield a bar for each step, starting where the steps before it end; what is unknown of them pushes it."""
    start, gaps = Fraction(0), 0
    for term in result.terms:
        values = (term.sampling, term.response, term.link)
        activity = timing_lookup.analysis.system.activities.get(term.activity)
        yield ChartBar(
            term.activity,
            tuple(_term_segment(kind, value) for kind, value in zip(_TERM_KINDS, values, strict=True)),
            _format_increment(values),
            to_float(start / _NS_PER_MS),
            gaps,
            ref=f"node:{activity.node}" if activity else None,
            is_outside=is_outside_scope(lookup, timing_lookup, term.activity),
        )
        start += sum_known_parts(term)
        gaps += any(value.value is None for value in values)


_TERM_KIND_WORDS = {"sampling": "waits", "response": "responds within", "link": "on the network"}


def _term_segment(kind: str, value: TimingValue) -> BarSegment:
    """Draw one part of a step."""
    length = None if value.value is None else to_float(value.value / _NS_PER_MS)
    duration_text = value_format.display_duration(value)
    return BarSegment(length, kind, duration_text, f"{_TERM_KIND_WORDS[kind]}: {duration_text}")  # type: ignore[arg-type]


def _format_increment(values: tuple[TimingValue, ...]) -> str:
    """Format what a step adds: the sum of what is known, and "+ ?" where more is unknown."""
    known_values = [value for value in values if value.value is not None]
    total = sum((value.value or Fraction(0) for value in known_values), Fraction(0))
    # A part with a sign before it bounds from one side only; a zero sum of such parts says nothing.
    is_partial = len(known_values) < len(values) or any(value_format.bound_sign(value) for value in known_values)
    if is_partial and not total:
        return value_format.UNKNOWN_FIGURE
    return f"+ {value_format.display_duration(TimingValue(total))}{' + ?' if len(known_values) < len(values) else ''}"


_VERDICT_KINDS: Mapping[ChainVerdict, SegmentKind] = {
    "met": "met",
    "missed": "missed",
    "not proven": "unproven",
    "open": "open",
}


def _bound_bar(result: ChainResult) -> ChartBar:
    """Draw the bound; without a complete one a hatched piece follows."""
    length = None if result.bound.value is None else to_float(result.bound.value / _NS_PER_MS)
    known_segments = (
        ()
        if length is None
        else (
            BarSegment(
                length, _VERDICT_KINDS[result.verdict], "", f"bound: {value_format.display_duration(result.bound)}"
            ),
        )
    )
    unknown_segments = (
        () if result.bound.complete and length is not None else (BarSegment(None, "open", "?", "no bound is known"),)
    )
    return ChartBar(
        "Reaction at the latest",
        (*known_segments, *unknown_segments),
        value_format.display_duration(result.bound),
        strong=True,
    )


def describe_chain_verdict(result: ChainResult, timing_lookup: TimingLookup) -> str:
    """Describe in one sentence whether a chain meets its deadline, and by how much."""
    bound, deadline = result.bound, result.deadline
    missing_text = value_format.describe_missing(bound, timing_lookup.analysis, 4)
    bound_text = value_format.display_duration(bound) + (f"; no bound: {missing_text}" if missing_text else "")
    if deadline is None or deadline.value is None:
        return f"No deadline. {'At the latest after ' if is_known_bound(bound) else ''}{bound_text}."
    if result.verdict == "open":
        return f"Open: {bound_text}."
    if result.verdict != "met" or bound.value is None:
        return f"{result.verdict.capitalize()}. {describe_lateness(timing_lookup.analysis, result, deadline.value)}"
    left_text = chain_status.round_duration(deadline.value - bound.value, ">")
    return (
        f"Met: at the latest after {value_format.display_duration(bound)}, {left_text} before the deadline of "
        f"{value_format.display_duration(deadline)}."
    )


def _legend_keys(result: ChainResult) -> Iterator[str]:
    """Yield the kinds of segment that this chart has."""
    for kind in _TERM_KINDS:
        if any(getattr(term, kind).value for term in result.terms):
            yield kind
    if (
        any(any(value.value is None for value in (term.sampling, term.response, term.link)) for term in result.terms)
        or not result.bound.complete
    ):
        yield "unknown"
