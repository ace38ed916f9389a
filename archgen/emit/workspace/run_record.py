"""What a backend wrote into a workspace: `.archgen/BACKEND.json`, a file's digests, and the runs that made it.

A run is a project with the part of it that was asked for (`--select`, `--host`). A file belongs to all runs that made it: it is
removed when none of them makes it any more, so that partners who generate their parts alone do not disturb each other. A run
for everything stands for all of its parts.
"""

from __future__ import annotations

import base64
import contextlib
import hashlib
import json
import os
import re
from collections.abc import Mapping
from pathlib import Path, PurePosixPath
from typing import Any

from archgen.conformance.seen_record import RECORD_FILE
from archgen.emit.file_tree import OutputError
from archgen.emit.workspace.disk_files import explain_bad_path, fold_file_path
from archgen.frozen import dataclass, field, replace

RECORD_FOLDER = ".archgen"
_FORMAT = 1
_MAX_RECORD_BYTES = 64_000_000
_HEAD_KEYS = ("archgen", "about")
_FRAME_LINES = frozenset({"", "{", "}", '"files": {', "}}"})
_FRAME_COUNT = 6
"""The lines of a record that has no files."""
_MARKERS = ("<<<<<<<", "=======", ">>>>>>>", "|||||||")
_MARKERS_IN_BYTES = tuple(each.encode() for each in _MARKERS)
_LINE_BYTES = 3
_LINE_LETTERS = 4
"""So many letters write so many bytes."""
_PLAIN_PATH = re.compile(r"[A-Za-z0-9_./+@-]+\Z")
"""A path that means itself among git's patterns."""
_ATTRIBUTES_BEGIN = "# archgen: git merges these files without a conflict, and `archgen generate` makes them anew"
_ATTRIBUTES_END = "# archgen: end"
_HEADER = "archgen wrote these files. It replaces and removes them as long as nobody edits them, and touches no others."


@dataclass(frozen=True, slots=True)
class RecordedFile:
    """A file that was written: its possible digests (two while a run is under way), and the runs that made it."""

    digests: frozenset[str]
    runs: frozenset[str]
    executable: bool = False
    once: bool = False
    """Whether it is the user's own from the start."""
    kept: bool = False
    """Whether the user took it over with `--keep`."""
    meanings: Mapping[str, str] = field(default_factory=dict)
    """What the names mean that the user's own file defines and uses, when that was last held against the model."""
    lines: str = ""
    """Short digests of the lines that archgen wrote, joined: they tell a merge of two of its texts from what somebody wrote."""
    successor: str = ""
    """The empty file in place of one that nothing needs any more, until somebody writes into it."""

    @property
    def is_own(self) -> bool:
        """Whether it is the user's, so that archgen never touches it."""
        return self.once or self.kept


@dataclass(frozen=True, slots=True)
class RunRecord:
    """What one backend wrote into a workspace, by path."""

    backend: str
    files: Mapping[str, RecordedFile] = field(default_factory=dict)
    is_on_disk: bool = False
    """Whether the workspace has just this record, laid out as archgen does."""


def read_run_record(workspace: Path, backend: str) -> RunRecord:
    """Read what a backend wrote into a workspace; empty where it never did. Raise OutputError where nobody can tell."""
    path = workspace / RECORD_FOLDER / f"{backend}.json"
    if not os.path.lexists(path):
        return RunRecord(backend)
    if path.is_symlink() or not path.is_file() or path.stat().st_size > _MAX_RECORD_BYTES:
        raise _explain_bad_record(path, "it is no plain file")
    files: dict[str, RecordedFile] = {}
    try:
        entries, is_plain = _list_entries(path.read_text("utf-8"))
        if entries[0] != ("archgen", _FORMAT):
            raise _explain_bad_record(path, "another version of archgen wrote it")
        for name, entry in entries:
            if name not in _HEAD_KEYS or isinstance(entry, dict):
                file = _read_file(name, entry)
                files[name] = _join_entries(files[name], file) if name in files else file
    except (ValueError, LookupError, TypeError, AttributeError, RecursionError):
        raise _explain_bad_record(path, "it is damaged") from None
    return RunRecord(backend, files, is_plain)


