"""Notice that files of a project have changed, by asking for their sizes and times again and again.

Asking costs about 1 ms for a hundred files; a library that has the system tell would be one more dependency, and sees
nothing on network folders and in containers.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path, PurePath

from archgen.frozen import dataclass
from archgen.syntax.file_patterns import YAML_ENDINGS

Snapshot = Mapping[str, tuple[int, int, int]]
"""Time (ns), size and number of each watched file, by its path."""
_WATCHED_ENDINGS = frozenset(
    {*YAML_ENDINGS, ".md", ".msg", ".srv", ".action", ".png", ".jpg", ".jpeg", ".gif", ".webp", ".svg"}
)
_SKIPPED_FOLDERS = frozenset({"archgen-out", "node_modules", "__pycache__"})
_SHORTEST_PAUSE, _LONGEST_PAUSE = 0.03, 2.0
"""Seconds between two looks."""
_BUSY_SHARE = 25
"""A pause is at least as many times as long as a look: 4 % of one processor."""
_SETTLING_TIME = 0.012
"""Seconds after which files count as saved: editors empty a file before they fill it."""


@dataclass(frozen=True, slots=True)
class WatchedPlaces:
    """What to watch: folders with all below them, and files wherever they are."""

    folders: tuple[Path, ...] = ()
    files: tuple[Path, ...] = ()


def take_snapshot(places: WatchedPlaces) -> Snapshot:
    """Look at all watched files. What cannot be read is as if it were not there."""
    snapshot: dict[str, tuple[int, int, int]] = {}
    for file in places.files:
        _add_file(snapshot, os.fspath(file))
    pending_folders = [os.fspath(folder) for folder in places.folders]
    while pending_folders:
        try:
            entries = list(os.scandir(pending_folders.pop()))
        except OSError:
            continue
        for entry in entries:
            if entry.name.startswith("."):
                continue
            if entry.is_dir(follow_symlinks=False):
                if entry.name not in _SKIPPED_FOLDERS:
                    pending_folders.append(entry.path)
            elif PurePath(entry.name).suffix.lower() in _WATCHED_ENDINGS:
                _add_file(snapshot, entry.path)
    return snapshot


def _add_file(snapshot: dict[str, tuple[int, int, int]], path: str) -> None:
    try:
        status = os.stat(path)  # noqa: PTH116 - a Path for each file takes as long as asking
    except OSError:
        return
    snapshot[path] = (status.st_mtime_ns, status.st_size, status.st_ino)


def watch_files(
    choose_places: Callable[[], WatchedPlaces], on_change: Callable[[], object], stopped: threading.Event
) -> None:
    """Call `on_change` whenever watched files have changed, until `stopped` is set. The places are asked for each time."""
    last_snapshot = take_snapshot(choose_places())
    while True:
        start = time.perf_counter()
        snapshot = take_snapshot(choose_places())
        cost = time.perf_counter() - start
        if snapshot != last_snapshot:
            last_snapshot = _wait_until_saved(choose_places, snapshot, stopped)
            on_change()
        if stopped.wait(min(_LONGEST_PAUSE, max(_SHORTEST_PAUSE, cost * _BUSY_SHARE))):
            return


def _wait_until_saved(
    choose_places: Callable[[], WatchedPlaces], snapshot: Snapshot, stopped: threading.Event
) -> Snapshot:
    """Wait until two looks in a row see the same, and return what they see."""
    while not stopped.wait(_SETTLING_TIME):
        next_snapshot = take_snapshot(choose_places())
        if next_snapshot == snapshot:
            break
        snapshot = next_snapshot
    return snapshot


def join_paths(root: Path, names: Iterable[str]) -> tuple[Path, ...]:
    """Return the paths of files that are named relative to a folder."""
    return tuple(root / name for name in names)
