"""The tutorial is done as it is written: files, commands, what is said, and a rover that moves under a real ROS."""

from __future__ import annotations

import contextlib
import re
import subprocess
import sys
from pathlib import Path

import pytest

from archgen.diagnostics.diagnostic import Severity
from archgen.pipeline import check_project
from tests.outside_tools import run_judge
from tests.plugins.ros_code.test_ros2_python import AMENT_FLAKE8
from tests.ros_environment import NEWEST_PYTHON, ROS_FOLDER, make_ros_python, ros_environment
from tests.running import ROOT, archgen_here

PAGE = (ROOT / "docs" / "tutorial_robot.md").read_text(encoding="utf-8")
FILES = dict(re.findall(r"^```\w+\n# ([\w/]+\.\w+)\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL))
COMMANDS = re.findall(r"^    archgen (.*)$", PAGE, re.MULTILINE)
SCRIPTS = re.findall(r"^```bash\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
(CHANGED_LINES,) = re.findall(r"^```yaml\n# archgen.yaml, changed\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


def write(folder: Path, name: str) -> None:
    file = folder / name
    # What is written by hand takes the place of what archgen wrote once.
    assert file.exists() or not name.startswith("ws/")
    file.write_text(FILES[name], encoding="utf-8")


@pytest.fixture
def rover(tmp_path: Path) -> Path:
    """Do what the page says up to the third step."""
    write(tmp_path, "archgen.yaml")
    assert COMMANDS[:2] == ["check", "generate ros2_python -o ws"]
    for command in COMMANDS[:2]:
        archgen_here(*command.split(), cwd=tmp_path)
    for name in FILES:
        if name != "archgen.yaml":
            write(tmp_path, name)
    return tmp_path


def test_all_of_the_page_is_done_here() -> None:
    assert list(FILES) == [
        "archgen.yaml",
        "ws/src/rover_drive/rover_drive/body.py",
        "ws/src/rover_drive/rover_drive/explorer.py",
        "watch.py",
    ]
    assert COMMANDS == [
        "check",
        "generate ros2_python -o ws",
        "generate ros2_launch -o ws",
        "generate ros2_python -o ws",
    ]
    assert len(SCRIPTS) == 3


def test_nothing_is_wrong_with_it(rover: Path) -> None:
    findings = check_project(rover).findings
    assert [each.message for each in findings if each.effective_severity > Severity.NOTE] == []


def test_own_code_is_written_as_ros_developers_write(rover: Path) -> None:
    command = [sys.executable, "-m", "flake8", "--isolated", "--jobs=1", *AMENT_FLAKE8, str(rover / "ws")]
    done = run_judge(*command)
    assert done.stdout == ""


def test_there_is_a_launch_file_of_the_name_that_is_started(rover: Path) -> None:
    archgen_here(*COMMANDS[2].split(), cwd=rover)
    (package, file) = re.findall(r"ros2 launch (\w+) (\S+)", SCRIPTS[2])[0]
    assert (rover / "ws" / "src" / package / "launch" / file).is_file()


def test_a_change_is_said_and_own_code_stays(rover: Path) -> None:
    text = (rover / "archgen.yaml").read_text()
    outputs, inputs, charge = CHANGED_LINES.splitlines()
    text = re.sub(r"^ +outputs: \{distance.*$", outputs, text, flags=re.MULTILINE)
    text = re.sub(r"^ +inputs: \{distance.*$", inputs, text, flags=re.MULTILINE)
    (rover / "archgen.yaml").write_text(text.replace("types:\n", f"types:\n{charge}\n"), encoding="utf-8")
    done = archgen_here(*COMMANDS[3].split(), cwd=rover, status=1)
    (error,) = re.findall(r"^error: .*$", PAGE, re.MULTILINE)
    assert error in done.stderr.decode()
    own = "ws/src/rover_drive/rover_drive/explorer.py"
    assert (rover / own).read_text() == FILES[own]
    assert "publish_battery" in (rover / "ws/src/rover_drive/rover_drive/body_node.py").read_text()


@pytest.mark.ros
def test_the_rover_moves(rover: Path) -> None:
    if sys.version_info[:2] > NEWEST_PYTHON or sys.platform != "linux":
        pytest.skip(f"there is no ROS 2 for {sys.platform} and Python {sys.version.split()[0]}")
    make_ros_python()
    assert SCRIPTS[0].startswith("python3 -m venv ros\n")
    (rover / "ros").symlink_to(ROS_FOLDER)
    environment = ros_environment(63, rover)
    command = ["bash", "-e", "-c", SCRIPTS[1]]
    started = subprocess.Popen(  # noqa: S603 - the page's own
        command, cwd=rover, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    for _ in range(6):
        with contextlib.suppress(subprocess.TimeoutExpired):
            started.wait(60)
            break
        # A node in Python may sleep on after a signal (see `interrupt_node`): the next one ends it.
        subprocess.run(["pkill", "-TERM", "-P", str(started.pid)], check=False)  # noqa: S603, S607
    started.kill()
    output, errors = started.communicate(timeout=60)
    assert started.returncode == 0, errors
    places = [(line.index(mark), mark) for line in output.splitlines() for mark in "<>" if mark in line]
    assert len(places) == 32
    assert {mark for _, mark in places} == {"<", ">"}
    assert max(place for place, _ in places) - min(place for place, _ in places) > 10
    # It turns before it is at the wall.
    assert max(place for place, _ in places) < 40
