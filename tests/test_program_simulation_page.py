"""The page on programs that run the architecture: its commands, behaviours and scenario do what it says, in both languages."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from tests.outside_tools import QUICK_START, find_tool, run_judge
from tests.running import ROOT, archgen_here

pytestmark = pytest.mark.build
PAGE = (ROOT / "docs" / "program_simulation.md").read_text(encoding="utf-8")
FENCED = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
BLOCKS = FENCED.findall(PAGE)
COMMANDS = re.findall(r"^    (\S[^#\n]*)", FENCED.sub("", PAGE), re.MULTILINE)
BUSY_MOTOR = '600ms < cleaning.left_arm.shoulder.target {"position": 1.5}\n'
"""The page's scenario gives no motor work; the left one may turn at 1.0 at most."""


def test_the_page_shows_what_is_run_here() -> None:
    assert [kind for kind, _ in BLOCKS] == ["java", "python", "text", "text"]
    assert [each.split()[0] for each in COMMANDS] == ["archgen"] * 2 + "cd javac java java cd python3".split()  # noqa: SIM905


def fill_motor(sim: Path) -> None:
    """Give the motor the page's `fire` in both languages."""
    java = sim / "java" / "src" / "cleaning_robot" / "types" / "MotorBehaviour.java"
    head, _, _ = java.read_text("utf-8").partition("    @Override")
    imports = "\n\nimport cleaning_robot.data.sensor_msgs.JointState;\nimport java.util.List;\n"
    fire = dict(BLOCKS)["java"]
    java.write_text(f"{head.replace(';', ';' + imports, 1)}    @Override\n{fire}}}\n", "utf-8")
    python = sim / "python" / "cleaning_robot_simulation" / "types" / "motor_behaviour.py"
    head, _, _ = python.read_text("utf-8").partition("    def fire")
    fire = "".join(f"    {line}\n" for line in dict(BLOCKS)["python"].splitlines())
    python.write_text(f"from ..data import sensor_msgs\n{head}{fire}", "utf-8")


def run_there(command: str, folder: Path) -> str:
    """Run a command of the page, and return what it prints."""
    program, *words = command.split()
    found = {"python3": sys.executable, "java": find_tool("java"), "javac": find_tool("javac")}[program]
    options = {"javac": [f"-J{each}" for each in QUICK_START], "java": [*QUICK_START], "python3": ["-B"]}[program]
    done = run_judge(found, *options, *words, cwd=folder)
    assert done.stderr == "", command
    return done.stdout


def test_the_page(tmp_path: Path) -> None:
    sim = tmp_path / "sim"
    folder = tmp_path
    printed: dict[str, str] = {}
    scenario, trace = (text for kind, text in BLOCKS if kind == "text")
    for command in COMMANDS:
        words = command.replace("~/sim", str(sim)).split()
        if words[0] == "archgen":
            archgen_here(*words[1:], cwd=ROOT / "examples" / "cleaning_robot")
        elif words[0] == "cd":
            folder = Path(words[1])
            (folder / "scenario.txt").write_text(scenario + BUSY_MOTOR, "utf-8")
            fill_motor(sim)
        else:
            printed[command.strip()] = run_there(command, folder)
    _, in_java, java_test, in_python = printed.values()
    assert java_test == "3 tests passed\n"
    assert in_java == in_python
    for line in trace.splitlines():
        assert re.search("^" + re.escape(line).replace(r"\{\.\.\.\}", r"\{.*\}") + "$", in_java, re.MULTILINE), line
    moved = r'^600000000 > cleaning\.left_arm\.shoulder\.state \{.*"position":\[1\.0\],.*\}$'
    assert re.search(moved, in_java, re.MULTILINE)
