"""Files that are kept for the next time: written aside and moved, so that nobody reads half of one; the oldest go."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path


def put(path: Path, data: bytes) -> None:
    """Keep a file in place of what was there."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile(dir=path.parent, suffix=".part", delete=False) as part:
        part.write(data)
    os.replace(part.name, path)  # noqa: PTH105 - as atomic as the system can


def thin(folder: Path, suffix: str, most: int) -> None:
    """Remove the oldest files with this ending beyond so many."""
    kept = sorted(folder.glob(f"*{suffix}"), key=lambda each: each.stat().st_mtime, reverse=True)
    for old in kept[most:]:
        old.unlink(missing_ok=True)
