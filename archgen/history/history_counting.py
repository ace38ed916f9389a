"""Count a project at every commit: cached counts are used, the rest is counted in several processes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from archgen.history import workers
from archgen.history.history_points import point_from_data, point_to_data
from archgen.history.point_cache import PointCache
from archgen.history.project_commits import HistoryInterval, ProjectCommit, list_commits
from archgen.model.project_history import History, HistoryPoint
from archgen.project import find_tracked_project

CountProgress = Callable[[int, int], None]


def count_history(
    path: Path | None,
    interval: HistoryInterval = "revision",
    *,
    cache: Path | None = None,
    progress: CountProgress | None = None,
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
        point_cache.store_points({tree: point_to_data(point) for tree, point in points_by_tree.items()})
    points = tuple(_at_commit(commit, points_by_tree[commit.tree_id]) for commit in commit_line)
    return History(points, interval, whole=not tracked_project.objects.repository.is_shallow)


def _at_commit(commit: ProjectCommit, point: HistoryPoint) -> HistoryPoint:
    return replace(point, commit=commit.id, day=commit.day)


def _read_cached_point(data: dict[str, object]) -> HistoryPoint | None:
    """Return a cached point, None where it has another shape."""
    try:
        return point_from_data(data)
    except (KeyError, TypeError, ValueError):
        return None
