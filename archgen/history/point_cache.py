"""Cache counted points by the id of the project's tree: the same tree has the same counts.

There is one file for each version of archgen's code and place of a project.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from archgen.cache.file_store import FileStore, digest_text
from archgen.cache.program_stamp import stamp_program

_MAX_FILES = 8
"""The most files that are kept."""
CachedPoints = dict[str, dict[str, Any]]


class PointCache:
    """The cached points of the project at one place; without a folder it is empty."""

    def __init__(self, folder: Path | None, place: str) -> None:
        """Point to the file of a project. The code is part of its name: a changed rule may count other findings."""
        self._files = FileStore(folder, ".history", _MAX_FILES)
        self._key = digest_text(f"{stamp_program()}\n{place}")[:40] if folder else ""

    def load_points(self) -> CachedPoints:
        """Read the cached points, by the id of a tree. What cannot be read counts as missing."""
        try:
            cached = json.loads(self._files.load(self._key) or b"{}")
        except ValueError:
            return {}
        return (
            {str(tree): data for tree, data in cached.items() if isinstance(data, dict)}
            if isinstance(cached, dict)
            else {}
        )

    def store_points(self, points: Mapping[str, Mapping[str, Any]]) -> None:
        """Replace the cached points."""
        self._files.store(self._key, json.dumps(points).encode())
