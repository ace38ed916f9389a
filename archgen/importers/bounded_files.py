"""Read files of other tools, and the members of zip archives, within limits."""

from __future__ import annotations

import lzma
import struct
import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import IO

from archgen.diagnostics.source_span import Span
from archgen.importers.foreign_import import ForeignFileError

MAX_MODEL_BYTES = 64_000_000
"""So much is read of one file, or of all members of an archive together."""
ZIP_BEGINNING = b"PK\x03\x04"
ARCHIVE_DAMAGE = (
    zipfile.BadZipFile,
    zlib.error,
    lzma.LZMAError,
    RuntimeError,
    EOFError,
    ValueError,
    struct.error,
    NotImplementedError,
)
"""What Python's zipfile raises for archives that are none, broken, or locked by a password."""


def read_bounded(path: Path, max_bytes: int = MAX_MODEL_BYTES) -> bytes:
    """Return what a file holds. Raise ForeignFileError for one that is too large, no file, or cannot be read."""
    try:
        if not path.is_file():
            words = "it is a folder, or no plain file" if path.exists() else "there is no such file"
            raise ForeignFileError(words, Span.of_file(str(path)), "name the file of the model")
        with path.open("rb") as stream:
            return _read_part(str(path), stream, max_bytes, max_bytes)
    except OSError as error:
        words = f"it cannot be read ({error.strerror})"
        raise ForeignFileError(words, Span.of_file(str(path)), "look at its rights") from None


def read_archive_members(path: Path, endings: tuple[str, ...]) -> Iterator[tuple[str, bytes]]:
    """Yield name and bytes of each member of a zip archive whose name ends so. Nothing of it is written to the disk.

    Names are for messages only: they may lead anywhere. Raise ForeignFileError.
    """
    bytes_left = MAX_MODEL_BYTES
    try:
        with zipfile.ZipFile(path) as archive:
            for member in archive.infolist():
                if member.filename.lower().endswith(endings):
                    with archive.open(member) as stream:
                        data = _read_part(f"{path} [{member.filename}]", stream, bytes_left, MAX_MODEL_BYTES)
                    bytes_left -= len(data)
                    yield member.filename, data
    except ARCHIVE_DAMAGE as error:
        words = f"the zip file is damaged ({error})"
        raise ForeignFileError(words, Span.of_file(str(path)), "export it again") from None
    except OSError as error:
        words = f"it cannot be read ({error.strerror or error})"
        raise ForeignFileError(words, Span.of_file(str(path)), "look at its rights") from None


def _read_part(name: str, stream: IO[bytes], max_bytes: int, told_bytes: int) -> bytes:
    # One byte more than allowed: what a zip file says of its sizes may be a lie.
    data = stream.read(max_bytes + 1)
    if len(data) > max_bytes:
        words = f"it is larger than {told_bytes // 1_000_000} MB"
        raise ForeignFileError(words, Span.of_file(name), "export the model in parts")
    return data
