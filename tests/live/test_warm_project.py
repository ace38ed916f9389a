"""A project with texts that are not saved says what a fresh check of the same texts says."""

from __future__ import annotations

import random
import shutil
from pathlib import Path

import pytest

from archgen.live.warm_project import WarmProject
from archgen.pipeline import check_project
from archgen.project import ProjectNotFoundError
from tests.property_sizes import try_some
from tests.running import RAMCIP, ROOT

SMALL = """\
archgen: 1
groups:
  arm:
    components:
      grip: {outputs: {state: std_msgs/msg/Bool}}
      plan: {inputs: {state: grip.state}}
"""


def write_small(folder: Path) -> WarmProject:
    (folder / "archgen.yaml").write_text(SMALL, encoding="utf-8")
    return WarmProject(folder)


def test_an_unsaved_text_counts_and_a_dropped_one_does_not(tmp_path: Path) -> None:
    project = write_small(tmp_path)
    project.set_text("archgen.yaml", SMALL.replace("grip.state", "grip.stat"))
    assert [each.rule for each in project.check().findings if each.severity == "error"] == ["unknown-reference"]
    project.drop_text("archgen.yaml")
    assert project.check().findings == check_project(tmp_path).findings


def test_a_new_file_that_is_not_saved_is_read(tmp_path: Path) -> None:
    project = write_small(tmp_path)
    project.set_text(
        "more/leg.yaml", "groups:\n  leg:\n    components:\n      knee: {inputs: {state: arm.grip.state}}\n"
    )
    assert "leg.knee" in project.check().architecture.components


def test_a_half_written_line_takes_nothing_else_down(tmp_path: Path) -> None:
    project = write_small(tmp_path)
    project.set_text("archgen.yaml", SMALL)
    project.set_text("archgen.yaml", SMALL.replace("grip.state}}", "grip."))
    checked_project = project.check()
    assert list(checked_project.architecture.components) == ["arm.grip"]
    assert project.is_mended("archgen.yaml")
    assert [(error.span.line, error.severity) for error in project.list_text_errors(checked_project)] == [(6, "error")]
    # Nobody says that what cannot be read is missing.
    assert not [finding for finding in checked_project.findings if finding.severity == "error"]


def test_a_file_that_is_no_slice_gets_no_errors(tmp_path: Path) -> None:
    project = write_small(tmp_path)
    project.set_text("chart.yaml", "a: {{ value }\n")
    assert project.list_text_errors(project.check()) == ()


def test_what_no_file_can_hold_is_told(tmp_path: Path) -> None:
    project = write_small(tmp_path)
    project.set_text("archgen.yaml", f"{SMALL}# \ud800\n")
    assert [error.span.line for error in project.list_text_errors(project.check())] == [7]


def test_a_project_that_is_gone_is_said_to_be(tmp_path: Path) -> None:
    project = write_small(tmp_path)
    project.check()
    (tmp_path / "archgen.yaml").unlink()
    with pytest.raises(ProjectNotFoundError):
        project.check()


def test_an_unsaved_text_of_a_library_counts(tmp_path: Path) -> None:
    library, robot = tmp_path / "library", tmp_path / "robot"
    library.mkdir()
    robot.mkdir()
    (tmp_path / ".git").mkdir()
    (library / "types.yaml").write_text(
        "component_types:\n  lamp: {outputs: {on: std_msgs/msg/Bool}}\n", encoding="utf-8"
    )
    (robot / "archgen.yaml").write_text(
        "archgen: 1\nlibraries: {lib: ../library}\ngroups: {g: {components: {a: {is: lib.lamp}}}}\n", encoding="utf-8"
    )
    project = WarmProject(robot)
    text = "component_types:\n  lamp: {outputs: {off: std_msgs/msg/Bool}}\n"
    project.set_text("../library/types.yaml", text)
    checked_project = project.check()
    if "../library/types.yaml" in checked_project.loaded_project.library_files:  # git may refuse an empty `.git`
        assert list(checked_project.architecture.outputs) == ["g.a.off"]


EDITED = (
    "examples/drone",
    "examples/cleaning_robot",
    "examples/arm",
    pytest.param("example_ramcip", marks=pytest.mark.slow),
)


def edit_randomly(text: str, chance: random.Random) -> str:
    lines = text.split("\n")
    number = chance.randrange(len(lines))
    line = lines[number]
    column = chance.randrange(len(line) + 1)
    lines[number : number + 1] = chance.choice(
        [[], [line, line], [line[:column]], [line[:column] + chance.choice("ab:. {}[]#-'\"1") + line[column:]]]
    )
    return "\n".join(lines)


@pytest.mark.parametrize("name", try_some(EDITED, 1))
def test_what_is_kept_changes_no_finding(tmp_path: Path, name: str) -> None:
    root = shutil.copytree(ROOT / name, tmp_path / "p", ignore=shutil.ignore_patterns("archgen-out"))
    project = WarmProject(root)
    files = [file for file in project.check().yaml_files if not file.startswith("../")]
    chance = random.Random(name)  # noqa: S311 - the same edits each time
    for _ in range(8):
        file = chance.choice(files)
        written = (root / file).read_text(encoding="utf-8")
        text = edit_randomly(project.text_of(file) or written, chance)
        project.set_text(file, text)
        kept = project.check()
        if any(map(project.is_mended, files)):
            assert project.list_text_errors(kept)
            project.set_text(file, written)
            continue
        (root / file).write_text(text, encoding="utf-8")
        fresh = check_project(root)
        assert kept.findings == fresh.findings
        assert kept.architecture == fresh.architecture


@pytest.mark.slow
def test_typing_loses_no_other_component() -> None:
    project = WarmProject(RAMCIP)
    file = "groups/robot_state.yaml"
    text = (RAMCIP / file).read_text(encoding="utf-8")
    everything = project.check().architecture.components.keys()
    lines = text.split("\n")
    number = next(at for at, line in enumerate(lines) if " outputs:" in line)
    for length in range(len(lines[number]) + 1):
        project.set_text(file, "\n".join((*lines[:number], lines[number][:length], *lines[number + 1 :])))
        checked_project = project.check((), has_timing=False)
        assert len(everything - checked_project.architecture.components.keys()) <= 1
        assert not checked_project.loaded_project.broken_files


def test_old_versions_are_forgotten(tmp_path: Path) -> None:
    project = write_small(tmp_path)
    for number in range(20):
        project.set_text("archgen.yaml", f"{SMALL}# {number}\n")
        project.check()
    assert len(project.cache.parsed_slices) == 1
