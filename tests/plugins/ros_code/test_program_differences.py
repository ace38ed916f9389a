"""Nodes of one program that say different things: what only one program of each could be is told."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.plugins.ros_code.node_programs import make_view
from archgen.views.generation.generation_context import GenerationContext

PROJECT = """\
archgen: 1
project: {{id: lab}}
ros: {{distro: jazzy}}
component_types:
  motor: {{functionality: Turns., inputs: {{}}, outputs: {{state: std_msgs/String}}, timing: {{period: 10 ms}}}}
groups:
  g:
    components:
      left: {{is: motor}}
      right: {{is: motor, {component}}}
      other: {{functionality: Waits., inputs: {{}}, outputs: {{news: std_msgs/String}}, timing: {{period: 10 ms}}}}
nodes:
  l: {{implements: g.left, package: p}}
  r: {{implements: g.right, package: p, {node}}}
"""


def find_differences(folder: Path, component: str = "", node: str = "") -> list[str]:
    text = PROJECT.format(component=component, node=node).replace(", }", "}")
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    return [each.message for each in make_view(GenerationContext(check_project(folder).architecture)).findings]


@pytest.mark.parametrize(
    ("component", "node", "difference"),
    [
        ("timing: {period: 0.02 s}", "", "other periods than"),
        ("", "kind: lifecycle", "other kinds than"),
        ("", "threads: 3", "other threads than"),
        ("", "publishes: {state: {qos: {depth: 3}}}", "other QoS of `state` than"),
        ("", "threads: 3, publishes: {state: {qos: {depth: 3}}}", "other threads, QoS of `state` than"),
    ],
)
def test_a_difference_is_told(tmp_path: Path, component: str, node: str, difference: str) -> None:
    assert find_differences(tmp_path, component, node) == [
        f"the program `motor` is generated as `l` needs it: `r` has {difference} `l`"
    ]


def test_the_same_in_other_words_is_no_difference(tmp_path: Path) -> None:
    assert find_differences(tmp_path, "timing: {rate: 100 Hz}", "namespace: /r, publishes: {state: /elsewhere}") == []


def test_other_ports_are_told(tmp_path: Path) -> None:
    text = PROJECT.format(component="", node="").replace(", }", "}")
    (tmp_path / "archgen.yaml").write_text(
        f"{text}  o: {{implements: g.other, package: p, executable: motor}}\n", encoding="utf-8"
    )
    findings = make_view(GenerationContext(check_project(tmp_path).architecture)).findings
    assert [each.message for each in findings] == [
        "the program `motor` is generated as `l` needs it: `o` has not the same ports (`news`, `state`) as `l`"
    ]
