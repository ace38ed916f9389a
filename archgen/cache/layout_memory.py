"""What layouts have been found before: by all that decides them, so that no search is done twice."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from archgen.cache.file_store import FileStore, digest_text
from archgen.frozen import NamedTuple

_SUFFIX = ".layout"
_MOST_LAYOUTS = 400


class LayoutMemory(NamedTuple):
    """Where choices are cached (None: nowhere), and the stamp of the program that made them."""

    folder: Path | None = None
    program_stamp: str = ""

    def recall_choice(self, problem: str) -> Any:  # noqa: ANN401 - as JSON says
        """Return what was chosen for a problem before, None where nothing was or the file is damaged."""
        data = self._store.load(self._name_problem(problem)) if self.folder else None
        try:
            return json.loads(data or b"null")
        except ValueError:
            return None

    def keep_choice(self, problem: str, choice: object) -> None:
        """Remember what was chosen, as JSON."""
        if self.folder:
            self._store.store(self._name_problem(problem), json.dumps(choice).encode())

    @property
    def _store(self) -> FileStore:
        return FileStore(self.folder, _SUFFIX, _MOST_LAYOUTS)

    def _name_problem(self, problem: str) -> str:
        return digest_text(f"{self.program_stamp}\n{problem}")


NO_MEMORY = LayoutMemory()
"""Remembers nothing."""
