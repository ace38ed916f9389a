"""Count a project at every commit: cached counts are used, the rest is counted in several processes."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from archgen.cache.file_store import FileStore, digest_text
from archgen.cache.program_stamp import stamp_program
from archgen.frozen import replace
from archgen.history import workers
from archgen.history.history_points import point_from_data
from archgen.history.project_commits import HistoryInterval, list_commits
from archgen.model.project_history import History, HistoryPoint
from archgen.project import find_tracked_project

_MAX_FILES = 8
"""The most files that are kept."""
CachedPoints = dict[str, dict[str, Any]]


class PointCache:
    """The cached points of the project at one place; without a folder it is empty."""

    def __init__(self, folder: Path | None, place: str) -> None:
        """Point to the file of a project. The code is part of its name: a changed rule may count other findings."""
        self._files = FileStore(folder, ".history", _MAX_FILES)
        self._key = digest_text(f"{stamp_program()}\n{place}")[:40] if folder else ""

    def load_points(self) -> CachedPoints:
        """Read the cached points, by the id of a tree. What cannot be read counts as missing."""
        try:
            cached = json.loads(self._files.load(self._key) or b"{}")
        except ValueError:
            return {}
        return (
            {str(tree): data for tree, data in cached.items() if isinstance(data, dict)}
            if isinstance(cached, dict)
            else {}
        )

    def store_points(self, points: Mapping[str, Mapping[str, Any]]) -> None:
        """Replace the cached points."""
        self._files.store(self._key, json.dumps(points).encode())


def count_history(
    path: Path | None,
    interval: HistoryInterval = "revision",
    *,
    cache: Path | None = None,
    progress: workers.WorkerProgress | None = None,
    least_points: int = 1,
) -> History:
    """Return size, progress and findings of a project over time, oldest first: at each commit of HEAD's line of first
    parents that changed its files, or at the last one of each month.

    `cache` is the folder for cached counts. With fewer than `least_points` commits none is counted. Raises
    `git.GitError` and `project.ProjectNotFoundError`.
    """
    tracked_project = find_tracked_project(path)
    commit_line = list_commits(tracked_project, interval)
    if len(commit_line) < least_points:
        return History((), interval, whole=not tracked_project.objects.repository.is_shallow)
    # Cached by tree and not by commit: whatever commit holds it, the same tree has the same counts.
    point_cache = PointCache(cache, "/".join(tracked_project.locations[0]))
    points_by_tree = {
        tree: point
        for tree, plain_point in point_cache.load_points().items()
        if (point := _read_cached_point(plain_point))
    }
    missing = {commit.tree_id: commit for commit in commit_line if commit.tree_id not in points_by_tree}
    if missing:
        counted = workers.count_commits(path, tuple(missing.values()), progress)
        points_by_tree |= {commit.tree_id: point for commit, point in zip(missing.values(), counted, strict=True)}
        # Cached points of trees that are not on this line are kept: they may belong to other branches.
        point_cache.store_points({tree: asdict(point) for tree, point in points_by_tree.items()})
    points = tuple(replace(points_by_tree[commit.tree_id], commit=commit.id, day=commit.day) for commit in commit_line)
    return History(points, interval, whole=not tracked_project.objects.repository.is_shallow)


def _read_cached_point(data: dict[str, object]) -> HistoryPoint | None:
    """Return a cached point, None where it has another shape."""
    try:
        return point_from_data(data)
    except (KeyError, TypeError, ValueError):
        return None
