"""Lines of a trace: the three ways to print a time, midnight, and what is no event."""

from __future__ import annotations

import io

import pytest

from archgen.plugins.recordings.recorded_figures import Oddities, RecordingError, RecordingSource
from archgen.plugins.recordings.trace_events import TraceEvent, TraceLoss, is_trace_line, read_trace_events

EVENT = "(+0.000000001) robot ros2:callback_end: { cpu_id = 3 }, { vpid = 7, vtid = 8 }, { callback = 0x5 }"


def _read(*lines: str) -> list[TraceEvent | TraceLoss]:
    source = RecordingSource("trace.txt", io.BytesIO("\n".join(lines).encode()))
    return list(read_trace_events(source, Oddities(source)))


def _times(*times: str) -> list[int]:
    events = _read(*(f"[{time}] {EVENT}" for time in times))
    return [events_time - first for events_time in (_time_of(e) for e in events) for first in [_time_of(events[0])]]


def _time_of(event: TraceEvent | TraceLoss) -> int:
    assert isinstance(event, TraceEvent)
    return event.time


@pytest.mark.parametrize(
    "times",
    [
        ("12:00:00.000000001", "12:00:01.5"),
        ("23:59:59.000000001", "00:00:00.500000000"),
        ("2026-11-22 12:00:00.000000001", "2026-11-22 12:00:01.500000000"),
        ("2026-12-31 23:59:59.000000001", "2027-01-01 00:00:00.500000000"),
        ("1664288798.000000001", "1664288799.500000000"),
    ],
)
def test_times_are_exact_however_they_are_printed(times: tuple[str, str]) -> None:
    assert _times(*times) == [0, 1_499_999_999]


@pytest.mark.parametrize("time", ["00123456789", "25-13-40", "12:00", "2026-02-30 12:00:00.1", "12:61:00.1"])
def test_a_time_that_is_none_ends_the_reading(time: str) -> None:
    with pytest.raises(RecordingError, match="neither a time of day nor in seconds"):
        _read(f"[{time}] {EVENT}")


def test_two_formats_of_times_in_one_trace_end_the_reading() -> None:
    with pytest.raises(RecordingError, match="given as time of day, and from here on as seconds"):
        _read(f"[12:00:00.1] {EVENT}", f"[1664288798.1] {EVENT}")


def test_host_process_thread_and_fields_are_read() -> None:
    event = _read(f"[12:00:00.1] {EVENT}")[0]
    assert isinstance(event, TraceEvent)
    assert (event.name, event.process, event.thread, event.fields["callback"]) == (
        "callback_end",
        ("robot", "7"),
        "8",
        "0x5",
    )


@pytest.mark.parametrize("head", ["[12:00:00.1] robot ", "[12:00:00.1] (+?.?????????) ", "[12:00:00.1] "])
def test_difference_and_host_may_be_left_out(head: str) -> None:
    assert isinstance(_read(head + EVENT.split("robot ")[1])[0], TraceEvent)


def test_other_events_are_passed_over() -> None:
    kernel = '[12:00:00.2] (+0.1) robot sched_switch: { cpu_id = 0 }, { prev_comm = "ros2:x", next_tid = 1 }'
    memory = "[12:00:00.2] (+0.1) robot lttng_ust_libc:malloc: { cpu_id = 0 }, { size = 5 }"
    assert len(_read(kernel, memory, f"[12:00:00.3] {EVENT}")) == 1


def test_losses_are_read_with_their_times() -> None:
    warning = "[warning] Tracer discarded 12 events between [12:00:00.5] and [12:00:01] in trace"
    loss, other, _ = _read(
        warning.replace("12:00:01", "12:00:01.0"), "Tracer discarded 3 events.", f"[12:00:00.3] {EVENT}"
    )
    assert isinstance(loss, TraceLoss)
    assert isinstance(other, TraceLoss)
    assert (loss.count, (loss.end or 0) - (loss.start or 0)) == (12, 500_000_000)
    assert (other.count, other.start, other.end) == (3, None, None)


@pytest.mark.parametrize("lines", [(), ("ros2:callback_start: { cpu_id = 1 }, { callback = 0x5 }",), ("x", "y")])
def test_a_trace_without_an_event_is_refused(lines: tuple[str, ...]) -> None:
    with pytest.raises(RecordingError, match="no event of ros2_tracing"):
        _read(*lines)


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        (f"[12:00:00.3] {EVENT}", True),
        ("[12:00:00.3] (+0.1) robot sched_switch: { cpu_id = 0 }", True),
        ("ros2:callback_start: { cpu_id = 1 }", True),
        ("average rate: 3", False),
        ("[1, 2]: {a: b}", False),
    ],
)
def test_what_a_line_of_a_trace_looks_like(line: str, *, expected: bool) -> None:
    assert is_trace_line(line) is expected
