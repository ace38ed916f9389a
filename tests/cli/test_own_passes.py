"""A project's own passes in `archgen transform`: by name, in the list, and what is refused."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
import yaml

from archgen.passes import PASSES
from archgen.passes.patterns.pattern_registry import find_known_passes
from tests.repositories import repository
from tests.running import ROOT, archgen_here

TAG_POSES = """title: Tags what sends poses
rules:
  - find: {components: {$c: {outputs: {$port: {type: Pose}}}}}
    unless: {components: {$c: {tags: [poses]}}}
    add: {components: {$c: {tags: [poses]}}}
"""


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    """Return a cleaning robot with a pass of its own."""
    folder = shutil.copytree(ROOT / "examples" / "cleaning_robot", tmp_path / "robot")
    (folder / "passes").mkdir()
    (folder / "passes" / "tag_poses.yaml").write_text(TAG_POSES)
    return folder


def test_what_passes_make_is_a_project(robot: Path) -> None:
    done = archgen_here("transform", "connect_ports", "rules.envelope", "tag_poses", cwd=robot)
    assert done.stdout.decode() == "wrote archgen-out/transformed.yaml\n"
    assert b"Ran before, since they are needed: " in done.stderr
    made = yaml.safe_load((robot / "archgen-out" / "transformed.yaml").read_text())
    assert made["component_types"]["pose_fusion"]["outputs"]["p"]["type"] == "Envelope<Pose>"
    assert archgen_here("check", "archgen-out/transformed.yaml", cwd=robot).stdout.decode() == "no findings\n"
    archgen_here("transform", "tag_poses", "-o", "made", cwd=robot)
    assert yaml.safe_load((robot / "made" / "archgen.yaml").read_text())["component_types"]["pose_fusion"]["tags"] == [
        "poses"
    ]


def test_the_list_says_what_passes_do(robot: Path) -> None:
    lines = archgen_here("transform", "--list", cwd=robot).stdout.decode().splitlines()
    assert "tag_poses: Tags what sends poses" in lines
    assert any(line.startswith("rules.envelope: ") for line in lines)
    shipped = find_known_passes(None).passes
    assert PASSES.keys() < shipped.keys()
    assert "tag_poses" not in shipped
    assert b"tag_poses" not in archgen_here("transform", "--list", cwd=robot.parent).stdout


def test_what_cannot_be_done_is_said_and_nothing_is_written(robot: Path) -> None:
    before = (robot / "archgen.yaml").read_bytes()
    assert b"no pass named `flaten`" in archgen_here("transform", "flaten", cwd=robot, status=2).stderr
    assert b"name one pass or several" in archgen_here("transform", cwd=robot, status=2).stderr
    assert (
        b"archgen.yaml is a file of the project itself"
        in archgen_here("transform", "tag_poses", "-o", "archgen.yaml", cwd=robot, status=2).stderr
    )
    assert (
        b"is a file of the project itself"
        in archgen_here("transform", "tag_poses", "-o", "passes/tag_poses.yaml", cwd=robot, status=2).stderr
    )
    (robot / "passes" / "tag_poses.yaml").write_text(
        TAG_POSES.replace("unless: {components: {$c: {tags: [poses]}}}", "where: $c != x")
    )
    done = archgen_here("transform", "tag_poses", cwd=robot, status=1)
    assert b"this rule changes nothing that it finds" in done.stderr
    assert b"passes/tag_poses.yaml:3:5" in done.stderr
    assert b"Nothing was written." in done.stderr
    assert not (robot / "archgen-out").exists()
    assert (robot / "archgen.yaml").read_bytes() == before


def test_a_pass_is_called_as_no_other(robot: Path) -> None:
    (robot / "passes" / "connect_ports.yaml").write_text(TAG_POSES)
    (robot / "passes" / "Loud.yaml").write_text(TAG_POSES)
    said = archgen_here("check", cwd=robot, status=1).stdout.decode()
    assert "there is a pass `connect_ports` already" in said
    assert "`Loud` is no name for a pass" in said


def test_own_passes_run_in_a_review_only_if_the_main_line_allows_them(tmp_path: Path) -> None:
    files = {
        "archgen.yaml": "archgen: 1\ngroups: {g: {components: {a: {outputs: {p: Pose}}}}}\ntypes: {Pose: std_msgs/msg/String}\n",
        "passes/tag_poses.yaml": TAG_POSES,
    }
    unnamed = tmp_path / "unnamed"
    repository(unnamed, files)
    said = archgen_here("transform", "tag_poses", "--trust", "HEAD", cwd=unnamed, status=2).stderr
    assert b"the revision that is trusted does not name it; add it to `review.passes` there" in said
    archgen_here("transform", "connect_ports", "rules.envelope", "--trust", "HEAD", cwd=unnamed)
    named = tmp_path / "named"
    repository(named, {**files, "archgen.yaml": files["archgen.yaml"] + "review: {passes: [tag_poses]}\n"})
    archgen_here("transform", "tag_poses", "--trust", "HEAD", cwd=named)
    (named / "passes" / "tag_poses.yaml").write_text(TAG_POSES.replace("[poses]", "[other]"))
    said = archgen_here("transform", "tag_poses", "--trust", "HEAD", cwd=named, status=2).stderr
    assert b"`passes/tag_poses.yaml` is not as it is in `HEAD`" in said
