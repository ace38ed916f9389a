"""The courier's start-up on two computers: one script above conducts those of the computers, which are both this one."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.plugins.start_scripts.start_up.started_workspaces import Run, Stage, copy_example, hold_ports, make_workspace

PROGRAMS = {"chronyd": "set_clock", "stage": "stage", "parcel-registry": "parcel_registry"}


@pytest.fixture(scope="module")
def ports() -> Iterator[list[int]]:
    with hold_ports(2) as ports:
        yield ports


@pytest.fixture(scope="module")
def script(tmp_path_factory: pytest.TempPathFactory, ports: list[int]) -> Path:
    folder = tmp_path_factory.mktemp("courier")
    hello = "ready: {log: says hello, within: 90 s}"
    replacements = {
        "port: 6665": f"port: {ports[0]}",
        "port: 8080": f"port: {ports[1]}",
        "within: 10 s": "within: 90 s",
        "within: 20 s": "within: 90 s",
        "within: 30 s": "within: 90 s",
        "directory: /opt/courier": "directory: .",
        "start: {phase: core}": f"start: {{phase: core, {hello}}}",
        "by: navigation_manager}": f"by: navigation_manager, {hello}}}",
        "after: parcel_registry,": f"after: parcel_registry, {hello},",
        "after: [navigation_manager],": f"after: [navigation_manager], {hello},",
    }
    project = copy_example("bringup", folder / "project", replacements)
    # What a container loads has no output of its own.
    text = (project / "start_up.yaml").read_text(encoding="utf-8")
    loaded = f"container: navigation\n    start: {{by: navigation_manager, {hello}}}"
    assert loaded in text
    text = text.replace(loaded, "container: navigation\n    start: {by: navigation_manager}")
    (project / "start_up.yaml").write_text(text, encoding="utf-8")
    return make_workspace(project, folder / "ws") / "start.sh"


def start(script: Path, folder: Path, ports: list[int], *words: str) -> tuple[Run, Stage]:
    stage = make_stage(folder, ports)
    return Run(script, stage, *words), stage


def make_stage(folder: Path, ports: list[int]) -> Stage:
    return Stage(
        folder / "stage",
        PROGRAMS,
        ports={"stage": ports[0], "parcel_registry": ports[1]},
        says={"stage": "physics running"},
        ends={"set_clock": 0},
        topics={"/map": "lifecycle_manager"},
        services={"/navigation/_container/load_node": "navigation", "/dispatcher/change_state": "dispatcher"},
    )


@pytest.mark.slow
def test_each_computer_waits_for_the_other(script: Path, ports: list[int], tmp_path: Path) -> None:
    run, stage = start(script, tmp_path, ports, "--all-here")
    run.wait_for("all: 12 steps on 2 computers")
    events = run.events
    for first, second in (
        (("ended", "set_clock"), ("starting", "stage")),
        (("up", "stage"), ("starting", "parcel_registry")),
        (("up", "map_server"), ("starting", "amcl")),
        (("up", "navigation_manager"), ("starting", "display")),
        # Its manager waits only until it is started.
        (("starting", "map_server"), ("starting", "lifecycle_manager")),
        (("starting", "lifecycle_manager"), ("up", "map_server")),
    ):
        assert events.index(first) < events.index(second)
    journal = stage.journal
    for line in (
        "load nav2_planner::PlannerServer into /navigation",
        "load nav2_controller::ControllerServer into /navigation",
        "start navigation",
        "activate /dispatcher",
    ):
        assert line in journal
    assert journal.index("configure /dispatcher") < journal.index("activate /dispatcher")
    run.send(signal.SIGINT)
    assert run.wait_for_end() == 0
    stopped = [line.partition(" ")[2] for line in stage.journal if line.startswith("stop")]
    assert stopped[0] == "display"
    assert stopped[-1] == "stage"
    assert stopped.index("dispatcher") < stopped.index("navigation") < stopped.index("parcel_registry")


@pytest.mark.slow
def test_what_fails_on_one_computer_stops_both(script: Path, ports: list[int], tmp_path: Path) -> None:
    run, stage = start(script, tmp_path, ports, "--all-here")
    run.wait_for("up        parcel_registry")
    os.kill(stage.read_process("stage"), signal.SIGKILL)
    assert run.wait_for_end() == 1
    assert "[sim_pc]" in run.output
    assert "ending    all: because of stage on sim_pc" in run.output
    assert "stop parcel_registry" in stage.journal


@pytest.mark.slow  # it waits for seconds, as the script does
def test_when_the_script_above_is_killed_the_others_stop(script: Path, ports: list[int], tmp_path: Path) -> None:
    run, _ = start(script, tmp_path, ports, "--all-here")
    run.wait_for("up        parcel_registry")
    run.send(signal.SIGKILL)
    run.wait_for_nothing_left()
    assert "ending    all: the script above is gone" in run.output


def test_it_has_to_be_told_how_to_reach_the_computers(script: Path, ports: list[int], tmp_path: Path) -> None:
    run, stage = start(script, tmp_path, ports)
    assert run.wait_for_end() == 2
    assert "bash start/hosts/sim_pc.sh    # Computer of the simulator" in run.output
    assert stage.journal == []


@pytest.mark.slow
def test_it_reaches_others_by_ssh(script: Path, ports: list[int], tmp_path: Path) -> None:
    stage = make_stage(tmp_path, ports)
    stage.add_program("ssh", f'echo "$@" >> {tmp_path}/ssh; for line; do :; done; exec sh -c "$line"')
    run = Run(script, stage, "--here", "robot_pc")
    run.wait_for("starting  parcel_registry")
    assert (
        (tmp_path / "ssh")
        .read_text(encoding="utf-8")
        .startswith(f"-T -o BatchMode=yes -- sim_pc cd {script.parent} && exec bash start/hosts/sim_pc.sh --follow ")
    )
    run.send(signal.SIGTERM)
    assert run.wait_for_end() == 128 + signal.SIGTERM


@pytest.mark.slow  # it waits for seconds, as the script does
def test_alone_a_computer_waits_for_what_it_sees_of_others(script: Path, ports: list[int], tmp_path: Path) -> None:
    settings = script.with_name("settings.sh")
    before = settings.read_text(encoding="utf-8")
    settings.write_text(f"{before}address[sim_pc]=localhost\n", encoding="utf-8")
    try:
        run, _ = start(script.parent / "start" / "hosts" / "robot_pc.sh", tmp_path, ports)
        run.wait_for(f"waiting   stage: the port {ports[0]} does not accept connections")
        run.send(signal.SIGTERM)
        assert run.wait_for_end() == 128 + signal.SIGTERM
    finally:
        settings.write_text(before, encoding="utf-8")
