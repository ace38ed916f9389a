"""A real ROS 2 for tests, from wheels, in a virtual environment of its own that later runs find again."""

from __future__ import annotations

import contextlib
import fcntl
import os
import signal
import subprocess
import sys
from pathlib import Path

from tests.outside_tools import run_judge
from tests.running import ROOT

ROS_FOLDER = ROOT / ".make" / "ros_jazzy"
# One version of each is published for a distribution.
_WHEELS = (
    "ros-jazzy-rclpy==7.1.6",
    "ros-jazzy-rmw-fastrtps-cpp==8.4.3",
    "ros-jazzy-common-interfaces==5.3.6",
    "ros-jazzy-std-srvs==5.3.6",
    "ros-jazzy-lifecycle-msgs==2.0.3",
    "ros-jazzy-test-msgs",
    "pytest>=8",
)
NEWEST_PYTHON = (3, 14)
"""There are wheels for Python 3.10 to this one."""


def make_ros_python() -> Path:
    """Return the Python of an environment with rclpy; it is made where it is not there yet."""
    python = ROS_FOLDER / "bin" / "python"
    done = ROS_FOLDER / "installed"
    ROS_FOLDER.parent.mkdir(exist_ok=True)
    with (ROS_FOLDER.parent / "ros_jazzy.lock").open("w") as lock:
        # Several workers ask for it at once.
        fcntl.flock(lock, fcntl.LOCK_EX)
        wanted = "\n".join(_WHEELS)
        if not done.exists() or done.read_text() != wanted:
            run_judge(sys.executable, "-m", "venv", "--clear", str(ROS_FOLDER))
            run_judge(str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *_WHEELS)
            done.write_text(wanted)
    return python


def ros_environment(domain: int, log_folder: Path) -> dict[str, str]:
    """Return the variables of a process of ROS: it sees only those of this machine that the same test started in the same domain."""
    return {
        # Nothing of the caller's own: two environments of ROS in one process do not get along.
        "PATH": f"{ROS_FOLDER / 'bin'}{os.pathsep}{os.environ['PATH']}",
        "HOME": str(log_folder),
        "AMENT_PREFIX_PATH": str(ROS_FOLDER),
        "VIRTUAL_ENV": str(ROS_FOLDER),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        # Another run of the same test, in another checkout, would be seen as well. There are the domains 0 to 101.
        "ROS_DOMAIN_ID": str((domain + os.getpid()) % 102),
        "ROS_LOG_DIR": str(log_folder),
    }


def interrupt_node(node: subprocess.Popen[bytes]) -> int:
    """Interrupt a node in Python until it ends, and return its status.

    rclpy may miss one: a process was seen to wait for messages all the same, and ended by the next.
    """
    for _ in range(6):
        node.send_signal(signal.SIGINT)
        with contextlib.suppress(subprocess.TimeoutExpired):
            return node.wait(20)
    node.kill()
    return node.wait()
