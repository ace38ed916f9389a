"""Count commits in this process, or in one process for each core if there are many; each caches the slices it has
parsed.

What a project says at a commit, without places and comments: commits that say the same count the same.

A digest of the files, not the comparison's normal form: it decides which commits need no reading and checking at all,
so it must be had before there is an architecture. It may only err towards "changed", which costs one more check.
"""

from __future__ import annotations

import gc
import itertools
import json
import os
import subprocess
import sys
import threading
from collections.abc import Callable, Hashable, Iterator, Sequence
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path

from archgen import pipeline, project
from archgen.cache.file_store import digest_text
from archgen.frozen import replace
from archgen.history.history_points import count_point, point_from_data
from archgen.history.project_commits import ProjectCommit
from archgen.model.project_history import HistoryPoint
from archgen.pipeline import VersionCache
from archgen.project import LoadedProject
from archgen.resources import worker_environment
from archgen.syntax.committed_files import CommittedFiles
from archgen.syntax.yaml_tree import MappingNode, SequenceNode, YamlDocument, YamlNode

WorkerProgress = Callable[[int, int], None]
_COMMITS_PER_PROCESS = 8
"""So many commits are counted sooner than another process starts."""
# The names in this string are this module's own path and function: a rename must change them as well.
_START = "import sys; sys.path.append({root!r}); from archgen.history.workers import main; main()"


