"""What a document says about itself: title, subject, language. No clock and no person, so the same report is the same bytes."""

from __future__ import annotations

from docx.document import Document
from docx.opc.constants import CONTENT_TYPE, RELATIONSHIP_TYPE
from docx.opc.packuri import PackURI
from docx.opc.parts.coreprops import CorePropertiesPart
from docx.oxml.coreprops import CT_CoreProperties
from docx.package import Package

from archgen.emit.docx.word_xml import clean_line
from archgen.views.shapes import Outline

_MAX_LENGTH = 255
"""Characters that Word allows in a property; python-docx raises ValueError beyond them."""


def write_core_properties(document: Document, package: Package, outline: Outline) -> None:
    """Write the report's own properties. The template's are gone (see `template_repair`)."""
    # An empty part comes first: the one that python-docx would add says python-docx, and the time of day.
    part = CorePropertiesPart(
        PackURI("/docProps/core.xml"), CONTENT_TYPE.OPC_CORE_PROPERTIES, CT_CoreProperties.new(), package
    )
    package.relate_to(part, RELATIONSHIP_TYPE.CORE_PROPERTIES)
    properties = document.core_properties
    properties.title = clean_line(outline.title)[:_MAX_LENGTH]
    properties.subject = clean_line(outline.subtitle)[:_MAX_LENGTH]
    properties.language = clean_line(outline.language)[:_MAX_LENGTH]
