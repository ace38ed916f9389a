"""The cleaning robot on a real ROS 1: its generated nodes run under a real master, and the graph is the model's."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import pytest

from archgen import pipeline
from archgen.model.architecture import Architecture
from archgen.model.parameter_values import find_effective_parameters
from tests.outside_tools import run_judge
from tests.ros_1_environment import (
    SYSTEM_PYTHON,
    build_messages,
    find_free_port,
    require_ros_1,
    ros_1_environment,
    run_programs,
)
from tests.running import ROOT, archgen_here

pytestmark = pytest.mark.ros


def write_project(folder: Path, text: str) -> Architecture:
    folder.mkdir(parents=True)
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    return pipeline.check_project(folder).architecture


def generate_workspace(project: Path, workspace: Path, *words: str) -> None:
    for backend in ("ros_interfaces", "ros1_python", "ros1_launch"):
        archgen_here("generate", backend, "-o", workspace, *words, cwd=project, status=0)


def judge_graph(environment: dict[str, str], architecture: Architecture) -> dict[str, Any]:
    """Return what another process sees of the graph when all nodes are there."""
    names = [each.full_name for each in architecture.nodes.values()]
    judge = [SYSTEM_PYTHON, str(ROOT / "tests" / "plugins" / "ros_code" / "ros_1_judge.py"), *names]
    done = run_judge(*judge, env=environment)
    observed: dict[str, Any] = json.loads(done.stdout)
    return observed


def list_modelled(architecture: Architecture) -> tuple[set[tuple[str, str, str]], dict[str, str]]:
    """Return what the model says: which node does what with which name, and the types of topics and services."""
    uses: set[tuple[str, str, str]] = set()
    types: dict[str, str] = {}
    for endpoint in architecture.endpoints:
        if endpoint.medium != "ros":
            continue
        node = architecture.nodes[endpoint.node].full_name
        package, _, name = (endpoint.message or "//").split("/")
        if endpoint.flow == "action":
            told, asked = (
                [f"{endpoint.name}/{each}" for each in ("status", "feedback", "result")],
                [f"{endpoint.name}/{each}" for each in ("goal", "cancel")],
            )
            is_server = endpoint.use == "serves"
            uses |= {(node, "publishes", each) for each in (told if is_server else asked)}
            uses |= {(node, "subscribes", each) for each in (asked if is_server else told)}
            types |= {
                f"{endpoint.name}/{each.lower()}": f"{package}/{name}Action{each}"
                for each in ("Goal", "Feedback", "Result")
            }
            types |= {
                f"{endpoint.name}/cancel": "actionlib_msgs/GoalID",
                f"{endpoint.name}/status": "actionlib_msgs/GoalStatusArray",
            }
        elif endpoint.use != "calls":
            # Who calls a service is in no graph of ROS 1.
            uses.add((node, endpoint.use, endpoint.label))
            types[endpoint.label] = f"{package}/{name}"
    return uses, types


def list_observed(observed: dict[str, Any]) -> set[tuple[str, str, str]]:
    """Return the same of a graph, without what ROS 1 gives to every node, and its own node."""
    return {
        (node, use, name)
        for node, entries in observed["graph"].items()
        for use, names in entries.items()
        for name in names
        if node != "/rosout" and name != "/rosout" and name not in {f"{node}/get_loggers", f"{node}/set_logger_level"}
    }


ROS_OWN_NAMES = {"/rosout", "/rosout_agg"}
ROS_OWN_PARAMETERS = {"/rosdistro", "/roslaunch", "/rosversion", "/run_id"}


def assert_same_graph(observed: dict[str, Any], architecture: Architecture) -> None:
    uses, types = list_modelled(architecture)
    assert list_observed(observed) == uses
    observed_types = {
        name: each for name, each in observed["types"].items() if each is not None and name not in ROS_OWN_NAMES
    }
    assert observed_types == types
    parameters = {
        f"{node.full_name}/{name.replace('.', '/')}": parameter.value
        for node in architecture.nodes.values()
        for name, parameter in find_effective_parameters(architecture, node).items()
        if parameter.is_known
    }
    assert {
        name: value
        for name, value in observed["parameters"].items()
        if "/" + name.split("/")[1] not in ROS_OWN_PARAMETERS
    } == parameters


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    require_ros_1()
    return tmp_path


MOTOR = """
from sensor_msgs.msg import JointState


