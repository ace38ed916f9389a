"""What component types say to their instances: components as instances would be that say nothing of their own."""

from __future__ import annotations

from pathlib import Path

from archgen import pipeline
from archgen.link.project_linking import link_type_patterns
from archgen.model.component import TypePatterns
from tests.compose.test_project_expansion import SHORT


def link_patterns(folder: Path, text: str) -> TypePatterns:
    file = folder / "robot.yaml"
    file.write_text(text, encoding="utf-8")
    checked = pipeline.check_project(file)
    return link_type_patterns(checked.merged_table, checked.architecture)


def test_patterns_are_types_and_what_is_inside_of_them(tmp_path: Path) -> None:
    patterns = link_patterns(tmp_path, SHORT)
    assert {name: each.timing and str(each.timing.wcet) for name, each in patterns.components.items()} == {
        "motor": "2 ms",
        "strong_motor": "3 ms",
        "filter": None,
        "arm.shoulder": "2 ms",
        "arm.elbow": "3 ms",
        "arm.joint": None,
        "arm": None,
    }
    assert [path for path, _ in patterns.list_parts("arm")] == ["shoulder", "elbow", "joint"]
    assert patterns.components["filter"].outputs["clean"].type == "T"
    node = patterns.nodes[patterns.components["arm.elbow"].id]
    assert (node.package, node.executable) == ("m", "motor")


def test_parts_of_parts_have_their_path_below_the_type(tmp_path: Path) -> None:
    text = "component_types:\n  a: {components: {b: {components: {c: {outputs: {o: T}}}}}}\n  d: {components: {e: {is: a}}}\n"
    patterns = link_patterns(tmp_path, text + "groups: {g: {components: {x: {is: d}}}}\n")
    assert [path for path, _ in patterns.list_parts("d")] == ["e", "e.b", "e.b.c"]


def test_an_abstract_type_and_one_in_a_circle_have_patterns(tmp_path: Path) -> None:
    text = "component_types:\n  a: {abstract: true, tags: [t]}\n  b: {components: {c: {is: b}}}\n  d: {is: d}\n"
    patterns = link_patterns(tmp_path, text + "groups: {g: {components: {x: {outputs: {o: T}}}}}\n")
    assert patterns.components["a"].tags == ("t",)
    assert [path for path, _ in patterns.list_parts("b")] == ["c", "c.c"]


def test_a_project_without_types_has_none(tmp_path: Path) -> None:
    assert link_patterns(tmp_path, "groups: {g: {components: {x: {outputs: {o: T}}}}}\n") == TypePatterns()
