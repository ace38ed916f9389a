"""From a loaded project to its findings, stage by stage: merged, linked, with what it names, judged."""

from __future__ import annotations

from pathlib import Path

from archgen import project
from archgen.checking.all_rules import SHIPPED_RULES, list_structural_errors
from archgen.checking.checked_packing import pack_checked_project
from archgen.checking.checked_project import CheckedProject
from archgen.checking.linked_project import (
    MergedProject,
    link_merged_project,
    load_project_interfaces,
    merge_project,
    read_interface_files,
)
from archgen.checking.project_judging import judge_merged_project, read_named_contents
from archgen.diagnostics.diagnostic import Diagnostic
from archgen.link.declare.type_declaration import DeclaredTypes
from archgen.timing.run_analysis import AnalysisMemory

ROBOT = """\
archgen: 1
project: {id: rover, title: Rover}
groups: {g: {components: {cam: {outputs: {image: sensor_msgs/msg/Image}}, look: {inputs: {image: cam.image}}}}}
"""


def merge(folder: Path, **files: str) -> MergedProject:
    """Write a project (`part_yaml` is part.yaml), and merge it."""
    for name, text in files.items():
        (folder / name.replace("_", ".")).write_text(text, encoding="utf-8")
    return merge_project(project.load_project(folder))


def judge(folder: Path, text: str) -> CheckedProject:
    """Judge a project of one slice."""
    return judge_merged_project(merge(folder, archgen_yaml=text), AnalysisMemory())


def told(diagnostics: tuple[Diagnostic, ...]) -> list[str]:
    """Return the places and the rules of diagnostics."""
    return [f"{each.span.file}:{each.span.line} {each.rule}" for each in diagnostics]


def test_every_rule_has_one_name() -> None:
    assert len({rule.name for rule in SHIPPED_RULES}) == len(SHIPPED_RULES)


def test_slices_become_one_table(tmp_path: Path) -> None:
    merged_project = merge(
        tmp_path, archgen_yaml=ROBOT, more_yaml="project: {title: Other}\ngroups: {h: {components: {c: }}}\n"
    )
    assert merged_project.is_folder
    assert list(merged_project.table.entries) == ["archgen", "project", "groups"]
    assert told(merged_project.diagnostics) == ["more.yaml:1 conflicting-values"]
    assert (merged_project.reading_errors, merged_project.damaged_elements) == ((), frozenset())


def test_what_could_not_be_read_is_damaged(tmp_path: Path) -> None:
    merged_project = merge(tmp_path, archgen_yaml=ROBOT.replace("look: {", "look: {outputs: 5, "))
    assert told(merged_project.reading_errors) == ["archgen.yaml:3 wrong-type"]
    assert merged_project.damaged_elements == {"g.look"}


def test_a_project_of_one_file_is_no_folder(tmp_path: Path) -> None:
    file = tmp_path / "robot.yaml"
    file.write_text(ROBOT, encoding="utf-8")
    assert not merge_project(project.load_project(file)).is_folder


def test_the_architecture_has_what_is_derived(tmp_path: Path) -> None:
    linked_project = link_merged_project(merge(tmp_path, archgen_yaml=ROBOT))
    assert list(linked_project.linked_architecture.components) == ["g.cam", "g.look"]
    assert (linked_project.linked_architecture.topics, list(linked_project.architecture.topics)) == (
        {},
        ["/g/cam/image"],
    )
    assert (linked_project.interface_findings, linked_project.link_findings) == ((), ())


def test_definitions_of_the_project_come_before_shipped_ones(tmp_path: Path) -> None:
    (tmp_path / "msgs" / "msg").mkdir(parents=True)
    (tmp_path / "msgs" / "msg" / "Own.msg").write_text("int32 x\n", encoding="utf-8")
    merged_project = merge(
        tmp_path,
        archgen_yaml="archgen: 1\nros: {distro: jazzy, interfaces: [msgs/msg/*.msg], definitions: {own_msgs/msg/Inline: int8 y}}\n",
    )
    texts, _ = read_interface_files(merged_project.loaded_project)
    assert texts == {"msgs/msg/Own.msg": "int32 x\n"}
    interfaces, findings = load_project_interfaces(
        merged_project.loaded_project, merged_project.table, DeclaredTypes({})
    )
    assert findings == ()
    assert {"msgs/msg/Own", "own_msgs/msg/Inline", "std_msgs/msg/Bool"} <= interfaces.names


