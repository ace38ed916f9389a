"""A project's files with some contents replaced, so that what is about to be written can be checked before it is."""

from __future__ import annotations

import posixpath
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from archgen.syntax.project_files import MAX_BYTES, NO_SUCH_FOLDER, TOO_LARGE, FileRefusal, ProjectFiles

_FolderNames = dict[str, tuple[set[str], set[str]]]
"""The names of subfolders and of files, by folder."""


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

    def is_behind_link(self, path: str) -> bool:
        """Whether a path of the base files leads to a file through a symbolic link."""
        return path not in self.contents and self.base_files is not None and self.base_files.is_behind_link(path)

    def walk_folders(self, top: str) -> Iterator[tuple[str, list[str], list[str]]]:
        """Walk down from a folder, as the base files do: callers may remove folders from the list to skip them."""
        overlay_folders = self._list_overlay_folders(top)
        is_walked = False
        for relative_folder, folders, file_names in (
            self.base_files.walk_folders(top) if self.base_files is not None else ()
        ):
            is_walked = True
            own_folders, own_names = overlay_folders.get(relative_folder, (set(), set()))
            base_folders = frozenset(folders)
            all_folders = [*folders, *sorted(own_folders - base_folders)]
            yield relative_folder, all_folders, sorted({*file_names, *own_names})
            # In place: what the caller skipped, the walk of the base files must skip as well.
            folders[:] = [name for name in all_folders if name in base_folders]
            for name in all_folders:
                if name not in base_folders:
                    yield from _walk_overlay(overlay_folders, _join_path(relative_folder, name))
        if not is_walked and overlay_folders:
            yield from _walk_overlay(overlay_folders, "")

    def fetch_bytes(self, path: str) -> bytes | FileRefusal:
        """Return a file's bytes, from the overlay where it has the file; the size limit holds for both."""
        if path in self.contents:
            data = self.contents[path]
            return data if len(data) <= MAX_BYTES else TOO_LARGE
        return (
            self.base_files.fetch_bytes(path) if self.base_files is not None else FileRefusal("the file does not exist")
        )

    def open_folder(self, path: str) -> OverlaidFiles | FileRefusal:
        """Return the files of another folder, with the contents of the overlay that lie in it."""
        base_files = self.base_files.open_folder(path) if self.base_files is not None else NO_SUCH_FOLDER
        if isinstance(base_files, FileRefusal):
            return base_files
        prefix = f"{posixpath.normpath(path)}/"
        contents = {name.removeprefix(prefix): data for name, data in self.contents.items() if name.startswith(prefix)}
        return OverlaidFiles(base_files.root, contents, base_files, self.commit)

    def _list_overlay_folders(self, top: str) -> _FolderNames:
        """Return the folders of the overlay below a folder, the empty ones between them included."""
        folder_names: _FolderNames = {}
        for path in self.contents:
            if not top or (path != top and PurePosixPath(path).is_relative_to(top)):
                folder, _, name = (path[len(top) + 1 :] if top else path).rpartition("/")
                folder_names.setdefault(folder, (set(), set()))[1].add(name)
                while folder:
                    parent, _, folder_name = folder.rpartition("/")
                    folder_names.setdefault(parent, (set(), set()))[0].add(folder_name)
                    folder = parent
        return folder_names


def _walk_overlay(folder_names: _FolderNames, relative_folder: str) -> Iterator[tuple[str, list[str], list[str]]]:
    """Walk down from a folder that only the overlay has."""
    subfolders, names = folder_names[relative_folder]
    folders = sorted(subfolders)
    yield relative_folder, folders, sorted(names)
    for name in folders:
        yield from _walk_overlay(folder_names, _join_path(relative_folder, name))


def _join_path(folder: str, name: str) -> str:
    return f"{folder}/{name}" if folder else name