def count_commits(
    path: Path | None, commits: Sequence[ProjectCommit], progress: WorkerProgress | None = None
) -> tuple[HistoryPoint, ...]:
    """Count a project at commits, in their order."""
    processes = min(os.cpu_count() or 1, 1 + len(commits) // _COMMITS_PER_PROCESS)
    done_numbers = itertools.count(1)
    progress_lock = threading.Lock()

    def report_point(_: HistoryPoint) -> None:
        # Points arrive in several threads: the lock keeps the numbers in order, and whoever prints them undisturbed.
        with progress_lock:
            done_number = next(done_numbers)
            if progress:
                progress(done_number, len(commits))

    if processes < 2:  # noqa: PLR2004 - this one
        return tuple(_count_here(path, commits, report_point))
    batch_size = -(-len(commits) // processes)
    batches = [commits[start : start + batch_size] for start in range(0, len(commits), batch_size)]
    results: list[list[HistoryPoint]] = [[] for _ in batches]
    # Threads only wait for the processes' output; this thread counts the first batch itself.
    threads = [
        threading.Thread(target=_count_elsewhere, args=(path, batch, batch_points, report_point))
        for batch, batch_points in zip(batches[1:], results[1:], strict=True)
    ]
    for thread in threads:
        thread.start()
    results[0] = _count_here(path, batches[0], report_point)
    for thread in threads:
        thread.join()
    for batch, batch_points in zip(
        batches, results, strict=True
    ):  # a process that was killed: what it left is counted here
        batch_points.extend(_count_here(path, batch[len(batch_points) :], report_point))
    return tuple(counted_point for batch_points in results for counted_point in batch_points)


def _count_here(
    path: Path | None, commits: Sequence[ProjectCommit], report_point: Callable[[HistoryPoint], None]
) -> list[HistoryPoint]:
    batch_points = []
    for counted_point in _yield_points(path, commits):
        batch_points.append(counted_point)
        report_point(counted_point)
    return batch_points


def _yield_points(path: Path | None, commits: Sequence[ProjectCommit]) -> Iterator[HistoryPoint]:
    tracked_project, version_cache, contents = project.find_tracked_project(path), VersionCache(), CommitContents()
    counted: dict[Hashable, HistoryPoint] = {}
    for commit in commits:
        loaded_project = project.load_at_commit(tracked_project, commit.id, version_cache.parsed_slices)
        content = contents.content_key(loaded_project)
        content_point = counted.get(content)
        if content_point is None:
            content_point = counted[content] = count_point(
                pipeline.check_loaded_project(loaded_project, version_cache), commit.id, commit.day
            )
        yield replace(content_point, commit=commit.id, day=commit.day)


def _count_elsewhere(
    path: Path | None,
    commits: Sequence[ProjectCommit],
    batch_points: list[HistoryPoint],
    report_point: Callable[[HistoryPoint], None],
) -> None:
    """Count commits in another process; `batch_points` holds whatever it delivered, even if it was killed."""
    # The folder that holds the package `archgen`: two levels above this file's own.
    root = str(Path(__file__).resolve().parents[2])
    command = (sys.executable, "-P", "-c", _START.format(root=root))
    request = {
        "path": None if path is None else str(path),
        "commits": [[item.id, item.day, item.tree_id] for item in commits],
    }
    # Programs are looked for along PATH, git among them; the others say where the user's settings for git are, which say
    # which repositories are safe.
    environment = worker_environment("PATH", "HOME", "USERPROFILE", "XDG_CONFIG_HOME")
    with subprocess.Popen(  # noqa: S603 - ourselves
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment
    ) as process:
        if process.stdin and process.stdout:
            # One that died before it read anything: what it did not count is counted here.
            with suppress(BrokenPipeError):
                process.stdin.write(json.dumps(request).encode())
            with suppress(BrokenPipeError):
                process.stdin.close()
            for line in process.stdout:
                try:
                    item = point_from_data(json.loads(line))
                except (ValueError, KeyError, TypeError, AttributeError):
                    # A process that died in the middle of a line: whatever is missing is counted here afterwards.
                    process.kill()
                    break
                batch_points.append(item)
                report_point(item)


def main() -> None:
    """Run as a worker: read what to count from standard input, write a line of JSON for each commit."""
    # The process lives for one batch only.
    gc.disable()
    request = json.loads(sys.stdin.buffer.read())
    path = None if request["path"] is None else Path(request["path"])
    for counted_point in _yield_points(path, [ProjectCommit(*fields) for fields in request["commits"]]):
        sys.stdout.write(json.dumps(asdict(counted_point)) + "\n")
        sys.stdout.flush()


class CommitContents:
    """Compares what commits say; a document that several of them share is digested once."""

    def __init__(self) -> None:
        """Start without any digest."""
        self._digests: dict[int, tuple[YamlDocument, str]] = {}

    def content_key(self, loaded_project: LoadedProject) -> Hashable:
        """Return a key for everything that a project says. Files that are not YAML count by their bytes."""
        documents = {document.file: self._digest(document, loaded_project) for document in loaded_project.documents}
        blobs = loaded_project.files.blobs if isinstance(loaded_project.files, CommittedFiles) else {}
        other_files = tuple((path, blob.object_id) for path, blob in blobs.items() if path not in documents)
        libraries = tuple(
            (library.id, self._digest(document, loaded_project))
            for library in loaded_project.libraries
            # What ships follows from the path and the distribution, which the project's own documents say.
            if not library.is_shipped
            for document in library.documents
        )
        messages = tuple((diagnostic.rule, diagnostic.message) for diagnostic in loaded_project.diagnostics)
        return (tuple(documents.items()), libraries, other_files, messages)

    def _digest(self, document: YamlDocument, loaded_project: LoadedProject) -> str:
        """Return a document's digest. Where a comment silences findings, lines matter: then the whole text counts."""
        cached = self._digests.get(id(document))
        if cached is None:
            text = (
                loaded_project.sources.text_of(document.file)
                if document.ignores
                else repr(_plain_content(document.root))
            )
            digest = digest_text(text or "")
            # The document is kept in the entry: its id() could be used again once it is collected.
            cached = self._digests[id(document)] = (document, digest)
        return cached[1]


def _plain_content(value: YamlNode) -> object:
    """Return a value without spans and comments."""
    if isinstance(value, MappingNode):
        return [(entry.key, _plain_content(entry.value)) for entry in value]
    if isinstance(value, SequenceNode):
        return [_plain_content(item) for item in value.items]
    return (value.text, value.value)
