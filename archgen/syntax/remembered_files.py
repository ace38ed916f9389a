"""A project's files of which each is read once: its variants name the same interfaces, chapters and parameters."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from archgen.syntax.project_files import FileRefusal, ProjectFiles

_MAX_KEPT_BYTES = 256 * 1024
"""A larger file, such as a picture, is read again: there are few of them, and memory is for the model."""


class RememberedFiles:
    """The files of a project as they were when each was read first. Implements `ProjectFiles`."""

    def __init__(self, files: ProjectFiles) -> None:
        """Remember nothing yet."""
        self._files = files
        self._contents: dict[str, bytes | FileRefusal] = {}

    @property
    def root(self) -> Path:
        """The project's folder."""
        return self._files.root

    @property
    def commit(self) -> str:
        """The hash of the commit that holds the files; empty for files on disk."""
        return self._files.commit

    def has_path(self, path: str) -> bool:
        """Whether there is anything at a path."""
        return self._files.has_path(path)

    def is_behind_link(self, path: str) -> bool:
        """Whether a path leads to a file through a symbolic link."""
        return self._files.is_behind_link(path)

    def walk_folders(self, top: str) -> Iterator[tuple[str, list[str], list[str]]]:
        """Walk down from a folder; callers may remove folders from the list to skip them."""
        return self._files.walk_folders(top)

    def fetch_bytes(self, path: str) -> bytes | FileRefusal:
        """Return a file's bytes, or why it cannot be used."""
        content = self._contents.get(path)
        if content is None:
            content = self._files.fetch_bytes(path)
            if isinstance(content, FileRefusal) or len(content) <= _MAX_KEPT_BYTES:
                self._contents[path] = content
        return content

    def open_folder(self, path: str) -> ProjectFiles | FileRefusal:
        """Return the files of another folder of the repository, or why they cannot be used."""
        return self._files.open_folder(path)
