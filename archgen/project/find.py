"""Find a project's folder, and the file in it that is read first."""

from __future__ import annotations

import os
from pathlib import Path

MARKER = "archgen.yaml"


class ProjectNotFoundError(Exception):
    """There is no project where one was looked for. The message says what to do."""


def find(path: Path | None) -> tuple[Path, str]:
    """Return a project's folder, and the name of the file in it that is read first.

    `path` is a folder with an archgen.yaml, a file that is the whole project, or None: then the current folder and
    those above it are searched. Raises `ProjectNotFoundError`.
    """
    if path is None:
        return _around()
    real = Path(os.path.realpath(path))
    if os.path.isdir(real):  # noqa: PTH112 - Path.is_dir raises where a folder may not be entered
        if os.path.lexists(real / MARKER):
            return real, MARKER
        msg = f"{path} holds no {MARKER}: `archgen init` makes one, or name a file"
        raise ProjectNotFoundError(msg)
    if os.path.lexists(real):
        return real.parent, real.name
    if os.path.lexists(path):  # a broken link: reading it says so
        return Path(os.path.realpath(path.parent)), path.name
    msg = f"{path} does not exist"
    raise ProjectNotFoundError(msg)


def _around() -> tuple[Path, str]:
    try:
        here = Path.cwd()
    except OSError:
        msg = "the current folder does not exist any more"
        raise ProjectNotFoundError(msg) from None
    for folder in (here, *here.parents):
        if os.path.lexists(folder / MARKER):
            return folder, MARKER
    msg = f"no {MARKER} here or in a folder above: `archgen init` makes one, or name a file"
    raise ProjectNotFoundError(msg)
