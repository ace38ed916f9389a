"""What stands at a path of a workspace: a file with its digest, or something in the way. No link is followed."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from archgen.emit.file_tree import digest_named_file, list_files_below


@dataclass(frozen=True, slots=True)
class DiskFile:
    """What stands at a path. `obstacle` says in words why no file can be written there."""

    digest: str | None = None
    mode: int = 0
    obstacle: str = ""
    obstacle_path: str = ""

    @property
    def exists(self) -> bool:
        """Whether there is a plain file."""
        return self.digest is not None


class DiskReader:
    """Looks at the paths of one workspace; folders on the way are looked at once."""

    def __init__(self, workspace: Path) -> None:
        """Start with nothing looked at."""
        # As text: paths as objects take longer than what is read.
        self._prefix = os.path.join(workspace, "")  # noqa: PTH118
        self._folder_obstacles: dict[str, tuple[str, str]] = {"": ("", "")}

    def read(self, path: str) -> DiskFile:
        """Return what stands at a path."""
        obstacle, obstacle_path = self._find_folder_obstacle(path.rpartition("/")[0])
        if obstacle:
            return DiskFile(obstacle=obstacle, obstacle_path=obstacle_path)
        name = self._prefix + path
        try:
            status = os.lstat(name)
        except FileNotFoundError:
            return DiskFile()
        if stat.S_ISLNK(status.st_mode):
            return DiskFile(obstacle="is a link", obstacle_path=path)
        if stat.S_ISDIR(status.st_mode):
            return DiskFile(obstacle="is a folder", obstacle_path=path)
        digest = digest_named_file(name, status.st_size) if stat.S_ISREG(status.st_mode) else None
        if digest is None:
            return DiskFile(obstacle="is no plain file", obstacle_path=path)
        return DiskFile(digest, stat.S_IMODE(status.st_mode))

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
