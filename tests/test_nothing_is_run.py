"""Whatever a project says of commands, archgen runs none of them: not by a verb, and not by a process that a verb starts."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.running import ROOT

TRAPS = ("stage", "xacro", "ros2", "rosrun", "roslaunch", "sudo", "ip", "colcon", "launch.sh", "chronyd")
"""Programs that lie first on the path, and leave a trace when somebody runs them."""
PROJECT = """\
archgen: 1
project: {id: hostile, title: Hostile}
ros: {distro: jazzy, parameters: {use_sim_time: true}}
groups:
  g:
    components:
      a: {outputs: {o: std_msgs/msg/Bool}, node: {command: [stage, $(touch trace), "; touch trace"], start: {once: true}}}
      b: {inputs: {i: a.o}}
nodes:
  b:
    implements: b
    package: "p; touch trace"
    executable: "`touch trace`"
    parameter_commands: {robot_description: [xacro, arm.xacro]}
    parameter_files: [launch.sh, params.yaml]
    start: {after: sim, environment: {LD_PRELOAD: ./evil.so, PATH: .}, directory: /, user: root, ready: {file: /etc/shadow, log: "|touch trace"}}
  sim: {kind: program, command: [sudo, bash, -c, "touch trace"], start: {phase: network, ready: {port: 22}}}
  script: {kind: program, command: [./launch.sh], start: {phase: simulators}}
"""
AUDITED = """\
import json
import os
import sys
started = []
def note(event, arguments):
    if event in {"subprocess.Popen", "os.posix_spawn", "os.exec", "os.system", "os.startfile", "pty.spawn"}:
        words = arguments[1] if event == "subprocess.Popen" else arguments
        program = arguments[0] or (words if isinstance(words, str) else words[0])
        started.append(f"{os.path.basename(os.fsdecode(program))} {words!r}")
sys.addaudithook(note)
from archgen.cli import main
for words in json.loads(sys.argv[2]):
    try:
        main(words)
    except SystemExit:
        pass
open(sys.argv[1], "a").write("\\n".join(started) + "\\n")
"""


@pytest.fixture
def hostile_project(tmp_path: Path) -> Path:
    folder = tmp_path / "project"
    folder.mkdir()
    (folder / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    (folder / "params.yaml").write_text("b: {ros__parameters: {x: $(touch trace)}}\n", encoding="utf-8")
    (folder / "arm.xacro").write_text("<robot/>", encoding="utf-8")
    traps = tmp_path / "traps"
    traps.mkdir()
    for trap in [*(traps / name for name in TRAPS), folder / "launch.sh", folder / "start.launch.py"]:
        trap.write_text(f"#!/bin/sh\necho {trap.name} >> {tmp_path / 'trace'}\n", encoding="utf-8")
        trap.chmod(0o755)
    return folder


def test_no_verb_runs_a_command_of_a_project(hostile_project: Path, tmp_path: Path) -> None:
    script, journal = tmp_path / "audited.py", tmp_path / "journal"
    script.write_text(AUDITED, encoding="utf-8")
    journal.touch()
    environment = {
        **os.environ,
        "PATH": f"{tmp_path / 'traps'}{os.pathsep}{os.environ['PATH']}",
        "PYTHONPATH": str(ROOT),
    }
    verbs = [
        ["check"],
        ["start"],
        ["start", "--format", "json"],
        ["list", "--of", "start_up"],
        ["show", "b"],
        ["pack", "-o", "packed.yaml"],
        ["transform", "monitor", "flatten", "-o", "flat.yaml", "--keep-going"],
        ["build", "-o", "out", "--keep-going"],
        ["generate", "start", "-o", "robot", "--keep-going"],
    ]
    result = subprocess.run(  # noqa: S603 - our own program
        [sys.executable, str(script), str(journal), json.dumps(verbs)],
        cwd=hostile_project,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert (result.returncode, "Traceback" in result.stderr) == (0, False), result.stderr
    assert (hostile_project / "out" / "site" / "start_up.html").is_file()
    assert (hostile_project / "robot" / "start.sh").is_file()
    started = [line for line in journal.read_text(encoding="utf-8").splitlines() if line]
    assert started, "the journal sees what is started: git and Graphviz at least"
    assert {line.split()[0] for line in started} <= {"git", "dot", Path(sys.executable).name}
    assert not [line for line in started if "touch" in line]
    assert not (tmp_path / "trace").exists()
    assert not list(hostile_project.rglob("trace"))
