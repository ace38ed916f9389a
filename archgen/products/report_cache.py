"""A cache of Word reports, each stored with all that decides its bytes, so that no stale report is ever used.

The key is a digest of the outline, the pictures, the template and the code that writes. Pictures in chapters are
compared one by one instead, because only the writer knows which of them it needs. A file is one line of JSON, followed
by the report.
"""

from __future__ import annotations

import hashlib
import json
import zlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from archgen.cache import find_cache_path
from archgen.cache.file_store import FileStore, digest_bytes
from archgen.cache.program_stamp import stamp_writers

if TYPE_CHECKING:
    from archgen.emit.picture import Picture
    from archgen.views.shapes import Outline

ReportWithWarnings = tuple[bytes, tuple[str, ...]]
"""A report and the warnings of its writer."""
ChapterFileReader = Callable[[str], bytes | None]
"""Reads a picture of a chapter by its path; None where there is no such file."""
_MAX_REPORTS = 4
"""Reports that are kept; the oldest beyond are removed."""


def cache_folder() -> Path | None:
    """Return the cache folder for pictures, reports and stamps, None where the system has no place for it."""
    path = find_cache_path()
    return None if path is None else Path(path)


def get_or_write_report(  # noqa: PLR0913 - all that a report depends on, and how to write it
    folder: Path | None,
    outline: Outline,
    pictures: Mapping[str, Picture],
    *,
    template: bytes | None,
    chapter_files: ChapterFileReader,
    write_report: Callable[[ChapterFileReader], ReportWithWarnings],
) -> ReportWithWarnings:
    """Return the report and its warnings: from the cache folder, or written anew.

    An exception of `write_report` passes through, and nothing is stored.
    """
    if folder is None:
        return write_report(chapter_files)
    files = FileStore(folder, ".report", _MAX_REPORTS)
    report_key = _report_key(outline, pictures, template)
    cached_report = _read_report(files.load(report_key), chapter_files)
    if cached_report is not None:
        return cached_report
    # Filled while the report is written: path and digest of each chapter picture, None for a missing file. A picture
    # that turns up later changes its digest, so that the report is written again.
    asked_digests: dict[str, str | None] = {}

    def read_and_record(path: str) -> bytes | None:
        """Read a chapter's picture and record its digest."""
        data = chapter_files(path)
        asked_digests[path] = digest_bytes(data)
        return data

    new_report = write_report(read_and_record)
    document, warnings = new_report
    header = json.dumps({"check": zlib.crc32(document), "warnings": warnings, "asked": asked_digests})
    files.store(report_key, header.encode() + b"\n" + document)
    return new_report


def _report_key(outline: Outline, pictures: Mapping[str, Picture], template: bytes | None) -> str:
    """Return the name of the cached file: a digest of all inputs but the chapters' pictures."""
    # The repr of a frozen shape holds all of it. `surrogatepass`: texts may hold lone surrogates, which UTF-8 cannot
    # write.
    digest = hashlib.sha256(f"{stamp_writers()}\n{outline!r}\n".encode("utf-8", "surrogatepass"))
    _add_to_digest(digest, template)
    for name, picture in pictures.items():
        _add_to_digest(
            digest,
            repr((name, picture.id, picture.width, picture.height, picture.warning)).encode("utf-8", "surrogatepass"),
        )
        for data in (picture.svg, picture.svg_outlines, picture.png):
            _add_to_digest(digest, data)
    return digest.hexdigest()


def _add_to_digest(digest: hashlib._Hash, data: bytes | None) -> None:
    """Add bytes after their length, so that no two lists of inputs give the same stream."""
    digest.update(b"none " if data is None else b"%d " % len(data))
    digest.update(data or b"")


def _read_report(data: bytes | None, chapter_files: ChapterFileReader) -> ReportWithWarnings | None:
    """Read a cached report; None if it is damaged or a chapter would show another picture today."""
    try:
        line, _, document = (data or b"").partition(b"\n")
        header = json.loads(line)
        # A check against files that were cut off or damaged, so a CRC is enough.
        is_intact = zlib.crc32(document) == header["check"]
        is_current = is_intact and all(
            digest_bytes(chapter_files(path)) == stored_digest for path, stored_digest in header["asked"].items()
        )
        return (document, tuple(map(str, header["warnings"]))) if is_current else None
    # Whatever the file holds instead, it is a miss.
    except (ValueError, KeyError, TypeError, AttributeError):
        return None
