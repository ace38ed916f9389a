"""Traces of ros2_tracing, as babeltrace2 prints them: who is who, how long, how often, and what is wrong with them."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.plugins.recordings import trace_events, trace_reading
from tests.measured_project import PROJECT
from tests.plugins.recordings import recorded
from tests.plugins.recordings.recorded import (
    begin,
    event,
    finish,
    list_figures,
    list_problems,
    list_unmapped,
    node,
    read,
    run,
    subscription,
    timer,
)

SCANNER = node("1") + timer("1", "0x1", 50)
PLANNER = node("2") + subscription("2", "0x2", "/scan") + subscription("2", "0x3", "/map")
MAPS = node("4")
THREE_RUNS = run("1", "0x1", 0, 3) + run("1", "0x1", 50, 54) + run("1", "0x1", 102, 104)


def test_a_timer_gives_execution_times_and_the_mean_period(tmp_path: Path) -> None:
    recordings = read(tmp_path, SCANNER + THREE_RUNS)
    assert list_figures(recordings) == ["scan: period 51 ms, bcet 2 ms, wcet 4 ms"]
    assert recordings.observations[0].samples["execution"].percentiles["p50"] == 3_000_000
    assert list_problems(recordings) == list_unmapped(recordings) == []


def test_an_input_that_fires_is_an_activation_and_one_that_does_not_is_stored(tmp_path: Path) -> None:
    runs = run("2", "0x2", 10, 15) + run("2", "0x3", 20, 21) + run("2", "0x2", 60, 67)
    assert list_figures(read(tmp_path, PLANNER + runs)) == [
        "g.planner.map: storing 1 ms",
        "plan: period 50 ms, bcet 5 ms, wcet 7 ms",
    ]


def test_of_an_activity_that_drops_messages_only_the_longest_run_counts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recorded, "PROJECT", PROJECT.replace("trigger: [scan]", "trigger: [scan], every: 3"))
    runs = run("2", "0x2", 10, 15) + run("2", "0x2", 60, 67)
    assert list_figures(read(tmp_path, PLANNER + runs)) == ["plan: wcet 7 ms"]


def test_messages_count_once_though_they_pass_two_layers(tmp_path: Path) -> None:
    publisher = 'publisher_handle = 0x5, node_handle = 0xA, rmw_publisher_handle = 0x6, topic_name = "/scan"'
    sent = "".join(
        event(time, name, "1", "publisher_handle = 0x5, message = 0x7")
        for time in (0, 50, 110)
        for name in ("rclcpp_publish", "rcl_publish")
    )
    recordings = read(tmp_path, node("1") + event(0, "rcl_publisher_init", "1", publisher) + sent)
    assert list_figures(recordings) == ["/scan: period 55 ms, min_period 50 ms, max_period 60 ms"]


def test_several_recordings_count_together_without_the_time_between_them(tmp_path: Path) -> None:
    later = SCANNER + run("1", "0x1", 9000, 9007) + run("1", "0x1", 9050, 9051)
    assert list_figures(read(tmp_path, SCANNER + THREE_RUNS, later)) == [
        "scan: period ~50.667 ms, bcet 1 ms, wcet 7 ms"
    ]


def test_timers_of_one_node_are_told_apart_by_their_periods(tmp_path: Path) -> None:
    trace = MAPS + timer("4", "0x1", 1000) + timer("4", "0x2", 100) + timer("4", "0x3", 7)
    trace += run("4", "0x1", 0, 80) + run("4", "0x2", 100, 101) + run("4", "0x3", 200, 201)
    recordings = read(tmp_path, trace)
    assert list_figures(recordings) == ["maps.checker: bcet 1 ms, wcet 1 ms", "maps.mapper: bcet 80 ms, wcet 80 ms"]
    why = "no activity of this node has this period, or several have"
    assert list_unmapped(recordings) == [f"/maps: timer of 7 ms (1): {why}"]


def test_a_timer_whose_period_is_not_designed_is_the_only_one_that_there_is(tmp_path: Path) -> None:
    trace = node("1") + timer("1", "0x1", 70) + run("1", "0x1", 0, 3) + run("1", "0x1", 70, 73)
    assert list_figures(read(tmp_path, trace)) == ["scan: period 70 ms, bcet 3 ms, wcet 3 ms"]


def test_before_humble_a_timer_is_that_of_the_only_node_of_its_process(tmp_path: Path) -> None:
    trace = SCANNER + THREE_RUNS
    without_link = "".join(line for line in trace.splitlines(keepends=True) if "timer_link_node" not in line)
    assert list_figures(read(tmp_path, without_link)) == ["scan: period 51 ms, bcet 2 ms, wcet 4 ms"]


def test_what_every_node_has_is_not_reported(tmp_path: Path) -> None:
    trace = SCANNER + subscription("1", "0x9", "/parameter_events") + run("1", "0x9", 5, 6)
    service = (
        'service_handle = 0x8, node_handle = 0xA, rmw_service_handle = 0x1, service_name = "/front/scan/get_parameters"'
    )
    trace += event(6, "rcl_service_init", "1", service)
    trace += event(6, "rclcpp_service_callback_added", "1", "service_handle = 0x8, callback = 0x7") + run(
        "1", "0x7", 7, 8
    )
    recordings = read(tmp_path, trace)
    assert (list_figures(recordings), list_unmapped(recordings)) == ([], [])


def test_what_the_design_does_not_have_is_counted(tmp_path: Path) -> None:
    stranger = SCANNER.replace('"scan"', '"skan"') + subscription("1", "0x4", "/odd") + run("1", "0x4", 1, 2)
    trace = stranger + run("1", "0x1", 5, 6) + run("1", "0x99", 7, 8) + run("1", "0x99", 9, 10)
    assert list_unmapped(read(tmp_path, trace)) == [
        "/front/skan: subscription /odd (1): no node of the design has this name",
        "/front/skan: timer of 50 ms (1): no node of the design has this name",
        "callbacks of the process p1 (2): the recording does not say whose they are",
    ]


def test_addresses_mean_something_in_one_process_only(tmp_path: Path) -> None:
    trace = SCANNER + node("3") + timer("3", "0x1", 20) + run("3", "0x1", 0, 1) + run("1", "0x1", 2, 6)
    assert list_figures(read(tmp_path, trace)) == ["drive: bcet 1 ms, wcet 1 ms", "scan: bcet 4 ms, wcet 4 ms"]


def test_an_address_that_is_used_again_means_the_later_thing(tmp_path: Path) -> None:
    trace = SCANNER + run("1", "0x1", 0, 3) + subscription("1", "0x1", "/odd") + run("1", "0x1", 10, 40)
    recordings = read(tmp_path, trace)
    assert list_figures(recordings) == ["scan: bcet 3 ms, wcet 3 ms"]
    assert list_unmapped(recordings) == ["/front/scan: subscription /odd (1): this node of the design does not read it"]


def test_an_address_of_a_subscription_that_is_used_again_may_be_a_timers(tmp_path: Path) -> None:
    trace = node("1") + subscription("1", "0x1", "/odd") + timer("1", "0x1", 50) + run("1", "0x1", 0, 3)
    recordings = read(tmp_path, trace)
    assert (list_figures(recordings), list_unmapped(recordings)) == (["scan: bcet 3 ms, wcet 3 ms"], [])


def test_two_processes_with_a_node_of_one_name_are_not_counted(tmp_path: Path) -> None:
    twin = SCANNER.replace("vpid = 1", "vpid = 7") + run("7", "0x1", 3, 40)
    recordings = read(tmp_path, SCANNER + run("1", "0x1", 0, 3) + twin)
    assert list_figures(recordings) == []
    assert "7 warning: 2 processes have a node /front/scan: none of its callbacks is counted" in list_problems(
        recordings
    )


def test_two_nodes_of_one_name_are_seen_without_processes_too(tmp_path: Path) -> None:
    twin = SCANNER.replace("node_handle = 0xA", "node_handle = 0xE").replace("0x1", "0x2")
    trace = (SCANNER + twin + run("1", "0x1", 0, 3)).replace("vpid", "other")
    assert list_figures(read(tmp_path, trace)) == []


@pytest.mark.parametrize(
    ("runs", "figures", "problem"),
    [
        (
            run("1", "0x1", 0, 3) + begin("1", "0x1", 50),
            "bcet 3 ms, wcet 3 ms",
            "7 note: the recording is cut off: 1 callback began and did not end, this one first; not counted",
        ),
        (
            finish("1", "0x1", 0) + run("1", "0x1", 50, 52),
            "bcet 2 ms, wcet 2 ms",
            "5 note: of 1 callback only the end was recorded, here first; not counted",
        ),
        (
            begin("1", "0x1", 0) + run("1", "0x1", 50, 52),
            "bcet 2 ms, wcet 2 ms",
            "6 warning: 1 callback began again before an end, in one thread, here first: events are missing; not counted",
        ),
        (
            run("1", "0x1", 500, 502) + begin("1", "0x1", 550) + run("1", "0x1", 100, 104),
            "bcet 2 ms, wcet 4 ms",
            "8 warning: time goes backwards 1 time, here first: what lasted across is not counted",
        ),
        (
            run("1", "0x1", 0, 3) + finish("1", "0x1", 5)[:100],
            "bcet 3 ms, wcet 3 ms",
            "7 warning: 1 line of ros2 events cannot be read, this one first",
        ),
    ],
)
def test_what_was_not_seen_whole_is_said_and_not_counted(tmp_path: Path, runs: str, figures: str, problem: str) -> None:
    recordings = read(tmp_path, SCANNER + runs)
    assert [line.replace("period 50 ms, ", "") for line in list_figures(recordings)] == [f"scan: {figures}"]
    assert list_problems(recordings) == [problem]


def test_the_same_callback_may_run_in_two_threads_at_once(tmp_path: Path) -> None:
    runs = (
        begin("1", "0x1", 0, "5") + begin("1", "0x1", 2, "6") + finish("1", "0x1", 9, "5") + finish("1", "0x1", 10, "6")
    )
    recordings = read(tmp_path, SCANNER + runs)
    assert list_figures(recordings) == ["scan: period 2 ms, bcet 8 ms, wcet 9 ms"]
    assert list_problems(recordings) == []


LOSS = 'WARNING: Tracer discarded 7002 events between [12:00:00.040000000] and [12:00:00.060000000] in trace "x"\n'


def test_nothing_counts_while_events_were_lost(tmp_path: Path) -> None:
    runs = begin("1", "0x1", 0) + LOSS + run("1", "0x1", 45, 55) + finish("1", "0x1", 70) + run("1", "0x1", 100, 104)
    recordings = read(tmp_path, SCANNER + runs)
    assert list_figures(recordings) == ["scan: bcet 4 ms, wcet 4 ms"]
    assert list_problems(recordings) == [
        "6 warning: the tracer discarded 7,002 events, here first: what was going on meanwhile is not counted",
        "9 note: of 1 callback only the end was recorded, here first; not counted",
    ]


def test_a_loss_counts_wherever_its_warning_stands_before_it(tmp_path: Path) -> None:
    others = "".join(
        f"[warning] Tracer discarded 1 events between [12:00:0{second}.1] and [12:00:0{second}.2] in trace\n"
        for second in (8, 5)
    )
    runs = (
        run("1", "0x1", 0, 3) + run("1", "0x1", 6000, 6002) + run("1", "0x1", 8150, 8190) + run("1", "0x1", 9000, 9001)
    )
    assert list_figures(read(tmp_path, others + SCANNER + runs)) == ["scan: bcet 1 ms, wcet 3 ms"]


def test_a_session_that_began_after_the_nodes_says_so(tmp_path: Path) -> None:
    assert list_problems(read(tmp_path, THREE_RUNS)) == [
        "1 warning: the trace has callbacks and no `ros2:rcl_node_init`: nothing says whose they are"
    ]


def test_a_trace_of_too_many_things_is_refused_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(trace_events, "MAX_ADDRESSES", 6)
    recordings = read(tmp_path, SCANNER + THREE_RUNS + subscription("1", "0x8", "/a"))
    assert list_figures(recordings) == []
    assert list_problems(recordings) == ["12 error: the trace tells of more things than any robot has"]


@pytest.mark.parametrize("is_open", [True, False])
def test_a_trace_of_too_many_callbacks_is_refused_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *, is_open: bool
) -> None:
    monkeypatch.setattr(trace_reading, "MAX_CALLBACKS", 4)
    lines = [begin("1", f"0x{n}", n) if is_open else run(str(n), "0x5", n, n + 0.5) for n in range(9)]
    recordings = read(tmp_path, SCANNER + THREE_RUNS + "".join(lines))
    assert list_figures(recordings) == []
    assert list_problems(recordings) == [
        f"{15 if is_open else 19} error: the trace tells of more things than any robot has"
    ]


def test_many_losses_take_no_more_room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(trace_reading, "_MAX_LOSSES", 3)
    assert list_figures(read(tmp_path, SCANNER + LOSS * 10 + run("1", "0x1", 100, 104))) == [
        "scan: bcet 4 ms, wcet 4 ms"
    ]


def test_hostile_names_are_names(tmp_path: Path) -> None:
    name = r"x\", callback = 0x1, node_name = \"scan"
    trace = SCANNER.replace('node_name = "scan"', f'node_name = "{name}"') + run("1", "0x1", 0, 3)
    recordings = read(tmp_path, trace)
    assert list_figures(recordings) == []
    assert [samples.name for samples in recordings.unmapped] == [f"/front/{name}: timer of 50 ms"]
