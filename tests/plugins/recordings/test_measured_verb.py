"""`archgen timing --measured` with recordings, and `--adopt`: what is printed, and what is written."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import jsonschema_rs
import pytest

from archgen import resources
from tests.cli.conftest import Run
from tests.measured_project import PROJECT
from tests.plugins.recordings.recorded import begin, node, subscription, timer
from tests.plugins.recordings.recorded import run as record_run

TRACE = (
    node("1")
    + timer("1", "0x1", 50)
    + node("2")
    + subscription("2", "0x2", "/scan")
    + subscription("2", "0x3", "/map")
    + record_run("1", "0x1", 0, 3)
    + record_run("2", "0x2", 4, 11.5)
    + record_run("2", "0x3", 12, 13)
    + record_run("1", "0x1", 50, 56)
    + record_run("2", "0x2", 57, 69)
)
OPEN = PROJECT.replace(", wcet: 5 ms", "").replace(", wcet: 20 ms", "")
"""The robot without the execution times of two elements."""


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    """Give the folder of a robot whose execution times are not all known, and a trace beside it."""
    folder = tmp_path / "robot"
    folder.mkdir()
    (folder / "archgen.yaml").write_text(OPEN, encoding="utf-8")
    (tmp_path / "trace.txt").write_text(TRACE, encoding="utf-8")
    return folder


def _read_json(run: Run, *words: object) -> Any:  # noqa: ANN401 - plain data
    data = json.loads(run("timing", "--format", "json", *words).out)
    schema = json.loads(resources.resource_path("schemas", "timing.schema.json").read_text(encoding="utf-8"))
    assert list(jsonschema_rs.Draft202012Validator(schema).iter_errors(data)) == []
    return data


def test_percentiles_stand_beside_the_design(run: Run, robot: Path) -> None:
    ran = run("timing", robot, "--measured", robot.parent / "trace.txt")
    assert (ran.status, ran.err) == (0, "")
    assert (
        ran.out
        == """\
  id    figure  designed  measured
  plan  period  50 ms     53 ms (106 %)  as designed
  scan  period  50 ms     50 ms (100 %)  as designed

What was seen of each
  id             of         count  least   p50     p90    p95    p99    largest
  g.planner.map  storing    1      1 ms    1 ms    1 ms   1 ms   1 ms   1 ms
  plan           execution  2      7.5 ms  7.5 ms  12 ms  12 ms  12 ms  12 ms
  plan           period     1      53 ms   53 ms   53 ms  53 ms  53 ms  53 ms
  scan           execution  2      3 ms    3 ms    6 ms   6 ms   6 ms   6 ms
  scan           period     1      50 ms   50 ms   50 ms  50 ms  50 ms  50 ms

