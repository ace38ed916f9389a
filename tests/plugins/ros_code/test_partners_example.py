"""examples/partners: two partners' code runs against stand-ins for what the two others have not written yet."""

from __future__ import annotations

import json
import shutil
import sys
from pathlib import Path

import pytest

from tests.outside_tools import run_judge
from tests.ros_environment import NEWEST_PYTHON, make_ros_python, ros_environment
from tests.running import ROOT, archgen_here

OWN_FILES = (
    "garden_mind/garden_mind/finder.py",
    "garden_mind/garden_mind/guide.py",
    "garden_base/garden_base/wheels.py",
)
SCENARIO = """\
import json, os, threading, time
import rclpy
from nav_msgs.msg import Odometry
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from garden_base import wheels_node
from garden_eyes import camera_node
from garden_mind import finder_node, guide_node
from garden_water import tank_node

rclpy.init()
judge = Node('judge')
heard = []
judge.create_subscription(Odometry, 'odometry', lambda message: heard.append(message.pose.pose.position.x), 10)
own = ['--ros-args', '-p', 'stand_in:=false']
nodes = [camera_node.CameraNode(), tank_node.TankNode(), finder_node.FinderNode(cli_args=own)]
nodes += [guide_node.GuideNode(cli_args=own), wheels_node.WheelsNode(cli_args=own), judge]
for node in nodes:
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    threading.Thread(target=executor.spin, daemon=True).start()
end = time.monotonic() + 60
while (not heard or heard[-1] <= 0.0) and time.monotonic() < end:
    time.sleep(0.1)
print(json.dumps({'driven': heard[-1] > 0.0, 'classes': [type(each.behaviour).__name__ for each in nodes[:-1]]}), flush=True)
os._exit(0)
"""


@pytest.fixture
def garden(tmp_path: Path) -> Path:
    return Path(shutil.copytree(ROOT / "examples" / "partners", tmp_path / "garden"))


def test_the_partners_code_fits_the_model(garden: Path) -> None:
    before = {name: (garden / "ws/src" / name).read_text(encoding="utf-8") for name in OWN_FILES}
    said = archgen_here("generate", cwd=garden, status=0).stderr.decode()
    assert "error" not in said
    for name, text in before.items():
        assert (garden / "ws/src" / name).read_text(encoding="utf-8") == text
    archgen_here("generate", "--check", cwd=garden, status=0)
    launch = (garden / "ws/src/garden_bringup").rglob("*.yaml")
    assert sorted(each.stem for each in launch if '"stand_in": false' in each.read_text()) == [
        "finder",
        "guide",
        "wheels",
    ]


@pytest.mark.ros
def test_it_drives_on_what_stand_ins_send(garden: Path) -> None:
    if sys.version_info[:2] > NEWEST_PYTHON or sys.platform != "linux":
        pytest.skip(f"there is no ROS 2 for {sys.platform} and Python {sys.version.split()[0]}")
    archgen_here("generate", cwd=garden, status=0)
    packages = ":".join(str(each) for each in sorted((garden / "ws/src").iterdir()))
    done = run_judge(str(make_ros_python()), "-c", SCENARIO, env=ros_environment(69, garden) | {"PYTHONPATH": packages})
    assert json.loads(done.stdout.splitlines()[-1]) == {
        "driven": True,
        "classes": ["CameraStandIn", "TankStandIn", "Finder", "Guide", "Wheels"],
    }
