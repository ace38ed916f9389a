"""Messages: what is unknown, what cannot be told, what is in conflict."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import pytest

from archgen.analyses.ros_facts import RULES, topic_type_conflict, unchecked_message, unknown_message
from archgen.diagnostics.diagnostic import Diagnostic, Rule, Severity
from archgen.diagnostics.source_span import Span
from archgen.findings.rule_pages import read_rule_page
from archgen.link.interface_sources import load_interfaces
from archgen.model.architecture import Architecture, ProjectInfo
from archgen.model.component import Output
from archgen.model.known_interfaces import Interfaces
from archgen.model.message_types import ConceptualType
from archgen.model.node import Endpoint, Node, PortUse, Topic, UseKind


def line(number: int, column: int = 1) -> Span:
    return Span("a.yaml", number, column, number, column + 5)


def architecture(
    *types: ConceptualType,
    outputs: tuple[Output, ...] = (),
    nodes: tuple[Node, ...] = (),
    topics: tuple[Topic, ...] = (),
    interfaces: Interfaces | None = None,
) -> Architecture:
    return Architecture(
        ProjectInfo("demo", "Demo"),
        types={type_.name: type_ for type_ in types},
        outputs={port.id: port for port in outputs},
        nodes={node.id: node for node in nodes},
        topics={topic.name: topic for topic in topics},
        interfaces=interfaces or load_interfaces("noetic")[0],
    )


def mapped(name: str, message: str | None, number: int, **changes: str) -> ConceptualType:
    return replace(ConceptualType(name, message, at=line(number), message_at=line(number, 20)), **changes)  # type: ignore[arg-type]


def output(name: str, type_: str, number: int) -> Output:
    return Output(f"g.c.{name}", name, "g.c", type_, at=line(number), type_at=line(number, 9))


def node(id_: str, message: str, number: int, *, internal: bool = False) -> Node:
    use = PortUse("publishes", "x", None, message=message, internal=internal, message_at=line(number, 30))
    return Node(id_, id_, uses=(use,), at=line(number))


def brief(diagnostic: Diagnostic) -> str:
    help_ = f" ({diagnostic.help})" if diagnostic.help else ""
    return f"{diagnostic.span} {diagnostic.element}: {diagnostic.message}{help_}"


def test_unknown_messages_of_types_and_of_nodes() -> None:
    found = unknown_message(
        architecture(
            mapped("Picture", "sensor_msgs/msg/Imgae", 1),
            mapped("Good picture", "sensor_msgs/msg/Image", 2),
            mapped("Switch it", "std_srvs/srv/SetBol", 3),
            mapped("Foreign", "demo_msgs/msg/Grasp", 4),
            nodes=(node("viewer", "vision_msgs/msg/Zebra", 5), node("inner", "nav_msgs/msg/Pose", 6, internal=True)),
        )
    )
    assert [brief(diagnostic) for diagnostic in found] == [
        (
            "a.yaml:1:20 Picture: no message `sensor_msgs/msg/Imgae` in `sensor_msgs`, as noetic has it "
            "(did you mean `sensor_msgs/msg/Image`?)"
        ),
        (
            "a.yaml:3:20 Switch it: no service `std_srvs/srv/SetBol` in `std_srvs`, as noetic has it "
            "(did you mean `std_srvs/srv/SetBool`?)"
        ),
        (
            "a.yaml:5:30 viewer: no message `vision_msgs/msg/Zebra` in `vision_msgs`, as noetic has it "
            "(if it is still to be defined, write `status: planned` at its type)"
        ),
        (
            "a.yaml:6:30 inner: no message `nav_msgs/msg/Pose` in `nav_msgs`, as noetic has it "
            "(did you mean `geometry_msgs/msg/Pose`?)"
        ),
    ]


@pytest.mark.parametrize(
    ("message", "expected"),
    [
        (
            "std_msgs/msg/Boool",
            "no message `std_msgs/msg/Boool` in `std_msgs`, as jazzy has it (did you mean `std_msgs/msg/Bool`?)",
        ),
        (
            "nav_msgs/msg/GetPlan",
            (
                "no message `nav_msgs/msg/GetPlan` in `nav_msgs`, as jazzy has it "
                "(`GetPlan` is a service: write `nav_msgs/srv/GetPlan`)"
            ),
        ),
        (
            "nav2_msgs/msg/NavigateToPoseAction",
            (
                "no message `nav2_msgs/msg/NavigateToPoseAction` in `nav2_msgs`, as jazzy has it "
                "(`NavigateToPose` is an action: write `nav2_msgs/action/NavigateToPose`)"
            ),
        ),
        (
            "nav_msg/msg/Odometry",
            (
                "no message `nav_msg/msg/Odometry`: archgen holds no package `nav_msg` for jazzy "
                "(did you mean `nav_msgs/msg/Odometry`?)"
            ),
        ),
        (
            "nav2_msgs/msg/Trajectory",
            "no message `nav2_msgs/msg/Trajectory` in `nav2_msgs`, as jazzy has it (it is in kilted, not in jazzy)",
        ),
    ],
)
def test_a_slip_is_unknown_in_ros_2_too(message: str, expected: str) -> None:
    one = architecture(mapped("Thing", message, 1), interfaces=load_interfaces("jazzy")[0])
    assert [brief(diagnostic) for diagnostic in unknown_message(one)] == [f"a.yaml:1:20 Thing: {expected}"]
    assert list(unchecked_message(one)) == []


def test_unknown_message_of_the_project() -> None:
    interfaces, _ = load_interfaces("jazzy", [("demo_msgs/msg/Grasp.msg", "float64 width")])
    found = unknown_message(architecture(mapped("Plan", "demo_msgs/action/Planning", 1), interfaces=interfaces))
    assert [brief(diagnostic) for diagnostic in found] == [
        (
            "a.yaml:1:20 Plan: no action `demo_msgs/action/Planning` in `demo_msgs`, which the project defines "
            "(add its definition, `demo_msgs/action/Planning.action`, to the others, or say its `request` and `response` at its type; if it is still to be defined, write "
            "`status: planned` at its type)"
        )
    ]


@pytest.mark.parametrize(
    ("distro", "message", "expected"),
    [
        (
            "jazzy",
            "demo_msgs/srv/Grasp",
            (
                "cannot tell whether the service `demo_msgs/srv/Grasp` exists: archgen holds no names of `demo_msgs` for jazzy "
                "(add its definition, for instance as `msgs/demo_msgs/srv/Grasp.srv` with "
                '`ros: {interfaces: ["msgs/**/*.srv"]}`)'
            ),
        ),
        (
            "jazzy",
            "mavros_msgs/msg/Altitud",
            (
                "cannot tell whether the message `mavros_msgs/msg/Altitud` exists: it is not among the names held of "
                "`mavros_msgs`, and newer ones may be missing there (did you mean `mavros_msgs/msg/Altitude`?)"
            ),
        ),
        (
            "jazzy",
            "snesr_msg/msg/Image",
            (
                "cannot tell whether the message `snesr_msg/msg/Image` exists: archgen holds no names of `snesr_msg` for "
                "jazzy (did you mean `sensor_msgs/msg/Image`?)"
            ),
        ),
        (
            "humble",
            "nav_msgs/msg/Trajectory",
            (
                "cannot tell whether the message `nav_msgs/msg/Trajectory` exists: it is in jazzy, kilted, lyrical and "
                "rolling, but not among the names held for humble (add its definition, for instance as "
                '`msgs/nav_msgs/msg/Trajectory.msg` with `ros: {interfaces: ["msgs/**/*.msg"]}`)'
            ),
        ),
        (
            "jazzy",
            "demo_msgs/msg/Image",
            (
                "cannot tell whether the message `demo_msgs/msg/Image` exists: archgen holds no names of `demo_msgs` for "
                "jazzy (add its definition, for instance as `msgs/demo_msgs/msg/Image.msg` with "
                '`ros: {interfaces: ["msgs/**/*.msg"]}`)'
            ),
        ),
        (
            None,
            "sensor_msgs/msg/Imgae",
            (
                "cannot tell whether the message `sensor_msgs/msg/Imgae` exists: the project names no distribution "
                "(`ros: {distro: jazzy}`) (did you mean `sensor_msgs/msg/Image`?)"
            ),
        ),
    ],
)
def test_unchecked_message_says_why_and_what_to_do(distro: str | None, message: str, expected: str) -> None:
    one = architecture(mapped("Thing", message, 1), interfaces=load_interfaces(distro)[0])
    assert [brief(diagnostic) for diagnostic in unchecked_message(one)] == [f"a.yaml:1:20 Thing: {expected}"]
    assert list(unknown_message(one)) == []


def test_known_messages_are_neither() -> None:
    one = architecture(mapped("Picture", "sensor_msgs/msg/Image", 1), nodes=(node("n", "std_msgs/msg/String", 2),))
    assert [*unknown_message(one), *unchecked_message(one)] == []


def test_planned_messages_are_neither_wherever_they_are_written() -> None:
    one = architecture(
        mapped("Grasp", "demo_msgs/msg/Grasp", 1, status="planned"),
        mapped("Plan", "nav_msgs/msg/Plan", 2, status="planned"),
        nodes=(node("n", "demo_msgs/msg/Grasp", 3), node("m", "nav_msgs/msg/Plan", 4)),
    )
    assert [*unknown_message(one), *unchecked_message(one)] == []


def test_each_place_is_reported_once_and_shipped_types_never() -> None:
    shipped = ConceptualType("Laser scan", "sensor_msgs/msg/Lser", origin="shipped")
    itself = ConceptualType("sensor_msgs/msg/Imgae", "sensor_msgs/msg/Imgae", origin="message")
    twice = replace(mapped("Picture", "sensor_msgs/msg/Imgae", 7), message_at=line(3, 9))
    one = architecture(shipped, itself, twice, outputs=(output("a", itself.name, 3), output("b", itself.name, 4)))
    assert [str(diagnostic.span) for diagnostic in unknown_message(one)] == ["a.yaml:3:9"]


def endpoint(
    node_: str, use: UseKind, message: str | None, number: int, place: Literal["message", "own", "node"]
) -> Endpoint:
    made = Endpoint(node_, use, "/camera", "topic", None, None, message)
    if place == "message":
        return replace(made, message_at=line(number, 30))
    return replace(made, at=line(number, 10)) if place == "own" else made


def topic(*endpoints: Endpoint) -> Topic:
    found = tuple(dict.fromkeys(e.message for e in endpoints if e.message))
    writers = tuple(e for e in endpoints if e.use == "publishes")
    return Topic("/camera", "topic", found, (), writers, tuple(e for e in endpoints if e.use == "subscribes"))


def test_a_topic_with_several_messages() -> None:
    one = architecture(
        topics=(
            topic(
                endpoint("viewer", "subscribes", "sensor_msgs/msg/CompressedImage", 2, "own"),
                endpoint("camera", "publishes", "sensor_msgs/msg/Image", 1, "message"),
                endpoint("recorder", "subscribes", "sensor_msgs/msg/Image", 3, "message"),
                endpoint("listener", "subscribes", None, 4, "own"),
                endpoint("odd", "subscribes", "sensor_msgs/msg/Imu", 5, "node"),
            ),
        ),
        nodes=(node("odd", "sensor_msgs/msg/Imu", 5),),
    )
    (found,) = topic_type_conflict(one)
    assert brief(found) == (
        "a.yaml:2:10 viewer: the topic `/camera` carries `sensor_msgs/msg/Image` and `sensor_msgs/msg/CompressedImage` and "
        "`sensor_msgs/msg/Imu` (give both nodes the same message, or one of them another topic: `camera` has "
        "`sensor_msgs/msg/Image`, `viewer` `sensor_msgs/msg/CompressedImage`)"
    )
    assert [(str(label.span), label.text) for label in found.labels] == [
        ("a.yaml:1:30", "`sensor_msgs/msg/Image` here, by the node `camera`"),
        ("a.yaml:5:1", "`sensor_msgs/msg/Imu` here, by the node `odd`"),
    ]


def test_a_topic_with_one_message_is_no_conflict() -> None:
    same = topic(
        endpoint("camera", "publishes", "sensor_msgs/msg/Image", 1, "message"),
        endpoint("viewer", "subscribes", "sensor_msgs/msg/Image", 2, "message"),
        endpoint("listener", "subscribes", None, 3, "own"),
    )
    assert list(topic_type_conflict(architecture(topics=(same,)))) == []


def test_rules_have_pages() -> None:
    rules = [Rule.from_function(*rule) for rule in RULES]
    assert {rule.name: rule.severity for rule in rules} == {
        "unknown-distro": Severity.ERROR,
        "other-ros-generation": Severity.WARNING,
        "unknown-message": Severity.ERROR,
        "unchecked-message": Severity.NOTE,
        "action-as-message": Severity.WARNING,
        "topic-type-conflict": Severity.ERROR,
    }
    for rule in rules:
        assert all(read_rule_page(rule))
