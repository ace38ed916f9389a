"""What all files of offices share: the zip that is the same bytes each time and names its program, text that XML can hold."""

from __future__ import annotations

import io
import re
import zipfile

from archgen.emit.own_file_marks import PROGRAM_NAME, PROGRAM_PART

STAMP = (1980, 1, 1, 0, 0, 0)
"""The earliest date that a zip can hold: in place of the time of day."""
# What XML 1.0 cannot hold (control characters, halves of surrogate pairs, two non-characters), and the C1 controls, which nobody sees.
_FORBIDDEN = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")
_APPLICATION = re.compile(r"<Application>[^<]*</Application>")
_MAIN_PARTS = frozenset({"xl/workbook.xml", "ppt/presentation.xml"})
_PICTURE_ENDINGS = (".png", ".jpeg", ".jpg", ".gif")


def replace_forbidden(text: str) -> str:
    """Return text with a visible sign for each character that XML cannot hold: libraries raise ValueError for them."""
    return _FORBIDDEN.sub("\ufffd", text)


def sign_package(data: bytes) -> bytes:
    """Return a package that names the program that wrote it: by this its next version may replace it.

    The main part is the last one, for there the list of a zip with many parts is looked at.
    """
    stream = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as source, zipfile.ZipFile(stream, "w") as target:
        for name in sorted(source.namelist(), key=lambda each: (each in _MAIN_PARTS, source.namelist().index(each))):
            content = source.read(name)
            if name == PROGRAM_PART:
                application = f"<Application>{PROGRAM_NAME}</Application>"
                content = _APPLICATION.sub(application, content.decode()).encode()
            info = zipfile.ZipInfo(name, STAMP)
            info.create_system = 0  # else the bytes would tell the system that wrote them
            method = zipfile.ZIP_STORED if name.endswith(_PICTURE_ENDINGS) else zipfile.ZIP_DEFLATED
            target.writestr(info, content, method, compresslevel=6)
    return stream.getvalue()
