"""Domain, clock and run state of each end: one test for each source of them, and what is not known stays unknown."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from archgen.derivation.derived_parts import DerivedParts
from archgen.derivation.low_level import derive_low_level
from archgen.derivation.wire.running_state import domain_of, find_environment, read_domain
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint

Derived = Callable[[str], Architecture]

ROBOT = """\
groups: {g: {components: {a: {outputs: {o: std_msgs/msg/Bool, s: std_srvs/srv/Trigger}}, b: {inputs: {i: a}}}}}
nodes:
  a: {implements: a, %s}
  b: b
"""


def ends_of(architecture: Architecture, node: str = "a") -> dict[str, Endpoint]:
    return {each.use: each for each in architecture.endpoints if each.node == node}


def tell(endpoint: Endpoint, field: str) -> str:
    """Give a field with what says so, as `value <- kind rule line:column`."""
    found = endpoint.evidence.get(field)
    source = f" <- {found.kind} {found.rule} {found.at.line}:{found.at.column}" if found else ""
    return f"{getattr(endpoint, field)}{source}"


@pytest.mark.parametrize(
    ("text", "domain"),
    [
        ("", 0),
        ("0", 0),
        ("42", 42),
        (" 42 ", 42),
        ("+7", 7),
        ("1.5", 1),
        ("42abc", 42),
        ("-1", 0),
        ("-2", 2**64 - 2),
        ("010", 8),
        ("0x1F", 31),
        ("08", None),
        ("0.5", None),
        ("0x", None),
        (" ", None),
        ("abc", None),
        ("9" * 5000, None),
        (str(2**64), None),
    ],
)
def test_a_domain_is_read_as_c_reads_numbers(text: str, domain: int | None) -> None:
    assert read_domain(text) == domain


def test_the_domain_of_the_node_its_host_and_the_project(derived: Derived) -> None:
    architecture = derived(
        ROBOT % "start: {environment: {ROS_DOMAIN_ID: 3}}"
        + "  c: {subscribes: {i: {topic: /x, message: std_msgs/msg/Bool}}, host: pc}\n"
        + "hosts: {pc: {environment: {ROS_DOMAIN_ID: 2, A: b}}}\nros: {environment: {ROS_DOMAIN_ID: 1}}"
    )
    assert [
        tell(ends_of(architecture, node)[use], "domain")
        for node, use in (("a", "publishes"), ("b", "subscribes"), ("c", "subscribes"))
    ] == [
        "3 <- written ROS_DOMAIN_ID=3 3:59",
        "1 <- written ROS_DOMAIN_ID=1 7:36",
        "2 <- written ROS_DOMAIN_ID=2 6:43",
    ]
    variables = find_environment(architecture, architecture.nodes["c"])
    assert {name: text for name, (text, _) in variables.items()} == {"ROS_DOMAIN_ID": "2", "A": "b"}


@pytest.mark.parametrize(
    ("start", "told", "compared"),
    [
        ('{environment: {ROS_DOMAIN_ID: ""}}', "0 <- written ROS_DOMAIN_ID= 3:59", 0),
        ('{environment: {ROS_DOMAIN_ID: "$(var d)"}}', "None <- unknown ROS_DOMAIN_ID=$(var d) 3:59", None),
        ("{environment: {ROS_DOMAIN_ID: abc}}", "None <- unknown ROS_DOMAIN_ID=abc 3:59", None),
        ("{phase: core}", "None", 0),
    ],
)
def test_an_unknown_domain_is_no_usual_one(derived: Derived, start: str, told: str, compared: int | None) -> None:
    endpoint = ends_of(derived(ROBOT % f"start: {start}"))["publishes"]
    assert (tell(endpoint, "domain"), domain_of(endpoint)) == (told, compared)


def test_a_container_that_was_imported(derived: Derived) -> None:
    text = ROBOT % "kind: composable, container: box, start: {environment: {ROS_DOMAIN_ID: 1}}" + (
        'containers: {box: {hints: {launch: {environment: {ROS_DOMAIN_ID: "2"}, by_default: "off"}}}}'
    )
    endpoint = ends_of(derived(text))["publishes"]
    assert tell(endpoint, "domain") == "2 <- written ROS_DOMAIN_ID=2 5:51"
    assert tell(endpoint, "runs") == "off <- written by_default: off 5:72"


def test_ros_1_has_no_domain_and_one_clock_for_all(derived: Derived) -> None:
    architecture = derived(
        ROBOT % "start: {environment: {ROS_DOMAIN_ID: 3}}, parameters: {use_sim_time: true}" + "ros: {distro: noetic}"
    )
    assert {(each.domain, each.clock, "domain" in each.evidence) for each in architecture.endpoints} == {
        (None, "simulated", False)
    }


@pytest.mark.parametrize(
    ("node", "more", "told"),
    [
        ("status: adapted", "", "system"),
        ("parameters: {use_sim_time: true}", "", "simulated <- written use_sim_time: true 3:49"),
        ("status: adapted", "ros: {parameters: {use_sim_time: true}}", "simulated <- written use_sim_time: true 5:34"),
        (
            "parameters: {use_sim_time: false}",
            "ros: {parameters: {use_sim_time: true}}",
            "system <- written use_sim_time: false 3:49",
        ),
        ('parameters: {use_sim_time: "$(var sim)"}', "", "None <- unknown use_sim_time: $(var sim) 3:49"),
        ("parameter_commands: {use_sim_time: [date]}", "", "None <- unknown use_sim_time 3:43"),
        (
            'arguments: ["--ros-args", -p, "a:use_sim_time:=True", -p, "x:=1"]',
            "",
            "simulated <- written -p use_sim_time:=true 3:52",
        ),
        (
            'arguments: ["--ros-args", "--param", "use_sim_time:=maybe"]',
            "",
            "None <- unknown -p use_sim_time:=maybe 3:59",
        ),
        ('arguments: [-p, "use_sim_time:=true"]', "", "system"),
        ("kind: program, command: [x], parameters: {use_sim_time: true}", "", "system"),
    ],
)
def test_the_clock(derived: Derived, node: str, more: str, told: str) -> None:
    assert tell(ends_of(derived(ROBOT % node + more))["publishes"], "clock") == told


def test_a_component_says_the_clock(derived: Derived) -> None:
    text = ROBOT.replace("a: {outputs", "a: {parameters: {use_sim_time: true}, outputs") % "status: adapted"
    assert tell(ends_of(derived(text))["publishes"], "clock") == "simulated <- written use_sim_time: true 1:58"


MANAGER = "  m: {package: nav2_lifecycle_manager, executable: lifecycle_manager, namespace: /n, parameters: {%s}}\n"


@pytest.mark.parametrize(
    ("node", "more", "publishes", "serves"),
    [
        ("status: existing", "", "active", "active"),
        ("status: planned", "", "planned", "planned"),
        ('hints: {launch: {by_default: "off"}}', "", "off", "off"),
        ("kind: lifecycle", "", "None", "None"),
        ("kind: lifecycle, start: {state: active}", "", "active", "active"),
        ("kind: lifecycle, start: {by: b}", "", "active", "active"),
        ("kind: lifecycle, start: {state: inactive}", "", "inactive", "active"),
        ("kind: lifecycle, start: {state: unconfigured}", "", "inactive", "inactive"),
        ("kind: lifecycle, status: existing, start: {state: inactive}", "", "inactive", "active"),
        ("kind: lifecycle, status: existing, start: {state: unconfigured}", "", "inactive", "None"),
        ("kind: lifecycle, status: existing, language: python, start: {state: inactive}", "", "None", "active"),
        ("kind: lifecycle", MANAGER % "node_names: [/a], autostart: true", "active", "active"),
        ("kind: lifecycle, namespace: /n", MANAGER % "node_names: [a], autostart: true", "active", "active"),
        ("kind: lifecycle, namespace: /n", MANAGER % "node_names: [a]", "None", "None"),
        ("kind: lifecycle, namespace: /n", MANAGER % "node_names: [b], autostart: true", "None", "None"),
    ],
)
def test_whether_it_runs(derived: Derived, node: str, more: str, publishes: str, serves: str) -> None:
    found = ends_of(derived(ROBOT % node + more))
    assert (str(found["publishes"].runs), str(found["serves"].runs)) == (publishes, serves)
    assert [(end.runs != "active") == ("runs" in end.evidence) for end in found.values()] == [True, True]


def test_a_node_that_nobody_wrote_is_planned(derived: Derived) -> None:
    endpoint = ends_of(derived("groups: {g: {components: {a: {outputs: {o: std_msgs/msg/Bool}}}}}"))["publishes"]
    assert tell(endpoint, "runs") == "planned <- generated status: planned 0:0"


def test_ends_are_kept_from_version_to_version_while_their_state_is_the_same(derived: Derived) -> None:
    text = ROBOT % "parameters: {use_sim_time: true}"
    memory = DerivedParts()
    linked = replace(derived(text), endpoints=(), topics={})
    first, second = (derive_low_level(linked, memory) for _ in range(2))
    assert all(old is new for old, new in zip(first.endpoints, second.endpoints, strict=True))
    moved = replace(linked, ros_environment=derived(text + "ros: {environment: {ROS_DOMAIN_ID: 5}}").ros_environment)
    assert {each.domain for each in derive_low_level(moved, memory).endpoints} == {5}
