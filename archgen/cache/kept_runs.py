"""A run that would hear from the disk what an earlier one heard says at once what that one said.

What a verb says follows from its words, its surroundings, its code, and what the disk answers. All that a run asks of the
disk is noted by the functions of `os` and `io` through which all Python code asks. A run that writes or starts a process is not
kept, nor is one of whose inputs any changed just before or during it. Decision 53 has the proof.
"""

from __future__ import annotations

import _posixsubprocess
import builtins
import hashlib
import io
import json
import os
import re
import stat
import sys
import time
from itertools import takewhile
from typing import TYPE_CHECKING, Any, cast

from archgen import cache
from archgen.cache import SETTLED_NANOSECONDS, find_cache_path
from archgen.installed_plugins import list_all_entries

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

_SUFFIX = ".run"
_MOST_RUNS = 48
_MAX_RECORD_BYTES = 32_000_000
_WRITING_FLAGS = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
_WRITING_LETTERS = frozenset("wax+")
_STAT, _LSTAT, _READLINK, _ACCESS = os.stat, os.lstat, os.readlink, os.access
_SCANDIR = os.scandir
_NOTED_FUNCTIONS: tuple[tuple[Any, str, str], ...] = (
    (os, "stat", "stat"),
    (os, "lstat", "lstat"),
    (os, "readlink", "lstat"),
    (os, "access", "rights"),
    (os, "listdir", "names"),
    (os, "scandir", "names"),
    (os, "open", "bytes"),
    (io, "open", "bytes"),
    (builtins, "open", "bytes"),
    (os, "rename", "act"),
    (os, "replace", "act"),
    (os, "remove", "act"),
    (os, "unlink", "act"),
    (os, "symlink", "act"),
    (os, "link", "act"),
    (os, "chmod", "act"),
    (os, "utime", "act"),
    (os, "chdir", "act"),
    (os, "fork", "act"),
    (os, "posix_spawn", "act"),
    # `subprocess`, which is loaded later, takes it from here.
    (_posixsubprocess, "fork_exec", "act"),
)
"""All ways in which Python code asks the disk, but for its own imports, or acts on it: module, name, kind of question.

Folders may be made and removed: what is made in them is opened to be written.
"""
_FACTS_OF_FILES = 7
"""So much is said of a file before the date of its last change."""
_GIT_WORD = re.compile(
    r"log|ls-tree|rev-parse|HEAD|-[1rz]|--format=%(?:h|cs)|--(?:no-show-signature|verify|quiet|show-prefix)"
    r"|--is-(?:bare-repository|shallow-repository|inside-git-dir)"
)
"""What git is asked again in a word that may be an option. A record that asks for anything else is not followed."""
_SAFE_TEXT = re.compile(r"(?:[^\x00-\x08\x0b-\x1f\x7f-\x9f]|\x1b\[[0-9;]*+m)*+")


class _UnkeptError(Exception):
    """A run cannot be kept."""


