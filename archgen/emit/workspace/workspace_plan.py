"""Decide for each file of a workspace what is done with it, before anything is changed. Nothing here writes."""

from __future__ import annotations

import hashlib
import re
import sys
from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Literal

from archgen.cache.file_store import FileStore
from archgen.cache.program_stamp import stamp_program
from archgen.emit.workspace.disk_files import DiskFile, DiskReader, GeneratedFile, fold_file_path
from archgen.emit.workspace.own_code import CodeFinding, CodeReport, has_lost_names, judge_own_code, read_contract
from archgen.emit.workspace.run_record import (
    RecordedFile,
    RunRecord,
    digest_lines,
    holds_conflict,
    join_digests,
    split_digests,
)
from archgen.frozen import dataclass, field, replace


class KnownFits:
    """The digests of all that decides whether a file fits, of those that did in the last run and in this one."""

    def __init__(self, cache_folder: Path | None = None, workspace: Path = Path(), backend: str = "") -> None:
        """Take the user's cache; without it, nothing is known."""
        self._store = FileStore(cache_folder, ".fits", 48)
        words = (stamp_program(), sys.version, str(workspace.absolute()), backend) if cache_folder else ()
        self._key = hashlib.sha256("\n".join(words).encode("utf-8", "replace")).hexdigest()
        kept = self._store.load(self._key) or b""
        self._known = frozenset(kept.decode("ascii", "replace").split())
        self._found: set[str] = set()

    def is_known(self, digest: str) -> bool:
        """Whether what has this digest fitted. It is kept for the next run, too."""
        if digest in self._known:
            self._found.add(digest)
        return digest in self._known

    def add(self, digest: str) -> None:
        """Remember what was found to fit."""
        self._found.add(digest)

    def keep(self) -> None:
        """Keep what fitted in this run, where that is something else than before."""
        if self._found != self._known:
            self._store.store(self._key, "\n".join(sorted(self._found)).encode())


def digest_fit(file: GeneratedFile, content_digest: str, *recorded: Mapping[str, str]) -> str:
    """Return a digest of a file of the user's own, what is generated around it, and what its names meant before."""
    meanings = (word for each in recorded for word in ("", *map(str, sorted(each.items()))))
    words = (file.path, content_digest, *file.expected_words, "", *file.offered_words, *meanings)
    return hashlib.sha256("\n".join(words).encode("utf-8", "surrogatepass")).hexdigest()[:32]


FileVerb = Literal["new", "changed", "merged", "same", "removed", "yours", "left", "edited", "foreign", "blocked"]
"""What is done with a file. The last three are not done: it stays as it is, and the run says why.

`yours` are the user's own files, `left` are those that are no longer made, but were edited: they are the user's from now on.
"""
CONFLICTS: frozenset[FileVerb] = frozenset({"edited", "foreign", "blocked"})
_OUTLIVED = "nothing that is generated needs it any more"
STALE: frozenset[FileVerb] = frozenset({"new", "changed", "removed", "merged"})
"""What has to be done so that a workspace is as the architecture says."""


@dataclass(frozen=True, slots=True)
class FileStep:
    """What is done with one file. `note` says more, such as what is in the way."""

    path: str
    verb: FileVerb
    note: str = ""
    findings: tuple[CodeFinding, ...] = ()
    """What is wrong with a file of the user's own."""


@dataclass(frozen=True, slots=True)
class UserChoices:
    """What the user decided about single files, by path: take the new one, or keep his own for good."""

    overwritten: Collection[str] = ()
    kept: Collection[str] = ()
    removes_unmade: bool = True
    """Whether what is no longer made goes: not in spite of errors, since it may only be missing because of one."""
    only_clears: bool = False
    """Whether only that goes which archgen wrote and makes no more: another backend waits for its place."""
    fits: KnownFits = field(default_factory=KnownFits)
    """Which files of the user's own fitted before."""
    read_others: Callable[[], Mapping[str, RecordedFile]] = dict
    """Returns the files of the user's own that other backends made here: what is in another language now has one of them."""


