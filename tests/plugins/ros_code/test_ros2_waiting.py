"""A generated node of one thread that serves and calls, on a real ROS 2: its methods wait for answers, and the node goes on meanwhile."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

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
      arm: {functionality: Reaches., outputs: {done: std_srvs/srv/Trigger, reach: test_msgs/action/Fibonacci}}
      gone: {functionality: Never there., outputs: {lost: std_srvs/srv/Trigger}}
      task:
        functionality: Decides.
        inputs: {done: arm.done, reach: arm.reach, lost: gone.lost}
        outputs: {go: std_srvs/srv/Trigger, plain: std_srvs/srv/Trigger, drive: test_msgs/action/Fibonacci}
        timing: {rate: 20 Hz, wcet: 1 ms}
"""
ARM = """\
from test_msgs.action import Fibonacci


class Arm:
    def __init__(self, node):
        self.node = node
        print('ready', flush=True)

    def serve_done(self, request, response):
        response.success, response.message = True, 'reached'
        return response

    def execute_reach(self, goal_handle):
        goal_handle.succeed()
        return Fibonacci.Result(sequence=[goal_handle.request.order])
"""
TASK = """\
from std_srvs.srv import Trigger
from test_msgs.action import Fibonacci

TICKS = []


class Task:
    def __init__(self, node):
        self.node = node

    async def on_timer(self):
        answer = await self.node.call_done(Trigger.Request())
        TICKS.append(answer.message)

    async def serve_go(self, request, response):
        answer = await self.node.call_done(Trigger.Request(), timeout_s=30.0)
        response.success, response.message = answer.success, answer.message
        return response

    async def serve_plain(self, request, response):
        try:
            await self.node.call_lost(Trigger.Request(), timeout_s=0.5)
        except TimeoutError as error:
            response.message = str(error)

    async def execute_drive(self, goal_handle):
        handle = await self.node.send_reach(Fibonacci.Goal(order=7), timeout_s=30.0)
        answer = await handle.get_result_async()
        goal_handle.succeed()
        return answer.result
"""
SCENARIO = """\
import json, os, threading, time
import rclpy
from rclpy.action import ActionClient
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_srvs.srv import Trigger
from test_msgs.action import Fibonacci
from rt_g import arm_node, task, task_node

rclpy.init()
judge = Node('judge')


def spin(node):
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    threading.Thread(target=executor.spin, daemon=True).start()


def finish(future):
    end = time.monotonic() + 60
    while not future.done() and time.monotonic() < end:
        time.sleep(0.01)
    assert future.done(), 'never answered'
    return future.result()


spin(judge)
spin(task_node.TaskNode())
clients = {name: judge.create_client(Trigger, f'/{name}') for name in ('go', 'plain')}
drive = ActionClient(judge, Fibonacci, '/drive')
for each in clients.values():
    assert each.wait_for_service(60)
assert drive.wait_for_server(60)
# The arm is not there yet: who asks for it waits.
early = clients['go'].call_async(Trigger.Request())
time.sleep(0.5)
said = {'early': early.done()}
spin(arm_node.ArmNode())
said['go'] = finish(early).message
said['plain'] = finish(clients['plain'].call_async(Trigger.Request())).message
handle = finish(drive.send_goal_async(Fibonacci.Goal(order=1)))
outcome = finish(handle.get_result_async())
said['drive'] = [outcome.status, list(outcome.result.sequence)]
ticks = len(task.TICKS)
time.sleep(1)
said['ticks'] = [task.TICKS[-1], len(task.TICKS) > ticks + 4]
print(json.dumps(said), flush=True)
os._exit(0)
"""


@pytest.fixture
def package(tmp_path: Path) -> Path:
    if sys.version_info[:2] > NEWEST_PYTHON or sys.platform != "linux":
        pytest.skip(f"there is no ROS 2 for {sys.platform} and Python {sys.version.split()[0]}")
    (tmp_path / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    archgen_here("generate", "ros2_python", "-o", tmp_path / "w", "--keep-going", cwd=tmp_path, status=0)
    package = tmp_path / "w" / "src" / "rt_g"
    (package / "rt_g" / "arm.py").write_text(ARM, encoding="utf-8")
    (package / "rt_g" / "task.py").write_text(TASK, encoding="utf-8")
    return package


@pytest.mark.ros
def test_whoever_is_impatient_leaves_no_traceback(package: Path, tmp_path: Path) -> None:
    environment = ros_environment(69, tmp_path) | {"PYTHONPATH": str(package)}
    words = [str(make_ros_python()), "-c", "from rt_g.arm_node import main; main()"]
    with subprocess.Popen(  # noqa: S603 - just generated
        words, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as running:
        assert running.stdout is not None
        assert running.stdout.readline() == "ready\n"
        time.sleep(1)
        for _ in range(5):
            running.send_signal(signal.SIGINT)
            time.sleep(0.02)
        _, errors = running.communicate(timeout=60)
    assert (running.returncode, errors) == (0, "")


@pytest.mark.ros
def test_a_node_of_one_thread_waits_for_what_it_asks_for(package: Path, tmp_path: Path) -> None:
    environment = ros_environment(67, tmp_path) | {"PYTHONPATH": str(package)}
    done = run_judge(str(make_ros_python()), "-c", SCENARIO, env=environment)
    assert json.loads(done.stdout.splitlines()[-1]) == {
        "early": False,
        "go": "reached",
        "plain": "lost: no server within 0.5 s",
        "drive": [4, [7]],
        "ticks": ["reached", True],
    }
