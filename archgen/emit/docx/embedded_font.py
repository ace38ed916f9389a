"""The face of code, which lies in the file itself: names stand in one face of fixed pitch, whoever opens the report."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from docx.document import Document
from docx.opc.constants import RELATIONSHIP_TYPE
from docx.opc.packuri import PackURI
from docx.opc.part import Part
from docx.oxml.ns import nsdecls, qn
from docx.oxml.parser import parse_xml
from lxml import etree

from archgen.emit.docx.style_table import StyleTable

CODE_FONT = "DejaVu Sans Mono"
_FONT_TABLE_TYPE = "application/vnd.openxmlformats-officedocument.wordprocessingml.fontTable+xml"
_FONT_TYPE = "application/vnd.openxmlformats-officedocument.obfuscatedFont"
_FONT_RELATION = "http://schemas.openxmlformats.org/officeDocument/2006/relationships/font"
_KEY = "5A1D8C0E-3B7F-4E52-9C61-A7D20F4B8E13"
_HIDDEN_BYTES = 32
_BEFORE_EMBEDDING = ("writeProtection", "view", "zoom", "removePersonalInformation", "removeDateAndTime",
    "doNotDisplayPageBoundaries", "displayBackgroundShape", "printPostScriptOverText", "printFractionalCharacterWidth",
    "printFormsData")  # fmt: skip
"""What stands before the word that fonts are embedded (ECMA-376 17.15.1.78)."""


def embed_code_font(document: Document, styles: StyleTable) -> None:
    """Put the face of code into the package, if its style is set in that face: a template may have another."""
    if styles.find_font("Inline Code") != CODE_FONT:
        return
    part = document.part
    old = next((each for each in part.rels.values() if each.reltype == RELATIONSHIP_TYPE.FONT_TABLE), None)
    root = _read_fonts(old.target_part.blob if old else b"")
    if any(each.get(qn("w:name")) == CODE_FONT for each in root.iterfind(qn("w:font"))):
        return
    # The id is one that no other font of a template's table has.
    relation_id = "archgenFont"
    root.append(
        parse_xml(
            f'<w:font {nsdecls("w", "r")} w:name="{CODE_FONT}"><w:altName w:val="Consolas"/><w:charset w:val="00"/>'
            '<w:family w:val="modern"/><w:pitch w:val="fixed"/>'
            f'<w:embedRegular r:id="{relation_id}" w:fontKey="{{{_KEY}}}"/></w:font>'
        )
    )
    data = etree.tostring(root, xml_declaration=True, encoding="UTF-8", standalone=True)
    name = old.target_part.partname if old else PackURI("/word/fontTable.xml")
    filled = Part(name, _FONT_TABLE_TYPE, data, part.package)
    for relation in old.target_part.rels.values() if old else ():
        target = relation.target_ref if relation.is_external else relation.target_part
        filled.load_rel(relation.reltype, target, relation.rId, relation.is_external)
    font = Part(PackURI("/word/fonts/archgen.odttf"), _FONT_TYPE, _hide_font(), part.package)
    filled.load_rel(_FONT_RELATION, font, relation_id)
    if old:
        part.load_rel(RELATIONSHIP_TYPE.FONT_TABLE, filled, old.rId)
    else:
        part.relate_to(filled, RELATIONSHIP_TYPE.FONT_TABLE)
    settings = document.settings.element
    if settings.find(qn("w:embedTrueTypeFonts")) is None:
        before = {qn(f"w:{each}") for each in _BEFORE_EMBEDDING}
        place = sum(item.tag in before for item in settings)
        settings.insert(place, parse_xml(f"<w:embedTrueTypeFonts {nsdecls('w')}/>"))


def _read_fonts(data: bytes) -> etree._Element:
    """Return the table of a template's fonts, an empty one where it has none that can be read."""
    empty = parse_xml(f"<w:fonts {nsdecls('w', 'r')}/>")
    try:
        root = parse_xml(data) if data else empty
    except etree.XMLSyntaxError:
        return empty
    return root if root.tag == qn("w:fonts") else empty


@cache
def _hide_font() -> bytes:
    """Return the font as Word wants it: its first bytes mixed with the key (ECMA-376 17.8.1)."""
    data = bytearray((Path(__file__).resolve().parent / "fonts" / "DejaVuSansMono.ttf").read_bytes())
    key = bytes.fromhex(_KEY.replace("-", ""))[::-1]
    for at in range(_HIDDEN_BYTES):
        data[at] ^= key[at % len(key)]
    return bytes(data)
