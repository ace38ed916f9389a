"""Recognise the single files that archgen writes, by the mark that each format of its carries.

A folder has a manifest of what archgen wrote there. A single file stands among files of others, and only its content can say
whose it is.
"""

from __future__ import annotations

import codecs
import io
import re
import struct
from pathlib import Path
from typing import BinaryIO

from archgen.regular_files import open_named_file

PACKED_HEADER = "# Packed by archgen from the files of a project: change those, and pack again.\n"
"""The first line of a packed file, which would otherwise look as a project that somebody wrote."""
MEASURED_HEADER = (
    "# Measured: written by `archgen timing --adopt`. Execution times are the longest and shortest seen, not proven.\n"
)
"""The first line of a slice with what was measured."""
PROGRAM_NAME = "archgen"
"""What the properties of a Word document call the program that wrote it; other programs that save it write their own name."""
PDF_MARK = b"% written by archgen\n"
"""The last line of a PDF: a comment behind its end, which readers pass over."""
PROGRAM_PART = "docProps/app.xml"
_EDGE_BYTES = 4096
"""All marks stand within so many bytes at the beginning or the end of a file."""
_MAX_ZIP_LIST = 4_000_000
"""Bytes of a zip's list of files: 40,000 files, so that no list of millions is brought into memory."""
_ZIP_END = struct.Struct("<20sL8sL6s")
"""The end of a zip without a comment: before it stands another mark if it is a large one; the list's size."""
_HEAD_MARKS = tuple(
    (name, re.compile(pattern))
    for name, pattern in (
        ("packed project", re.escape(PACKED_HEADER.encode())),
        ("measured slice", re.escape(MEASURED_HEADER.encode())),
        ("resolved model", rb"archgen_resolved: "),
        ("project", rb"\s*(?:#[^\n]*\n\s*)*archgen: "),
        ("CODEOWNERS file", rb"# Who reviews which file: made by `archgen owners"),
        ("list of owners", rb"Partner {2,}groups +components +nodes +files +reviewers\n"),
        (
            "web page",
            rb'<!DOCTYPE html>\s*<html[^>]*>\s*<head>\s*<meta charset="utf-8">\s*<meta name="generator" content="archgen">',
        ),
        ("picture", rb'<\?xml[^>]*>\s*<svg class="archgen"'),
        ("JSON comparison", rb'\{\n  "version": \d+,\n  "changes": \['),
        ("Markdown comparison", "### (?:Cannot be judged\n|[^\n]*\n\n`[^\n]*` → `)".encode()),
        ("Markdown agreement", rb"# [^\n]*\n\nInterface agreement\n"),
        (
            "SARIF list of findings",
            rb'\{\n  "\$schema": "[^"]*sarif[^"]*",\n  "version": "2\.1\.0",\n  "runs": \[\s*\{\s*"tool": \{\s*"driver": \{\s*"name": "archgen"',
        ),
        ("JUnit list of findings", rb'<\?xml[^>]*>\s*<testsuites name="archgen"'),
    )
)
_ZIP_SIGNATURE = int.from_bytes(b"PK\x05\x06", "little")
_BINARY_BYTE = re.compile(rb"[\0-\x08\x0e-\x1a\x1c-\x1f]")
_COMPARISON_END = re.compile(
    rb"(?m)^(?:(?:\w+: )?cannot be judged: |no changes(?: in what could be read)?$|\d+ changes?(?:[,;]| \(|$)|no change breaks another partner$"
    rb"|(?:\w+: )?\d+ breaking changes? for |`review\.breaking` is off)"
)
"""A line near the end of a comparison in plain text."""


def explain_refusal(path: Path, new_content: bytes) -> str:
    """Return why new content must not replace an existing file, empty where it may: archgen wrote it, and the same format.

    Formats without a mark, such as what a backend of one's own exports, may replace any text of that kind.
    """
    with open_named_file(path) as stream:
        # So a file that somebody touched, or that a full disk left, is no obstacle.
        if not stream.read(1):
            return ""
        old_name = name_written_format(stream)
        new_name = name_written_format(io.BytesIO(new_content))
        if new_name and old_name != new_name:
            return f"{path} is no {new_name} that archgen wrote"
        if old_name and not new_name:
            return f"{path} is a {old_name}"
        return "" if old_name or _is_text(stream) else f"{path} is no text file"


def name_written_format(stream: BinaryIO) -> str | None:
    """Return the name of the format in which archgen wrote a file; None if it did not, or the format has no mark."""
    stream.seek(0)
    head = stream.read(_EDGE_BYTES)
    if head.startswith(b"PK"):
        if not _has_program_name(stream):
            return None
        # Its list of files, at the end, names the parts of the one or the other.
        end = _read_end(stream)
        named = {"workbook": b"xl/workbook.xml", "presentation": b"ppt/presentation.xml"}
        return next((name for name, part in named.items() if part in end), "Word document")
    if head.startswith(b"%PDF-"):
        return "PDF" if _read_end(stream).endswith(PDF_MARK) else None
    name = next((name for name, mark in _HEAD_MARKS if mark.match(head)), None)
    return name or ("plain comparison" if _COMPARISON_END.search(_read_end(stream)) else None)


def _read_end(stream: BinaryIO) -> bytes:
    stream.seek(max(0, stream.seek(0, io.SEEK_END) - _EDGE_BYTES))
    return stream.read(_EDGE_BYTES)


def _has_program_name(stream: BinaryIO) -> bool:
    """Whether a Word document says that archgen wrote it, and no other program saved it since."""
    import zipfile
    import zlib

    try:
        stream.seek(-_ZIP_END.size, io.SEEK_END)
        before, signature, _, list_size, _ = _ZIP_END.unpack(stream.read(_ZIP_END.size))
        if before.startswith(b"PK\x06\x07") or signature != _ZIP_SIGNATURE or list_size > _MAX_ZIP_LIST:
            return False
        with zipfile.ZipFile(stream) as archive, archive.open(PROGRAM_PART) as part:
            return f"<Application>{PROGRAM_NAME}</Application>".encode() in part.read(_EDGE_BYTES)
    # Whatever is wrong with the file, archgen did not write it.
    except (OSError, KeyError, ValueError, RuntimeError, EOFError, struct.error, zipfile.BadZipFile, zlib.error):
        return False


def _is_text(stream: BinaryIO) -> bool:
    """Whether a file begins as text in UTF-8."""
    stream.seek(0)
    head = stream.read(_EDGE_BYTES)
    try:
        # The last character of a longer file may be cut.
        codecs.getincrementaldecoder("utf-8")().decode(head, final=len(head) < _EDGE_BYTES)
    except UnicodeDecodeError:
        return False
    return not _BINARY_BYTE.search(head)
