"""The backend `ros2_cpp`: what its view says, and what it leaves out."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
import yaml

from archgen.emit.file_tree import OutputError
from archgen.pipeline import CheckedProject, check_project
from archgen.plugins.ros_code.node_programs import make_view
from archgen.products.output_options import OutputOptions
from archgen.products.workspace_product import WorkspaceRequest, write_workspace
from archgen.views.generation.generation_context import GenerationContext
from tests.hostile import TEXTS
from tests.plugins.ros_code.cpp_compiler import name_header

ROBOT = """\
archgen: 1
project: {id: rt, title: Robot}
ros: {distro: jazzy}
groups:
  g:
    components:
      cam:
        title: Camera
        functionality: Takes pictures.
        outputs: {image: Image, cloud: Cloud}
        parameters:
          rate: {type: float, value: 10, unit: Hz, range: [1, 30], description: How often.}
          mode: {choices: [fast, careful], value: careful}
          names: {value: [a, "b'c"]}
          lens: {focus: {value: 0.5, range: [0, 1]}, class: 3}
          greeting: {value: 'say "hello"', choices: ['say "hello"', bye]}
          size: {type: integer, value: 640, range: [1, 4096], read_only: true}
          map_file: {type: string, description: Where it is kept.}
        timing: {rate: 10 Hz, wcet: 1 ms}
      det:
        inputs: {image: cam.image, cloud: cam.cloud}
        outputs: {found: Words, plan: Plan, go: Fib}
      user: {functionality: 'Ends in "quotes"', inputs: {go: det.go, plan: det.plan}}
      m1: {is: motor, inputs: {target: det.found}}
      m2: {is: motor, inputs: {target: det.found}, parameters: {joint: right}}
      slow: {inputs: {image: cam.image}, timing: {rate: 2 Hz, wcet: 1 ms}}
      fast: {inputs: {plan: det.plan}, timing: {rate: 50 Hz, wcet: 1 ms}}
component_types:
  motor: {inputs: {target: Words}, outputs: {state: Words}, parameters: {joint: left}, node: {namespace: /arm, language: cpp}}
types:
  Image: sensor_msgs/msg/Image
  Cloud: sensor_msgs/msg/PointCloud2
  Words: std_msgs/msg/String
  Plan: std_srvs/srv/Trigger
  Fib: test_msgs/action/Fibonacci
nodes:
  cam: {implements: g.cam, kind: composable, publishes: {image: {topic: /camera/image, qos: sensor_data}}}
  user: {implements: g.user, language: cpp, plugin: 'people::Asker'}
  both: {implements: [g.slow, g.fast], language: cpp, threads: 2, callback_groups: {quick: [g.fast]}}
  det:
    implements: g.det
    kind: lifecycle
    language: cpp
    namespace: /perception
    threads: 2
    reentrant: true
    publishes:
      found: {topic: found, own_name: detections, qos: {depth: 3, deadline: 100 ms, lifespan: 1 s, liveliness: manual_by_topic, lease_duration: 2 s}}
