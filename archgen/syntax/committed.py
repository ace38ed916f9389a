"""Read a project's files from a commit, straight from git's objects: nothing is checked out.

Links are followed here, not by the operating system: a commit may hold any link, and none may leave the project.
"""

from __future__ import annotations

import posixpath
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from archgen.git.objects import LINK, SUBMODULE, Blob, Objects
from archgen.syntax.files import MAX_BYTES, TOO_LARGE, Refusal

_MOST_LINKS = 40  # Linux gives up after as many (MAXSYMLINKS), with the same message
_OUT = Refusal("this link leads out of the project's folder", "copy the file into the project")
_BROKEN = Refusal("this is a broken link: what it points to does not exist")
_LOOP = Refusal("the file cannot be read: too many levels of symbolic links")
_ABSENT = Refusal("the file cannot be read: no such file or directory")
_FOLDER = Refusal("this is a folder, not a file")
_NOT_HERE = Refusal(
    "this partial clone does not hold the file's content", "fetch it with `git checkout`, then try again"
)


@dataclass(frozen=True, slots=True)
class Committed:
    """The files below one folder of a commit. Implements `ProjectFiles`."""

    objects: Objects
    commit: str
    root: Path
    blobs: Mapping[str, Blob]
    """Regular files, links and submodules, by path."""
    folders: Mapping[str, tuple[str, ...]]
    """The names in each folder, by the folder's path; "" is the project's own."""

    def exists(self, path: str) -> bool:
        """Whether there is anything at a path, even a broken link.

        Every path inside a submodule counts as present: a commit holds only the submodule's hash, not its files.
        """
        folder, _, name = posixpath.normpath(path).rpartition("/")
        # Only the folder is resolved: the last name may be a link that points nowhere, as with os.path.lexists.
        parent = self._resolve(folder)
        if isinstance(parent, Refusal):
            return False
        found = posixpath.join(parent, name)
        return found in self.blobs or found in self.folders or self._submodule(found) is not None

    def walk(self, top: str) -> Iterator[tuple[str, list[str], list[str]]]:
        """Walk as `os.walk` does; a submodule is an empty folder. Callers may remove folders from the list in place."""
        start = self._resolve(top)
        waiting = [] if isinstance(start, Refusal) or start not in self.folders else [(start, "")]
        while waiting:
            folder, below = waiting.pop()
            held = self.folders.get(folder, ())
            inside = [name for name in held if self._is_folder(posixpath.join(folder, name))]
            folders, names = list(inside), [name for name in held if name not in inside]
            yield below, folders, names
            # `folders` may be shorter now: the caller takes out what it does not want to enter. Reversed, because the
            # last path is popped first. A link to a folder is listed but is no key of self.folders: it is not entered.
            waiting += [
                (path, posixpath.join(below, name))
                for name in reversed(folders)
                if (path := posixpath.join(folder, name)) in self.folders
            ]

    def fetch(self, path: str) -> bytes | Refusal:
        """Return a file's bytes as they were committed, or why it cannot be used."""
        found = self._resolve(path)
        if isinstance(found, Refusal):
            return found
        blob = self.blobs.get(found)
        if blob is None:
            within = self._submodule(found)
            if within:
                return Refusal(f"this lies in the submodule `{within}`, of which a commit holds no files")
            return _FOLDER if found in self.folders else _ABSENT
        if blob.mode == SUBMODULE:
            return _FOLDER
        # The size is asked first: a huge blob is never brought into memory. None: the object is not in this clone.
        size = self.objects.size(blob.id)
        if size is not None and size > MAX_BYTES:
            return TOO_LARGE
        data = self.objects.content(blob.id) if size is not None else None
        return _NOT_HERE if data is None else data

    def _submodule(self, path: str) -> str | None:
        """Return the submodule that a path lies in, or None."""
        parts = path.split("/")
        above = ("/".join(parts[:end]) for end in range(1, len(parts)))
        return next((name for name in above if (blob := self.blobs.get(name)) and blob.mode == SUBMODULE), None)

    def _is_folder(self, path: str) -> bool:
        blob = self.blobs.get(path)
        if blob is None or blob.mode == SUBMODULE:
            return True
        return blob.mode == LINK and self._resolve(path) in self.folders

    def _resolve(self, path: str) -> str | Refusal:
        """Follow the links on a path; return the path they lead to, which need not exist, or a refusal if it leaves."""
        # A stack of path parts, the next one last: a link's target replaces the link, relative to the link's folder.
        waiting, done, links = path.split("/")[::-1], "", 0
        while waiting:
            part = waiting.pop()
            if part in {"", "."}:
                continue
            if part == "..":
                if not done:
                    return _OUT
                done = posixpath.dirname(done)
                continue
            done = posixpath.join(done, part)
            blob = self.blobs.get(done)
            if blob is None or blob.mode != LINK:
                continue
            target, links = self._target(blob), links + 1
            if target.startswith("/"):
                return _OUT
            if links > _MOST_LINKS:
                return _LOOP
            done = posixpath.dirname(done)
            waiting += target.split("/")[::-1]
        # Without a link on the way a missing file is simply absent, which fetch_bytes says in other words.
        return _BROKEN if links and done and done not in self.blobs and done not in self.folders else done

    def _target(self, blob: Blob) -> str:
        size = self.objects.size(blob.id)
        data = self.objects.content(blob.id) if size is not None and size < MAX_BYTES else None
        # A target that cannot be read (partial clone, absurd size) counts as absolute, which _follow_links refuses.
        return "/" if data is None else data.decode("utf-8", "surrogateescape")


def committed(objects: Objects, commit: str, prefix: str) -> Committed | None:
    """Return the files below a folder of a commit, or None where the commit has no such folder."""
    blobs = objects.tree(commit, prefix)
    if blobs is None:
        return None
    # git lists files only; folders follow from their paths. Dicts serve as ordered sets: git's order is kept.
    held: dict[str, dict[str, None]] = {"": {}}
    for path in blobs:
        here = path
        while here:
            parent, _, name = here.rpartition("/")
            known = parent in held
            held.setdefault(parent, {})[name] = None
            if known:
                break  # then all folders above are known as well
            here = parent
    folders = {folder: tuple(names) for folder, names in held.items()}
    return Committed(objects, commit, objects.repository.top / prefix, blobs, folders)
