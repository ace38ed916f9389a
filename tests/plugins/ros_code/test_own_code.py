"""Own code is told what a change of the model means to it, with file and line, until it fits; and nothing where it fits."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

from tests.property_sizes import try_some
from tests.repositories import git
from tests.running import archgen_here

ROBOT = """\
archgen: 1
project: {id: farm, title: Farm}
ros: {distro: jazzy}
types:
  Battery: std_msgs/msg/Float32
  Stop: std_msgs/msg/Bool
  State: sensor_msgs/msg/JointState
component_types:
  filter: {inputs: {raw: Battery}, outputs: {smooth: Battery}}
groups:
  arms:
    components:
      left: {outputs: {state: State, fruit: Stop}}
      right: {outputs: {state: State}}
      smooth_left: {is: filter, inputs: {raw: base.wheels.battery}}
      smooth_right: {is: filter, inputs: {raw: base.wheels.battery}}
  base:
    components:
      wheels: {inputs: {stop: guard.stop}, outputs: {battery: Battery}, timing: {rate: 20 Hz}}
      guard:
        inputs: {battery: wheels.battery, fruits: arms.left.fruit, arms: [arms.left.state]}
        outputs: {stop: Stop, reset: std_srvs/srv/Trigger}
        parameters: {lowest: 0.2}
      guide: {inputs: {reset: guard.reset}, outputs: {}, timing: {rate: 10 Hz}}
"""
GUARD = '''\
"""Mine."""
from std_msgs.msg import Bool


class Guard:
    def __init__(self, node):
        self.node = node
        self.arm = None

    def receive_battery(self, message):
        if message.data < self.node.get_parameter('lowest').value:
            self.stop()

    def receive_fruits(self, message):
        self.last = message

    def receive_arms(self, message):
        self.arm = message

    def serve_reset(self, request, response):
        return response

    def stop(self):
        self.node.publish_stop(Bool(data=True))
'''
GUIDE = """\
from std_srvs.srv import Trigger


class Guide:
    def __init__(self, robot):
        self.robot = robot

    def on_timer(self):
        self.robot.call_reset(Trigger.Request())
"""
FILTER = """\
class Filter:
    def __init__(self, node):
        self.node = node

    def receive_raw(self, message):
        self.node.publish_smooth(message)
