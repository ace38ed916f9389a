"""Points that were counted before, by the id of the project's tree: what is the same tree has the same counts.

One file for each state of archgen's code and place of a project. It is written aside and moved; one that cannot be read is
as good as none.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from archgen import resources

_MOST = 8
"""So many files are kept."""
Kept = dict[str, dict[str, Any]]


def file(folder: Path | None, place: str) -> Path | None:
    """Name the file that holds the points of a project, None where nothing can be kept."""
    if folder is None:
        return None
    digest = hashlib.sha256(f"{_code()}\n{place}".encode("utf-8", "surrogateescape"))
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
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=path.parent, suffix=".part", delete=False) as part:
            part.write(json.dumps(points).encode())
        os.replace(part.name, path)  # noqa: PTH105 - as atomic as the system can
        files = sorted(path.parent.glob("*.history"), key=lambda each: each.stat().st_mtime, reverse=True)
        for old in files[_MOST:]:
            old.unlink(missing_ok=True)


def _code() -> str:
    """Stamp the code and the data that counting stands on."""
    digest = hashlib.sha256()
    package = Path(__file__).resolve().parents[1]
    folders = (package, resources.path("schemas"), resources.path("ros_type_mapper.yaml"))
    for folder in folders:
        files = [folder] if folder.is_file() else sorted([*folder.rglob("*.py"), *folder.rglob("*.json")])
        for each in files:
            digest.update(each.name.encode() + b"\n" + each.read_bytes())
    return digest.hexdigest()
