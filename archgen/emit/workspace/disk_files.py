"""The files of a workspace: those that a backend makes, and what stands at a path already."""

from __future__ import annotations

import errno
import hashlib
import os
import stat
import unicodedata
from collections.abc import Collection, Iterable, Iterator
from functools import lru_cache
from pathlib import Path

from archgen.emit.file_tree import digest_named_file, list_files_below
from archgen.emit.safe_names import explain_long_path, is_safe_path
from archgen.frozen import dataclass

_MAX_TEXT_BYTES = 16_000_000
"""A larger file is no text whose ends of lines git changes."""

_LINK_FLAG = getattr(os, "O_NOFOLLOW", 0)
"""Opens no link; Windows has none."""
_OPENING_FLAGS = _LINK_FLAG | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0) | os.O_RDONLY
_MAX_PART_BYTES = 200
"""What every file system takes as one name, with room for what other tools append."""
_MAX_SHOWN_PATH = 120
_TOOL_FOLDERS = frozenset({".archgen", ".git", ".hg", ".svn"})
"""Folders in which a file is an instruction to a tool: `.git/hooks/pre-commit` is run."""


@dataclass(frozen=True, slots=True)
class GeneratedFile:
    """One file to write. `path` is relative to the workspace, with `/` between its parts."""

    path: str
    data: bytes
    executable: bool = False
    once: bool = False
    """The user's own from the start: written where it is absent, and never touched again."""
    expected_words: tuple[str, ...] = ()
    """Words that the user's own file should hold."""
    offered_words: tuple[str, ...] = ()
    """Words that it may use of what is generated."""
    place: str = ""
    """Where the element stands that it is made for, such as `archgen.yaml:12:3`; empty where there is none."""


def fold_file_path(path: str) -> str:
    """Return a path as file systems compare it that ignore case, or write letters and accents apart."""
    if path.isascii():
        return path.lower()
    return unicodedata.normalize("NFC", unicodedata.normalize("NFC", path).casefold())


def find_path_problems(files: Iterable[GeneratedFile]) -> Iterator[str]:
    """Yield in words what is wrong with the paths of generated files, with the places that they come from."""
    files_by_fold = dict[str, GeneratedFile]()
    folders_by_fold = dict[str, GeneratedFile]()
    for file in files:
        refusal = explain_bad_path(file.path)
        if refusal:
            yield f"{_name_file(file)} {refusal}"
            continue
        fold = fold_file_path(file.path)
        other = files_by_fold.get(fold) or folders_by_fold.get(fold)
        parent = fold.rpartition("/")[0]
        while parent and parent not in folders_by_fold:
            other = other or files_by_fold.get(parent)
            folders_by_fold[parent] = file
            parent = parent.rpartition("/")[0]
        if other is not None:
            yield f"{_name_file(other)} and {_name_file(file)} fall together: {_explain_clash(other.path, file.path)}"
        files_by_fold.setdefault(fold, file)


@lru_cache(65536)  # asked of each file that is made, and of each in the record
def explain_bad_path(path: str) -> str:
    """Return why a path may not be written, as the end of a sentence; empty where it may."""
    if explain_long_path(path):
        return "is too long a path"
    if not is_safe_path(path):
        return "is no path that every system takes"
    data = path.encode("utf-8", "surrogatepass")
    if len(data) > _MAX_PART_BYTES and any(len(part) > _MAX_PART_BYTES for part in data.split(b"/")):
        return f"has a part of more than {_MAX_PART_BYTES} bytes"
    folded_parts = fold_file_path(path).split("/")
    if any(part in _TOOL_FOLDERS or part.startswith("git~") for part in folded_parts):
        return "leads into a folder of another tool"
    return ""


def _name_file(file: GeneratedFile) -> str:
    path = file.path if len(file.path) <= _MAX_SHOWN_PATH else f"{file.path[:_MAX_SHOWN_PATH]}..."
    return f"`{path}`" + (f" ({file.place})" if file.place else "")


def _explain_clash(first: str, second: str) -> str:
    if first == second:
        return "two files of one name"
    if len(first) == len(second):
        return "on many systems they are one file"
    return "one is a file where the other needs a folder"


