"""Fields that own code may name: those of messages that the project defines, and of what is in them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from archgen.plugins.ros_code.node_programs import list_message_fields
from tests.plugins.ros_code.test_ros2_cpp import write_project
from tests.property_sizes import try_some
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


ACTING = """\
archgen: 1
project: {id: rt, title: Robot}
ros: {distro: jazzy}
groups: {g: {components: {arm: {outputs: {pick: Pick}}, mind: {inputs: {pick: arm.pick}, outputs: {}}}}}
types: {Pick: {request: {force: float64}, response: {done: bool}, feedback: {share: float64}}}
"""
MIND = '''\
"""Mine."""


class Mind:
    def __init__(self, node):
        self.node = node

    async def start(self, goal):
        handle = await self.node.send_pick(goal, self.hear)
        later = handle.get_result_async()
        self.node.send_pick(goal, feedback_callback=lambda each: print(each.feedback.share, each.share))
        return handle.accepted, (await later).result.done, later.done()

    def hear(self, told):
        self.share = told.feedback.share
'''


def test_a_client_is_told_of_fields_of_results_and_feedback_that_are_gone(tmp_path: Path) -> None:
    _generate(tmp_path, ACTING, "ros2_python", 0)
    (tmp_path / "ws/src/rt_g/rt_g/mind.py").write_text(MIND, encoding="utf-8")
    assert _generate(tmp_path, ACTING, "ros2_python", 0) == []
    changed = ACTING.replace("done: bool", "held: bool").replace("share: float64", "part: float64")
    told = _generate(tmp_path, changed, "ros2_python", 1)
    assert [each.removeprefix("error: src/rt_g/rt_g/") for each in told] == [
        "mind.py:11:86: `rt_msgs/action/Pick/Feedback` has no field `share` any more; it is most likely `part` now",
        "mind.py:12:54: `rt_msgs/action/Pick/Result` has no field `done` any more; it is most likely `held` now",
        "mind.py:15:36: `rt_msgs/action/Pick/Feedback` has no field `share` any more; it is most likely `part` now",
    ]


def test_own_code_in_cpp_is_told_of_fields_that_are_gone(tmp_path: Path) -> None:
    told = _tell_changes(tmp_path, "ros2_cpp", "cpp", "rt_g_cpp/src/arm_behaviour.cpp", "")
    assert told == [
        "`rt_msgs/msg/Spot` has no field `x` any more; it is most likely `left` now",
        "`rt_msgs/msg/Seen` has no field `name` any more",
    ]


SERVING = """\
archgen: 1
project: {id: rt, title: Robot}
ros: {distro: jazzy}
groups:
  g:
    components:
      drill: {outputs: {set_mode: SetMode}, node: {language: LANGUAGE}}
      wheels: {inputs: {mode: drill.set_mode}, outputs: {}, node: {language: LANGUAGE}}
types:
  SetMode: {request: {mode: string}, response: {ok: bool}}
