"""A picture of the run in which a chain was late: its way in red, what each thread did, and who held what, in ms."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.simulation.drawn_orders import describe_orders
from archgen.simulation.schedule_log import LateSchedule, ThreadSpan, describe_step
from archgen.timing.analysis import ChainResult
from archgen.timing.figures.figure_wording import format_duration
from archgen.views.chart_shapes import BarSegment, Chart, ChartBar, SegmentKind
from archgen.views.lookup import Lookup
from archgen.views.shapes import Block, Figure, Paragraph, Text
from archgen.views.timing.load_charts import to_float
from archgen.views.timing.timing_lookup import TimingLookup

_NS_PER_MS = 10**6
_Piece = tuple[int, int, SegmentKind, str]
"""From when to when, in units, how it is drawn, and what it is."""


def make_late_run_charts(lookup: Lookup, timing_lookup: TimingLookup) -> Iterator[Chart]:
    """Yield the picture of the late run of each chain that has one."""
    for result in timing_lookup.chains:
        schedule = timing_lookup.late_runs.get(result.id)
        if schedule is not None and result.id in lookup.architecture.chains:
            yield _make_chart(lookup, result, schedule)


def make_late_run_figures(lookup: Lookup, timing_lookup: TimingLookup, result: ChainResult) -> tuple[Block, ...]:
    """Return the picture of a chain's late run, and how to see it again; empty where there is none."""
    schedule = timing_lookup.late_runs.get(result.id)
    if schedule is None:
        return ()
    name, title = f"chains/{result.id}.late", lookup.architecture.chains[result.id].title
    command = (
        f"archgen simulate --chain {result.id} --seed {schedule.seed} --seconds {schedule.seconds} --trace late.json"
    )
    lead = f"A simulated run in which it took {format_duration(schedule.longest)}; for https://ui.perfetto.dev:"
    figure = Figure(f"figure:{name}", name, f"{title}: a run in which it is late", describe_orders(schedule.orders))
    return Paragraph((Text(f"{lead} "), Text(command, code=True))), figure


def _make_chart(lookup: Lookup, result: ChainResult, schedule: LateSchedule) -> Chart:
    plan, deadline = schedule.run.plan, result.deadline.value if result.deadline else None
    words = [describe_step(schedule, step) for step in schedule.way]
    way: list[_Piece] = []
    for step, text in zip(schedule.way, words, strict=True):
        held = ", ".join(f"{name} {format_duration(time * plan.unit)}" for name, time in step.holders)
        kind: SegmentKind = "missed" if step.kind == "works" else "late_wait"
        way.append((step.start, step.end, kind, f"{text}{f', held up by {held}' if held else ''}"))
    title = lookup.architecture.chains[result.id].title
    return Chart(
        f"chains/{result.id}.late",
        f"{title}: a run in which it is late",
        "ms",
        (_draw_bar(schedule, "The chain", way, strong=True), *_list_thread_bars(lookup, schedule)),
        limit=(to_float(deadline / _NS_PER_MS), f"deadline {format_duration(deadline)}") if deadline else None,
        conclusion=f"Late: {format_duration(schedule.longest)} in this run.",
        legend=(
            "missed: works for the chain",
            "late_wait: keeps the chain waiting",
            "response: works",
            "other_load: waits",
        ),
        notes=(describe_orders(schedule.orders),) if schedule.orders else (),
        alt=f"{title}: {'; '.join(text for _, _, _, text in way)}.",
    )


def _list_thread_bars(lookup: Lookup, schedule: LateSchedule) -> Iterator[ChartBar]:
    """Yield a row for each thread and resource on the way, or of who held the chain up, by host."""
    plan, callbacks = schedule.run.plan, schedule.run.plan.callbacks
    on_way = {(step.activity, step.job) for step in schedule.way}
    names = {plan.activities[activity].id for activity, _ in on_way} | {
        name for step in schedule.way for name, _ in step.holders
    }
    executors = {each.executor for each in callbacks if plan.activities[each.activity].id in names}
    rows: dict[tuple[str, int, int], list[_Piece]] = {}
    for span in schedule.spans:
        callback = callbacks[span.callback]
        host = plan.processors[plan.activities[callback.activity].processor].host or ""
        if callback.executor in executors:
            rows.setdefault((host, -1, span.thread), []).append(_make_piece(schedule, span, on_way))
        if span.state == "uses" and any(
            use[0] == span.resource for name, _ in on_way for use in plan.activities[name].uses
        ):
            rows.setdefault((host, span.resource, -1), []).append(_make_piece(schedule, span, on_way))
    first_callbacks = {span.thread: callbacks[span.callback] for span in reversed(schedule.spans)}
    for (host, resource, thread), pieces in sorted(rows.items()):
        name = (
            plan.resources[resource].id
            if resource >= 0
            else plan.executors[first_callbacks[thread].executor].id.partition(" ")[2]
        )
        host_title = lookup.architecture.hosts[host].title if host in lookup.architecture.hosts else host
        yield _draw_bar(schedule, f"{name} on {host_title}" if host else name, pieces)


def _make_piece(schedule: LateSchedule, span: ThreadSpan, on_way: Iterable[tuple[int, int]]) -> _Piece:
    plan = schedule.run.plan
    callback = plan.callbacks[span.callback]
    is_way = (callback.activity, span.job) in on_way and not callback.is_storing
    waits = span.state in {"ready", "awaits"}
    kind: SegmentKind = ("late_wait" if waits else "missed") if is_way else ("other_load" if waits else "response")
    return span.start, span.end, kind, plan.activities[callback.activity].id


def _draw_bar(schedule: LateSchedule, title: str, pieces: Iterable[_Piece], *, strong: bool = False) -> ChartBar:
    """Draw what lies within the way, with gaps between."""
    first, last, unit = schedule.way[0].start, schedule.way[-1].end, schedule.run.plan.unit
    segments: list[BarSegment] = []
    time = first
    for piece_start, piece_end, kind, text in pieces:
        start, end = max(piece_start, time), min(piece_end, last)
        if end > start:
            if start > time:
                segments.append(BarSegment(to_float((start - time) * unit / _NS_PER_MS), "gap"))
            length = (end - start) * unit
            segments.append(BarSegment(to_float(length / _NS_PER_MS), kind, text, f"{text}: {format_duration(length)}"))
            time = end
    return ChartBar(title, tuple(segments), format_duration((last - first) * unit) if strong else "", strong=strong)
