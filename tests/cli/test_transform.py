"""`archgen transform`: what it writes, says and refuses."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from archgen.passes import PASSES
from archgen.passes.pass_shape import STATES
from tests.cli.conftest import Run
from tests.passes.same_meaning import EXAMPLES

ROBOT = EXAMPLES / "cleaning_robot"


def test_what_passes_make_is_written_and_those_that_were_needed_are_told(run: Run, tmp_path: Path) -> None:
    ran = run("transform", "-C", ROBOT, "flatten", "-o", tmp_path / "flat.yaml")
    assert ran.status == 0
    assert "Ran before, since they are needed: complete_names," in ran.err
    assert "resolve_instances." in ran.err
    components = yaml.safe_load((tmp_path / "flat.yaml").read_text(encoding="utf-8"))["groups"]["cleaning"][
        "components"
    ]
    assert "left_arm_shoulder" in components
    card = run("show", "-C", tmp_path / "flat.yaml", "left_arm_shoulder").out
    assert "origin:" in card
    assert "archgen.yaml:78:7" in card
    assert run("check", tmp_path / "flat.yaml").status == 0
    # A folder gets an archgen.yaml, which is a project, too.
    assert run("transform", "-C", tmp_path / "flat.yaml", "envelope", "-o", tmp_path / "folder").status == 0
    assert run("check", tmp_path / "folder").status == 0


def test_the_list_says_what_each_pass_does_needs_and_leaves(run: Run) -> None:
    listed = run("transform", "--list").out
    for each in PASSES.values():
        assert f"{each.name}: {each.title}\n" in listed
        assert all(STATES[state] for state in (*each.needs, *each.leaves, *each.ends))
    assert "    needs no_instances: every component says all that it has\n" in listed


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ((), "name one pass or several; `archgen transform --list` shows all"),
        (("flaten",), "no pass named `flaten`: did you mean `flatten`?"),
        (("flatten", "\x1b[31m"), "no pass named"),
    ],
)
def test_wrong_words(run: Run, words: tuple[str, ...], message: str) -> None:
    ran = run("transform", "-C", ROBOT, *words)
    assert ran.status == 2
    assert message in ran.err
    assert "\x1b[31m" not in ran.err


def test_the_project_itself_is_never_overwritten(run: Run, tmp_path: Path) -> None:
    robot = tmp_path / "archgen.yaml"
    robot.write_text((ROBOT / "archgen.yaml").read_text(encoding="utf-8"), encoding="utf-8")
    for target in (robot, tmp_path):
        ran = run("transform", "-C", tmp_path, "flatten", "-o", target)
        assert ran.status != 0
        assert "is a file of the project itself" in ran.err
    assert robot.read_text(encoding="utf-8") == (ROBOT / "archgen.yaml").read_text(encoding="utf-8")


def test_with_errors_nothing_is_written_unless_asked(run: Run, tmp_path: Path) -> None:
    robot = tmp_path / "robot.yaml"
    robot.write_text("groups: {g: {components: {a: {inputs: {x: nothing}}}}}\n", encoding="utf-8")
    target = tmp_path / "out.yaml"
    assert run("transform", "-C", robot, "flatten", "-o", target).status == 1
    assert not target.exists()
    assert run("transform", "-C", robot, "flatten", "-o", target, "--keep-going").status == 1
    assert target.exists()


def test_variants(run: Run, tmp_path: Path) -> None:
    robot = tmp_path / "robot.yaml"
    robot.write_text(
        "groups: {g: {components: {a: {outputs: {x: {type: T, external: the log}}, components: {b: B}}, c: {outputs: {y: {type: T, external: the log}}}}}}\n"
        "types: {T: std_msgs/msg/Bool}\nvariants: {small: {without: c}}\n",
        encoding="utf-8",
    )
    target = tmp_path / "out.yaml"
    ran = run("transform", "-C", robot, "flatten", "-o", target)
    assert "`connect_components` takes the project as it stands: without its variants (small)" in ran.err
    assert "variants" not in yaml.safe_load(target.read_text(encoding="utf-8"))
    assert run("transform", "-C", robot, "flatten", "-o", target, "--variant", "small").status == 0
    assert "c" not in yaml.safe_load(target.read_text(encoding="utf-8"))["groups"]["g"]["components"]
    # What only writes short forms out keeps them.
    assert run("transform", "-C", robot, "normalise_connections", "-o", target).status == 0
    assert "small" in yaml.safe_load(target.read_text(encoding="utf-8"))["variants"]
