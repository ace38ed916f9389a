"""Count a project at every commit: cached counts are used, the rest is counted in several processes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from archgen.history import kept, workers
from archgen.history.commits import By, Commit, commits
from archgen.history.points import plain, read
from archgen.model.history import History, Point
from archgen.project import tracked

Progress = Callable[[int, int], None]


def history(
    path: Path | None,
    by: By = "revision",
    *,
    cache: Path | None = None,
    progress: Progress | None = None,
    least: int = 1,
) -> History:
    """Return size, progress and findings of a project over time, oldest first: at each commit of HEAD's line of first
    parents that changed its files, or at the last one of each month.

    `cache` is the folder for cached counts. With fewer than `least_points` commits none is counted. Raises
    `git.GitError` and `project.ProjectNotFoundError`.
    """
    found = tracked(path)
    line = commits(found, by)
    if len(line) < least:
        return History((), by, whole=not found.objects.repository.shallow)
    # Cached by tree and not by commit: whatever commit holds it, the same tree has the same counts.
    file = kept.file(cache, "/".join(found.places[0]))
    held = {tree: point for tree, data in kept.load(file).items() if (point := _read(data))}
    missing = {one.tree: one for one in line if one.tree not in held}
    if missing:
        counted = workers.count(path, tuple(missing.values()), progress)
        held |= {one.tree: point for one, point in zip(missing.values(), counted, strict=True)}
        # Cached points of trees that are not on this line are kept: they may belong to other branches.
        kept.store(file, {tree: plain(point) for tree, point in held.items()})
    points = tuple(_at(one, held[one.tree]) for one in line)
    return History(points, by, whole=not found.objects.repository.shallow)


def _at(one: Commit, point: Point) -> Point:
    return replace(point, commit=one.id, day=one.day)


def _read(data: dict[str, object]) -> Point | None:
    """Return a cached point, None where it has another shape."""
    try:
        return read(data)
    except (KeyError, TypeError, ValueError):
        return None