@dataclass(frozen=True, slots=True)
class WorkspacePlan:
    """All that a run does in a workspace."""

    steps: tuple[FileStep, ...]
    """By path."""
    writes: Mapping[str, GeneratedFile]
    modes: Mapping[str, int]
    """The permissions of written files that replace others, and of files whose permissions alone change."""
    removals: tuple[str, ...]
    vanished: tuple[str, ...]
    """Paths that are no longer made, and were gone before: their folders may be empty now."""
    intent: RunRecord
    """What is true while files are being moved: of each the old digest and the new one are known."""
    record: RunRecord
    """What is true afterwards, and whether the workspace says so already."""

    def count(self, verb: FileVerb) -> int:
        """Return how many files something is done with."""
        return sum(step.verb == verb for step in self.steps)

    @property
    def conflicts(self) -> tuple[FileStep, ...]:
        """The files that should have been written, and were not."""
        return tuple(step for step in self.steps if step.verb in CONFLICTS)

    @property
    def has_orphans(self) -> bool:
        """Whether nothing needs code of the user's own any more, and nothing is known to take its place."""
        return any(step.verb == "yours" and step.note == _OUTLIVED for step in self.steps)

    @property
    def has_unfit_code(self) -> bool:
        """Whether code of the user's own does not fit what is generated."""
        return any(not finding.is_note for step in self.steps for finding in step.findings)


def plan_workspace(
    record: RunRecord,
    run: str,
    files: Iterable[GeneratedFile],
    disk: DiskReader,
    choices: UserChoices,
) -> WorkspacePlan:
    """Plan what a run of a backend does. `run` names the part that was asked for; the paths of `files` are sound."""
    wanted_files = {file.path: file for file in files}
    planner = _Planner(record, run, disk, choices, choices.fits, wanted_files)
    # First what goes: a folder may take the place of a file, and a file that of a folder.
    for path, entry in record.files.items():
        is_cleared = not choices.only_clears or disk.read(path).has_digest(entry.digests)
        if path not in wanted_files and choices.removes_unmade and is_cleared:
            planner.plan_unwanted(path, entry)
        elif path not in wanted_files or choices.only_clears:
            planner.entries[path] = entry
    for file in () if choices.only_clears else wanted_files.values():
        planner.plan_wanted(file)
    return planner.finish()


