"""Find a project's folder, and the file in it that is read first."""

from __future__ import annotations

import os
import re
from pathlib import Path

from archgen.syntax.folder_files import FolderFiles
from archgen.syntax.project_files import read_text_file

PROJECT_FILE = "archgen.yaml"


class ProjectNotFoundError(Exception):
    """There is no project where one was looked for. The message says what to do."""


def find_project(path: Path | None) -> tuple[Path, str]:
    """Return a project's folder, and the name of the file in it that is read first.

    `path` is a folder with an archgen.yaml, a file that is the whole project, or None: then the current folder and
    those above it are searched. Raises `ProjectNotFoundError`.
    """
    if path is None:
        return _find_project_around()
    real_path = Path(os.path.realpath(path))
    if os.path.isdir(real_path):  # noqa: PTH112 - Path.is_dir raises where a folder may not be entered
        if os.path.lexists(real_path / PROJECT_FILE):
            return real_path, PROJECT_FILE
        raise ProjectNotFoundError(f"{path} holds no {PROJECT_FILE}: `archgen init` makes one, or name a file")
    folder = Path(os.path.realpath(path.parent))
    if os.path.lexists(real_path) and (real_path.is_relative_to(folder) or not path.is_symlink()):
        return real_path.parent, real_path.name
    if os.path.lexists(path):  # a link that is broken or leads out of its folder: reading it says so
        return folder, path.name
    raise ProjectNotFoundError(f"{path} does not exist")


def find_project_of_slice(file: Path) -> Path | None:
    """Return the folder of the project around a file that says nothing of being one itself; None where there is none."""
    real_path = Path(os.path.realpath(file))
    if real_path.name == PROJECT_FILE or not os.path.isfile(real_path):  # noqa: PTH113 - Path.is_file may raise
        return None
    folder = _find_folder_around(real_path.parent)
    if folder is None:
        return None
    text = read_text_file(FolderFiles(real_path.parent), real_path.name).text
    return None if re.search(r"^archgen[ \t]*+:", text, re.MULTILINE) else folder


def name_path_from(folder: Path | str, path: Path | str) -> str:
    """Return the way from a folder to a path, with `/`; the whole path where there is no way, as between drives of Windows."""
    try:
        return Path(os.path.relpath(path, folder)).as_posix()
    except ValueError:
        return Path(os.path.abspath(path)).as_posix()  # noqa: PTH100 - no link is followed


def _find_folder_around(folder: Path) -> Path | None:
    return next((each for each in (folder, *folder.parents) if os.path.lexists(each / PROJECT_FILE)), None)


def _find_project_around() -> tuple[Path, str]:
    try:
        current_folder = Path.cwd()
    except OSError:
        raise ProjectNotFoundError("the current folder does not exist any more") from None
    folder = _find_folder_around(current_folder)
    if folder is not None:
        return folder, PROJECT_FILE
    raise ProjectNotFoundError(f"no {PROJECT_FILE} here or in a folder above: `archgen init` makes one, or name a file")
