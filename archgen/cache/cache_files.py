"""Store cache files: written aside and moved into place, so that no reader sees half a file. The oldest are removed."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path


def store_file(path: Path, data: bytes) -> None:
    """Store a file, in place of one that may exist."""
    path.parent.mkdir(parents=True, exist_ok=True)
    # In the same folder, since a move across file systems is not atomic; another process may store the same file.
    with tempfile.NamedTemporaryFile(dir=path.parent, suffix=".part", delete=False) as part:
        part.write(data)
    os.replace(part.name, path)  # noqa: PTH105 - as atomic as the system can


def remove_oldest(folder: Path, suffix: str, keep_count: int) -> None:
    """Remove the oldest files with this suffix, all but `keep_count`."""
    newest_first = sorted(folder.glob(f"*{suffix}"), key=lambda each: each.stat().st_mtime, reverse=True)
    for outdated_file in newest_first[keep_count:]:
        outdated_file.unlink(missing_ok=True)
