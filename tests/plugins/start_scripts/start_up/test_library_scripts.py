"""What the scripts have in common, each alone: looking whether something is up, and becoming a program."""

from __future__ import annotations

import os
import subprocess
import time
from pathlib import Path

import pytest

from tests.plugins.start_scripts.start_up.started_workspaces import hold_ports
from tests.running import ROOT

LIBRARY = ROOT / "archgen/plugins/start_scripts/backends/start/assets/start/lib"


class Tools:
    """Runs a script with small programs in the place of ROS's."""

    def __init__(self, folder: Path) -> None:
        """Start without any."""
        self.folder = folder
        (folder / "bin").mkdir()

    def add(self, name: str, *lines: str) -> None:
        """Add a program: lines for a shell."""
        file = self.folder / "bin" / name
        file.write_text("\n".join(["#!/bin/sh", f"cd {self.folder}", *lines, ""]), encoding="utf-8")
        file.chmod(0o755)

    def run(self, script: str, *words: str, status: int = 0, **environment: str) -> str:
        """Run a script, which must end with a status, and return its output."""
        done = subprocess.run(  # noqa: S603 - our own script
            ["/usr/bin/env", "bash", str(LIBRARY / script), *words],
            cwd=self.folder,
            env={**os.environ, "PATH": f"{self.folder / 'bin'}:{os.environ['PATH']}", **environment},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            check=False,
            timeout=120,
        )
        assert done.returncode == status, done.stdout + done.stderr
        return done.stdout

    def look(self, *words: str, status: int = 0, **environment: str) -> str:
        """Look once, and return what is missing."""
        missing = self.folder / "missing"
        self.run("wait_until_up.sh", "--look", "--missing", str(missing), *words, status=status, **environment)
        return missing.read_text(encoding="utf-8").strip()


@pytest.fixture
def tools(tmp_path: Path) -> Tools:
    return Tools(tmp_path)


def test_ports_and_files(tools: Tools) -> None:
    with hold_ports(1) as (port,):
        assert tools.look("--port", str(port), status=1) == f"the port {port} does not accept connections"
    assert tools.look("--file", "x $(y)", status=1) == "there is no file x $(y)"
    (tools.folder / "x $(y)").touch()
    assert tools.look("--file", "x $(y)") == "there is no file x $(y)"


def test_words_of_the_output_that_are_no_older(tools: Tools) -> None:
    output = tools.folder / "output"
    output.write_text("old [ready]\n", encoding="utf-8")
    words = ("--output", str(output), str(output.stat().st_size), "--log", "[ready]")
    assert tools.look(*words, status=1) == 'its output does not hold "[ready]"'
    output.write_text("old [ready]\nnow [ready]\n", encoding="utf-8")
    tools.look(*words)
    tools.look("--output", str(output), "0", "--log", "[ready]\nnow")
    tools.look("--output", str(tools.folder / "none"), "0", "--log", "x", status=1)


def test_messages_and_services_of_both_generations(tools: Tools) -> None:
    tools.add("ros2", 'case "$*" in "topic echo --once /map"|*list) ;; *) exit 1 ;; esac', "cat $2")
    tools.add("rostopic", '[ "$*" = "echo -n 1 /map" ] && exit; [ "$1" = list ] && cat action')
    tools.add("rosservice", "cat list")
    (tools.folder / "list").write_text("/other\n/plan/x\n", encoding="utf-8")
    (tools.folder / "action").write_text("/dock/goal\n", encoding="utf-8")
    assert tools.look("--topic", "/maps", status=1) == "no message has come on /maps"
    assert tools.look("--service", "/plan", status=1) == "/plan is not offered"
    tools.look("--service", "/plan/x", "--topic", "/map", ROS_VERSION="1")
    tools.look("--service", "/dock", ROS_VERSION="1")
    tools.look("--service", "/plan", status=1, ROS_VERSION="1")
    tools.look("--service", "/plan/x")


