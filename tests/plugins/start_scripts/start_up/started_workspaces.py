"""Workspaces of the backend `start`, run with programs that stand in for those of the robot."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from archgen.pipeline import check_project
from archgen.products.output_options import OutputOptions
from archgen.products.workspace_product import WorkspaceRequest, write_workspace
from tests.outside_tools import find_tool, run_judge
from tests.running import ROOT

_STAND_IN = Path(__file__).with_name("stand_in.py")
_PATIENCE = 120
"""Seconds until a test gives up on what must come sooner or later."""


def make_workspace(project: Path, folder: Path, **request: Any) -> Path:  # noqa: ANN401 - of the request
    """Generate the start-up of a project, and return the folder with it."""
    checked_project = check_project(project)
    assert not checked_project.has_errors, checked_project.findings
    result = write_workspace(checked_project, OutputOptions(), "start", folder, WorkspaceRequest(**request))
    assert result.is_complete, result.findings
    return folder


def copy_example(name: str, folder: Path, replacements: Mapping[str, str]) -> Path:
    """Copy an example of the repository, with other words in its files, and return it."""
    shutil.copytree(ROOT / "examples" / name, folder)
    # A library beside the project counts where both are in one repository.
    subprocess.run(["git", "init", "-q"], cwd=folder, check=True)  # noqa: S607
    for file in folder.rglob("*.yaml"):
        text = file.read_text(encoding="utf-8")
        for old, new in replacements.items():
            text = text.replace(old, new)
        file.write_text(text, encoding="utf-8")
    return folder


@contextmanager
def hold_ports(count: int) -> Iterator[list[int]]:
    """Hold free ports, so that nobody but the stand-ins of this test opens them."""
    sockets = []
    try:
        for _ in range(count):
            held = socket.socket()
            held.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
            held.bind(("127.0.0.1", 0))
            sockets.append(held)
        yield [held.getsockname()[1] for held in sockets]
    finally:
        for held in sockets:
            held.close()


class Stage:
    """A folder in which stand-ins play the programs of a robot."""

    def __init__(
        self,
        folder: Path,
        programs: Mapping[str, str],
        *,
        patience: int = _PATIENCE,
        **settings: Any,  # noqa: ANN401 - any data
    ) -> None:
        """Put stand-ins for programs on a path of their own: `programs` are the names of nodes by program.

        `patience` is how many seconds a script waits for the end of what it told to end, before it insists.
        """
        self.folder = folder
        self.patience = patience
        (folder / "bin").mkdir(parents=True)
        defaults: dict[str, Any] = {
            key: {} for key in ("needs", "ports", "says", "manners", "ends", "topics", "services")
        }
        (folder / "settings.json").write_text(json.dumps({"names": programs, **defaults, **settings}), encoding="utf-8")
        (folder / "journal").touch()
        for program in {*programs, "ros2"}:
            command = f'exec "{sys.executable}" -IS "{_STAND_IN}" "{folder}" {program} "$@"'
            self.add_program(program, command)
        # Whoever may not become another user runs the rest of the words all the same.
        self.add_program("sudo", 'while [ "$1" != -- ]; do shift; done; shift; exec "$@"')

    def add_program(self, name: str, line: str) -> None:
        """Put a program on the path that runs a line of a shell."""
        file = self.folder / "bin" / name
        file.write_text(f"#!/bin/sh\n{line}\n", encoding="utf-8")
        file.chmod(0o755)

    @property
    def environment(self) -> dict[str, str]:
        """The environment of a run."""
        path = f"{self.folder / 'bin'}{os.pathsep}{os.environ['PATH']}"
        return {
            **os.environ,
            "PATH": path,
            "START_PATIENCE": str(self.patience),
            "START_LOGS": str(self.folder / "logs"),
        }

    @property
    def journal(self) -> list[str]:
        """What the stand-ins did, in that order."""
        return (self.folder / "journal").read_text(encoding="utf-8").splitlines()

    def read_told(self, name: str) -> list[dict[str, Any]]:
        """Return what a program was told each time it started: its words, its folder, its environment."""
        return [json.loads(line) for line in (self.folder / f"{name}.told").read_text(encoding="utf-8").splitlines()]

    def read_process(self, name: str) -> int:
        """Return the number of a program's process."""
        return int((self.folder / f"{name}.runs").read_text(encoding="utf-8"))