class RunKeeper:
    """A run: repeated from what is kept, or noted and kept."""

    def __init__(self, words: Sequence[str], ask_git: Callable[[str, list[str]], object]) -> None:
        """Take the words of the command line, and what asks git in a folder."""
        folder = find_cache_path()
        self._path = folder and os.path.join(folder, _name_run(words) + _SUFFIX)  # noqa: PTH118 - pathlib takes longer to load than all this takes
        self._asked: dict[tuple[str, str], str] = {}
        """What was asked, with what the disk said first: of files and folders when they changed last."""
        self._said: list[tuple[int, str]] = []
        self._is_keepable = self._path is not None
        self._is_noting = False
        self._ask_git = ask_git
        self._originals: list[tuple[Any, str, Callable[..., Any]]] = []
        self._settled_before = time.time_ns() - SETTLED_NANOSECONDS

    def repeat(self) -> int | None:
        """Say what is kept, and return the exit status; None where nothing is kept that holds today."""
        try:
            with open(self._path or "", "rb") as stream:  # noqa: PTH123 - as above
                status = os.fstat(stream.fileno())
                # In a folder that is shared, others could say that all is well.
                is_own = status.st_uid == os.geteuid() and not status.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
                record = json.loads(stream.read(_MAX_RECORD_BYTES))
            # Nothing but text and its colours reaches a terminal, whoever wrote this file.
            is_sound = is_own and record["status"] in {0, 1} and _is_safe(record["said"])
            said = [(number, text.encode()) for number, text in record["said"]]
            if not is_sound or any(self._ask_again(kind, path) != answer for kind, path, answer in record["asked"]):
                return None
        except (OSError, ValueError, TypeError, KeyError, RecursionError):
            return None
        for number, text in said:
            output: Any = sys.stdout if number == 1 else sys.stderr
            output.buffer.write(text)
            if not text:
                output.flush()
        return int(record["status"])

    def start_noting(self) -> None:
        """Note from now on what is asked and what is said, where it can be kept."""
        if not self._is_keepable:
            return
        import shutil  # noqa: F401 - when it is loaded it looks whether these functions are those of the system

        self._streams = sys.stdout, sys.stderr
        sys.stdout, sys.stderr = self._copy_words(1, sys.stdout), self._copy_words(2, sys.stderr)
        # What some starts of Python have loaded already has taken it: a `.pth` file does so, for instance.
        subprocess = sys.modules.get("subprocess")
        early_takers = ((subprocess, "_fork_exec", "act"),) if hasattr(subprocess, "_fork_exec") else ()
        for module, name, kind in (*_NOTED_FUNCTIONS, *early_takers):
            self._originals.append((module, name, getattr(module, name)))
            setattr(module, name, self._note_calls(getattr(module, name), kind))
        cache.note_git = self._note_git
        self._is_noting = True

    def stop_noting(self) -> None:
        """Put back what was replaced, and hand on what is still to be said."""
        if not self._originals:
            return
        self._is_noting = False
        cache.note_git = None
        while self._originals:
            setattr(*self._originals.pop())
        copies = sys.stdout, sys.stderr
        sys.stdout, sys.stderr = self._streams
        for copy in copies:
            copy.flush()

    def keep(self, status: object) -> None:
        """Keep the run where that is sound."""
        if not self._originals:
            return
        self.stop_noting()
        # A plug-in of others may ask the clock.
        self._is_keepable &= not list_all_entries()
        if not self._is_keepable or status not in {0, 1} or not _is_safe(self._said):
            return
        try:
            asked = [(*question, self._settle_answer(*question)) for question in self._asked | _list_code()]
        except (_UnkeptError, ValueError):
            return
        from pathlib import Path

        from archgen.cache.file_store import FileStore

        path = Path(self._path or "")
        record = {"status": status, "said": self._said, "asked": asked}
        FileStore(path.parent, _SUFFIX, _MOST_RUNS).store(path.stem, json.dumps(record).encode())

    def _note_calls(self, function: Callable[..., Any], kind: str) -> Callable[..., Any]:
        def ask(path: Any = ".", *arguments: Any, **options: Any) -> Any:  # noqa: ANN401 - as the function that it stands for
            if not self._is_noting or isinstance(path, int):  # a number is a file that is open already
                pass
            elif (
                kind == "act"
                or (kind == "bytes" and _is_writing(*arguments[:1], **options))
                or options.get("dir_fd") is not None
            ):
                # Below a folder that is open, a path means something else the next time.
                self._is_keepable = self._is_noting = False
            else:
                question = (kind if options.get("follow_symlinks", True) else "lstat", os.fsdecode(path or "."))
                if question not in self._asked:
                    self._asked[question] = answer = _ask_early(*question)
                    *facts, changed = answer.split(" ")
                    if kind != "rights" and len(facts) == _FACTS_OF_FILES and int(changed) >= self._settled_before:
                        # It cannot be kept: there is nothing more to note.
                        self._is_keepable = self._is_noting = False
            return function(path, *arguments, **options)

        return ask

    def _note_git(self, ask: Callable[..., Any], folder: str, words: Sequence[str]) -> Any:  # noqa: ANN401 - git's answer
        if not self._is_noting or not _are_plain(words):
            return ask(folder, words)  # the process that is started is an act
        self._is_noting = False
        try:
            result = ask(folder, words)
        finally:
            self._is_noting = True
        question, answer = ("git", json.dumps([os.path.abspath(folder), words])), _digest(repr(result))  # noqa: PTH100 - as above
        self._is_keepable &= self._asked.setdefault(question, answer) == answer
        return result

    def _ask_again(self, kind: str, path: str) -> str:
        if kind != "git":
            return _ask_disk(kind, path)
        folder, words = json.loads(path)
        if not _are_plain(words):
            raise ValueError(path)
        return _digest(repr(self._ask_git(folder, words)))

    def _settle_answer(self, kind: str, path: str) -> str:
        """Return what the disk answers, or what git said. Raise _UnkeptError where the disk may have said otherwise during the run."""
        if kind == "git":
            return self._asked[kind, path]
        try:
            status = _LSTAT(path)
        except OSError:
            status = None
        is_link = status is not None and stat.S_ISLNK(status.st_mode)
        answer = _ask_disk(kind, path, None if is_link else status)
        early_answer = self._asked.get((kind, path))
        if early_answer and early_answer != (_ask_early(kind, path) if kind == "names" else answer):
            raise _UnkeptError
        try:
            is_settled = status is None or self._is_settled(status, kind)
            if is_settled and is_link:
                is_settled = self._is_settled(_STAT(path), kind)
        except OSError:
            return answer
        if not is_settled:
            raise _UnkeptError
        return answer

    def _is_settled(self, status: os.stat_result, kind: str) -> bool:
        # Of folders on the way it counts which they are: `/tmp` changes all the time.
        return status.st_ctime_ns < self._settled_before or (stat.S_ISDIR(status.st_mode) and kind != "names")

    def _copy_words(self, number: int, stream: Any) -> io.TextIOWrapper:  # noqa: ANN401 - one with bytes behind it
        copying = cast("Any", _CopyingStream(stream, number, self._said))
        buffering = {"line_buffering": stream.line_buffering, "write_through": stream.write_through}
        return io.TextIOWrapper(copying, stream.encoding, stream.errors, **buffering)


