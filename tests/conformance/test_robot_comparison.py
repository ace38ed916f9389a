"""A running robot held against the design: each planted difference is found at its line, and none where there is none."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from archgen.conformance.robot_comparison import ComparedPart
from archgen.pipeline import CheckedProject, check_project
from tests.conformance.rovers import ROVER, check_rover, compare_with_graph, print_graph, show_findings
from tests.quiet_seconds import measure_quiet_seconds
from tests.running import RAMCIP


@pytest.fixture(scope="module")
def rover(tmp_path_factory: pytest.TempPathFactory) -> CheckedProject:
    return check_rover(tmp_path_factory.mktemp("rover"))


def line_of(text: str) -> int:
    """Return the line of the project that holds a text."""
    return next(number for number, line in enumerate(ROVER.splitlines(), 1) if text in line)


def cut_node(graph: str, name: str) -> str:
    """Take all that is said of a node out of a graph."""
    graph = graph.replace(f"\n{name}\n", "\n", 1)
    graph = re.sub(rf"\$ ros2 (?:node info|param dump) {name}\n(?:[^$].*\n)+", "", graph)
    return re.sub(rf"\$ ros2 topic info -v \S+\nNode name: {name.rpartition('/')[2]}\n(?:[^$].*\n)+", "", graph)


def test_a_robot_as_designed_has_no_findings(rover: CheckedProject) -> None:
    report = compare_with_graph(rover, print_graph(rover.architecture))
    assert show_findings(report.reported.findings) == []
    seen = report.comparisons[0]
    assert (seen.nodes, seen.seen_nodes, seen.endpoints, seen.seen_endpoints, seen.untold) == (5, 5, 12, 12, 0)
    assert seen.compared_parameters == 2


def test_the_case_study_as_designed_has_no_findings(tmp_path: Path) -> None:
    """Nodes that are planned and run already are told, and are no difference."""
    checked_project = check_project(shutil.copytree(RAMCIP, tmp_path / "ramcip"))
    report = compare_with_graph(checked_project, print_graph(checked_project.architecture))
    assert show_findings(report.reported.findings) == []
    comparison = report.comparisons[0]
    planned = [each.full_name for each in checked_project.architecture.nodes.values() if each.status == "planned"]
    assert planned
    assert comparison.early_nodes == planned
    assert comparison.seen_nodes == len(checked_project.architecture.nodes)


def both(*changes: tuple[str, str]) -> Callable[[str], str]:
    """Return what replaces texts, each of which is there."""

    def plant(graph: str) -> str:
        for old, new in changes:
            assert old in graph, old
            graph = graph.replace(old, new, 1)
        return graph

    return plant


def replaced(old: str, new: str) -> Callable[[str], str]:
    """Return what replaces a text that is there."""
    return both((old, new))


def odometry_policy(end: str, policy: str, value: str) -> Callable[[str], str]:
    """Return what changes a policy of one end of the odometry."""
    pattern = rf"(Topic type: nav_msgs/msg/Odometry\nEndpoint type: {end}\n(?:.+\n)*?  {policy}: )\w+"
    return lambda graph: re.sub(pattern, rf"\g<1>{value}", graph, count=1)


STRANGER = "$ ros2 node info /relay\n/relay\n  Subscribers:\n    /scan: sensor_msgs/msg/LaserScan\n"
FAULTS: dict[str, tuple[Callable[[str], str], Sequence[tuple[str, str, str]]]] = {
    "type of a topic": (
        both(
            ("  Publishers:\n    /odom: nav_msgs/msg/Odometry", "  Publishers:\n    /odom: nav_msgs/msg/Path"),
            (
                "Topic type: nav_msgs/msg/Odometry\nEndpoint type: PUB",
                "Topic type: nav_msgs/msg/Path\nEndpoint type: PUB",
            ),
        ),
        [
            (
                "error other-type",
                "  base: {implements",
                "has the type `nav_msgs/msg/Path` on the robot, and `nav_msgs/msg/Odometry` in",
            )
        ],
    ),
    "type of a service": (
        replaced("/front/lidar/reset: std_srvs/srv/Trigger", "/front/lidar/reset: std_srvs/srv/Empty"),
        [
            (
                "error other-type",
                "serves: {reset",
                "`/front/lidar/reset`, which `/front/lidar` serves, has the type `std_srvs/srv/Empty`",
            )
        ],
    ),
    "type of an action": (
        replaced("    /drive: nav2_msgs/action/NavigateToPose", "    /drive: nav2_msgs/action/Spin"),
        [
            (
                "error other-type",
                "serves: {drive",
                "`/drive`, which `/planner` serves, has the type `nav2_msgs/action/Spin`",
            )
        ],
    ),
    "remap that is lost": (
        both(
            ("  Publishers:\n    /scan:", "  Publishers:\n    /front/scan:"),
            ("-v /scan\nNode name: lidar", "-v /front/scan\nNode name: lidar"),
        ),
        [
            (
                "error other-name",
                "publishes: {scan",
                "publishes `/front/scan` on the robot, and `/scan` in the design: its remap does not count",
            )
        ],
    ),
    "name that is misspelt": (
        both(
            ("  Subscribers:\n    /odom:", "  Subscribers:\n    /odometry:"),
            ("-v /odom\nNode name: arm", "-v /odometry\nNode name: arm"),
        ),
        [
            (
                "error other-name",
                "  arm: {implements",
                "`/arm` subscribes to `/odometry` on the robot, and `/odom` in the design",
            )
        ],
    ),
    "node that is gone": (
        lambda graph: cut_node(graph, "/base"),
        [("error not-running", "  base: {implements", "`/base` does not run")],
    ),
    "service that is gone": (
        replaced("    /front/lidar/reset: std_srvs/srv/Trigger\n", ""),
        [("error not-running", "serves: {reset", "`/front/lidar` does not serve `/front/lidar/reset`")],
    ),
    "client that is gone": (
        replaced("  Action Clients:\n    /drive: nav2_msgs/action/NavigateToPose\n", ""),
        [("warning not-running", "  arm: {implements", "`/arm` does not call `/drive`")],
    ),
    "node that is not designed": (
        lambda graph: graph + STRANGER,
        [("warning not-in-model", "", "there is a node `/relay` on the robot, and the design has none of this name")],
    ),
    "topic that is not designed": (
        replaced(
            "    /image: sensor_msgs/msg/Image\n",
            "    /image: sensor_msgs/msg/Image\n    /depth: sensor_msgs/msg/PointCloud2\n",
        ),
        [
            (
                "warning not-in-model",
                "  camera: {implements",
                "`/camera` publishes `/depth`, and the design does not say so",
            )
        ],
    ),
    "reliability that is written": (
        replaced("Reliability: BEST_EFFORT", "Reliability: RELIABLE"),
        [
            (
                "error other-qos",
                "publishes: {scan",
                "the reliability of `/scan` is `reliable` on the robot, and `best_effort` in the design",
            )
        ],
    ),
    "reliability that no longer fits": (
        odometry_policy("PUBLISHER", "Reliability", "BEST_EFFORT"),
        [
            (
                "error other-qos",
                "  base: {implements",
                "`/odom` does not arrive on the robot: a reader asks for reliable delivery, and best effort only is offered",
            )
        ],
    ),
    "durability that no longer fits": (
        odometry_policy("SUBSCRIPTION", "Durability", "TRANSIENT_LOCAL"),
        [
            (
                "error other-qos",
                "  arm: {implements",
                "`/odom` does not arrive on the robot: a reader asks for what was sent before it started",
            )
        ],
    ),
    "node that runs twice": (
        replaced("\n/camera\n", "\n/camera\n/camera\n"),
        [("error runs-twice", "  camera: {implements", "2 nodes are called `/camera` on the robot")],
    ),
    "node that is called otherwise": (
        lambda graph: graph.replace("/base\n", "/chassis\n").replace("Node name: base", "Node name: chassis"),
        [
            (
                "error other-name",
                "  base: {implements",
                "`/base` is called `/chassis` on the robot: what it uses is the same",
            )
        ],
    ),
    "parameter of another value": (
        replaced("rate: 12.5", "rate: 10.0"),
        [
            (
                "warning other-parameter",
                "parameters: {rate: 12.5}",
                "the parameter `rate` of `/front/lidar` is `10.0` on the robot, and `12.5` in the design",
            )
        ],
    ),
    "parameter that nobody declares": (
        replaced('    frame: "laser"\n', ""),
        [
            (
                "warning other-parameter",
                "frame: {type",
                '`/front/lidar` has no parameter `frame` on the robot: `"laser"` reaches nobody',
            )
        ],
    ),
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_planted_difference_is_found_at_its_line_and_no_other(rover: CheckedProject, name: str) -> None:
    plant, expected = FAULTS[name]
    graph = print_graph(rover.architecture)
    planted = plant(graph)
    assert planted != graph
    findings = compare_with_graph(rover, planted).reported.findings
    assert len(findings) == len(expected), show_findings(findings)
    for finding, (head, place, words) in zip(findings, expected, strict=True):
        assert f"{finding.severity} {finding.rule}" == head
        assert words in finding.message
        assert finding.help
        if place:
            assert (finding.span.file, finding.span.line) == ("archgen.yaml", line_of(place))
        else:
            assert (finding.span.file, finding.span.line) == ("graph.txt", graph.count("\n") + 2)


def test_what_may_differ_by_design_is_no_difference(tmp_path: Path) -> None:
    """Planned nodes, optional inputs, internal ends, hosts that are down, what a variant adds, tools and what ROS itself has."""
    text = ROVER.replace("motion.arm, host: arm_pc, status: existing", "motion.arm, host: arm_pc, status: planned")
    text = text.replace(
        "publishes: {image: /image}",
        "publishes: {image: /image}, internal: {publishes: {debug: {topic: /debug, message: std_msgs/msg/String}}}",
    )
    text += "variants:\n  wide: {title: Wide, changes: {nodes: {side: {implements: sensing.camera, status: existing, publishes: {image: /side}}}}}\n"
    checked_project = check_rover(tmp_path, text)
    graph = cut_node(print_graph(checked_project.architecture), "/arm")
    graph = graph.replace("    /image: sensor_msgs/msg/Image\n  Publishers", "  Publishers").replace(
        "    /debug: std_msgs/msg/String\n", ""
    )
    graph += "$ ros2 node info /side\n/side\n  Publishers:\n    /side: sensor_msgs/msg/Image\n"
    graph += "$ ros2 node info /rviz2\n/rviz2\n  Subscribers:\n    /scan: sensor_msgs/msg/LaserScan\n"
    graph += "$ ros2 node info /camera\n/camera\n  Publishers:\n    /rosout: rcl_interfaces/msg/Log\n    /image/compressed: sensor_msgs/msg/CompressedImage\n"
    report = compare_with_graph(checked_project, graph)
    assert show_findings(report.reported.findings) == []


def test_values_that_files_of_other_packages_may_set_are_not_compared(tmp_path: Path) -> None:
    text = ROVER.replace(
        "parameters: {rate: 12.5}", "parameters: {rate: 12.5}\n    parameter_files: [$(find-pkg-share sick)/sick.yaml]"
    )
    checked_project = check_rover(tmp_path, text)
    graph = print_graph(checked_project.architecture)
    changed = graph.replace('frame: "laser"', 'frame: "scanner"').replace("rate: 12.5", "rate: 10.0")
    findings = compare_with_graph(checked_project, changed).reported.findings
    assert [finding.message for finding in findings] == [
        "the parameter `rate` of `/front/lidar` is `10.0` on the robot, and `12.5` in the design"
    ]
    assert changed.count("scanner") == 1


def test_states_and_computers_are_compared_as_far_as_both_sides_tell(tmp_path: Path) -> None:
    """A node that should stay inactive is; one that nobody activates is not compared; a computer by its id, title or domain name."""
    text = ROVER.replace("  camera: {implements", "  camera: {kind: lifecycle, start: {state: active}, implements")
    text = text.replace("  base: {implements", "  base: {kind: lifecycle, start: {state: inactive}, implements")
    text = text.replace("  arm: {implements", "  arm: {kind: lifecycle, implements")
    checked_project = check_rover(tmp_path, text)
    graph = print_graph(checked_project.architecture)
    states = {"/camera": "active", "/base": "inactive", "/arm": "inactive"}
    places = "".join(f"$ ros2 lifecycle get {name}\n{state} [2]\n" for name, state in states.items())
    places += "$ archgen host Base-Computer.lan\n/camera\n/base\n/nobody\n$ archgen host other\n/planner\n$ archgen host ARM-PC\n/arm\n"
    wrong = places.replace("/camera\nactive", "/camera\nfinalized").replace("ARM-PC\n", "base\n")
    quiet = {"not-running", "other-qos"}  # an end of a lifecycle node that is not active is not there
    found = [
        [(each.rule, each.message) for each in compare_with_graph(checked_project, graph + text).reported.findings]
        for text in (places, wrong)
    ]
    assert [each for each in found[0] if each[0] not in quiet] == []
    assert [each for each in found[1] if each[0] not in quiet] == [
        ("other-state", "the lifecycle node `/camera` is finalized on the robot, and active in the design"),
        ("other-host", "`/arm` runs on `base` on the robot, and on `arm_pc` in the design"),
    ]


def test_a_node_whose_name_nobody_says_is_not_missed(tmp_path: Path) -> None:
    """As an import of a workspace marks it: what its program calls itself may be there under that name."""
    text = ROVER.replace("  camera: {implements", "  camera: {hints: {launch: {name: unknown}}, implements")
    checked_project = check_rover(tmp_path, text)
    found = compare_with_graph(checked_project, cut_node(print_graph(checked_project.architecture), "/camera"))
    shown = [each for each in show_findings(found.reported.findings) if "camera" in each]
    place = f"archgen.yaml:{line_of('  camera: {implements')}"
    words = "`/camera` does not run on the robot, unless it is called otherwise: its launch file does not say how"
    assert shown == [f"note not-running {place} {words}"]


def test_what_ros_gives_each_node_is_seen_where_the_design_has_it(tmp_path: Path) -> None:
    """A hidden topic, and the calls by which a manager changes states: not told as strange, and not as missing."""
    text = ROVER.replace(
        "image: /image}}\n", "image: /image}, internal: {subscribes: {led: {topic: /hmi/_led}}}}\n"
    ).replace("topic: /scan, qos", "topic: /_scan, qos")
    text = text.replace("remaps: {scan: /scan}", "remaps: {scan: /_scan}")
    checked_project = check_rover(tmp_path, text)
    graph = print_graph(checked_project.architecture)
    assert "/_scan" in graph
    report = compare_with_graph(
        checked_project, graph.replace("/arm\n  Sub", "/arm\n  Publishers:\n    /_own: a/msg/B\n  Sub")
    )
    assert show_findings(report.reported.findings) == []


def test_hosts_that_are_not_named_are_not_missed(rover: CheckedProject) -> None:
    graph = cut_node(print_graph(rover.architecture), "/arm")
    assert [each.rule for each in compare_with_graph(rover, graph).reported.findings] == ["not-running"]
    report = compare_with_graph(rover, graph, ComparedPart(hosts=("base",)))
    assert report.reported.findings == ()
    assert report.comparisons[0].nodes == 4


def test_a_graph_of_another_robot_is_one_finding(rover: CheckedProject) -> None:
    findings = compare_with_graph(rover, STRANGER).reported.findings
    assert [each.message.partition("graph.txt")[2] for each in findings] == [
        " has none of the 5 nodes of the design: it is that of another robot"
    ]


def test_a_name_that_the_design_does_not_say_is_offered(tmp_path: Path) -> None:
    """What may be the end whose name is not written is a note with the text to write."""
    graph = print_graph(check_rover(tmp_path / "whole").architecture)
    text = ROVER.replace("publishes: {image: /image}", "publishes: {image: {}}").replace("image: /image}", "image: {}}")
    findings = compare_with_graph(check_rover(tmp_path / "part", text), graph).reported.findings
    assert show_findings(findings)[0] == (
        f"note not-in-model archgen.yaml:{line_of('  camera: {implements')} `/camera` publishes `/image`, which may be "
        "`sensing.camera.image`, whose name the design does not say"
    )
    assert findings[0].help == "write `topic: /image` there; it belongs to North"
    assert {each.severity for each in findings} == {"note"}


def test_a_dump_without_uses_says_nothing_about_them(rover: CheckedProject) -> None:
    """Absence of evidence is no fault: of nodes that are only listed nobody knows what they use."""
    report = compare_with_graph(rover, "$ ros2 node list\n/front/lidar\n/camera\n/planner\n/base\n/arm\n")
    assert report.reported.findings == ()
    assert (report.comparisons[0].seen_endpoints, report.comparisons[0].untold) == (0, 11)


def test_an_action_whose_type_a_dump_does_not_say_is_seen(rover: CheckedProject) -> None:
    graph = print_graph(rover.architecture).replace("    /drive: nav2_msgs/action/NavigateToPose\n", "")
    graph += "$ ros2 action info /drive\nAction: /drive\nAction clients: 1\n    /arm\nAction servers: 1\n    /planner\n"
    report = compare_with_graph(rover, graph)
    assert show_findings(report.reported.findings) == []
    assert report.comparisons[0].seen_endpoints == 12


def test_a_large_graph_is_quick(tmp_path: Path) -> None:
    """200 nodes beside a check: far below a second."""
    parts = [f"      c{n}: {{inputs: {{i: c{n - 1}.o}}, outputs: {{o: std_msgs/msg/String}}}}" for n in range(1, 200)]
    nodes = [f"  n{n}: {{implements: g.c{n}, status: existing, publishes: {{o: /t{n}}}}}" for n in range(200)]
    text = "\n".join(
        [
            "archgen: 1",
            "groups:\n  g:\n    components:\n      c0: {outputs: {o: std_msgs/msg/String}}",
            *parts,
            "nodes:",
            *nodes,
        ]
    )
    checked_project = check_rover(tmp_path, text + "\n")
    graph = print_graph(checked_project.architecture)
    reports = []
    assert measure_quiet_seconds(lambda: reports.append(compare_with_graph(checked_project, graph))) < 1
    (report,) = reports
    assert report.comparisons[0].seen_nodes == 200
    assert report.reported.findings == ()


LEGS = """\
archgen: 1
ros: {distro: jazzy}
component_types:
  leg:
    inputs: {goal: std_msgs/msg/Float64}
    outputs: {state: std_msgs/msg/Float64}
    node: {package: legs, executable: leg, publishes: {state: state}, subscribes: {goal: goal}}
