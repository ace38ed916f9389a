"""Stand-ins of components without code, on a real ROS 2: they send at the designed rates and sizes, and answer."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

import pytest

from tests.outside_tools import find_tool, run_judge
from tests.plugins.ros_code.test_ros2_cpp import ROBOT, make_programs, write_project
from tests.plugins.ros_code.test_ros2_cpp_builds import LIFECYCLE, compile_all, judge_format
from tests.plugins.ros_code.test_ros2_python import AMENT_FLAKE8
from tests.ros_environment import NEWEST_PYTHON, ROS_FOLDER, make_ros_python, ros_environment
from tests.running import archgen_here

PROJECT = """\
archgen: 1
project: {id: rt, title: Robot}
ros: {distro: jazzy}
groups:
  g:
    components:
      cam: {functionality: Sees., outputs: {image: Picture}, timing: {rate: 20 Hz, wcet: 1 ms}}
      det: {functionality: Finds., inputs: {image: cam.image, mode: lamp.mode}, outputs: {found: Place, plan: Plan, go: Fib}}
      lamp: {functionality: Shines., outputs: {mode: std_msgs/String}}
      sink: {functionality: Takes., inputs: {found: det.found, plan: det.plan, go: det.go}}
types:
  Picture: {message: sensor_msgs/Image, size: 10 kB}
  Place: geometry_msgs/PoseStamped
  Plan: std_srvs/srv/Trigger
  Fib: test_msgs/action/Fibonacci
"""
SCENARIO = """\
import json, os, threading, time
import rclpy
from geometry_msgs.msg import PoseStamped
from rclpy.action import ActionClient
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import Image
from std_msgs.msg import String
from std_srvs.srv import Trigger
from test_msgs.action import Fibonacci
from rt_g import cam_node, det_node, lamp_node

rclpy.init()
judge = Node('judge')
heard = {'image': [], 'found': [], 'mode': []}
for name, kind in (('image', Image), ('found', PoseStamped), ('mode', String)):
    judge.create_subscription(kind, f'/{name}', lambda each, name=name: heard[name].append((time.monotonic(), each)), 100)
silent = cam_node.CamNode(cli_args=['--ros-args', '-r', 'image:=/other', '-p', 'stand_in:=false'])
judge.create_subscription(Image, '/other', lambda each: heard['mode'].append(each), 10)
plan = judge.create_client(Trigger, '/plan')
go = ActionClient(judge, Fibonacci, '/go')
for node in (cam_node.CamNode(), det_node.DetNode(), lamp_node.LampNode(), silent, judge):
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    threading.Thread(target=executor.spin, daemon=True).start()


def finish(future):
    end = time.monotonic() + 60
    while not future.done() and time.monotonic() < end:
        time.sleep(0.01)
    return future.result()


end = time.monotonic() + 60
while min(map(len, heard.values())) < 3 and time.monotonic() < end:
    time.sleep(0.1)
started = len(heard['image'])
time.sleep(2)
pictures = heard['image'][started:]
assert plan.wait_for_service(60) and go.wait_for_server(60)
answer = finish(plan.call_async(Trigger.Request()))
feedback = []
handle = finish(go.send_goal_async(Fibonacci.Goal(order=1), feedback.append))
outcome = finish(handle.get_result_async())
last = pictures[-1][1]
place = heard['found'][-1][1]
print(json.dumps({
    'rate': len(pictures) / 2,
    'picture': [last.width, last.height, last.step, last.encoding, len(last.data), last.header.frame_id],
    'age': abs(time.time() - last.header.stamp.sec) < 60,
    'place': [place.pose.orientation.w, -1 <= place.pose.position.x <= 1, place.header.frame_id],
    'mode': heard['mode'][-1][1].data.split()[0],
    'answer': answer.success,
    'go': [outcome.status, len(feedback)],
}), flush=True)
os._exit(0)
"""


FILLED = """\
#include <cstdio>

#include "geometry_msgs/msg/pose_stamped.hpp"
#include "rt_g/stand_in_messages.hpp"
#include "sensor_msgs/msg/image.hpp"
#include "sensor_msgs/msg/point_cloud2.hpp"
#include "std_srvs/srv/trigger.hpp"
#include "test_msgs/msg/bounded_plain_sequences.hpp"

template<typename Message>
Message make(std::size_t size)
{
  builtin_interfaces::msg::Time now;
  now.sec = 7;
  Message message;
  rt_g_stand_in::fill(message, now, 4, size);
  return message;
}

