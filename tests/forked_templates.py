"""Processes of templates that are forked from one that has imported all they need: to start a Python costs more than to render.

Each render has a process of its own, confined as users have it, and runs the same code. Templates that ship are compiled once,
before the fork: hundreds of renders take the same, and to compile them costs ten times as much as to render. Tests of how such a
process is started take it as it is: `pytest.mark.usefixtures("fresh_workers")`.
"""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import tempfile
import threading
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace

import pytest

from archgen.emit import text

# Answers each request (eight bytes, and three descriptors: the child's input, output and errors) with these bytes and the child's
# number, and again with its status when it ended.
_FORKING_CODE = """
import gc, marshal, os, socket, sys
from contextlib import suppress
from pathlib import Path
sys.path.insert(0, sys.argv[1])
from jinja2 import Environment
from archgen.emit.text.template_worker import create_sandbox, main
channel = socket.socket(fileno=int(sys.argv[2]))

shipped = [Path(sys.argv[1]).resolve() / name for name in ("archgen", "backends")]
compiled, compiled_folders = {}, set()
compile_anew = Environment.compile

def compile_once(sandbox, source, name=None, *others, **named):
    code = compiled.get((sandbox.loader.folder, source, name))
    return compile_anew(sandbox, source, name, *others, **named) if code is None else code

Environment.compile = compile_once

def compile_shipped(request):
    # A project's own templates are compiled where it is confined.
    folder = Path(request["templates"]).resolve()
    if folder in compiled_folders or not any(map(folder.is_relative_to, shipped)):
        return
    compiled_folders.add(folder)
    sandbox = create_sandbox(folder, request["escapes"])
    # What is no template is left to the child, which says so.
    for name in [file.relative_to(folder).as_posix() for file in folder.rglob("*") if file.is_file()]:
        with suppress(Exception):
            source, *_ = sandbox.loader.get_source(sandbox, name)
            compiled[folder, source, name] = compile_anew(sandbox, source, name, name)
    for source in {file.get(key) or "" for file in request["files"] for key in ("path", "expects", "offers")}:
        with suppress(Exception):
            compiled[folder, source, None] = compile_anew(sandbox, source)

while True:
    request, descriptors, _, _ = socket.recv_fds(channel, 8, 3)
    if not request:
        break
    given = descriptors[0]
    compile_shipped(marshal.loads(os.pread(given, os.fstat(given).st_size, 0)))
    gc.freeze()  # no child looks through it, which would copy it
    child = os.fork()
    if not child:
        channel.close()
        for number, descriptor in enumerate(descriptors):
            os.dup2(descriptor, number)
        try:
            main()
        except SystemExit as end:  # it has said all: to take down what it imported would cost more than to render
            os._exit(end.code)
    for descriptor in descriptors:
        os.close(descriptor)
    channel.sendall(request + child.to_bytes(8, "little"))
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    channel.sendall(request + status.to_bytes(8, "little", signed=True))
"""


class _ForkingProcess:
    """A Python that forks itself for each request, one after the other."""

    def __init__(self, package_root: str, environment: Mapping[str, str]) -> None:
        self._channel, others_end = socket.socketpair()
        words = ("-I", "-B", "-c", _FORKING_CODE, package_root, str(others_end.fileno()))
        self._process = subprocess.Popen(  # noqa: S603 - our own interpreter and code
            [sys.executable, *words], env=environment, pass_fds=[others_end.fileno()], stdin=subprocess.DEVNULL
        )
        others_end.close()
        self._lock = threading.Lock()

    def run(self, command: Sequence[str], request: bytes, seconds: float) -> subprocess.CompletedProcess[bytes]:
        """Render in a child, and return what `subprocess.run` would; end it after some seconds."""
        with self._lock, tempfile.TemporaryFile() as given, ThreadPoolExecutor(2) as readers:
            given.write(request)
            given.seek(0)
            output, errors = os.pipe(), os.pipe()
            key = os.urandom(8)
            socket.send_fds(self._channel, [key], [given.fileno(), output[1], errors[1]])
            os.close(output[1])
            os.close(errors[1])
            child = self._take_answer(key)
            reading = [readers.submit(_read_all, end[0]) for end in (output, errors)]
            self._channel.settimeout(seconds)
            try:
                status = self._take_answer(key)
            except TimeoutError:
                os.kill(child, 9)
                self._channel.settimeout(None)
                self._take_answer(key)
                raise subprocess.TimeoutExpired(command, seconds) from None
            self._channel.settimeout(None)
            said, complained = (each.result() for each in reading)
            return subprocess.CompletedProcess(command, status, said, complained)

    def _take_answer(self, key: bytes) -> int:
        """Return the next answer to a request; answers to one that was interrupted are passed over."""
        while (answer := self._channel.recv(16))[:8] != key:
            if not answer:
                message = "the process of templates ended"
                raise ConnectionError(message)
        return int.from_bytes(answer[8:], "little", signed=True)

    def end(self) -> None:
        """End the process."""
        self._channel.close()
        self._process.wait()


def _read_all(descriptor: int) -> bytes:
    with os.fdopen(descriptor, "rb") as stream:
        return stream.read()


_RUNNING: dict[tuple[tuple[str, str], ...], _ForkingProcess] = {}
"""By its environment."""


def _run_forked(
    command: Sequence[str],
    *,
    input: bytes,  # noqa: A002 - as `subprocess.run` calls it
    env: Mapping[str, str],
    timeout: float,
    **others: bool,
) -> subprocess.CompletedProcess[bytes]:
    assert others == {"capture_output": True, "check": False}
    key = tuple(sorted(env.items()))
    if key not in _RUNNING:
        _RUNNING[key] = _ForkingProcess(command[-1], env)
    return _RUNNING[key].run(command, input, timeout)


FORKING = SimpleNamespace(run=_run_forked, TimeoutExpired=subprocess.TimeoutExpired)
"""Stands for `subprocess` where templates are rendered."""


def fork_templates(config: pytest.Config) -> None:
    """Fork the processes of templates until the end of the run."""
    vars(text)["subprocess"] = FORKING
    config.add_cleanup(_end_processes)


def _end_processes() -> None:
    for process in _RUNNING.values():
        process.end()
    _RUNNING.clear()