class Motor:

    def __init__(self, node):
        self.node = node

    def receive_target(self, message):
        self.node.publish_state(JointState(name=[str(message.position), self.node.parameters['joint']]))
"""
STRANGER = """
# Sends a target under a wrong name and one under the right one, and says what the motor makes of them.
import json, sys, time
import rospy
from cleaning_robot_msgs.msg import EnvelopeJointState, EnvelopeJointTarget, JointTarget

rospy.init_node('stranger')
answers = []
rospy.Subscriber('/cleaning/left_arm/shoulder/state', EnvelopeJointState, answers.append)
targets = rospy.Publisher('/cleaning/left_arm/planner/shoulder', EnvelopeJointTarget, queue_size=10)
end = time.monotonic() + 60
# One connection carries all that a node sends on a topic, in order: an answer to the first would be there by then.
while not answers and time.monotonic() < end:
    for sender, position in (('/stranger', 1), ('', 2), ('/left_arm/elbow', 3), ('/left_arm/planner', 4)):
        targets.publish(EnvelopeJointTarget(sender=sender, payload=JointTarget(position=position)))
    time.sleep(0.2)
json.dump(sorted({(each.sender, *each.payload.name) for each in answers}), sys.stdout)
"""


def run_script(text: str, environment: dict[str, str]) -> str:
    done = run_judge(SYSTEM_PYTHON, "-c", text, env=environment)
    return done.stdout


def test_the_cleaning_robot_runs_as_its_model_says(folder: Path) -> None:
    """Flattened, with envelopes, as in figure 18 of the paper; the nodes and topics are those of the project as it is written."""
    text = (ROOT / "examples" / "cleaning_robot" / "archgen.yaml").read_text(encoding="utf-8")
    written = write_project(folder / "p", text.replace("distro: jazzy", "distro: noetic"))
    passes = ["envelope", "remove_generics", "flatten"]
    archgen_here("transform", *passes, "-o", folder / "flat", cwd=folder / "p", status=0)
    architecture = pipeline.check_project(folder / "flat").architecture
    assert list_modelled(architecture)[0] == list_modelled(written)[0]
    workspace = folder / "w"
    generate_workspace(folder / "flat", workspace)
    (motor,) = workspace.rglob("motor.py")
    motor.write_text(MOTOR, encoding="utf-8")
    build_messages(workspace, folder)
    port = find_free_port()
    environment = ros_1_environment(workspace, folder, port)
    launch = ["/usr/bin/roslaunch", "cleaning_robot_bringup", "cleaning_robot.launch"]
    listed = run_judge(*launch, "--nodes", env=environment)
    assert set(listed.stdout.split()) == {each.full_name for each in architecture.nodes.values()}
    commands = [["/usr/bin/roscore", "-p", str(port)], [*launch, "--wait"]]
    with run_programs(commands, environment, folder / "log"):
        observed = judge_graph(environment, architecture)
        answers = json.loads(run_script(STRANGER, environment))
    assert len(observed["graph"]) == 15
    assert_same_graph(observed, architecture)
    assert observed["types"]["/cleaning/localization/pose_fusion/p"] == "cleaning_robot_msgs/EnvelopePose"
    assert answers == [["/left_arm/shoulder", "4.0", "left_shoulder"]]
    assert "refused a message for target from '/stranger'" in (folder / "log").read_text(encoding="utf-8")


ROBOT = """\
archgen: 1
project: {id: rt, title: Robot}
ros: {distro: noetic}
groups:
  g:
    components:
      det:
        inputs: {words: {type: Words, external: Somebody's microphone}}
        outputs: {found: {type: Words, external: Whoever listens}, plan: Plan, go: Go}
        parameters: {deep.limit: {type: float, value: 3, range: [0, 5]}, mode: {choices: [a, b], value: b}}
      user:
        inputs: {plan: det.plan, go: det.go}
        outputs: {report: {type: Words, external: Whoever listens}}
        timing: {rate: 5 Hz, wcet: 1 ms}
      idle: {}
types: {Words: std_msgs/msg/String, Plan: std_srvs/srv/Trigger, Go: actionlib/action/Test}
nodes:
  det: {implements: det, namespace: /perception, publishes: {found: {topic: found, own_name: detections, qos: {durability: transient_local}}}}
  # A program that other programs of the package must not take for the module of this name.
  idle: {implements: idle, executable: rospy.py}
"""
DET = """
from actionlib.msg import TestResult
from std_msgs.msg import String


class Det:

    def __init__(self, node):
        self.node = node

    def receive_words(self, message):
        self.node.publish_found(String(message.data.upper()))

    def serve_plan(self, request, response):
        response.success = True
        response.message = str(self.node.parameters['deep/limit'])
        return response

    def execute_go(self, goal, server):
        server.set_succeeded(TestResult(goal.goal + 1))
"""
USER = """
from actionlib.msg import TestGoal
import rospy
from std_msgs.msg import String
from std_srvs.srv import TriggerRequest


class User:

    def __init__(self, node):
        self.node = node

    def on_timer(self):
        try:
            plan = self.node.call_plan(TriggerRequest())
        except rospy.ServiceException:
            return
        client = self.node.send_go(TestGoal(41))
        if client.wait_for_result(rospy.Duration(1)):
            self.node.publish_report(String(f'{plan.message} {client.get_result().result}'))
"""
OWN_LAUNCH = """\
<launch>
  <include file="$(find rt_bringup)/launch/rt.launch"/>
  <node pkg="by_hand" type="microphone" name="microphone">
    <remap from="spoken" to="WORDS"/>
    <remap from="heard" to="/perception/found"/>
  </node>
</launch>
"""
MICROPHONE = """\
#!/usr/bin/env python3
import time
import rospy
from std_msgs.msg import String

rospy.init_node('microphone')
heard = []
rospy.Subscriber('heard', String, lambda message: heard.append(message.data))
spoken = rospy.Publisher('spoken', String, queue_size=1)
while not rospy.is_shutdown():
    spoken.publish('hello')
    rospy.set_param('~heard', heard[-1:])
    time.sleep(0.2)
"""
LISTENER = """
# Waits for the report of the user, and for what the microphone heard.
import json, sys, time
import rospy
from std_msgs.msg import String

rospy.init_node('listener')
report = rospy.wait_for_message('/g/user/report', String, 60).data
end = time.monotonic() + 60
while not rospy.get_param('/microphone/heard', []) and time.monotonic() < end:
    time.sleep(0.2)
json.dump([report, rospy.get_param('/microphone/heard')], sys.stdout)
"""


@pytest.fixture
def robot_workspace(folder: Path) -> Path:
    """Return the workspace of a robot with services, actions and open ports, and behaviours written by hand."""
    write_project(folder / "p", ROBOT)
    workspace = folder / "w"
    generate_workspace(folder / "p", workspace)
    package = workspace / "src" / "rt_g" / "src" / "rt_g"
    (package / "det.py").write_text(DET, encoding="utf-8")
    (package / "user.py").write_text(USER, encoding="utf-8")
    return workspace


def test_services_actions_and_nodes_written_by_hand_take_part(folder: Path, robot_workspace: Path) -> None:
    """What nobody in the model sends or reads is a topic: a node that knows other names takes part through remaps."""
    architecture = pipeline.check_project(folder / "p").architecture
    own = robot_workspace / "src" / "by_hand"
    own.mkdir()
    (words,) = (each.label for each in architecture.endpoints if each.port == "g.det.words")
    (own / "all.launch").write_text(OWN_LAUNCH.replace("WORDS", words), encoding="utf-8")
    (own / "package.xml").write_text(
        (robot_workspace / "src" / "rt_g" / "package.xml").read_text().replace("rt_g", "by_hand")
    )
    (own / "microphone").write_text(MICROPHONE, encoding="utf-8")
    (own / "microphone").chmod(0o755)
    port = find_free_port()
    environment = ros_1_environment(robot_workspace, folder, port)
    commands = [
        ["/usr/bin/roscore", "-p", str(port)],
        ["/usr/bin/roslaunch", "--wait", "by_hand", "all.launch"],
    ]
    with run_programs(commands, environment, folder / "log"):
        observed = judge_graph(environment, architecture)
        heard = json.loads(run_script(LISTENER, environment))
    assert heard == ["3.0 42", ["HELLO"]]
    microphone = observed["graph"].pop("/microphone")
    assert (words in microphone["publishes"], microphone["subscribes"]) == (True, ["/perception/found"])
    observed["parameters"].pop("/microphone/heard", None)
    assert_same_graph(observed, architecture)


def test_generated_tests_pass_and_fail(folder: Path, robot_workspace: Path) -> None:
    environment = ros_1_environment(robot_workspace, folder, find_free_port())

    def run_test(name: str) -> tuple[bool, str]:
        command = ["/usr/bin/rostest", "rt_g", f"{name}_node.test"]
        done = run_judge(*command, statuses=range(256), env=environment)
        return done.returncode == 0, done.stdout + done.stderr

    for name in ("det", "rospy_py"):
        is_good, said = run_test(name)
        assert is_good, said
        assert "FAILED" not in said
    # A node that does not start is noticed.
    (robot_workspace / "src" / "rt_g" / "src" / "rt_g" / "rospy_py.py").write_text(
        "raise ValueError\n", encoding="utf-8"
    )
    test = robot_workspace / "src" / "rt_g" / "test" / "test_rospy_py_node.py"
    test.write_text(test.read_text(encoding="utf-8").replace("+ 60", "+ 5"), encoding="utf-8")
    is_good, said = run_test("rospy_py")
    assert not is_good, said


def test_wrong_parameters_end_a_node_with_words(folder: Path, robot_workspace: Path) -> None:
    port = find_free_port()
    environment = ros_1_environment(robot_workspace, folder, port)
    script = str(robot_workspace / "src" / "rt_g" / "scripts" / "det")
    with run_programs([["/usr/bin/rosmaster", "--core", "-p", str(port)]], environment, folder / "log"):
        run_script(
            "import time, rosgraph\nend = time.monotonic() + 60\n"
            "while not rosgraph.is_master_online() and time.monotonic() < end: time.sleep(0.1)\n",
            environment,
        )
        for setting, words in (
            ("_deep/limit:=7.5", "/perception/det/deep/limit is 7.5, not in 0.0 to 5.0"),
            ("_mode:=c", "/perception/det/mode is 'c', none of ['a', 'b']"),
            ("_mode:=1", "/perception/det/mode is 1, and should be str"),
        ):
            done = subprocess.run(  # noqa: S603 - just generated
                [script, "__ns:=/perception", setting],
                env=environment,
                capture_output=True,
                text=True,
                check=False,
                timeout=120,
            )
            assert (done.returncode, words in done.stderr) == (1, True), done.stderr
            run_script(
                f"import rospy\nrospy.delete_param('/perception/det/{setting[1:].partition(':')[0]}')\n", environment
            )


@pytest.mark.build
def test_catkin_builds_what_is_generated(folder: Path, robot_workspace: Path) -> None:
    """Built as people build it, installed, and tested in the space that catkin makes for that; with messages of its own."""
    (folder / "p" / "archgen.yaml").write_text(
        ROBOT.replace("Words: std_msgs/msg/String", "Words: {fields: {data: string}}"), encoding="utf-8"
    )
    for name in ("det", "user"):
        own = robot_workspace / "src" / "rt_g" / "src" / "rt_g" / f"{name}.py"
        own.write_text(
            own.read_text(encoding="utf-8").replace("std_msgs.msg import String", "rt_msgs.msg import Words as String")
        )
    generate_workspace(folder / "p", robot_workspace)
    environment = ros_1_environment(folder, folder, find_free_port())
    for name in ("PYTHONPATH", "ROS_DISTRO", "ROS_PACKAGE_PATH"):
        del environment[name]
    steps = [
        # The other languages of messages take most of a build's time.
        "catkin_make install -j2 -DPYTHON_EXECUTABLE=/usr/bin/python3",
        ". devel/setup.sh && rostest rt_g det_node.test",
        ". install/setup.sh && roslaunch rt_bringup rt.launch --nodes",
        "test -x install/lib/rt_g/det && . install/setup.sh && python3 -c 'import rt_g.det_node'",
    ]
    environment["ROS_LANG_DISABLE"] = "gencpp:geneus:genlisp:gennodejs"
    said = []
    for step in steps:
        done = subprocess.run(  # noqa: S603 - the commands of the README
            ["/bin/sh", "-c", step], cwd=robot_workspace, env=environment, capture_output=True, text=True, check=False
        )
        said.append(done.stdout)
        assert done.returncode == 0, done.stdout + done.stderr
    assert set(said[2].split()) == {"/perception/det", "/user", "/idle"}