@dataclass()
class _Planner:
    """Collects the parts of a plan."""

    old_record: RunRecord
    run: str
    disk: DiskReader
    choices: UserChoices
    fits: KnownFits
    files_by_path: Mapping[str, GeneratedFile]
    steps: list[FileStep] = field(default_factory=list)
    writes: dict[str, GeneratedFile] = field(default_factory=dict)
    modes: dict[str, int] = field(default_factory=dict)
    removals: list[str] = field(default_factory=list)
    vanished: list[str] = field(default_factory=list)
    entries: dict[str, RecordedFile] = field(default_factory=dict)
    known_digests: dict[str, set[str]] = field(default_factory=lambda: defaultdict(set))
    _outlived: dict[str, RecordedFile] = field(default_factory=dict)
    """Files of the user's own that nothing needs any more."""

    def __post_init__(self) -> None:
        for path, entry in self.old_record.files.items():
            # By folded path: where case is ignored, `Node.py` is what stands at `node.py`.
            self.known_digests[fold_file_path(path)] |= set() if entry.is_own else entry.digests

    def plan_unwanted(self, path: str, entry: RecordedFile) -> None:
        """Plan what happens to a file that this run does not make."""
        # A run for everything makes what each part of it would make: `robot` and `robot --host arm_pc`.
        other_runs = frozenset(each for each in entry.runs - {self.run} if not each.startswith(f"{self.run} --"))
        if other_runs:
            self.entries[path] = replace(entry, runs=other_runs)
            return
        on_disk = self.disk.read(path)
        if on_disk.exists and entry.is_own and not (entry.once and on_disk.has_digest(entry.digests)):
            self._outlived[path] = entry
        elif on_disk.exists and path in self.choices.kept:
            self.steps.append(FileStep(path, "left", "it is no longer made, and kept: it is yours now"))
        elif on_disk.has_digest(entry.digests) or (on_disk.exists and self._is_merged(path, entry)):
            self.removals.append(path)
            self.steps.append(FileStep(path, "removed"))
        elif on_disk.exists:
            self.steps.append(FileStep(path, "left", "it is no longer made, but was changed by hand: it is yours now"))
        # With a link, a folder or the like in its place it is gone as well, and folders behind a link are not archgen's.
        elif not on_disk.obstacle:
            self.vanished.append(path)

    def plan_wanted(self, file: GeneratedFile) -> None:
        """Plan what happens at the path of a file that this run makes."""
        entry = self.old_record.files.get(file.path)
        on_disk = self._ignore_leaving(self.disk.read(file.path), file.path)
        digest = hashlib.sha256(file.data).hexdigest()
        if on_disk.obstacle:
            self._keep(file, entry, "blocked", f"`{on_disk.obstacle_path}` {on_disk.obstacle}")
        elif not on_disk.exists:
            self._write(file, entry, digest, on_disk, "new")
        elif self._is_users_own(file, entry):
            is_empty = entry is not None and on_disk.has_digest(entry.digests)
            self._keep_own(file, entry, digest, on_disk, is_empty=is_empty)
        elif file.path in self.choices.kept and not (entry and file.path in self.choices.overwritten):
            self._keep_own(file, entry, digest, on_disk)
        elif on_disk.has_digest({digest}):
            self._keep_same(file, entry, digest, on_disk)
        elif on_disk.has_digest(self.known_digests[fold_file_path(file.path)]) or (
            entry and file.path in self.choices.overwritten
        ):
            self._write(file, entry, digest, on_disk, "changed")
        elif entry and self._is_merged(file.path, entry, file.data):
            self._write(file, entry, digest, on_disk, "merged")
        else:
            self._keep(file, entry, "edited" if entry else "foreign")

    def _is_merged(self, path: str, entry: RecordedFile, new_data: bytes = b"") -> bool:
        """Whether git made a file of two that archgen wrote: each of its lines is of one of them, or of the new one.

        One branch may have written it under the name that it had before the other one renamed something.
        """
        data = self.disk.read_data(path)
        lines, own_lines = digest_lines(data), split_digests(entry.lines) | digest_lines(new_data)
        is_mixed = len(entry.digests) > 1 or holds_conflict(data) or bool((lines - own_lines) & self._leaving_lines)
        return is_mixed and lines <= own_lines | self._leaving_lines

    @cached_property
    def _files_by_name(self) -> Mapping[str, Sequence[GeneratedFile]]:
        """The files that are made, by the last part of their paths."""
        wanted_files: dict[str, list[GeneratedFile]] = defaultdict(list)
        for path, file in self.files_by_path.items():
            wanted_files[path.rpartition("/")[2]].append(file)
        return wanted_files

    @cached_property
    def _files_of_others(self) -> Mapping[str, RecordedFile]:
        return self.choices.read_others()

    @cached_property
    def _leaving_lines(self) -> frozenset[str]:
        """The lines of files that archgen wrote and makes no more, as short digests."""
        leaving = (each for path, each in self.old_record.files.items() if path not in self.files_by_path)
        return frozenset[str]().union(*(split_digests(each.lines) for each in leaving))

    def _is_users_own(self, file: GeneratedFile, entry: RecordedFile | None) -> bool:
        was_taken_over = entry is not None and entry.kept and file.path not in self.choices.overwritten
        return file.once or was_taken_over

    def _ignore_leaving(self, on_disk: DiskFile, path: str) -> DiskFile:
        """Return what stands at a path once the files are gone that this run removes."""
        leaving = set(self.removals) if on_disk.obstacle else set()
        if on_disk.obstacle == "is a file" and on_disk.obstacle_path in leaving:
            return DiskFile()
        if on_disk.obstacle == "is a folder" and leaving.issuperset(self.disk.list_below(path)):
            return DiskFile()
        return on_disk

    def _write(
        self, file: GeneratedFile, entry: RecordedFile | None, digest: str, on_disk: DiskFile, verb: FileVerb
    ) -> None:
        self.writes[file.path] = file
        if on_disk.exists:
            self.modes[file.path] = _choose_mode(file, entry, on_disk)
        report = _judge(file, file.data, {}) if file.once else CodeReport()
        if file.once and not report.findings and not has_lost_names(file.offered_words, {}):
            # Until somebody writes into it, the next run need not judge it again.
            self.fits.add(digest_fit(file, digest, {}, report.meanings))
        self.entries[file.path] = self._record(file, entry, digest, report.meanings)
        was_deleted = verb == "new" and file.once and entry is not None
        self.steps.append(
            FileStep(file.path, verb, "it was gone, and is written anew: an empty one" if was_deleted else "")
        )

    def _keep_same(self, file: GeneratedFile, entry: RecordedFile | None, digest: str, on_disk: DiskFile) -> None:
        mode = _choose_mode(file, entry, on_disk)
        if mode != on_disk.mode:
            self.modes[file.path] = mode
        self.entries[file.path] = self._record(file, entry, digest, entry.meanings if entry else {})
        self.steps.append(FileStep(file.path, "changed" if mode != on_disk.mode else "same"))

    def _keep_own(
        self, file: GeneratedFile, entry: RecordedFile | None, digest: str, on_disk: DiskFile, *, is_empty: bool = False
    ) -> None:
        report = CodeReport()
        if file.once:
            # What is empty was written for nothing.
            meanings = entry.meanings if entry and not is_empty else {}
            report = self._judge_own(file, on_disk.digest or "", meanings, entry.meanings if entry else {})
        self.entries[file.path] = self._record(file, entry, digest, report.meanings, is_own=True)
        findings = report.findings
        if is_empty and any(not each.is_note for each in findings):
            message = (
                f"is of an older model, and nobody wrote into it: take it away for a new one ({findings[0].message})"
            )
            findings = (CodeFinding(message, findings[0].line, findings[0].column),)
        self.steps.append(FileStep(file.path, "yours", findings=findings))

    def _judge_own(
        self, file: GeneratedFile, disk_digest: str, meanings: Mapping[str, str], last_meanings: Mapping[str, str]
    ) -> CodeReport:
        """Judge a file, unless it is known to fit, and to mean what it meant in the last run."""
        fit = digest_fit(file, disk_digest, meanings, last_meanings)
        if self.fits.is_known(fit):
            return CodeReport((), last_meanings)
        data = self.disk.read_data(file.path)
        report = _judge(file, data, meanings, self._list_helpers(file.path))
        if moved := tuple(find_moved_packages(file.path, data, self._files_by_name)):
            report = replace(report, findings=(*report.findings, *moved))
        if (
            not report.findings
            and report.meanings == last_meanings
            and not has_lost_names(file.offered_words, meanings)
        ):
            self.fits.add(fit)
        return report

    def _keep(self, file: GeneratedFile, entry: RecordedFile | None, verb: FileVerb, note: str = "") -> None:
        if entry:
            self.entries[file.path] = replace(entry, runs=entry.runs | {self.run})
        self.steps.append(FileStep(file.path, verb, note))

    def _record(
        self,
        file: GeneratedFile,
        entry: RecordedFile | None,
        digest: str,
        meanings: Mapping[str, str],
        *,
        is_own: bool = False,
    ) -> RecordedFile:
        runs = (entry.runs if entry else frozenset[str]()) | {self.run}
        is_as_before = entry is not None and bool(entry.lines) and entry.digests == {digest}
        lines = "" if file.once else entry.lines if entry and is_as_before else join_digests(digest_lines(file.data))
        digests = entry.digests if entry and is_own else frozenset({digest})
        return RecordedFile(digests, runs, file.executable, file.once, is_own and not file.once, meanings, lines)

    def _list_helpers(self, path: str) -> Iterator[tuple[str, bytes]]:
        """Yield the Python files of the user's beside one of his own, and below, with their bytes."""
        folder, _, name = path.rpartition("/")
        if folder and name.endswith(".py"):
            for each in self.disk.list_below(folder):
                is_others = each not in self.files_by_path and each not in self.old_record.files
                if is_others and each.endswith(".py") and self.disk.read(each).exists:
                    yield each, self.disk.read_data(each)

    def _find_successor(self, path: str, entry: RecordedFile) -> str:
        """Return the new file of the user's own that has most names in common with one, and its name; empty where none has any.

        It stays that one until somebody writes into it.
        """
        known = self.old_record.files.get(entry.successor)
        if known and entry.successor in self.files_by_path:
            return entry.successor if self.disk.read(entry.successor).has_digest(known.digests) else ""
        elements = _list_elements(entry)
        # In another language: another backend has made it, and for the same ports of the model.
        alike = {each: file for each, file in self._files_of_others.items() if elements & _list_elements(file)}
        if alike and all(self.disk.read(each).has_digest(file.digests) for each, file in alike.items()):
            return max(alike)
        own_ports = _list_ports(entry)
        likeness = {
            each: (len(_list_ports(self.entries[each]) & own_ports), each.rpartition("/")[2] == path.rpartition("/")[2])
            for each, file in self.writes.items()
            if file.once and each not in self.old_record.files
            if self.entries[each].meanings.keys() & entry.meanings.keys()
        }
        best = max(likeness, key=lambda each: (likeness[each], each), default="")
        return best if best and any(likeness[best]) else ""

    def _find_heir(self, entry: RecordedFile) -> str:
        """Return a file of the user's own that has ports of one now and had not before: its node is one with another now."""
        for path, heir in self.entries.items():
            old_heir = self.old_record.files.get(path)
            old_elements = _list_elements(old_heir) if old_heir else set()
            if heir.once and _list_elements(entry) & (_list_elements(heir) - old_elements):
                return path
        return ""

    def finish(self) -> WorkspacePlan:
        """Return the plan."""
        old_files = self.old_record.files
        for path, entry in self._outlived.items():
            successor = self._find_successor(path, entry)
            if successor:
                self.entries[path] = replace(entry, successor=successor)
                words = f"{_OUTLIVED}; it may become {successor}, which is empty: move what you wrote there, and take this file away"
                self.steps.append(FileStep(path, "yours", findings=(CodeFinding(words, 1, 1),)))
            else:
                heir = self._find_heir(entry)
                self.steps.append(
                    FileStep(path, "yours", f"{_OUTLIVED}: {heir} has its ports now" if heir else _OUTLIVED)
                )
        intended_files = dict(self.entries)
        for path in self.writes:
            if path in old_files:
                both_digests = self.entries[path].digests | old_files[path].digests
                both_lines = join_digests(
                    split_digests(self.entries[path].lines) | split_digests(old_files[path].lines)
                )
                intended_files[path] = replace(self.entries[path], digests=both_digests, lines=both_lines)
        intended_files |= {path: old_files[path] for path in self.removals}
        return WorkspacePlan(
            tuple(sorted(self.steps, key=lambda step: step.path)),
            self.writes,
            self.modes,
            tuple(self.removals),
            tuple(self.vanished),
            RunRecord(self.old_record.backend, intended_files),
            RunRecord(self.old_record.backend, self.entries, self.old_record.is_on_disk and self.entries == old_files),
        )