"""


def write_project(folder: Path, text: str) -> CheckedProject:
    folder.mkdir(exist_ok=True)
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    return check_project(folder)


def generate(project: CheckedProject, workspace: Path, backend: str = "ros2_cpp") -> list[str]:
    """Generate into a workspace, and return what was left out."""
    return [each.message for each in write_workspace(project, OutputOptions(), backend, workspace).findings]


def make_programs(project: CheckedProject) -> tuple[dict[str, dict[str, Any]], list[str]]:
    """Return the view by executable, and what was left out."""
    view = make_view(GenerationContext(project.architecture, options={"language": "cpp", "with_cpp": True}))
    return {each["executable"]: each for each in view.data["programs"]}, [each.message for each in view.findings]


def test_a_program_has_what_cpp_asks_for(tmp_path: Path) -> None:
    programs, left_out = make_programs(write_project(tmp_path, ROBOT))
    assert left_out == []
    assert list(programs) == ["both", "cam", "det", "motor", "user"]
    user, both = programs["user"], programs["both"]
    assert (user["cpp_namespace"], user["cpp_class"], user["cpp_guard"]) == ("people", "Asker", "RT_G__USER")
    assert user["cpp_headers"] == ["std_srvs/srv/trigger.hpp", "test_msgs/action/fibonacci.hpp"]
    assert programs["cam"]["publishers"][0]["cpp_header"] == "sensor_msgs/msg/point_cloud2.hpp"
    assert both["callback_groups"] == [{"key": "quick", "components": ["g.fast"]}]
    assert [(each["key"], each["callback_group"]) for each in both["timers"]] == [("fast", "quick"), ("slow", "")]
    assert (both["subscriptions"][0]["callback_group"], both["clients"][0]["callback_group"]) == ("", "quick")
    assert programs["det"]["callback_groups"] == []
    assert {each["callback_group"] for each in programs["det"]["subscriptions"]} == {""}


def test_the_library_declares_what_it_can(tmp_path: Path) -> None:
    programs, _ = make_programs(write_project(tmp_path, ROBOT))
    cam = {each["name"]: each["is_in_library"] for each in programs["cam"]["parameters"]}
    assert [name for name, is_in_library in cam.items() if not is_in_library] == ["greeting", "lens.class", "map_file"]
    rows = [(each["depth"], each["name"]) for each in programs["cam"]["library_rows"]]
    assert rows == [(0, "lens"), (1, "focus"), (0, "mode"), (0, "names"), (0, "rate"), (0, "size")]
    (joint,) = programs["motor"]["parameters"]
    assert (joint["default"], joint["first_value"], joint["is_in_library"]) == ("left", "left", True)


def test_with_both_backends_nothing_is_made_twice(tmp_path: Path) -> None:
    project = write_project(
        tmp_path / "p", ROBOT.replace("threads: 2, callback_groups", "package: own, threads: 2, callback_groups")
    )
    generate(project, tmp_path / "w")
    before = {path for path in (tmp_path / "w" / "src").rglob("*") if path.is_file()}
    generate(project, tmp_path / "w", "ros2_python")
    assert {path for path in (tmp_path / "w" / "src").rglob("*") if path.is_file()} == before


def test_a_backend_writes_one_language(tmp_path: Path) -> None:
    text = "groups: {g: {components: {a: {}, b: {}}}}\nnodes: {a: {implements: g.a, language: cpp}, b: {implements: g.b}}\n"
    project = write_project(tmp_path / "p", text)
    generate(project, tmp_path / "w")
    assert [path.name for path in tmp_path.rglob("*_node.cpp") if path.parent.name == "src"] == ["a_node.cpp"]
    for backend, language in (("ros2_cpp", "python"), ("ros2_python", "cpp"), ("ros1_python", "c++")):
        with pytest.raises(OutputError, match=f"the option `language` of the backend `{backend}` is `[a-z]+`, not `"):
            write_workspace(
                project, OutputOptions(), backend, tmp_path / "w", WorkspaceRequest(options={"language": language})
            )


def test_a_second_run_touches_nothing(tmp_path: Path) -> None:
    project = write_project(tmp_path / "p", ROBOT)
    generate(project, tmp_path / "w")
    result = write_workspace(project, OutputOptions(), "ros2_cpp", tmp_path / "w")
    assert result.plan is not None
    assert {step.verb for step in result.plan.steps} == {"same", "yours"}


@pytest.mark.parametrize(
    ("node", "told"),
    [
        ("plugin: 'Lone'", "no class of C++ can be called `Lone`"),
        ("plugin: 'a::class'", "no class of C++ can be called `a::class`"),
        ("plugin: 'a::B(); //'", "no class of C++ can be called `a::B(); //`"),
    ],
)
def test_classes_that_no_compiler_takes_are_told(node: str, told: str, tmp_path: Path) -> None:
    text = f"groups: {{g: {{components: {{a: {{}}}}}}}}\nnodes: {{a: {{implements: g.a, language: cpp, {node}}}}}\n"
    programs, left_out = make_programs(write_project(tmp_path, text))
    assert programs == {}
    assert left_out == [f"the program of `a` is left out: {told}"]


def test_nodes_of_one_program_are_of_one_class(tmp_path: Path) -> None:
    text = (
        "groups: {g: {components: {a: {}, b: {}}}}\nnodes:\n"
        "  a: {implements: g.a, language: cpp, executable: x, plugin: 'n::A'}\n"
        "  b: {implements: g.b, language: cpp, executable: x, plugin: 'n::B'}\n"
    )
    assert make_programs(write_project(tmp_path, text)) == (
        {},
        ["the program of `a` is left out: its nodes have different classes, `n::A` and `n::B`"],
    )


def test_own_code_is_asked_for_what_the_model_gained(tmp_path: Path) -> None:
    project = write_project(tmp_path / "p", ROBOT)
    generate(project, tmp_path / "w")
    own = tmp_path / "w" / "src" / "rt_g" / "src" / "det_behaviour.cpp"
    own.write_text(own.read_text().replace("receive_image", "take_picture"))
    result = write_workspace(project, OutputOptions(), "ros2_cpp", tmp_path / "w")
    assert result.plan is not None
    assert "take_picture" in own.read_text()
    (step,) = (each for each in result.plan.steps if each.path.endswith("det_behaviour.cpp"))
    assert "receive_image" in str(step)


def test_a_hidden_text_ends_no_string_and_no_comment(tmp_path: Path) -> None:
    """What no compiler has to say: after strings and comments are taken away, hostile words are gone."""
    for number, text in enumerate(TEXTS.values()):
        component = {
            "title": text,
            "functionality": text,
            "outputs": {"o": {"type": "T", "description": text}},
            "parameters": {
                "x": {"value": text, "description": text, "unit": text},
                "y": {"choices": [text, "b"], "description": text},
            },
        }
        project = {
            "archgen": 1,
            "project": {"id": "p", "title": text},
            "groups": {"g": {"components": {"a": component}}},
            "types": {"T": {"message": "std_msgs/msg/String", "comment": text}},
            "nodes": {"a": {"implements": "a", "language": "cpp", "title": text}},
        }
        folder = tmp_path / str(number)
        generate(write_project(folder, yaml.safe_dump(project, allow_unicode=True)), folder / "w")
        files = [*folder.rglob("*.cpp"), *folder.rglob("*.hpp")]
        assert len(files) == 6
        for path in files:
            code = path.read_text(encoding="utf-8")
            bare = re.sub(r'"(?:[^"\\\n]|\\.)*"|//[^\n]*', "", code)
            assert code.isprintable() or not re.search(r"[\x00-\x09\x0b-\x1f]", code), path
            assert '"' not in bare, path
            assert not set(re.findall(r"\w+", bare)) & {"alert", "cmd", "script", "rm"}, path
            assert "*/" not in re.sub(r"/\*\w+\*/", "", bare), path
        for path in folder.glob("w/src/*/src/*_parameters.yaml"):
            for entry in next(iter(yaml.safe_load(path.read_text(encoding="utf-8")).values())).values():
                written = [entry.get("description", ""), entry.get("default_value", "")]
                written += [each for values in entry.get("validation", {}).values() for each in values[0]]
                # The library puts these between quotes as they are.
                assert not any('"' in str(each) or "\\" in str(each) or "\n" in str(each) for each in written)


@pytest.mark.parametrize(
    ("name", "header"), [("PointCloud2", "point_cloud2"), ("IMUData", "imu_data"), ("UInt8", "u_int8"), ("A", "a")]
)
def test_headers_are_named_as_rosidl_names_them(name: str, header: str, tmp_path: Path) -> None:
    text = (
        "groups: {g: {components: {a: {outputs: {x: X}}}}}\n"
        f"types: {{X: {{message: own_msgs/msg/{name}, status: planned}}}}\nnodes: {{a: {{implements: g.a, language: cpp}}}}\n"
    )
    (program,) = make_programs(write_project(tmp_path, text))[0].values()
    assert program["cpp_headers"] == [f"own_msgs/msg/{header}.hpp"]
    assert name_header(name) == header
