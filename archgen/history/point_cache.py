"""Cache counted points by the id of the project's tree: the same tree has the same counts.

There is one file for each version of archgen's code and place of a project; a file that cannot be read counts as
missing.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from archgen.cache import cache_files
from archgen.cache.program_stamp import stamp_program

_MAX_FILES = 8
"""The most files that are kept."""
CachedPoints = dict[str, dict[str, Any]]


def cache_file(folder: Path | None, place: str) -> Path | None:
    """Return the path of the cache file for a project, None without a cache folder."""
    if folder is None:
        return None
    # The code is part of the name: a changed rule may count other findings in the same tree.
    digest = hashlib.sha256(f"{stamp_program()}\n{place}".encode("utf-8", "surrogateescape"))
    return folder / f"{digest.hexdigest()[:40]}.history"


def load_points(path: Path | None) -> CachedPoints:
    """Read the cached points, by the id of a tree."""
    try:
        cached = json.loads(path.read_bytes()) if path else {}
    except (OSError, ValueError):
        return {}
    return (
        {str(tree): data for tree, data in cached.items() if isinstance(data, dict)} if isinstance(cached, dict) else {}
    )


def store_points(path: Path | None, points: Mapping[str, Mapping[str, Any]]) -> None:
    """Replace the cached points; the oldest files beyond a few are removed."""
    if path is None:
        return
    with contextlib.suppress(OSError):  # a full or read-only disk costs only the time that this would have saved
        cache_files.store_file(path, json.dumps(points).encode())
        cache_files.remove_oldest(path.parent, ".history", _MAX_FILES)
