"""A project's files with some contents replaced, so that what is about to be written can be checked before it is."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from archgen.syntax.files import MAX_BYTES, TOO_LARGE, Files, Refusal


@dataclass(frozen=True, slots=True)
class Overlay:
    """New contents by path, laid over the files of a project (`base_files` None: an empty folder).

    Implements `ProjectFiles`.
    """

    root: Path
    over: Mapping[str, bytes]
    under: Files | None = None
    commit: str = ""

    def exists(self, path: str) -> bool:
        """Whether there is anything at a path."""
        return path in self.over or (self.under is not None and self.under.exists(path))

    def walk(self, top: str) -> Iterator[tuple[str, list[str], list[str]]]:
        """Walk down from a folder: first the folders of the base files, then those that only the overlay has."""
        seen = set[str]()
        for below, folders, names in self.under.walk(top) if self.under is not None else ():
            seen.add(below)
            yield below, folders, sorted({*names, *self._names(top, below)})
        # Folders of the overlay alone are yielded without subfolders: a caller cannot prune them, so hidden ones are
        # left out here.
        for below in sorted({path.rpartition("/")[0] for path in self._inside(top)}):
            if below not in seen and not any(part.startswith(".") for part in below.split("/")):
                yield below, [], sorted(self._names(top, below))

    def fetch(self, path: str) -> bytes | Refusal:
        """Return a file's bytes, from the overlay where it has the file; the size limit holds for both."""
        if path in self.over:
            data = self.over[path]
            return data if len(data) <= MAX_BYTES else TOO_LARGE
        return self.under.fetch(path) if self.under is not None else Refusal("the file does not exist")

    def _inside(self, top: str) -> Iterator[str]:
        for path in self.over:
            if not top or PurePosixPath(path).is_relative_to(top):
                yield path[len(top) + 1 :] if top else path

    def _names(self, top: str, below: str) -> Iterator[str]:
        for path in self._inside(top):
            folder, _, name = path.rpartition("/")
            if folder == below:
                yield name
