"""A late run as Chrome and Perfetto read it: events of the documented kinds, whose times add up, whatever names are."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import replace
from itertools import pairwise
from typing import Any

import pytest

from archgen.emit.data.trace_events import format_trace
from archgen.simulation.schedule_log import LateSchedule
from tests.simulation.late_robot import record_witnesses

_KEYS = {
    "X": {"name", "ph", "ts", "dur", "pid", "tid"},
    "M": {"name", "ph", "pid", "tid", "args"},
    "s": {"name", "cat", "ph", "ts", "pid", "tid", "id"},
    "f": {"name", "cat", "ph", "ts", "pid", "tid", "id", "bp"},
}
"""What the format asks of complete events, metadata and the ends of flows."""


@pytest.fixture(scope="module", name="schedule")
def make_schedule() -> LateSchedule:
    return record_witnesses()["stop"][1]


def _read(schedule: LateSchedule, name: str = "stop") -> dict[str, Any]:
    events: dict[str, Any] = json.loads(format_trace(name, schedule))
    return events


def test_each_event_has_what_the_format_asks_for(schedule: LateSchedule) -> None:
    document = _read(schedule)
    assert document["displayTimeUnit"] == "ms"
    events = document["traceEvents"]
    for event in events:
        assert _KEYS[event["ph"]] <= set(event)
        assert all(isinstance(event[key], int) for key in ("pid", "tid"))
        assert all(isinstance(event[key], (int, float)) and event[key] >= 0 for key in ("ts", "dur") if key in event)
    # Each process and each track that something happens on has a name.
    named = {(event["name"], event["pid"], event["tid"]) for event in events if event["ph"] == "M"}
    for event in events:
        if event["ph"] == "X":
            assert {("process_name", event["pid"], 0), ("thread_name", event["pid"], event["tid"])} <= named


def test_the_way_adds_up_to_the_witness_and_says_who_held_it_up(schedule: LateSchedule) -> None:
    document = _read(schedule)
    way = [event for event in document["traceEvents"] if event["ph"] == "X" and event["cat"] == "chain"]
    assert sum(event["dur"] for event in way) == pytest.approx(float(schedule.longest) / 1000, abs=1e-6)
    assert document["otherData"]["longest_ms"] == float(schedule.longest) / 10**6
    assert document["otherData"]["orders"] == [order._asdict() for order in schedule.orders]
    assert any("planner" in event["args"].get("held up by (ms)", {}) for event in way)
    waits = [event for event in document["traceEvents"] if event.get("cat") == "awaits"]
    assert waits
    assert all(event["args"]["held by"] for event in waits)


def test_arrows_lead_from_slice_to_slice(schedule: LateSchedule) -> None:
    events = _read(schedule)["traceEvents"]
    slices = [event for event in events if event["ph"] == "X"]
    ends = [event for event in events if event["ph"] in "sf"]
    assert Counter(event["id"] for event in ends) == Counter({0: 2, 1: 2})
    for end in ends:
        assert any(
            (each["pid"], each["tid"], each["ts"]) == (end["pid"], end["tid"], end["ts"]) and each["dur"]
            for each in slices
        )


def test_slices_of_a_track_never_overlap(schedule: LateSchedule) -> None:
    tracks: dict[tuple[int, int], list[tuple[float, float]]] = {}
    for event in _read(schedule)["traceEvents"]:
        if event["ph"] == "X":
            tracks.setdefault((event["pid"], event["tid"]), []).append((event["ts"], event["ts"] + event["dur"]))
    for spans in tracks.values():
        assert all(end <= start + 1e-6 for (_, end), (start, _) in pairwise(spans))


def test_names_of_any_kind_are_only_text(schedule: LateSchedule) -> None:
    name = 'a"},{"ph":"M</script>\x1b[2J\u202e\x00'
    track = schedule.tracks[0]
    hostile = replace(schedule, tracks=(track._replace(name=name, host=name), *schedule.tracks[1:]))
    data = format_trace(name, hostile)
    assert b"\x1b" not in data
    assert "\u202e" not in data.decode()
    # One host more has a name and a place.
    assert len(json.loads(data)["traceEvents"]) == len(_read(schedule)["traceEvents"]) + 2


def test_the_same_run_gives_the_same_bytes(schedule: LateSchedule) -> None:
    assert format_trace("stop", schedule) == format_trace("stop", record_witnesses()["stop"][1])