def _list_ports(entry: RecordedFile) -> set[str]:
    """Return the names of a file that stand for ports: many files have a timer, or know the fields of a message."""
    return {each for each in entry.meanings if not each.startswith((".", "'", "on_"))}


def _list_elements(entry: RecordedFile) -> set[tuple[str, str]]:
    """Return the ports of a file with what they stand for in the model."""
    return {(each, entry.meanings[each].lstrip("+").partition(":")[0]) for each in _list_ports(entry)}


def _choose_mode(file: GeneratedFile, entry: RecordedFile | None, on_disk: DiskFile) -> int:
    """Return the permissions of a file that is there already: its own, but for running it."""
    if file.executable:
        return on_disk.mode | (on_disk.mode & 0o444) >> 2
    # What the user made executable himself stays so.
    return on_disk.mode & ~0o111 if entry and entry.executable else on_disk.mode


def _judge(
    file: GeneratedFile, data: bytes, recorded: Mapping[str, str], helpers: Iterable[tuple[str, bytes]] = ()
) -> CodeReport:
    """Hold the user's own text of a file against what is generated around it."""
    if not (file.expected_words or file.offered_words):
        return CodeReport()
    return judge_own_code(file.path, data, read_contract(file.expected_words, file.offered_words), recorded, helpers)


