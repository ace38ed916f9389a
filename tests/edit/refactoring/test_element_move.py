"""Moves and splits: whole entries with their comments, the same model, `sources` and owners seen to, refusals in words."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from archgen.edit.element_edit import EditRefusedError
from archgen.edit.refactoring.element_move import plan_move, plan_split
from archgen.edit.refactoring.element_rename import find_element
from archgen.edit.refactoring.judged_version import JudgedVersion, judge_edited, judge_version
from archgen.edit.refactoring.refactoring import Refactoring
from archgen.project import load_project
from tests.running import RAMCIP

PROJECT = """\
archgen: 1
sources: [two.yaml, types.yaml]
partners: {lab: Lab, shop: Shop}
groups:
  # What sees.
  sensing:
    owner: lab
    components:
      # Sees far.
      camera:
        outputs: {image: Image}   # in colour

      lidar:
        outputs: {scan: Scan}
  driving:
    owner: shop
    components:
      pilot:
        inputs: {image: {from: camera.image}, scan: {from: sensing.lidar.scan}}
types: {Image: {message: sensor_msgs/msg/Image}, Scan: {message: sensor_msgs/msg/LaserScan}}
views: {eyes: {show: sensing.camera+}}
variants:
  indoor:
    changes:
      groups:
        sensing:
          components:
            camera: {title: Indoor camera}
"""
OTHER = """\
groups:
  sensing:
    components:
      camera:
        requirements: ["Sees far"]
nodes:
  eye: {implements: sensing.camera}
