"""A trace held against the design: nodes, ends, depths and computers, as far as it tells them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from archgen.conformance.robot_comparison import ComparedPart
from archgen.importers.foreign_import import ForeignFileError
from archgen.importers.robot_observation import ObservationOptions, observe_robot
from archgen.model.architecture import Architecture
from archgen.pipeline import CheckedProject
from archgen.products.robot_conformance import ConformanceReport, hold_against_robots
from tests.conformance.rovers import check_rover, show_findings

EVENTS = {
    "publishes": ("rcl_publisher_init", "topic_name"),
    "subscribes": ("rcl_subscription_init", "topic_name"),
    "serves": ("rcl_service_init", "service_name"),
    "calls": ("rcl_client_init", "service_name"),
}


def print_trace(architecture: Architecture) -> str:
    """Return the trace of a robot that is as the architecture says, each node a process."""
    return "\n".join(_list_lines(architecture)) + "\n"


def _list_lines(architecture: Architecture) -> Iterator[str]:
    for number, node in enumerate(architecture.nodes.values()):
        begin = f"[10:00:00.{number:09}] (+0.000000001) {node.host} ros2:"
        context = f"{{ cpu_id = 1 }}, {{ vpid = {number + 10}, vtid = {number + 10} }}"
        fields = f'node_handle = 0x1, rmw_handle = 0x2, node_name = "{node.name}", namespace = "{node.namespace}"'
        yield f"{begin}rcl_node_init: {context}, {{ {fields} }}"
        for end in (each for each in architecture.endpoints if each.node == node.id):
            event, field = EVENTS[end.use]
            name = f"{end.name}/_action/send_goal" if end.flow == "action" else end.name
            depth = end.qos.depth if end.flow == "topic" else 10
            yield f'{begin}{event}: {context}, {{ node_handle = 0x1, {field} = "{name}", queue_depth = {depth} }}'


def compare(checked_project: CheckedProject, text: str) -> ConformanceReport:
    (checked_project.root / "trace.txt").write_text(text, encoding="utf-8")
    robot = observe_robot(checked_project.root / "trace.txt", checked_project.root, ObservationOptions())
    assert robot.kind == "trace"
    return hold_against_robots(checked_project, [robot], ComparedPart())


def test_a_trace_of_a_robot_as_designed_has_no_findings(tmp_path: Path) -> None:
    checked_project = check_rover(tmp_path)
    report = compare(checked_project, print_trace(checked_project.architecture))
    assert show_findings(report.reported.findings) == []
    seen = report.comparisons[0]
    assert (seen.nodes, seen.seen_nodes, seen.endpoints, seen.seen_endpoints) == (5, 5, 12, 12)


def test_what_differs_is_found_and_what_was_not_traced_is_not_claimed(tmp_path: Path) -> None:
    """A depth, a name, a computer, a node; without events of clients nothing is said of calls; a node that began again runs once."""
    checked_project = check_rover(tmp_path)
    text = print_trace(checked_project.architecture)
    lines = [line for line in text.splitlines() if "rcl_client_init" not in line and '"camera"' not in line]
    lines = [line.replace("arm_pc", "base") for line in lines]
    lines.append(next(line for line in lines if '"lidar"' in line).replace("vpid = 10", "vpid = 99"))
    planted = "\n".join(lines).replace('"/scan", queue_depth = 5', '"/scan", queue_depth = 1', 1)
    planted = planted.replace('"/cmd_vel"', '"/fast/cmd_vel"', 1)
    found = [each.split(" ", 3)[1::2] for each in show_findings(compare(checked_project, planted).reported.findings)]
    assert sorted(found) == [
        ["not-running", "`/camera` does not run on the robot"],
        ["other-host", "`/arm` runs on `base` on the robot, and on `arm_pc` in the design"],
        ["other-name", "`/planner` publishes `/fast/cmd_vel` on the robot, and `/cmd_vel` in the design"],
        ["other-qos", "the depth of `/scan` is `1` on the robot, and `5` in the design"],
    ]


def test_a_trace_that_began_too_late_says_what_to_do(tmp_path: Path) -> None:
    late = "[10:00:00.000000001] (+0.1) base ros2:callback_start: { cpu_id = 3 }, { vpid = 12, vtid = 12 }, { callback = 0x5 }\n"
    (tmp_path / "trace.txt").write_text(late, encoding="utf-8")
    with pytest.raises(ForeignFileError) as refused:
        observe_robot(tmp_path / "trace.txt", tmp_path, ObservationOptions())
    assert "has no `ros2:rcl_node_init`" in refused.value.message
    assert refused.value.help_line == "start tracing before the nodes start"
