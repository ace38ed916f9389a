"""Verbs in variants: what holds in them, a project as it stands in one, and two of them compared."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
import yaml

from tests.cli.conftest import Run

ROBOT = """\
archgen: 1
groups:
  sensing:
    components:
      lidar: {outputs: {scan: T}, tags: [hardware]}
      battery: {outputs: {charge: T}, tags: [hardware]}
      filter: {inputs: {scan: lidar.scan, charge: {from: battery.charge, optional: true}}, outputs: {clean: {type: T, external: the log}}}
types: {T: sensor_msgs/msg/LaserScan}
nodes: {lidar: {implements: lidar, package: driver}, battery: battery, filter: filter}
variants:
  quiet: {without: battery}
  simulation: {title: In the simulator, of: quiet, changes: {nodes: {lidar: {package: bridge}}}}
  broken: {without: lidar}
"""


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    file = tmp_path / "robot.yaml"
    file.write_text(ROBOT, encoding="utf-8")
    return file


def test_check_says_in_which_variants_a_finding_holds(run: Run, robot: Path) -> None:
    ran = run("check", robot)
    assert "unfed-input" in ran.out
    assert "(in the variant `broken`)" in ran.out
    assert "(in the variant" not in run("check", "--variant", "base,simulation", robot).out
    found = json.loads(run("check", "--format", "json", "--variant", "broken", robot).out)["diagnostics"]
    assert [each["variants"] for each in found if each["rule"] == "unfed-input"] == [["broken"]]
    found = json.loads(run("check", "--format", "sarif", robot).out)["runs"][0]["results"]
    assert {"variants": ["broken"]} in [each.get("properties") for each in found]


def test_unknown_variants_are_wrong_usage(run: Run, robot: Path) -> None:
    for words in (("check",), ("pack",), ("list", "-C")):
        ran = run(*words, robot, "--variant", "simulatoin")
        assert (ran.status, "did you mean `simulation`?" in ran.err) == (2, True), words
    assert run("list", "-C", robot, "--variant", ",").status == 2


def test_a_baseline_knows_the_findings_of_variants(run: Run, robot: Path, tmp_path: Path) -> None:
    baseline = tmp_path / "known.yaml"
    assert run("check", robot, "--update-baseline", "--baseline", baseline).status == 0
    assert "in the variant `broken`" in baseline.read_text(encoding="utf-8")
    assert "no new findings" in run("check", robot, "--baseline", baseline).out
    assert run("check", robot, "--update-baseline", "--baseline", baseline, "--variant", "quiet").status == 2


def test_a_project_is_listed_and_packed_as_it_stands_in_a_variant(run: Run, robot: Path, tmp_path: Path) -> None:
    listed = run("list", "-C", robot, "--format", "json", "--variant", "quiet")
    assert [each["id"] for each in json.loads(listed.out)] == ["sensing.lidar", "sensing.filter"]
    packed = tmp_path / "packed.yaml"
    assert run("pack", robot, "-o", packed, "--variant", "simulation").status == 0
    data = yaml.safe_load(packed.read_text(encoding="utf-8"))
    assert list(data["nodes"]) == ["lidar", "filter"]
    assert data["nodes"]["lidar"]["package"] == "bridge"
    assert "variants" not in data
    ran = run("show", "-C", robot, "simulation")
    assert "nodes.lidar.package: bridge" in ran.out
    assert "quiet" in run("list", "-C", robot, "--of", "variants").out
    assert "sensing.battery" in run("list", "-C", robot, "variant:quiet").out


def test_variants_are_compared(run: Run, robot: Path, tmp_path: Path) -> None:
    ran = run("diff", "-C", robot, "--variant", "base", "--variant", "simulation")
    assert "package `driver` → `bridge`" in ran.out
    assert "`sensing.battery` is removed" in ran.out
    ran = run("diff", "-C", robot, "--variant", "quiet", "--variant", "simulation")
    assert "`sensing.battery`" not in ran.out
    assert run("diff", "-C", robot, "--variant", "quiet", "--variant", "base", "--variant", "quiet").status == 2
    assert run("diff", "-C", robot, ".", ".", "--variant", "quiet", "--variant", "base").status == 2
    later = tmp_path / "later.yaml"
    later.write_text(ROBOT.replace("package: bridge", "package: gazebo"), encoding="utf-8")
    ran = run("diff", robot, later, "--variant", "simulation")
    assert "package `bridge` → `gazebo`" in ran.out
    ran = run("diff", robot, later)
    assert "variant `simulation`: changes `nodes.lidar.package: bridge` → `nodes.lidar.package: gazebo`" in ran.out


def test_a_variant_is_added_where_the_others_stand(run: Run, robot: Path) -> None:
    ran = run("new", "variant", "night", "-C", robot, "--of", "quiet", "--title", "At night")
    assert ran.status == 0, ran.err
    assert yaml.safe_load(robot.read_text(encoding="utf-8"))["variants"]["night"] == {
        "title": "At night",
        "of": "quiet",
    }
    assert run("list", "-C", robot, "--variant", "night").status == 0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("base",), "is what the project itself is called"),
        (("quiet",), "there is a variant 'quiet' already"),
        (("Night",), "is no id"),
        (("night", "--of", "quite"), "did you mean `quiet`?"),
        (("night", "--without", "lidra"), "did you mean `lidar`?"),
    ],
)
def test_a_variant_that_cannot_be_is_not_added(run: Run, robot: Path, words: tuple[str, ...], said: str) -> None:
    ran = run("new", "variant", *words, "-C", robot)
    assert (ran.status, said in ran.err) == (2, True), ran.err
    assert robot.read_text(encoding="utf-8") == ROBOT


def test_test_reports_say_the_variants_of_a_finding(run: Run, robot: Path) -> None:
    report = ET.fromstring(run("check", "--format", "junit", robot).out)  # noqa: S314 - of our own making
    cases = [each for each in report.iter("testcase") if "(in the variant `broken`)" in each.get("name", "")]
    assert cases
    # Readers of such reports know no properties of single cases.
    assert list(report.iter("property")) == []
