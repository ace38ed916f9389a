"""Remember which of many ways to lay out a picture was the best, by all that decides it: the sizes of what is placed and
the arrows between, not their words.

A title that changes but needs no more room is drawn anew with one layout instead of twenty.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from archgen.cache.file_store import FileStore, digest_text

_SUFFIX = ".layout"
_MOST_LAYOUTS = 400

LayoutCandidate = tuple[str, Sequence[str]]
"""A way to lay out a graph: settings and statements in DOT."""


class LayoutMemory(NamedTuple):
    """Where choices are cached (None: nowhere), and the stamp of the program that made them."""

    folder: Path | None = None
    program_stamp: str = ""

    def recall_choice(self, problem: str) -> LayoutCandidate | None:
        """Return what was chosen for a problem before."""
        # What is not there and what is damaged end alike: `null` is no pair either.
        data = self._store.load(self._name_problem(problem)) if self.folder else None
        try:
            settings, statements = json.loads(data or b"null")
            return str(settings), [str(each) for each in statements]
        except (ValueError, TypeError):  # a damaged file, or none
            return None

    def keep_choice(self, problem: str, candidate: LayoutCandidate) -> None:
        """Remember what was chosen."""
        if self.folder:
            self._store.store(self._name_problem(problem), json.dumps(candidate).encode())

    @property
    def _store(self) -> FileStore:
        return FileStore(self.folder, _SUFFIX, _MOST_LAYOUTS)

    def _name_problem(self, problem: str) -> str:
        return digest_text(f"{self.program_stamp}\n{problem}")


NO_MEMORY = LayoutMemory()
"""Remembers nothing."""
