"""A late run in Chrome's trace event format, as https://ui.perfetto.dev opens it: hosts are processes, threads are tracks.

The format: https://docs.google.com/document/d/1CvAClvFfyA5R-PhYUmn5OOQtYMH4h6I0nSsKchNAySU. Times are in microseconds.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from fractions import Fraction
from itertools import pairwise
from typing import Any

from archgen.diagnostics import make_visible
from archgen.simulation.schedule_log import LateSchedule, TrackSpan

_STATE_WORDS = {"runs": "", "ready": "waits for a core", "awaits": "waits for", "uses": "uses"}
_Place = tuple[int, int]
"""The numbers of a process and a track."""
_WAY_PLACE: _Place = 1, 1
TraceEvent = dict[str, Any]


def format_trace(chain_id: str, schedule: LateSchedule) -> bytes:
    """Return the file: the way of the chain in a track of its own, what each thread did, arrows from job to job."""
    hosts = {host: number for number, host in enumerate(dict.fromkeys(track.host for track in schedule.tracks), 2)}
    places = [(hosts[track.host], number) for number, track in enumerate(schedule.tracks, 1)]
    names: dict[_Place, str] = {(1, 0): f"chain {chain_id}", _WAY_PLACE: "its way"}
    names |= {(number, 0): host or "without a host" for host, number in hosts.items()}
    names |= {place: track.name for place, track in zip(places, schedule.tracks, strict=True)}
    placed_spans = [(place, span) for place, track in zip(places, schedule.tracks, strict=True) for span in track.spans]
    uses = [span for _, span in placed_spans if span.state == "uses"]
    events: list[TraceEvent] = [event for place, name in names.items() for event in _name_place(place, name)]
    for step in schedule.way:
        held = {make_visible(name): float(time / 10**6) for name, time in step.holders}
        colour, args = "bad" if step.kind == "works" else "terrible", {"held up by (ms)": held} if held else {}
        events.append(_make_slice(step.words, _WAY_PLACE, step.start, step.end, cat="chain", cname=colour, args=args))
    for place, span in placed_spans:
        subject = f"{span.activity} stores" if span.is_storing else span.activity
        words = " ".join(filter(None, (subject, _STATE_WORDS[span.state], span.resource)))
        holders = list(dict.fromkeys(_list_holders(span, uses))) if span.state == "awaits" else []
        more = {"args": {"held by": holders}} if holders else {}
        events.append(_make_slice(words, place, span.start, span.end, cat=span.state, **more))
    about = {
        "chain": make_visible(chain_id),
        "longest_ms": float(schedule.longest / 10**6),
        "seed": schedule.seed,
        "seconds": schedule.seconds,
        "orders": [{key: make_visible(text) for key, text in order._asdict().items()} for order in schedule.orders],
    }
    events += _list_arrows(
        schedule,
        {
            (each.activity, each.job): (at, each)
            for at, each in placed_spans[::-1]
            if each.is_on_way and each.state == "runs"
        },
    )
    # Without blanks: a minute of a large robot has a hundred thousand events.
    document = {"traceEvents": events, "displayTimeUnit": "ms", "otherData": about}
    return json.dumps(document, separators=(",", ":")).encode()


def _name_place(place: _Place, name: str) -> Iterator[TraceEvent]:
    """Yield the name of a process or a track, and where it stands among the others."""
    kind, where = "thread" if place[1] else "process", {"ph": "M", "pid": place[0], "tid": place[1]}
    yield {"name": f"{kind}_name", **where, "args": {"name": make_visible(name)}}
    yield {"name": f"{kind}_sort_index", **where, "args": {"sort_index": place[1] or place[0]}}


def _make_slice(name: str, place: _Place, start: Fraction, end: Fraction, **rest: object) -> TraceEvent:
    times = {"ts": float(start / 1000), "dur": float((end - start) / 1000)}
    return {"name": make_visible(name), "ph": "X", **times, "pid": place[0], "tid": place[1], **rest}


def _list_holders(wait: TrackSpan, uses: list[TrackSpan]) -> Iterator[str]:
    """Yield who used the resource that a thread waited for meanwhile."""
    for use in uses:
        if use.resource == wait.resource and use.start < wait.end and use.end > wait.start:
            yield make_visible(use.activity)


def _list_arrows(
    schedule: LateSchedule, runs: Mapping[tuple[str, int], tuple[_Place, TrackSpan]]
) -> Iterator[TraceEvent]:
    """Yield an arrow from each job of the way to the next one, between the slices in which they begin to run."""
    # What has a declared response ends without a thread: no arrow leads there.
    jobs = [job for job in dict.fromkeys((step.activity, step.job) for step in schedule.way) if job in runs]
    for number, pair in enumerate(pairwise(jobs)):
        for phase, job in zip("sf", pair, strict=True):
            (process, thread), span = runs[job]
            place = {"ts": float(span.start / 1000), "pid": process, "tid": thread, "id": number}
            yield {"name": "the chain", "cat": "chain", "ph": phase, **place, **({"bp": "e"} if phase == "f" else {})}
