"""Messages that carry their sender: generated nodes send their name, and hear only whom the architecture names."""

from __future__ import annotations

import ast
import json
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from archgen.model.message_types import ConceptualType, DataField
from archgen.pipeline import check_project
from archgen.plugins.ros_code.node_programs import make_view
from archgen.views.generation.generation_context import GenerationContext
from archgen.views.generation.program_parts import is_envelope
from tests.outside_tools import run_judge
from tests.plugins.ros_code.test_ros2_cpp_builds import compile_all, judge_format
from tests.plugins.ros_code.test_ros2_python import AMENT_FLAKE8
from tests.property_sizes import try_some
from tests.ros_2_kilted import KILTED_FOLDER, build_interfaces, kilted_environment, make_kilted_python
from tests.ros_environment import NEWEST_PYTHON, interrupt_node
from tests.running import archgen_here

ROBOT = """\
archgen: 1
project: {id: rt, title: Robot}
ros: {distro: DISTRO}
groups:
  g:
    components:
      planner: {outputs: {target: Target, name: Words}, node: {namespace: /arm}}
      left: {is: motor, inputs: {target: planner.target}}
      right: {is: motor, inputs: {target: planner.target}}
      open: {inputs: {target: {type: Target}, states: [left.state, right.state]}}
component_types:
  motor: {inputs: {target: Target}, outputs: {state: State}, node: {package: rt_arm, namespace: /arm}}
types:
  Target: {fields: {position: float64}}
  State: {fields: {positions: "float64[]"}}
  Words: std_msgs/msg/String
"""


# Payloads of each kind, a parameter that says whom to hear, and what comes before a node is active.
CPP_ROBOT = (
    ROBOT.replace("namespace: /arm}", "namespace: /arm, language: cpp}")
    .replace("name: Words}", "name: Words, count: Count, many: Many}")
    .replace(
        "right.state]}}",
        "right.state], words: planner.name, count: planner.count, many: planner.many}, "
        "parameters: {senders.words: [/x]}, node: {language: cpp, threads: 2}}\n"
        "      keeper: {inputs: {target: planner.target, name: planner.name}, node: {language: cpp, kind: [lifecycle, composable], "
        "subscribes: {target: {qos: {durability: transient_local}}}}}",
    )
    + """  Count: {fields: {sender: string, payload: float64}}
  Many: {fields: {sender: string, payload: "Target[]"}}
"""
)


def write_enveloped(folder: Path, distro: str, *passes: str, robot: str = ROBOT) -> Path:
    """Return a folder with the project behind the pass `envelope` and others."""
    (folder / "p").mkdir()
    (folder / "p" / "archgen.yaml").write_text(robot.replace("DISTRO", distro), encoding="utf-8")
    archgen_here("transform", "envelope", *passes, "-o", folder / "e", cwd=folder / "p", status=0)
    return folder / "e"


@pytest.mark.parametrize("passes", [(), ("remove_generics",), ("remove_generics", "flatten")])
@pytest.mark.parametrize("ros", [1, 2])
def test_each_node_knows_whom_it_listens_to(ros: int, passes: tuple[str, ...], tmp_path: Path) -> None:
    project = write_enveloped(tmp_path, "noetic" if ros == 1 else "jazzy", *passes)
    view = make_view(GenerationContext(check_project(project).architecture), ros)
    ports = {
        (program["executable"], port["key"]): port["envelope"]
        for program in view.data["programs"]
        for port in (*program["publishers"], *program["subscriptions"])
    }
    shared = "left" if "flatten" in passes else "motor"
    assert ports["planner", "target"] == {"payload": "rt_msgs/msg/Target", "senders": {}}
    assert ports["planner", "name"] == {"payload": "std_msgs/msg/String", "senders": {}}
    readers = ["/arm/left"] if shared == "left" else ["/arm/left", "/arm/right"]
    assert ports[shared, "target"]["senders"] == {reader: ["/arm/planner"] for reader in readers}
    assert ports["open", "target"]["senders"] == {"/open": ["*"]}
    assert [ports["open", key]["senders"]["/open"] for key in ("states_left", "states_right")] == [
        ["/arm/left"],
        ["/arm/right"],
    ]


def test_only_a_text_and_a_payload_are_an_envelope() -> None:
    def has_fields(**fields: str) -> bool:
        return is_envelope(ConceptualType("T", fields=tuple(DataField(*each) for each in fields.items())))

    assert has_fields(sender="string", payload="Pose")
    assert has_fields(payload="Pose", sender="string")
    assert not has_fields(sender="uint8", payload="Pose")
    assert not has_fields(sender="string", payload="Pose", stamp="time")
    assert not is_envelope(ConceptualType("T"))


