"""How many threads a container has where it says so, and where it does not: what its program has."""

from __future__ import annotations

import pytest

from archgen.bringup.start_commands import describe_container_launch
from archgen.model.process_threads import find_container_threads
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
