"""A program that runs verbs of archgen and does them harm at a chosen moment: each in a process of its own, forked from one
that has imported what they need, so that a run costs milliseconds and each step of a verb can be tried.

Python tells an audit hook of each step on files before it is taken. What happens at step N below a watched folder is one of:

- `full`, `denied`: from this step on the system refuses what makes or changes files, as a full or a read-only disk does;
- `kill`, `term`, `int`, `hup`: the process gets a signal;
- `vanish`, `link`, `pipe`, `folder`, `half`, `other`: the file that is opened for reading is gone, a link out of the project,
  a pipe, a folder, cut in half or another text in this very moment.

`limit` is another one: no file gets longer than N bytes, so that the disk is full in the midst of a write.
"""

from __future__ import annotations

import contextlib
import errno
import importlib
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
SIGNALS = {"kill": signal.SIGKILL, "term": signal.SIGTERM, "int": signal.SIGINT, "hup": signal.SIGHUP}
OUTSIDE = Path(__file__).resolve()
"""Where links lead to: a file that no verb has to read. It is known by these words: who reads this read too much."""
_SECONDS = 300
"""After so many a run hangs, for sure, and is ended by SIGALRM."""
_ERRORS = {"full": errno.ENOSPC, "denied": errno.EROFS}
_MAKING_EVENTS = frozenset({"os.mkdir", "os.link", "os.symlink", "os.truncate"})
_CHANGING_EVENTS = frozenset({"os.rename", "os.remove", "os.rmdir", "os.chmod", "os.utime"})
_WRITING_FLAGS = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND


@dataclass(frozen=True)
class Fault:
    """What happens, and at which step (of `limit`: after how many bytes)."""

    kind: str = "none"
    step: int = 0


@dataclass(frozen=True)
class FaultyRun:
    """What a run left: its exit status (below zero: the signal that ended it), what it said, and how many steps it took."""

    status: int
    out: str
    err: str
    writing_steps: int = 0
    reading_steps: int = 0


_IS_OWN = re.compile(r"/(\.git|\.archgen|ws|archgen-out)/")
"""What archgen or git itself wrote is read for other ends: nobody is to change it meanwhile."""


class FaultyArchgen:
    """archgen as a process that is forked for each run."""

    def __init__(self) -> None:
        """Start it."""
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": ""}
        for name in ("FORCE_COLOR", "GITHUB_WORKSPACE", "GITHUB_STEP_SUMMARY"):
            environment.pop(name, None)
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tests.fault_injection"],
            cwd=ROOT,
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )

    def run(
        self,
        *words: str | Path,
        cwd: Path,
        fault: Fault | None = None,
        watched: Path | None = None,
        env: Mapping[str, str | None] | None = None,
    ) -> FaultyRun:
        """Run a verb, with a fault below a watched folder (the current one, unless told)."""
        request = {
            "words": [*map(str, words)],
            "cwd": str(cwd),
            "watched": str((watched or cwd).resolve()),
            "env": {**(env or {})},
            **asdict(fault or Fault()),
        }
        assert self._process.stdin
        assert self._process.stdout
        self._process.stdin.write(json.dumps(request).encode() + b"\n")
        self._process.stdin.flush()
        return FaultyRun(**json.loads(self._process.stdout.readline()))

    def end(self) -> None:
        """End the process."""
        assert self._process.stdin
        assert self._process.stdout
        self._process.stdin.close()
        self._process.stdout.close()
        self._process.wait()


