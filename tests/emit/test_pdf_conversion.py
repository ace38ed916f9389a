"""PDF by LibreOffice: refused with a clear word where it is not there."""

from __future__ import annotations

import io

import pytest

from archgen.emit.docx import write
from archgen.emit.own_file_marks import name_written_format
from archgen.emit.pdf_conversion import LibreOfficeError, convert_document, replace_clock
from archgen.views.shapes import Outline, Paragraph, Section, Text
from tests.outside_tools import find_tool

OUTLINE = Outline("Arm", sections=(Section("s", "Reach", (Paragraph((Text("So far."),)),)),))


def test_without_libreoffice_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    with pytest.raises(LibreOfficeError, match="there is no `soffice` on the path: install it"):
        convert_document(b"")


def test_a_pdf_says_the_day_of_the_revision_and_not_the_time_of_its_making() -> None:
    pdfs = [
        f"%PDF-1.6\n<</CreationDate(D:{time}+01'00')>>\n/ID [ <{number:032X}>\n<{number:032X}> ]\n/DocChecksum /{number + 1:032X}\n".encode()
        for time, number in (("20261122120547", 77), ("20270101235959", 78))
    ]
    first, second = (replace_clock(pdf, "2026-03-31") for pdf in pdfs)
    assert first == second
    assert len(first) == len(pdfs[0])
    assert b"/CreationDate(D:20260331000000+00'00')" in first
    assert b"/CreationDate(D:20000101000000" in replace_clock(pdfs[0], "March 2026")


@pytest.mark.slow
def test_a_report_becomes_a_pdf_that_archgen_knows_again() -> None:
    find_tool("soffice")  # archgen does so by itself
    document, _ = write(OUTLINE, {}, chapter_files=lambda _path: None)
    data = convert_document(document)
    assert data.startswith(b"%PDF-")
    assert name_written_format(io.BytesIO(data)) == "PDF"
