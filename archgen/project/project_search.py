"""Find a project's folder, and the file in it that is read first."""

from __future__ import annotations

import os
from pathlib import Path

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
        msg = f"{path} holds no {PROJECT_FILE}: `archgen init` makes one, or name a file"
        raise ProjectNotFoundError(msg)
    if os.path.lexists(real_path):
        return real_path.parent, real_path.name
    if os.path.lexists(path):  # a broken link: reading it says so
        return Path(os.path.realpath(path.parent)), path.name
    msg = f"{path} does not exist"
    raise ProjectNotFoundError(msg)


def _find_project_around() -> tuple[Path, str]:
    try:
        current_folder = Path.cwd()
    except OSError:
        msg = "the current folder does not exist any more"
        raise ProjectNotFoundError(msg) from None
    for folder in (current_folder, *current_folder.parents):
        if os.path.lexists(folder / PROJECT_FILE):
            return folder, PROJECT_FILE
    msg = f"no {PROJECT_FILE} here or in a folder above: `archgen init` makes one, or name a file"
    raise ProjectNotFoundError(msg)
