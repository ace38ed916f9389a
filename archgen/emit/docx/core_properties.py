"""What a document says about itself: title, number, authors, version, program. No clock: the same report, the same bytes."""

from __future__ import annotations

from docx.document import Document
from docx.opc.constants import CONTENT_TYPE, RELATIONSHIP_TYPE
from docx.opc.packuri import PackURI
from docx.opc.part import Part
from docx.opc.parts.coreprops import CorePropertiesPart
from docx.oxml.coreprops import CT_CoreProperties
from docx.package import Package

from archgen.emit.docx.word_xml import clean_line
from archgen.emit.own_file_marks import PROGRAM_NAME, PROGRAM_PART
from archgen.views.shapes import Outline

_MAX_LENGTH = 255
"""Characters that Word allows in a property; python-docx raises ValueError beyond them."""
_PROPERTY_NAMES = {"author": "authors", "category": "dissemination", "version": "version", "content_status": "status"}
"""Word's properties, and what the document says of itself under other names."""


def write_core_properties(document: Document, package: Package, outline: Outline) -> None:
    """Write the report's own properties. The template's are gone (see `template_repair`)."""
    # An empty part comes first: the one that python-docx would add says python-docx, and the time of day.
    part = CorePropertiesPart(
        PackURI("/docProps/core.xml"), CONTENT_TYPE.OPC_CORE_PROPERTIES, CT_CoreProperties.new(), package
    )
    package.relate_to(part, RELATIONSHIP_TYPE.CORE_PROPERTIES)
    properties = document.core_properties
    properties.title = clean_line(outline.title)[:_MAX_LENGTH]
    said = {name: clean_line(value)[:_MAX_LENGTH] for name, value in outline.properties.items()}
    # Word has no field for a document's number; its readers look for it in the subject.
    number = outline.properties.get("number", "")
    subject = f"{number} {outline.subtitle}".strip() if number else outline.subtitle
    properties.subject = clean_line(subject)[:_MAX_LENGTH]
    for name, key in _PROPERTY_NAMES.items():
        if said.get(key):
            setattr(properties, name, said[key])
    properties.language = clean_line(outline.language)[:_MAX_LENGTH]
    _write_program_name(package)


def _write_program_name(package: Package) -> None:
    """Say which program wrote the document, as all that write Word files do: by this its next version may replace it."""
    xml = (
        "<?xml version='1.0' encoding='UTF-8' standalone='yes'?>\n"
        '<Properties xmlns="http://schemas.openxmlformats.org/officeDocument/2006/extended-properties">'
        f"<Application>{PROGRAM_NAME}</Application></Properties>"
    )
    part = Part(PackURI(f"/{PROGRAM_PART}"), CONTENT_TYPE.OFC_EXTENDED_PROPERTIES, xml.encode(), package)
    package.relate_to(part, RELATIONSHIP_TYPE.EXTENDED_PROPERTIES)
