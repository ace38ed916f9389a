"""By which keys rosdep knows what generated packages need: their own names, or what hints say."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.products.output_options import OutputOptions
from archgen.products.workspace_product import write_workspace

PROJECT = """\
archgen: 1
project: {id: rt}
ros: {distro: DISTRO}
groups:
  g:
    components:
      laser: {outputs: {scan: Scan, level: Level}}
      user: {inputs: {scan: laser.scan, level: laser.level}}
      eye: {outputs: {seen: Scan}}
      broker: {outputs: {news: {type: News, medium: mqtt}}}
types:
  Scan: {message: acme_msgs/msg/Scan, status: existing, hints: {rosdep: acme-msgs}}
  Level: {fields: {scan: Scan, x: float64}}
containers: {seeing: {package: tuned_containers, executable: run, hints: {rosdep: tuned}}}
nodes:
  laser: {implements: laser, package: acme_laser, executable: run, status: existing, hints: {rosdep: acme-laser}}
  user: {implements: user}
  eye: {implements: eye, CONTAINER}
  broker: {implements: broker, kind: program, command: [mosquitto], hints: {rosdep: mosquitto}}
"""


def list_needs(folder: Path, text: str, backend: str) -> tuple[dict[str, set[str]], list[str]]:
    """Return what each package.xml names beside tools of ROS, and what was told."""
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    result = write_workspace(check_project(folder), OutputOptions(), backend, folder / "w")
    needs = {}
    for path in (folder / "w").glob("src/*/package.xml"):
        names = re.findall(r"<(?:exec_)?depend>([^<]*)</", path.read_text(encoding="utf-8"))
        needs[path.parent.name] = {each for each in names if not re.match(r"ros|launch|catkin|rclcpp|message_", each)}
    return needs, [each.message for each in result.findings]


@pytest.mark.parametrize(
    ("distro", "backend", "expected"),
    [
        ("jazzy", "ros2_launch", {"rt_bringup": {"acme-laser", "mosquitto", "rt_g", "rt_g_cpp", "tuned"}}),
        ("jazzy", "ros2_python", {"rt_g": {"acme-msgs", "rclpy", "rt_msgs"}}),
        ("jazzy", "ros2_cpp", {"rt_g_cpp": {"acme-msgs"}}),
        ("jazzy", "ros_interfaces", {"rt_msgs": {"acme-msgs"}}),
        ("noetic", "ros1_python", {"rt_g": {"acme-msgs", "rt_msgs"}}),
        ("noetic", "ros1_launch", {"rt_bringup": {"acme-laser", "mosquitto", "rt_g"}}),
    ],
)
def test_hints_say_them(distro: str, backend: str, expected: dict[str, set[str]], tmp_path: Path) -> None:
    container = "container: seeing" if distro == "jazzy" else "language: python"
    text = PROJECT.replace("DISTRO", distro).replace("CONTAINER", container)
    if distro == "noetic":
        text = "".join(line for line in text.splitlines(keepends=True) if not line.startswith("containers:"))
    assert list_needs(tmp_path, text, backend) == (expected, [])


def test_what_is_no_key_is_told(tmp_path: Path) -> None:
    text = PROJECT.replace("DISTRO", "jazzy").replace("CONTAINER", "container: seeing")
    text = text.replace("rosdep: mosquitto", "rosdep: [a]").replace("rosdep: tuned", "rosdep: '</exec_depend>'")
    text = text.replace(
        "implements: user", "implements: user, package: acme_laser, executable: x, hints: {rosdep: other}"
    )
    needs, told = list_needs(tmp_path, text, "ros2_launch")
    assert needs == {"rt_bringup": {"acme-laser", "rt_g", "tuned_containers"}}
    assert sorted(told) == [
        "`user` says that rosdep knows the package `acme_laser` as `other`, another one as `acme-laser`",
        "the hint `rosdep` of `broker` is no key of rosdep",
        "the hint `rosdep` of `seeing` is no key of rosdep",
    ]
