"""Call git so that nothing in a repository can make it run a program, ask a question or reach for the network."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from archgen import cache
from archgen.frozen import NamedTuple


class GitError(Exception):
    """git cannot deliver what was asked for."""


class NoRepositoryError(GitError):
    """There is no repository, or git refuses to read it."""


class NoCommitsError(GitError):
    """Nothing has been committed yet."""


class UnknownRevisionError(GitError):
    """No commit has this name."""


class ShallowError(GitError):
    """The commit is not here because the clone is shallow."""


SAFE_COMMAND = (
    "git",
    "--no-pager",
    "--no-replace-objects",
    *("-c", "core.fsmonitor=false"),
    *("-c", "core.hooksPath=/dev/null"),
    *("-c", "log.showSignature=false"),
    *("-c", "protocol.allow=never"),
)
ANSWER_SECONDS = 60
"""So long may git take for one call, or for the answer to one question."""
_NOT_FOUND_STATUS = 127


class GitOutputError(GitError):
    """A git command prints more than it may."""


class GitResult(NamedTuple):
    """The result of a call: exit status (127 where git could not be run), output, and the text of its errors."""

    status: int
    output: bytes
    error_text: str

    @property
    def text(self) -> str:
        """The output as text; bytes that are not UTF-8 become surrogates, as in Python's file names."""
        return self.output.decode("utf-8", "surrogateescape")


def run_git(folder: Path, *arguments: str, stdin: bytes = b"") -> GitResult:
    """Run one git command in a folder."""
    note_git = None if stdin else cache.note_git
    return note_git(ask_git, str(folder), arguments) if note_git else ask_git(str(folder), arguments, stdin)


def ask_git(folder: str, arguments: Sequence[str], stdin: bytes = b"") -> GitResult:
    """Run one git command in a folder, whether or not runs are noted."""
    # Imported only when git is called: it would add to the start-up time of every command.
    import subprocess

    try:
        completed = subprocess.run(  # noqa: S603 - a fixed program; what users type stands behind --end-of-options or --
            [*SAFE_COMMAND, *arguments],
            cwd=folder,
            env=git_environment(os.environ),
            input=stdin,
            capture_output=True,
            timeout=ANSWER_SECONDS,
            check=False,
        )
    except FileNotFoundError:
        return GitResult(_NOT_FOUND_STATUS, b"", "git is not installed")
    except (OSError, ValueError, subprocess.TimeoutExpired) as error:
        return GitResult(_NOT_FOUND_STATUS, b"", f"git cannot be run: {error}")
    return GitResult(completed.returncode, completed.stdout, completed.stderr.decode("utf-8", "replace").strip())


def read_git_output(folder: Path, *arguments: str, max_bytes: int) -> bytes | None:
    """Return what a git command prints, None where it fails. Raise GitOutputError where it prints more than `max_bytes`.

    It is stopped there: trees that name each other ten times a level make a list of gigabytes from a few hundred bytes.
    One that takes too long is stopped, too.
    """
    import subprocess
    import threading

    try:
        process = subprocess.Popen(  # noqa: S603 - a fixed program; what users type stands behind --end-of-options or --
            [*SAFE_COMMAND, *arguments],
            cwd=folder,
            env=git_environment(os.environ),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
    except (OSError, ValueError):
        return None
    alarm = threading.Timer(ANSWER_SECONDS, process.kill)
    alarm.start()
    with process:
        try:
            output = process.stdout.read(max_bytes + 1) if process.stdout else b""
            if len(output) > max_bytes:
                process.kill()
                raise GitOutputError(f"git prints more than {max_bytes:,} bytes")
        finally:
            alarm.cancel()
    return None if process.returncode else output


def git_environment(variables: Mapping[str, str]) -> dict[str, str]:
    """Return the variables that git needs, without those that could point it elsewhere or make it run a program."""
    harmless = {key: value for key, value in variables.items() if not key.startswith("GIT_")}
    return harmless | {
        # A setting of the repository for one protocol wins over `protocol.allow`; this variable wins over all of them.
        "GIT_ALLOW_PROTOCOL": "",
        "GIT_GRAFT_FILE": os.devnull,
        "GIT_LITERAL_PATHSPECS": "1",
        # In a partial clone reading an object could otherwise fetch it from the remote.
        "GIT_NO_LAZY_FETCH": "1",
        "GIT_OPTIONAL_LOCKS": "0",
        "GIT_TERMINAL_PROMPT": "0",
        # Messages are compared with English texts (`_explain_refusal`).
        "LC_ALL": "C",
    }
