"""PDF by LibreOffice: refused with a clear word where it is not there."""

from __future__ import annotations

import io
import shutil

import pytest

from archgen.emit.docx import write
from archgen.emit.pdf_conversion import LibreOfficeError, convert_document
from archgen.emit.written_formats import name_written_format
from archgen.views.shapes import Outline, Paragraph, Section, Text

OUTLINE = Outline("Arm", sections=(Section("s", "Reach", (Paragraph((Text("So far."),)),)),))


def test_without_libreoffice_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    with pytest.raises(LibreOfficeError, match="there is no `soffice` on the path: install it"):
        convert_document(b"")


@pytest.mark.slow
@pytest.mark.skipif(not shutil.which("soffice"), reason="LibreOffice is not there")
def test_a_report_becomes_a_pdf_that_archgen_knows_again() -> None:
    document, _ = write(OUTLINE, {}, chapter_files=lambda _path: None)
    data = convert_document(document)
    assert data.startswith(b"%PDF-")
    assert name_written_format(io.BytesIO(data)) == "PDF"
