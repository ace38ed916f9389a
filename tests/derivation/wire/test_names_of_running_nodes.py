"""Names and remaps as real ones of ROS 2 and rospy's resolver have them, on random nodes and rules: archgen says the same."""

from __future__ import annotations

import json
import random
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest

from archgen.bringup.program_names import (
    ProgramNames,
    choose_own_names,
    group_by_program,
    group_endpoints,
    index_endpoints,
)
from archgen.derivation.wire.wire_names import NodeNames, apply_launch_names, read_arguments
from archgen.model.architecture import Architecture
from archgen.model.node import Node
from tests.derivation.wire.test_remap_rules import REFUSED_IN_ROS_2, ROS_2_ROWS
from tests.derivation.wire.test_wire_names import MOVED_BY_ARGUMENTS, SHARED_PROGRAM, SWAP
from tests.outside_tools import run_judge
from tests.ros_1_environment import SYSTEM_PYTHON, require_ros_1, ros_1_environment
from tests.ros_2_kilted import kilted_environment, make_kilted_python
from tests.ros_environment import make_ros_python, ros_environment

DRAWS = 400
_ROS_2_NAMES = """
import json
import sys

import rclpy
from rclpy.context import Context


def ask(case):
    context = Context()
    try:
        rclpy.init(args=case["words"], context=context)
    except Exception as error:
        return {"refused": type(error).__name__}
    try:
        node = rclpy.create_node(case["name"], namespace=case["namespace"], context=context)
    except Exception as error:
        rclpy.shutdown(context=context)
        return {"refused": type(error).__name__}
    names = {}
    for written in case["written"]:
        for kind, resolve in (("topic", node.resolve_topic_name), ("service", node.resolve_service_name)):
            try:
                names[f"{kind} {written}"] = resolve(written)
            except Exception:
                names[f"{kind} {written}"] = None
    answer = {"node": node.get_fully_qualified_name(), "names": names}
    node.destroy_node()
    rclpy.shutdown(context=context)
    return answer


for line in sys.stdin:
    print(json.dumps(ask(json.loads(line))), flush=True)
"""
_ROSPY_NAMES = """
import json
import sys

import rospy.names
from rosgraph.names import get_ros_namespace


def ask(case):
    rospy.names.reload_mappings(case["words"])
    mappings = rospy.names.get_mappings()
    namespace = get_ros_namespace(env={"ROS_NAMESPACE": case["namespace"]}, argv=case["words"])
    caller = namespace + mappings.get("__name", case["name"])
    rospy.names.initialize_mappings(caller)
    return {"node": caller, "names": {name: rospy.names.resolve_name(name, caller) for name in case["written"]}}


for line in sys.stdin:
    print(json.dumps(ask(json.loads(line))), flush=True)
"""
_PIECES = ("x", "/x", "~/x", "a/x", "/a/x", "n/x", "/a/n/x", "y", "/y", "~/y", "/a/y", "q", "/q", "m/x", "~", "X")
_ODD_PIECES = (
    *(
        "{node}/x",
        "{ns}/x",
        "{namespace}/x",
        "x/{ns}",
        "{foo}/x",
        "~x",
        "a//b",
        "x/",
        "1a",
        "a-b",
        "a b",
        "a__b",
        "_x",
        "x_",
    ),
    *("", "/", "/{node}/x", "/{ns}/x", "{node}{node}", "a{ns}", "{ns}{node}", "x~", "~~/x", "*", "/*/x", "x/**"),
)
_PREFIXES = ("", "", "", "", "n:", "m:", "new:", "rosservice://", "rostopic://", "n:rostopic://", "/a/n:", "n:m:")
_NODE_RULES = (
    *("__node:=new", "__name:=m", "__ns:=/b", "__ns:=/", "__ns:=/a/c", "n:__node:=new", "m:__ns:=/b", "new:__ns:=/c"),
    *("__ns:=b", "__ns:=", "__node:=a-b", "__node:=a/b", "m:__node:=q", "__node:="),
)


