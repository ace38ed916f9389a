"""The parts beside the text that a report writes into: styles, numbering, settings, pictures, and the document itself."""

from __future__ import annotations

import copy
from typing import cast

from docx.document import Document
from docx.opc.constants import CONTENT_TYPE, RELATIONSHIP_TYPE
from docx.opc.packuri import PackURI
from docx.opc.part import XmlPart
from docx.oxml.ns import nsdecls, qn
from docx.oxml.parser import parse_xml
from docx.package import Package
from docx.parts.document import DocumentPart
from docx.parts.numbering import NumberingPart
from docx.parts.styles import StylesPart
from lxml import etree

from archgen import resources

_UNWANTED_SETTINGS = ("updateFields", "attachedTemplate", "mailMerge", "documentProtection", "writeProtection")
"""Settings that make Word ask a question, fetch something, or lock the report."""
_UNWANTED_RELATIONS = ("/attachedTemplate", "/mailMergeSource", "/mailMergeHeaderSource")


def read_own_styles() -> etree._Element:
    """Return the styles of archgen's own template."""
    return parse_xml(resources.resource_path("backends", "report", "template", "word", "styles.xml").read_bytes())


def find_styles(document: Document, own_styles: etree._Element) -> etree._Element:
    """Return the root of a document's styles; new ones with our defaults alone where it has none.

    python-docx would add its own styles, and then no reader could tell what the template lacked.
    """
    part = _find_part(document, RELATIONSHIP_TYPE.STYLES)
    if part is None:
        root = parse_xml(f"<w:styles {nsdecls('w')}/>")
        root.extend(copy.deepcopy(own_styles.findall(qn("w:docDefaults"))))
        part = StylesPart(_name_part(document, "styles"), CONTENT_TYPE.WML_STYLES, root, _find_package(document))
        document.part.relate_to(part, RELATIONSHIP_TYPE.STYLES)
    styles: etree._Element = part.element
    return styles


def find_numbering(document: Document) -> etree._Element:
    """Return the root of a document's numbering, an empty one where it has none: `NumberingPart.new` is not implemented."""
    part = _find_part(document, RELATIONSHIP_TYPE.NUMBERING)
    if part is None:
        root = parse_xml(f"<w:numbering {nsdecls('w')}/>")
        part = NumberingPart(
            _name_part(document, "numbering"), CONTENT_TYPE.WML_NUMBERING, root, _find_package(document)
        )
        document.part.relate_to(part, RELATIONSHIP_TYPE.NUMBERING)
    numbering: etree._Element = part.element
    return numbering


def clean_settings(document: Document) -> None:
    """Take out of a document's settings what asks questions, fetches or locks."""
    root = document.settings.element  # python-docx adds settings where a template has none
    part = document.part.part_related_by(RELATIONSHIP_TYPE.SETTINGS)
    for name in _UNWANTED_SETTINGS:
        for item in root.findall(qn(f"w:{name}")):
            root.remove(item)
    # A relationship is enough for Word to look for the partner's file.
    for relation_id in [key for key, item in part.rels.items() if item.reltype.endswith(_UNWANTED_RELATIONS)]:
        del part.rels[relation_id]


def replace_document_text(document: Document, xml: str) -> None:
    """Parse the text of the document, and put it in the place of the document's part.

    The text is not moved into the tree that stands there: lxml's `append` of a parsed table takes a time that grows with
    the square of its rows (0.8 s for 1,000 rows, 12 s for 4,000; 7.7 s for the body of example_ramcip), parsing takes 0.06 s.
    """
    old, package = document.part, _find_package(document)
    new = DocumentPart.load(old.partname, old.content_type, xml.encode(), package)
    # With their ids, which stand in the text.
    for relation in old.rels.values():
        target = relation.target_ref if relation.is_external else relation.target_part
        new.load_rel(relation.reltype, target, relation.rId, relation.is_external)
    for relation in list(package.rels.values()):
        if relation.reltype == RELATIONSHIP_TYPE.OFFICE_DOCUMENT:
            package.load_rel(relation.reltype, new, relation.rId)


def _find_part(document: Document, relation_type: str) -> XmlPart | None:
    try:
        return cast("XmlPart", document.part.part_related_by(relation_type))
    except KeyError:
        return None


def _name_part(document: Document, kind: str) -> PackURI:
    return PackURI(f"{document.part.partname.baseURI.rstrip('/')}/archgen-{kind}.xml")


def _find_package(document: Document) -> Package:
    return cast("Package", document.part.package)