def _list_entries(text: str) -> tuple[list[tuple[str, Any]], bool]:
    """Return what a record says, line by line, and whether it is laid out as archgen does.

    Where git merged two it says of some files what each side says.
    """
    entries: list[tuple[str, Any]] = []
    with contextlib.suppress(ValueError, LookupError, TypeError, AttributeError):
        data = json.loads(text)
        # As archgen writes it, each entry on a line: then no name stands there twice.
        if text.count("\n") == len(data["files"]) + _FRAME_COUNT:
            return [("archgen", data["archgen"]), *data["files"].items()], True
    try:
        for line in text.splitlines():
            if line.strip() not in _FRAME_LINES and not line.startswith(_MARKERS):
                entries += json.loads(f"{{{line.strip().removesuffix(',')}}}").items()
    except ValueError:  # somebody's tool laid it out anew
        data = json.loads(text)
        entries = [("archgen", data["archgen"]), *data["files"].items()]
    return sorted(entries, key=lambda each: each[0] not in _HEAD_KEYS), False


def _join_entries(first: RecordedFile, second: RecordedFile) -> RecordedFile:
    """Return what is known of a file that two branches wrote: either text, and the meanings on which both agree."""
    meanings = {name: each for name, each in first.meanings.items() if second.meanings.get(name, each) == each}
    return RecordedFile(
        first.digests | second.digests,
        first.runs | second.runs,
        first.executable or second.executable,
        first.once or second.once,
        first.kept or second.kept,
        {**{name: each for name, each in second.meanings.items() if name not in first.meanings}, **meanings},
        join_digests(split_digests(first.lines) | split_digests(second.lines)),
        first.successor or second.successor,
    )


def digest_lines(data: bytes) -> frozenset[str]:
    """Return short digests of the lines of a file; of what git puts between the sides of a conflict, none."""
    lines = {line.strip() for line in data.splitlines() if not line.startswith(_MARKERS_IN_BYTES)} - {b""}
    return frozenset(base64.b64encode(hashlib.sha256(line).digest()[:_LINE_BYTES]).decode() for line in lines)


def join_digests(digests: frozenset[str]) -> str:
    """Return digests of lines as a record has them."""
    return "".join(sorted(digests))


def split_digests(text: str) -> frozenset[str]:
    """Return the digests of lines that a record has."""
    return frozenset(text[i : i + _LINE_LETTERS] for i in range(0, len(text), _LINE_LETTERS))


def holds_conflict(data: bytes) -> bool:
    """Whether git's marks of a conflict stand in a file."""
    lines = data.splitlines()
    return any(line.startswith(b"<<<<<<< ") for line in lines) and any(line.startswith(b">>>>>>> ") for line in lines)


def find_former_project(record: RunRecord, project: str, wanted_paths: frozenset[str]) -> str:
    """Return another project whose own code this one would begin anew, in packages that are called after it; empty where there is none.

    Where own code of this project is recorded, both share the workspace.
    """
    found: set[str] = set()
    for path, file in record.files.items():
        projects = {run.partition(" ")[0] for run in file.runs} if file.is_own else set[str]()
        if project in projects:
            return ""
        found |= {each for each in projects if _rename_packages(path, each, project) in wanted_paths - {path}}
    return min(found, default="")


def _rename_packages(path: str, old_project: str, new_project: str) -> str:
    return re.sub(rf"(?<![^/]){re.escape(old_project)}(?=_)", new_project, path)


def take_over_runs(record: RunRecord, old_project: str, project: str) -> RunRecord:
    """Return a record in which what was made for a project under its former id was made for it under the present one."""
    old_run = re.compile(rf"{re.escape(old_project)}(?= |\Z)")
    files = {
        path: replace(
            file, runs=frozenset(old_run.sub(project, run, 1) if old_run.match(run) else run for run in file.runs)
        )
        for path, file in record.files.items()
    }
    return RunRecord(record.backend, files)


