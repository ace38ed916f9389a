"""Where the finding about a breaking change stands: at the changed key, the element, or what held what is gone."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.products.compared_versions import ProjectVersion, compare_named_versions
from archgen.products.merge_breaks import find_breaks

FILES = {
    "archgen.yaml": """\
project: {id: mini}
partners: {a: A, b: B}
sources: [a.yaml, b.yaml]
ros: {distro: jazzy, interfaces: ["msg/**/*.msg"]}
types: {Stop: {message: m_msgs/msg/Stop, size: 10 B}}
""",
    "a.yaml": """\
groups:
  sense:
    owner: a
    components:
      eye:
        timing: {period: 100 ms, wcet: 5 ms}
        outputs: {stop: Stop}
nodes:
  eye: {implements: eye, publishes: {stop: {topic: /stop, qos: {reliability: reliable}}}}
""",
    "b.yaml": """\
groups:
  drive:
    owner: b
    components:
      base:
        timing: {rate: 50 Hz, wcet: 1 ms}
        inputs: {stop: sense.eye.stop}
nodes:
  base: {implements: base, subscribes: {stop: {topic: /stop, qos: {reliability: reliable}}}}
chains: {halt: {through: [eye, base], deadline: 300 ms}}
""",
    "msg/m_msgs/msg/Stop.msg": "uint8 what\n",
}


def project(folder: Path, **replaced: tuple[str, str]) -> ProjectVersion:
    """Make and check the project, with one text replaced in files named by their stem."""
    for name, text in FILES.items():
        old, new = replaced.get(Path(name).stem, ("", ""))
        assert old in text
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text.replace(old, new, 1) if old else text, encoding="utf-8")
    return ProjectVersion(folder.name, check_project(folder))


@pytest.mark.parametrize(
    ("changes", "places"),
    [
        # The key of timing, also where the comparison calls it by another name.
        ({"a": ("period: 100 ms", "period: 400 ms")}, ["a.yaml:6:26 sense.eye breaks B (promise)"]),
        ({"a": ("period: 100 ms", "rate: 2 Hz")}, ["a.yaml:6:24 sense.eye breaks B (promise)"]),
        # The value of a type, of a topic, of the quality of service.
        (
            {"a": ("outputs: {stop: Stop}", "outputs: {stop: std_msgs/msg/Empty}")},
            ["a.yaml:7:25 sense.eye.stop breaks B (wire)"],
        ),
        ({"a": ("topic: /stop", "topic: /halt")}, ["a.yaml:9:52 eye.publishes.stop breaks B (wire)"]),
        (
            {"a": ("reliability: reliable", "reliability: best_effort")},
            ["a.yaml:9:64 eye.publishes.stop breaks B (wire)"],
        ),
        # What is gone stood in its component, in its group, or in its file.
        ({"a": ("outputs: {stop: Stop}", "outputs: {}")}, ["a.yaml:5:7 sense.eye.stop breaks B (wire, promise)"]),
        # A message is a file.
        ({"Stop": ("uint8 what", "uint16 what")}, ["msg/m_msgs/msg/Stop.msg:1:1 m_msgs/msg/Stop breaks B (wire)"]),
        ({"b": ("rate: 50 Hz", "rate: 40 Hz")}, []),
    ],
)
def test_a_break_stands_where_the_change_is(
    tmp_path: Path, changes: dict[str, tuple[str, str]], places: list[str]
) -> None:
    before, after = project(tmp_path / "before"), project(tmp_path / "after", **changes)
    breaks = find_breaks(compare_named_versions(before, after), after.checked_project)
    assert [f"{finding.span} {finding.element} {finding.message.split(':')[0]}" for finding in breaks] == places
    assert all(finding.help for finding in breaks)


@pytest.mark.parametrize(
    ("change", "severity", "category"),
    [
        ({"a": ("topic: /stop", "topic: /halt")}, "warning", "wire"),
        ({"a": ("period: 100 ms", "period: 400 ms")}, "error", "promise"),
        # Of one change that breaks in two categories the graver counts.
        ({"a": ("outputs: {stop: Stop}", "outputs: {}")}, "error", "wire, promise"),
        ({"Stop": ("uint8 what", "uint8 what  # 0 is left")}, None, ""),
    ],
)
def test_a_break_has_the_severity_of_its_category(
    tmp_path: Path, change: dict[str, tuple[str, str]], severity: str | None, category: str
) -> None:
    policy = ("project: {id: mini}\n", "project: {id: mini}\nreview: {breaking: {promise: error}}\n")
    before, after = project(tmp_path / "before"), project(tmp_path / "after", archgen=policy, **change)
    breaks = find_breaks(compare_named_versions(before, after), after.checked_project)
    assert [str(finding.severity) for finding in breaks] == ([severity] if severity else [])
    assert all(finding.message.startswith(f"breaks B ({category}): ") for finding in breaks)
