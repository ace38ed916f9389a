"""What runs: threads as written and not written, languages, memories."""

from __future__ import annotations

from dataclasses import replace

import pytest

from archgen.bringup.start_commands import describe_container_launch
from archgen.model.declared_timing import InputTiming
from archgen.model.node import Endpoint
from archgen.model.runtime_facts import (
    RCLCPP,
    RCLPY,
    TRANSFORM_MESSAGE,
    count_node_threads,
    find_container_threads,
    find_library,
    find_usual_order,
    keeps_each_source,
)
from archgen.timing.system.system_builder import build_system
from archgen.timing.system.thread_pools import name_lane
from tests.timing.random_systems import architecture


@pytest.mark.parametrize(
    ("distro", "written", "threads", "program", "told"),
    [
        ("jazzy", "", 1, "component_container", {}),
        ("jazzy", "threads: 1", 1, "component_container", {}),
        ("jazzy", "threads: 3", 3, "component_container_mt", {"thread_num": 3}),
        ("jazzy", "executable: component_container_mt", None, "component_container_mt", {}),
        ("jazzy", "threads: 2, executable: component_container_mt", 2, "component_container_mt", {"thread_num": 2}),
        ("jazzy", "executable: component_container_isolated", None, "component_container_isolated", {}),
        ("jazzy", "threads: 1, executable: component_container_isolated", None, "component_container_isolated", {}),
        ("jazzy", "package: own, executable: box", 1, "box", {}),
        ("jazzy", "threads: 2, package: own, executable: box", 2, "box", {}),
        ("noetic", "", None, "nodelet", {}),
    ],
)
def test_what_is_started_has_the_threads_that_are_judged(
    distro: str, written: str, threads: int | None, program: str, told: dict[str, int]
) -> None:
    robot = architecture(f"ros: {{distro: {distro}}}\ncontainers: {{box: {{{written}}}}}\n")
    container = robot.containers["box"]
    assert find_container_threads(robot, container) == threads
    launch = describe_container_launch(robot, container)
    assert (launch.executable, launch.own_values) == (program, told)


def test_another_middleware_has_a_thread_for_each_component() -> None:
    robot = architecture("project: {id: r, title: R, middleware: orocos}\ncontainers: {box: {}}\n")
    assert find_container_threads(robot, robot.containers["box"]) is None


def test_an_isolated_container_has_a_thread_for_each_node() -> None:
    robot = architecture("""
groups: {g: {components: {a: {outputs: {o: T}}, b: {outputs: {o: T}}, c: {outputs: {o: T}}}}}
containers: {box: {executable: component_container_isolated}}
nodes:
  two: {implements: [a, b], container: box, reentrant: true}
  one: {implements: c, container: box}
""")
    system = build_system(robot)[0]
    lanes = {name: name_lane(system, activity) for name, activity in system.activities.items()}
    assert lanes["two.a"] == lanes["two.b"] != lanes["one"]


def test_who_is_written_in_python_computes_in_one_thread_at_a_time() -> None:
    robot = architecture("nodes: {a: {language: python}, b: {language: cpp}, c: {}}")
    libraries = [
        find_library(nodes)
        for nodes in ([robot.nodes["a"]], [robot.nodes["b"]], [robot.nodes["c"]], [], [*robot.nodes.values()])
    ]
    assert libraries == [RCLPY, RCLCPP, RCLCPP, RCLCPP, RCLCPP]
    assert [count_node_threads(node) for node in robot.nodes.values()] == [1, 1, 1]


def test_whose_messages_an_input_keeps() -> None:
    topic = Endpoint("n", "subscribes", "/t", "topic", None, None, "std_msgs/msg/String")
    assert not keeps_each_source(topic, InputTiming())
    assert keeps_each_source(topic, InputTiming(memory="each_source"))
    assert keeps_each_source(replace(topic, message=TRANSFORM_MESSAGE), InputTiming())
    assert keeps_each_source(replace(topic, medium="orocos"), InputTiming())


@pytest.mark.parametrize(
    ("project", "order"),
    [
        ("ros: {distro: jazzy}", "ros2_executor"),
        ("ros: {distro: noetic}", "fifo"),
        ("project: {id: r, middleware: zenoh}", None),
    ],
)
def test_the_order_of_callbacks_is_that_of_the_middleware(project: str, order: str | None) -> None:
    assert find_usual_order(architecture(project)) == order
