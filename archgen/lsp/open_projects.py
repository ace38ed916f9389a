"""The projects whose files stand open in an editor: which one a file belongs to, and what it is called there."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path

from pygls import uris

from archgen.live.warm_project import EditedProject
from archgen.project.project_search import PROJECT_FILE, ProjectNotFoundError, name_path_from
from archgen.syntax.file_patterns import is_yaml_name

_OWN_PROJECT = re.compile(r"^archgen[ \t]*+:", re.MULTILINE)


class OpenProjects:
    """Projects by the path that is checked: a folder with an archgen.yaml, or a file that is a whole project."""

    def __init__(self) -> None:
        """Start without any."""
        self.projects: dict[Path, EditedProject] = {}
        self._uris: dict[Path, str] = {}
        """How the editor writes the addresses of what is open."""
        self._holders: dict[Path, EditedProject] = {}
        """The projects of what is open: they stay when an archgen.yaml goes."""

    def open_file(self, uri: str, text: str) -> tuple[EditedProject, str] | None:
        """Return the project of a file that is opened or changed, with its name there; None where it belongs to none."""
        path = _find_path(uri)
        if path is None:
            return None
        self._uris[path] = uri
        is_own = path.name != PROJECT_FILE and is_yaml_name(path.name) and _OWN_PROJECT.search(text) is not None
        found = (None if is_own else self.find_file(uri)) or self._start_project(
            path if is_own else _find_folder(path), path
        )
        if found is not None:
            self._holders[path] = found[0]
        return found

    def close_file(self, uri: str) -> None:
        """Forget how an editor calls a file."""
        path = _find_path(uri)
        if path is not None:
            self._uris.pop(path, None)
            self._holders.pop(path, None)

    def find_file(self, uri: str) -> tuple[EditedProject, str] | None:
        """Return the project that a file belongs to, and its name there; None where no open project has it.

        A library belongs to the project that was opened first.
        """
        path = _find_path(uri)
        if path is None:
            return None
        if path in self._holders:
            return self._holders[path], name_file(self._holders[path], path)
        nearest = _find_folder(path)
        for root, project in self.projects.items():
            name = name_file(project, path)
            checked = project.last_checked
            if root in {path, nearest} or (checked and name in checked.loaded_project.library_files):
                return project, name
        return None

    def _start_project(self, root: Path | None, path: Path) -> tuple[EditedProject, str] | None:
        if root is None:
            return None
        try:
            project = self.projects.get(root) or EditedProject(root)
        except ProjectNotFoundError:  # such as a file that was never saved
            return None
        self.projects[root] = project
        return project, name_file(project, path)

    def write_uri(self, project: EditedProject, file: str) -> str:
        """Return the address of a project's file, as the editor writes it where it is open."""
        path = Path(os.path.normpath(project.warm.root / file))
        return self._uris.get(path) or uris.from_fs_path(str(path)) or ""

    def list_open_files(self, project: EditedProject) -> Iterator[tuple[str, str]]:
        """Yield the address and the name of each open file of a project."""
        for uri in self._uris.values():
            found = self.find_file(uri)
            if found and found[0] is project:
                yield uri, found[1]


def name_file(project: EditedProject, path: Path) -> str:
    """Return what a project calls a file: its path from the project's folder."""
    return name_path_from(project.warm.root, path)


def _find_path(uri: str) -> Path | None:
    """Return the path that an address means, without links in its folders; None for what is no file of this machine."""
    path = uris.to_fs_path(uri)
    if not path or "\0" in path or not os.path.isabs(path):  # noqa: PTH117 - a text, not a path yet
        return None
    folder, name = os.path.split(path)
    return Path(os.path.realpath(folder)) / name if name else None


def _find_folder(path: Path) -> Path | None:
    """Return the folder of the project around a file."""
    return next((folder for folder in path.parents if os.path.lexists(folder / PROJECT_FILE)), None)
