"""The vehicle of the paper, started by its script with stand-ins that fail unless what they need is up."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.plugins.start_scripts.start_up.started_workspaces import Run, Stage, copy_example, hold_ports, make_workspace

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


@pytest.fixture(scope="module")
def ports() -> Iterator[list[int]]:
    with hold_ports(3) as ports:
        yield ports


@pytest.fixture(scope="module")
def script(tmp_path_factory: pytest.TempPathFactory, ports: list[int]) -> Path:
    folder = tmp_path_factory.mktemp("vehicle")
    replacements = {
        "port: 6665": f"port: {ports[0]}",
        "port: 12000": f"port: {ports[1]}",
        "port: 12001": f"port: {ports[2]}",
        "within: 10 s": "within: 90 s",
        # A node without a sign is up as soon as it is started: here all wait for what the stand-ins say.
        ", host: desk_pc}": ", host: desk_pc, start: {ready: {log: says hello, within: 90 s}}}",
        "node: {host: desk_pc}": "node: {host: desk_pc, start: {ready: {log: says hello, within: 90 s}}}",
    }
    project = copy_example("vehicle", folder / "project", replacements)
    return make_workspace(project / "scenario", folder / "ws") / "start.sh"


def start(script: Path, folder: Path, ports: list[int], says: str = "now IceStorm ready") -> tuple[Run, Stage]:
    stage = Stage(
        folder / "stage",
        PROGRAMS,
        needs=NEEDS,
        ports=dict(zip(SERVICES, ports, strict=True)),
        says={"event_cache": says},
        ends={"multicast": 0},
    )
    return Run(script, stage), stage


def test_it_has_the_size_of_the_papers_script(script: Path) -> None:
    lines = (script.parent / "start" / "hosts" / "desk_pc.sh").read_text(encoding="utf-8").splitlines()
    assert sum(line.startswith("step ") for line in lines) == len(PLANNED)
    assert 50 < len(lines) < 90


@pytest.mark.slow
def test_it_comes_up_in_order_and_stops_in_reverse(script: Path, ports: list[int], tmp_path: Path) -> None:
    run, stage = start(script, tmp_path, ports)
    run.wait_for("up        all: 12 steps")
    events = run.events
    for name, needs in NEEDS.items():
        for need in needs:
            seen = ("ended" if need == "multicast" else "up", need)
            assert events.index(seen) < events.index(("starting", name)), (need, name)
    assert {"-p", "map_file:=maps/parking_lot.pnm.gz"} < set(stage.read_told("gridmap")[0]["words"])
    run.send(signal.SIGINT)
    assert run.wait_for_end() == 0
    assert [line for line in stage.journal if line.startswith("stop")] == [f"stop {name}" for name in PLANNED[:0:-1]]
    assert {f"{name}.log" for name in PLANNED} | {"start.log"} == {file.name for file in run.log_folder.iterdir()}


@pytest.mark.slow
def test_killed_in_the_middle_it_stops_what_was_started(script: Path, ports: list[int], tmp_path: Path) -> None:
    run, stage = start(script, tmp_path, ports, says="")
    run.wait_for("starting  event_cache")
    missing = run.log_folder / "event_cache.missing"
    run.wait_until(lambda: missing.exists() and "IceStorm" in missing.read_text(encoding="utf-8"))
    run.send(signal.SIGTERM)
    assert run.wait_for_end() == 128 + signal.SIGTERM
    assert [line for line in stage.journal if line.startswith("stop")] == [
        f"stop {name}" for name in reversed(SERVICES)
    ]
    assert 'not up    event_cache: its output does not hold "IceStorm ready"' in run.output
    assert "not up    dgclocalnav: not started, it waits for faithlocaliser3d laser2d0" in run.output
