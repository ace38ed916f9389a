"""The backend `ros2_cpp`: what it writes compiles, and is formatted as ament wants it."""

from __future__ import annotations

import dataclasses
import sys
from pathlib import Path

import pytest

from archgen.pipeline import CheckedProject, check_project
from tests.outside_tools import find_tool, run_judge
from tests.plugins.ros_code.cpp_compiler import compile_package
from tests.plugins.ros_code.test_ros2_cpp import ROBOT, generate, write_project
from tests.plugins.ros_code.test_ros2_lifecycle import PROJECT
from tests.ros_environment import NEWEST_PYTHON, ROS_FOLDER, make_ros_python
from tests.running import ROOT

# What ament_cpplint of Jazzy has in its configuration; guards and licences it looks at in its own way.
AMENT_CPPLINT = (
    "-build/c++11,-runtime/references,-whitespace/braces,-whitespace/indent,-whitespace/parens,-whitespace/semicolon,"
    "-build/header_guard,-legal/copyright"
)
ODD = """\
archgen: 1
project: {id: 'Odd', title: '*/ "); } ??/ // \\'}
groups:
  class:
    components:
      auto: {title: "a\\n*/ b ??/", outputs: {register: T, Register_: T, new: T}, parameters: {template: 1, int: {type: float, value: .inf}}}
      double:
        inputs: {register: auto.register, delete: auto.new}
        parameters:
          a: {b: {value: .nan}, B: -1}
          deep.a1_b.x: 1
          deep.a1b.x: 2
          linux: true
          least: -9223372036854775808
          most: {value: 9223372036854775807, range: [-9223372036854775808, 9223372036854775807]}
          tiny: {value: -5.0e-324, range: [-1.0e+308, .inf]}
          texts: {value: ["*/", "??=", "\\\\", "a\\nb", "\\""], choices: ["*/", "??=", "\\\\", "a\\nb", "\\"", c]}
          flags: {value: [true, false], choices: [true, false]}
          flag: {value: true, choices: [true]}
          numbers: {value: [1, 2], choices: [1, 2, 3]}
          number: {value: 2, choices: [1, 2], description: "\\"quoted\\" ??/ \\\\ */ `x`"}
          empty: {type: "string[]", value: []}
          params.x: 1
          'dashed-name': 1
      void: {}
      nameless: {outputs: {x: Unknown}}
types: {T: std_msgs/msg/String}
nodes:
  auto: {implements: class.auto, language: cpp}
  double: {implements: class.double, language: cpp, kind: [lifecycle, composable]}
  void: {implements: class.void, language: cpp, package: own, executable: test}
  nameless: {implements: class.nameless, language: cpp}
"""


SPEED = """\
archgen: 1
project: {id: p}
ros: {distro: jazzy}
groups: {g: {components: {a: {parameters: {speed: 1.0}, outputs: {done: std_msgs/msg/Empty}}}}}
nodes: {a: {implements: g.a, language: cpp, kind: KIND}}
"""
LIFECYCLE = PROJECT.replace("kind: lifecycle", "kind: lifecycle, language: cpp")


def make_cpp(folder: Path) -> CheckedProject:
    """Return a project of which all nodes are programs in C++."""
    project = check_project(folder)
    nodes = {each.id: dataclasses.replace(each, language="cpp") for each in project.architecture.nodes.values()}
    return dataclasses.replace(project, architecture=dataclasses.replace(project.architecture, nodes=nodes))


def compile_all(workspace: Path, folder: Path, include_folders: list[Path] | None = None) -> None:
    packages = sorted(each.parent for each in workspace.glob("src/*/package.xml"))
    assert packages
    for package in packages:
        assert compile_package(package, folder, include_folders) == "", package


@pytest.mark.build
def test_odd_names_and_numbers_compile(tmp_path: Path) -> None:
    project = write_project(tmp_path / "p", ODD)
    left_out = generate(project, tmp_path / "w")
    assert left_out == ["`class.nameless.x` of the node `nameless` is left out: nobody says which message it has"]
    compile_all(tmp_path / "w", tmp_path)


@pytest.mark.build
@pytest.mark.parametrize("way", ["threads: 4", "threads: 4, reentrant: true", "threads: 1"])
def test_lifecycle_nodes_compile(way: str, tmp_path: Path) -> None:
    generate(write_project(tmp_path / "p", LIFECYCLE.replace("threads: 4", way)), tmp_path / "w")
    compile_all(tmp_path / "w", tmp_path)


@pytest.mark.build
@pytest.mark.parametrize("kind", ["node", "lifecycle"])
def test_an_own_class_may_hear_of_new_values(kind: str, tmp_path: Path) -> None:
    text = SPEED.replace("KIND", kind)
    generate(write_project(tmp_path / "p", text), tmp_path / "w")
    (header,) = (tmp_path / "w").rglob("a_behaviour.hpp")
    method = "  void on_parameters(const std::vector<rclcpp::Parameter> & values) {count_ = values.size();}"
    own = header.read_text(encoding="utf-8").replace("private:", f"{method}\n\nprivate:\n  size_t count_{{0}};")
    header.write_text(f'#include <vector>\n#include "rclcpp/rclcpp.hpp"\n{own}', encoding="utf-8")
    compile_all(tmp_path / "w", tmp_path)
    (node,) = (tmp_path / "w").rglob("a_node.cpp")
    assert "tell_values(*behaviour_, values, 0)" in node.read_text(encoding="utf-8")
    # Before Iron, ROS tells nobody of values that were set.
    generate(write_project(tmp_path / "h", text.replace("jazzy", "humble")), tmp_path / "hw")
    assert not [each for each in (tmp_path / "hw").rglob("*.cpp") if "tell_values" in each.read_text(encoding="utf-8")]


@pytest.mark.build
@pytest.mark.parametrize("example", ["examples/cleaning_robot", "example_ramcip"])
def test_examples_compile(example: str, tmp_path: Path) -> None:
    generate(make_cpp(ROOT / example), tmp_path / "w")
    compile_all(tmp_path / "w", tmp_path)


@pytest.mark.ros
def test_it_compiles_against_real_messages(tmp_path: Path) -> None:
    if sys.version_info[:2] > NEWEST_PYTHON or sys.platform != "linux":
        pytest.skip(f"there is no ROS 2 for {sys.platform} and Python {sys.version.split()[0]}")
    make_ros_python()
    generate(write_project(tmp_path / "p", ROBOT), tmp_path / "w")
    compile_all(tmp_path / "w", tmp_path, sorted(each for each in (ROS_FOLDER / "include").iterdir() if each.is_dir()))


@pytest.mark.build
@pytest.mark.parametrize("example", [ROBOT, LIFECYCLE, "example_ramcip"], ids=["robot", "lifecycle", "ramcip"])
def test_it_is_formatted_as_ament_wants_it(example: str, tmp_path: Path) -> None:
    is_own = "\n" in example
    generate(write_project(tmp_path / "p", example) if is_own else make_cpp(ROOT / example), tmp_path / "w")
    judge_format(tmp_path)


def judge_format(folder: Path) -> None:
    files = sorted(str(path) for path in folder.rglob("*.?pp"))
    assert len(files) >= 6
    words = ("--quiet", "--linelength=100", "--extensions=hpp,cpp", "--headers=hpp", f"--filter={AMENT_CPPLINT}")
    assert run_judge(find_tool("cpplint"), *words, *files).stderr == ""
    style = Path(__file__).parent / "ament_code_style.cfg"
    # With `--check` it names those that it would write otherwise.
    run_judge(find_tool("uncrustify"), "-q", "-l", "CPP", "-c", style, "--check", *files)