@pytest.mark.parametrize(("backend", "distro"), try_some([("ros1_python", "noetic"), ("ros2_python", "jazzy")], 1))
def test_it_is_written_as_ros_developers_write(backend: str, distro: str, tmp_path: Path) -> None:
    project = write_enveloped(tmp_path, distro)
    archgen_here("generate", backend, "-o", tmp_path / "w", cwd=project, status=0)
    command = [sys.executable, "-m", "flake8", "--isolated", "--jobs=1", *AMENT_FLAKE8, str(tmp_path / "w")]
    done = run_judge(*command)
    assert done.stdout == ""


def test_an_empty_name_is_nobody(tmp_path: Path) -> None:
    """ROS has no empty list of texts as a default: nobody is an empty text."""
    project = write_enveloped(tmp_path, "jazzy")
    archgen_here("generate", "ros2_python", "-o", tmp_path / "w", cwd=project, status=0)
    method = take_method(tmp_path / "w", "is_expected")
    said: list[str] = []
    logger = SimpleNamespace(warning=lambda text, **_: said.append(text))

    def is_expected(known: list[str], sender: str) -> object:
        node = SimpleNamespace(senders={"target": known}, get_logger=lambda: logger)
        return method(node, "target", "/target", sender, {})

    assert [is_expected(known, "") for known in ([""], ["/a"], ["*"])] == [False, False, True]
    assert [is_expected(["/a"], "/a"), is_expected(["/a"], "/b")] == [True, False]
    assert said[-1] == "refused a message for target from '/b': nobody expects it"


def take_method(workspace: Path, name: str) -> Callable[..., object]:
    """Return a method of the generated node `motor`, to call without ROS."""
    (path,) = workspace.rglob("motor_node.py")
    methods = (
        each for each in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(each, ast.FunctionDef)
    )
    method = next(each for each in methods if each.name == name)
    names: dict[str, Any] = {"rospy": ROSPY}
    exec(compile(ast.Module([method], []), str(path), "exec"), names)  # noqa: S102 - just generated
    return names[name]  # type: ignore[no-any-return]


ROSPY = SimpleNamespace(name="")
ROSPY.get_name = lambda: ROSPY.name


@pytest.mark.parametrize(("backend", "distro"), [("ros1_python", "noetic"), ("ros2_python", "jazzy")])
def test_a_second_robot_hears_its_own(backend: str, distro: str, tmp_path: Path) -> None:
    """What stands in front of a node's name stands in front of those whom it hears; nobody else is guessed."""
    project = write_enveloped(tmp_path, distro)
    archgen_here("generate", backend, "-o", tmp_path / "w", cwd=project, status=0)
    method = take_method(tmp_path / "w", "find_senders")

    def find_senders(own_name: str) -> object:
        ROSPY.name = own_name
        node = SimpleNamespace(get_fully_qualified_name=lambda: own_name)
        return method(node, {"/left": ["*"], "/arm/left": ["/arm/planner", "*"]})

    assert find_senders("/arm/left") == ["/arm/planner", "*"]
    assert find_senders("/r2/arm/left") == ["/r2/arm/planner", "*"]
    assert find_senders("/r2/left") == ["*"]
    nobody = [] if distro == "noetic" else [""]
    assert [find_senders(each) for each in ("/arm/left2", "/other", "/aleft")] == [nobody] * 3


def generate_cpp(folder: Path, distro: str, *options: str) -> Path:
    project = write_enveloped(folder, distro, robot=CPP_ROBOT)
    for backend in (("ros_interfaces",), ("ros2_cpp", *options)):
        archgen_here("generate", *backend, "-o", folder / "w", cwd=project, status=0)
    return folder / "w"


@pytest.mark.build
@pytest.mark.parametrize(
    ("distro", "options"), [("jazzy", ()), ("kilted", ()), ("kilted", ("--option", "stand_ins=true"))]
)
def test_nodes_in_cpp_send_their_name_and_hear_whom_they_may(
    distro: str, options: tuple[str, ...], tmp_path: Path
) -> None:
    workspace = generate_cpp(tmp_path, distro, *options)
    compile_all(workspace, tmp_path)
    judge_format(workspace)
    node = (workspace / "src" / "rt_arm" / "src" / "motor_node.cpp").read_text(encoding="utf-8")
    assert "envelope->sender = get_fully_qualified_name();" in node
    assert re.search(r'is_called\("/arm/left"\)\) \{\s*target_senders_ = \{\s*robot \+ "/arm/planner"\s*\};', node)
    # As in Python, ROS is asked from Kilted on who published a message.
    assert ("publisher_gid" in node) == (distro == "kilted")
    own = (workspace / "src" / "rt_arm" / "include" / "rt_arm" / "motor_behaviour.hpp").read_text(encoding="utf-8")
    assert "void receive_target(rt_msgs::msg::Target::ConstSharedPtr message);" in own
    assert "envelope" not in own


