"""The backend `ros2_python`: what it writes is Python that people would write, and runs on a real ROS 2."""

from __future__ import annotations

import ast
import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml

from archgen import pipeline
from archgen.plugins.ros_code.node_programs import make_view
from archgen.views.generation.generation_context import GenerationContext
from tests.hostile import TEXTS
from tests.outside_tools import run_judge
from tests.property_sizes import try_some
from tests.ros_environment import NEWEST_PYTHON, interrupt_node, make_ros_python, ros_environment
from tests.running import ROOT, archgen_here

# What ament_flake8 of Jazzy has in its configuration.
AMENT_FLAKE8 = (
    "--extend-ignore=B902,C816,D100,D101,D102,D103,D104,D105,D106,D107,D203,D212,D404,I202",
    "--import-order-style=google",
    "--max-line-length=99",
)
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
        outputs: {image: Image, info: Words}
        parameters:
          rate: {type: float, value: 10, unit: Hz, range: [1, 30], description: How often.}
          mode: {choices: [fast, careful], value: careful}
          names: {value: [a, "b'c"]}
          languages: {value: [el, en], choices: [el, pl, en]}
          size: {type: integer, value: 640, range: [1, 4096], read_only: true}
          map_file: {type: string}
        timing: {rate: 10 Hz, wcet: 1 ms}
      det:
        inputs: {image: cam.image, configure: cam.info, timer: cam.info}
        outputs: {found: Words, plan: Plan, go: Fib}
      talker_node: {outputs: {words: Words}}
      user: {functionality: 'Ends in "quotes"', inputs: {go: det.go, plan: det.plan}}
      m1: {is: motor, inputs: {target: det.found}}
      m2: {is: motor, inputs: {target: det.found}, parameters: {joint: right}}
component_types:
  motor: {inputs: {target: Words}, outputs: {state: Words}, parameters: {joint: left}, node: {namespace: /arm}}
types:
  Image: sensor_msgs/msg/Image
  Words: std_msgs/msg/String
  Plan: std_srvs/srv/Trigger
  Fib: test_msgs/action/Fibonacci
nodes:
  cam: {implements: g.cam, publishes: {image: {topic: /camera/image, qos: sensor_data}}}
  det:
    implements: g.det
    kind: lifecycle
    namespace: /perception
    threads: 2
    reentrant: true
    publishes: {found: {topic: found, own_name: detections, qos: {depth: 3, deadline: 100 ms}}}