"""
ANSWERS = {
    "awaited": (
        "    async def start(self):\n        answer = await self.node.call_mode(1)\n        return answer.ok\n",
        [("9", "23")],
    ),
    "at once": ("    async def start(self):\n        return (await self.node.call_mode(1)).ok\n", [("8", "47")]),
    "future": (
        "    def start(self):\n        future = self.node.call_mode(1)\n        return future.result().ok, future.ok()\n",
        [("9", "32")],
    ),
    "future that is awaited": (
        "    async def start(self):\n        f = self.node.call_mode(1)\n        a = await f\n        return a.ok\n",
        [("10", "18")],
    ),
    "method": (
        (
            "    def start(self):\n        self.node.call_mode(1).add_done_callback(self.hear)\n\n"
            "    def hear(self, future):\n        self.ok = future.result().ok\n"
        ),
        [("11", "35")],
    ),
    "lambda": (
        (
            "    def start(self):\n        f = self.node.call_mode(1)\n"
            "        f.add_done_callback(lambda done: print(done.result().ok))\n"
        ),
        [("9", "62")],
    ),
    "future that is kept": (
        (
            "    asked = None\n\n    def start(self):\n        self.asked = self.node.call_mode(1)\n\n"
            "    def look(self):\n        if self.asked and self.asked.done():\n"
            "            self.ok = self.asked.result().ok\n            self.asked = None\n"
        ),
        [("14", "43")],
    ),
    "futures in a list": (
        (
            "        self.asked = []\n\n    def start(self):\n        self.asked.append(self.node.call_mode(1))\n\n"
            "    def look(self):\n        return [each.result().ok for each in self.asked if each.done()]\n"
        ),
        [("13", "31")],
    ),
    "futures in pairs": (
        (
            "        self.asked = deque(maxlen=3)\n\n    def start(self, row):\n"
            "        self.asked.append((row, self.node.call_mode(1)))\n\n"
            "    def look(self):\n        for row, future in list(self.asked):\n"
            "            print(row.ok, future.result().ok)\n"
        ),
        [("14", "43")],
    ),
    "futures by name": (
        (
            "        self.asked = {}\n\n    def start(self, row):\n        self.asked[row] = self.node.call_mode(1)\n\n"
            "    def look(self):\n        first = self.asked.get('a').result().ok\n"
            "        return first, {row: each.result().ok for row, each in self.asked.items()}, self.asked['b'].ok()\n"
        ),
        [("13", "46"), ("14", "43")],
    ),
    "two at once": (
        (
            "    async def start(self):\n        one, two = self.node.call_mode(1), self.node.call_mode(2)\n"
            "        return [(await each).ok for each in (one, two)] + [(await two).ok]\n"
        ),
        [("9", "30"), ("9", "72")],
    ),
    "other things in the list": (
        (
            "        self.asked = []\n\n    def start(self, other):\n        self.asked.append(self.node.call_mode(1))\n"
            "        self.asked.append(other)\n\n    def look(self):\n        return self.asked[0].result().ok\n"
        ),
        [],
    ),
    "one of two that are kept": (
        (
            "    def start(self, other):\n        self.asked = self.node.call_mode(1)\n"
            "        self.asked = other.call(1)\n        return self.asked.result().ok\n"
        ),
        [],
    ),
    "function inside": (
        (
            "    def start(self):\n        def hear(done):\n            return done.result().ok\n\n"
            "        self.node.call_mode(1).add_done_callback(hear)\n"
        ),
        [("9", "34")],
    ),
    "of others": (
        "    def start(self, other):\n        answer = other.call_it(1)\n        return answer.ok, other.result().ok\n",
        [],
    ),
}
CPP_ANSWERS = {
    "future": "auto f = node_.call_mode(r);\n  print(f.get()->ok);",
    "future that is taken": "auto f = node_.call_mode(r);\n  auto a = f.get();\n  print(a->ok);",
    "callback": "node_.call_mode(r, [this](const auto & a) {\n    print(a->ok); });",
    "typed callback": "node_.call_mode(r, [this](rt_msgs::srv::SetMode::Response::SharedPtr a) {\n    print(a->ok); });",
}


def _change_service(folder: Path, language: str, own_path: str, add_code: Callable[[str], str], new: str) -> list[str]:
    robot, backend = SERVING.replace("LANGUAGE", language), f"ros2_{language}"
    _generate(folder, robot, backend, 0)
    own = folder / "ws" / "src" / own_path
    own.write_text(add_code(own.read_text("utf-8")), encoding="utf-8")
    assert _generate(folder, robot, backend, 0) == []
    changed = robot.replace("  SetMode: {request: {mode: string}, response: {ok: bool}}", f"  SetMode: {new}")
    told = _generate(folder, changed, backend, 1)
    assert _generate(folder, changed, backend, 1) == told
    return [line for line in told if "wheels" in line]


@pytest.mark.parametrize("form", try_some(ANSWERS, 3))
def test_a_client_in_python_is_told_of_fields_of_the_answer_that_are_gone(tmp_path: Path, form: str) -> None:
    code, places = ANSWERS[form]
    text = f'"""Mine."""\n\n\nclass Wheels:\n    def __init__(self, node):\n        self.node = node\n{code}'
    if not places:
        robot = SERVING.replace("LANGUAGE", "python")
        _generate(tmp_path, robot, "ros2_python", 0)
        (tmp_path / "ws/src/rt_g/rt_g/wheels.py").write_text(text, encoding="utf-8")
        assert _generate(tmp_path, robot.replace("{ok: bool}", "{done: bool}"), "ros2_python", 0) == []
        return
    new = "{request: {mode: string}, response: {done: bool}}"
    told = _change_service(tmp_path, "python", "rt_g/rt_g/wheels.py", lambda _: text, new)
    words = "`rt_msgs/srv/SetMode/Response` has no field `ok` any more; it is most likely `done` now"
    assert told == [f"error: src/rt_g/rt_g/wheels.py:{line}:{column}: {words}" for line, column in places]


@pytest.mark.parametrize("form", CPP_ANSWERS)
def test_a_client_in_cpp_is_told_of_fields_of_the_answer_that_are_gone(tmp_path: Path, form: str) -> None:
    new = "{request: {mode: string}, response: {done: bool}}"
    own_path = "rt_g/src/wheels_behaviour.cpp"
    code = f"\nvoid start()\n{{\n  {CPP_ANSWERS[form]}\n}}\n"
    (told,) = _change_service(tmp_path, "cpp", own_path, lambda old: old + code, new)
    assert "`rt_msgs/srv/SetMode/Response` has no field `ok` any more; it is most likely `done` now" in told


@pytest.mark.parametrize("language", ["python", "cpp"])
def test_a_field_is_told_that_went_with_the_name_of_its_port(tmp_path: Path, language: str) -> None:
    """Each of the two is told until it is mended, whichever comes first."""
    robot, backend = SERVING.replace("LANGUAGE", language), f"ros2_{language}"
    _generate(tmp_path, robot, backend, 0)
    own = tmp_path / "ws/src/rt_g" / ("rt_g/wheels.py" if language == "python" else "src/wheels_behaviour.cpp")
    text, cpp_form = own.read_text("utf-8"), CPP_ANSWERS["future"]
    text += (
        "\n" + ANSWERS["future that is kept"][0] if language == "python" else f"\nvoid start()\n{{\n  {cpp_form}\n}}\n"
    )
    own.write_text(text, encoding="utf-8")
    assert _generate(tmp_path, robot, backend, 0) == []
    changed = robot.replace("{ok: bool}", "{done: bool}").replace("{mode: drill", "{shift: drill")
    told = _generate(tmp_path, changed, backend, 1)
    assert ["call_mode" in told[0], "no field `ok` any more" in told[1], len(told)] == [True, True, 2]
    own.write_text(text.replace("call_mode", "call_shift"), encoding="utf-8")
    (left,) = _generate(tmp_path, changed, backend, 1)
    assert "has no field `ok` any more; it is most likely `done` now" in left


@pytest.mark.parametrize("language", ["python", "cpp"])
def test_a_service_that_becomes_an_action_is_told_with_what_is_called_then(tmp_path: Path, language: str) -> None:
    own_path = "rt_g/rt_g/wheels.py" if language == "python" else "rt_g/src/wheels_behaviour.cpp"
    code = {
        "python": "class Wheels:\n    def __init__(self, node):\n        self.node = node\n\n    def go(self):\n        NAME(1)\n",
        "cpp": "\nvoid go()\n{\n  NAME(1);\n}\n",
    }[language]
    robot, backend = SERVING.replace("LANGUAGE", language), f"ros2_{language}"
    action = robot.replace("response: {ok: bool}", "response: {ok: bool}, feedback: {share: float64}")
    uses = (robot, "call_mode", "serve_set_mode"), (action, "send_mode", "execute_set_mode")
    for folder, ((old, use, method), (new, new_use, new_method), word) in (
        (tmp_path / "a", (*uses, "action")),
        (tmp_path / "b", (*reversed(uses), "service")),
    ):
        folder.mkdir()
        _generate(folder, old, backend, 0)
        own = folder / "ws" / "src" / own_path
        text = code.replace("NAME", f"{'self.node.' if language == 'python' else 'node_.'}{use}")
        own.write_text(text if language == "python" else own.read_text("utf-8") + text, encoding="utf-8")
        server = own.with_name(own.name.replace("wheels", "drill"))
        server.write_text(f"{server.read_text('utf-8')}\n", encoding="utf-8")
        assert _generate(folder, old, backend, 0) == []
        told = "\n".join(_generate(folder, new, backend, 1))
        assert f"`{use}`" in told
        assert f"any more: `g.wheels.mode` is {'an' if word == 'action' else 'a'} {word} now, with `{new_use}`" in told
        assert f"`{method}`" in told
        assert (
            f"any more: `g.drill.set_mode` is {'an' if word == 'action' else 'a'} {word} now, with `{new_method}`"
            in told
        )