def test_time_passes(tools: Tools) -> None:
    began = time.monotonic()
    tools.run("wait_until_up.sh", "--time", "0.4")
    assert time.monotonic() - began >= 0.4
    assert tools.look("--time", "100000000000", status=1) == "100000000000 s have not passed"


LIFECYCLE = ("--lifecycle", "/arm", "active", "configure activate")


def test_a_node_is_brought_into_its_state(tools: Tools) -> None:
    tools.add(
        "ros2",
        'case "$*" in',
        '"service list") echo /arm/change_state ;;',
        '"lifecycle set /arm configure") echo inactive > state ;;',
        '"lifecycle set /arm activate") echo "${AFTER:-active}" > state ;;',
        '"lifecycle get /arm") echo "$(cat state) [3]" ;;',
        "esac",
    )
    tools.run("wait_until_up.sh", *LIFECYCLE)
    missing = tools.folder / "missing"
    tools.run("wait_until_up.sh", "--missing", str(missing), *LIFECYCLE, status=2, AFTER="inactive")
    assert missing.read_text(encoding="utf-8") == "/arm is not active\n"


def test_what_cannot_be_loaded_never_comes_up(tools: Tools) -> None:
    tools.add(
        "ros2",
        '[ "$1" = service ] && echo /box/_container/load_node && exit',
        'echo "$@" > loaded',
        "exit ${STATUS:-0}",
    )
    words = ("--load", "/box", "--", "ros2", "component", "load", "/box", "a; b")
    tools.run("wait_until_up.sh", *words)
    assert (tools.folder / "loaded").read_text(encoding="utf-8") == "component load /box a; b\n"
    missing = tools.folder / "missing"
    tools.run("wait_until_up.sh", "--missing", str(missing), *words, status=2, STATUS="3")
    assert missing.read_text(encoding="utf-8") == "loading it into /box failed with status 3\n"


def test_a_program_is_prepared(tools: Tools) -> None:
    (tools.folder / "settings").write_text("A=from_settings $NONE\nexport A\n", encoding="utf-8")
    script = 'echo "$A|$B|$PWD|$*"'
    words = ("--settings", "settings", "--set", "B=$(x) 'y'", "--in", "in", "--before", "2", "touch", "made here")
    (tools.folder / "in").mkdir()
    said = tools.run("run.sh", *words, "--", "sh", "-c", script, "-", "a b", "", START_FOLDER=str(tools.folder))
    assert said == f"from_settings|$(x) 'y'|{tools.folder / 'in'}|a b \n"
    assert (tools.folder / "in" / "made here").exists()
    tools.run("run.sh", "--before", "1", "false", "--", "touch", "never", status=1, START_FOLDER=str(tools.folder))
    assert not (tools.folder / "never").exists()


def test_output_is_copied(tools: Tools) -> None:
    said = tools.run("run.sh", "--by-line", "--copy", "copy", "--", "printf", "a\nb", START_FOLDER=str(tools.folder))
    assert said == "a\nb"
    assert (tools.folder / "copy").read_text(encoding="utf-8") == "a\nb"


def test_parameters_are_the_output_of_commands(tools: Tools) -> None:
    tools.add("rosparam", 'printf "%s\\n" "$@" > param')
    value = ("printf", '<robot name="a">\n\\t\t</robot>')
    said = tools.run(
        "run.sh", "--value", "robot_description", "2", *value, "--", "echo", "--ros-args", START_FOLDER="/"
    )
    assert said == '--ros-args -p robot_description:="<robot name=\\"a\\">\\n\\t\\t</robot>"\n'
    tools.run("run.sh", "--value", "/arm/robot_description", "2", "printf", "a\nb", "--", "true", START_FOLDER="/")
    assert (tools.folder / "param").read_text(encoding="utf-8") == 'set\n/arm/robot_description\n"a\\nb"\n'
    tools.run("run.sh", "--value", "x", "1", "false", "--", "touch", "never", status=1, START_FOLDER=str(tools.folder))
