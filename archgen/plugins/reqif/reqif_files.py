"""Open ReqIF files: a single one, or those of a zip file (.reqifz), within limits."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import IO

from archgen.plugin.importing import ARCHIVE_DAMAGE, ZIP_BEGINNING, ForeignFileError, Span
from archgen.plugins.reqif.reqif_document import ReqifDocument
from archgen.plugins.reqif.reqif_parsing import parse_reqif

MAX_BYTES = 500_000_000
"""So much is read of one file, or of all in a zip file together."""
_CHUNK = 1 << 18


def read_reqif_file(path: Path) -> ReqifDocument:
    """Read a .reqif or .reqifz file. Raise ForeignFileError for what is none, and OSError."""
    document = ReqifDocument()
    with path.open("rb") as stream:
        is_zip = stream.read(4) == ZIP_BEGINNING
        stream.seek(0)
        if is_zip:
            _read_archive(path.name, stream, document)
        else:
            parse_reqif(path.name, _ByteLimit(path.name).read_chunks(stream), document)
    return document


def _read_archive(name: str, stream: IO[bytes], document: ReqifDocument) -> None:
    """Read each .reqif of a zip file; nothing of it is written to the disk."""
    limit = _ByteLimit(name)
    try:
        with zipfile.ZipFile(stream) as archive:
            members = [each for each in archive.infolist() if each.filename.lower().endswith(".reqif")]
            if not members:
                words = "there is no .reqif file in it"
                raise ForeignFileError(words, Span.of_file(name), "export it again as ReqIF")
            for member in members:
                with archive.open(member) as part:
                    parse_reqif(f"{name} [{member.filename}]", limit.read_chunks(part), document)
    except ARCHIVE_DAMAGE as error:
        words = f"the zip file is damaged ({error})"
        raise ForeignFileError(words, Span.of_file(name), "export it again") from None


class _ByteLimit:
    """Counts what is read: what a zip file says of its sizes may be a lie."""

    def __init__(self, name: str) -> None:
        self._name, self._bytes_left = name, MAX_BYTES

    def read_chunks(self, stream: IO[bytes]) -> Iterator[bytes]:
        while chunk := stream.read(_CHUNK):
            self._bytes_left -= len(chunk)
            if self._bytes_left < 0:
                words = f"it is larger than {MAX_BYTES // 1_000_000} MB"
                raise ForeignFileError(words, Span.of_file(self._name), "export the specifications one by one")
            yield chunk