def draw_cases(draw: random.Random, count: int) -> list[dict[str, Any]]:
    """Draw nodes with rules, most of them such that ROS takes; one name in the written ones is of any kind."""
    cases = []
    for _ in range(count):
        odd_share = draw.choice((0, 0, 0, 0.15))
        words = ["node", "--ros-args"]
        for _ in range(draw.randint(0, 4)):
            if draw.random() < 0.25:
                rule = draw.choice(_NODE_RULES[:8] if draw.random() >= odd_share else _NODE_RULES)
            else:
                sides = [draw.choice(_ODD_PIECES if draw.random() < odd_share else _PIECES) for _ in range(2)]
                prefix = draw.choice(_PREFIXES if draw.random() < odd_share else _PREFIXES[:10])
                rule = f"{prefix}{sides[0]}:={sides[1]}"
            words += [draw.choice(("-r", "--remap")), rule] if draw.random() > odd_share / 4 else [rule]
        if draw.random() < 0.2:
            words.insert(1, f"{draw.choice(_PIECES)}:={draw.choice(_PIECES)}")
        written = [*draw.sample(_PIECES, 6), *draw.sample(_ODD_PIECES, 4)]
        cases.append({"name": "n", "namespace": draw.choice(("/", "/a", "/a/b")), "words": words, "written": written})
    return cases


def answer_case(case: dict[str, Any], distro: str) -> dict[str, Any]:
    """Return what archgen says of a case, as the programs above do."""
    ros_1 = distro == "noetic"
    node = Node("n", "N", name=case["name"], namespace=case["namespace"], arguments=tuple(case["words"][1:]))
    if not ros_1 and any(rule is None for _, _, rule in read_arguments(node, ros_1=False)):
        return {"refused": True}
    node = apply_launch_names(node, distro)
    names = NodeNames(node, distro)
    if ros_1:
        return {"node": node.full_name, "names": {each: names.resolve(each, "topic") for each in case["written"]}}
    kinds: tuple[Any, ...] = ("topic", "service")
    resolved = {f"{kind} {each}": names.resolve(each, kind) for each in case["written"] for kind in kinds}
    return {"node": node.full_name, "names": resolved}


def ask_ros(
    program: str, python: Path | str, environment: dict[str, str], cases: Sequence[dict[str, Any]]
) -> list[Any]:
    """Return what ROS says of cases."""
    asked = "".join(f"{json.dumps(case)}\n" for case in cases)
    done = run_judge(str(python), "-c", program, env=environment, stdin=asked)
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


def find_differences(cases: Sequence[dict[str, Any]], answers: Sequence[Any], distro: str) -> list[str]:
    """Return the cases in which archgen says something else than ROS."""
    assert len(answers) == len(cases)
    differences = []
    for case, answer in zip(cases, answers, strict=True):
        said = answer_case(case, distro)
        if "refused" in answer or "refused" in said:
            if ("refused" in answer) != ("refused" in said):
                differences.append(f"{case['namespace']} {case['words']}: ROS {answer}, archgen {said}")
            continue
        if said["node"] != answer["node"]:
            differences.append(f"{case['namespace']} {case['words']}: ROS {answer['node']}, archgen {said['node']}")
        differences += [
            f"{case['namespace']} {case['words']} {name}: ROS {found}, archgen {said['names'][name]}"
            for name, found in answer["names"].items()
            if said["names"][name] != found
        ]
    return differences