"""
FILES = {"base/guard": GUARD, "base/guide": GUIDE, "arms/filter": FILTER}
Farm = Callable[..., list[str]]


def find_own(folder: Path, name: str, backend: str) -> Path:
    group, _, module = name.partition("/")
    inner = f"farm_{group}" if backend == "ros2_python" else f"src/farm_{group}"
    return folder / "ws" / "src" / f"farm_{group}" / inner / f"{module}.py"


def generate(folder: Path, backend: str, robot: str, status: int, *more: str) -> list[str]:
    """Return what is said, without the counts."""
    text = robot.replace("jazzy", "noetic") if backend == "ros1_python" else robot
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    done = archgen_here("generate", backend, "-o", "ws", *more, cwd=folder, status=status)
    said = done.stderr.decode()
    lines = [
        line.replace("src/farm_", "").replace("src/", "").replace("base/farm_", "").replace("base/base/", "base/")
        for line in said.splitlines()
    ]
    return [line for line in lines if line.startswith(("error: ", "note: ", "warning: "))]


@pytest.fixture(params=try_some(["ros2_python", "ros1_python"]))
def backend(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def make_farm(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """Make a workspace with own code for all nodes, that fits, once for each backend."""

    @cache
    def make(backend: str) -> Path:
        folder = tmp_path_factory.mktemp("farm")
        generate(folder, backend, ROBOT, 0)
        for name, text in FILES.items():
            find_own(folder, name, backend).write_text(text, encoding="utf-8")
        assert generate(folder, backend, ROBOT, 0) == []
        return folder

    return make


@pytest.fixture
def farm(tmp_path: Path, backend: str, make_farm: Callable[[str], Path]) -> Path:
    """Return a folder with such a workspace for one test."""
    shutil.copytree(make_farm(backend), tmp_path, dirs_exist_ok=True)
    return tmp_path


CHANGES = {
    "an output is renamed": (
        [("outputs: {stop: Stop", "outputs: {halt: Stop"), ("guard.stop", "guard.halt")],
        "base/guard",
        ["24:9: the node has no `publish_stop` any more; it is most likely `publish_halt` now"],
        [("publish_stop", "publish_halt")],
    ),
    "an input is removed": (
        [(", fruits: arms.left.fruit", "")],
        "base/guard",
        ["14:5: nobody calls `receive_fruits` any more: the model has no `base.guard.fruits` for it"],
        [("receive_fruits", "_receive_fruits")],
    ),
    "an action is added": (
        [("reset: std_srvs", "calibrate: test_msgs/action/Fibonacci, reset: std_srvs")],
        "base/guard",
        ["5:1: `Guard` lacks `execute_calibrate`, which is called for `base.guard.calibrate`"],
        [("    def stop", "    def execute_calibrate(self, *goal):\n        pass\n\n    def stop")],
    ),
    "a message is another one": (
        [("  Battery: std_msgs/msg/Float32", "  Battery: sensor_msgs/msg/BatteryState")],
        "base/guard",
        [
            (
                "10:5: `receive_battery` has `sensor_msgs/msg/BatteryState` now, and had `std_msgs/msg/Float32`:"
                " what is written here was written for that"
            )
        ],
        [("message.data <", "message.percentage <")],
    ),
    "a sent message is another one": (
        [("  Stop: std_msgs/msg/Bool", "  Stop: std_msgs/msg/UInt8"), (", fruits: arms.left.fruit", "")],
        "base/guard",
        [
            "14:5: nobody calls `receive_fruits` any more: the model has no `base.guard.fruits` for it",
            "24:9: `publish_stop` has `std_msgs/msg/UInt8` now, and not `std_msgs/Bool`",
        ],
        [("import Bool", "import UInt8"), ("Bool(data=True)", "UInt8(data=1)"), ("receive_fruits", "_fruits")],
    ),
    "an input of a component type is renamed": (
        [("inputs: {raw: Battery}", "inputs: {value: Battery}"), ("{raw: base", "{value: base")],
        "arms/filter",
        [
            (
                "5:5: nobody calls `receive_raw` any more; it is most likely `receive_value` now"
                " (`filter.value`, not `filter.raw`), which is lacking"
            )
        ],
        [("receive_raw", "receive_value")],
    ),
    "a rate is taken away": (
        [("outputs: {}, timing: {rate: 10 Hz}", "outputs: {}")],
        "base/guide",
        ["8:5: nobody calls `on_timer` any more: the model gives it no rate, so nothing happens by the clock"],
        [("on_timer", "work")],
    ),
    "a second source is added": (
        [("arms: [arms.left.state]", "arms: [arms.left.state, arms.right.state]")],
        "base/guard",
        [
            "5:1: `Guard` lacks `receive_arms_right`, which is called for `base.guard.arms`",
            "17:5: nobody calls `receive_arms` any more; it is most likely `receive_arms_left` now, which is lacking",
        ],
        [("def receive_arms(", "def receive_arms_right(self, message):\n        pass\n\n    def receive_arms_left(")],
    ),
    "a parameter is renamed": (
        [("parameters: {lowest: 0.2}", "parameters: {lowest_charge: 0.2}")],
        "base/guard",
        ["11:51: the node has no parameter `lowest` any more; it is most likely `lowest_charge` now"],
        [("'lowest'", "'lowest_charge'")],
    ),
    "a parameter is another thing": (
        [("parameters: {lowest: 0.2}", "parameters: {lowest: low}")],
        "base/guard",
        [("11:51: `lowest` is `string` now, and was `double`: what is written here was written for that")],
        [("message.data <", "message.data + 1 <")],
    ),
    "an output is gone": (
        [
            ("stop: Stop, reset", "reset"),
            ("inputs: {stop: guard.stop}, outputs: {battery", "inputs: {}, outputs: {battery"),
        ],
        "base/guard",
        ["24:9: the node has no `publish_stop` any more"],
        [("self.node.publish_stop(Bool(data=True))", "return")],
    ),
    "a service becomes a topic": (
        [("reset: std_srvs/srv/Trigger", "reset: Stop")],
        "base/guide",
        [
            "4:1: `Guide` lacks `receive_reset`, which is called for `base.guide.reset`",
            "9:9: the node has no `call_reset` any more",
        ],
        [
            ("call_reset(Trigger.Request())", "get_name()"),
            ("    def on_timer", "    def receive_reset(self, message):\n        pass\n\n    def on_timer"),
        ],
    ),
    "a second component comes into the node": (
        [
            (
                "outputs: {}, timing: {rate: 10 Hz}}",
                "outputs: {}, timing: {rate: 10 Hz}}\n      aid: {outputs: {}, timing: {rate: 1 Hz}}\nnodes:\n  guide: {implements: [base.guide, base.aid]}",
            )
        ],
        "base/guide",
        [
            "4:1: `Guide` lacks `on_timer_aid`, which is called for `base.aid`",
            "8:5: nobody calls `on_timer` any more; it is most likely `on_timer_guide` now, which is lacking",
        ],
        [("def on_timer(self)", "def on_timer_aid(self):\n        pass\n\n    def on_timer_guide(self)")],
    ),
    "a service is another one": (
        [("reset: std_srvs/srv/Trigger", "reset: std_srvs/srv/SetBool")],
        "base/guide",
        ["9:9: `call_reset` has `std_srvs/srv/SetBool` now, and not `std_srvs/Trigger`"],
        [("Trigger", "SetBool")],
    ),
}
TOLD_ELSEWHERE = frozenset(
    {
        "a message is another one",
        "a sent message is another one",
        "a service is another one",
        "a service becomes a topic",
    }
)
"""Changes that other files have to be mended for, too."""


@pytest.mark.parametrize("change", try_some(CHANGES, 5))
def test_each_change_is_told_with_its_line_until_own_code_fits(farm: Path, backend: str, change: str) -> None:
    edits, name, expected, mends = CHANGES[change]
    robot = ROBOT
    for old, new in edits:
        assert old in robot
        robot = robot.replace(old, new)
    own = find_own(farm, name, backend)
    text = own.read_text(encoding="utf-8")
    for _ in range(3):
        said = [line for line in generate(farm, backend, robot, 1) if f"{name.partition('/')[2]}.py" in line]
        assert [line.partition(".py:")[2] for line in said] == expected
        assert own.read_text(encoding="utf-8") == text
    for old, new in mends:
        assert old in text
        text = text.replace(old, new)
    own.write_text(text, encoding="utf-8")
    left = [line for line in generate(farm, backend, robot, int(change in TOLD_ELSEWHERE)) if own.name in line]
    assert left == []


@pytest.mark.parametrize(
    "change", ["an output is renamed", "an input of a component type is renamed", "a parameter is renamed"]
)
def test_a_patch_gives_own_code_its_likely_names(farm: Path, backend: str, change: str) -> None:
    edits, name, _, mends = CHANGES[change]
    robot = ROBOT
    for old, new in edits:
        robot = robot.replace(old, new)
    own = find_own(farm, name, backend)
    text = own.read_text(encoding="utf-8")
    (farm / "archgen.yaml").write_text(
        robot.replace("jazzy", "noetic") if backend == "ros1_python" else robot, encoding="utf-8"
    )
    patch = archgen_here("generate", backend, "-o", "ws", "--patch", cwd=farm, status=0).stdout
    assert own.read_text(encoding="utf-8") == text
    # Its paths are those of the workspace.
    git(farm / "ws", "apply", "-", stdin=patch)
    for old, new in mends:
        text = text.replace(old, new)
    assert own.read_text(encoding="utf-8") == text


def change(text: str, *edits: tuple[str, str]) -> str:
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    return text


def test_a_method_that_hears_another_sensor_is_told(farm: Path, backend: str) -> None:
    """Nodes of one program on other topics share its methods, and a source may be another one under the same last word."""
    two = ("arms: [arms.left.state]", "arms: [arms.left.state, arms.right.state]")
    own = find_own(farm, "base/guard", backend)
    own.write_text(
        GUARD.replace("receive_arms", "receive_arms_left")
        + "\n    def receive_arms_right(self, message):\n        pass\n",
        encoding="utf-8",
    )
    assert generate(farm, backend, change(ROBOT, two), 0) == []
    moved = change(
        ROBOT,
        ("[arms.left.state]", "[legs.left.state, arms.right.state]"),
        ("groups:\n", "groups:\n  legs: {components: {left: {outputs: {state: State}}}}\n"),
    )
    (told,) = [line for line in generate(farm, backend, moved, 1) if "guard.py" in line]
    assert told.endswith(
        "guard.py:17:5: `receive_arms_left` hears `legs.left.state` now, and heard `arms.left.state`: what is written here"
        " was written for that"
    )
    own.write_text(own.read_text().replace("self.arm = message", "self.leg = message"), encoding="utf-8")
    assert generate(farm, backend, moved, 0) == []


def test_annotations_count(farm: Path, backend: str) -> None:
    """What a method says of its message is held against the model, whatever it was before."""
    own = find_own(farm, "base/guard", backend)
    own.write_text(
        change(GUARD, ("receive_battery(self, message)", "receive_battery(self, message: 'std_msgs.msg.UInt8')")),
        encoding="utf-8",
    )
    (told,) = generate(farm, backend, ROBOT, 1)
    assert told.endswith("guard.py:10:5: `receive_battery` has `std_msgs/msg/Float32` now, and not `std_msgs/UInt8`")
    right = change(GUARD, ("receive_battery(self, message)", "receive_battery(self, message: 'std_msgs.msg.Float32')"))
    own.write_text(right, encoding="utf-8")
    assert generate(farm, backend, ROBOT, 0) == []


def test_a_message_that_an_annotation_names_is_told_once(farm: Path, backend: str) -> None:
    """Of a method of one of several sources both are known: what it was, and what is written at it."""
    two = ("arms: [arms.left.state]", "arms: [arms.left.state, arms.right.state]")
    methods = "".join(
        f"    def receive_arms_{side}(self, message: 'sensor_msgs.msg.JointState'):\n        pass\n\n"
        for side in ("left", "right")
    )
    own = GUARD.replace("    def receive_arms(", f"{methods}    def hear_arms(")
    find_own(farm, "base/guard", backend).write_text(own, encoding="utf-8")
    assert generate(farm, backend, change(ROBOT, two), 0) == []
    changed = change(ROBOT, two, ("State: sensor_msgs/msg/JointState", "State: std_msgs/msg/Float64"))
    told = [line.partition("guard.py:")[2] for line in generate(farm, backend, changed, 1) if "guard.py" in line]
    assert [line.partition(": ")[2] for line in told] == [
        f"`receive_arms_{side}` has `std_msgs/msg/Float64` now, and not `sensor_msgs/JointState`"
        for side in ("left", "right")
    ]


ODD = {
    "no Python": ("def broken(:\n", 1, ["error: guard.py:1:1: cannot be held against the model: it is no Python"]),
    "deep": ("x = " + "(" * 5000, 1, ["error: guard.py:1:1: cannot be held against the model: it is"]),
    "no text": ("x = 'a\0b'", 1, ["error: guard.py:1:1: cannot be held against the model: it is no"]),
    "computed": (
        change(GUARD, ("self.node.publish_stop(Bool(data=True))", "getattr(self.node, 'publish_' + 'stop')(1)")),
        0,
        ["note: guard.py:24:9: `getattr(self.node, 'publish_' + 'stop')` computes a name: archgen cannot see"],
    ),
    "named as text": (
        change(GUARD, ("self.node.publish_stop(Bool(data=True))", "getattr(self.node, 'publish_halt')(1)")),
        1,
        ["error: guard.py:24:28: the node has no `publish_halt`"],
    ),
    "another's base": (
        change(
            GUARD,
            ("class Guard:", "class Guard(Base):"),
            ("    def receive_arms(self, message)", "    def other(self, message)"),
        ),
        0,
        ["note: guard.py:5:1: `Base`, of another file, has to define receive_arms: `Guard` does not"],
    ),
    "an alias": (
        change(
            GUARD, ("self.node.publish_stop(Bool(data=True))", "robot = self.node\n        robot.publish_stopp(Bool())")
        ),
        1,
        ["error: guard.py:25:9: the node has no `publish_stopp`; it is most likely `publish_stop` now"],
    ),
    "own helpers": (
        change(
            GUARD,
            ("    def stop(self):", "    def receive_more(self):\n        return self.send_it\n\n    def stop(self):"),
        ),
        0,
        [],
    ),
}


@pytest.mark.parametrize("kind", ODD)
def test_odd_code_is_told_and_stays(farm: Path, backend: str, kind: str) -> None:
    text, status, expected = ODD[kind]
    own = find_own(farm, "base/guard", backend)
    own.write_text(text, encoding="utf-8")
    said = generate(farm, backend, ROBOT, status)
    told = [line.replace("base/guard.py", "guard.py") for line in said]
    assert [line[: len(each)] for line, each in zip(told, expected, strict=True)] == expected
    assert own.read_text(encoding="utf-8") == text
    checked = archgen_here("generate", backend, "-o", "ws", "--check", cwd=farm, status=status)
    assert checked.stdout == b""


def test_what_changed_is_stale_and_own_code_is_told_by_a_check(farm: Path, backend: str) -> None:
    renamed = change(ROBOT, ("outputs: {stop: Stop", "outputs: {halt: Stop"), ("guard.stop", "guard.halt"))
    for _ in range(2):  # a check remembers nothing
        said = generate(farm, backend, renamed, 1, "--check")
        assert [line.partition(".py:")[2] for line in said] == CHANGES["an output is renamed"][2]
    checked = archgen_here("generate", backend, "-o", "ws", "--check", cwd=farm, status=1).stdout.decode()
    assert "guard_node.py (it is not as the model says)" in checked


def test_what_was_deleted_is_written_again(farm: Path, backend: str) -> None:
    find_own(farm, "base/guard", backend).unlink()
    (told,) = generate(farm, backend, ROBOT, 0)
    assert told.endswith("guard.py: it was gone, and is written anew: an empty one")
    assert generate(farm, backend, ROBOT, 0) == []


def test_a_component_that_is_renamed_names_the_file_that_becomes_the_other(farm: Path, backend: str) -> None:
    renamed = ROBOT.replace("guard", "warden")
    # Until somebody writes into the new one.
    for _ in range(2):
        said = generate(farm, backend, renamed, 1)
        assert any(
            "guard.py:1:1: nothing that is generated needs it any more; it may become " in line
            and "warden.py, which is empty" in line
            for line in said
        )
    find_own(farm, "base/guard", backend).rename(find_own(farm, "base/warden", backend))
    assert not any("it may become" in line for line in generate(farm, backend, renamed, 0))


CPP_HALT = change(ROBOT, ("outputs: {stop: Stop", "outputs: {halt: Stop"), ("guard.stop", "guard.halt"))


JOINED = """
nodes:
  both: {implements: [base.wheels, base.guard], package: farm_base, executable: wheels}
