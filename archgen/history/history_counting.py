"""Count size, progress and findings at every commit: cached counts are used, the rest is counted in several processes.

Commits that say the same, without places and comments, count the same. A digest of the files decides that, not the
comparison's normal form: it decides which commits need no reading and checking at all, so it must be had before there is an
architecture. It may only err towards "changed", which costs one more check.
"""

from __future__ import annotations

import gc
import itertools
import json
import os
import subprocess
import sys
import threading
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any

from archgen import pipeline, project
from archgen.analyses.size_counts import count_mapped_connections, measure_progress
from archgen.cache.file_store import FileStore, digest_text
from archgen.cache.program_stamp import stamp_program
from archgen.diagnostics import Diagnostic, Severity, count_by_severity
from archgen.frozen import replace
from archgen.history.project_commits import HistoryInterval, ProjectCommit, list_commits
from archgen.model.architecture import Architecture
from archgen.model.project_history import FindingCounts, History, HistoryPoint, ProgressRow
from archgen.pipeline import CheckedProject, VersionCache
from archgen.project import LoadedProject, find_tracked_project
from archgen.resources import worker_environment
from archgen.syntax.committed_files import CommittedFiles
from archgen.syntax.yaml_tree import MappingNode, SequenceNode, YamlDocument, YamlNode

_COUNTED_FIELDS = ("components", "described", "typed", "mapped", "timed", "traced")


def count_point(checked_project: CheckedProject, commit: str, day: str) -> HistoryPoint:
    """Count a project."""
    architecture = checked_project.architecture
    findings_of = _findings_by_scope(checked_project)
    return HistoryPoint(
        commit=commit,
        day=day,
        groups=len(architecture.groups),
        nodes=sum(node.written for node in architecture.nodes.values()),
        connections=len(architecture.connections),
        mapped_connections=count_mapped_connections(architecture),
        rows=tuple(
            ProgressRow(
                scope=progress_row.scope,
                id=progress_row.id,
                title=progress_row.title,
                **{name: getattr(progress_row, name) for name in _COUNTED_FIELDS},
                findings=_count_findings(
                    findings_of.get(
                        (progress_row.scope, "" if progress_row.scope == "project" else progress_row.id), ()
                    )
                ),
            )
            for progress_row in measure_progress(architecture)
        ),
    )


def point_from_data(data: Mapping[str, Any]) -> HistoryPoint:
    """Return a point from the plain data that `asdict` makes of it. Raise KeyError or TypeError for anything else."""
    rows = tuple(ProgressRow(**{**row, "findings": FindingCounts(**row["findings"])}) for row in data["rows"])
    return HistoryPoint(**{**data, "rows": rows})


def _count_findings(findings: Iterable[Diagnostic]) -> FindingCounts:
    counts = count_by_severity(findings)
    return FindingCounts(counts[Severity.ERROR], counts[Severity.WARNING], counts[Severity.NOTE])


def _findings_by_scope(checked_project: CheckedProject) -> dict[tuple[str, str], list[Diagnostic]]:
    """Return the findings by scope: each once for the whole, for its group, and for each partner who owns its element."""
    element_scopes = _find_scopes(checked_project.architecture)
    findings_of: dict[tuple[str, str], list[Diagnostic]] = {}
    for finding in checked_project.findings:
        findings_of.setdefault(("project", ""), []).append(finding)
        for scope in sorted(element_scopes.get(_known_element(finding.element, element_scopes), ())):
            findings_of.setdefault(scope, []).append(finding)
    return findings_of


_ElementScopes = Mapping[str, frozenset[tuple[str, str]]]


def _known_element(name: str | None, element_scopes: _ElementScopes) -> str:
    """Return the element that a finding is about, or the nearest element that it is a part of."""
    name = name or ""
    while name and name not in element_scopes:
        name = name.rpartition(".")[0]
    return name


def _find_scopes(architecture: Architecture) -> dict[str, frozenset[tuple[str, str]]]:
    """Return the groups and partners that each group, component and node belongs to."""
    scopes: dict[str, frozenset[tuple[str, str]]] = {}
    for group in architecture.groups.values():
        group_scope = {("group", group.id)}
        scopes[group.id] = frozenset(group_scope | {("partner", owner) for owner in group.owners})
        for component in group.components.values():
            # The partner "" collects the components that nobody owns.
            scopes[component.id] = frozenset(group_scope | {("partner", owner) for owner in component.owners or ("",)})
    for node in architecture.nodes.values():
        implemented_scopes = frozenset[tuple[str, str]]().union(
            *(scopes.get(name, frozenset()) for name in node.implements)
        )
        # A node without an owner belongs to those of the components that it implements.
        owner_scopes = {("partner", owner) for owner in node.owners} or {
            scope for scope in implemented_scopes if scope[0] == "partner"
        }
        scopes.setdefault(
            node.id, frozenset({scope for scope in implemented_scopes if scope[0] == "group"} | owner_scopes)
        )
    return scopes


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
    progress: WorkerProgress | None = None,
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
        counted = count_commits(path, tuple(missing.values()), progress)
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


WorkerProgress = Callable[[int, int], None]
_COMMITS_PER_PROCESS = 8
"""So many commits are counted sooner than another process starts."""
# The names in this string are this module's own path and function: a rename must change them as well.
_START = "import sys; sys.path.append({root!r}); from archgen.history.history_counting import main; main()"


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
