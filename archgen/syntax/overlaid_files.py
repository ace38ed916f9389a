"""A project's files with some contents replaced, so that what is about to be written can be checked before it is."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from archgen.syntax.project_files import MAX_BYTES, TOO_LARGE, FileRefusal, ProjectFiles


@dataclass(frozen=True, slots=True)
class OverlaidFiles:
    """New contents by path, laid over the files of a project (`base_files` None: an empty folder).

    Implements `ProjectFiles`.
    """

    root: Path
    contents: Mapping[str, bytes]
    base_files: ProjectFiles | None = None
    commit: str = ""

    def has_path(self, path: str) -> bool:
        """Whether there is anything at a path."""
        return path in self.contents or (self.base_files is not None and self.base_files.has_path(path))

    def walk_folders(self, top: str) -> Iterator[tuple[str, list[str], list[str]]]:
        """Walk down from a folder: first the folders of the base files, then those that only the overlay has."""
        walked_folders = set[str]()
        for relative_folder, folders, file_names in (
            self.base_files.walk_folders(top) if self.base_files is not None else ()
        ):
            walked_folders.add(relative_folder)
            yield relative_folder, folders, sorted({*file_names, *self._list_names_in(top, relative_folder)})
        # Folders of the overlay alone are yielded without subfolders: a caller cannot prune them, so hidden ones are
        # left out here.
        for relative_folder in sorted({path.rpartition("/")[0] for path in self._list_paths_below(top)}):
            if relative_folder not in walked_folders and not any(
                part.startswith(".") for part in relative_folder.split("/")
            ):
                yield relative_folder, [], sorted(self._list_names_in(top, relative_folder))

    def fetch_bytes(self, path: str) -> bytes | FileRefusal:
        """Return a file's bytes, from the overlay where it has the file; the size limit holds for both."""
        if path in self.contents:
            data = self.contents[path]
            return data if len(data) <= MAX_BYTES else TOO_LARGE
        return (
            self.base_files.fetch_bytes(path) if self.base_files is not None else FileRefusal("the file does not exist")
        )

    def _list_paths_below(self, top: str) -> Iterator[str]:
        for path in self.contents:
            if not top or PurePosixPath(path).is_relative_to(top):
                yield path[len(top) + 1 :] if top else path

    def _list_names_in(self, top: str, relative_folder: str) -> Iterator[str]:
        for path in self._list_paths_below(top):
            folder, _, name = path.rpartition("/")
            if folder == relative_folder:
                yield name
