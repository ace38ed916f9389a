"""A cache of Word reports, each stored with all that decides its bytes, so that no stale report is ever used.

The key is a digest of the outline, the pictures, the template and the code that writes. Pictures in chapters are
compared one by one instead, because only the writer knows which of them it needs. A file is one line of JSON, followed
by the report.
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
"""A report and the warnings of its writer."""
ChapterFiles = Callable[[str], bytes | None]
"""Reads a picture of a chapter by its path; None where there is no such file."""
_MOST = 4
"""Reports that are kept; the oldest beyond are removed."""


def folder() -> Path | None:
    """Return the cache folder for pictures, reports and stamps, None where the system has no place for it."""
    base = os.environ.get("XDG_CACHE_HOME")
    try:
        return Path(base) / "archgen" if base else Path.home() / ".cache" / "archgen"
    # `Path.home` raises this where the user has no home folder.
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
    """Return the report and its warnings: from the cache folder, or written anew.

    An exception of `write_report` passes through, and nothing is stored.
    """
    if folder is None:
        return write(chapter_files)
    file = folder / f"{_key(outline, pictures, template)}.report"
    found = _load(file, chapter_files)
    if found is not None:
        return found
    # Filled while the report is written: path and digest of each chapter picture, None for a missing file. A picture
    # that turns up later changes its digest, so that the report is written again.
    asked: dict[str, str | None] = {}

    def noting(path: str) -> bytes | None:
        """Read a chapter's picture and record its digest."""
        data = chapter_files(path)
        asked[path] = _digest(data)
        return data

    made = write(noting)
    with contextlib.suppress(OSError):  # a full or read-only disk costs only the time that this would have saved
        _store(file, made, asked)
    return made


def _key(outline: Outline, pictures: Mapping[str, Picture], template: bytes | None) -> str:
    """Return the name of the cached file: a digest of all inputs but the chapters' pictures."""
    # The repr of a frozen shape holds all of it. `surrogatepass`: texts may hold lone surrogates, which UTF-8 cannot
    # write.
    digest = hashlib.sha256(f"{writers()}\n{outline!r}\n".encode("utf-8", "surrogatepass"))
    _add(digest, template)
    for name, each in pictures.items():
        _add(digest, repr((name, each.id, each.width, each.height, each.warning)).encode("utf-8", "surrogatepass"))
        for data in (each.svg, each.svg_outlines, each.png):
            _add(digest, data)
    return digest.hexdigest()


def _add(digest: hashlib._Hash, data: bytes | None) -> None:
    """Add bytes after their length, so that no two lists of inputs give the same stream."""
    digest.update(b"none " if data is None else b"%d " % len(data))
    digest.update(data or b"")


def _digest(data: bytes | None) -> str | None:
    return None if data is None else hashlib.sha256(data).hexdigest()


def _load(file: Path, chapter_files: ChapterFiles) -> Written | None:
    """Read a cached report; None if it is damaged or a chapter would show another picture today."""
    try:
        line, _, document = file.read_bytes().partition(b"\n")
        head = json.loads(line)
        # A check against files that were cut off or damaged, so a CRC is enough.
        sound = zlib.crc32(document) == head["check"]
        same = sound and all(_digest(chapter_files(path)) == held for path, held in head["asked"].items())
        return (document, tuple(map(str, head["warnings"]))) if same else None
    # Whatever the file holds instead, it is a miss.
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None


def _store(file: Path, made: Written, asked: Mapping[str, str | None]) -> None:
    """Store a report and remove the oldest beyond a few."""
    document, warnings = made
    head = json.dumps({"check": zlib.crc32(document), "warnings": warnings, "asked": asked})
    shelf.put(file, head.encode() + b"\n" + document)
    shelf.thin(file.parent, ".report", _MOST)
