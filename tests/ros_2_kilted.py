"""ROS 2 Kilted for tests, from wheels that also build interface packages, in a virtual environment of its own."""

from __future__ import annotations

import fcntl
import os
import sys
from pathlib import Path

from tests.outside_tools import run_judge
from tests.running import ROOT

KILTED_FOLDER = ROOT / ".make" / "ros_kilted"
_WHEELS = tuple(
    f"ros-kilted-{name}"
    for name in (
        *(
            "rclpy",
            "rmw-fastrtps-cpp",
            "common-interfaces",
            "test-msgs",
            "ament-cmake",
            "ament-cmake-ros",
            "ament-cmake-ros-core",
        ),
        *("ament-cmake-include-directories", "ament-cmake-gmock", "ament-cmake-gtest", "ament-cmake-pytest"),
        *("ament-package", "rosidl-default-generators", "rosidl-core-generators"),
    )
)
_TOOLS = ("catkin-pkg", "empy==3.3.4", "cmake", "ninja", "pytest>=8")
# Wheels name the folders of the machine that built them.
_MEND_PATHS = """
import pathlib, re, sysconfig, numpy
for file in pathlib.Path(sysconfig.get_path("data"), "share").rglob("*Export.cmake"):
    text = file.read_text()
    mended = re.sub(r"/opt/python/[a-z0-9-]+/lib/python[0-9.]+t?/site-packages/numpy/_core/include", numpy.get_include(), text)
    mended = re.sub(r"/opt/python/[a-z0-9-]+/include/python[0-9.]+t?", sysconfig.get_path("include"), mended)
    if mended != text:
        file.write_text(mended)
"""


def make_kilted_python() -> Path:
    """Return the Python of an environment with rclpy of Kilted; it is made where it is not there yet."""
    python = KILTED_FOLDER / "bin" / "python"
    done = KILTED_FOLDER / "installed"
    KILTED_FOLDER.parent.mkdir(exist_ok=True)
    with (KILTED_FOLDER.parent / "ros_kilted.lock").open("w") as lock:
        # Several workers ask for it at once.
        fcntl.flock(lock, fcntl.LOCK_EX)
        wanted = "\n".join([*_WHEELS, *_TOOLS])
        if not done.exists() or done.read_text() != wanted:
            run_judge(sys.executable, "-m", "venv", "--clear", str(KILTED_FOLDER))
            pip = [str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
            run_judge(*pip, *_WHEELS, *_TOOLS)
            run_judge(str(python), "-c", _MEND_PATHS)
            done.write_text(wanted)
    return python


def kilted_environment(domain: int, workspace: Path, prefix: Path, log_folder: Path) -> dict[str, str]:
    """Return the variables of a process that knows the packages of a workspace, and what was built into a prefix."""
    packages = [str(each.parent) for each in workspace.glob("src/*/setup.py")]
    built = [str(each) for each in prefix.glob("lib/python*/site-packages")]
    return {
        "PATH": f"{KILTED_FOLDER / 'bin'}{os.pathsep}{os.environ['PATH']}",
        "HOME": str(log_folder),
        "AMENT_PREFIX_PATH": f"{prefix}:{KILTED_FOLDER}",
        "LD_LIBRARY_PATH": str(prefix / "lib"),
        "PYTHONPATH": os.pathsep.join([*packages, *built]),
        "VIRTUAL_ENV": str(KILTED_FOLDER),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        # Another run of the same test, in another checkout, would be seen as well. There are the domains 0 to 101.
        "ROS_DOMAIN_ID": str((domain + os.getpid()) % 102),
        "ROS_LOG_DIR": str(log_folder),
    }


def build_interfaces(package: Path, folder: Path) -> Path:
    """Build an interface package as colcon would, and return the prefix that it is installed in."""
    prefix = folder / "prefix"
    tools = KILTED_FOLDER / "bin"
    settings = {
        "CMAKE_PREFIX_PATH": KILTED_FOLDER,
        "CMAKE_INSTALL_PREFIX": prefix,
        "CMAKE_MAKE_PROGRAM": tools / "ninja",
        "Python3_EXECUTABLE": tools / "python",
        "BUILD_TESTING": "OFF",
    }
    environment = ["env", f"AMENT_PREFIX_PATH={KILTED_FOLDER}", f"PATH={tools}:/usr/bin:/bin"]
    words = [f"-D{name}={value}" for name, value in settings.items()]
    build = str(folder / "build")
    run_judge(*environment, "cmake", "-G", "Ninja", "-S", str(package), "-B", build, *words)
    run_judge(*environment, "cmake", "--build", build, "--target", "install")
    return prefix
