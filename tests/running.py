"""The command line as users have it: whole processes, away from the checkout."""

from __future__ import annotations

import fcntl
import os
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
RAMCIP = ROOT / "example_ramcip"
REVISION = "1a2b3c4"
"""Printed in documents instead of git's last commit, which is another one in every clone."""
QUICK_START = ("-XX:TieredStopAtLevel=1", "-XX:+UseSerialGC")
"""Options of Java for judges that run some seconds: optimising their code costs more than it saves (12 s instead of 6 for 170 pages)."""


def archgen(
    *words: str | Path, cwd: Path, status: int = 0, env: Mapping[str, str] | None = None, stdin: bytes = b""
) -> subprocess.CompletedProcess[bytes]:
    """Run a verb with the code of this checkout; what it leaves with another status is shown."""
    command = [sys.executable, "-m", "archgen", *map(str, words)]
    path = os.pathsep.join(filter(None, ((env or {}).get("PYTHONPATH"), str(ROOT))))
    # As wide as it must be, unless a test says otherwise: pytest's workers set COLUMNS.
    environment = {**os.environ, "COLUMNS": "", **(env or {}), "PYTHONPATH": path}
    done = subprocess.run(  # noqa: S603 - our own program
        command, cwd=cwd, env=environment, input=stdin, capture_output=True, check=False, timeout=1800
    )
    said = f"{done.stdout.decode()[-2000:]}\n{done.stderr.decode()[-4000:]}"
    assert done.returncode == status, f"{' '.join(command[2:])} ended with {done.returncode}:\n{said}"
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
