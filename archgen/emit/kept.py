"""A Word report written before: kept with all that it depends on, so that nothing old is ever taken.

The key is a digest of the outline, the pictures, the template and the code that writes; pictures that chapters show are
compared one by one, because only the writer knows which it asks for. A file is a line of JSON, and then the report.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import zlib
from collections.abc import Callable, Mapping
from pathlib import Path

from archgen.emit import shelf
from archgen.emit.picture import Picture
from archgen.emit.program import writers
from archgen.views.shapes import Outline

Written = tuple[bytes, tuple[str, ...]]
ChapterFiles = Callable[[str], bytes | None]
_MOST = 4
"""So many reports are kept."""


def folder() -> Path | None:
    """Give the folder in which pictures, reports and stamps are kept, None where there is no place for it."""
    base = os.environ.get("XDG_CACHE_HOME")
    try:
        return Path(base) / "archgen" if base else Path.home() / ".cache" / "archgen"
    except RuntimeError:  # nobody's home
        return None


def report(  # noqa: PLR0913 - all that a report depends on, and how to write it
    folder: Path | None,
    outline: Outline,
    pictures: Mapping[str, Picture],
    *,
    template: bytes | None,
    chapter_files: ChapterFiles,
    write: Callable[[ChapterFiles], Written],
) -> Written:
    """Give the report and its warnings: as kept in a folder, or written anew. `write` may raise; then nothing is kept."""
    if folder is None:
        return write(chapter_files)
    file = folder / f"{_key(outline, pictures, template)}.report"
    found = _load(file, chapter_files)
    if found is not None:
        return found
    asked: dict[str, str | None] = {}

    def noting(path: str) -> bytes | None:
        data = chapter_files(path)
        asked[path] = _digest(data)
        return data

    made = write(noting)
    with contextlib.suppress(OSError):  # a full or read-only disk costs only the time that this would have saved
        _store(file, made, asked)
    return made


def _key(outline: Outline, pictures: Mapping[str, Picture], template: bytes | None) -> str:
    digest = hashlib.sha256(f"{writers()}\n{outline!r}\n".encode("utf-8", "surrogatepass"))
    _add(digest, template)
    for name, each in pictures.items():
        _add(digest, repr((name, each.id, each.width, each.height, each.warning)).encode("utf-8", "surrogatepass"))
        for data in (each.svg, each.svg_outlines, each.png):
            _add(digest, data)
    return digest.hexdigest()


def _add(digest: hashlib._Hash, data: bytes | None) -> None:
    """Add bytes with their length before them, so that no two lists of parts run into one."""
    digest.update(b"none " if data is None else b"%d " % len(data))
    digest.update(data or b"")


def _digest(data: bytes | None) -> str | None:
    return None if data is None else hashlib.sha256(data).hexdigest()


def _load(file: Path, chapter_files: ChapterFiles) -> Written | None:
    """Read a report whose chapters would show the same pictures today."""
    try:
        line, _, document = file.read_bytes().partition(b"\n")
        head = json.loads(line)
        sound = zlib.crc32(document) == head["check"]
        same = sound and all(_digest(chapter_files(path)) == held for path, held in head["asked"].items())
        return (document, tuple(map(str, head["warnings"]))) if same else None
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None


def _store(file: Path, made: Written, asked: Mapping[str, str | None]) -> None:
    """Keep a report; the oldest beyond a few are removed."""
    document, warnings = made
    head = json.dumps({"check": zlib.crc32(document), "warnings": warnings, "asked": asked})
    shelf.put(file, head.encode() + b"\n" + document)
    shelf.thin(file.parent, ".report", _MOST)
