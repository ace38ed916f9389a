"""Decide for each file of a workspace what is done with it, before anything is changed. Nothing here writes."""

from __future__ import annotations

import hashlib
import re
from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from archgen.emit.workspace.disk_files import DiskFile, DiskReader, GeneratedFile, fold_file_path
from archgen.emit.workspace.run_record import RecordedFile, RunRecord

FileVerb = Literal["new", "changed", "same", "removed", "yours", "left", "edited", "foreign", "blocked"]
"""What is done with a file. The last three are not done: it stays as it is, and the run says why.

`yours` are the user's own files, `left` are those that are no longer made, but were edited: they are the user's from now on.
"""
CONFLICTS: frozenset[FileVerb] = frozenset({"edited", "foreign", "blocked"})


@dataclass(frozen=True, slots=True)
class FileStep:
    """What is done with one file. `note` says more: what is in the way, or which words a file of the user's lacks."""

    path: str
    verb: FileVerb
    note: str = ""


@dataclass(frozen=True, slots=True)
class UserChoices:
    """What the user decided about single files, by path: take the new one, or keep his own for good."""

    overwritten: Collection[str] = ()
    kept: Collection[str] = ()
    removes_unmade: bool = True
    """Whether what is no longer made goes: not in spite of errors, since it may only be missing because of one."""


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
    """What is true afterwards."""

    def count(self, verb: FileVerb) -> int:
        """Return how many files something is done with."""
        return sum(step.verb == verb for step in self.steps)

    @property
    def conflicts(self) -> tuple[FileStep, ...]:
        """The files that should have been written, and were not."""
        return tuple(step for step in self.steps if step.verb in CONFLICTS)


def plan_workspace(
    record: RunRecord, run: str, files: Iterable[GeneratedFile], disk: DiskReader, choices: UserChoices
) -> WorkspacePlan:
    """Plan what a run of a backend does. `run` names the part that was asked for; the paths of `files` are sound."""
    planner = _Planner(record, run, disk, choices)
    wanted_files = {file.path: file for file in files}
    # First what goes: a folder may take the place of a file, and a file that of a folder.
    for path, entry in record.files.items():
        if path not in wanted_files and choices.removes_unmade:
            planner.plan_unwanted(path, entry)
        elif path not in wanted_files:
            planner.entries[path] = entry
    for file in wanted_files.values():
        planner.plan_wanted(file)
    return planner.finish()


@dataclass
class _Planner:
    """Collects the parts of a plan."""

    old_record: RunRecord
    run: str
    disk: DiskReader
    choices: UserChoices
    steps: list[FileStep] = field(default_factory=list)
    writes: dict[str, GeneratedFile] = field(default_factory=dict)
    modes: dict[str, int] = field(default_factory=dict)
    removals: list[str] = field(default_factory=list)
    vanished: list[str] = field(default_factory=list)
    entries: dict[str, RecordedFile] = field(default_factory=dict)
    known_digests: dict[str, set[str]] = field(default_factory=lambda: defaultdict(set))

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
        if on_disk.exists and entry.is_own:
            self.steps.append(FileStep(path, "yours", "nothing that is generated needs it any more"))
        elif on_disk.exists and path in self.choices.kept:
            self.steps.append(FileStep(path, "left", "it is no longer made, and kept: it is yours now"))
        elif on_disk.digest in entry.digests:
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
            words = _find_missing_words(file, self.disk.read_data(file.path)) if file.expected_words else ()
            self._keep_own(file, entry, digest, f"it lacks {', '.join(words)}" if words else "")
        elif file.path in self.choices.kept and not (entry and file.path in self.choices.overwritten):
            self._keep_own(file, entry, digest, "")
        elif on_disk.digest == digest:
            self._keep_same(file, entry, digest, on_disk)
        elif on_disk.digest in self.known_digests[fold_file_path(file.path)] or (
            entry and file.path in self.choices.overwritten
        ):
            self._write(file, entry, digest, on_disk, "changed")
        else:
            self._keep(file, entry, "edited" if entry else "foreign")

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
        self.entries[file.path] = self._record(file, entry, digest)
        self.steps.append(FileStep(file.path, verb))

    def _keep_same(self, file: GeneratedFile, entry: RecordedFile | None, digest: str, on_disk: DiskFile) -> None:
        mode = _choose_mode(file, entry, on_disk)
        if mode != on_disk.mode:
            self.modes[file.path] = mode
        self.entries[file.path] = self._record(file, entry, digest)
        self.steps.append(FileStep(file.path, "changed" if mode != on_disk.mode else "same"))

    def _keep_own(self, file: GeneratedFile, entry: RecordedFile | None, digest: str, note: str) -> None:
        own = self._record(file, entry, digest)
        if entry:
            own = replace(own, digests=entry.digests)
        self.entries[file.path] = replace(own, once=file.once, kept=not file.once)
        self.steps.append(FileStep(file.path, "yours", note))

    def _keep(self, file: GeneratedFile, entry: RecordedFile | None, verb: FileVerb, note: str = "") -> None:
        if entry:
            self.entries[file.path] = replace(entry, runs=entry.runs | {self.run})
        self.steps.append(FileStep(file.path, verb, note))

    def _record(self, file: GeneratedFile, entry: RecordedFile | None, digest: str) -> RecordedFile:
        runs = (entry.runs if entry else frozenset[str]()) | {self.run}
        return RecordedFile(frozenset({digest}), runs, file.executable, file.once)

    def finish(self) -> WorkspacePlan:
        """Return the plan."""
        old_files = self.old_record.files
        intended_files = dict(self.entries)
        for path in self.writes:
            if path in old_files:
                both_digests = self.entries[path].digests | old_files[path].digests
                intended_files[path] = replace(self.entries[path], digests=both_digests)
        intended_files |= {path: old_files[path] for path in self.removals}
        return WorkspacePlan(
            tuple(sorted(self.steps, key=lambda step: step.path)),
            self.writes,
            self.modes,
            tuple(self.removals),
            tuple(self.vanished),
            RunRecord(self.old_record.backend, intended_files),
            RunRecord(self.old_record.backend, self.entries),
        )


def _choose_mode(file: GeneratedFile, entry: RecordedFile | None, on_disk: DiskFile) -> int:
    """Return the permissions of a file that is there already: its own, but for running it."""
    if file.executable:
        return on_disk.mode | (on_disk.mode & 0o444) >> 2
    # What the user made executable himself stays so.
    return on_disk.mode & ~0o111 if entry and entry.executable else on_disk.mode


def _find_missing_words(file: GeneratedFile, data: bytes) -> tuple[str, ...]:
    """Return the words that a file of the user's should hold, and does not."""
    text = data.decode("utf-8", "replace")
    found_words = set(re.findall(r"\w+", text))
    return tuple(word for word in file.expected_words if word not in found_words and not _holds_phrase(text, word))


def _holds_phrase(text: str, phrase: str) -> bool:
    """Whether a text holds words with what stands between them: `arm.move`."""
    return not phrase.isidentifier() and re.search(rf"(?<!\w){re.escape(phrase)}(?!\w)", text) is not None