def read_other_records(workspace: Path, backend: str) -> Mapping[str, str]:
    """Return the folded paths that other backends made in a workspace, with the name of the backend."""
    return {
        fold_file_path(path): name
        for name in list_recorded_backends(workspace)
        if name != backend
        for path in read_run_record(workspace, name).files
    }


def read_other_own_files(workspace: Path, backend: str) -> Mapping[str, RecordedFile]:
    """Return the files of the user's own that other backends made in a workspace."""
    others = (read_run_record(workspace, name) for name in list_recorded_backends(workspace) if name != backend)
    return {path: file for record in others for path, file in record.files.items() if file.once}


def list_recorded_backends(workspace: Path) -> list[str]:
    """Return the backends that have a record in a workspace."""
    folder = workspace / RECORD_FOLDER
    records = folder.glob("*.json") if folder.is_dir() else ()
    # In a project's own folder, what was seen of its robots stands there, too.
    return sorted(path.stem for path in records if path.name != PurePosixPath(RECORD_FILE).name)


def write_git_attributes(workspace: Path, old_text: str) -> str:
    """Return a workspace's .gitattributes, by which git merges what is generated without a conflict, since a run makes it anew.

    What somebody wrote into it stays; without it the text is empty where nothing is generated.
    """
    paths = {
        path
        for name in list_recorded_backends(workspace)
        for path, file in read_run_record(workspace, name).files.items()
        if not file.is_own and _PLAIN_PATH.match(path)
    }
    attributes = [
        f"/{path} merge=union text=auto eol=lf linguist-generated" for path in sorted({*paths, ".gitattributes"})
    ]
    lines = [_ATTRIBUTES_BEGIN, *attributes, _ATTRIBUTES_END] if paths else []
    before, begin, rest = old_text.partition(f"{_ATTRIBUTES_BEGIN}\n")
    after = rest.partition(f"{_ATTRIBUTES_END}\n")[2] if begin else ""
    gap = "\n" if before and not before.endswith("\n") else ""
    return "".join((before, gap, *(f"{line}\n" for line in lines), after))


def write_run_record(record: RunRecord) -> bytes:
    """Return the bytes of a record: one line for each file, so that git merges the records of two branches."""
    lines = [f"  {json.dumps(path)}: {json.dumps(_write_file(file))}" for path, file in sorted(record.files.items())]
    head = f'{{\n "archgen": {_FORMAT},\n "about": {json.dumps(_HEADER)},\n "files": {{\n'
    return (head + ",\n".join(lines) + ("\n" if lines else "") + " }\n}\n").encode()


def _read_file(path: str, entry: Mapping[str, Any]) -> RecordedFile:
    digests, runs = entry["sha256"], entry["runs"]
    if isinstance(digests, str):
        digests = [digests]
    # A record can be edited: a path such as `../x` would let the next run remove files outside of the workspace.
    if explain_bad_path(path) or not all(isinstance(each, str) for each in (*digests, *runs)):
        raise ValueError
    state, names = entry.get("state"), entry.get("names", {})
    if not all(isinstance(each, str) for each in names.values()):
        raise ValueError
    return RecordedFile(
        frozenset(digests),
        frozenset(runs),
        entry.get("executable") is True,
        state == "once",
        state == "kept",
        names,
        str(entry.get("lines", "")),
        str(entry.get("becomes", "")),
    )


def _write_file(file: RecordedFile) -> dict[str, object]:
    digests = sorted(file.digests)
    entry: dict[str, object] = {"sha256": digests[0] if len(digests) == 1 else digests, "runs": sorted(file.runs)}
    if file.executable:
        entry["executable"] = True
    if file.is_own:
        entry["state"] = "once" if file.once else "kept"
    if file.lines:
        entry["lines"] = file.lines
    if file.successor:
        entry["becomes"] = file.successor
    if file.meanings:
        entry["names"] = dict(sorted(file.meanings.items()))
    return entry


def _explain_bad_record(path: Path, reason: str) -> OutputError:
    return OutputError(
        f"{path} does not say what archgen wrote: {reason}",
        "take it from the version control again, or remove it: files that are as archgen would write them are then known again",
    )
