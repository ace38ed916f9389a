"""Generated lifecycle nodes on a real ROS 2: what is not active hears and sends nothing, and the own class is told."""

from __future__ import annotations

import json
import sys
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
      guide:
        functionality: Guides.
        inputs: {image: cam.image, map: cam.map, done: arm.done, go: arm.go}
        outputs: {way: std_msgs/String, plan: std_srvs/srv/Trigger, drive: test_msgs/action/Fibonacci}
        timing: {rate: 50 Hz, wcet: 1 ms}
      cam: {functionality: Sees., outputs: {image: std_msgs/String, map: std_msgs/String}}
      arm: {functionality: Reaches., outputs: {done: std_srvs/srv/Trigger, go: test_msgs/action/Fibonacci}}
nodes:
  guide: {implements: guide, kind: lifecycle, threads: 4, subscribes: {map: {qos: {durability: transient_local}}}}
  cam: {implements: cam, publishes: {map: {topic: map, qos: {durability: transient_local}}}}
"""
OWN = """\
import threading
from std_msgs.msg import String
from std_srvs.srv import Trigger
from test_msgs.action import Fibonacci

TOLD, TAKEN = [], {'image': 0, 'map': 0, 'timer': 0, 'plan': 0}


class Guide:
    def __init__(self, node):
        self.node = node
        TOLD.append('made')

    def on_configure(self):
        TOLD.append('configure')

    def on_activate(self):
        TOLD.append('activate')
        self.node.publish_way(String(data='first'))

    def on_deactivate(self):
        TOLD.append('deactivate')
        self.node.publish_way(String(data='last'))

    def on_cleanup(self):
        TOLD.append('cleanup')

    def on_error(self):
        TOLD.append('error')

    def on_timer(self):
        TAKEN['timer'] += 1
        self.node.publish_way(String(data='way'))
        self.node.send_go(Fibonacci.Goal(order=1))

    def receive_image(self, message):
        TAKEN['image'] += 1

    def receive_map(self, message):
        TAKEN['map'] += 1

    def serve_plan(self, request, response):
        TAKEN['plan'] += 1
        response.success = True
        return response

    def execute_drive(self, goal_handle):
        TOLD.append('drive')
        while goal_handle.is_active:
            feedback = Fibonacci.Feedback()
            goal_handle.publish_feedback(feedback)
            threading.Event().wait(0.01)
        TOLD.append('driven')
"""
SCENARIO = """\
import json, os, threading, time
import rclpy
from rclpy.action import ActionClient, ActionServer, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String
from std_srvs.srv import Trigger
from test_msgs.action import Fibonacci
from rt_g import guide, guide_node

rclpy.init()
node = guide_node.GuideNode()
world = Node('world')
group = ReentrantCallbackGroup()
heard = {'way': [], 'goals': 0, 'feedback': 0, 'calls': 0}


def accept(goal):
    heard['goals'] += 1
    return GoalResponse.REJECT


def answer(request, response):
    heard['calls'] += 1
    response.success = True
    return response


images = world.create_publisher(String, '/image', 10)
latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
maps = world.create_publisher(String, '/map', latched)
world.create_timer(0.002, lambda: images.publish(String()), callback_group=group)
world.create_subscription(String, '/way', lambda each: heard['way'].append(each.data), 100)
world.create_service(Trigger, '/done', answer)
ActionServer(world, Fibonacci, '/go', lambda handle: None, goal_callback=accept, callback_group=group)
plan = world.create_client(Trigger, '/plan', callback_group=group)
drive = ActionClient(world, Fibonacci, '/drive', callback_group=group)


def spin(executor, *nodes):
    for each in nodes:
        executor.add_node(each)
    threading.Thread(target=executor.spin, daemon=True).start()


spin(MultiThreadedExecutor(4), node)
spin(MultiThreadedExecutor(4), world)


def wait(holds, seconds=60):
    end = time.monotonic() + seconds
    while not holds() and time.monotonic() < end:
        time.sleep(0.02)
    return holds()


def finish(future):
    assert wait(future.done), 'no answer'
    return future.result()


