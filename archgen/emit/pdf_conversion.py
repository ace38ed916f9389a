"""PDF out of a Word document, by LibreOffice where the machine has it."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from archgen.emit.written_formats import PDF_MARK

_TIME_LIMIT = 600
"""Seconds after which LibreOffice is given up; a report of 300 pages takes 60 on a slow machine."""
_PROGRAMS = ("soffice", "libreoffice")


class LibreOfficeError(Exception):
    """LibreOffice is not there, or failed; the text says what to do."""


def find_libreoffice() -> str:
    """Return the path of LibreOffice. Raise LibreOfficeError if it is not on the path."""
    program = next((path for name in _PROGRAMS if (path := shutil.which(name))), None)
    if program is None:
        message = "writing .pdf needs LibreOffice, and there is no `soffice` on the path: install it (Debian: `apt install libreoffice-writer-nogui`), or write the .docx"
        raise LibreOfficeError(message)
    return program


def convert_document(document: bytes) -> bytes:
    """Return a Word document as PDF. Raise LibreOfficeError where LibreOffice is missing or makes none."""
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
            message = "LibreOffice made no .pdf of the report; write the .docx, and print that"
            raise LibreOfficeError(message)
        return target.read_bytes().rstrip() + b"\n" + PDF_MARK