_IMPORT = re.compile(r"^[ \t]*(?:from|import)[ \t]+(?P<package>\w+)\.(?P<name>\w+)", re.MULTILINE)
_INCLUDE = re.compile(r"^[ \t]*#[ \t]*include[ \t]+[\"<](?P<package>\w+)/(?P<name>[\w./]+)[\">]", re.MULTILINE)
_NAMESPACE = re.compile(r"^[ \t]*(?:inline[ \t]+)?namespace[ \t]+(?P<package>\w+)", re.MULTILINE)


def find_moved_packages(
    path: str, data: bytes, wanted_files: Mapping[str, Collection[GeneratedFile]]
) -> Iterator[CodeFinding]:
    """Yield where a file imports or includes what its package has under another name of the package, and such namespaces.

    `wanted_files` are those that are generated, by the last part of their paths.
    """
    text = data.decode("utf-8", "replace")
    is_python = path.endswith(".py")
    own_folder = "/".join(path.split("/")[:2])
    found_names: list[tuple[re.Match[str], str]] = []
    new_packages: dict[str, str] = {}
    for found in (_IMPORT if is_python else _INCLUDE).finditer(text):
        package, name = found["package"], f"{found['name']}.py" if is_python else found["name"]
        alike = [each for each in wanted_files.get(name.rpartition("/")[2], ()) if each.path.endswith(f"/{name}")]
        beside = [each for each in alike if each.path.startswith(f"{own_folder}/")]
        if len(beside) == 1 and not any(each.path.endswith(f"/{package}/{name}") for each in alike):
            new_package = beside[0].path.removesuffix(f"/{name}").rpartition("/")[2]
            found_names.append((found, new_package))
            # The module of a component called `clock` is no `rclpy.clock`: it alone says nothing of a package.
            if not (is_python and beside[0].once):
                new_packages[package] = new_package
    # As the patch finds it: a dotted word, or a text.
    frame = "{}.{}" if is_python else '"{}/{}"'
    for found, new_package in found_names:
        if found["package"] in new_packages:
            names = (frame.format(each, found["name"]) for each in (found["package"], new_package))
            yield _tell(text, found, f"`{found['package']}` has no `{found['name']}` any more", new_package, *names)
    for found in () if is_python else _NAMESPACE.finditer(text):
        if found["package"] in new_packages:
            new_package = new_packages[found["package"]]
            reason = "what is generated is in another namespace"
            yield _tell(text, found, reason, new_package, found["package"], new_package)


def _tell(  # noqa: PLR0913, PLR0917 - what a finding is made of
    text: str, found: re.Match[str], reason: str, new_package: str, old_name: str, new_name: str
) -> CodeFinding:
    start = found.start("package")
    line, column = text.count("\n", 0, start) + 1, start - text.rfind("\n", 0, start)
    return CodeFinding(f"{reason}: it is `{new_package}` now", line, column, old_name=old_name, new_name=new_name)