def try_all():
    '''Return what happens within a second, what its service says, and whether it takes a goal.'''
    assert wait(plan.service_is_ready) and wait(drive.server_is_ready)
    before = dict(guide.TAKEN), len(heard['way']), heard['goals'], heard['calls'], heard['feedback']
    response = finish(plan.call_async(Trigger.Request()))

    def feel(feedback):
        heard['feedback'] += 1

    handle = finish(drive.send_goal_async(Fibonacci.Goal(order=3), feel))
    refused = node.behaviour.node.call_done(Trigger.Request(), timeout_s=20.0) if node.behaviour else None
    failure = type(refused.exception()).__name__ if wait(lambda: refused.done()) else ''
    time.sleep(1)
    after = dict(guide.TAKEN), len(heard['way']), heard['goals'], heard['calls'], heard['feedback']
    grown = {name: after[0][name] > before[0][name] for name in after[0]}
    grown |= dict(zip(('way', 'goals', 'calls', 'feedback'), (b > a for a, b in zip(before[1:], after[1:]))))
    return {
        'works': sorted(name for name, has in grown.items() if has),
        'says': [response.success, response.message],
        'accepts': handle.accepted,
        'failure': failure,
    }, handle


said = {}
node.trigger_configure()
managed = len(node._managed_entities)
maps.publish(String())
said['configured'], _ = try_all()
node.trigger_activate()
assert wait(lambda: guide.TAKEN['map'] == 1), 'the map that came before'
said['activated'], handle = try_all()
assert wait(lambda: 'drive' in guide.TOLD)
node.trigger_deactivate()
result = finish(handle.get_result_async())
time.sleep(0.5)
maps.publish(String())
said['deactivated'], _ = try_all()
said['map'] = guide.TAKEN['map']
node.trigger_activate()
assert wait(lambda: guide.TAKEN['map'] == 2), 'the map that came meanwhile'
said['again'], handle = try_all()
node.trigger_deactivate()
finish(handle.get_result_async())
said['edges'] = [heard['way'][0], heard['way'][-1]]
node.trigger_cleanup()
node.trigger_configure()
said['managed'] = [managed, len(node._managed_entities)]
said['goal'] = result.status
said['told'] = guide.TOLD
print(json.dumps(said), flush=True)
os._exit(0)
"""


def make_guide(folder: Path) -> Path:
    (folder / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    archgen_here("generate", "ros2_python", "-o", folder / "w", "--keep-going", cwd=folder, status=0)
    package = folder / "w" / "src" / "rt_g"
    (package / "rt_g" / "guide.py").write_text(OWN, encoding="utf-8")
    return package


@pytest.mark.ros
def test_an_inactive_node_hears_and_sends_nothing(tmp_path: Path) -> None:
    if sys.version_info[:2] > NEWEST_PYTHON or sys.platform != "linux":
        pytest.skip(f"there is no ROS 2 for {sys.platform} and Python {sys.version.split()[0]}")
    environment = ros_environment(66, tmp_path) | {"PYTHONPATH": str(make_guide(tmp_path))}
    done = run_judge(str(make_ros_python()), "-c", SCENARIO, env=environment)
    said = json.loads(done.stdout.splitlines()[-1])
    inactive = {
        "works": [],
        "says": [False, "plan is refused: guide is not active"],
        "accepts": False,
        "failure": "NotActive",
    }
    active = {
        "works": ["calls", "feedback", "goals", "image", "plan", "timer", "way"],
        "says": [True, ""],
        "accepts": True,
        "failure": "NoneType",
    }
    assert said["configured"] == inactive
    assert said["activated"] == active
    assert said["deactivated"] == inactive
    assert said["again"] == active
    assert said["map"] == 1
    # A goal that was being carried out is aborted, and a last word of the own class goes out.
    assert said["goal"] == 6
    assert said["edges"] == ["first", "last"]
    told = ["made", "configure", "activate", "drive", "deactivate", "driven"]
    assert said["told"] == [*told, *told[2:], "cleanup", "made", "configure"]
    # What was taken away is forgotten, too.
    assert said["managed"] == [1, 1]
    assert "drive is refused: guide is not active" in done.stderr
    assert "done is refused: guide is not active" in done.stderr
