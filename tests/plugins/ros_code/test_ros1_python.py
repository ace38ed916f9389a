"""The backend `ros1_python`: what it writes is Python that people would write, and says only what the model says."""

from __future__ import annotations

import ast
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import pytest
import yaml

from archgen import pipeline
from archgen.plugins.ros_code.node_programs import make_view
from archgen.views.generation.generation_context import GenerationContext
from tests.hostile import TEXTS
from tests.outside_tools import run_judge
from tests.plugins.ros_code.test_ros2_python import AMENT_FLAKE8
from tests.running import archgen_here

ROBOT = """\
archgen: 1
project: {id: rt, title: Robot}
ros: {distro: noetic}
groups:
  g:
    components:
      cam:
        title: Camera
        functionality: Takes pictures.
        outputs: {image: Image, info: Words}
        parameters:
          rate: {type: float, value: 10, unit: Hz, range: [1, 30], description: How often.}
          mode: {choices: [fast, careful], value: careful}
          deep.names: {value: [a, "b'c"]}
          size: {type: integer, value: 640, range: [1, 4096], read_only: true}
          big: {type: integer, value: 5000000000}
          map_file: {type: string}
        timing: {rate: 10 Hz, wcet: 1 ms}
      det:
        inputs: {image: cam.image, class: cam.info, timer: cam.info}
        outputs: {found: Words, plan: Plan, go: Fib}
      talker_node: {outputs: {words: Words}}
      user: {functionality: 'Ends in "quotes"', inputs: {go: det.go, plan: det.plan}}
      m1: {is: motor, inputs: {target: det.found}}
      m2: {is: motor, inputs: {target: det.found}, parameters: {joint: right}}
      idle: {}
component_types:
  motor: {inputs: {target: Words}, outputs: {state: Words}, parameters: {joint: left}, node: {namespace: /arm}}
types:
  Image: sensor_msgs/msg/Image
  Words: std_msgs/msg/String
  Plan: std_srvs/srv/Trigger
  Fib: actionlib/action/Test
nodes:
  cam: {implements: g.cam, publishes: {image: {topic: /camera/image, qos: {durability: transient_local, history: keep_all}}}}
  det: {implements: g.det, namespace: /perception, reentrant: true, publishes: {found: {topic: found, own_name: detections, qos: {depth: 3}}}}
"""


def generate_nodes(folder: Path, text: str, workspace: Path, status: int = 0) -> str:
    """Generate into a workspace, and return what is said of it."""
    folder.mkdir(exist_ok=True)
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    done = archgen_here("generate", "ros1_python", "-o", workspace, "--keep-going", cwd=folder, status=status)
    return (done.stdout + done.stderr).decode()


def make_programs(folder: Path, text: str, ros: int = 1) -> tuple[dict[str, dict[str, Any]], list[str]]:
    """Return the view by executable, and what was left out."""
    folder.mkdir(exist_ok=True)
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    view = make_view(GenerationContext(pipeline.check_project(folder).architecture), ros)
    return {each["executable"]: each for each in view.data["programs"]}, [each.message for each in view.findings]


def test_classes_of_messages_are_those_of_ros_1(tmp_path: Path) -> None:
    programs, left_out = make_programs(tmp_path, ROBOT)
    assert left_out == ["the parameter `big` of `cam` is left out: no parameter of ROS can be what it is"]
    assert list(programs) == ["cam", "det", "idle", "motor", "talker_node", "user"]
    assert programs["det"]["python_imports"] == [
        {"module": "actionlib.msg", "names": ["TestAction"]},
        {"module": "sensor_msgs.msg", "names": ["Image"]},
        {"module": "std_msgs.msg", "names": ["String"]},
        {"module": "std_srvs.srv", "names": ["Trigger", "TriggerResponse"]},
    ]
    assert [each["names"] for each in programs["user"]["python_imports"]] == [["TestAction"], ["Trigger"]]
    assert [each["key"] for each in programs["det"]["subscriptions"]] == ["class_", "image", "timer"]


