"""The files of a library, by their paths from the folder of the project that names it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from archgen.frozen import dataclass
from archgen.syntax.project_files import FileRefusal, ProjectFiles


@dataclass(frozen=True, slots=True)
class LibraryFiles:
    """The files of another folder by paths such as `../common/laser.yaml`. Implements `ProjectFiles`.

    So a finding in a library names its file as people at the project would. `folder` is in its shortest form.
    """

    folder: str
    folder_files: ProjectFiles

    @property
    def root(self) -> Path:
        """The library's folder."""
        return self.folder_files.root

    @property
    def commit(self) -> str:
        """The full hash of the commit that holds the files; empty for files on disk."""
        return self.folder_files.commit

    def has_path(self, path: str) -> bool:
        """Whether there is anything at a path, even a broken link."""
        return self.folder_files.has_path(self._to_inner(path))

    def is_behind_link(self, path: str) -> bool:
        """Whether a path leads to a file through a symbolic link."""
        return self.folder_files.is_behind_link(self._to_inner(path))

    def walk_folders(self, top: str) -> Iterator[tuple[str, list[str], list[str]]]:
        """Walk down from a folder, as the library's files do."""
        return self.folder_files.walk_folders(self._to_inner(top))

    def fetch_bytes(self, path: str) -> bytes | FileRefusal:
        """Return a file's bytes, or why it cannot be used."""
        return self.folder_files.fetch_bytes(self._to_inner(path))

    def open_folder(self, path: str) -> ProjectFiles | FileRefusal:
        """Return no files: a library has no libraries of its own."""
        return FileRefusal(f"a library has no libraries of its own: `{path}`", "name it in the project")

    def _to_inner(self, path: str) -> str:
        return path.removeprefix(self.folder).removeprefix("/")
