"""Call git so that nothing in a repository can make it run a program, ask a question or reach for the network."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

SAFE = (
    "git",
    "--no-pager",
    "--no-replace-objects",
    *("-c", "core.fsmonitor=false"),
    *("-c", "core.hooksPath=/dev/null"),
    *("-c", "log.showSignature=false"),
    *("-c", "protocol.allow=never"),
)
_SECONDS = 60
_MISSING = 127


class Done(NamedTuple):
    """What a call gave: its exit status (127 where git could not be run), its output, what it said."""

    status: int
    out: bytes
    said: str

    @property
    def text(self) -> str:
        """Give the output as text, bytes that are no UTF-8 as Python's file names hold them."""
        return self.out.decode("utf-8", "surrogateescape")


def call(folder: Path, *arguments: str, stdin: bytes = b"") -> Done:
    """Run one command of git in a folder."""
    import subprocess

    try:
        done = subprocess.run(  # noqa: S603 - a fixed program; what users type stands behind --end-of-options or --
            [*SAFE, *arguments],
            cwd=folder,
            env=environment(os.environ),
            input=stdin,
            capture_output=True,
            timeout=_SECONDS,
            check=False,
        )
    except FileNotFoundError:
        return Done(_MISSING, b"", "git is not installed")
    except (OSError, ValueError, subprocess.TimeoutExpired) as error:
        return Done(_MISSING, b"", f"git cannot be run: {error}")
    return Done(done.returncode, done.stdout, done.stderr.decode("utf-8", "replace").strip())


def environment(outer: Mapping[str, str]) -> dict[str, str]:
    """Keep what git needs to run; leave out what could point it elsewhere or make it run a program.

    A setting of the repository for one protocol wins over `protocol.allow`; GIT_ALLOW_PROTOCOL wins over all of them.
    """
    kept = {key: value for key, value in outer.items() if not key.startswith("GIT_")}
    return kept | {
        "GIT_ALLOW_PROTOCOL": "",
        "GIT_GRAFT_FILE": os.devnull,
        "GIT_LITERAL_PATHSPECS": "1",
        "GIT_NO_LAZY_FETCH": "1",
        "GIT_OPTIONAL_LOCKS": "0",
        "GIT_TERMINAL_PROMPT": "0",
        "LC_ALL": "C",
    }
