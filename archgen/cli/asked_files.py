"""What `[PROJECT | FILE...]` on the command line asks for."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from collections.abc import Iterable

    from archgen.pipeline import CheckedProject


def find_asked_files(paths: tuple[Path, ...], project: Path | None) -> tuple[Path | None, tuple[Path, ...]]:
    """Return the project that is asked for, and the files of it that alone are; none for all."""
    if not paths:
        return project, ()
    if project is not None:
        other_paths = [path for path in paths if not os.path.isfile(path)]  # noqa: PTH113 - Path.is_file may raise
        if other_paths:
            raise click.UsageError(f"the project is named twice: {other_paths[0]} and -C {project}")
        return project, paths
    from archgen.project.project_search import PROJECT_FILE, find_project_of_slice

    if len(paths) == 1:
        folder = find_project_of_slice(paths[0])
        return folder or paths[0], paths if folder else ()
    folders = [path.resolve().parent if path.name == PROJECT_FILE else find_project_of_slice(path) for path in paths]
    if folders[0] is None or any(folder != folders[0] for folder in folders):
        raise click.UsageError(f"these are not files of one project: {', '.join(map(str, paths))}")
    return folders[0], paths


def name_files(checked_project: CheckedProject, files: Iterable[Path]) -> dict[str, Path]:
    """Return files by what the project calls them: their path below its folder."""
    from archgen.project.project_search import name_path_from

    root = os.path.realpath(checked_project.root)
    return {name_path_from(root, os.path.realpath(file)): file for file in files}
