"""Tests of what errors of reading and linking explain."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import NO_SPAN
from archgen.findings.error_aftermath import AFTERMATH_RULES, drop_aftermath, list_waiting_rules
from archgen.pipeline import SHIPPED_RULES, check_project
from tests.judged_projects import check_text


def _findings(folder: Path, files: dict[str, str]) -> list[str]:
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    return [f"{d.span.file}:{d.span.line} {d.severity} {d.rule}" for d in check_project(folder).findings]


def test_every_rule_that_may_wait_exists_and_can_be_switched_off() -> None:
    assert {rule.name for rule in SHIPPED_RULES if not rule.fixed} >= AFTERMATH_RULES


def test_what_an_error_swallowed_is_neither_lacking_nor_unused() -> None:
    error = Diagnostic("unknown-key", "input", NO_SPAN, element="g.screen")
    findings = [
        Diagnostic("disconnected-component", "of the whole model", NO_SPAN, element="g.other"),
        Diagnostic("unfed-input", "of the damaged element", NO_SPAN, element="g.screen"),
        Diagnostic("unfed-input", "of another element", NO_SPAN, element="g.other"),
        Diagnostic("type-mismatch", "not about what is missing", NO_SPAN, element="g.screen"),
    ]
    waiting_rules = list_waiting_rules([error], frozenset(), is_partial=False)
    assert "unchecked-message" not in waiting_rules
    assert [d.message for d in drop_aftermath(findings, [error], waiting_rules)] == [
        "of another element",
        "not about what is missing",
    ]
    assert list(drop_aftermath(findings, [], list_waiting_rules([], frozenset(), is_partial=False))) == findings


_ROBOT = {
    "archgen.yaml": """\
archgen: 1
project: {id: robot}
sources: ["groups/*.yaml", nodes.yaml]
ros: {distro: jazzy}
rules: {unread-output: off, missing-detail: off}
""",
    "groups/sensing.yaml": """\
groups:
  sensing:
    components:
      camera: {outputs: {image: Image, depth: Depth}, timing: {rate: 30 Hz, wcet: 30 ms}}
      screen: {inputs: {image: camera.image}, timing: {wcet: 1 ms}}
""",
    "nodes.yaml": """\
nodes:
  camera: {implements: camera, host: pc}
  screen: {implements: screen, host: pc}
types: {Depth: sensor_msgs/msg/Image, Image: sensor_msgs/msg/Image}
hosts: {pc: {cores: 1}}
chains: {see: {through: [camera, screen], deadline: 1 s}}
views: {all_of_it: {show: sensing}}
""",
}


@pytest.mark.parametrize(
    ("file", "text", "slip", "finding"),
    [
        ("archgen.yaml", "{id: robot}", "{id: robot", "archgen.yaml:2 error syntax-error"),
        ("archgen.yaml", "id: robot", "id: @robot", "archgen.yaml:2 error syntax-error"),
        ("archgen.yaml", "rules:", "rule:", "archgen.yaml:5 error unknown-key"),
        ("archgen.yaml", "unread-output: off", "unread-output: of", "archgen.yaml:5 error wrong-value"),
        ("archgen.yaml", "groups/*.yaml", "group/*.yaml", "archgen.yaml:3 error missing-source"),
        ("archgen.yaml", "nodes.yaml", "node.yaml", "archgen.yaml:3 error missing-source"),
        ("archgen.yaml", "ros: {distro: jazzy}", "ros: {distribution: jazzy}", "archgen.yaml:4 error unknown-key"),
        ("archgen.yaml", "ros: {distro: jazzy}", "ros: jazzy", "archgen.yaml:4 error wrong-type"),
        ("nodes.yaml", "hosts: {pc: {cores: 1}}", "hosts: [pc]", "nodes.yaml:5 error wrong-type"),
        ("archgen.yaml", "sources:", "source:", "archgen.yaml:3 error unknown-key"),
        ("archgen.yaml", "project:", "projekt:", "archgen.yaml:2 error unknown-key"),
        ("groups/sensing.yaml", "groups:", "group:", "groups/sensing.yaml:1 error unknown-key"),
        ("groups/sensing.yaml", "components:", "component:", "groups/sensing.yaml:3 error unknown-key"),
        ("groups/sensing.yaml", "{image: camera.image}", "{image: camera.image", "groups/sensing.yaml:5 error syntax-error"),
        ("nodes.yaml", "nodes:", "node:", "nodes.yaml:1 error unknown-key"),
        ("nodes.yaml", "types:", "type:", "nodes.yaml:4 error unknown-key"),
        ("nodes.yaml", "cores: 1", "cores: eight", "nodes.yaml:5 error wrong-type"),
        ("nodes.yaml", "[camera, screen]", "[camera, sreen]", "nodes.yaml:6 error unknown-reference"),
        ("groups/sensing.yaml", "{wcet: 1 ms}", "{wcet: 1 ms, trigger: [imag]}", "groups/sensing.yaml:5 error unknown-reference"),
        ("groups/sensing.yaml", "{wcet: 1 ms}", "{wcet: 1 ms, calls: {plann: 2}}", "groups/sensing.yaml:5 error unknown-reference"),
        ("groups/sensing.yaml", "rate: 30 Hz", "rate: 30", "groups/sensing.yaml:4 error wrong-value"),
    ],
)  # fmt: skip
def test_one_slip_is_one_finding(tmp_path: Path, file: str, text: str, slip: str, finding: str) -> None:
    assert _findings(tmp_path, _ROBOT) == []
    assert text in _ROBOT[file]
    assert _findings(tmp_path, {file: _ROBOT[file].replace(text, slip)}) == [finding]


def test_a_pattern_that_nothing_resembles_stays_a_warning_and_hides_nothing(tmp_path: Path) -> None:
    settings = _ROBOT["archgen.yaml"].replace("nodes.yaml]", 'nodes.yaml, "deployment/*.yaml"]')
    robot = _ROBOT | {"archgen.yaml": settings.replace("unread-output: off, ", "")}
    assert [line.split(" ", 1)[1] for line in _findings(tmp_path, robot)] == [
        "warning missing-source",
        "warning unread-output",
    ]


def test_no_comment_is_unused_while_its_rule_waits() -> None:
    text = """\
groups:
  g:
    components:
      a: {outputs: {o: std_msgs/msg/Empty}}  # archgen: ignore[unread-output] later
      b: {inputs: {i: {form: a.o}}}
nodes: {a: a, b: b}
"""
    assert [f"{d.span.line} {d.rule}" for d in check_text(text)] == ["5 unknown-key"]