int main()
{
  const auto image = make<sensor_msgs::msg::Image>(10050);
  std::printf("%u %u %s %zu ", image.width, image.step, image.encoding.c_str(), image.data.size());
  std::printf("%s %d\\n", image.header.frame_id.c_str(), image.header.stamp.sec);
  const auto cloud = make<sensor_msgs::msg::PointCloud2>(1000);
  std::printf("%u %u %zu\\n", cloud.width, cloud.row_step, cloud.data.size());
  const auto pose = make<geometry_msgs::msg::PoseStamped>(0).pose;
  std::printf("%g %.3f\\n", pose.orientation.w, pose.position.x);
  const auto answer = make<std_srvs::srv::Trigger::Response>(0);
  std::printf("%d %s\\n", answer.success, answer.message.c_str());
  std::printf("%zu\\n", make<test_msgs::msg::BoundedPlainSequences>(1000).byte_values.size());
}
"""


def generate(folder: Path, text: str = PROJECT, backend: str = "ros2_python") -> Path:
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    words = ("generate", backend, "-o", folder / "w", "--option", "stand_ins=true")
    archgen_here(*words, cwd=folder)
    return folder / "w" / "src" / "rt_g"


def test_they_are_written_as_ros_developers_write(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "flake8", "--isolated", "--jobs=1", *AMENT_FLAKE8, str(generate(tmp_path))]
    assert run_judge(*command).stdout == ""


def test_without_the_option_there_are_none(tmp_path: Path) -> None:
    generate(tmp_path)
    archgen_here("generate", "ros2_python", "-o", tmp_path / "w", cwd=tmp_path)
    files = [each for each in (tmp_path / "w").rglob("*") if each.is_file()]
    assert not [each for each in files if "stand_in" in each.name]
    assert not [each for each in files if "stand_in" in each.read_text(encoding="utf-8") and each.suffix == ".py"]


@pytest.mark.ros
def test_they_send_and_answer_as_designed(tmp_path: Path) -> None:
    if sys.version_info[:2] > NEWEST_PYTHON or sys.platform != "linux":
        pytest.skip(f"there is no ROS 2 for {sys.platform} and Python {sys.version.split()[0]}")
    environment = ros_environment(68, tmp_path) | {"PYTHONPATH": str(generate(tmp_path))}
    done = run_judge(str(make_ros_python()), "-c", SCENARIO, env=environment)
    said = json.loads(done.stdout.splitlines()[-1])
    assert 10 <= said.pop("rate") <= 21
    assert said == {
        "picture": [100, 100, 100, "mono8", 10000, "base_link"],
        "age": True,
        "place": [1.0, True, "base_link"],
        "mode": "data",
        "answer": True,
        "go": [4, 5],
    }


def test_instances_of_a_type_send_in_their_timer(tmp_path: Path) -> None:
    text = ROBOT.replace("parameters: {joint: left}", "parameters: {joint: left}, timing: {rate: 5 Hz, wcet: 1 ms}")
    programs, _ = make_programs(write_project(tmp_path, text))
    sent_in = {name: [port["sent_in"] for port in each["publishers"]] for name, each in programs.items()}
    assert sent_in == {
        "both": [],
        "cam": ["on_timer", "on_timer"],
        "det": ["receive_cloud"],
        "motor": ["on_timer"],
        "user": [],
    }


@pytest.mark.build
@pytest.mark.parametrize(
    "text",
    [
        ROBOT,
        LIFECYCLE,
        PROJECT.replace("groups:", "nodes: {x: {implements: [g.cam, g.lamp, g.det], language: cpp}}\ngroups:").replace(
            "mode: lamp.mode", "what_the_lamp_says_of_itself_and_of_others: lamp.mode"
        ),
    ],
)
def test_those_in_cpp_compile(text: str, tmp_path: Path) -> None:
    generate(tmp_path, text, "ros2_cpp")
    compile_all(tmp_path / "w", tmp_path)
    judge_format(tmp_path / "w")


@pytest.mark.ros
def test_those_in_cpp_fill_real_messages(tmp_path: Path) -> None:
    if sys.version_info[:2] > NEWEST_PYTHON or sys.platform != "linux":
        pytest.skip(f"there is no ROS 2 for {sys.platform} and Python {sys.version.split()[0]}")
    make_ros_python()
    package = generate(tmp_path, ROBOT, "ros2_cpp")
    folders = sorted(each for each in (ROS_FOLDER / "include").iterdir() if each.is_dir())
    compile_all(tmp_path / "w", tmp_path, folders)
    (tmp_path / "fill.cpp").write_text(FILLED, encoding="utf-8")
    command: list[str | Path] = [
        "-std=c++17",
        "-Wall",
        "-Wextra",
        "-Werror",
        f"-I{package / 'include'}",
        tmp_path / "fill.cpp",
    ]
    command += [word for each in folders for word in ("-isystem", str(each))]
    names = ("geometry_msgs", "sensor_msgs", "std_srvs", "test_msgs")
    libraries = [*(f"{each}__rosidl_typesupport_cpp" for each in names), "rosidl_typesupport_introspection_cpp"]
    command += [f"-L{ROS_FOLDER / 'lib'}", *(f"-l{each}" for each in libraries), "-Wl,--allow-shlib-undefined"]
    run_judge(find_tool("g++"), *command, "-o", tmp_path / "fill")
    libraries_of_wheels = [ROS_FOLDER / "lib", *ROS_FOLDER.rglob("ros_*.libs")]
    search = os.pathsep.join(map(str, libraries_of_wheels))
    said = run_judge(str(tmp_path / "fill"), env=ros_environment(68, tmp_path) | {"LD_LIBRARY_PATH": search}).stdout
    assert said == "100 100 mono8 10000 base_link 7\n1000 1000 1000\n1 0.389\n1 message 4\n3\n"
