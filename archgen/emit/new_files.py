"""Write new files, all of them or none. Nothing that exists is ever replaced."""

from __future__ import annotations

import errno
import os
import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path

from archgen.emit.file_tree import OutputError


def write_new_files(files: Mapping[Path, bytes], top: Path) -> None:
    """Write files below a folder, which may be new itself. An error, or Ctrl-C, leaves nothing behind.

    Raise OutputError where a file exists already, or a link leads out of the folder.
    """
    created_paths: list[Path] = []
    try:
        _create_folder(top, created_paths)
        staging_folder = Path(tempfile.mkdtemp(prefix=".archgen-", dir=top))
        try:
            for number, (path, data) in enumerate(files.items()):
                (staging_folder / str(number)).write_bytes(data)
                _create_folder(path.parent, created_paths)
                # After the parent exists, so that a link anywhere in the path is seen; before the file is placed.
                _refuse_outside(path.parent, top)
                _place_file(staging_folder / str(number), path)
                created_paths.append(path)
        finally:
            shutil.rmtree(staging_folder, ignore_errors=True)
    except OSError as error:
        _undo_creation(created_paths)
        msg = f"cannot write {error.filename2 or error.filename or top}: {error.strerror or error}"
        raise OutputError(msg, "nothing was written") from error
    # Ctrl-C (KeyboardInterrupt) is no Exception, and must leave nothing behind either.
    except BaseException:
        _undo_creation(created_paths)
        raise


def _create_folder(folder: Path, created_paths: list[Path]) -> None:
    """Create a folder with its missing parents, and append the new ones to `created_paths`."""
    missing = [missing_folder for missing_folder in (folder, *folder.parents) if not missing_folder.is_dir()]
    for missing_folder in reversed(missing):
        missing_folder.mkdir()
        created_paths.append(missing_folder)


def _refuse_outside(folder: Path, top: Path) -> None:
    if not Path(os.path.realpath(folder)).is_relative_to(os.path.realpath(top)):
        msg = f"{folder} is a link that leads out of {top}"
        raise OutputError(msg, "nothing was written")


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