@dataclass(frozen=True, slots=True)
class DiskFile:
    """What stands at a path. `obstacle` says in words why no file can be written there."""

    digest: str | None = None
    mode: int = 0
    obstacle: str = ""
    obstacle_path: str = ""
    digest_with_line_feeds: str | None = None
    """That of the file as archgen writes lines, where they end as on Windows: git does so there when it checks out."""

    @property
    def exists(self) -> bool:
        """Whether there is a plain file."""
        return self.digest is not None

    def has_digest(self, digests: Collection[str]) -> bool:
        """Whether the file has one of these digests, but for the ends of its lines."""
        return self.digest in digests or self.digest_with_line_feeds in digests


class DiskReader:
    """Looks at the paths of one workspace; folders on the way are looked at once."""

    def __init__(self, workspace: Path, leaving: Collection[str] = ()) -> None:
        """Start with nothing looked at. Files that are `leaving` count as gone."""
        self._leaving = leaving
        # As text: paths as objects take longer than what is read.
        self._prefix = os.path.join(workspace, "")  # noqa: PTH118
        self._folder_obstacles: dict[str, tuple[str, str]] = {"": ("", "")}

    def read(self, path: str) -> DiskFile:
        """Return what stands at a path."""
        obstacle, obstacle_path = self._find_folder_obstacle(path.rpartition("/")[0])
        if obstacle:
            return DiskFile(obstacle=obstacle, obstacle_path=obstacle_path)
        if path in self._leaving:
            return DiskFile()
        try:
            # Opened first: of 5,000 files, asking for each what it is before took as long as reading them.
            status, data = self._read_plain(path)
        except FileNotFoundError:
            return DiskFile()
        except OSError:
            status, data = os.lstat(self._prefix + path), None
            if stat.S_ISREG(status.st_mode):
                raise
        if stat.S_ISLNK(status.st_mode) or stat.S_ISDIR(status.st_mode):
            obstacle = "is a link" if stat.S_ISLNK(status.st_mode) else "is a folder"
            return DiskFile(obstacle=obstacle, obstacle_path=path)
        digest = None
        if data is not None:
            digest = hashlib.sha256(data).hexdigest()
        elif stat.S_ISREG(status.st_mode):
            digest = digest_named_file(self._prefix + path, status.st_size)
        if digest is None:
            return DiskFile(obstacle="is no plain file", obstacle_path=path)
        data = data or b""
        plain_data = data.replace(b"\r\n", b"\n") if b"\r\n" in data else data
        plain_digest = hashlib.sha256(plain_data).hexdigest() if plain_data is not data else None
        return DiskFile(digest, stat.S_IMODE(status.st_mode), digest_with_line_feeds=plain_digest)

    def _read_plain(self, path: str) -> tuple[os.stat_result, bytes | None]:
        """Return what stands at a path, and the bytes of a plain file that is not too large. Raise OSError, also for a link."""
        if not _LINK_FLAG and os.path.islink(self._prefix + path):  # noqa: PTH114 - as above
            raise OSError(errno.ELOOP, "is a link", path)
        descriptor = os.open(self._prefix + path, _OPENING_FLAGS)
        status = os.fstat(descriptor)
        if not stat.S_ISREG(status.st_mode) or status.st_size > _MAX_TEXT_BYTES:
            os.close(descriptor)
            return status, None
        with open(descriptor, "rb", buffering=0) as stream:  # noqa: PTH123 - as above
            return status, stream.read()

    def read_data(self, path: str) -> bytes:
        """Return the bytes of a file that is there."""
        with open(self._prefix + path, "rb", buffering=0) as stream:  # noqa: PTH123 - as above
            return stream.read()

    def list_below(self, folder: str) -> Iterator[str]:
        """Yield the paths of all files below a folder."""
        return (f"{folder}/{path}" for path in list_files_below(Path(self._prefix + folder)))

    def _find_folder_obstacle(self, folder: str) -> tuple[str, str]:
        """Return what makes a folder on the way unusable, and where; empty texts where it is a folder or absent."""
        if folder not in self._folder_obstacles:
            above = self._find_folder_obstacle(folder.rpartition("/")[0])
            self._folder_obstacles[folder] = above if above[0] else self._judge_folder(folder)
        return self._folder_obstacles[folder]

    def _judge_folder(self, folder: str) -> tuple[str, str]:
        try:
            mode = os.lstat(self._prefix + folder).st_mode
        except FileNotFoundError:
            return "", ""
        if stat.S_ISLNK(mode):
            return "is a link", folder
        return ("", "") if stat.S_ISDIR(mode) else ("is a file", folder)