@pytest.mark.ros
@pytest.mark.build
def test_nodes_in_cpp_compile_with_real_envelopes(tmp_path: Path) -> None:
    if sys.version_info[:2] > NEWEST_PYTHON or sys.platform != "linux":
        pytest.skip(f"there is no ROS 2 for {sys.platform} and Python {sys.version.split()[0]}")
    make_kilted_python()
    workspace = generate_cpp(tmp_path, "kilted")
    prefix = build_interfaces(workspace / "src" / "rt_msgs", tmp_path)
    folders = [
        each for root in (KILTED_FOLDER, prefix) for each in sorted((root / "include").iterdir()) if each.is_dir()
    ]
    shutil.rmtree(workspace / "src" / "rt_msgs")
    compile_all(workspace, tmp_path, folders)


MOTOR = """
from rt_msgs.msg import State


class Motor:

    def __init__(self, node):
        self.node = node

    def receive_target(self, message):
        self.node.publish_state(State(positions=[message.position]))
"""
STRANGER = """
import json, sys, time
import rclpy
from rclpy.node import Node
from rt_msgs.msg import EnvelopeState, EnvelopeTarget, Target

TOPIC = '/g/planner/target'
log = sys.argv[1]
rclpy.init()
stranger, planner = Node('stranger'), Node('planner', namespace='/arm')
answers = []
stranger.create_subscription(EnvelopeState, '/g/left/state', answers.append, 100)
forged, real = (node.create_publisher(EnvelopeTarget, TOPIC, 10) for node in (stranger, planner))
end = time.monotonic() + 120


def send(publisher, sender, position):
    publisher.publish(EnvelopeTarget(sender=sender, payload=Target(position=position)))
    rclpy.spin_once(stranger, timeout_sec=0.1)


def has_answer(position):
    return any(position in each.payload.positions for each in answers)


# At first nobody knows whose a message is: from the first refusal for that reason on, all of them are refused.
while '/stranger sent it' not in open(log).read() and time.monotonic() < end:
    send(forged, '/arm/planner', 1.0)
for _ in range(5):
    send(forged, '/stranger', 2.0)
    send(forged, '/arm/planner', 3.0)
    send(forged, '', 5.0)
while not has_answer(4.0) and time.monotonic() < end:
    send(real, '/arm/planner', 4.0)
known = [position for position in (2.0, 3.0, 4.0, 5.0) if has_answer(position)]
print(json.dumps([known, sorted({each.sender for each in answers})]))
"""


@pytest.mark.ros
@pytest.mark.build
def test_foreign_senders_are_refused_on_ros_2(tmp_path: Path) -> None:
    """By the name in the envelope, and on Kilted by who published it as well."""
    if sys.version_info[:2] > NEWEST_PYTHON or sys.platform != "linux":
        pytest.skip(f"there is no ROS 2 for {sys.platform} and Python {sys.version.split()[0]}")
    python = str(make_kilted_python())
    project = write_enveloped(tmp_path, "kilted")
    workspace = tmp_path / "w"
    for backend in ("ros_interfaces", "ros2_python"):
        archgen_here("generate", backend, "-o", workspace, cwd=project, status=0)
    (workspace / "src" / "rt_arm" / "rt_arm" / "motor.py").write_text(MOTOR, encoding="utf-8")
    prefix = build_interfaces(workspace / "src" / "rt_msgs", tmp_path)
    environment = kilted_environment(37, workspace, prefix, tmp_path)
    log = tmp_path / "log"
    words = ["__node:=left", "__ns:=/arm", "state:=/g/left/state", "target:=/g/planner/target"]
    module = "import sys; from rt_arm.motor_node import main; main(sys.argv)"
    command = [python, "-u", "-c", module, "--ros-args", *(word for each in words for word in ("-r", each))]
    with log.open("wb") as stream:
        node = subprocess.Popen(command, env=environment, stdout=stream, stderr=stream)  # noqa: S603 - just generated
    try:
        sending = [python, "-c", STRANGER, str(log)]
        done = run_judge(*sending, statuses=range(256), env=environment)
    finally:
        status = interrupt_node(node)
    said = log.read_text(encoding="utf-8")
    assert done.returncode == 0, done.stderr + said
    assert json.loads(done.stdout.splitlines()[-1]) == [[4.0], ["/arm/left"]], said
    assert status == 0, said
    tests = [python, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(workspace / "src" / "rt_arm" / "test")]
    done = run_judge(*tests, env=environment)
