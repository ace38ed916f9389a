"""The same behaviours in Java and in Python give the same trace, byte by byte."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.plugins.middlewares.simulation.simulated_workspaces import build_java, generate, run_java, run_python
from tests.running import ROOT

pytestmark = pytest.mark.build
BEHAVIOURS = Path(__file__).parent / "cleaning_robot"


def test_the_cleaning_robot(tmp_path: Path) -> None:
    assert generate(ROOT / "examples" / "cleaning_robot", tmp_path) == []
    shutil.copytree(BEHAVIOURS / "java", tmp_path / "java" / "src" / "cleaning_robot", dirs_exist_ok=True)
    shutil.copytree(BEHAVIOURS / "python", tmp_path / "python" / "cleaning_robot_simulation", dirs_exist_ok=True)
    build_java(tmp_path)
    words = (str(BEHAVIOURS / "scenario.txt"), "--until", "1s")
    java = run_java(tmp_path, "cleaning_robot.Main", *words)
    python = run_python(tmp_path, "cleaning_robot_simulation", *words)
    assert java[0] == python[0] == 0, (java[2], python[2])
    assert java[1].splitlines() == python[1].splitlines()
    assert java == python
    trace = java[1]
    for line in (
        (
            '430000000 > cleaning.localization.pose_fusion.p {"header":{"stamp":{"sec":0,"nanosec":0},"frame_id":""},'
            '"pose":{"position":{"x":1e+300,"y":-0.0,"z":NaN},"orientation":{"x":0.0,"y":0.0,"z":0.0,"w":1.0}}}'
        ),
        '150000000 < cleaning.localization.gps.signals "second\\n"',
        '500000001 > cleaning.left_arm.shoulder.torque "left_shoulder turns"',
    ):
        assert f"{line}\n" in trace
    # What navigation sends goes through controller, planner and motors to the watch of the arm, and back.
    assert '"mode":{"value":2}' in trace
    assert run_java(tmp_path, "cleaning_robot.ArchitectureTest") == (0, "3 tests passed\n", "")
    assert run_python(tmp_path, "unittest", "-q", "cleaning_robot_simulation.test_architecture")[0] == 0
    # A scenario with a slip is refused in the same words.
    for slip in (
        "x",
        "1ms < a.b 1",
        "1.5 < cleaning.smooth.raw {}",
        '1 < cleaning.smooth.raw {"pos": 1}',
        "1 < cleaning.smooth.raw []",
        # No blank line: only spaces and tabs are blank.
        "\u00a0",
    ):
        (tmp_path / "slip.txt").write_text(f"# one\n{slip}\n", "utf-8")
        java = run_java(tmp_path, "cleaning_robot.Main", str(tmp_path / "slip.txt"))
        python = run_python(tmp_path, "cleaning_robot_simulation", str(tmp_path / "slip.txt"))
        assert java == python
        assert java[0] == 1
        assert "slip.txt:2: " in java[2]