class Run:
    """A run of a generated script."""

    def __init__(self, script: Path, stage: Stage, *words: str) -> None:
        """Start it."""
        self.logs = stage.folder / "logs"
        self.output_file = stage.folder / "output"
        with self.output_file.open("wb") as output:
            self.process = subprocess.Popen(  # noqa: S603 - the script that was just generated, with stand-ins only
                # What runs in the background of a shell ignores interrupts, and below `nohup` hang-ups, and would hand that on.
                ["/usr/bin/env", "--default-signal=INT,HUP", "bash", str(script), *words],
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=output,
                env=stage.environment,
                start_new_session=True,
            )

    @property
    def output(self) -> str:
        """All that it said."""
        return self.output_file.read_text(encoding="utf-8")

    @property
    def events(self) -> list[tuple[str, str]]:
        """What it said of steps: `("up", "imu")`."""
        found = re.findall(r"^(?:\[\w+\] )?\d\d:\d\d:\d\d  (\S.*?)\s{1,9}(\S+?)(?::.*)?$", self.output, re.MULTILINE)
        return [(what.strip(), step) for what, step in found]

    def wait_for(self, words: str) -> None:
        """Wait until it says something."""
        self.wait_until(lambda: words in self.output)

    def wait_until(self, holds: Callable[[], bool]) -> None:
        """Wait until something holds; it must do so before the end of the run."""
        until = time.monotonic() + _PATIENCE
        while not holds():
            assert self.process.poll() is None, self.output
            assert time.monotonic() < until, self.output
            time.sleep(0.05)

    def send(self, number: signal.Signals) -> None:
        """Send a signal to the script alone."""
        self.process.send_signal(number)

    def wait_for_end(self) -> int:
        """Wait until it has ended, and return its status; nothing that it started may be left."""
        status = self.process.wait(timeout=_PATIENCE)
        assert list_marked(self.logs) == [], self.output
        return status

    def wait_for_nothing_left(self) -> None:
        """Wait until nothing is left of what it started, after its own end."""
        self.process.wait(timeout=_PATIENCE)
        until = time.monotonic() + _PATIENCE
        while list_marked(self.logs):
            assert time.monotonic() < until, list_marked(self.logs)
            time.sleep(0.1)

    def is_missed(self, step: str) -> bool:
        """Whether the script has said what a step still lacks."""
        return any(file.read_text(encoding="utf-8") for file in self.logs.glob(f"*/{step}.missing"))

    @property
    def log_folder(self) -> Path:
        """The folder with the logs of this run."""
        (folder,) = (each for each in self.logs.iterdir() if each.is_dir())
        return folder


def list_marked(logs: Path) -> list[str]:
    """Return the processes that scripts with this folder for logs started and that still run."""
    mark = f"START_STEP={logs}/".encode()
    found = []
    for process in Path("/proc").iterdir():
        try:
            if process.name.isdigit() and mark in (process / "environ").read_bytes():
                found.append((process / "cmdline").read_bytes().decode("utf-8", "replace"))
        except OSError:
            continue
    return found


def check_by_shellcheck(*scripts: Path) -> None:
    """Find nothing in scripts, and in what they include."""
    assert run_judge(find_tool("shellcheck"), "-x", *scripts).stdout == ""


def check_by_systemd(*units: Path) -> None:
    """Find nothing in units, which is more than that systemd would take them."""
    done = run_judge(find_tool("systemd-analyze"), "verify", "--man=no", *units)
    assert done.stdout + done.stderr == ""
