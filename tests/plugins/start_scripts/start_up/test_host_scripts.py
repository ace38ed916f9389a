"""The scripts that `archgen generate start` makes, run: order, waiting, failures, and that nothing is left behind."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.plugins.start_scripts.start_up.started_workspaces import Run, Stage, hold_ports, make_workspace

PROJECT = """\
archgen: 1
project: {id: robot, title: Robot}
groups:
  g:
    components:
      a: {outputs: {o: std_msgs/msg/Bool}, node: {kind: program, command: [camera, --fast], start: {ready: {log: says hello}}}}
      b: {inputs: {i: a.o}, node: {kind: program, command: [finder], start: {ready: {log: says hello}}}}
nodes:
  clock: {kind: program, command: [set_clock], start: {phase: network, once: true}}
  world: {kind: program, command: [simulator], start: {phase: simulators, ready: {port: PORT, file: /proc, within: WITHIN}}}
"""
PROGRAMS = {"set_clock": "clock", "simulator": "world", "camera": "a", "finder": "b"}
NEEDS = {"world": ["clock"], "a": ["world"], "b": ["a", "world"]}


@pytest.fixture(scope="module")
def port() -> Iterator[int]:
    with hold_ports(1) as (port,):
        yield port


@pytest.fixture(scope="module")
def script(tmp_path_factory: pytest.TempPathFactory, port: int) -> Path:
    return make_script(tmp_path_factory.mktemp("robot"), port)


def make_script(folder: Path, port: int, *, within: str = "60 s", old: str = "", new: str = "") -> Path:
    (folder / "project").mkdir()
    text = PROJECT.replace("PORT", str(port)).replace("WITHIN", within).replace(old or " ", new or " ")
    (folder / "project" / "archgen.yaml").write_text(text, encoding="utf-8")
    return make_workspace(folder / "project", folder / "ws") / "start.sh"


def start(script: Path, folder: Path, port: int, **settings: Any) -> tuple[Run, Stage]:  # noqa: ANN401 - any data
    wanted = {"needs": NEEDS, "ports": {"world": port}, "ends": {"clock": 0}, **settings}
    stage = Stage(folder / "stage", PROGRAMS, **wanted)
    return Run(script, stage), stage


def test_it_starts_in_order_and_stops_in_reverse(script: Path, port: int, tmp_path: Path) -> None:
    run, stage = start(script, tmp_path, port)
    run.wait_for("up        all: 4 steps")
    run.send(signal.SIGINT)
    assert run.wait_for_end() == 0
    assert stage.journal == [
        "start clock",
        "end clock",
        "start world",
        "start a",
        "start b",
        "stop b",
        "stop a",
        "stop world",
    ]
    assert {file.name for file in run.log_folder.iterdir()} == {"clock.log", "world.log", "a.log", "b.log", "start.log"}
    assert (run.log_folder / "a.log").read_text(encoding="utf-8") == "a says hello\n\n"
    assert (run.log_folder / "start.log").read_text(encoding="utf-8") == run.output
    assert stage.read_told("a")[0]["words"] == ["camera", "--fast"]
    assert stage.read_told("a")[0]["folder"] == str(script.parent)


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_in_the_middle_stops_what_was_started(
    script: Path, port: int, tmp_path: Path, number: signal.Signals
) -> None:
    run, stage = start(script, tmp_path, port, ports={})
    run.wait_for("starting  world")
    run.wait_until(lambda: "start world" in stage.journal and run.is_missed("world"))
    run.send(number)
    assert run.wait_for_end() == 128 + number
    assert stage.journal == ["start clock", "end clock", "start world", "stop world"]
    assert f"not up    world: the port {port} does not accept connections" in run.output
    assert "not up    a: not started, it was not its turn" in run.output
    assert "not up    b: not started, it waits for a" in run.output


@pytest.mark.slow
def test_the_end_of_one_program_stops_all_and_is_said(script: Path, port: int, tmp_path: Path) -> None:
    run, stage = start(script, tmp_path, port)
    run.wait_for("up        all: 4 steps")
    os.kill(stage.read_process("a"), signal.SIGKILL)
    assert run.wait_for_end() == 1
    assert "failed    a: it was ended by SIGKILL" in run.output
    assert "not up    a: it was ended by SIGKILL" in run.output
    assert stage.journal[-2:] == ["stop b", "stop world"]


def test_a_program_that_fails_is_said_with_the_end_of_its_log(script: Path, port: int, tmp_path: Path) -> None:
    run, stage = start(script, tmp_path, port, needs={"a": ["what is not there"]})
    assert run.wait_for_end() == 1
    assert "failed    a: it ended with status 9" in run.output
    assert "            | needs what is not there" in run.output
    assert "start b" not in stage.journal
    assert stage.journal[-1] == "stop world"


def test_a_step_that_runs_once_and_fails_ends_the_start(script: Path, port: int, tmp_path: Path) -> None:
    run, stage = start(script, tmp_path, port, ends={"clock": 4})
    assert run.wait_for_end() == 1
    assert "failed    clock: it ended with status 4" in run.output
    assert stage.journal == ["start clock", "end clock"]


@pytest.mark.slow  # it waits for seconds, as the script does
def test_what_does_not_listen_is_killed_with_all_that_it_started(script: Path, port: int, tmp_path: Path) -> None:
    run, _ = start(script, tmp_path, port, manners={"world": "deaf", "b": "parent"}, patience=1)
    run.wait_for("up        all: 4 steps")
    run.send(signal.SIGTERM)
    assert run.wait_for_end() == 0
    assert "killing   world: it does not end by itself" in run.output


@pytest.mark.slow  # it waits for seconds, as the script does
def test_what_does_not_end_by_an_interrupt_is_terminated(script: Path, port: int, tmp_path: Path) -> None:
    run, stage = start(script, tmp_path, port, manners={"a": "stubborn"}, patience=8)
    run.wait_for("up        all: 4 steps")
    run.send(signal.SIGTERM)
    assert run.wait_for_end() == 0
    assert "killing" not in run.output
    assert stage.journal[-3:] == ["stop b", "stop a", "stop world"]


@pytest.mark.slow
def test_when_the_script_itself_is_killed_nothing_is_left(script: Path, port: int, tmp_path: Path) -> None:
    run, _ = start(script, tmp_path, port)
    run.wait_for("up        all: 4 steps")
    run.send(signal.SIGKILL)
    run.wait_for_nothing_left()


def test_where_no_log_can_be_written_nothing_starts(script: Path, port: int, tmp_path: Path) -> None:
    stage = Stage(tmp_path / "stage", PROGRAMS, needs=NEEDS, ports={"world": port}, ends={"clock": 0})
    done = subprocess.run(  # noqa: S603 - the script that was just generated
        ["bash", script],  # noqa: S607
        env={**stage.environment, "START_LOGS": "/proc/logs"},
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    assert done.returncode == 2
    assert "/proc/logs" in done.stderr
    assert stage.journal == []


@pytest.mark.slow
def test_it_needs_no_home(script: Path, port: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("HOME", "USER", "LOGNAME", "TMPDIR"):
        monkeypatch.delenv(name, raising=False)
    run, stage = start(script, tmp_path, port)
    run.wait_for("up        all: 4 steps")
    run.send(signal.SIGTERM)
    assert run.wait_for_end() == 0
    assert stage.journal.count("start world") == 1


@pytest.mark.slow
def test_it_does_not_run_twice(script: Path, port: int, tmp_path: Path) -> None:
    run, stage = start(script, tmp_path, port)
    run.wait_for("up        all: 4 steps")
    output = run.output
    second = Run(script, stage)
    assert second.process.wait(timeout=120) == 2
    assert second.output.startswith("What runs on no-host is running already; its logs are in ")
    run.output_file.write_text(output, encoding="utf-8")
    run.send(signal.SIGTERM)
    assert run.wait_for_end() == 0
    assert stage.journal.count("start world") == 1


@pytest.mark.slow  # it waits for seconds, as the script does
def test_what_respawns_starts_again(port: int, tmp_path: Path) -> None:
    script = make_script(
        tmp_path, port, old="[finder], start: {", new="[finder], start: {respawn: true, respawn_delay: 1 s, "
    )
    run, stage = start(script, tmp_path, port, manners={"b": "short"})
    run.wait_for("again     b")
    run.wait_for("up        all: 4 steps")
    assert "ended     b: it ended with status 3, and starts again in 1 s" in run.output
    run.send(signal.SIGINT)
    assert run.wait_for_end() == 0
    assert [line for line in stage.journal if line.endswith(" b")] == ["start b", "fall b", "start b", "stop b"]


LIFECYCLE_PROJECT = """\
archgen: 1
project: {id: robot}
ros: {distro: jazzy}
groups: {g: {components: {arm: {outputs: {o: {type: std_msgs/msg/Bool, external: Somebody}}}}}}
nodes: {arm: {implements: arm, kind: lifecycle, package: p, executable: arm_node, start: {state: active, respawn: true, respawn_delay: 1 s, ready: {within: 60 s}}}}
"""


@pytest.mark.slow  # it waits for seconds, as the script does
def test_a_lifecycle_node_that_respawns_is_brought_into_its_state_again(tmp_path: Path) -> None:
    (tmp_path / "project").mkdir()
    (tmp_path / "project" / "archgen.yaml").write_text(LIFECYCLE_PROJECT, encoding="utf-8")
    script = make_workspace(tmp_path / "project", tmp_path / "ws") / "start.sh"
    stage = Stage(tmp_path / "stage", {"arm_node": "arm"}, services={"/arm/change_state": "arm"})
    run = Run(script, stage)
    run.wait_for("up        all: 1 step")
    os.kill(stage.read_process("arm"), signal.SIGTERM)
    run.wait_until(lambda: stage.journal.count("activate /arm") == 2)
    run.wait_until(lambda: run.output.count("up        arm") == 2)
    run.send(signal.SIGINT)
    assert run.wait_for_end() == 0
    assert [line for line in stage.journal if not line.startswith("stop")] == 2 * [
        "start arm",
        "configure /arm",
        "activate /arm",
    ]


@pytest.mark.slow
def test_what_is_not_up_in_time_is_said(port: int, tmp_path: Path) -> None:
    run, stage = start(make_script(tmp_path, port, within="500 ms"), tmp_path, port, ports={})
    assert run.wait_for_end() == 1
    assert f"failed    world: not up within 0.5 s: the port {port} does not accept connections" in run.output
    assert "start a" not in stage.journal


@pytest.mark.slow
def test_what_runs_once_has_its_time(port: int, tmp_path: Path) -> None:
    script = make_script(tmp_path, port, old="once: true", new="once: true, ready: {within: 1 s}")
    run, _ = start(script, tmp_path, port, ends={})
    assert run.wait_for_end() == 1
    assert "failed    clock: not at its end within 1 s" in run.output


def test_missing_programs_are_said_before_anything_starts(port: int, tmp_path: Path) -> None:
    script = make_script(tmp_path, port, old="[finder]", new="[no_such_finder]")
    run, stage = start(script, tmp_path, port)
    assert run.wait_for_end() == 2
    assert run.output == "b needs the program no_such_finder, which is not on the path\nNothing was started.\n"
    assert stage.journal == []


def test_cores_that_a_computer_lacks_are_said_before_anything_starts(port: int, tmp_path: Path) -> None:
    script = make_script(tmp_path, port, old="i: a.o}", new="i: a.o}, timing: {core: 900}")
    run, stage = start(script, tmp_path, port)
    assert run.wait_for_end() == 2
    assert run.output.startswith(
        "b cannot be started with taskset -c 900: that needs rights (rtprio in limits.conf) and"
    )
    assert "START_SCHEDULING=no" in run.output
    assert stage.journal == []


def test_settings_are_the_users_own(port: int, tmp_path: Path) -> None:
    script = make_script(
        tmp_path, port, old="once: true", new="once: true, environment: {CLOCK: \"$(date) 'x'\"}, directory: bin"
    )
    settings = script.with_name("settings.sh")
    settings.write_text(f"export OF_ROS=yes $UNSET\nSTART_FOLDER={tmp_path / 'stage'}\n", encoding="utf-8")
    run, stage = start(script, tmp_path, port)
    run.wait_for("ended     clock")
    run.send(signal.SIGTERM)
    run.wait_for_end()
    (told,) = stage.read_told("clock")
    assert told["folder"] == str(tmp_path / "stage" / "bin")
    assert told["environment"]["CLOCK"] == "$(date) 'x'"
    assert told["environment"]["OF_ROS"] == "yes"