"""


@pytest.fixture
def version(tmp_path: Path) -> JudgedVersion:
    """Give a project of two files."""
    (tmp_path / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    (tmp_path / "two.yaml").write_text(OTHER, encoding="utf-8")
    (tmp_path / "groups").mkdir()
    (tmp_path / "groups" / "camera.yaml").write_text("what: ever\n", encoding="utf-8")
    (tmp_path / "types.yaml").write_text("types: {Odd: {message: std_msgs/msg/Empty}}\n", encoding="utf-8")
    return judge_version(load_project(tmp_path))


def move(version: JudgedVersion, name: str, group: str | None = None, file: str | None = None) -> Refactoring:
    return plan_move(version, find_element(version, name), group, file)


def texts(refactoring: Refactoring) -> dict[str, str]:
    return {edit.file: edit.new_content.decode() for edit in refactoring.edits}


def test_a_component_moves_into_another_group_with_all_that_is_said_of_it(version: JudgedVersion) -> None:
    moved = texts(move(version, "sensing.camera", "driving"))
    assert moved["archgen.yaml"] == (
        PROJECT.replace(
            "      # Sees far.\n      camera:\n        outputs: {image: Image}   # in colour\n\n", ""
        )
        .replace(
            "scan: {from: sensing.lidar.scan}}\n",
            "scan: {from: sensing.lidar.scan}}\n      # Sees far.\n      camera:\n"
            "        outputs: {image: Image}   # in colour\n        owner: lab\n",
        )
        .replace("show: sensing.camera+", "show: driving.camera+")
        .replace("        sensing:\n          components:\n            camera: {title", "        driving:\n          components:\n            camera: {title")
    )  # fmt: skip
    assert moved["two.yaml"] == OTHER.replace("sensing", "driving")


def test_the_owner_is_written_for_the_project_where_a_variant_comes_first(tmp_path: Path) -> None:
    start, _, variant = PROJECT.partition("variants:\n")
    groups = start[start.index("groups:") : start.index("types: ")]
    (tmp_path / "archgen.yaml").write_text(
        start.replace(groups, "").replace("[two.yaml, types.yaml]", "[two.yaml]") + f"variants:\n{variant}",
        encoding="utf-8",
    )
    (tmp_path / "two.yaml").write_text(groups, encoding="utf-8")
    moved = texts(move(judge_version(load_project(tmp_path)), "sensing.camera", "driving"))
    assert "        outputs: {image: Image}   # in colour\n        owner: lab\n" in moved["two.yaml"]
    assert "owner" not in moved["archgen.yaml"]


def test_an_element_moves_into_a_new_file_that_is_read(version: JudgedVersion) -> None:
    moved = texts(move(version, "sensing.camera", file="eyes/camera.yaml"))
    assert moved["eyes/camera.yaml"] == (
        "groups:\n  sensing:\n    components:\n      # Sees far.\n      camera:\n"
        "        outputs: {image: Image}   # in colour\n"
    )
    assert "sources: [two.yaml, types.yaml, eyes/camera.yaml]\n" in moved["archgen.yaml"]
    assert "camera:\n        outputs" not in moved["archgen.yaml"]


def test_an_element_moves_into_a_file_that_is_there(version: JudgedVersion) -> None:
    moved = texts(move(version, "driving.pilot", file="two.yaml"))
    assert moved["two.yaml"].startswith(
        OTHER.partition("nodes:")[0] + "  driving:\n    components:\n      pilot:\n        inputs:"
    )
    assert "    owner: shop\ntypes:" in moved["archgen.yaml"]


def test_a_list_of_sources_gets_a_line(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(
        PROJECT.replace("sources: [two.yaml, types.yaml]", "sources:\n  - two.yaml   # more\n"), encoding="utf-8"
    )
    (tmp_path / "two.yaml").write_text(OTHER, encoding="utf-8")
    moved = texts(plan_move(judge_version(load_project(tmp_path)), ("group", "sensing"), None, "sensing.yaml"))
    assert "sources:\n  - two.yaml   # more\n  - sensing.yaml\n" in moved["archgen.yaml"]
    assert moved["sensing.yaml"].startswith("groups:\n  # What sees.\n  sensing:\n    owner: lab\n")


def test_a_file_is_split_by_groups_components_or_sections(version: JudgedVersion) -> None:
    by_group = texts(plan_split(version, "archgen.yaml", None))
    assert sorted(by_group) == ["archgen.yaml", "groups/driving.yaml", "groups/sensing.yaml"]
    assert by_group["groups/sensing.yaml"].startswith("groups:\n  # What sees.\n  sensing:\n    owner: lab\n")
    assert (
        "sources: [two.yaml, types.yaml, groups/sensing.yaml, groups/driving.yaml]\npartners:"
        in by_group["archgen.yaml"]
    )
    assert "\ngroups:\n" not in by_group["archgen.yaml"].partition("variants:")[0]
    with pytest.raises(EditRefusedError, match=r"types\.yaml is there already"):
        plan_split(version, "archgen.yaml", "section")
    by_section = texts(plan_split(version, "two.yaml", "section"))
    # What would be empty keeps what comes first.
    assert by_section["nodes.yaml"] == "nodes:\n  eye: {implements: sensing.camera}\n"
    assert by_section["two.yaml"] == OTHER.partition("nodes:")[0]


@pytest.mark.parametrize(
    ("name", "group", "file", "message"),
    [
        ("sensing.camera", "sensing", None, "stands in that group already"),
        ("sensing.camera", None, "two.yaml", "two.yaml:4:7: the file says something of `camera` already"),
        ("sensing.camera", "sky", None, "there is no group `sky`"),
        ("camera.image", "driving", None, "does not stand directly in a group"),
        ("camera.image", None, "two.yaml", "goes with it"),
        ("sensing.camera", None, "../two.yaml", "lies outside of the project"),
        ("sensing.camera", None, "/two.yaml", "lies outside of the project"),
        ("sensing.camera", None, "two.txt", "is no name of a slice"),
        ("Image", None, "two.yaml", "is written in braces, or behind a key in its line"),
    ],
)
def test_what_cannot_be_moved_is_refused(
    version: JudgedVersion, name: str, group: str | None, file: str | None, message: str
) -> None:
    with pytest.raises(EditRefusedError) as refused:
        move(version, name, group, file)
    assert message in refused.value.message
    assert refused.value.by_hand


def test_what_cannot_be_split_is_refused(version: JudgedVersion) -> None:
    with pytest.raises(EditRefusedError, match=r"other\.yaml is no slice of the project"):
        plan_split(version, "other.yaml", None)
    with pytest.raises(EditRefusedError, match=r"groups/camera\.yaml is there already"):
        plan_split(version, "two.yaml", "component")
    with pytest.raises(EditRefusedError, match=r"nothing in types\.yaml to be split by group"):
        plan_split(version, "types.yaml", "group")


def test_a_file_whose_lines_editors_and_yaml_see_differently_is_not_split(tmp_path: Path) -> None:
    text = "archgen: 1 # one\rgroups: {g: {components: {a: {}}}}\n"
    (tmp_path / "archgen.yaml").write_bytes(text.encode())
    with pytest.raises(EditRefusedError, match="line breaks that editors and parsers see differently"):
        plan_split(judge_version(load_project(tmp_path)), "archgen.yaml", None)


def test_a_source_that_is_a_whole_group_would_read_more(tmp_path: Path) -> None:
    text = PROJECT.replace("{from: camera.image}", "{from: sensing}")
    (tmp_path / "archgen.yaml").write_text(text, encoding="utf-8")
    (tmp_path / "two.yaml").write_text(OTHER, encoding="utf-8")
    with pytest.raises(EditRefusedError, match="more than names") as refused:
        move(judge_version(load_project(tmp_path)), "sensing.lidar", "driving")
    assert "`from`" in refused.value.by_hand


def test_what_goes_by_the_group_is_told(tmp_path: Path) -> None:
    text = PROJECT.replace("show: sensing.camera+", "show: sensing")
    (tmp_path / "archgen.yaml").write_text(text, encoding="utf-8")
    (tmp_path / "two.yaml").write_text(OTHER, encoding="utf-8")
    (tmp_path / "types.yaml").write_text("hosts: {pc: PC}\n", encoding="utf-8")
    moved = move(judge_version(load_project(tmp_path)), "sensing.lidar", "driving")
    told = "what `sensing` selects in the view `eyes` is more or less by what moved: it goes by the group"
    assert told in moved.notes


@pytest.mark.slow
def test_the_case_study_split_says_the_same_with_all_comments() -> None:
    version = judge_version(load_project(RAMCIP))
    split = plan_split(version, "groups/robot_action_planner.yaml", "component")
    again = judge_edited(version, {edit.file: edit.new_content for edit in split.edits})
    assert sorted(again.project.architecture.components) == sorted(version.project.architecture.components)
    comments = [
        Counter(line.strip() for text in side for line in text.decode().splitlines() if line.lstrip().startswith("#"))
        for side in ([edit.old_content or b"" for edit in split.edits], [edit.new_content for edit in split.edits])
    ]
    assert comments[0] == comments[1]
    assert "elements come in another order now, which reports and lists show" in split.notes
    assert [note for note in split.notes if note.startswith("on the wire")] == []
