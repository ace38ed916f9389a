"""The scripts that `archgen generate start` makes, run: order, waiting, failures, and that nothing is left behind."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.bringup.started_workspaces import Run, Stage, copy_example, hold_ports, make_workspace

PLANNED = [
    "multicast",
    "stage",
    "registry",
    "event_cache",
    "imu",
    "faithlocaliser3d",
    "gridmap",
    "laser2d0",
    "dgclocalnav",
    "highlevelplanner",
    "car",
    "orcaview2d",
]
PROGRAMS = {"ip": "multicast", "player": "stage", "icegridregistry": "registry", "icebox": "event_cache"}
SERVICES = ["stage", "registry", "event_cache"]
NEEDS = {
    "stage": ["multicast"],
    "registry": ["stage"],
    "event_cache": ["stage", "registry"],
    "imu": SERVICES,
    "faithlocaliser3d": [*SERVICES, "imu"],
    "gridmap": SERVICES,
    "laser2d0": SERVICES,
    "dgclocalnav": [*SERVICES, "laser2d0", "faithlocaliser3d"],
    "highlevelplanner": [*SERVICES, "dgclocalnav", "gridmap", "faithlocaliser3d"],
    "car": [*SERVICES, "dgclocalnav"],
    "orcaview2d": [*SERVICES, "gridmap", "faithlocaliser3d", "highlevelplanner", "laser2d0"],
}


@pytest.fixture
def ports() -> Iterator[list[int]]:
    with hold_ports(3) as ports:
        yield ports


def start_vehicle(folder: Path, free: list[int], words: dict[str, str] | None = None, **settings: Any) -> tuple[Run, Stage]:
    """Generate the vehicle's start-up, with free ports, and start it with stand-ins."""
    written = {"6665": str(free[0]), "12000": str(free[1]), "12001": str(free[2]), "within: 10 s": "within: 60 s"}
    project = copy_example("vehicle", folder / "project", {**written, **(words or {})})
    stage = Stage(
        folder / "stage",
        PROGRAMS,
        **{
            "needs": NEEDS,
            "ports": dict(zip(SERVICES, free, strict=True)),
            "says": {"event_cache": "now IceStorm ready"},
            "ends": {"multicast": 0},
            **settings,
        },
    )
    return Run(make_workspace(project / "scenario", folder / "ws") / "start.sh", stage), stage


def test_the_vehicle_comes_up_in_order_and_stops_in_reverse(tmp_path: Path, ports: list[int]) -> None:
    run, stage = start_vehicle(tmp_path, ports)
    run.wait_for("all of 12 steps")
    events = run.events
    for name, needs in NEEDS.items():
        for need in needs:
            seen = ("ended" if need == "multicast" else "up", need)
            assert events.index(seen) < events.index(("starting", name)), (need, name)
    run.send(signal.SIGINT)
    assert run.wait_for_end() == 0
    assert [line for line in stage.journal if line.startswith("stop")] == [f"stop {name}" for name in PLANNED[:0:-1]]
    assert {f"{name}.log" for name in PLANNED} | {"start.log"} == {file.name for file in run.log_folder.iterdir()}
    assert (run.log_folder / "imu.log").read_text(encoding="utf-8").startswith("imu says hello\n")
    assert "up        imu" in (run.log_folder / "start.log").read_text(encoding="utf-8")


def test_a_signal_in_the_middle_stops_what_was_started(tmp_path: Path, ports: list[int]) -> None:
    run, stage = start_vehicle(tmp_path, ports, says={})
    run.wait_for("starting  event_cache")
    run.send(signal.SIGTERM)
    assert run.wait_for_end() == 128 + signal.SIGTERM
    assert [line for line in stage.journal if line.startswith("stop")][-2:] == ["stop registry", "stop stage"]
    assert "not up    imu: not started, it was not its turn" in run.output
    assert "not up    dgclocalnav: not started, it waits for laser2d0 faithlocaliser3d" in run.output


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGHUP])
def test_an_interrupt_while_nothing_is_up_tells_its_status(tmp_path: Path, ports: list[int], number: signal.Signals) -> None:
    run, _ = start_vehicle(tmp_path, ports, ports={})
    run.wait_for("starting  stage")
    run.send(number)
    assert run.wait_for_end() == 128 + number