class _CopyingStream(io.RawIOBase):
    """What is written to a stream, and kept."""

    def __init__(self, stream: Any, number: int, said: list[tuple[int, str]]) -> None:  # noqa: ANN401 - as above
        self._stream, self._number, self._said = stream, number, said

    def writable(self) -> bool:
        return True

    def isatty(self) -> bool:
        return bool(self._stream.isatty())

    def fileno(self) -> int:
        return int(self._stream.fileno())

    def write(self, data: Any) -> int:  # noqa: ANN401 - bytes of any kind
        # What is no UTF-8 is not safe, so that the run is not kept.
        self._said.append((self._number, bytes(data).decode("utf-8", "replace").replace("\ufffd", "\0")))
        return int(self._stream.buffer.write(data))

    def flush(self) -> None:
        # Kept as an empty text, so that both streams are in the same order where they go to one place.
        self._said.append((self._number, ""))
        self._stream.flush()


def _is_writing(how: int | str = "r", *, flags: int = 0, mode: str = "r", **_: object) -> bool:
    """Whether arguments behind the path, of `open` or of `os.open`, open a file to be written."""
    is_marked = bool((how if isinstance(how, int) else flags) & _WRITING_FLAGS)
    return is_marked or not _WRITING_LETTERS.isdisjoint(f"{how}{mode}")


def _are_plain(words: Sequence[str]) -> bool:
    """Whether words for git ask for nothing but what a project's files are in its commits."""
    return all(map(_GIT_WORD.fullmatch, takewhile(lambda word: word not in {"--", "--end-of-options"}, words)))


def _is_safe(said: Sequence[tuple[int, str]]) -> bool:
    return all(_SAFE_TEXT.fullmatch(text) for _, text in said)


def _name_run(words: Sequence[str]) -> str:
    """Return a digest of what decides a run beside the disk."""
    streams = [
        (stream.isatty(), getattr(stream, "encoding", "")) for stream in (sys.stdin, sys.stdout, sys.stderr) if stream
    ]
    try:
        width = os.get_terminal_size(1)
    except OSError:  # no terminal
        width = None
    folder = os.getcwd() if os.path.isdir(".") else ""  # noqa: PTH109, PTH112 - as above
    surroundings = (sys.version, sys.executable, sys.flags, folder, os.geteuid(), sorted(os.environ.items()))
    return _digest(repr((list(words), streams, width, *surroundings)))


def _list_code() -> dict[tuple[str, str], str]:
    """Return questions about the code that was loaded, and about where Python looks for code."""
    files = (vars(module).get("__file__") for module in list(sys.modules.values()))
    return {("bytes", str(path)): "" for path in (*files, *sys.path) if path}


def _ask_early(kind: str, path: str) -> str:
    """Return what the disk answers while the run goes on: of a folder when it changed last, not all that it holds."""
    return _ask_disk("bytes" if kind == "names" else kind, path)


def _ask_disk(kind: str, path: str, known_status: os.stat_result | None = None) -> str:
    """Return what the disk answers, as short text. What is known already of a file that is no link is not asked again."""
    try:
        if kind == "names":
            with _SCANDIR(path) as entries:
                return _digest(repr(sorted(map(_describe_entry, entries))))
        status = known_status or (_LSTAT(path) if kind == "lstat" else _STAT(path))
        identity = f"{status.st_mode} {status.st_uid} {status.st_gid} {status.st_dev} {status.st_ino}"
        if stat.S_ISLNK(status.st_mode):
            return f"{identity} {_READLINK(path)}"
        if kind == "rights":
            return f"{identity} {[_ACCESS(path, right) for right in (os.R_OK, os.W_OK, os.X_OK)]}"
    except OSError as error:
        return f"no: {error.errno}"
    if stat.S_ISDIR(status.st_mode) and kind != "bytes":
        return identity
    # No file is written without a change of the last of these, whatever dates its writer sets.
    return f"{identity} {status.st_size} {status.st_mtime_ns} {status.st_ctime_ns}"


def _describe_entry(entry: os.DirEntry[str]) -> tuple[str, bool, bool, bool]:
    is_link = entry.is_symlink()
    try:
        return entry.name, is_link, entry.is_dir(), entry.is_file()
    except OSError:  # a link that leads round in a circle
        return entry.name, is_link, False, False


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()
