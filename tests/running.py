"""The command line as users have it: whole processes, away from the checkout, or, which is cheaper, in this process."""

from __future__ import annotations

import fcntl
import gc
import io
import os
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, chdir, contextmanager, redirect_stderr, redirect_stdout
from pathlib import Path
from unittest.mock import patch

from archgen.__main__ import main
from tests.judged_projects import judge_shipped_once

ROOT = Path(__file__).resolve().parents[1]
RAMCIP = ROOT / "example_ramcip"
REVISION = "1a2b3c4"
"""Printed in documents instead of git's last commit, which is another one in every clone."""


def archgen(
    *words: str | Path, cwd: Path, status: int = 0, env: Mapping[str, str] | None = None, stdin: bytes = b""
) -> subprocess.CompletedProcess[bytes]:
    """Run a verb with the code of this checkout; what it leaves with another status is shown."""
    command = [sys.executable, "-m", "archgen", *map(str, words)]
    path = os.pathsep.join(filter(None, ((env or {}).get("PYTHONPATH"), str(ROOT))))
    # As wide as it must be, unless a test says otherwise: pytest's workers set COLUMNS.
    environment = {**os.environ, "COLUMNS": "", **(env or {}), "PYTHONPATH": path}
    done = subprocess.run(  # noqa: S603 - our own program
        command, cwd=cwd, env=environment, input=stdin, capture_output=True, check=False, timeout=800
    )
    return _demand_status(done, status)


def archgen_here(
    *words: str | Path, cwd: Path, status: int = 0, env: Mapping[str, str] | None = None
) -> subprocess.CompletedProcess[bytes]:
    """Run a verb as `archgen` does, but in this process, where all is imported and shipped projects are judged already.

    For tests of what a verb writes or says. What it imports, its streams, locale and settings of Python need a process.
    """
    command = ["archgen", *map(str, words)]
    out, err = io.BytesIO(), io.BytesIO()
    was_collecting = gc.isenabled()
    with ExitStack() as stack:
        stack.enter_context(patch.dict(os.environ, {"COLUMNS": "", **(env or {})}))
        for name in ("FORCE_COLOR", "GITHUB_WORKSPACE"):
            os.environ.pop(name, None)
        stack.enter_context(chdir(cwd))
        stack.enter_context(judge_shipped_once())
        stack.enter_context(patch.object(sys, "argv", command))
        streams = [io.TextIOWrapper(stream, encoding="utf-8") for stream in (out, err)]
        stack.enter_context(redirect_stdout(streams[0]))
        stack.enter_context(redirect_stderr(streams[1]))
        left = 0
        try:
            main()
        except SystemExit as stop:
            # A text is printed by Python itself, and ends with 1.
            left = stop.code if isinstance(stop.code, int) else int(stop.code is not None)
        finally:
            if was_collecting:
                gc.enable()
        for stream in streams:
            stream.flush()
        return _demand_status(subprocess.CompletedProcess(command, left, out.getvalue(), err.getvalue()), status)


def _demand_status(done: subprocess.CompletedProcess[bytes], status: int) -> subprocess.CompletedProcess[bytes]:
    said = f"{done.stdout.decode()[-2000:]}\n{done.stderr.decode()[-4000:]}"
    assert done.returncode == status, f"{' '.join(map(str, done.args))} ended with {done.returncode}:\n{said}"
    return done


def contents(folder: Path) -> dict[str, bytes]:
    """Give every file below a folder, by its path."""
    files = sorted(file for file in folder.rglob("*") if file.is_file())
    return {file.relative_to(folder).as_posix(): file.read_bytes() for file in files}


def made_once(folder: Path, make: Callable[[Path], None]) -> Path:
    """Fill a folder, once for all of pytest's workers: who comes second waits for the first."""
    with _locked(folder.with_name(f"{folder.name}.lock")):
        if not folder.exists():
            part = folder.with_name(f"{folder.name}.part")
            make(part)
            part.rename(folder)
    return folder


@contextmanager
def _locked(path: Path) -> Iterator[None]:
    with path.open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield
