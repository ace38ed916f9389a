"""What nodes of one generated program are called in launch files and in code is the answer that the plan of the start-up has."""

from __future__ import annotations

from pathlib import Path

from archgen.plugins.ros_code.launch_view import make_view as make_launch_view
from archgen.plugins.ros_code.node_programs import make_view as make_programs
from archgen.views.generation.generation_context import GenerationContext
from tests.bringup.test_program_names import EXPECTED, read
from tests.plugins.ros_code.test_ros2_cpp import write_project


def test_all_who_ask_get_one_answer(tmp_path: Path) -> None:
    architecture = read(tmp_path)
    launch = make_launch_view(GenerationContext(architecture), 2).data
    entries = [block["entry"] for host in launch["hosts"] for phase in host["phases"] for block in phase["blocks"]]
    assert {each["step"]: list_names(each) for each in entries if each["step"] in EXPECTED} == EXPECTED
    (motor,) = [
        each for each in make_programs(GenerationContext(architecture)).data["programs"] if each["module"] == "motor"
    ]
    assert {each["id"]: list_names(each) for each in motor["nodes"]} == EXPECTED
    assert [port["topic"] for port in (*motor["subscriptions"], *motor["publishers"])] == ["target", "state"]


def list_names(record: dict[str, list[dict[str, str]]]) -> dict[str, str]:
    return {each["own_name"]: each["name"] for each in record["remaps"]}


def test_a_program_is_the_same_where_only_some_of_its_nodes_are_asked_for(tmp_path: Path) -> None:
    architecture = read(tmp_path)
    whole, part = (
        next(each for each in make_programs(context).data["programs"] if each["module"] == "motor")
        for context in (GenerationContext(architecture), GenerationContext(architecture, host="two"))
    )
    # Its nodes, too: their values stand in one file of the package.
    assert [each["id"] for each in part["nodes"]] == ["l", "r"]
    assert whole == part


def test_a_port_keeps_its_name_where_another_one_is_refused(tmp_path: Path) -> None:
    """Launch files and scripts remap what the program says, also while a message beside it is left out."""
    text = """\
archgen: 1
project: {id: rt}
ros: {distro: jazzy}
types: {Good: {fields: {x: float64}}, Bad: {fields: {class: float64}}}
groups: {g: {components: {a: {outputs: {pose: Good}}, b: {outputs: {pose: Bad}}}}}
nodes: {n: {implements: [a, b]}}
"""
    context = GenerationContext(write_project(tmp_path, text).architecture)
    (program,) = make_programs(context).data["programs"]
    assert [port["topic"] for port in program["publishers"]] == ["a_pose"]
    (host,) = make_launch_view(context, 2).data["hosts"]
    (entry,) = [block["entry"] for phase in host["phases"] for block in phase["blocks"]]
    assert "a_pose" in list_names(entry)
