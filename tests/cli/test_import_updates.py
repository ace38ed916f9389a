"""`archgen import --merge` and `--check`: what the source said last, what it says now, and what people wrote."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from tests.cli.conftest import Run

LAUNCH = """\
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([Node(package='p', executable='a', name='a'SAYS)])
"""
FIRST = ", namespace='front', remappings=[('scan', '/scan'), ('tf', '/tf')], arguments=['-v'], respawn=True, parameters=[{'rate': 5}]"
SLICE = Path("robot/r_launch.yaml")


@pytest.fixture(autouse=True)
def _in_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def bring_in(run: Run, said: str, *options: str) -> str:
    """Import the launch file with what its node says, again if it is there; return what is told."""
    Path("r.launch.py").write_text(LAUNCH.replace("SAYS", said), encoding="utf-8")
    merge = ["--merge"] if Path("robot").exists() else []
    done = run("import", "launch", "r.launch.py", "-o", "robot", *merge, *options)
    assert done.status == 0, done.err + done.out
    return done.out


def test_what_went_away_with_its_source_is_taken_out_and_told(run: Run) -> None:
    bring_in(run, FIRST)
    before = SLICE.read_text(encoding="utf-8")
    for key in ("namespace", "remaps", "arguments", "respawn"):
        assert f"{key}:" in before
    out = bring_in(run, "")
    after = SLICE.read_text(encoding="utf-8")
    for key in ("namespace", "remaps", "arguments", "respawn"):
        assert f"{key}:" not in after
    assert "  removed: nodes.a.namespace: `/front`\n" in out
    assert "  removed: nodes.a.remaps\n" in out
    assert "rate: 5" not in after
    assert "as before" in bring_in(run, "")


def test_what_people_changed_or_added_stays(run: Run) -> None:
    bring_in(run, FIRST)
    text = SLICE.read_text(encoding="utf-8")
    text = text.replace("namespace: /front", "namespace: /bow  # ours").replace(
        "scan: /scan", "scan: /scan\n      odom: /odom"
    )
    SLICE.write_text(text, encoding="utf-8")
    out = bring_in(run, "")
    after = SLICE.read_text(encoding="utf-8")
    assert "namespace: /bow  # ours" in after
    assert "odom: /odom" in after
    assert "scan" not in after.replace("r.launch", "")
    assert "but people wrote there, which stays: nodes.a.namespace (r_launch.yaml:" in out
    assert "but people wrote there, which stays: nodes.a.remaps (r_launch.yaml:" in out
    assert "as before" in bring_in(run, "")


def test_without_a_record_nothing_is_taken_away(run: Run) -> None:
    bring_in(run, FIRST)
    record = Path("robot/.archgen/imported/r_launch.yaml")
    assert record.read_text(encoding="utf-8") == SLICE.read_text(encoding="utf-8")
    record.unlink()
    out = bring_in(run, "")
    assert "removed" not in out
    assert "what the last import said is not known: nothing is taken away" in out
    assert "namespace: /front" in SLICE.read_text(encoding="utf-8")


@pytest.mark.skipif(os.name == "nt", reason="links need rights there")
def test_a_record_behind_a_link_is_not_read(run: Run) -> None:
    bring_in(run, FIRST)
    record = Path("robot/.archgen/imported/r_launch.yaml")
    record.rename("elsewhere.yaml")
    record.symlink_to(Path("elsewhere.yaml").resolve())
    assert "removed" not in bring_in(run, "")


def test_check_ends_with_1_where_slices_are_older_than_their_source(run: Run) -> None:
    bring_in(run, FIRST)
    files = {path: path.read_bytes() for path in Path("robot").rglob("*.yaml")}
    done = run("import", "launch", "r.launch.py", "-o", "robot", "--check")
    assert (done.status, "r_launch.yaml: as before" in done.out) == (0, True)
    Path("r.launch.py").write_text(LAUNCH.replace("SAYS", ""), encoding="utf-8")
    done = run("import", "launch", "r.launch.py", "-o", "robot", "--check")
    assert (done.status, ": would be brought up to date\n  removed: nodes.a.namespace: `/front`" in done.out) == (
        1,
        True,
    )
    assert {path: path.read_bytes() for path in Path("robot").rglob("*.yaml")} == files
    # A conflict that nobody was told yet changes no slice, and is news all the same.
    SLICE.write_text(
        SLICE.read_text(encoding="utf-8").replace("namespace: /front", "namespace: /bow"), encoding="utf-8"
    )
    Path("r.launch.py").write_text(LAUNCH.replace("SAYS", FIRST.replace("front", "stern")), encoding="utf-8")
    done = run("import", "launch", "r.launch.py", "-o", "robot", "--check")
    assert (done.status, "conflict: nodes.a.namespace: it was `/front` and is `/stern` now; `/bow`" in done.out) == (
        1,
        True,
    )
    bring_in(run, FIRST.replace("front", "stern"))
    assert run("import", "launch", "r.launch.py", "-o", "robot", "--check").status == 0


def test_a_node_that_is_called_otherwise_keeps_its_id(run: Run) -> None:
    bring_in(run, "")
    Path("robot/own.yaml").write_text("nodes: {a: {description: Known as a.}}\n", encoding="utf-8")
    Path("r.launch.py").write_text(LAUNCH.replace("name='a'SAYS", "name='z'"), encoding="utf-8")
    done = run("import", "launch", "r.launch.py", "-o", "robot", "--merge")
    assert (done.status, "renamed: nodes.a is /z by now; its id stays" in done.out) == (0, True)
    assert "nodes:\n  a:\n    name: z\n    package: p\n" in SLICE.read_text(encoding="utf-8")
    assert "added" not in done.out


def test_a_slice_with_another_name_is_brought_up_to_date_and_a_deleted_one_comes_anew(run: Run) -> None:
    bring_in(run, FIRST)
    SLICE.rename("robot/mine.yaml")
    out = bring_in(run, "")
    assert "mine.yaml: brought up to date\n  removed: nodes.a.namespace: `/front`" in out
    assert not SLICE.exists()
    Path("robot/mine.yaml").unlink()
    bring_in(run, "")
    assert "executable: a" in SLICE.read_text(encoding="utf-8")


def test_a_dry_run_tells_and_writes_nothing(run: Run) -> None:
    bring_in(run, FIRST)
    before = SLICE.read_bytes()
    record = json.loads(bring_in(run, "", "--dry-run", "--format", "json"))
    told = {"kind": "removed", "path": "nodes.a.namespace", "before": "`/front`", "now": "", "mine": "`/front`"}
    assert any(told.items() <= change.items() for change in record["files"][0]["changes"])
    assert SLICE.read_bytes() == before


GRAPH = """\
/front/driver
$ ros2 node info /front/driver
/front/driver
  Subscribers:
  Publishers:
    /front/scan: sensor_msgs/msg/LaserScan
  Service Servers:
    /front/driver/describe_parameters: rcl_interfaces/srv/DescribeParameters
  Service Clients:
  Action Servers:
  Action Clients:
