"""Each row of the rules of remaps, for a node `n` in `/a`; real nodes hold them in test_names_of_running_nodes.py."""

from __future__ import annotations

import pytest

from archgen.derivation.wire.wire_names import NodeNames, apply_launch_names, find_rule_fault, read_remaps, read_rule
from archgen.diagnostics.source_span import NO_SPAN
from archgen.model.node import FlowKind, Node


def make_node(rules: str, distro: str, remaps: str = "", name: str = "n") -> Node:
    """Return a node with rules in its arguments, and others in `remaps`."""
    words = rules.split()
    arguments = words if distro == "noetic" else [word for rule in words for word in ("-r", rule)]
    pairs = dict(each.split(":=") for each in remaps.split())
    node = Node(name, "N", name=name, namespace="/a", arguments=("--ros-args", *arguments), remaps=pairs)
    return apply_launch_names(node, distro)


def resolve(rules: str, written: str, flow: FlowKind = "topic", distro: str = "jazzy", remaps: str = "") -> str | None:
    """Return what a written name is on the wire."""
    return NodeNames(make_node(rules, distro, remaps), distro).resolve(written, flow)


ROS_2_ROWS: list[tuple[str, dict[str, str]]] = [
    ("x:=y", {"x": "/a/y", "/a/x": "/a/y"}),
    ("/a/x:=/q", {"x": "/q"}),
    ("/x:=/q", {"x": "/a/x", "/x": "/q"}),
    ("~/x:=/q", {"~/x": "/q", "n/x": "/q", "/a/n/x": "/q"}),
    ("x:=g n:x:=s", {"x": "/a/g"}),
    ("n:x:=s x:=g", {"x": "/a/s"}),
    ("m:x:=s", {"x": "/a/x"}),
    ("a:=b b:=c", {"a": "/a/b", "b": "/a/c"}),
    ("a:=b b:=a", {"a": "/a/b", "b": "/a/a"}),
    ("x:=x x:=z", {"x": "/a/x"}),
    ("a:=c b:=c", {"a": "/a/c", "b": "/a/c"}),
    ("__node:=new ~/x:=/q", {"~/x": "/q", "n/x": "/a/n/x"}),
    ("m:__ns:=/b __node:=new", {"x": "/a/x"}),
    ("new:__ns:=/b __node:=new", {"x": "/b/x"}),
    ("__ns:=/b __name:=new new:x:=y", {"x": "/b/y", "~/x": "/b/new/x"}),
    ("__node:=one __name:=two", {"~": "/a/one"}),
    ("cam:=eye", {"cam/image": "/a/cam/image"}),
    ("/tf:=tf", {"/tf": "/a/tf"}),
    ("/rosout:=/l", {"/rosout": "/l"}),
    ("rosout:=/l", {"/rosout": "/rosout"}),
]
"""Rules, and what names become by them; test_names_of_running_nodes.py asks real nodes."""


@pytest.mark.parametrize(("rules", "names"), ROS_2_ROWS)
def test_rules_of_ros_2(rules: str, names: dict[str, str]) -> None:
    assert {written: resolve(rules, written) for written in names} == names


@pytest.mark.parametrize(
    ("rules", "topic", "service"),
    [("rosservice://x:=y", "/a/x", "/a/y"), ("rostopic://x:=y", "/a/y", "/a/x"), ("x:=y", "/a/y", "/a/y")],
)
def test_rules_for_topics_or_services_alone(rules: str, topic: str, service: str) -> None:
    assert (resolve(rules, "x"), resolve(rules, "x", "service")) == (topic, service)


PARTS = "send_goal cancel_goal get_result feedback status"
FIVE = " ".join(f"act/_action/{part}:=go/_action/{part}" for part in PARTS.split())
FIVE_IN_ROS_1 = " ".join(f"act/{part}:=go/{part}" for part in ("goal", "cancel", "status", "feedback", "result"))


@pytest.mark.parametrize(
    ("rules", "distro", "name"),
    [
        ("act:=go", "humble", "/a/act"),
        ("act:=go", "jazzy", "/a/act"),
        ("act:=go", "kilted", "/a/go"),
        ("act:=go", "rolling", "/a/go"),
        (FIVE, "jazzy", "/a/go"),
        (FIVE, "kilted", "/a/go"),
        (FIVE.rpartition(" ")[0], "jazzy", "/a/act"),
        (FIVE_IN_ROS_1, "noetic", "/a/go"),
        ("act:=go", "noetic", "/a/act"),
    ],
)
def test_an_action_moves_with_its_five_parts_and_alone_from_kilted_on(rules: str, distro: str, name: str) -> None:
    assert resolve(rules, "act", "action", distro) == name


