"""A late run in Chrome's trace event format, as https://ui.perfetto.dev opens it: hosts are processes, threads are tracks.

The format: https://docs.google.com/document/d/1CvAClvFfyA5R-PhYUmn5OOQtYMH4h6I0nSsKchNAySU. Times are in microseconds.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

from archgen.diagnostics.safe_text import format_json, make_visible
from archgen.simulation.schedule_log import LateSchedule, ThreadSpan, WayStep, describe_step

_CHAIN_PROCESS = 1
_STATE_WORDS = {"runs": "", "ready": "waits for a core", "awaits": "waits for", "uses": "uses"}
TraceEvent = dict[str, Any]


def format_trace(chain_id: str, schedule: LateSchedule) -> bytes:
    """Return the file: the way of the chain in a track of its own, what each thread did, arrows from job to job."""
    tracks = _Tracks(schedule)
    uses = [span for span in schedule.spans if span.state == "uses"]
    spans = [_make_span(schedule, tracks, span, uses) for span in schedule.spans]
    way = [_make_step(schedule, step) for step in schedule.way]
    arrows = list(_list_arrows(schedule, tracks))
    about = {
        "chain": make_visible(chain_id),
        "longest_ms": float(schedule.longest / 10**6),
        "seed": schedule.seed,
        "seconds": schedule.seconds,
        "orders": [{key: make_visible(text) for key, text in order._asdict().items()} for order in schedule.orders],
    }
    events = [*tracks.list_names(f"chain {chain_id}"), *way, *spans, *arrows]
    return format_json({"traceEvents": events, "displayTimeUnit": "ms", "otherData": about}).encode()


class _Tracks:
    """The numbers of processes (hosts) and tracks (threads), in the order in which they appear in the plan."""

    def __init__(self, schedule: LateSchedule) -> None:
        plan = schedule.run.plan
        self.of_thread: dict[int, tuple[int, int]] = {}
        self.names: dict[tuple[int, int], str] = {}
        self.processes: dict[str, int] = {}
        first_spans = {span.thread: span for span in reversed(schedule.spans)}
        for thread, span in sorted(first_spans.items()):
            callback = plan.callbacks[span.callback]
            host = plan.processors[plan.activities[callback.activity].processor].host or "without a host"
            process = self.processes.setdefault(host, len(self.processes) + _CHAIN_PROCESS + 1)
            # Names are `container navbox` and `node base`.
            name = plan.executors[callback.executor].id.partition(" ")[2]
            number = sum(each.partition(" (")[0] == name for each in self.names.values()) + 1
            self.of_thread[thread] = process, thread + 1
            self.names[process, thread + 1] = name if number == 1 else f"{name} ({number})"

    def list_names(self, chain_title: str) -> Iterator[TraceEvent]:
        """Yield the names of processes and tracks: that of the chain first."""
        names = {(_CHAIN_PROCESS, 0): chain_title, **{(number, 0): host for host, number in self.processes.items()}}
        for (process, thread), name in (*names.items(), ((_CHAIN_PROCESS, 1), "its way"), *self.names.items()):
            kind = "thread" if thread else "process"
            place = {"ph": "M", "pid": process, "tid": thread}
            yield {"name": f"{kind}_name", **place, "args": {"name": make_visible(name)}}
            yield {"name": f"{kind}_sort_index", **place, "args": {"sort_index": thread or process}}


def _make_slice(
    schedule: LateSchedule, name: str, place: tuple[int, int], times: tuple[int, int], **rest: object
) -> TraceEvent:
    start, end = times
    unit, (process, thread) = schedule.run.plan.unit / 1000, place
    span = {"ts": float(start * unit), "dur": float((end - start) * unit), "pid": process, "tid": thread}
    return {"name": make_visible(name), "ph": "X", **span, **rest}


def _make_span(schedule: LateSchedule, tracks: _Tracks, span: ThreadSpan, uses: Sequence[ThreadSpan]) -> TraceEvent:
    plan = schedule.run.plan
    callback = plan.callbacks[span.callback]
    name = f"{plan.activities[callback.activity].id}{' stores' if callback.is_storing else ''}"
    resource = plan.resources[span.resource].id if span.resource >= 0 else ""
    words = " ".join(filter(None, (name, _STATE_WORDS[span.state], resource)))
    holders = [
        make_visible(plan.activities[plan.callbacks[use.callback].activity].id)
        for use in (uses if span.state == "awaits" else ())
        if use.resource == span.resource and use.start < span.end and use.end > span.start
    ]
    more = {"args": {"held by": holders}} if holders else {}
    return _make_slice(schedule, words, tracks.of_thread[span.thread], (span.start, span.end), cat=span.state, **more)


def _make_step(schedule: LateSchedule, step: WayStep) -> TraceEvent:
    unit = schedule.run.plan.unit / 10**6
    held: Mapping[str, float] = {make_visible(name): float(time * unit) for name, time in step.holders}
    words, colour = describe_step(schedule, step), "terrible" if step.kind != "works" else "bad"
    place, times = (_CHAIN_PROCESS, 1), (step.start, step.end)
    return _make_slice(schedule, words, place, times, cat="chain", cname=colour, args={"held up by (ms)": held})


def _list_arrows(schedule: LateSchedule, tracks: _Tracks) -> Iterator[TraceEvent]:
    """Yield an arrow from each job of the way to the next one, between the slices in which they begin to run."""
    callbacks, unit = schedule.run.plan.callbacks, schedule.run.plan.unit / 1000
    runs = {
        (callbacks[span.callback].activity, span.job): span
        for span in reversed(schedule.spans)
        if span.state == "runs" and not callbacks[span.callback].is_storing
    }
    # What has a declared response ends without a thread: no arrow leads there.
    ends = [runs[job] for job in dict.fromkeys((step.activity, step.job) for step in schedule.way) if job in runs]
    for number, pair in enumerate(pairwise(ends)):
        for phase, span in zip("sf", pair, strict=True):
            process, thread = tracks.of_thread[span.thread]
            place = {"ts": float(span.start * unit), "pid": process, "tid": thread, "id": number}
            yield {"name": "the chain", "cat": "chain", "ph": phase, **place, **({"bp": "e"} if phase == "f" else {})}
