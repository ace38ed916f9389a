"""A robot of five nodes as a project, and what the verbs of ROS 2 print of one that runs as an architecture says."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from pathlib import Path

from archgen.conformance.robot_comparison import ComparedPart
from archgen.diagnostics.diagnostic import Diagnostic
from archgen.importers.robot_observation import ObservationOptions, observe_robot
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint
from archgen.model.parameter_values import find_effective_parameters
from archgen.pipeline import CheckedProject, check_project
from archgen.products.robot_conformance import ConformanceReport, hold_against_robots

ROVER = """\
archgen: 1
project: {id: rover, title: Rover}
ros: {distro: jazzy}
partners: {north: {title: North}}
hosts: {base: {title: Base computer}, arm_pc: {title: Computer of the arm}}
groups:
  sensing:
    owner: north
    components:
      lidar:
        outputs: {scan: sensor_msgs/msg/LaserScan, reset: std_srvs/srv/Trigger}
        parameters: {frame: {type: string, value: laser}, rate: {type: float, value: 10}}
      camera: {outputs: {image: sensor_msgs/msg/Image}}
  motion:
    components:
      planner:
        inputs: {scan: lidar.scan, image: {from: camera.image, optional: true}, reset: lidar.reset}
        outputs: {drive: nav2_msgs/action/NavigateToPose, cmd_vel: geometry_msgs/msg/Twist}
      base: {inputs: {cmd_vel: planner.cmd_vel}, outputs: {odom: nav_msgs/msg/Odometry}}
      arm: {inputs: {drive: planner.drive, odom: base.odom}}
nodes:
  lidar:
    implements: sensing.lidar
    namespace: /front
    host: base
    status: existing
    remaps: {scan: /scan}
    parameters: {rate: 12.5}
    publishes: {scan: {own_name: scan, qos: {reliability: best_effort, depth: 5}}}
    serves: {reset: "~/reset"}
  camera: {implements: sensing.camera, host: base, status: existing, publishes: {image: /image}}
  planner:
    implements: motion.planner
    host: base
    status: existing
    subscribes: {scan: {topic: /scan, qos: sensor_data}, image: /image}
    publishes: {cmd_vel: cmd_vel}
    serves: {drive: drive}
    calls: {reset: /front/lidar/reset}
  base: {implements: motion.base, host: base, status: existing, subscribes: {cmd_vel: cmd_vel}, publishes: {odom: odom}}
  arm: {implements: motion.arm, host: arm_pc, status: existing, subscribes: {odom: odom}, calls: {drive: drive}}
"""
_ENDLESS = 9223372036854775807
_SECTIONS = {
    "Subscribers": ("subscribes", "topic"),
    "Publishers": ("publishes", "topic"),
    "Service Servers": ("serves", "service"),
    "Service Clients": ("calls", "service"),
    "Action Servers": ("serves", "action"),
    "Action Clients": ("calls", "action"),
}


def check_rover(folder: Path, text: str = ROVER) -> CheckedProject:
    """Write a project into a folder and check it: there are no errors."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    checked_project = check_project(folder)
    assert not checked_project.has_errors, [each.message for each in checked_project.findings]
    return checked_project


def print_graph(architecture: Architecture) -> str:
    """Return what the verbs of ROS 2 print of a robot that is as the architecture says."""
    nodes = [each for each in architecture.nodes.values() if not each.is_program]
    lines = ["$ ros2 node list", *(node.full_name for node in nodes)]
    for node in nodes:
        ends = [each for each in architecture.endpoints if each.node == node.id and each.medium == "ros"]
        lines += [f"$ ros2 node info {node.full_name}", node.full_name]
        for title, (use, flow) in _SECTIONS.items():
            lines.append(f"  {title}:")
            lines += [
                f"    {e.name}: {e.message}" for e in ends if (e.use, e.flow) == (use, flow) and e.name and e.message
            ]
        for end in (each for each in ends if each.flow == "topic" and each.message):
            lines += _print_endpoint(node.namespace, node.name, end)
        values = {
            name: each.value for name, each in find_effective_parameters(architecture, node).items() if each.is_known
        }
        if values:
            lines += [f"$ ros2 param dump {node.full_name}", f"{node.full_name}:", "  ros__parameters:"]
            lines += [f"    {name}: {json.dumps(value)}" for name, value in values.items()]
    return "\n".join(lines) + "\n"


def _print_endpoint(namespace: str, name: str, end: Endpoint) -> Iterator[str]:
    yield f"$ ros2 topic info -v {end.name}"
    yield f"Node name: {name}"
    yield f"Node namespace: {namespace}"
    yield f"Topic type: {end.message}"
    yield f"Endpoint type: {'PUBLISHER' if end.use == 'publishes' else 'SUBSCRIPTION'}"
    yield "QoS profile:"
    yield f"  Reliability: {end.qos.reliability.upper()}"
    yield "  History (Depth): UNKNOWN"
    yield f"  Durability: {end.qos.durability.upper()}"
    yield f"  Lifespan: {end.qos.lifespan.value if end.qos.lifespan else _ENDLESS} nanoseconds"
    yield f"  Deadline: {end.qos.deadline.value if end.qos.deadline else _ENDLESS} nanoseconds"
    yield f"  Liveliness: {end.qos.liveliness.upper()}"
    yield f"  Liveliness lease duration: {end.qos.lease_duration.value if end.qos.lease_duration else _ENDLESS} nanoseconds"


def compare_with_graph(
    checked_project: CheckedProject, text: str, part: ComparedPart | None = None
) -> ConformanceReport:
    """Hold a project against the dump of a graph."""
    file = checked_project.root / "graph.txt"
    file.write_text(text, encoding="utf-8")
    robot = observe_robot(file, checked_project.root, ObservationOptions())
    return hold_against_robots(checked_project, [robot], part or ComparedPart())


def show_findings(findings: Iterable[Diagnostic]) -> list[str]:
    """Return findings as short lines: severity, rule, file and line, message."""
    return [f"{each.severity} {each.rule} {each.span.file}:{each.span.line} {each.message}" for each in findings]
