"""Carry out the plan for a workspace so that a run that is cut off anywhere leaves each file old or new.

First all new files are written beside the others, below `.archgen/`: a full disk shows there. Then the record says of each
file both digests, and only then files are removed and moved in. Whatever a run that was killed has not done, the next one
does: it knows all of these files.
"""

from __future__ import annotations

import contextlib
import os
import shutil
from collections.abc import Iterable, Iterator
from pathlib import Path

from archgen.emit.file_tree import OutputError, lock_folder
from archgen.emit.workspace.run_record import (
    RECORD_FOLDER,
    RunRecord,
    write_git_attributes,
    write_run_record,
)
from archgen.emit.workspace.workspace_plan import WorkspacePlan
from archgen.regular_files import holds_bytes


@contextlib.contextmanager
def lock_workspace(workspace: Path) -> Iterator[None]:
    """Keep other runs of archgen out of a workspace. Raise OutputError where one is at work."""
    folder = workspace / RECORD_FOLDER
    if folder.is_symlink():
        raise OutputError(f"{folder} is a link", "take the link away: archgen writes there what it made")
    try:
        with lock_folder(folder):
            yield
    finally:
        # Of a workspace that has no file any more.
        with contextlib.suppress(OSError):
            folder.rmdir()


def carry_out(plan: WorkspacePlan, workspace: Path) -> None:
    """Change a workspace as planned, under the lock of `lock_workspace`. Raise OSError where the system refuses.

    What has its bytes already is not touched.
    """
    staging = workspace / RECORD_FOLDER / f"{plan.record.backend}.new"
    # One that a killed run left behind.
    shutil.rmtree(staging, ignore_errors=True)
    _refuse_closed_folders(plan, workspace)
    try:
        if plan.writes or plan.removals or plan.modes:
            _stage_files(plan, staging)
            _put_record(plan.intent, workspace, staging)
            _remove_files(plan.removals, workspace)
            _move_in(plan, workspace, staging)
        for path in plan.vanished:
            _prune_folders(workspace, path)
        is_new = not (workspace / RECORD_FOLDER / ".gitattributes").exists()
        if (_put_record(plan.record, workspace, staging) or is_new) and _is_in_repository(workspace):
            _put_attributes(workspace, staging)
    finally:
        shutil.rmtree(staging, ignore_errors=True)


def _stage_files(plan: WorkspacePlan, staging: Path) -> None:
    """Write the new files, each under a number: a path of theirs may be another one's folder."""
    staging.mkdir()
    for number, (path, file) in enumerate(plan.writes.items()):
        staged_file = staging / str(number)
        staged_file.write_bytes(file.data)
        mode = plan.modes.get(path)
        if mode is None and file.executable:
            own_mode = staged_file.stat().st_mode & 0o777
            mode = own_mode | (own_mode & 0o444) >> 2
        if mode is not None:
            staged_file.chmod(mode)


def _move_in(plan: WorkspacePlan, workspace: Path, staging: Path) -> None:
    for number, path in enumerate(plan.writes):
        (workspace / path).parent.mkdir(parents=True, exist_ok=True)
        _remove_empty_folders(workspace / path)
        os.replace(staging / str(number), workspace / path)  # noqa: PTH105 - says what it does on every system
    for path, mode in plan.modes.items():
        if path not in plan.writes:
            (workspace / path).chmod(mode)


def _remove_empty_folders(path: Path) -> None:
    """Remove a folder that stands where a file goes: the plan found no file in it, and one with a file does not go."""
    if path.is_dir() and not path.is_symlink():
        for folder, _, _ in os.walk(path, topdown=False):
            Path(folder).rmdir()


def _remove_files(paths: Iterable[str], workspace: Path) -> None:
    for path in paths:
        (workspace / path).unlink(missing_ok=True)
        _prune_folders(workspace, path)


def _prune_folders(workspace: Path, path: str) -> None:
    """Remove the folders that are empty without a file."""
    for parent in list((workspace / path).parents)[: path.count("/")]:
        # Not empty, gone, or a link that somebody put there: it stays.
        with contextlib.suppress(OSError):
            parent.rmdir()


def _put_record(record: RunRecord, workspace: Path, staging: Path) -> bool:
    """Replace the record, unless it says the same already. A backend that has no file here has no record.

    Return whether there was something to do.
    """
    path = workspace / RECORD_FOLDER / f"{record.backend}.json"
    if not record.files:
        path.unlink(missing_ok=True)
        return True
    return not record.is_on_disk and _replace(path, write_run_record(record), staging)


def _put_attributes(workspace: Path, staging: Path) -> None:
    """Tell git how to merge what is generated, and the records of it."""
    own_file, file = workspace / RECORD_FOLDER / ".gitattributes", workspace / ".gitattributes"
    old_text = file.read_text("utf-8", "surrogateescape") if file.is_file() else ""
    text = "" if file.is_symlink() else write_git_attributes(workspace, old_text)
    if text and text != old_text:
        _replace(file, text.encode("utf-8", "surrogateescape"), staging)
    elif old_text and not text and not file.is_symlink():
        file.unlink()
    if any(own_file.parent.glob("*.json")):
        _replace(own_file, b"*.json merge=union eol=lf linguist-generated\n", staging)
    else:
        own_file.unlink(missing_ok=True)


def _is_in_repository(workspace: Path) -> bool:
    resolved = workspace.resolve()
    return any(os.path.lexists(folder / ".git") for folder in (resolved, *resolved.parents))


def _replace(path: Path, data: bytes, staging: Path) -> bool:
    if holds_bytes(path, data):
        return False
    staging.mkdir(exist_ok=True)
    (staging / "record").write_bytes(data)
    os.replace(staging / "record", path)  # noqa: PTH105
    return True


def _refuse_closed_folders(plan: WorkspacePlan, workspace: Path) -> None:
    """Raise OutputError before anything is changed where files are to be written in a folder that may not be."""
    checked_folders = set[Path]()
    for path in (*plan.writes, *plan.removals):
        folder = (workspace / path).parent
        while not folder.exists() and folder != workspace:
            folder = folder.parent
        if folder not in checked_folders and folder.is_dir() and not os.access(folder, os.W_OK | os.X_OK):
            msg = f"the folder {folder} may not be written"
            raise OutputError(msg, "nothing was changed; allow it, or give another folder with `-o`")
        checked_folders.add(folder)
