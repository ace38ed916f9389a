"""Write edited files of a project, all of them or none, so that the last time can be undone.

What was there before lies in the user's cache, since a project need not lie in a repository.
"""

from __future__ import annotations

import base64
import hashlib
import json
import os
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path

from archgen.cache.file_store import FileStore
from archgen.edit.element_edit import FileEdit
from archgen.emit import file_tree
from archgen.emit.file_tree import OutputError
from archgen.frozen import NamedTuple
from archgen.products.report_cache import cache_folder
from archgen.regular_files import holds_bytes

_MOST_PROJECTS = 20
"""Of so many projects the last edit can be undone."""


class UndoneEdit(NamedTuple):
    """What was undone, and the files that are as they were."""

    title: str
    files: tuple[str, ...]


def write_edits(root: Path, edits: Sequence[FileEdit], title: str) -> bool:
    """Write edited files, all or none; return whether `undo_last` can take that back.

    Raise OutputError where a file is not as it was read, or lies outside of the project.
    """
    with file_tree.lock_folder(root):
        contents = {edit.file: edit.new_content for edit in edits}
        olds = {edit.file: edit.old_content for edit in edits}
        _refuse_changed(root, olds)
        stored = {
            "root": str(root.resolve()),
            "title": title,
            "files": {
                file: [
                    None if old is None else base64.b64encode(old).decode(),
                    hashlib.sha256(contents[file]).hexdigest(),
                ]
                for file, old in olds.items()
            },
        }
        # First, so that a run that is killed half way can be undone.
        store, key = _store_of(root)
        store.store(key, json.dumps(stored).encode())
        _put_all(root, contents, olds)
        return store.load(key) is not None


def undo_last(root: Path) -> UndoneEdit:
    """Put the files of the last edit back as they were. Raise OutputError where one was touched since."""
    store, key = _store_of(root)
    data = store.load(key)
    if data is None:
        msg = "there is nothing to undo here"
        raise OutputError(msg, "`archgen rename`, `move` and `split` can be undone, each until the next one")
    stored = json.loads(data)
    with file_tree.lock_folder(root):
        olds: dict[str, bytes | None] = {}
        nows: dict[str, bytes | None] = {}
        for file, (old, digest) in stored["files"].items():
            olds[file] = None if old is None else base64.b64decode(old)
            nows[file] = _read_digested(_find_inside(root, file), digest, olds[file], file)
        _put_all(root, olds, nows)
    path = store.path_of(key)
    if path is not None:
        path.unlink(missing_ok=True)
    return UndoneEdit(stored["title"], tuple(olds))


def _store_of(root: Path) -> tuple[FileStore, str]:
    folder = cache_folder()
    key = hashlib.sha256(str(root.resolve()).encode()).hexdigest()
    return FileStore(None if folder is None else folder / "undo", ".json", _MOST_PROJECTS), key


def _find_inside(root: Path, file: str) -> Path:
    """Return the path of a file of the project. Raise OutputError for one that is, or lies, elsewhere by now."""
    path = root / file
    if path.is_symlink() or not path.resolve().is_relative_to(root.resolve()):
        msg = f"{file} is a link, or lies outside of the project"
        raise OutputError(msg, "nothing was written; edit it where it lies")
    return path


def _refuse_changed(root: Path, olds: Mapping[str, bytes | None]) -> None:
    for file, old in olds.items():
        path = _find_inside(root, file)
        if (old is None and os.path.lexists(path)) or (old is not None and not holds_bytes(path, old)):
            msg = f"{file} was changed, moved or removed since it was read"
            raise OutputError(msg, "nothing was written; run this again")


def _read_digested(path: Path, digest: str, old: bytes | None, file: str) -> bytes | None:
    """Return what a file holds if that is what was written, or already what was there before (an edit that was killed)."""
    data = path.read_bytes() if path.is_file() else None
    if data == old or (data is not None and hashlib.sha256(data).hexdigest() == digest):
        return data
    raise OutputError(f"{file} was edited since", "nothing was undone; take back your own edits first, or use git")


def _put_all(root: Path, contents: Mapping[str, bytes | None], olds: Mapping[str, bytes | None]) -> None:
    """Put contents (None: no file) in their places; where one fails, those before it are as they were again."""
    done: list[str] = []
    try:
        for file, content in contents.items():
            done.append(file)
            _put(root / file, content)
    except BaseException as error:
        for file in done:
            _put(root / file, olds[file])
        if isinstance(error, OSError):
            raise OutputError(f"cannot write {done[-1]}: {error.strerror or error}", "nothing was written") from error
        raise


def _put(path: Path, content: bytes | None) -> None:
    if content is None:
        path.unlink(missing_ok=True)
        with suppress(OSError):
            path.parent.rmdir()  # only if it is empty now
    else:
        path.parent.mkdir(parents=True, exist_ok=True)
        file_tree.replace_file(path, content)
