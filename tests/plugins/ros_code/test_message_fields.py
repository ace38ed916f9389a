"""Fields that own code may name: those of messages that the project defines, and of what is in them."""

from __future__ import annotations

from pathlib import Path

from archgen.plugins.ros_code.message_fields import list_message_fields
from tests.plugins.ros_code.test_ros2_cpp import write_project
from tests.running import archgen_here

ROBOT = """\
archgen: 1
project: {id: rt, title: Robot}
ros: {distro: jazzy}
groups:
  g:
    components:
      cam: {outputs: {seen: Seen, pick: Pick}}
      arm: {inputs: {seen: cam.seen, pick: cam.pick}, node: {language: LANGUAGE}}
types:
  Seen: {fields: {spots: "Spot[]", name: string, at: geometry_msgs/msg/Point}}
  Spot: {fields: {x: float64, mark: string}}
  Pick: {request: {force: float64}, response: {done: bool}, feedback: {force: float64}}
"""
PYTHON = """\
from rt_msgs.action import Pick
from rt_msgs.msg import Seen


class Arm:
    def __init__(self, node):
        self.node = node

    def receive_seen(self, message):
        for spot in message.spots:
            self.x = spot.x
        first = message.spots[0]
        made = Seen(name='a')
        self.node.send_pick(Pick.Goal(force=1.0), feedback_callback=lambda each: each.feedback.force)
        return first.x, made.name, self.name
"""
CPP = """
void ArmBehaviour::receive_seen(rt_msgs::msg::Seen::ConstSharedPtr message)
{
  // message->name
  const rt_msgs::msg::Spot & spot = message->spots.front();
  rt_msgs::action::Pick::Goal goal;
  goal.force = spot.x + other.name;
  print(message->name);
}
"""


def test_fields_have_their_message_in_front(tmp_path: Path) -> None:
    architecture = write_project(tmp_path, ROBOT.replace("LANGUAGE", "cpp")).architecture
    fields = {
        each["name"]: each["message"] for each in list_message_fields(architecture, {"Seen", "Pick", "", "Other"})
    }
    assert fields == {
        "rt_msgs/action/Pick/Feedback.force": "",
        "rt_msgs/action/Pick/Goal.force": "",
        "rt_msgs/action/Pick/Result.done": "",
        "rt_msgs/msg/Seen.at": "",
        "rt_msgs/msg/Seen.name": "",
        "rt_msgs/msg/Seen.spots": "rt_msgs/msg/Spot",
        "rt_msgs/msg/Spot.mark": "",
        "rt_msgs/msg/Spot.x": "",
    }


def _generate(folder: Path, text: str, backend: str, status: int) -> list[str]:
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    done = archgen_here("generate", backend, "-o", "ws", cwd=folder, status=status)
    return [
        line.partition("/src/rt_g")[2] or line for line in done.stderr.decode().splitlines() if line.startswith("error")
    ]


def _tell_changes(folder: Path, backend: str, language: str, own_path: str, code: str) -> list[str]:
    robot = ROBOT.replace("LANGUAGE", language)
    _generate(folder, robot, backend, 0)
    own = folder / "ws" / "src" / own_path
    own.write_text(code if backend == "ros2_python" else own.read_text(encoding="utf-8") + CPP, encoding="utf-8")
    assert _generate(folder, robot, backend, 0) == []
    changed = robot.replace("{x: float64,", "{left: float64,").replace("name: string, ", "")
    changed = changed.replace("Pick: {request: {force", "Pick: {request: {grip")
    told = _generate(folder, changed, backend, 1)
    assert _generate(folder, changed, backend, 1) == told
    return [line.partition(": ")[2].partition(": ")[2] or line for line in told]


def test_own_code_in_python_is_told_of_fields_that_are_gone(tmp_path: Path) -> None:
    told = _tell_changes(tmp_path, "ros2_python", "python", "rt_g/rt_g/arm.py", PYTHON)
    left = "`rt_msgs/msg/Spot` has no field `x` any more; it is most likely `left` now"
    assert told == [
        left,
        "`rt_msgs/msg/Seen` has no field `name` any more",
        "`rt_msgs/action/Pick/Goal` has no field `force` any more; it is most likely `grip` now",
        left,
        "`rt_msgs/msg/Seen` has no field `name` any more",
    ]
    done = archgen_here("generate", "ros2_python", "-o", "ws", "--patch", cwd=tmp_path, status=0)
    for line in (
        "+            self.x = spot.left",
        "Pick.Goal(grip=1.0)",
        "+        return first.left, made.name, self.name",
    ):
        assert line in done.stdout.decode()


def test_own_code_in_cpp_is_told_of_fields_that_are_gone(tmp_path: Path) -> None:
    told = _tell_changes(tmp_path, "ros2_cpp", "cpp", "rt_g_cpp/src/arm_behaviour.cpp", "")
    assert told == [
        "`rt_msgs/msg/Spot` has no field `x` any more; it is most likely `left` now",
        "`rt_msgs/msg/Seen` has no field `name` any more",
    ]
