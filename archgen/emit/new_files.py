"""Write new files, all of them or none. Nothing that exists is ever replaced."""

from __future__ import annotations

import errno
import os
from collections.abc import Mapping
from pathlib import Path

from archgen.emit.file_tree import OutputError, open_staging_folder
from archgen.regular_files import holds_bytes

MARKER = "archgen.yaml"
"""The file that makes a folder a project."""


def write_new_files(files: Mapping[Path, bytes], top: Path) -> None:
    """Write files below a folder, which may be new itself. An error, or Ctrl-C, leaves nothing behind.

    A new folder appears with all that is in it at once; what begins a project (`archgen.yaml`) comes last. So a run that
    is killed leaves no half project: the next one takes what is there and the same for its own, and goes on. Raise
    OutputError where a file exists already and is another, or a link leads out of the folder.
    """
    created_paths: list[Path] = []
    try:
        staging_parent = next(folder for folder in (top, *top.parents) if folder.is_dir())
        with open_staging_folder(staging_parent) as staging_folder:
            for number, (folder, members) in enumerate(_group_by_new_folder(files)):
                staged_top = staging_folder / str(number)
                if folder is None:
                    _place_loose_files(members, staged_top, top, created_paths)
                else:
                    _place_new_folder(folder, members, staged_top, top, created_paths)
    except OSError as error:
        _undo_creation(created_paths)
        msg = f"cannot write {error.filename2 or error.filename or top}: {error.strerror or error}"
        raise OutputError(msg, "nothing was written") from error
    # Ctrl-C (KeyboardInterrupt) is no Exception, and must leave nothing behind either.
    except BaseException:
        _undo_creation(created_paths)
        raise


def _group_by_new_folder(files: Mapping[Path, bytes]) -> list[tuple[Path | None, dict[Path, bytes]]]:
    """Group files by the outermost folder that is still missing (None: there is none); the project's file comes last."""
    groups: dict[Path | None, dict[Path, bytes]] = {}
    for path, data in sorted(files.items(), key=lambda item: item[0].name == MARKER):
        missing_folders = [folder for folder in path.parents if not os.path.lexists(folder)]
        groups.setdefault(missing_folders[-1] if missing_folders else None, {})[path] = data
    return sorted(groups.items(), key=lambda group: any(path.name == MARKER for path in group[1]))


def _place_loose_files(members: Mapping[Path, bytes], staged_file: Path, top: Path, created_paths: list[Path]) -> None:
    """Put files into folders that exist."""
    for path, data in members.items():
        refuse_outside(path.parent, top)
        if not path.is_symlink() and holds_bytes(path, data):
            continue  # left by a run that was killed
        staged_file.write_bytes(data)
        _place_file(staged_file, path)
        staged_file.unlink(missing_ok=True)
        created_paths.append(path)


def _place_new_folder(
    folder: Path, members: Mapping[Path, bytes], staged_top: Path, top: Path, created_paths: list[Path]
) -> None:
    """Make a folder with all its files aside, and move it to its place as a whole."""
    for path, data in members.items():
        staged_file = staged_top / path.relative_to(folder)
        staged_file.parent.mkdir(parents=True, exist_ok=True)
        staged_file.write_bytes(data)
    umask = os.umask(0)
    os.umask(umask)
    staged_top.chmod(0o777 & ~umask)
    refuse_outside(folder.parent, top if top.is_dir() else folder.parent)
    if os.path.lexists(folder):  # since it was looked for
        raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(folder))
    staged_top.rename(folder)
    created_paths.append(folder)
    created_paths += sorted(folder.rglob("*"))


def refuse_outside(folder: Path, top: Path) -> None:
    """Raise OutputError where a folder, which need not be there yet, is reached by a link that leads out of another one."""
    if not Path(os.path.realpath(folder)).is_relative_to(os.path.realpath(top)):
        raise OutputError(f"{folder} is a link that leads out of {top}", "nothing was written")


def _place_file(staged_file: Path, path: Path) -> None:
    """Move a file to its place unless something is there.

    A hard link fails where the path exists, so there is no moment between test and move.
    """
    try:
        os.link(staged_file, path)
    except FileExistsError:
        raise
    # The gap between this test and the move cannot be closed here: `rename` replaces silently on POSIX.
    except OSError:  # a file system without hard links
        if os.path.lexists(path):
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(path)) from None
        staged_file.rename(path)


def _undo_creation(created_paths: list[Path]) -> None:
    # In reverse: files before their folders, inner folders before outer ones.
    for path in reversed(created_paths):
        if path.is_dir() and not path.is_symlink():
            _remove_if_empty(path)
        else:
            path.unlink(missing_ok=True)


def _remove_if_empty(folder: Path) -> None:
    """Remove a folder that this run created, unless somebody has put something into it since."""
    if not any(folder.iterdir()):
        folder.rmdir()
