"""Random architectures with the same behaviours in Java and in Python give the same trace, byte by byte."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tests.outside_tools import QUICK_START, find_tool, run_judge
from tests.plugins.middlewares.simulation.random_robots import Robot, make_robot, make_scenario
from tests.plugins.middlewares.simulation.robot_behaviours import write_behaviours
from tests.plugins.middlewares.simulation.simulated_workspaces import generate, run_python

pytestmark = pytest.mark.build
SEEDS = range(6)


def make_workspace(folder: Path, robot: Robot, seed: int) -> None:
    """Generate the programs of a robot, and write what its components do, and a scenario."""
    (folder / "project").mkdir(parents=True)
    (folder / "project" / "archgen.yaml").write_text(robot.text, "utf-8")
    assert generate(folder / "project", folder) == []
    write_behaviours(robot, folder)
    (folder / "scenario.txt").write_text(make_scenario(robot, seed), "utf-8")


def run_all_in_java(folder: Path, robots: list[Robot]) -> dict[str, str]:
    """Compile all programs at once, and run them one after the other in one process; return the traces."""
    runs = "".join(
        f"""\
        try (PrintStream out = new PrintStream("{each.name}.txt", "UTF-8")) {{
            if (Command.run({each.name}.{each.name.capitalize()}System::new, new String[] {{"{each.name}/scenario.txt", "--until", "41ms"}}, out, System.err) != 0) {{
                throw new IllegalStateException("{each.name}");
            }}
        }}
"""
        for each in robots
    )
    (folder / "RunAll.java").write_text(
        "import archgen.runtime.Command;\nimport java.io.PrintStream;\n\n"
        f"class RunAll {{\n    public static void main(String[] words) throws Exception {{\n{runs}    }}\n}}\n",
        "utf-8",
    )
    sources = [f"{robots[0].name}/java/runtime"]
    sources += [f"{each.name}/java/{place}" for each in robots for place in ("generated", "src")]
    options = ["-Xlint:all", "-Werror", "-encoding", "UTF-8", "--release", "17", "-d", "build"]
    quick = [f"-J{each}" for each in QUICK_START]
    for command in (
        [find_tool("javac"), *quick, *options, "--source-path", os.pathsep.join(sources), "RunAll.java"],
        [find_tool("java"), *QUICK_START, "-cp", "build", "RunAll"],
    ):
        done = run_judge(*command, cwd=folder)
        assert done.stdout + done.stderr == ""
    return {each.name: (folder / f"{each.name}.txt").read_bytes().decode("ascii") for each in robots}


def test_random_architectures(tmp_path: Path) -> None:
    robots = [make_robot(seed) for seed in SEEDS]
    for seed, robot in zip(SEEDS, robots, strict=True):
        make_workspace(tmp_path / robot.name, robot, seed)
    in_java = run_all_in_java(tmp_path, robots)
    marks = set()
    for robot in robots:
        words = (f"{robot.name}_simulation", str(tmp_path / robot.name / "scenario.txt"), "--until", "41ms")
        status, trace, errors = run_python(tmp_path / robot.name, *words)
        assert (status, errors) == (0, ""), robot.name
        assert in_java[robot.name].splitlines() == trace.splitlines(), robot.name
        assert in_java[robot.name] == trace
        lines = [each.split(" ") for each in trace.splitlines()]
        # Nearly all have something to do.
        assert len({port.rpartition(".")[0] for _, mark, port, *_ in lines if mark == ">"}) > 3, robot.name
        marks |= {mark for _, mark, *_ in lines}
    assert marks == set("<>?~!")