def test_messages_of_one_name_are_told_apart(tmp_path: Path) -> None:
    text = (
        "ros: {distro: noetic}\ngroups: {g: {components: {a: {outputs: {x: X, y: Y, z: Z}}}}}\n"
        "types: {X: std_msgs/msg/String, Y: {message: own_msgs/msg/String, status: planned}, Z: {message: own_msgs/msg/RLock, status: planned}}\n"
    )
    generate_nodes(tmp_path / "p", text, tmp_path / "w")
    (node,) = (tmp_path / "w").rglob("a_node.py")
    imported = "from own_msgs.msg import RLock as OwnMsgsMsgRLock, String as OwnMsgsMsgString\n"
    assert imported in node.read_text()
    assert "from std_msgs.msg import String as StdMsgsMsgString\n" in node.read_text()


@pytest.mark.parametrize(("ros", "distro"), [(1, "jazzy"), (2, "noetic")])
def test_a_project_of_the_other_ros_is_told_so(ros: int, distro: str, tmp_path: Path) -> None:
    programs, left_out = make_programs(tmp_path, ROBOT.replace("noetic", distro), ros)
    assert programs == {}
    assert left_out == [f"the project is made for ROS {3 - ros}: it has no nodes for ROS {ros}"]


def test_it_is_written_as_ros_developers_write(tmp_path: Path) -> None:
    generate_nodes(tmp_path / "p", ROBOT, tmp_path / "w", status=1)
    scripts = [str(each) for each in (tmp_path / "w").rglob("scripts/*")]
    assert len(scripts) == 6
    command = [sys.executable, "-m", "flake8", "--isolated", "--jobs=1", *AMENT_FLAKE8, str(tmp_path / "w"), *scripts]
    done = run_judge(*command)
    assert done.stdout == ""
    for path in [*(tmp_path / "w").rglob("scripts/*"), *(tmp_path / "w").rglob("test/*.py")]:
        assert path.stat().st_mode & 0o111, path


def test_own_code_is_asked_for_what_the_model_gained(tmp_path: Path) -> None:
    generate_nodes(tmp_path / "p", ROBOT, tmp_path / "w", status=1)
    own = tmp_path / "w" / "src" / "rt_g" / "src" / "rt_g" / "det.py"
    own.write_text(own.read_text().replace("receive_image", "take_picture"))
    assert "receive_image" in generate_nodes(tmp_path / "p", ROBOT, tmp_path / "w", status=1)
    assert "take_picture" in own.read_text()


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)
def test_no_text_breaks_out(text: str, tmp_path: Path) -> None:
    project = {
        "archgen": 1,
        "project": {"id": "p", "title": text},
        "ros": {"distro": "noetic"},
        "groups": {
            "g": {
                "components": {
                    "a": {
                        "title": text,
                        "functionality": f"{text}'''\"\"\"\\",
                        "description": text,
                        "outputs": {"o": {"type": "T", "description": text}},
                        "parameters": {
                            "x": {"value": text, "description": text, "unit": text},
                            "y": {"choices": [text, "b"]},
                        },
                    }
                }
            }
        },
        "types": {"T": {"message": "std_msgs/msg/String", "comment": text}},
        "nodes": {"a": {"implements": "a", "publishes": {"o": {"topic": "/o"}}, "title": text}},
    }
    generate_nodes(tmp_path / "p", yaml.safe_dump(project, allow_unicode=True), tmp_path / "w")
    files = [*(tmp_path / "w").rglob("*.py"), *(tmp_path / "w").rglob("scripts/*")]
    assert len(files) == 7
    for file in files:
        tree = ast.parse(file.read_text(encoding="utf-8"))
        names = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
        assert not names & {"alert", "cmd", "N", "T"}, file
    for file in [*(tmp_path / "w").rglob("*.test"), *(tmp_path / "w").rglob("package.xml")]:
        ET.parse(file)  # noqa: S314 - just made


def test_what_nobody_wrote_yet_reports_no_success(tmp_path: Path) -> None:
    generate_nodes(tmp_path / "p", ROBOT, tmp_path / "w", status=1)
    behaviours = "".join(file.read_text() for file in (tmp_path / "w").rglob("*.py"))
    assert "set_aborted(" in behaviours
    assert "set_succeeded(" not in behaviours
    assert "is not written yet: its answers say nothing" in behaviours
