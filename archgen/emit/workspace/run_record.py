"""What a backend wrote into a workspace: `.archgen/BACKEND.json`, a file's digests, and the runs that made it.

A run is a project with the part of it that was asked for (`--select`, `--host`). A file belongs to all runs that made it: it is
removed when none of them makes it any more, so that partners who generate their parts alone do not disturb each other. A run
for everything stands for all of its parts.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from archgen.emit.file_tree import OutputError
from archgen.emit.workspace.disk_files import explain_bad_path, fold_file_path
from archgen.frozen import dataclass, field

RECORD_FOLDER = ".archgen"
_FORMAT = 1
_MAX_RECORD_BYTES = 64_000_000
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

    @property
    def is_own(self) -> bool:
        """Whether it is the user's, so that archgen never touches it."""
        return self.once or self.kept


@dataclass(frozen=True, slots=True)
class RunRecord:
    """What one backend wrote into a workspace, by path."""

    backend: str
    files: Mapping[str, RecordedFile] = field(default_factory=dict)


def read_run_record(workspace: Path, backend: str) -> RunRecord:
    """Read what a backend wrote into a workspace; empty where it never did. Raise OutputError where nobody can tell."""
    path = workspace / RECORD_FOLDER / f"{backend}.json"
    if not os.path.lexists(path):
        return RunRecord(backend)
    if path.is_symlink() or not path.is_file() or path.stat().st_size > _MAX_RECORD_BYTES:
        raise _explain_bad_record(path, "it is no plain file")
    try:
        data = json.loads(path.read_bytes())
        if data["archgen"] != _FORMAT:
            raise _explain_bad_record(path, "another version of archgen wrote it")
        files = {str(name): _read_file(name, entry) for name, entry in data["files"].items()}
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        raise _explain_bad_record(path, "it is damaged") from None
    return RunRecord(backend, files)


def read_other_records(workspace: Path, backend: str) -> Mapping[str, str]:
    """Return the folded paths that other backends made in a workspace, with the name of the backend."""
    folder = workspace / RECORD_FOLDER
    names = sorted(path.stem for path in folder.glob("*.json")) if folder.is_dir() else []
    return {
        fold_file_path(path): name
        for name in names
        if name != backend
        for path in read_run_record(workspace, name).files
    }


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
    state = entry.get("state")
    return RecordedFile(
        frozenset(digests),
        frozenset(runs),
        entry.get("executable") is True,
        state == "once",
        state == "kept",
    )


def _write_file(file: RecordedFile) -> dict[str, object]:
    digests = sorted(file.digests)
    entry: dict[str, object] = {"sha256": digests[0] if len(digests) == 1 else digests, "runs": sorted(file.runs)}
    if file.executable:
        entry["executable"] = True
    if file.is_own:
        entry["state"] = "once" if file.once else "kept"
    return entry


def _explain_bad_record(path: Path, reason: str) -> OutputError:
    return OutputError(
        f"{path} does not say what archgen wrote: {reason}",
        "take it from the version control again, or remove it: files that are as archgen would write them are then known again",
    )
