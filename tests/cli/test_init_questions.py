"""`archgen init` on a terminal: what it asks, and what Ctrl-C leaves."""

from __future__ import annotations

import os
import pty
import select
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from archgen.pipeline import check_project
from tests.running import ROOT


def findings(folder: Path) -> list[str]:
    return [f"{d.rule} {d.span}" for d in check_project(folder).findings]


class Terminal:
    """A run on a terminal: wait for a question, answer it."""

    def __init__(self, folder: Path, *words: str) -> None:
        self.main, end = pty.openpty()
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "TERM": "dumb"}
        command = [sys.executable, "-m", "archgen", "init", *words]
        self.process = subprocess.Popen(  # noqa: S603 - our own program
            command, cwd=folder, env=environment, stdin=end, stdout=end, stderr=end, start_new_session=True
        )
        os.close(end)
        self.said = ""

    def until(self, words: str) -> None:
        """Read until it has said something new that ends so."""
        said = ""
        while not said.rstrip().endswith(words):
            more = self._read()
            assert more, f"waited for {words!r} behind {self.said}{said}"
            said += more
        self.said += said

    def _read(self) -> str:
        """Give what it says next; nothing where it has ended or says nothing for long."""
        if not select.select([self.main], [], [], 120)[0]:
            return ""
        try:
            return os.read(self.main, 4096).decode()
        except OSError:  # what Linux says where the other end was closed
            return ""

    def answer(self, question: str, words: str) -> None:
        """Wait for a question and answer it."""
        self.until(question)
        os.write(self.main, f"{words}\n".encode())

    def end(self) -> int:
        """Read the rest and give the exit status."""
        while more := self._read():
            self.said += more
        return self.process.wait(120)


@pytest.fixture
def terminal(tmp_path: Path) -> Iterator[Callable[..., Terminal]]:
    """Give a function that starts `archgen init` on a terminal; what still runs in the end is stopped."""
    started: list[Terminal] = []
    # Where the tests run in the background, they ignore what Ctrl-C sends, and so would what they start.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)

    def start(*words: str) -> Terminal:
        started.append(Terminal(tmp_path, *words))
        return started[-1]

    yield start
    signal.signal(signal.SIGINT, before)
    for one in started:
        one.process.kill()
        one.process.wait(120)
        os.close(one.main)


Start = Callable[..., Terminal]


def test_on_a_terminal_it_asks(terminal: Start, tmp_path: Path) -> None:
    asked = terminal("robot")
    asked.answer("Title of the project [Robot]:", "Kitchen helper")
    asked.answer("[jazzy]:", "foxy")
    asked.answer("[jazzy]:", "humble")
    asked.answer("Enter for none:", "certh = CERTH-ITI")
    asked.answer("Enter to go on:", "certh")
    asked.answer("Enter to go on:", "SSSA")
    asked.answer("Enter to go on:", "")
    asked.answer("[sensing, driving]:", "Perception, Grasping")
    asked.answer("[certh]:", "")
    asked.answer("[certh]:", "sssa")
    asked.answer("[github]:", "none")
    assert asked.end() == 0
    assert "two partners have the id 'certh'" in asked.said
    found = check_project(tmp_path / "robot")
    assert findings(tmp_path / "robot") == []
    assert (found.architecture.project.title, found.architecture.distro) == ("Kitchen helper", "humble")
    assert [(g.title, g.owner) for g in found.architecture.groups.values()] == [
        ("Grasping", "sssa"),
        ("Perception", "certh"),
    ]


def test_ctrl_c_leaves_nothing(terminal: Start, tmp_path: Path) -> None:
    asked = terminal("robot")
    asked.answer("Title of the project [Robot]:", "")
    asked.until("[jazzy]:")
    os.killpg(asked.process.pid, signal.SIGINT)
    try:
        status = asked.process.wait(10)
    except subprocess.TimeoutExpired:
        # An interrupt between the printed question and the wait for its answer is seen only when that wait ends. A second
        # interrupt might meet a Python that is ending already, and kills it (status -2).
        os.write(asked.main, b"\n")
        status = asked.end()
    assert status == 130
    assert list(tmp_path.iterdir()) == []


def test_yes_asks_nothing_on_a_terminal(terminal: Start, tmp_path: Path) -> None:
    asked = terminal("robot", "--yes", "--title", "T")
    assert asked.end() == 0
    assert findings(tmp_path / "robot") == []
