"""PDF out of a Word document, by LibreOffice where the machine has it."""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

from archgen.emit.own_file_marks import PDF_MARK

_TIME_LIMIT = 600
"""Seconds after which LibreOffice is given up; a report of 300 pages takes 60 on a slow machine."""
_PROGRAMS = ("soffice", "libreoffice")
_DATE = re.compile(rb"(/(?:CreationDate|ModDate)\s*\(D:)([^)]*)\)")
_ID = re.compile(rb"/ID\s*\[\s*<([0-9A-F]{32})>\s*<([0-9A-F]{32})>\s*\]")
_CHECKSUM = re.compile(rb"/DocChecksum\s*/([0-9A-F]{32})")
_UNKNOWN_DAY = "2000-01-01"
"""As in the pictures that Graphviz writes as PDF."""


class LibreOfficeError(Exception):
    """LibreOffice is not there, or failed; the text says what to do."""


def find_libreoffice() -> str:
    """Return the path of LibreOffice. Raise LibreOfficeError if it is not on the path."""
    program = next((path for name in _PROGRAMS if (path := shutil.which(name))), None)
    if program is None:
        message = "writing .pdf needs LibreOffice, and there is no `soffice` on the path: install it (Debian: `apt install libreoffice-writer-nogui`), or write the .docx"
        raise LibreOfficeError(message)
    return program


def convert_document(document: bytes, day: str = "") -> bytes:
    """Return a Word document as PDF that says it is of a day (`2026-03-31`), not of now.

    Raise LibreOfficeError where LibreOffice is missing or makes none.
    """
    program = find_libreoffice()
    with tempfile.TemporaryDirectory(prefix="archgen-pdf-") as folder:
        source = Path(folder) / "report.docx"
        source.write_bytes(document)
        # A profile of its own: else a LibreOffice that somebody has open would take the job, or refuse it.
        profile = f"-env:UserInstallation={(Path(folder) / 'profile').as_uri()}"
        arguments = [
            program,
            profile,
            "--headless",
            "--norestore",
            "--convert-to",
            "pdf",
            "--outdir",
            folder,
            str(source),
        ]
        try:
            subprocess.run(  # noqa: S603 - a program of the machine, and a file of our own
                arguments,
                check=False,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                timeout=_TIME_LIMIT,
                env={**os.environ, "HOME": folder},
            )
        except (OSError, subprocess.TimeoutExpired) as error:
            message = f"LibreOffice made no .pdf: {type(error).__name__}; write the .docx, and print that"
            raise LibreOfficeError(message) from None
        target = source.with_suffix(".pdf")
        if not target.is_file():
            raise LibreOfficeError("LibreOffice made no .pdf of the report; write the .docx, and print that")
        return replace_clock(target.read_bytes(), day).rstrip() + b"\n" + PDF_MARK


def replace_clock(data: bytes, day: str) -> bytes:
    """Overwrite the time of day and what LibreOffice computes from it, byte for byte: the file's offsets must not move.

    LibreOffice 7.4 does not heed SOURCE_DATE_EPOCH.
    """
    day = day if re.fullmatch(r"[0-9]{4}-[0-9]{2}-[0-9]{2}", day) else _UNKNOWN_DAY
    data = _DATE.sub(lambda found: found[1] + _write_day(found[2], day) + b")", data)
    for pattern in (_ID, _CHECKSUM):
        data = pattern.sub(lambda found: re.sub(rb"[0-9A-F]{32}", b"0" * 32, found[0]), data)
    digest = hashlib.sha256(data).hexdigest()[:32].upper().encode()
    for pattern in (_ID, _CHECKSUM):
        data = pattern.sub(lambda found: found[0].replace(b"0" * 32, digest), data)
    return data


def _write_day(date: bytes, day: str) -> bytes:
    """Return a date of PDF with another day and midnight, as long as it was: `20260331000000Z`."""
    digits = re.sub(rb"[0-9]", b"0", date)
    return day.replace("-", "").encode() + digits[8:]
