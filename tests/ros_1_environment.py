"""A real ROS 1 for tests, from Debian's packages: a master of their own, programs that end with it, built messages."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest

from tests.outside_tools import run_judge

SYSTEM_PYTHON = "/usr/bin/python3"
"""The Python that Debian's packages of ROS are made for."""
SHARE = Path("/usr/share")
STOPPING_SECONDS = 60


def require_ros_1() -> None:
    """Skip a test where there is no ROS 1: `tools/system_packages.sh ros` installs it on Debian 12."""
    if not shutil.which("roslaunch", path="/usr/bin"):
        pytest.skip("there is no ROS 1 on this machine: `sh tools/system_packages.sh ros` installs it on Debian 12")


def find_free_port() -> int:
    """Return a port of this machine that nobody listens on."""
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return int(listener.getsockname()[1])


def ros_1_environment(workspace: Path, folder: Path, port: int) -> dict[str, str]:
    """Return the variables of a process that knows the packages of a workspace as they lie in `src`."""
    sources = [str(each) for each in sorted(workspace.glob("src/*/src"))]
    return {
        "PATH": "/usr/bin:/bin",
        "HOME": str(folder),
        "PYTHONPATH": os.pathsep.join([str(folder / "messages"), *sources]),
        "PYTHONDONTWRITEBYTECODE": "1",
        "ROS_DISTRO": "noetic",
        "ROS_ETC_DIR": "/etc/ros",
        "ROS_HOME": str(folder / "ros_home"),
        "ROS_IP": "127.0.0.1",
        "ROS_LOG_DIR": str(folder / "ros_logs"),
        "ROS_MASTER_URI": f"http://127.0.0.1:{port}",
        "ROS_PACKAGE_PATH": f"{workspace / 'src'}:{SHARE}",
        "ROS_ROOT": "/usr/share/ros",
    }


def build_messages(workspace: Path, folder: Path) -> None:
    """Let genpy make the modules of all messages in a workspace, as catkin would."""
    packages = [each.parent for each in workspace.glob("src/*/msg")]
    known = [f"{each.parent.name}:{each}" for each in [*SHARE.glob("*/msg"), *workspace.glob("src/*/msg")]]
    includes = [word for each in sorted(known) for word in ("-I", each)]
    for package in packages:
        target = folder / "messages" / package.name
        target.mkdir(parents=True)
        (target / "__init__.py").touch()
        command = ["/usr/lib/genpy/genmsg_py.py", "-p", package.name, "-o", str(target / "msg")]
        files = sorted(str(each) for each in package.glob("msg/*.msg"))
        (target / "msg").mkdir()
        for words in ([*includes, *files], ["--initpy"]):
            run_judge(SYSTEM_PYTHON, *command, *words)


@contextlib.contextmanager
def run_programs(commands: Sequence[Sequence[str]], environment: dict[str, str], log: Path) -> Iterator[None]:
    """Run programs, and end them in reverse order whatever happens: with SIGINT, and all of their own by force if need be."""
    processes: list[subprocess.Popen[bytes]] = []
    try:
        with log.open("ab") as stream:
            for command in commands:
                processes.append(  # noqa: PERF401 - what started before a failure is ended
                    subprocess.Popen(  # noqa: S603 - programs of ROS
                        command, env=environment, stdout=stream, stderr=stream, start_new_session=True
                    )
                )
        yield
    finally:
        for process in reversed(processes):
            _end_process(process)
        _end_left_programs(environment)
        sys.stdout.write(log.read_text(encoding="utf-8", errors="replace"))


def _end_process(process: subprocess.Popen[bytes]) -> None:
    with contextlib.suppress(ProcessLookupError):
        process.send_signal(signal.SIGINT)
    try:
        process.wait(STOPPING_SECONDS)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _end_left_programs(environment: dict[str, str]) -> None:
    """End what programs of ROS started in sessions of their own, and did not end: it has their environment."""
    mark = f"ROS_HOME={environment['ROS_HOME']}".encode()
    for folder in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            if mark in (folder / "environ").read_bytes().split(b"\0"):
                os.kill(int(folder.name), signal.SIGKILL)
