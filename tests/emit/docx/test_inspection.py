"""Our own judge finds what it is there for: each fault is put into a sound document."""

from __future__ import annotations

import io
import re
import zipfile

import pytest

from archgen.emit.docx import write
from tests.emit.docx import inspection, sample

SOUND = write(sample.outline(1, 1), sample.pictures(), chapter_files=sample.FILES.get)[0]


def spoilt(pattern: str, new: str, part: str = "word/document.xml") -> bytes:
    source, target = zipfile.ZipFile(io.BytesIO(SOUND)), io.BytesIO()
    with zipfile.ZipFile(target, "w") as archive:
        for name in source.namelist():
            content = source.read(name)
            if name == part:
                text, count = re.subn(pattern, new, content.decode(), count=1)
                assert count == 1
                content = text.encode()
            archive.writestr(name, content)
    return target.getvalue()


@pytest.mark.parametrize(
    ("pattern", "new", "fault"),
    [
        (r'<w:hyperlink w:anchor="\w+"', '<w:hyperlink w:anchor="gone"', "link to the missing bookmark gone"),
        (r"PAGEREF \w+", "PAGEREF gone", "PAGEREF to the missing bookmark gone"),
        (r'(<w:bookmarkStart w:id=")\d+("[^>]*/><w:bookmarkEnd)', r"\g<1>9999\2", "bookmarks do not begin and end once each"),
        (r'<w:bookmarkStart w:id="\d+" w:name="(\w+)"/><w:bookmarkEnd w:id="\d+"/>', r'<w:bookmarkStart w:id="77777" w:name="\1"/><w:bookmarkEnd w:id="77777"/>\g<0>', "stands 2 times"),
        (r'<w:fldChar w:fldCharType="end"/>', "", "fields do not balance in word/document.xml: a field has no end"),
        (r'<w:fldChar w:fldCharType="separate"/>', '<w:fldChar w:fldCharType="end"/>', "end outside of a field"),
        (r"</w:p></w:tc>", "</w:p><w:tbl/></w:tc>", "a cell ends without a paragraph"),
        (r"</w:tbl><w:p>.*?</w:p>", "</w:tbl><w:tbl/>", "no paragraph stands behind a table"),
        (r'<w:pStyle w:val="\w+"', '<w:pStyle w:val="gone"', "uses the missing paragraph style gone"),
        (r'<w:tblStyle w:val="\w+"', '<w:tblStyle w:val="gone"', "uses the missing table style gone"),
        (r'<w:numId w:val="[1-9]\d*"', '<w:numId w:val="999"', "uses the missing list 999"),
        (r'r:embed="\w+"', 'r:embed="gone"', "uses the missing relationship gone"),
        (r' descr="[^"]*"', "", "has no alternative text"),
        (r"<w:gridCol [^>]*/>", "", "a row has another number of cells than the table has columns"),
    ],
)  # fmt: skip
def test_a_fault_is_found(pattern: str, new: str, fault: str) -> None:
    assert inspection.faults(SOUND) == []
    assert any(fault in found for found in inspection.faults(spoilt(pattern, new)))


def test_a_relationship_to_nothing_is_found() -> None:
    data = spoilt(r'Target="media/\w+\.png"', 'Target="media/gone.png"', "word/_rels/document.xml.rels")
    assert any("leads to the missing part word/media/gone.png" in found for found in inspection.faults(data))


def test_a_question_at_opening_is_found() -> None:
    data = spoilt(r"<w:zoom", "<w:updateFields/><w:zoom", "word/settings.xml")
    assert "Word asks whether to update fields" in inspection.faults(data)