7 figures measured, no outliers
"""
    )


def test_the_same_stands_in_json(run: Run, robot: Path) -> None:
    trace = robot.parent / "trace.txt"
    trace.write_text(TRACE + record_run("2", "0x9", 70, 71), encoding="utf-8")
    data = _read_json(run, robot, "--measured", trace)
    assert [(row["id"], row["figure"], row["measured"]) for row in data["measured"][:3]] == [
        ("g.planner.map", "storing", 1.0),
        ("plan", "period", 53.0),
        ("plan", "bcet", 7.5),
    ]
    assert data["samples"][1] == {
        "id": "plan",
        "of": "execution",
        "count": 2,
        "least": 7.5,
        "p50": 7.5,
        "p90": 12.0,
        "p95": 12.0,
        "p99": 12.0,
        "largest": 12.0,
        "exact": True,
        "at": f"{trace}:14:1",
    }
    assert [(entry["name"], entry["count"]) for entry in data["unmapped"]] == [("callbacks of the process p2", 1)]


def test_a_latency_above_the_chains_bound_is_an_outlier(run: Run, robot: Path) -> None:
    (robot / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    table = robot.parent / "path.csv"
    table.write_text(",avoid,avoid\n,path_start_timestamp [ns],response_time [ms]\n0,1000,333.25\n", encoding="utf-8")
    ran = run("timing", robot, "--measured", table)
    assert ran.out.endswith("1 figure measured, 1 outlier:\n  avoid: latency the bound of the chain does not hold\n")
    table.write_text(table.read_text().replace("333.25", "33.25"), encoding="utf-8")
    assert "1 figure measured, no outliers" in run("timing", robot, "--measured", table).out


def test_what_was_rounded_by_a_tool_is_no_outlier(run: Run, robot: Path) -> None:
    (robot / "archgen.yaml").write_text(OPEN.replace("scanner: {", "scanner: {title: S, ", 1), encoding="utf-8")
    log = robot.parent / "hz.log"
    for largest, outliers in (("0.053", "1 outlier"), ("0.050", "no outliers")):
        text = f"average rate: 20.000\n\tmin: 0.050s max: {largest}s std dev: 0.1s window: 21\n"
        log.write_text(f"ros2 topic hz /scan\n{text}", encoding="utf-8")
        (robot / "archgen.yaml").write_text(
            PROJECT.replace("50 ms, wcet: 5 ms", "49.8 ms, wcet: 0 ms"), encoding="utf-8"
        )
        assert outliers in run("timing", robot, "--measured", log).out


def test_recordings_that_cannot_be_used_end_with_status_1(run: Run, robot: Path) -> None:
    log = robot.parent / "hz.log"
    log.write_text("average rate: 20.000\n\tmin: 0.048s max: 0.052s std dev: 0.1s window: 21\n", encoding="utf-8")
    ran = run("timing", robot, "--measured", log, "--measured", robot.parent / "trace.txt")
    assert (ran.status, "7 figures measured" in ran.out) == (1, True)
    assert f"error[missing-key]: the log does not say which topic it is of\n  --> {log}" in ran.err


def test_a_binary_trace_is_wrong_usage(run: Run, robot: Path) -> None:
    (robot.parent / "session" / "ust").mkdir(parents=True)
    ran = run("timing", robot, "--measured", robot.parent / "session")
    assert (ran.status, "babeltrace2" in ran.err) == (2, True)


def test_adopting_writes_what_no_other_file_writes(run: Run, robot: Path) -> None:
    ran = run("timing", robot, "--measured", robot.parent / "trace.txt", "--adopt")
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.endswith(f"\nwrote {robot / 'measured.yaml'} (5 figures, measured and not proven)\n")
    text = (robot / "measured.yaml").read_text(encoding="utf-8")
    assert text.partition("\n")[2] == (
        "nodes:\n  plan:\n    timing:\n      inputs:\n        map:  # measured, not proven\n          wcet: 1 ms\n"
        "          bcet: 1 ms\n      wcet:\n        max: 12 ms\n        p50: 7.5 ms\n        p90: 12 ms\n        p95: 12 ms\n"
        "        p99: 12 ms\n        measured: true\n      bcet: 7.5 ms\n  scan:\n    timing:\n      wcet:\n        max: 6 ms\n"
        "        p50: 3 ms\n        p90: 6 ms\n        p95: 6 ms\n        p99: 6 ms\n        measured: true\n      bcet: 3 ms\n"
    )
    checked = run("timing", robot, "--measured", robot.parent / "trace.txt", "--format", "json")
    assert {row["verdict"] for row in json.loads(checked.out)["measured"]} == {"as designed"}
    assert run("check", robot).status == 0


def test_adopting_again_keeps_the_longest_and_the_shortest(run: Run, robot: Path) -> None:
    trace, again = robot.parent / "trace.txt", robot.parent / "again.txt"
    run("timing", robot, "--measured", trace, "--adopt")
    again.write_text(node("1") + timer("1", "0x1", 50) + record_run("1", "0x1", 0, 4), encoding="utf-8")
    assert run("timing", robot, "--measured", again, "--adopt").status == 0
    text = (robot / "measured.yaml").read_text(encoding="utf-8")
    assert "max: 6 ms\n        p50: 4 ms\n" in text
    assert "bcet: 3 ms\n" in text
    assert "plan:" in text


def test_what_is_written_elsewhere_is_left_out_with_its_place(run: Run, robot: Path) -> None:
    (robot / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    ran = run("timing", robot, "--measured", robot.parent / "trace.txt", "--adopt")
    assert "Not adopted: 2. To let a measured figure count, write it where the old one stands:\n" in ran.out
    assert (
        "  archgen.yaml:16:37: plan: written already: 20 ms; measured is wcet: {max: 12 ms, p50: 7.5 ms, p90: 12 ms, "
        "p95: 12 ms, p99: 12 ms, measured: true}\n"
    ) in ran.out
    assert "wcet:\n" not in (robot / "measured.yaml").read_text(encoding="utf-8")
    assert run("check", robot).status == 0


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ("wcet: 2 ms", "scan: the wcet that is written, 2 ms, is shorter; measured is bcet: 3 ms"),
        ("bcet: 9 ms", "scan: the bcet that is written, 9 ms, is longer; measured is wcet: {max: 6 ms,"),
    ],
)
def test_what_contradicts_the_other_half_is_left_out(run: Run, robot: Path, written: str, said: str) -> None:
    (robot / "archgen.yaml").write_text(PROJECT.replace("wcet: 5 ms", written), encoding="utf-8")
    ran = run("timing", robot, "--measured", robot.parent / "trace.txt", "--adopt")
    assert (ran.status, said in ran.out) == (0, True)
    assert run("check", robot).status == 0


def test_a_slice_that_sources_do_not_name_is_written_and_the_line_to_add_said(run: Run, robot: Path) -> None:
    (robot / "rest.yaml").write_text(OPEN.partition("\n")[2].partition("\n")[2], encoding="utf-8")
    (robot / "archgen.yaml").write_text(
        "archgen: 1\nproject: {id: p, title: P}\nsources: [rest.yaml]\n", encoding="utf-8"
    )
    ran = run("timing", robot, "--measured", robot.parent / "trace.txt", "--adopt")
    assert ran.err == ("warning: the project does not read it yet: add `measured.yaml` to `sources` in archgen.yaml\n")
    assert (robot / "measured.yaml").exists()


def test_a_component_of_a_node_of_several_has_its_figures_at_the_component(run: Run, robot: Path) -> None:
    trace = node("4") + timer("4", "0x1", 100) + timer("4", "0x2", 1000) + record_run("4", "0x1", 0, 4)
    (robot.parent / "trace.txt").write_text(trace, encoding="utf-8")
    run("timing", robot, "--measured", robot.parent / "trace.txt", "--adopt")
    text = (robot / "measured.yaml").read_text(encoding="utf-8")
    assert (
        "groups:\n  g:\n    components:\n      checker:\n        timing:\n          wcet:\n            max: 4 ms\n"
        in text
    )
    assert run("check", robot).status == 0


def test_another_file_may_be_named_and_what_archgen_did_not_write_stays(run: Run, robot: Path) -> None:
    mine = robot / "mine.yaml"
    mine.write_text("nodes: {scan: {title: Mine}}\n", encoding="utf-8")
    ran = run("timing", "-C", robot, "--measured", robot.parent / "trace.txt", "--adopt", mine)
    assert (ran.status, "is no measured slice that archgen wrote" in ran.err) == (2, True)
    assert mine.read_text(encoding="utf-8") == "nodes: {scan: {title: Mine}}\n"
    other = robot / "timing" / "seen.yaml"
    assert run("timing", "-C", robot, "--measured", robot.parent / "trace.txt", "--adopt", other).status == 0
    assert other.read_text(encoding="utf-8").startswith("# Measured: written by `archgen timing --adopt`")


def test_nothing_is_written_where_a_recording_or_the_project_is_wrong(run: Run, robot: Path) -> None:
    trace = robot.parent / "trace.txt"
    bad = robot.parent / "hz.log"
    bad.write_text("average rate: 20.000\n\tmin: 0.048s max: 0.052s std dev: 0.1s window: 21\n", encoding="utf-8")
    ran = run("timing", robot, "--measured", trace, "--measured", bad, "--adopt")
    assert (ran.status, "Nothing was written" in ran.err) == (1, True)
    (robot / "archgen.yaml").write_text(OPEN + "x: 5\n", encoding="utf-8")
    ran = run("timing", robot, "--measured", trace, "--adopt")
    assert (ran.status, "Nothing was written" in ran.err) == (1, True)
    assert not (robot / "measured.yaml").exists()


def test_nothing_to_adopt_is_said(run: Run, robot: Path) -> None:
    (robot.parent / "trace.txt").write_text(node("1") + timer("1", "0x1", 50) + begin("1", "0x1", 0), encoding="utf-8")
    ran = run("timing", robot, "--measured", robot.parent / "trace.txt", "--adopt")
    assert (ran.status, "Nothing was written: there is nothing to adopt." in ran.err) == (0, True)
    assert not (robot / "measured.yaml").exists()


def test_adopting_is_told_in_json_too(run: Run, robot: Path) -> None:
    (robot / "archgen.yaml").write_text(OPEN.replace("period: 50 ms", "period: 50 ms, bcet: 1 ms"), encoding="utf-8")
    data = _read_json(run, robot, "--measured", robot.parent / "trace.txt", "--adopt")
    assert data["adopted"] == {
        "file": "measured.yaml",
        "read": True,
        "figures": [
            {"id": "g.planner.map", "figure": "wcet"},
            {"id": "plan", "figure": "wcet"},
            {"id": "plan", "figure": "bcet"},
            {"id": "scan", "figure": "wcet"},
        ],
        "left_out": [
            {
                "id": "scan",
                "figure": "bcet",
                "why": "written already: 1 ms",
                "proposal": "bcet: 3 ms",
                "at": "archgen.yaml:6:67",
            }
        ],
    }


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--adopt", "x.yaml"), "--adopt writes what --measured reads, and goes with no --set"),
        (("--measured", "x", "--chain", "avoid"), "ask one at a time"),
    ],
)
def test_wrong_usage_is_said(run: Run, robot: Path, words: tuple[str, ...], said: str) -> None:
    ran = run("timing", "-C", robot, *words)
    assert (ran.status, said in ran.err) == (2, True)


def test_a_project_of_one_file_has_no_slices(run: Run, robot: Path) -> None:
    (robot / "archgen.yaml").rename(robot / "robot.yaml")
    ran = run("timing", robot / "robot.yaml", "--measured", robot.parent / "trace.txt", "--adopt")
    assert (ran.status, "a project of a single file reads no slices" in ran.err) == (2, True)


def test_a_folder_is_no_slice(run: Run, robot: Path) -> None:
    ran = run("timing", "-C", robot, "--measured", robot.parent / "trace.txt", "--adopt", robot)
    assert (ran.status, "--adopt takes the name of a file" in ran.err) == (2, True)


def test_a_slice_that_cannot_be_read_is_not_replaced(run: Run, robot: Path) -> None:
    robot_text = OPEN.partition("\n")[2].partition("\n")[2]
    (robot / "rest.yaml").write_text(robot_text, encoding="utf-8")
    (robot / "archgen.yaml").write_text("archgen: 1\nsources: [rest.yaml]\n", encoding="utf-8")
    (robot / "measured.yaml").write_text("nodes: {scan: [\n", encoding="utf-8")
    ran = run("timing", robot, "--measured", robot.parent / "trace.txt", "--adopt")
    assert (ran.status, "error[syntax-error]" in ran.err, "Nothing was written" in ran.err) == (1, True, True)
    assert (robot / "measured.yaml").read_text(encoding="utf-8") == "nodes: {scan: [\n"


def test_colours_of_a_terminal_are_no_text(run: Run, robot: Path) -> None:
    trace = robot.parent / "trace.txt"
    coloured = TRACE.replace("ros2:", "\x1b[1mros2:").replace("callback =", "\x1b[0;33mcallback\x1b[0m =")
    trace.write_text(coloured, encoding="utf-8")
    ran = run("timing", robot, "--measured", trace)
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.endswith("7 figures measured, no outliers\n")