$ ros2 param dump /front/driver
/front/driver:
  ros__parameters:
    frame: "laser"
    rate: 5
"""
DRIVER = ", namespace='front', parameters=[{'rate': RATE}]"


@pytest.mark.parametrize(
    ("rate", "told"), [("5", ""), ("7", "nodes.driver.parameters.rate: `7` in r_launch.yaml, `5` here")]
)
def test_the_launch_and_the_running_robot_are_one_project(run: Run, rate: str, told: str) -> None:
    Path("r.launch.py").write_text(
        LAUNCH.replace("name='a'SAYS", f"name='driver'{DRIVER.replace('RATE', rate)}"), encoding="utf-8"
    )
    assert run("import", "launch", "r.launch.py", "-o", "robot").status == 0
    Path("dump.txt").write_text(GRAPH, encoding="utf-8")
    done = run("import", "ros2", "dump.txt", "-o", "robot")
    assert done.status == 0, done.err + done.out
    assert (told in done.out) if told else "said otherwise" not in done.out
    checked = run("check", "robot")
    assert "conflicting-values" not in checked.out + checked.err
    slices = "".join(path.read_text(encoding="utf-8") for path in Path("robot").glob("*.yaml"))
    assert slices.count("namespace: /front") == 1
    assert slices.count("rate:") == 1
    assert "topic: /front/scan" in slices
    again = run("import", "ros2", "dump.txt", "-o", "robot", "--merge")
    assert again.status == 0, again.err
    assert "conflicting-values" not in run("check", "robot").err


def test_recordings_of_two_days_are_one_robot_and_another_robot_is_refused(run: Run) -> None:
    Path("monday.txt").write_text(GRAPH, encoding="utf-8")
    Path("tuesday.txt").write_text(GRAPH.replace("/front/scan:", "/front/scan_raw:"), encoding="utf-8")
    assert run("import", "ros2", "monday.txt", "-o", "robot").status == 0
    done = run("import", "ros2", "tuesday.txt", "-o", "robot", "--merge")
    assert done.status == 0, done.err
    assert "  removed: nodes.driver.publishes.scan\n" in done.out
    assert "  added: nodes.driver.publishes.scan_raw\n" in done.out
    text = Path("robot/running_nodes.yaml").read_text(encoding="utf-8")
    assert text.startswith("# From tuesday.txt by `archgen import ros2`")
    Path("wednesday.txt").write_text(Path("tuesday.txt").read_text(encoding="utf-8"), encoding="utf-8")
    files = {path: path.read_bytes() for path in Path("robot").rglob("*.yaml")}
    assert run("import", "ros2", "wednesday.txt", "-o", "robot", "--merge").status == 0
    assert {path: path.read_bytes() for path in Path("robot").rglob("*.yaml")} == files
    Path("other.txt").write_text(GRAPH.replace("driver", "pilot"), encoding="utf-8")
    done = run("import", "ros2", "other.txt", "-o", "robot", "--merge")
    assert (done.status, "none of its nodes is in the slices here: it is another robot" in done.err) == (2, True)


def test_what_other_files_say_otherwise_is_told_once(run: Run) -> None:
    bring_in(run, "")
    Path("robot/own.yaml").write_text("nodes: {a: {namespace: /mine}}\n", encoding="utf-8")
    told = "said otherwise by another file, which stays as it is: nodes.a.namespace: `/mine` in own.yaml, `/front` here"
    assert told in bring_in(run, FIRST)
    assert "said otherwise" not in bring_in(run, FIRST)
    assert told.replace("front", "bow") in bring_in(run, FIRST.replace("front", "bow"))
    # It was never struck out: where nobody else says it any more, the slice does.
    Path("robot/own.yaml").unlink()
    bring_in(run, FIRST.replace("front", "bow"))
    assert "namespace: /bow" in SLICE.read_text(encoding="utf-8")
