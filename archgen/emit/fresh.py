"""Write new files, all of them or none. Nothing that exists is ever replaced."""

from __future__ import annotations

import errno
import os
import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path

from archgen.emit.tree import OutputError


def write_new(files: Mapping[Path, bytes], top: Path) -> None:
    """Write files below a folder, which may be new itself. An error, or Ctrl-C, leaves nothing behind.

    Raise OutputError where a file exists already, or a link leads out of the folder.
    """
    made: list[Path] = []
    try:
        _folder(top, made)
        staged = Path(tempfile.mkdtemp(prefix=".archgen-", dir=top))
        try:
            for number, (path, data) in enumerate(files.items()):
                (staged / str(number)).write_bytes(data)
                _folder(path.parent, made)
                # After the parent exists, so that a link anywhere in the path is seen; before the file is placed.
                _see_inside(path.parent, top)
                _place(staged / str(number), path)
                made.append(path)
        finally:
            shutil.rmtree(staged, ignore_errors=True)
    except OSError as error:
        _undo(made)
        msg = f"cannot write {error.filename2 or error.filename or top}: {error.strerror or error}"
        raise OutputError(msg, "nothing was written") from error
    # Ctrl-C (KeyboardInterrupt) is no Exception, and must leave nothing behind either.
    except BaseException:
        _undo(made)
        raise


def _folder(folder: Path, made: list[Path]) -> None:
    """Create a folder with its missing parents, and append the new ones to `created_paths`."""
    missing = [above for above in (folder, *folder.parents) if not above.is_dir()]
    for above in reversed(missing):
        above.mkdir()
        made.append(above)


def _see_inside(folder: Path, top: Path) -> None:
    if not Path(os.path.realpath(folder)).is_relative_to(os.path.realpath(top)):
        msg = f"{folder} is a link that leads out of {top}"
        raise OutputError(msg, "nothing was written")


def _place(staged: Path, path: Path) -> None:
    """Move a file to its place unless something is there.

    A hard link fails where the path exists, so there is no moment between test and move.
    """
    try:
        os.link(staged, path)
    except FileExistsError:
        raise
    # The gap between this test and the move cannot be closed here: `rename` replaces silently on POSIX.
    except OSError:  # a file system without hard links
        if os.path.lexists(path):
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(path)) from None
        staged.rename(path)


def _undo(made: list[Path]) -> None:
    # In reverse: files before their folders, inner folders before outer ones.
    for path in reversed(made):
        if path.is_dir() and not path.is_symlink():
            _leave(path)
        else:
            path.unlink(missing_ok=True)


def _leave(folder: Path) -> None:
    """Remove a folder that this run created, unless somebody has put something into it since."""
    if not any(folder.iterdir()):
        folder.rmdir()