@pytest.mark.parametrize(
    ("rules", "names"),
    [
        ("x:=a x:=b", {"x": "/a/b"}),
        ("x:=a /a/x:=b", {"x": None}),
        ("x:=a /a/x:=a", {"x": "/a/a"}),
        ("a:=b b:=c", {"a": "/a/b", "b": "/a/c"}),
        ("__ns:=b", {"x": "/b/x"}),
        ("__ns:=/b/", {"x": "/b/x"}),
        ("~x:=y", {"~x": "/a/y", "n/x": "/a/y"}),
        ("x/:=a//b", {"x": "/a/a/b"}),
    ],
)
def test_rules_of_ros_1(rules: str, names: dict[str, str | None]) -> None:
    assert {written: resolve(rules, written, distro="noetic") for written in names} == names


def test_arguments_come_before_remaps_in_ros_2_and_behind_them_in_ros_1() -> None:
    assert resolve("x:=a", "x", remaps="x:=b") == "/a/a"
    assert resolve("x:=a", "x", distro="noetic", remaps="x:=b") == "/a/b"
    assert resolve("", "x", remaps="/a/x:=/b") == "/b"


def test_the_rule_of_a_port_comes_behind_arguments_and_before_remaps() -> None:
    names = NodeNames(make_node("x:=argued", "jazzy", "y:=mapped x:=mapped"), "jazzy")
    assert names.name_end("/topic", "x", "topic")[:2] == ("/a/x", "/a/argued")
    assert names.name_end("/topic", "y", "topic")[:2] == ("/a/y", "/topic")
    assert names.name_end(None, "y", "topic")[:2] == ("/a/y", "/a/mapped")
    assert names.name_end("/topic", "z", "topic").evidence["name"].rule == "z:=/topic"
    assert names.name_end("/topic", None, "topic").evidence == {}


def test_seen_names_are_those_after_all_rules() -> None:
    node = Node("n", "N", name="n", namespace="/a", remaps={"x": "/y", "/y": "/x"}, observed=True)
    wire = NodeNames(node, "jazzy").name_end("/y", None, "topic")
    assert (wire.program_name, wire.name, wire.evidence["name"].kind) == (None, "/y", "observed")


REFUSED_IN_ROS_2 = [
    ("{node}:=y", "a rule takes no `{...}`"),
    ("x:={node}", "a rule takes no `{...}`"),
    ("~x:=y", "`~` is followed by `/`"),
    ("/a/n:x:=y", "it holds `:`, and only letters (a to z), digits and `_` are allowed"),
    ("x=y", "a rule has the form `from:=to`"),
    ("x:=1b", "`1b` begins with a digit"),
    ("x:=a//b", "two `/` follow one another"),
    ("x:=b/", "it ends with `/`"),
    ("x:=a__b", "in a rule, no two `_` follow one another"),
    ("x:=", "it is empty"),
    ("*:=y", "ROS has no wildcards there yet"),
    ("**/x:=y", "ROS has no wildcards there yet"),
    ("__ns:=b", "a namespace begins with `/`"),
    ("__ns:=", "it is empty"),
    ("__ns:=/b/", "it ends with `/`"),
    ("__node:=a/b", "it holds `/`: what stands before the name belongs into `namespace`"),
]


@pytest.mark.parametrize(("rule", "fault"), REFUSED_IN_ROS_2)
def test_rules_that_ros_2_refuses(rule: str, fault: str) -> None:
    assert read_rule(rule, NO_SPAN, is_argument=True, ros_1=False) is None
    assert find_rule_fault(rule, ros_1=False) == fault


def test_a_rule_with_a_blank_around_its_joint_is_refused() -> None:
    assert read_rule("x := y", NO_SPAN, is_argument=True, ros_1=False) is None


@pytest.mark.parametrize("rule", ["x:=1b", "n:x:=y", "x:=a-b"])
def test_rules_that_roscpp_refuses(rule: str) -> None:
    assert read_rule(rule, NO_SPAN, is_argument=True, ros_1=True) is None
    assert find_rule_fault(rule, ros_1=True)


def test_what_a_launch_fills_in_is_not_known() -> None:
    node = Node("n", "N", name="n", remaps={"x": "$(var side)/x"})
    ((_, _, rule),) = read_remaps(node, ros_1=False)
    assert rule is not None
    assert rule.name is None
    assert NodeNames(node, "jazzy").resolve("x", "topic") is None


def test_hostile_rules_end_quickly() -> None:
    rules = {f"{'a/' * 100}x{i}": "y" * 5000 for i in range(3000)}
    assert NodeNames(Node("n", "N", name="n", remaps=rules), "jazzy").resolve("x", "topic") == "/x"
