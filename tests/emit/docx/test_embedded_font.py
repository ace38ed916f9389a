"""The face of code lies in the file, and a template keeps its own fonts."""

from __future__ import annotations

import io
import re
import zipfile

import docx
from docx.opc.constants import RELATIONSHIP_TYPE
from docx.opc.packuri import PackURI
from docx.opc.part import Part

from archgen.emit.docx import write
from archgen.emit.docx.docx_writer import CODE_FONT
from archgen.views.shapes import Column, Outline, Paragraph, Section, Table, Text

CODE = Text("/scan", code=True)
OUTLINE = Outline(
    "T",
    sections=(
        Section(
            "a",
            "A",
            (Paragraph((CODE,)), Table("t", "Topics", (Column("Topic"),), (((Text("/odom", code=True, ref="a"),),),))),
        ),
    ),
)


def _read(data: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def test_code_is_set_in_one_face_that_the_file_holds() -> None:
    files = _read(write(OUTLINE, {}, chapter_files=lambda _path: None)[0])
    fonts, hidden = files["word/fontTable.xml"].decode(), files["word/fonts/archgen.odttf"]
    key = bytes.fromhex(re.findall(r'w:fontKey="\{([^}]+)\}"', fonts)[0].replace("-", ""))[::-1]
    font = bytes(byte ^ key[at % 16] if at < 32 else byte for at, byte in enumerate(hidden))
    assert font.startswith(b"\x00\x01\x00\x00"), "a TrueType font"
    assert '<w:family w:val="modern"/><w:pitch w:val="fixed"/>' in fonts
    assert b"<w:embedTrueTypeFonts" in files["word/settings.xml"]
    xml = files["word/document.xml"].decode() + files["word/styles.xml"].decode()
    assert set(re.findall(r'w:ascii="([^"]+)"', xml)) == {"Calibri", CODE_FONT}


def _make_template(code_font: str) -> bytes:
    """Make a template with a table of fonts of its own, and a style for code where a font is named."""
    document = docx.Document()
    namespace = "http://schemas.openxmlformats.org/wordprocessingml/2006/main"
    table = f'<w:fonts xmlns:w="{namespace}"><w:font w:name="House Sans"/></w:fonts>'.encode()
    content_type = "application/vnd.openxmlformats-officedocument.wordprocessingml.fontTable+xml"
    part = Part(PackURI("/word/fontTable.xml"), content_type, table, document.part.package)
    for relation in [key for key, each in document.part.rels.items() if each.reltype == RELATIONSHIP_TYPE.FONT_TABLE]:
        del document.part.rels[relation]
    document.part.relate_to(part, RELATIONSHIP_TYPE.FONT_TABLE)
    if code_font:
        document.styles.add_style("Inline Code", 2).font.name = code_font
    stream = io.BytesIO()
    document.save(stream)
    return stream.getvalue()


def test_the_fonts_of_a_template_stay_beside_it() -> None:
    data, _ = write(OUTLINE, {}, template=_make_template(""), chapter_files=lambda _path: None)
    names = re.findall(r'<w:font [^>]*w:name="([^"]+)"', _read(data)["word/fontTable.xml"].decode())
    assert names == ["House Sans", CODE_FONT]


def test_code_takes_the_face_of_a_template_everywhere() -> None:
    files = _read(write(OUTLINE, {}, template=_make_template("House Mono"), chapter_files=lambda _path: None)[0])
    assert "word/fonts/archgen.odttf" not in files
    assert set(re.findall(r'<w:rFonts w:ascii="([^"]+)"', files["word/document.xml"].decode())) == {"House Mono"}