"""


def test_own_code_of_a_node_that_becomes_one_with_another_is_told(farm: Path, backend: str) -> None:
    said = generate(farm, backend, ROBOT + JOINED, 1)
    assert any("base/guard.py: nothing that is generated needs it any more: " in line for line in said), said
    assert any(line.endswith("wheels.py has its ports now") for line in said), said


def test_words_of_cpp_are_told_with_their_line(tmp_path: Path) -> None:
    nodes = "nodes: {guard: {implements: guard, language: cpp, package: farm_cpp}}\n"
    robot = f"{ROBOT}{nodes}"
    generate(tmp_path, "ros2_cpp", robot, 0)
    own = tmp_path / "ws" / "src" / "farm_cpp" / "src" / "guard_behaviour.cpp"
    text = own.read_text(encoding="utf-8") + "// publish_stop\nvoid f() { node_.publish_stop(message); }\n"
    own.write_text(text, encoding="utf-8")
    assert generate(tmp_path, "ros2_cpp", robot, 0) == []
    count = text.count("\n")
    renamed = f"{CPP_HALT}{nodes}"
    (told,) = generate(tmp_path, "ros2_cpp", renamed, 1)
    assert told.endswith(
        f"guard_behaviour.cpp:{count}:18: `publish_stop` is nothing that is generated any more; it is most likely `publish_halt` now"
    )
    lacking = change(renamed, (", fruits: arms.left.fruit", ", seen: arms.left.fruit"))
    assert any(
        "receive_fruits` is nothing that is generated any more; it is most likely `receive_seen`" in line
        for line in generate(tmp_path, "ros2_cpp", lacking, 1)
    )


@pytest.mark.judges
def test_a_type_checker_says_the_same(farm: Path, backend: str) -> None:
    own = find_own(farm, "base/guard", backend)
    own.unlink()
    generate(farm, backend, ROBOT, 0)
    text = own.read_text(encoding="utf-8")
    own.write_text(
        f"{text}\n    def stop(self) -> None:\n        self.node.publish_stopp(True)\n".replace(
            "receive_battery", "receive_power"
        ),
        encoding="utf-8",
    )
    home = own.parent.parent
    user = home / "user.py"
    user.write_text(
        "from farm_base.guard import Guard\nfrom farm_base.guard_contract import GuardBehaviour, GuardFakeNode\n"
        "behaviour: GuardBehaviour = Guard(GuardFakeNode())\n",
        encoding="utf-8",
    )
    command = [sys.executable, "-m", "mypy", "--ignore-missing-imports", "--no-incremental", user.name]
    done = subprocess.run(command, cwd=home, capture_output=True, text=True, check=False)  # noqa: S603
    assert '"GuardPorts" has no attribute "publish_stopp"; maybe "publish_stop"?' in done.stdout
    assert '"Guard" is missing following "GuardBehaviour" protocol member:' in done.stdout
    assert "    receive_battery" in done.stdout or "note:     receive_battery" in done.stdout
    assert done.stdout.strip().endswith("Found 2 errors in 2 files (checked 1 source file)"), done.stdout


def test_own_code_is_tried_without_ros(farm: Path, backend: str) -> None:
    text = change(GUARD, ("from std_msgs.msg import Bool\n", "Bool = dict\n"))
    if backend == "ros1_python":
        text = change(text, ("get_parameter('lowest').value", "parameters['lowest']"))
    find_own(farm, "base/guard", backend).write_text(text, encoding="utf-8")
    code = (
        "from farm_base.guard import Guard; from farm_base.guard_contract import GuardFakeNode; from types import SimpleNamespace as S;"
        "node = GuardFakeNode(lowest=0.5); Guard(node).receive_battery(S(data=0.4)); print(node.sent)"
    )
    home = find_own(farm, "base/guard", backend).parent.parent
    done = subprocess.run([sys.executable, "-c", code], cwd=home, capture_output=True, text=True, check=True)  # noqa: S603
    assert done.stdout == "[('stop', {'data': True})]\n"


def test_a_component_that_moves_to_another_group_takes_its_file_along(farm: Path, backend: str) -> None:
    guide = "      guide: {inputs: {reset: guard.reset}, outputs: {}, timing: {rate: 10 Hz}}\n"
    moved = change(
        ROBOT,
        (guide, ""),
        ("  base:\n", f"  head:\n    components:\n{guide}  base:\n"),
        ("reset: guard.reset", "reset: base.guard.reset"),
    )
    said = generate(farm, backend, moved, 1)
    assert any(
        "guide.py:1:1: nothing that is generated needs it any more; it may become " in line and "head" in line
        for line in said
    )


def test_other_files_of_the_package_are_told_of_what_the_node_had(farm: Path, backend: str) -> None:
    own = find_own(farm, "base/guard", backend)
    own.write_text(
        change(GUARD, ("self.node.publish_stop(Bool(data=True))", "brakes.pull(self.node)")), encoding="utf-8"
    )
    helper = own.parent / "brakes.py"
    helper.write_text("def pull(node):\n    node.publish_stop(True)\n    node.publish_other(1)\n", encoding="utf-8")
    assert generate(farm, backend, ROBOT, 0) == []
    for _ in range(2):
        (told,) = generate(farm, backend, change(ROBOT, *CHANGES["an output is renamed"][0]), 1)
        assert told.endswith(
            "brakes.py:2:5: the node of `Guard` has no `publish_stop` any more; it is most likely `publish_halt` now"
        )
    helper.write_text("def pull(node):\n    node.publish_halt(True)\n", encoding="utf-8")
    assert generate(farm, backend, change(ROBOT, *CHANGES["an output is renamed"][0]), 0) == []


def _read_all(folder: Path) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def test_own_code_follows_a_project_that_gets_another_id(tmp_path: Path) -> None:
    generate(tmp_path, "ros2_python", ROBOT, 0)
    guard = find_own(tmp_path, "base/guard", "ros2_python")
    guard.write_text(GUARD, encoding="utf-8")
    renamed = ROBOT.replace("id: farm", "id: ranch")
    (tmp_path / "archgen.yaml").write_text(renamed, encoding="utf-8")
    before = _read_all(tmp_path)
    for more in ([], ["--check"], ["--was", "frm"]):
        said = archgen_here("generate", "ros2_python", "-o", "ws", *more, cwd=tmp_path, status=1).stderr.decode()
        assert "archgen.yaml:2:" in said
        assert "that was made for the project `farm`: `ranch` would begin it anew beside it" in said
        assert before == _read_all(tmp_path)
    lines = generate(tmp_path, "ros2_python", renamed, 1, "--was", "farm")
    assert any("it may become ranch_base/ranch_base/guard.py, which is empty" in line for line in lines), lines
    assert [each.name for each in sorted((tmp_path / "ws" / "src").glob("farm_*"))] == ["farm_base"]
    guard.rename(tmp_path / "ws" / "src" / "ranch_base" / "ranch_base" / "guard.py")
    assert generate(tmp_path, "ros2_python", renamed, 0) == []
    assert not list((tmp_path / "ws" / "src" / "farm_base").rglob("*.py"))


def test_a_former_id_for_which_nothing_was_made_is_told(tmp_path: Path) -> None:
    generate(tmp_path, "ros2_python", ROBOT, 0)
    words = ("generate", "ros2_python", "-o", "ws", "--was")
    said = archgen_here(*words, "frm", cwd=tmp_path, status=0).stderr.decode()
    assert "nothing that `ros2_python` made in ws was made for `frm`: `--was` changes nothing of it" in said
    assert "did you mean `farm`?" in said
    assert "was made for" not in archgen_here(*words, "farm", cwd=tmp_path, status=0).stderr.decode()


def test_two_projects_of_one_shape_share_a_workspace(tmp_path: Path) -> None:
    generate(tmp_path, "ros2_python", ROBOT, 0)
    guard = find_own(tmp_path, "base/guard", "ros2_python")
    guard.write_text(GUARD, encoding="utf-8")
    other = ROBOT.replace("id: farm", "id: ranch")
    generate(tmp_path, "ros2_python", other, 0, "--was", "ranch")
    for robot in (other, ROBOT):
        assert generate(tmp_path, "ros2_python", robot, 0) == []
    assert guard.read_text("utf-8") == GUARD


RIG = """\
archgen: 1
project: {id: rt, title: Robot}
ros: {distro: jazzy}
generate: {into: ws, backends: {ros_interfaces: {}, ros2_python: {}, ros2_cpp: {}}}
types: {Speed: {fields: {value: float64}}}
groups:
  rig:
    components:
      drill: {outputs: {speed: Speed}, timing: {rate: 5 Hz}, node: {language: DRILL}}
      wheels: {inputs: {drill: drill.speed}, outputs: {spin: Speed}, timing: {rate: 5 Hz}, node: {language: WHEELS}}