@pytest.mark.ros
@pytest.mark.parametrize("distro", ["jazzy", "kilted"])
def test_real_nodes_of_ros_2_have_these_names(tmp_path: Path, distro: str) -> None:
    cases = draw_cases(random.Random(28), DRAWS)  # noqa: S311 - the same nodes each time
    if distro == "jazzy":
        python, environment = make_ros_python(), ros_environment(17, tmp_path)
    else:
        python = make_kilted_python()
        environment = kilted_environment(19, tmp_path, tmp_path, tmp_path)
    answers = ask_ros(_ROS_2_NAMES, python, environment, cases)
    assert find_differences(cases, answers, distro) == []
    assert sum("refused" in each for each in answers) in range(DRAWS // 50, DRAWS // 2)


@pytest.mark.ros
def test_real_nodes_agree_with_each_row_of_the_rules(tmp_path: Path) -> None:
    cases = [
        {"name": "n", "namespace": "/a", "words": ["n", *_write_words(rules)], "written": list(names)}
        for rules, names in ROS_2_ROWS
    ]
    refused = [rule for rule, _ in REFUSED_IN_ROS_2]
    cases += [{"name": "n", "namespace": "/a", "words": ["n", *_write_words(rule)], "written": []} for rule in refused]
    answers = ask_ros(_ROS_2_NAMES, make_ros_python(), ros_environment(25, tmp_path), cases)
    expected = [{f"topic {written}": name for written, name in names.items()} for _, names in ROS_2_ROWS]
    found = [
        {name: made for name, made in each["names"].items() if name.startswith("topic")}
        for each in answers[: len(ROS_2_ROWS)]
    ]
    assert found == expected
    assert [rule for rule, each in zip(refused, answers[len(ROS_2_ROWS) :], strict=True) if "refused" not in each] == []


def _write_words(rules: str) -> list[str]:
    return ["--ros-args", *(word for rule in rules.split(" ") for word in ("-r", rule))]


@pytest.mark.ros
def test_trap_1_generated_code_and_launch_files_give_the_names_of_the_record(
    derived: Callable[[str], Architecture], tmp_path: Path
) -> None:
    """What generated code says, with the rules that launch files give it, is on a real node what the endpoint is called."""
    cases, expected = [], []
    for text in (SHARED_PROGRAM, SWAP, MOVED_BY_ARGUMENTS):
        architecture = derived(text)
        program_names, endpoints = ProgramNames(architecture, 2), index_endpoints(architecture)
        for nodes in group_by_program(architecture, architecture.nodes.values()).values():
            groups = group_endpoints(nodes, endpoints)
            for place, said in choose_own_names(architecture, groups).items():
                for end in groups[place]:
                    node = architecture.nodes[end.node]
                    rules = [f"{own}:={name}" for own, name in program_names.find_remaps(node).items()]
                    words = [*node.arguments, *_write_words(" ".join(rules))] if rules else [*node.arguments]
                    names = {"name": node.name, "namespace": node.namespace}
                    cases.append({**names, "words": ["n", *words], "written": [said]})
                    expected.append(end.name)
    answers = ask_ros(_ROS_2_NAMES, make_ros_python(), ros_environment(27, tmp_path), cases)
    assert [each["names"][f"topic {case['written'][0]}"] for each, case in zip(answers, cases, strict=True)] == expected
    assert len(expected) >= 9


@pytest.mark.ros
@pytest.mark.parametrize(("distro", "name"), [("jazzy", "/a/act"), ("kilted", "/a/go")])
def test_a_new_name_for_an_action_alone_moves_it_from_kilted_on(tmp_path: Path, distro: str, name: str) -> None:
    """The name of the service that sends goals, as the graph has it."""
    if distro == "jazzy":
        python, environment = make_ros_python(), ros_environment(21, tmp_path)
    else:
        python = make_kilted_python()
        environment = kilted_environment(23, tmp_path, tmp_path, tmp_path)
    action = _ACTION.replace("IMPORTED", "test_msgs.action").replace("MESSAGE", "Fibonacci")
    done = run_judge(str(python), "-c", action, env=environment)
    assert f"{name}/_action/send_goal" in done.stdout.split()
    node = Node("n", "N", name="n", namespace="/a", remaps={"act": "go"})
    assert NodeNames(node, distro).resolve("act", "action") == name


_ACTION = """
import rclpy
from rclpy.action import ActionServer
from rclpy.context import Context
from IMPORTED import MESSAGE

context = Context()
rclpy.init(args=["n", "--ros-args", "-r", "act:=go"], context=context)
node = rclpy.create_node("n", namespace="/a", context=context)
server = ActionServer(node, MESSAGE, "act", lambda goal: None)
print(*[name for name, _ in node.get_service_names_and_types_by_node("n", "/a")])
"""


@pytest.mark.ros
def test_rospy_gives_these_names(tmp_path: Path) -> None:
    require_ros_1()
    draw = random.Random(28)  # noqa: S311 - the same rules each time
    sides = [each for each in _PIECES if not each.startswith("~/")] + ["~x", "x/", "a//b", "~y"]
    cases = []
    for _ in range(DRAWS * 5):
        rules = [f"{draw.choice(sides)}:={draw.choice(sides)}" for _ in range(draw.randint(0, 4))]
        if draw.random() < 0.2:
            rules.append(draw.choice(("__ns:=/b", "__ns:=b", "_rate:=5")))
        written = [each for each in draw.sample(sides, 8) if each != "~"]
        cases.append(
            {"name": "n", "namespace": draw.choice(("/", "/a", "/a/b")), "words": ["n", *rules], "written": written}
        )
    answers = ask_ros(_ROSPY_NAMES, SYSTEM_PYTHON, ros_1_environment(tmp_path, tmp_path, 11311), cases)
    differences = []
    for case, answer in zip(cases, answers, strict=True):
        said = answer_case(case, "noetic")
        assert said["node"] == answer["node"]
        # Where rospy and roscpp take different rules, archgen says of neither that it is right.
        differences += [
            (case["words"], name, found, said["names"][name])
            for name, found in answer["names"].items()
            if said["names"][name] not in {found, None}
        ]
        unknown = [name for name in case["written"] if said["names"][name] is None]
        assert not unknown or len(case["words"]) > 2, (case, unknown)
    assert differences == []