def test_the_end_of_one_program_stops_all_and_is_said(tmp_path: Path, ports: list[int]) -> None:
    run, stage = start_vehicle(tmp_path, ports)
    run.wait_for("all of 12 steps")
    os.kill(stage.read_process("imu"), signal.SIGKILL)
    assert run.wait_for_end() == 1
    assert "failed    imu: it was ended by SIGKILL" in run.output
    assert [line for line in stage.journal if line.startswith("stop")] == [
        f"stop {name}" for name in PLANNED[:0:-1] if name != "imu"
    ]


def test_what_is_not_up_in_time_is_said(tmp_path: Path, ports: list[int]) -> None:
    words = {f"port: {ports[2]}, log: IceStorm ready, within: 60 s": f"port: {ports[2]}, log: IceStorm ready, within: 1 s"}
    run, stage = start_vehicle(tmp_path, ports, words, says={})
    assert run.wait_for_end() == 1
    assert 'failed    event_cache: not up within 1 s: its output does not hold "IceStorm ready"' in run.output
    assert "start imu" not in stage.journal


def test_a_program_that_fails_is_said_with_the_end_of_its_log(tmp_path: Path, ports: list[int]) -> None:
    run, _ = start_vehicle(tmp_path, ports, needs={"registry": ["what is not there"]})
    assert run.wait_for_end() == 1
    assert "failed    registry: it ended with status 9" in run.output
    assert "| needs what is not there" in run.output


def test_a_step_that_runs_once_and_fails_ends_the_start(tmp_path: Path, ports: list[int]) -> None:
    run, stage = start_vehicle(tmp_path, ports, ends={"multicast": 4})
    assert run.wait_for_end() == 1
    assert "failed    multicast: it ended with status 4" in run.output
    assert stage.journal == ["start multicast", "end multicast"]


def test_what_does_not_listen_is_killed_with_all_that_it_started(tmp_path: Path, ports: list[int]) -> None:
    manners = {"imu": "deaf", "car": "stubborn", "gridmap": "parent"}
    run, stage = start_vehicle(tmp_path, ports, manners=manners)
    run.wait_for("all of 12 steps")
    assert (stage.folder / "gridmap.child").exists()
    run.send(signal.SIGTERM)
    assert run.wait_for_end() == 0
    assert "killing   imu: it does not end by itself" in run.output
    assert "killing   car" not in run.output
    assert "stop car" in stage.journal


def test_what_respawns_starts_again(tmp_path: Path, ports: list[int]) -> None:
    words = {"after: registry,": "after: registry, respawn: true, respawn_delay: 1 s,"}
    run, stage = start_vehicle(tmp_path, ports, words, manners={"event_cache": "short"})
    run.wait_for("all of 12 steps")
    assert "ended     event_cache: it ended with status 3, and starts again in 1 s" in run.output
    assert [line for line in stage.journal if "event_cache" in line] == ["start event_cache", "fall event_cache", "start event_cache"]
    run.send(signal.SIGINT)
    assert run.wait_for_end() == 0


def test_when_the_script_itself_is_killed_nothing_is_left(tmp_path: Path, ports: list[int]) -> None:
    run, _ = start_vehicle(tmp_path, ports)
    run.wait_for("all of 12 steps")
    run.send(signal.SIGKILL)
    run.wait_for_nothing_left()


def test_a_missing_program_is_said_before_anything_starts(tmp_path: Path, ports: list[int]) -> None:
    run, stage = start_vehicle(tmp_path, ports, {"command: [icebox,": "command: [no_such_icebox,"})
    assert run.wait_for_end() == 2
    assert run.output.splitlines() == [
        "event_cache needs the program no_such_icebox, which is not on the path",
        "Nothing was started.",
    ]
    assert stage.journal == []
