"""Whoever writes a frame publishes it on /tf or /tf_static, unless the node names the topic itself."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.model.architecture import Architecture
from archgen.timing.run_analysis import analyse_architecture

Derived = Callable[[str], Architecture]

DRIVE = """
groups: {{g: {{components: {{drive: {{title: Drive, frames: {{{frames}}}}}}}}}}}
frames: {{map: {{}}{more}}}
nodes: {{{nodes}}}
"""
HAND = "message: tf2_msgs/msg/TFMessage"


def list_transforms(architecture: Architecture) -> list[str]:
    """Return who publishes transforms where; what follows from frames with a `*`."""
    return [
        f"{endpoint.node} {endpoint.name}{'' if endpoint.written else '*'}"
        for endpoint in architecture.endpoints
        if endpoint.message == "tf2_msgs/msg/TFMessage"
    ]


@pytest.mark.parametrize(
    ("frames", "more", "nodes", "transforms"),
    [
        ("odom: map", "", "n: drive", ["n /tf*"]),
        ("odom: map, base: odom", "", "n: drive", ["n /tf*"]),
        ("odom: map, eye: {parent: odom, static: true}", "", "n: drive", ["n /tf*", "n /tf_static*"]),
        ("odom: map", "", "", ["drive /tf*"]),
        ("odom: ", "", "n: drive", []),
        ("", ", odom: {parent: map, by: drive}", "n: drive", ["n /tf*"]),
        ("", ", odom: {parent: map, by: n}", "n: {package: p}, m: drive", ["n /tf*"]),
        ("", ", odom: map", "n: drive", []),
        ("odom: map", "", "n: drive, m: drive", []),
        ("odom: map", "", f"n: {{implements: drive, internal: {{publishes: {{tf: {{topic: /tf, {HAND}}}}}}}}}", ["n /tf"]),
        ("odom: map", "", f"n: {{implements: drive, namespace: /r, internal: {{publishes: {{tf: {{topic: tf, {HAND}}}}}}}}}", ["n /r/tf"]),
        ("odom: map", "", f"n: {{implements: drive, internal: {{subscribes: {{tf: {{topic: /tf, {HAND}}}}}}}}}", ["n /tf", "n /tf*"]),
        ("eye: {parent: map, static: true}", "", f"n: {{implements: drive, internal: {{publishes: {{tf: {{topic: /tf, {HAND}}}}}}}}}", ["n /tf", "n /tf_static*"]),
    ],
)  # fmt: skip
def test_who_publishes_transforms(derived: Derived, frames: str, more: str, nodes: str, transforms: list[str]) -> None:
    assert list_transforms(derived(DRIVE.format(frames=frames, more=more, nodes=nodes))) == transforms


def test_transforms_have_the_quality_of_service_of_tf2_and_are_shared(derived: Derived) -> None:
    architecture = derived(DRIVE.format(frames="a: map, b: {parent: a, static: true}", more="", nodes="n: drive"))
    qos = {endpoint.name: (endpoint.qos.durability, endpoint.qos.depth) for endpoint in architecture.endpoints}
    assert qos == {"/tf": ("volatile", 100), "/tf_static": ("transient_local", 1)}
    assert [(topic.name, topic.shared) for topic in architecture.topics.values()] == [
        ("/tf", True),
        ("/tf_static", True),
    ]
    assert {endpoint.component for endpoint in architecture.endpoints} == {"g.drive"}


def test_frames_make_no_findings_of_topics_and_change_no_timing(tmp_path: Path) -> None:
    """A server stays on demand, and who reads /tf by hand is fed as before."""
    text = """
ros: {distro: jazzy}
groups:
  g:
    components:
      maps: {outputs: {load: example_interfaces/srv/Trigger}, timing: {wcet: 2 ms}FRAMES}
      user: {inputs: {load: maps.load}, timing: {rate: 2 Hz, wcet: 1 ms}}
nodes:
  maps: {implements: maps, host: pc}
  user: {implements: user, host: arm, internal: {subscribes: {tf: {topic: /tf, message: tf2_msgs/msg/TFMessage}}}}
hosts: {pc: {cores: 1}, arm: {cores: 1}}
links: {lan: {connects: [pc, arm], bandwidth: 1 Gbit/s, latency: 1 ms}}
rules: {missing-detail: off}
"""
    file = tmp_path / "robot.yaml"
    figures = []
    for frames in ("", ", frames: {map: , odom: map, eye: {parent: odom, static: true}}"):
        file.write_text(text.replace("FRAMES", frames), encoding="utf-8")
        checked = pipeline.check_project(file)
        assert [str(finding) for finding in checked.findings] == []
        analysis = analyse_architecture(checked.architecture)
        figures.append((analysis.system.activities["maps"].behaviour, analysis.hosts["pc"].utilisation.value))
    assert figures[0] == figures[1]
    assert figures[0][0] == "on_demand"