groups:
  body:
    components:
      left: {is: leg, inputs: {goal: gait.l}, node: {namespace: /left}}
      right: {is: leg, inputs: {goal: gait.r}, node: {namespace: /right}}
      gait: {outputs: {l: std_msgs/msg/Float64, r: std_msgs/msg/Float64}, inputs: {states: [left.state, right.state]}}
nodes:
  gait: {implements: gait, publishes: {l: /left/goal, r: /right/goal}}
"""


def test_what_is_so_of_one_instance_is_not_to_be_written_at_the_type_of_all(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(LEGS, encoding="utf-8")
    project = check_project(tmp_path)
    graph = print_graph(project.architecture)
    before, start, after = re.sub(r"\$ ros2 topic info (?:.*\n)(?:[^$].*\n)+", "", graph).partition(
        "$ ros2 node info /right"
    )
    other_type = (
        before + start + after.replace("/right/goal: std_msgs/msg/Float64", "/right/goal: std_msgs/msg/Float32")
    )
    for changed, text in (
        (graph.replace("/right/state", "/right/stat"), "write `topic: /right/stat` here, or change the name there"),
        (other_type, "write `std_msgs/msg/Float32` as the type, or change the program"),
    ):
        findings = compare_with_graph(project, changed).reported.findings
        (of_leg,) = [each for each in findings if (each.element or "").startswith("body.right")]
        shared = "; this line is for 2 nodes: what is so of one alone goes to its instance `body.right`"
        assert of_leg.help == text + shared
        # An end that nobody wrote is told at its node, not in what was seen.
        assert {each.span.file for each in findings} == {"archgen.yaml"}


def test_a_node_that_moved_to_another_namespace_is_the_same_with_what_it_calls_relative_to_it(
    rover: CheckedProject, tmp_path: Path
) -> None:
    moved = check_rover(tmp_path, ROVER.replace("  base: {implements", "  base: {namespace: /robot, implements"))
    findings = compare_with_graph(rover, print_graph(moved.architecture)).reported.findings
    words = "`/base` is called `/robot/base` on the robot: what it uses is the same"
    assert [(each.rule, each.message) for each in findings if "/base" in each.message] == [("other-name", words)]
    (finding,) = [each for each in findings if each.rule == "other-name"]
    assert finding.help is not None
    assert "`namespace: /robot`" in finding.help