class _Harm:
    """The audit hook of one run."""

    def __init__(self, kind: str, step: int, watched: str) -> None:
        self.kind, self.step, self.watched = kind, step, watched
        self.writing_steps = self.reading_steps = 0
        self.is_done = self.is_inside = False

    def __call__(self, event: str, arguments: tuple[Any, ...]) -> None:
        if self.is_inside or not (event == "open" or event in _MAKING_EVENTS or event in _CHANGING_EVENTS):
            return
        # What is named by a descriptor of its folder (`shutil.rmtree` does so) is taken for watched.
        name = arguments[0] if event not in {"os.link", "os.symlink"} else arguments[1]
        if isinstance(name, int):
            return
        path = os.path.abspath(os.fsdecode(name))  # noqa: PTH100 - of a link, not of what it leads to
        if not f"{path}/".startswith(f"{self.watched}/"):
            return
        is_writing = event != "open" or bool(arguments[2] & _WRITING_FLAGS)
        makes = event in _MAKING_EVENTS or (event == "open" and is_writing)
        self.is_inside = True
        try:
            self._take_step(path, is_writing=is_writing, makes=makes)
        finally:
            self.is_inside = False

    def _take_step(self, path: str, *, is_writing: bool, makes: bool) -> None:
        if is_writing:
            self.writing_steps += 1
            if self.kind in _ERRORS and self.writing_steps >= self.step and (makes or self.kind == "denied"):
                raise OSError(_ERRORS[self.kind], os.strerror(_ERRORS[self.kind]), path)
            if self.kind in SIGNALS and self.writing_steps == self.step:
                signal.raise_signal(SIGNALS[self.kind])
        else:
            self.reading_steps += 1
            if self.kind in _CHANGES and self.reading_steps >= self.step and not self.is_done:
                if not Path(path).is_file() or _IS_OWN.search(path):
                    return
                self.is_done = True
                _CHANGES[self.kind](Path(path))


def _replace_with_link(path: Path) -> None:
    path.unlink()
    path.symlink_to(OUTSIDE)


def _replace_with_pipe(path: Path) -> None:
    path.unlink()
    os.mkfifo(path)


def _replace_with_folder(path: Path) -> None:
    path.unlink()
    path.mkdir()


def _cut_in_half(path: Path) -> None:
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 2])


_CHANGES: dict[str, Callable[[Path], object]] = {
    "vanish": Path.unlink,
    "link": _replace_with_link,
    "pipe": _replace_with_pipe,
    "folder": _replace_with_folder,
    "half": _cut_in_half,
    "other": lambda path: path.write_text("somebody: [else\n"),
}
READING_KINDS = tuple(_CHANGES)


def _run_child(request: dict[str, Any], note_file: Path) -> None:
    from archgen.__main__ import main

    harm = _Harm(request["kind"], request["step"], request["watched"])
    os.chdir(request["cwd"])
    for name, value in request["env"].items():
        os.environ.pop(name, None)
        if value is not None:
            os.environ[name] = value
    sys.argv = ["archgen", *request["words"]]
    # As a process of its own begins, whatever pytest or a shell in the background did to signals.
    for number in SIGNALS.values():
        if number != signal.SIGKILL:
            signal.signal(number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL)
    if request["kind"] == "limit":
        resource.setrlimit(resource.RLIMIT_FSIZE, (request["step"], resource.RLIM_INFINITY))
    sys.addaudithook(harm)
    status = 0
    try:
        main()
    except SystemExit as stop:
        status = stop.code if isinstance(stop.code, int) else int(stop.code is not None)
    harm.is_inside = True
    resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
    modules = [name for name in sys.modules if name.startswith("archgen.")]
    steps = {"writing_steps": harm.writing_steps, "reading_steps": harm.reading_steps}
    note_file.write_text(json.dumps({**steps, "modules": modules}))
    os._exit(status)


def _serve() -> None:
    import archgen.cli  # noqa: F401 - for all children

    folder = Path(tempfile.mkdtemp(prefix="faults-"))
    note_file = folder / "note"
    try:
        for line in sys.stdin:
            request = json.loads(line)
            note_file.write_text("{}")
            # Pipes, which no limit of the length of files concerns.
            pipes = [os.pipe(), os.pipe()]
            child = os.fork()
            if not child:
                os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
                for number, (_, end) in enumerate(pipes, 1):
                    os.dup2(end, number)
                signal.alarm(_SECONDS)
                with contextlib.suppress(BaseException):
                    _run_child(request, note_file)
                os._exit(99)
            for _, end in pipes:
                os.close(end)
            with ThreadPoolExecutor(2) as readers:
                out, err = readers.map(_read_all, [end for end, _ in pipes])
            status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
            note = json.loads(note_file.read_text())
            for name in note.get("modules", ()):
                importlib.import_module(name)
            answer = FaultyRun(status, out, err, note.get("writing_steps", 0), note.get("reading_steps", 0))
            sys.stdout.write(json.dumps(asdict(answer)) + "\n")
            sys.stdout.flush()
    finally:
        shutil.rmtree(folder)


def _read_all(descriptor: int) -> str:
    with os.fdopen(descriptor, "rb") as stream:
        return stream.read().decode("utf-8", "replace")


if __name__ == "__main__":
    _serve()