def test_files_that_are_named_and_missing_are_told(tmp_path: Path) -> None:
    text = f"{ROBOT}nodes: {{n: {{implements: cam, parameter_files: [none.yaml]}}}}\nreport: {{chapters: [intro.md]}}\n"
    merged_project = merge(tmp_path, archgen_yaml=text, intro_md="![p](none.png)\n")
    chapters, findings = read_named_contents(merged_project, link_merged_project(merged_project))
    assert list(chapters.texts) == ["intro.md"]
    assert told(findings) == ["intro.md:1 missing-picture", "archgen.yaml:4 missing-parameter-file"]


def test_what_a_comment_silences_is_kept_apart(tmp_path: Path) -> None:
    shown = judge(tmp_path, ROBOT.replace("inputs: {image: cam.image}", ""))
    assert "unread-output" in {each.rule for each in shown.findings}
    assert shown.silenced_findings == ()
    ignored = judge(
        tmp_path, f"{ROBOT.replace('inputs: {image: cam.image}}}}}', '}}}}  # archgen: ignore[unread-output] later')}"
    )
    assert "unread-output" not in {each.rule for each in ignored.findings}
    assert [each.rule for each in ignored.silenced_findings] == ["unread-output"]


def test_rules_about_what_is_missing_wait_for_errors_of_reading(tmp_path: Path) -> None:
    assert judge(tmp_path, ROBOT).waiting_rules == frozenset()
    judged = judge(tmp_path, ROBOT.replace("look: {", "look: {outputs: 5, "))
    assert judged.waiting_rules
    assert told(judged.reading_errors) == ["archgen.yaml:3 wrong-type"]
    assert judged.structural_errors == judged.reading_errors
    assert judged.has_errors


def test_errors_of_reading_are_structural(tmp_path: Path) -> None:
    judged = judge(tmp_path, ROBOT.replace("cam.image", "cam.no"))
    rules = {each.rule for each in list_structural_errors(judged.findings)}
    assert rules == {each.rule for each in judged.structural_errors} == {"unknown-reference"}
    assert judged.reading_errors == ()


def test_outputs_depend_on_all_files_that_were_read(tmp_path: Path) -> None:
    merged_project = merge(tmp_path, archgen_yaml=f"{ROBOT}report: {{chapters: [intro.md]}}\n", intro_md="Hello\n")
    judged = judge_merged_project(merged_project, AnalysisMemory())
    assert judged.input_files == ("archgen.yaml", "intro.md")
    assert (judged.root, judged.output_folder) == (tmp_path, tmp_path / "archgen-out")
    packed_project = pack_checked_project(judged)
    report = packed_project.data["report"]
    assert isinstance(report, dict)
    assert report["texts"] == {"intro.md": "Hello\n"}


def test_a_comment_at_the_first_line_of_whatever_element_silences(tmp_path: Path) -> None:
    text = """\
archgen: 1
project: {id: rover, title: Rover}
groups:
  g:
    components:
      arm:  # archgen: ignore[missing-file] drawn later
        components: {joint: {is: hand}}
        image: arm.svg
component_types:
  hand:  # archgen: ignore[missing-file] drawn later
    outputs: {x: std_msgs/msg/Bool}
    image: hand.svg
"""
    judged = judge(tmp_path, text)
    assert {"missing-file", "unused-ignore"}.isdisjoint(each.rule for each in judged.findings), told(judged.findings)
    assert [each.rule for each in judged.silenced_findings] == ["missing-file", "missing-file"]
