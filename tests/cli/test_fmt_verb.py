"""`archgen fmt`: what it writes, shows, says and ends with."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import Run

ROOT = Path(__file__).resolve().parents[2]
SHIPPED_PROJECTS = [ROOT / "example_ramcip", *sorted(path.parent for path in ROOT.glob("examples/**/archgen.yaml"))]

UNTIDY = "archgen: 1\ngroups:\n    sensing:\n        components:\n            lidar: { outputs: {scan: Scan} }\n"
TIDY = "archgen: 1\ngroups:\n  sensing:\n    components:\n      lidar: {outputs: {scan: Scan}}\n"


def test_it_checks_shows_and_writes(tmp_path: Path, run: Run) -> None:
    file = tmp_path / "archgen.yaml"
    file.write_text(UNTIDY)
    checked = run("fmt", "--check", tmp_path)
    assert (checked.status, Path(checked.out.strip()).name) == (1, "archgen.yaml")
    assert "+      lidar: {outputs: {scan: Scan}}" in run("fmt", "--diff", tmp_path).out
    assert file.read_text() == UNTIDY
    written = run("fmt", tmp_path)
    assert (written.status, "3 lines laid out anew" in written.out) == (0, True)
    assert file.read_text() == TIDY
    assert run("fmt", tmp_path).out == run("fmt", "--check", file).out == "all files are as they should be\n"


@pytest.mark.parametrize("project", SHIPPED_PROJECTS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_what_ships_is_in_the_one_style(run: Run, project: Path) -> None:
    checked = run("fmt", "--check", project)
    assert (checked.status, checked.out) == (0, "all files are as they should be\n")


def test_what_it_leaves_alone_is_named(tmp_path: Path, run: Run) -> None:
    (tmp_path / "archgen.yaml").write_text(UNTIDY)
    (tmp_path / "broken.yaml").write_text("groups: {a: {title: A\n")
    (tmp_path / "list.txt").write_text("no slice")
    said = run("fmt", tmp_path)
    assert (said.status, "broken.yaml:1: " in said.err, "archgen.yaml" in said.out) == (0, True, True)
    assert run("fmt", "--check", tmp_path).status == 1
    assert "list.txt: it is no file of this project" in run("fmt", "-C", tmp_path, tmp_path / "list.txt").err


def test_a_file_behind_a_link_outside_of_the_project_stays(tmp_path: Path, run: Run) -> None:
    outside = tmp_path / "outside.yaml"
    outside.write_text("groups:\n    a: {title: A}\n")
    robot = tmp_path / "robot"
    robot.mkdir()
    (robot / "archgen.yaml").write_text(TIDY)
    (robot / "linked.yaml").symlink_to(outside)
    run("fmt", robot)
    assert outside.read_text() == "groups:\n    a: {title: A}\n"
