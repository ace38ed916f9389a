"""Logs of `ros2 topic hz` and `ros2 topic delay`: which topic, which figures, and what is wrong with them."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.plugins.recordings.recording_import import is_topic_log_line
from tests.plugins.recordings.recorded import list_figures, list_problems, list_unmapped, read

BLOCK = "average rate: 20.000\n\tmin: 0.048s max: 0.052s std dev: 0.00043s window: 21\n"
LATER = "average rate: 19.500\n\tmin: 0.047s max: 0.051s std dev: 0.00043s window: 41\n"
DELAY = "average delay: 0.012\n\tmin: 0.010s max: 0.020s std dev: 0.00043s window: 101\n"


@pytest.mark.parametrize(
    "command",
    [
        "ros2 topic hz /scan",
        "$ ros2 topic hz /scan",
        "me@robot:~/ws$ ros2 topic hz scan",
        "ros2 topic hz -w 100 --wall-time /scan",
        "ros2 topic hz --filter 'm.x>3' /scan --window 5",
        "WARNING: topic [/scan] does not appear to be published yet",
        "Subscribed to [/scan]",
    ],
)
def test_the_topic_stands_in_the_command_or_in_what_the_tool_says(tmp_path: Path, command: str) -> None:
    recordings = read(tmp_path, f"{command}\n{BLOCK}{LATER}^C")
    # The last mean, the extremes of all blocks.
    assert list_figures(recordings) == ["/scan: rate 19.5 Hz, min_period 47 ms, max_period 52 ms"]
    assert list_problems(recordings) == []


def test_several_topics_at_once_are_printed_as_a_table(tmp_path: Path) -> None:
    head = "   topic      rate   min_delta   max_delta   std_dev   window\n=========================================\n"
    rows = "/scan      20.000       0.048       0.052   0.00043       21\n/map   1.0  0.9  1.1  0.1  3\n"
    assert list_figures(read(tmp_path, head + rows)) == [
        "/scan: rate 20 Hz, min_period 48 ms, max_period 52 ms",
        "/map: rate 1 Hz, min_period 900 ms, max_period 1100 ms",
    ]


def test_a_delay_is_its_largest(tmp_path: Path) -> None:
    assert list_figures(read(tmp_path, f"ros2 topic delay /scan\n{DELAY}")) == ["/scan: delay 20 ms"]


def test_one_log_may_hold_several_commands(tmp_path: Path) -> None:
    log = f"$ ros2 topic hz /scan\n{BLOCK}$ ros2 topic delay /map\nno new messages\n{DELAY}"
    assert list_figures(read(tmp_path, log)) == [
        "/scan: rate 20 Hz, min_period 48 ms, max_period 52 ms",
        "/map: delay 20 ms",
    ]


def test_a_topic_that_the_design_does_not_have_is_counted(tmp_path: Path) -> None:
    assert list_unmapped(read(tmp_path, f"ros2 topic hz /odd\n{BLOCK}")) == [
        "rate of /odd (1): the design has no topic of this name"
    ]


@pytest.mark.parametrize(
    ("log", "problem"),
    [
        (BLOCK, "1 error: the log does not say which topic it is of"),
        (
            "ros2 topic hz /scan\n" + BLOCK.replace("0.048s", "48ms"),
            "3 error: the tool prints seconds (`s`), and here stands `ms s`",
        ),
        (
            "ros2 topic delay /scan\n" + DELAY.replace("0.010s", "-0.001s"),
            "3 warning: 1 delay below zero: the clocks of sender and receiver differ, and no delay of this log is right",
        ),
        (
            "ros2 topic hz /odd\naverage rate: 20.0\n",
            "2 note: the log is cut off: 1 average without the line of extremes, here first",
        ),
    ],
)
def test_what_is_wrong_is_said_and_nothing_counted(tmp_path: Path, log: str, problem: str) -> None:
    recordings = read(tmp_path, log)
    assert (list_figures(recordings), list_problems(recordings)) == ([], [problem])


def test_a_clock_that_was_set_back_and_strange_lines_are_said(tmp_path: Path) -> None:
    log = f"ros2 topic hz /scan\n{BLOCK}time has reset, resetting counters\nTraceback (most recent call last):\n{BLOCK}"
    assert list_problems(read(tmp_path, log)) == [
        "4 warning: the clock was set back while this was recorded, 1 time: the figures after it count anew",
        "5 note: 1 line that `ros2 topic hz` and `delay` do not print, this one first; not counted",
    ]


def test_a_rate_of_nothing_is_no_rate(tmp_path: Path) -> None:
    assert list_figures(read(tmp_path, "ros2 topic hz /scan\n" + BLOCK.replace("20.000", "0.000"))) == []


def test_what_a_line_of_a_log_looks_like() -> None:
    assert is_topic_log_line("average rate: 3.1")
    assert not is_topic_log_line("rate: 3.1")
