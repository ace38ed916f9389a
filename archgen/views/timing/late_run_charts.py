"""A picture of the run in which a chain was late: its way in red, what each thread did, and who held what, in ms."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

from archgen.frozen import NamedTuple
from archgen.simulation.drawn_orders import describe_orders
from archgen.simulation.schedule_log import LateSchedule, TrackSpan
from archgen.timing.analysis import ChainResult
from archgen.timing.figures.figure_wording import format_duration
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import BarSegment, Chart, ChartBar, SegmentKind
from archgen.views.shapes import Block, Figure, Paragraph, Text
from archgen.views.timing.load_charts import to_float
from archgen.views.timing.timing_lookup import TimingLookup

_NS_PER_MS = 10**6


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