"""


def generate(folder: Path, text: str, workspace: Path, status: int = 0) -> str:
    """Generate into a workspace, and return what is said of it."""
    folder.mkdir(exist_ok=True)
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    done = archgen_here("generate", "ros2_python", "-o", workspace, "--keep-going", cwd=folder, status=status)
    return (done.stdout + done.stderr).decode()


def make_programs(folder: Path, text: str) -> tuple[dict[str, dict[str, Any]], list[str]]:
    """Return the view by executable, and what was left out."""
    folder.mkdir(exist_ok=True)
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    view = make_view(GenerationContext(pipeline.check_project(folder).architecture))
    return {each["executable"]: each for each in view.data["programs"]}, [each.message for each in view.findings]


def test_instances_of_one_type_are_one_program(tmp_path: Path) -> None:
    programs, left_out = make_programs(tmp_path, ROBOT)
    assert left_out == []
    assert list(programs) == ["cam", "det", "motor", "talker_node", "user"]
    assert (programs["talker_node"]["module"], programs["cam"]["parameters"][3]["type"]) == ("talker", "string_array")
    motor = programs["motor"]
    assert [(each["full_name"], each["remaps"]) for each in motor["nodes"]] == [
        ("/arm/m1", [{"own_name": "state", "name": "/g/m1/state"}]),
        ("/arm/m2", [{"own_name": "state", "name": "/g/m2/state"}]),
    ] or motor["nodes"]
    (target,) = motor["subscriptions"]
    assert (target["key"], target["topics"]) == ("target", {"m1": "/perception/found", "m2": "/perception/found"})
    (joint,) = motor["parameters"]
    assert (joint["name"], joint["type"], joint["default"]) == ("joint", "string", "left")


def test_what_exists_or_is_no_python_is_not_generated(tmp_path: Path) -> None:
    text = (
        "groups: {g: {components: {a: {}, b: {}, c: {}, d: {}, e: {}}}}\n"
        "nodes: {a: {implements: a, status: existing}, b: {implements: b, kind: program, command: [x]},\n"
        "        c: {implements: c, language: cpp}, d: {implements: d, kind: composable}, e: {implements: e}, f: {implements: e, status: adapted}}\n"
    )
    assert list(make_programs(tmp_path, text)[0]) == ["e"]


def test_what_cannot_be_generated_is_told(tmp_path: Path) -> None:
    text = (
        "groups: {g: {components: {a: {outputs: {x: X}, parameters: {deep: {choices: [1, a]}}}, b: {}, c: {}}}}\n"
        "nodes: {a: {implements: a}, b: {implements: b, package: p, executable: go_on}, c: {implements: c, package: p, executable: goOn},\n"
        "        d: {package: p, language: cpp}}\n"
    )
    programs, left_out = make_programs(tmp_path, text)
    assert set(programs) == {"a", "go_on", "goOn"}
    assert left_out == [
        "the package `p` has programs in Python and in C++: `b` and `d`; here it has only those in Python",
        "`g.a.x` of the node `a` is left out: nobody says which message it has",
        "the parameter `deep` of `a` is left out: no parameter of ROS can be what it is",
        "`c` and `b` give the same class `GoOn`",
    ]


def test_a_message_that_no_class_can_be_is_told(tmp_path: Path) -> None:
    text = (
        "groups: {g: {components: {a: {outputs: {x: X, y: Y}}}}}\n"
        "types: {X: {message: m_msgs/msg/None, status: planned}, Y: std_msgs/msg/String}\n"
    )
    programs, left_out = make_programs(tmp_path, text)
    assert [each["key"] for each in programs["a"]["publishers"]] == ["y"]
    assert left_out == ["`g.a.x` of the node `a` is left out: no class can be called as its message `m_msgs/msg/None`"]


def test_messages_of_one_name_are_told_apart(tmp_path: Path) -> None:
    text = (
        "groups: {g: {components: {a: {outputs: {x: X, y: Y}}}}}\n"
        "types: {X: std_msgs/msg/String, Y: {message: own_msgs/msg/String, status: planned}}\n"
    )
    generate(tmp_path / "p", text, tmp_path / "w")
    (node,) = (tmp_path / "w").rglob("a_node.py")
    assert "from own_msgs.msg import String as OwnMsgsMsgString\n" in node.read_text()
    assert "from std_msgs.msg import String as StdMsgsMsgString\n" in node.read_text()


# What waits, is called, and has what was sent before it was active.
WAITING = ROBOT.replace(
    "inputs: {image: cam.image, configure",
    "inputs: {image: cam.image, ask: talker_node.ask, send: talker_node.send, configure",
)
WAITING = WAITING.replace("{words: Words}", "{words: Words, ask: Plan, send: Fib}").replace(
    "qos: sensor_data", "qos: {durability: transient_local}"
)
WAITING = WAITING.replace(
    "    reentrant: true\n",
    "    subscribes: {image: {qos: {durability: transient_local}}}\n    timing: {rate: 10 Hz, wcet: 1 ms}\n",
)


@pytest.mark.parametrize("text", try_some([ROBOT, WAITING], 1), ids=["reentrant", "waiting"])
def test_it_is_written_as_ros_developers_write(text: str, tmp_path: Path) -> None:
    generate(tmp_path / "p", text, tmp_path / "w")
    command = [sys.executable, "-m", "flake8", "--isolated", "--jobs=1", *AMENT_FLAKE8, str(tmp_path / "w")]
    done = run_judge(*command)
    assert done.stdout == ""


def test_own_code_is_asked_for_what_the_model_gained(tmp_path: Path) -> None:
    generate(tmp_path / "p", ROBOT, tmp_path / "w")
    own = tmp_path / "w" / "src" / "rt_g" / "rt_g" / "det.py"
    own.write_text(own.read_text().replace("receive_image", "take_picture"))
    assert "receive_image" in generate(tmp_path / "p", ROBOT, tmp_path / "w", 1)
    assert "take_picture" in own.read_text()


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)
def test_no_text_breaks_out(text: str, tmp_path: Path) -> None:
    project = {
        "archgen": 1,
        "project": {"id": "p", "title": text},
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
    generate(tmp_path / "p", yaml.safe_dump(project, allow_unicode=True), tmp_path / "w")
    files = list((tmp_path / "w").rglob("*.py"))
    assert len(files) == 7
    for file in files:
        tree = ast.parse(file.read_text(encoding="utf-8"))
        names = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
        assert not names & {"alert", "cmd", "N", "T"}, file


@pytest.fixture
def ros_python() -> Path:
    if sys.version_info[:2] > NEWEST_PYTHON or sys.platform != "linux":
        pytest.skip(f"there is no ROS 2 for {sys.platform} and Python {sys.version.split()[0]}")
    return make_ros_python()


@pytest.mark.ros
def test_the_graph_is_what_the_model_says(ros_python: Path, tmp_path: Path) -> None:
    """Each node runs in a process of its own; another process reads the graph, which holds nothing but the model."""
    generate(tmp_path / "p", ROBOT, tmp_path / "w")
    archgen_here("generate", "ros2_launch", "-o", tmp_path / "w", "--keep-going", cwd=tmp_path / "p")
    package = tmp_path / "w" / "src" / "rt_g"
    environment = ros_environment(61, tmp_path) | {"PYTHONPATH": str(package)}
    tests = [str(ros_python), "-m", "pytest", "-q", "-p", "no:cacheprovider", str(package / "test")]
    done = run_judge(*tests, env=environment)
    assert re.search(r"\b20 passed", done.stdout)

    programs, _ = make_programs(tmp_path / "p", ROBOT)
    processes: list[subprocess.Popen[bytes]] = []
    expected: dict[str, dict[str, set[tuple[str, str]]]] = {}
    try:
        for program in programs.values():
            for node in program["nodes"]:
                words = ["-r", f"__node:={node['name']}", "-r", f"__ns:={node['namespace']}"]
                for remap in node["remaps"]:
                    words += ["-r", f"{remap['own_name']}:={remap['name']}"]
                values = tmp_path / "w" / "src" / "rt_bringup" / "config" / f"{node['id']}.yaml"
                words += ["--params-file", str(values)] if values.exists() else []
                module = f"import sys; from rt_g.{program['module']}_node import main; main(sys.argv)"
                processes.append(
                    subprocess.Popen([str(ros_python), "-c", module, "--ros-args", *words], env=environment)  # noqa: S603
                )
                expected[node["full_name"]] = list_expected(program, node["id"])
        judge = [str(ros_python), str(ROOT / "tests" / "plugins" / "ros_code" / "graph_judge.py"), *expected]
        done = run_judge(*judge, env=environment)
        observed = json.loads(done.stdout.splitlines()[-1])
    finally:
        statuses = [interrupt_node(process) for process in processes]
    assert statuses == [0] * len(processes)
    assert set(observed["graph"]) == set(expected)
    for name, uses in observed["graph"].items():
        for use, topics in uses.items():
            assert {(topic, type_name) for topic, type_name in topics if not is_ros_own(topic, name)} == expected[name][
                use
            ], (name, use)
    assert observed["qualities"]["/camera/image"] == [["cam", "BEST_EFFORT", "VOLATILE"]]


@pytest.mark.ros
def test_a_program_whose_class_lacks_a_method_does_not_start_and_others_hear_of_parameters(
    ros_python: Path, tmp_path: Path
) -> None:
    generate(tmp_path / "p", ROBOT, tmp_path / "w")
    package = tmp_path / "w" / "src" / "rt_g"
    environment = ros_environment(64, tmp_path) | {"PYTHONPATH": str(package)}
    cam, det = (package / "rt_g" / f"{name}.py" for name in ("cam", "det"))
    det.write_text(det.read_text().replace("receive_image", "take_picture"), encoding="utf-8")
    run = [
        str(ros_python),
        "-c",
        "import sys; from rt_g.det_node import DetNode, main, rclpy; rclpy.init();DetNode().on_configure(None)",
    ]
    done = subprocess.run(run, env=environment, capture_output=True, text=True, check=False, timeout=120)  # noqa: S603
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1] == "/det does not start: Det in det.py lacks receive_image"
    assert "Traceback" not in done.stderr
    cam.write_text(
        f"{cam.read_text()}\n    def on_parameters(self, values):\n        print(values)\n", encoding="utf-8"
    )
    code = (
        "import rclpy; from rclpy.parameter import Parameter; from rt_g.cam_node import CamNode; rclpy.init(); node = CamNode();"
        "node.set_parameters([Parameter('rate', value=12.0), Parameter('mode', value='wrong')])"
    )
    assert run_judge(str(ros_python), "-c", code, env=environment).stdout == "{'rate': 12.0}\n"


def list_expected(program: dict[str, Any], node_id: str) -> dict[str, set[tuple[str, str]]]:
    """Return what a node has in the model. One that waits to be configured has nothing yet."""
    uses = {"publishes": "publishers", "subscribes": "subscriptions", "serves": "services", "calls": "clients"}
    sections = {
        use: set[tuple[str, str]]()
        if program["is_lifecycle"]
        else {(port["topics"][node_id], port["message"]) for port in program[section]}
        for use, section in uses.items()
    }
    if not program["is_lifecycle"]:
        # What a client of an action subscribes to and calls, its server publishes and serves.
        for section, listens, asks in (
            ("action_clients", "subscribes", "calls"),
            ("action_servers", "publishes", "serves"),
        ):
            for port in program[section]:
                name, message = port["topics"][node_id], port["message"]
                sections[listens] |= {
                    (f"{name}/_action/feedback", f"{message}_FeedbackMessage"),
                    (f"{name}/_action/status", "action_msgs/msg/GoalStatusArray"),
                }
                sections[asks] |= {
                    (f"{name}/_action/send_goal", f"{message}_SendGoal"),
                    (f"{name}/_action/get_result", f"{message}_GetResult"),
                    (f"{name}/_action/cancel_goal", "action_msgs/srv/CancelGoal"),
                }
    return sections


def is_ros_own(topic: str, node: str) -> bool:
    """Whether ROS itself gives every node this topic or service, or each with a life cycle."""
    parameter_services = "describe_parameters get_parameter_types get_parameters list_parameters set_parameters"
    own = [*parameter_services.split(), "set_parameters_atomically", "get_type_description"]
    cycle = ["change_state", "get_state", "get_available_states", "get_available_transitions", "get_transition_graph"]
    return topic in {"/rosout", "/parameter_events", "/clock"} or topic in {
        f"{node}/{name}" for name in (*own, *cycle, "transition_event")
    }


def test_what_nobody_wrote_yet_reports_no_success(tmp_path: Path) -> None:
    generate(tmp_path / "p", ROBOT, tmp_path / "w")
    (behaviour,) = (file.read_text() for file in (tmp_path / "w").rglob("det.py"))
    assert "goal_handle.abort()" in behaviour
    assert ".succeed()" not in behaviour
    assert "execute_go is not written yet: its goals are aborted" in behaviour
    assert "serve_plan is not written yet: its answers say nothing" in behaviour
