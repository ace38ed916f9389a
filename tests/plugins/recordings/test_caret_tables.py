"""Tables of CARET: records of callbacks and paths, and the tables behind its plots."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.plugins.recordings.caret_tables import is_caret_heading
from tests.plugins.recordings.recorded import list_figures, list_problems, list_unmapped, read

RECORDS = """\
,/front/scan/callback_0/callback_start_timestamp,/front/scan/callback_0/callback_end_timestamp
0,1664288798730941555,1664288798733941555
1,1664288798780941555,1664288798782941555
"""
PLOT = """\
,/front/scan/callback_0,/front/scan/callback_0,/drive/callback_0,/drive/callback_0
,callback_start_timestamp [ns],latency [ms],callback_start_timestamp [ns],latency [ms]
0,1664288798730941555,3.0,1664288798730941555,0.5
1,1664288798780941555,2.0,,
"""
PATH = """\
,/scan/rclcpp_publish_timestamp/0,/plan/callback_0/callback_start_timestamp/0,/path/rclcpp_publish_timestamp/0,\
/drive/callback_0/callback_start_timestamp/0
0,1000,2000,3000,40001000
1,50001000,50002000,,
2,60001000,60002000,60003000,80001000
"""


def test_records_give_execution_times(tmp_path: Path) -> None:
    assert list_figures(read(tmp_path, RECORDS)) == ["scan: bcet 2 ms, wcet 3 ms"]


def test_tables_behind_plots_have_their_units_in_the_heading(tmp_path: Path) -> None:
    for factor, unit in ((1, "ms"), (10**6, "ns"), (10**3, "us")):
        table = PLOT.replace("latency [ms]", f"latency [{unit}]")
        for number in ("3.0", "2.0"):
            table = table.replace(f",{number}", f",{float(number) * factor}")
        assert list_figures(read(tmp_path, table)) == ["scan: bcet 2 ms, wcet 3 ms"]


def test_a_callback_that_may_be_another_is_not_guessed(tmp_path: Path) -> None:
    why = "this node has callbacks that only store an input, and the name does not say which one it is"
    assert list_unmapped(read(tmp_path, PLOT)) == [f"/drive/callback_0 (1): {why}"]


@pytest.mark.parametrize(
    ("name", "figure"),
    [
        ("timer_callback_0", "drive: bcet 500 us, wcet 500 us"),
        ("subscription_callback_0", "g.base.path: storing 500 us"),
    ],
)
def test_a_callback_whose_name_says_what_it_is_has_its_place(tmp_path: Path, name: str, figure: str) -> None:
    assert figure in list_figures(read(tmp_path, PLOT.replace("/drive/callback_0", f"/drive/{name}")))


def test_periods_of_callbacks_are_read_and_other_figures_are_counted(tmp_path: Path) -> None:
    recordings = read(
        tmp_path, PLOT.replace("latency [ms]", "period [ms]", 1).replace("latency [ms]", "frequency [Hz]")
    )
    assert list_figures(recordings) == ["scan: period 2.5 ms"]
    assert list_unmapped(recordings) == ["/drive/callback_0 frequency [Hz] (1): archgen reads no figure of this kind"]


def test_a_path_is_held_against_the_chain_through_the_same_nodes(tmp_path: Path) -> None:
    recordings = read(tmp_path, PATH)
    assert list_figures(recordings) == ["avoid: latency 40 ms"]
    assert recordings.observations[0].samples["latency"].count == 2
    assert list_problems(recordings) == [
        "3 note: 1 row of a path without an end, this one first: lost, or still on its way; not counted"
    ]


def test_a_path_that_no_chain_goes_is_counted(tmp_path: Path) -> None:
    short = "\n".join(line.rpartition(",")[0].rpartition(",")[0] for line in PATH.splitlines())
    assert list_unmapped(read(tmp_path, short)) == [
        "/scan - /plan/callback_0 (3): no chain of the design leads through scan - plan"
    ]


def test_a_path_of_a_plot_is_the_chain_of_its_name(tmp_path: Path) -> None:
    table = ",avoid,avoid\n,path_start_timestamp [ns],response_time [ms]\n0,1000,33.25\n"
    assert list_figures(read(tmp_path, table)) == ["avoid: latency 33.25 ms"]
    assert list_unmapped(read(tmp_path, table.replace("avoid", "other"))) == [
        "other (1): no chain of the design has this name"
    ]


@pytest.mark.parametrize(
    ("table", "problem"),
    [
        (
            RECORDS + "2,5,3\n",
            "4 warning: 1 row with an end before the beginning, this one first: a clock was set; not counted",
        ),
        (RECORDS + "2,5,3x\n", "4 warning: 1 row with a cell that is no number, this one first; not counted"),
        (RECORDS + "2,1e999999999,3\n", "4 warning: 1 row with a cell that is no number, this one first; not counted"),
        (
            RECORDS + "2,16642887\n",
            "4 warning: 1 row with fewer cells than the heading, this one first: the file is cut off; not counted",
        ),
    ],
)
def test_rows_that_cannot_be_are_said_and_not_counted(tmp_path: Path, table: str, problem: str) -> None:
    recordings = read(tmp_path, table)
    assert list_figures(recordings) == ["scan: bcet 2 ms, wcet 3 ms"]
    assert list_problems(recordings) == [problem]


def test_an_unknown_unit_ends_the_reading(tmp_path: Path) -> None:
    recordings = read(tmp_path, PLOT.replace("latency [ms]", "latency [ticks]"))
    assert list_figures(recordings) == []
    assert list_problems(recordings) == ["2 error: `ticks` is no unit of time that CARET uses"]


@pytest.mark.parametrize(
    ("lines", "expected"),
    [(RECORDS, True), (PLOT, True), (PATH, True), ("id,rate,wcet\nscan,1 Hz,\n", False), ("", False), ("\0\n", False)],
)
def test_what_a_heading_of_caret_looks_like(lines: str, *, expected: bool) -> None:
    assert is_caret_heading(lines.splitlines()) is expected
