"""Points that were counted before, by the id of the project's tree: what is the same tree has the same counts.

One file for each state of archgen and place of a project; one that cannot be read is as good as none.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from archgen.emit import shelf
from archgen.emit.program import program

_MOST = 8
"""So many files are kept."""
Kept = dict[str, dict[str, Any]]


def file(folder: Path | None, place: str) -> Path | None:
    """Name the file that holds the points of a project, None where nothing can be kept."""
    if folder is None:
        return None
    digest = hashlib.sha256(f"{program()}\n{place}".encode("utf-8", "surrogateescape"))
    return folder / f"{digest.hexdigest()[:40]}.history"


def load(path: Path | None) -> Kept:
    """Read what is kept, by the id of a tree."""
    try:
        found = json.loads(path.read_bytes()) if path else {}
    except (OSError, ValueError):
        return {}
    return (
        {str(tree): data for tree, data in found.items() if isinstance(data, dict)} if isinstance(found, dict) else {}
    )


def store(path: Path | None, points: Mapping[str, Mapping[str, Any]]) -> None:
    """Keep points in place of what was there; the oldest files beyond a few are removed."""
    if path is None:
        return
    with contextlib.suppress(OSError):  # a full or read-only disk costs only the time that this would have saved
        shelf.put(path, json.dumps(points).encode())
        shelf.thin(path.parent, ".history", _MOST)