"""


def _make_rig(folder: Path, drill: str, wheels: str, status: int, *more: str) -> str:
    text = RIG.replace("DRILL", drill).replace("WHEELS", wheels)
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    return archgen_here("generate", *more, cwd=folder, status=status).stderr.decode()


def _swap(folder: Path, front: str, rear: str, status: int, *more: str) -> str:
    groups = f"""\
groups:
  front: {{components: {{eye: {{outputs: {{spot: Speed}}, node: {{language: {front}}}}}}}}}
  rear: {{components: {{leg: {{inputs: {{spot: eye.spot}}, node: {{language: {rear}}}}}}}}}
"""
    (folder / "archgen.yaml").write_text(RIG.partition("groups:")[0] + groups, encoding="utf-8")
    return archgen_here("generate", *more, cwd=folder, status=status).stderr.decode()


def test_two_packages_swap_their_languages_in_one_run(tmp_path: Path) -> None:
    """Each backend is in the way of the other one until it has taken away what it no longer makes."""
    _swap(tmp_path, "python", "cpp", 0)
    own = tmp_path / "ws/src/rt_front/rt_front/eye.py"
    own.write_text(own.read_text("utf-8") + "\n\nMINE = 1\n", encoding="utf-8")
    before = contents(tmp_path / "ws")
    assert "error" not in _swap(tmp_path, "cpp", "python", 1, "--check")
    assert contents(tmp_path / "ws") == before
    (error,) = [each for each in _swap(tmp_path, "cpp", "python", 1).splitlines() if "error" in each]
    assert "eye.py:1:1" in error
    assert "it may become src/rt_front/src/eye_behaviour.cpp, which is empty" in error
    assert "MINE" in own.read_text("utf-8")
    made = {each.parent.name: each.name for each in (tmp_path / "ws/src").rglob("*") if each.name in BUILT_BY}
    assert made == {"rt_front": "CMakeLists.txt", "rt_rear": "setup.py", "rt_msgs": "CMakeLists.txt"}
    own.unlink()
    _swap(tmp_path, "cpp", "python", 0)
    assert _swap(tmp_path, "cpp", "python", 0, "--check") == ""


def test_a_language_that_swaps_with_another_is_told_whose_turn_it_is(tmp_path: Path) -> None:
    """With one backend in a run, too, one after the other comes to its end."""
    _swap(tmp_path, "python", "cpp", 0)
    said = _swap(tmp_path, "cpp", "python", 1, "ros2_cpp")
    assert "`archgen generate ros2_python` takes it away" in said
    _swap(tmp_path, "cpp", "python", 0, "ros2_python")
    _swap(tmp_path, "cpp", "python", 0, "ros2_cpp")
    assert _swap(tmp_path, "cpp", "python", 0, "--check") == ""


BUILT_BY = ("setup.py", "CMakeLists.txt")


def contents(folder: Path) -> dict[str, bytes]:
    return {str(each.relative_to(folder)): each.read_bytes() for each in folder.rglob("*") if each.is_file()}


def test_a_node_in_another_language_moves_its_package_in_one_run(tmp_path: Path) -> None:
    _make_rig(tmp_path, "cpp", "cpp", 0)
    said = _make_rig(tmp_path, "python", "cpp", 1, "--check")
    assert "is made by the backend" not in said
    assert "error" not in said
    said = _make_rig(tmp_path, "python", "cpp", 0)
    assert {each.name for each in (tmp_path / "ws" / "src").glob("rt_rig*")} == {"rt_rig", "rt_rig_cpp"}
    assert (tmp_path / "ws/src/rt_rig/rt_rig/drill.py").is_file()
    assert _make_rig(tmp_path, "python", "cpp", 0, "--check") == ""
    _make_rig(tmp_path, "cpp", "cpp", 0)
    assert (tmp_path / "ws/src/rt_rig/src/drill_behaviour.cpp").is_file()
    assert "stale" not in _make_rig(tmp_path, "cpp", "cpp", 0, "--check")


def test_another_node_that_has_a_timer_too_is_no_successor(tmp_path: Path) -> None:
    _make_rig(tmp_path, "cpp", "cpp", 0)
    for name in ("drill", "wheels"):
        own = tmp_path / f"ws/src/rt_rig/src/{name}_behaviour.cpp"
        own.write_text(f"{own.read_text('utf-8')}// Mine.\n", encoding="utf-8")
    said = _make_rig(tmp_path, "python", "cpp", 1)
    (line,) = [each for each in said.splitlines() if "/drill_behaviour.cpp" in each]
    assert "wheels" not in line
    (line,) = [each for each in said.splitlines() if "rt_rig/src/wheels_behaviour.cpp" in each]
    assert "it may become src/rt_rig_cpp/src/wheels_behaviour.cpp" in line


BOTH_LANGUAGES = """\
archgen: 1
project: {id: farm}
ros: {distro: jazzy}
generate: {into: ws, backends: {ros2_python: , ros2_cpp: }}
groups: {g: {components: {cam: {outputs: {seen: std_msgs/msg/Bool}, timing: {rate: 1 Hz}, node: {language: LANGUAGE}}}}}
"""


@pytest.mark.parametrize(
    ("before", "after", "old", "new"),
    [
        ("python", "cpp", "farm_g/cam.py", "farm_g/src/cam_behaviour.cpp"),
        ("cpp", "python", "src/cam_behaviour.cpp", "farm_g/farm_g/cam.py"),
    ],
)
def test_own_code_of_a_node_that_gets_another_language_is_told_until_it_is_written_there(
    tmp_path: Path, before: str, after: str, old: str, new: str
) -> None:
    def run(*words: str, status: int) -> list[str]:
        said = archgen_here("generate", *words, cwd=tmp_path, status=status).stderr.decode()
        return [line for line in said.splitlines() if "needs it any more" in line]

    project, own = tmp_path / "archgen.yaml", tmp_path / "ws/src/farm_g" / old
    project.write_text(BOTH_LANGUAGES.replace("LANGUAGE", before), encoding="utf-8")
    assert run(status=0) == []
    own.write_text(f"{own.read_text('utf-8')}\n", encoding="utf-8")
    project.write_text(BOTH_LANGUAGES.replace("LANGUAGE", after), encoding="utf-8")
    words = "nothing that is generated needs it any more"
    told = f"error: src/farm_g/{old}:1:1: {words}; it may become src/{new}, which is empty: "
    for check in ((), ("--check",)):
        (said,) = run(*check, status=1)
        assert said.startswith(told)
    written = tmp_path / "ws/src" / new
    written.write_text(f"{written.read_text('utf-8')}\n", encoding="utf-8")
    assert run(status=0) == [f"warning: src/farm_g/{old}: {words}"]
    assert run(status=0) == []
