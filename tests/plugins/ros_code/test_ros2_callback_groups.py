"""Callback groups of generated nodes: what excludes one another in the model does so under a real executor, and the rest runs side by side."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.plugins.ros_code.node_programs import make_view
from archgen.views.generation.generation_context import GenerationContext
from tests.outside_tools import run_judge
from tests.ros_environment import NEWEST_PYTHON, make_ros_python, ros_environment
from tests.running import archgen_here

PROJECT = """\
archgen: 1
project: {id: rt, title: Robot}
ros: {distro: jazzy}
groups:
  g:
    components:
      stop: {functionality: Stops., inputs: {image: cam.image, go: cam.go}, timing: {rate: 20 Hz, wcet: 1 ms}}
      map: {functionality: Maps., inputs: {image: cam.image}, timing: {rate: 10 Hz, wcet: 1 ms}}
      log: {functionality: Logs., inputs: {image: cam.image}}
      cam: {functionality: Sees., outputs: {image: std_msgs/String, go: std_srvs/srv/Trigger}}
nodes:
  brain: {implements: [stop, map, log], threads: 3, GROUPS}
"""
GROUPS = "callback_groups: {fast: [stop], slow: [map]}"
WATCHED = """\
import os, threading, time
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from std_msgs.msg import String
from rt_g import brain_node

fired, inside, overlaps, received, done = threading.Semaphore(0), threading.Lock(), [], [], threading.Event()


def hold(name):
    if not inside.acquire(blocking=False):
        overlaps.append(name)
        return
    time.sleep(0.03)
    inside.release()


class Watched(brain_node.Brain):
    def on_timer_stop(self):
        hold('timer')
        fired.release()

    def receive_stop_image(self, message):
        received.append(message)
        hold('image')

    def on_timer_map(self):
        # It ends only where the timer of the other group goes on meanwhile.
        if all(fired.acquire(timeout=60) for _ in range(5)) and len(received) > 3:
            done.set()


brain_node.Brain = Watched
rclpy.init()
node = brain_node.BrainNode()
images = node.create_publisher(String, '/stop_image', 10)
node.create_timer(0.01, lambda: images.publish(String()), callback_group=ReentrantCallbackGroup())
executor = MultiThreadedExecutor(num_threads=4)
executor.add_node(node)
spinning = threading.Thread(target=executor.spin, daemon=True)
spinning.start()
print('side by side' if done.wait(120) else 'stuck', overlaps, flush=True)
executor.shutdown(0)
rclpy.try_shutdown()
os._exit(0)
"""


def make_brain(folder: Path, groups: str) -> dict[str, object]:
    (folder / "archgen.yaml").write_text(PROJECT.replace("GROUPS", groups))
    (program,) = (
        each
        for each in make_view(GenerationContext(check_project(folder).architecture)).data["programs"]
        if each["node_name"] == "brain"
    )
    return dict(program)


def test_the_view_says_who_is_in_which_group(tmp_path: Path) -> None:
    program = make_brain(tmp_path, GROUPS)
    assert program["callback_groups"] == [
        {"key": "fast", "components": ["g.stop"]},
        {"key": "slow", "components": ["g.map"]},
    ]
    called = [*program["subscriptions"], *program["clients"], *program["timers"]]  # type: ignore[misc]
    assert {each["key"]: each["callback_group"] for each in called} == {
        "go": "fast",
        "log_image": "",
        "map": "slow",
        "map_image": "slow",
        "stop": "fast",
        "stop_image": "fast",
    }


@pytest.mark.parametrize("groups", ["reentrant: true", "callback_groups: {}", "callback_groups: {none_called: [cam]}"])
def test_without_groups_there_are_none(groups: str, tmp_path: Path) -> None:
    assert make_brain(tmp_path, groups)["callback_groups"] == []


@pytest.mark.ros
def test_groups_run_side_by_side_and_callbacks_of_one_do_not(tmp_path: Path) -> None:
    if sys.version_info[:2] > NEWEST_PYTHON or sys.platform != "linux":
        pytest.skip(f"there is no ROS 2 for {sys.platform} and Python {sys.version.split()[0]}")
    make_brain(tmp_path, GROUPS)
    archgen_here("generate", "ros2_python", "-o", tmp_path / "w", "--keep-going", cwd=tmp_path)
    environment = ros_environment(62, tmp_path) | {"PYTHONPATH": str(tmp_path / "w" / "src" / "rt_g")}
    command = [str(make_ros_python()), "-c", WATCHED]
    done = run_judge(*command, env=environment)
    assert done.stdout == "side by side []\n", done.stderr
