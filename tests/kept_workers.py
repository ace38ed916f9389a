"""Drawing processes that outlive a build: hundreds of tests draw small pictures, and to start a process costs more than to draw.

They are the real ones, and an answer of theirs depends on nothing but the task: `archgen serve` keeps its own for the same
reason. Tests of the processes themselves take fresh ones: `pytest.mark.usefixtures("fresh_workers")`.
"""

from __future__ import annotations

import functools
import os
import subprocess
import tempfile
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

import pytest

from archgen.emit.graphviz import font_config, worker_pool
from archgen.emit.graphviz.drawing_worker import DrawingFailure, DrawingTask
from archgen.emit.picture import Picture

_Start = tuple[tuple[str, ...], tuple[tuple[str, str], ...]]
"""How a process was started: its command line and its environment."""


@dataclass(frozen=True)
class _IdleProcess:
    process: subprocess.Popen[bytes]
    has_greeted: bool


_CACHE_FOLDER = os.environ["XDG_CACHE_HOME"]
"""The cache of this run, which its end removes; some tests have another."""
_IDLE: defaultdict[_Start, list[_IdleProcess]] = defaultdict(list)


class KeptWorker(worker_pool.DrawingWorker):
    """A worker that takes an idle process where there is one, and gives it back unless it broke."""

    def __init__(self, command_line: worker_pool.CommandLine, environment: dict[str, str]) -> None:
        # A build's own folder of fonts is gone after its test.
        environment = environment | {"FONTCONFIG_FILE": str(_write_font_config())}
        super().__init__(command_line, environment)
        self._start: _Start = (tuple(command_line), tuple(sorted(environment.items())))
        self._is_idle = True

    def start_process(self) -> subprocess.Popen[bytes]:
        """Take an idle process, or start one."""
        if self._process is None and (idle := _take_idle(self._start)):
            self._process, self._greeted = idle.process, idle.has_greeted
            return idle.process
        return super().start_process()

    def _exchange_messages(self, task: DrawingTask) -> Picture | DrawingFailure:
        self._is_idle = False
        answer = super()._exchange_messages(task)
        self._is_idle = self._greeted
        return answer

    def stop_process(self) -> int | None:
        """Give the process back. End it where an answer of it is still to come, or will never come."""
        process = self._process
        if process is None or not self._is_idle or self._timed_out or process.poll() is not None:
            self._is_idle = True
            return super().stop_process()
        _IDLE[self._start].append(_IdleProcess(process, self._greeted))
        self._process = None
        return None


def _take_idle(start: _Start) -> _IdleProcess | None:
    """Return an idle process that still runs. Builds ask for it in several threads."""
    while True:
        try:
            idle = _IDLE[start].pop()
        except IndexError:
            return None
        if idle.process.poll() is None:
            return idle


@functools.cache
def _write_font_config() -> Path:
    return font_config.write_font_config(Path(tempfile.mkdtemp(prefix="kept-workers-", dir=_CACHE_FOLDER)))


def keep_workers(config: pytest.Config) -> None:
    """Keep drawing processes until the end of the run."""
    worker_pool.DrawingWorker = KeptWorker  # type: ignore[misc]
    config.add_cleanup(_end_processes)


def _end_processes() -> None:
    for idle in (each for processes in _IDLE.values() for each in processes):
        idle.process.kill()
        idle.process.communicate()
    _IDLE.clear()
