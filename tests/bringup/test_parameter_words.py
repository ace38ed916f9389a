"""The values that commands of a start-up give to nodes, as ROS 2 and ROS 1 read them."""

from __future__ import annotations

import shlex
from collections.abc import Callable
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.bringup.plan_shapes import RosLaunch, StartStep
from archgen.bringup.start_commands import list_loading_options, list_ros_2_options
from archgen.bringup.start_plan import make_start_plan, name_files
from archgen.model.architecture import Architecture

Derived = Callable[[str], Architecture]

NODES = """
groups:
  g:
    components:
      camera:
        title: Camera
        parameters: {rate: {type: float, value: 15}, gains: {type: "float[]", value: [1, 2.5]}, frame: map, unset: {type: string}}
      lidar: {title: Lidar, parameters: {rate: 10}}
      plain: P
nodes:
  camera:
    implements: camera
    package: p
    executable: camera
    namespace: front
    parameters: {rate: 30, filter: {size: 3, names: [a, "b c", "1"]}}
    parameter_files: [config/camera.yaml, config/more files.yaml]
  lidar: {implements: lidar, package: p, plugin: "p::Lidar", container: box, parameters: {on: "yes", text: "it's $HOME"}}
  plain: {implements: plain, package: p, executable: plain, parameter_commands: {robot_description: [xacro, urdf/my robot.xacro]}}
containers: {box: {parameters: {thread_num: 3, a: {b: true}}}}
"""


def find_steps(architecture: Architecture) -> dict[str, StartStep]:
    return {step.id: step for step in make_start_plan(architecture).steps}


def test_ros_2_reads_values_of_the_project_and_the_component_then_files_then_those_of_the_node(
    derived: Derived,
) -> None:
    steps = find_steps(derived(f"ros: {{distro: jazzy, parameters: {{use_sim_time: true}}}}\n{NODES}"))
    assert shlex.join(steps["camera"].command) == (
        "ros2 run p camera --ros-args -r __node:=camera -r __ns:=/front -p use_sim_time:=true -p rate:=15.0 "
        "-p 'gains:=[1.0, 2.5]' -p frame:=map --params-file config/camera.yaml --params-file 'config/more files.yaml' "
        '-p rate:=30.0 -p filter.size:=3 -p \'filter.names:=[a, "b c", "1"]\''
    )
    assert shlex.join(steps["lidar"].command) == (
        "ros2 component load /box p p::Lidar --node-name lidar -p use_sim_time:=true -p rate:=10 "
        "-p 'on:=\"yes\"' -p 'text:=\"it'\"'\"'s $HOME\"'"
    )
    assert steps["box"].command[4:] == ("--ros-args", "-r", "__node:=box", "-p", "thread_num:=3", "-p", "a.b:=true")
    assert steps["plain"].ros is not None
    assert steps["plain"].ros.value_commands == {"robot_description": ("xacro", "urdf/my robot.xacro")}
    assert steps["plain"].command[-2:] == ("-p", "use_sim_time:=true")


def test_ros_1_has_its_own_words_and_a_server_for_what_words_cannot_say(derived: Derived) -> None:
    steps = find_steps(derived(f"ros: {{distro: noetic, parameters: {{use_sim_time: true}}}}\n{NODES}"))
    camera = steps["camera"]
    assert [shlex.join(words) for words in camera.preparations] == [
        "rosparam set /use_sim_time true",
        "rosparam set /front/camera/rate 15.0",
        "rosparam set /front/camera/gains '[1.0, 2.5]'",
        "rosparam set /front/camera/frame map",
        "rosparam load config/camera.yaml /front/camera",
        "rosparam load 'config/more files.yaml' /front/camera",
        'rosparam set /front/camera/filter/names \'[a, "b c", "1"]\'',
    ]
    assert camera.command == (
        *("rosrun", "p", "camera", "__name:=camera", "__ns:=/front", "_rate:=30.0", "_filter/size:=3"),
    )
    nodelets = NODES.replace('plugin: "p::Lidar"', "kind: nodelet, plugin: p/Lidar")
    lidar = find_steps(derived(f"ros: {{distro: noetic}}\n{nodelets}"))
    assert [shlex.join(words) for words in lidar["lidar"].preparations] == [
        "rosparam set /lidar/on '\"yes\"'",
        "rosparam set /lidar/text '\"it'\"'\"'s $HOME\"'",
    ]
    assert lidar["lidar"].command[-1] == "_rate:=10"


@pytest.mark.parametrize(
    ("value", "word"),
    [
        (1.0, "1.0"),
        ("1.0", '"1.0"'),
        (1e20, "1.0e+20"),
        ("nan", '"nan"'),
        (float("nan"), ".nan"),
        ("-Infinity", '"-Infinity"'),
        (["inf", float("inf"), float("-inf"), 2e30, "x"], '["inf", .inf, -.inf, 2.0e+30, x]'),
        ("no", '"no"'),
        (True, "true"),
        ("true", '"true"'),
        ("", '""'),
        ("a:=b", '"a:=b"'),
        ("{a: 1}", '"{a: 1}"'),
        ("/dev/video0", "/dev/video0"),
        ([], "[]"),
        ("\u0085\u2028\n", '"\\u0085\\u2028\\n"'),
        ([{"a": 1}], "[{a: 1}]"),
        ([[1, 2], [3]], "[[1, 2], [3]]"),
    ],
)
def test_texts_stay_texts_and_numbers_numbers(value: object, word: str) -> None:
    launch = RosLaunch("a", own_values={"x": value})
    assert list(list_ros_2_options(launch)) == ["-p", f"x:={word}"]
    assert list(list_loading_options(launch)) == ["-p", f"x:={word}"]


def test_what_a_node_says_itself_counts_more_than_what_its_file_says_to_it(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(
        "groups: {g: {components: {a: A}}}\nnodes:\n  a: {implements: a, package: p, executable: a, "
        "parameters: {x: 2}, parameter_files: [a.yaml]}\n  b: {implements: a, package: p, plugin: P, container: c, "
        "parameter_files: [a.yaml]}\ncontainers: {c: {}}\n",
        encoding="utf-8",
    )
    (tmp_path / "a.yaml").write_text("/**:\n  ros__parameters: {x: 1, y: 3}\n", encoding="utf-8")
    steps = find_steps(pipeline.check_project(tmp_path).architecture)
    assert steps["a"].command[-4:] == ("--params-file", "a.yaml", "-p", "a:x:=2")
    assert steps["b"].command[-4:] == ("-p", "x:=1", "-p", "y:=3")


def test_files_about_steps_have_names_of_their_own() -> None:
    assert name_files(["a", "A", "container a", "container_a", "../x", "..", "-", "b" * 300, "b" * 301]) == {
        "a": "a",
        "A": "A_2",
        "container a": "container_a",
        "container_a": "container_a_2",
        "../x": "_x",
        "..": "step",
        "-": "step_2",
        "b" * 300: "b" * 100,
        "b" * 301: f"{'b' * 100}_2",
    }
