"""Store cache files: written aside and moved into place, so that no reader sees half a file. The oldest are removed."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path


def put(path: Path, data: bytes) -> None:
    """Store a file, in place of one that may exist."""
    path.parent.mkdir(parents=True, exist_ok=True)
    # In the same folder, since a move across file systems is not atomic; another process may store the same file.
    with tempfile.NamedTemporaryFile(dir=path.parent, suffix=".part", delete=False) as part:
        part.write(data)
    os.replace(part.name, path)  # noqa: PTH105 - as atomic as the system can


def thin(folder: Path, suffix: str, most: int) -> None:
    """Remove the oldest files with this suffix, all but `keep_count`."""
    kept = sorted(folder.glob(f"*{suffix}"), key=lambda each: each.stat().st_mtime, reverse=True)
    for old in kept[most:]:
        old.unlink(missing_ok=True)
