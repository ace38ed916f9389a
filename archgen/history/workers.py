"""Count commits in this process, or in one process for each core if there are many; each caches the slices it has
parsed.
"""

from __future__ import annotations

import gc
import json
import os
import subprocess
import sys
import threading
from collections.abc import Callable, Hashable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from archgen import pipeline, project
from archgen.history.commits import Commit
from archgen.history.content import Contents
from archgen.history.points import plain, point, read
from archgen.model.history import Point
from archgen.project.slices import Slices

Progress = Callable[[int, int], None]
_FEW = 8
"""So many commits are counted sooner than another process starts."""
# The names in this string are this module's own path and function: a rename must change them as well.
_START = "import sys; sys.path.append({root!r}); from archgen.history.workers import main; main()"


def count(path: Path | None, commits: Sequence[Commit], progress: Progress | None = None) -> tuple[Point, ...]:
    """Count a project at commits, in their order."""
    processes = min(os.cpu_count() or 1, 1 + len(commits) // _FEW)
    done = [0]

    def told(_: Point) -> None:
        done[0] += 1
        if progress:
            progress(done[0], len(commits))

    if processes < 2:  # noqa: PLR2004 - this one
        return tuple(_counted(path, commits, told))
    size = -(-len(commits) // processes)
    parts = [commits[start : start + size] for start in range(0, len(commits), size)]
    results: list[list[Point]] = [[] for _ in parts]
    # Threads only wait for the processes' output; this thread counts the first batch itself.
    threads = [
        threading.Thread(target=_elsewhere, args=(path, part, into, told))
        for part, into in zip(parts[1:], results[1:], strict=True)
    ]
    for thread in threads:
        thread.start()
    results[0] = _counted(path, parts[0], told)
    for thread in threads:
        thread.join()
    for part, into in zip(parts, results, strict=True):  # a process that was killed: what it left is counted here
        into.extend(_counted(path, part[len(into) :], told))
    return tuple(one for into in results for one in into)


def _counted(path: Path | None, commits: Sequence[Commit], told: Callable[[Point], None]) -> list[Point]:
    found = []
    for one in _points(path, commits):
        found.append(one)
        told(one)
    return found


def _points(path: Path | None, commits: Sequence[Commit]) -> Iterator[Point]:
    tracked, known, contents = project.tracked(path), Slices(), Contents()
    counted: dict[Hashable, Point] = {}
    for one in commits:
        loaded = project.load_commit(tracked, one.id, known)
        content = contents.of(loaded)
        found = counted.get(content)
        if found is None:
            found = counted[content] = point(pipeline.judged(loaded), one.id, one.day)
        yield replace(found, commit=one.id, day=one.day)


def _elsewhere(path: Path | None, commits: Sequence[Commit], into: list[Point], told: Callable[[Point], None]) -> None:
    # The folder that holds the package `archgen`: two levels above this file's own.
    """Count commits in another process; `batch_points` holds whatever it delivered, even if it was killed."""
    root = str(Path(__file__).resolve().parents[2])
    command = (sys.executable, "-P", "-c", _START.format(root=root))
    asked = {"path": None if path is None else str(path), "commits": [[one.id, one.day, one.tree] for one in commits]}
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:  # noqa: S603 - ourselves
        if process.stdin and process.stdout:
            process.stdin.write(json.dumps(asked).encode())
            process.stdin.close()
            for line in process.stdout:
                one = read(json.loads(line))
                into.append(one)
                told(one)


def main() -> None:
    """Run as a worker: read what to count from standard input, write a line of JSON for each commit."""
    # The process lives for one batch only.
    gc.disable()
    asked = json.loads(sys.stdin.buffer.read())
    path = None if asked["path"] is None else Path(asked["path"])
    for one in _points(path, [Commit(*words) for words in asked["commits"]]):
        sys.stdout.write(json.dumps(plain(one)) + "\n")
        sys.stdout.flush()
