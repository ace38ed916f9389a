"""Which files of the user's own fitted what is generated around them, kept for a later run: reading code takes long."""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Mapping
from pathlib import Path

from archgen.cache.file_store import FileStore
from archgen.cache.program_stamp import stamp_program
from archgen.emit.workspace.disk_files import GeneratedFile


class KnownFits:
    """The digests of all that decides whether a file fits, of those that did in the last run and in this one."""

    def __init__(self, cache_folder: Path | None = None, workspace: Path = Path(), backend: str = "") -> None:
        """Take the user's cache; without it, nothing is known."""
        self._store = FileStore(cache_folder, ".fits", 48)
        words = (stamp_program(), sys.version, str(workspace.absolute()), backend) if cache_folder else ()
        self._key = hashlib.sha256("\n".join(words).encode("utf-8", "replace")).hexdigest()
        kept = self._store.load(self._key) or b""
        self._known = frozenset(kept.decode("ascii", "replace").split())
        self._found: set[str] = set()

    def is_known(self, digest: str) -> bool:
        """Whether what has this digest fitted. It is kept for the next run, too."""
        if digest in self._known:
            self._found.add(digest)
        return digest in self._known

    def add(self, digest: str) -> None:
        """Remember what was found to fit."""
        self._found.add(digest)

    def keep(self) -> None:
        """Keep what fitted in this run, where that is something else than before."""
        if self._found != self._known:
            self._store.store(self._key, "\n".join(sorted(self._found)).encode())


def digest_fit(file: GeneratedFile, content_digest: str, *recorded: Mapping[str, str]) -> str:
    """Return a digest of a file of the user's own, what is generated around it, and what its names meant before."""
    meanings = (word for each in recorded for word in ("", *map(str, sorted(each.items()))))
    words = (file.path, content_digest, *file.expected_words, "", *file.offered_words, *meanings)
    return hashlib.sha256("\n".join(words).encode("utf-8", "surrogatepass")).hexdigest()[:32]
