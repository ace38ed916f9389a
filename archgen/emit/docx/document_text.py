"""The text of the document: the template's cover, the title page and the pieces on their sheets, put together."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Iterator, Sequence

from docx.oxml.ns import qn
from lxml import etree

from archgen.emit.docx.docx_writer import DocxWriter
from archgen.emit.docx.page_flow import FlowPiece
from archgen.emit.docx.report_template import ReportTemplate
from archgen.emit.docx.word_xml import MC, NAMESPACES, fill_labels

_BODY_MARK = "<!--body-->"
_IGNORABLE = f"{{{MC}}}Ignorable"


def format_document(
    template: ReportTemplate, writer: DocxWriter, title_page: Sequence[FlowPiece], main: Sequence[FlowPiece]
) -> str:
    """Return the XML of the document."""
    frame = _format_frame(template.document.element)
    body = "".join(_iter_body(template, writer, title_page, main))
    return frame.replace(_BODY_MARK, fill_labels(body, writer.list_labels()))


def _iter_body(
    template: ReportTemplate, writer: DocxWriter, title_page: Sequence[FlowPiece], main: Sequence[FlowPiece]
) -> Iterator[str]:
    """Yield what the body holds: cover, title page, pieces with the paper turning between them, and what closes the document."""
    paper = writer.paper
    # The title page (or a cover) has the template's own section, with its first page without a header.
    opening = paper.section
    if template.before:
        yield from _format_elements(template.before)
        yield _format_section_end(opening)
        opening = paper.create_section_properties(paper.base)
    # A cover may show all that the title page has: then there is none.
    if title_page or not template.before:
        yield from (piece.xml for piece in title_page)
        yield _format_section_end(opening)
    sheet = (main[0].sheet if main else None) or paper.base
    for index, piece in enumerate(main):
        sheet = piece.sheet or paper.base
        after = main[index + 1].sheet if index + 1 < len(main) else sheet
        turns = after and after != sheet
        if not turns:
            yield piece.xml
        elif piece.marks or piece.xml.endswith("</w:tbl>"):
            # LibreOffice loses the bookmarks of a paragraph that ends a section: a reference to its number would be empty.
            yield piece.xml
            yield _format_section_end(paper.create_section_properties(sheet))
        else:
            place = piece.xml.rindex("</w:pPr>")
            yield f"{piece.xml[:place]}{_format_element(paper.create_section_properties(sheet))}{piece.xml[place:]}"
    if template.after:
        if sheet != paper.base:
            yield _format_section_end(paper.create_section_properties(sheet))
            sheet = paper.base
        yield from _format_elements(template.after)
    # The last section's properties are the body's own (ECMA-376 17.6.17).
    yield _format_element(paper.create_section_properties(sheet))


def _format_section_end(section: etree._Element) -> str:
    """Return a paragraph of one point, as good as unseen, that ends a section."""
    spacing = '<w:spacing w:before="0" w:after="0" w:line="20" w:lineRule="exact"/>'
    return f"<w:p><w:pPr>{spacing}{_format_element(section)}</w:pPr></w:p>"


def _format_elements(elements: Iterable[etree._Element]) -> Iterator[str]:
    """Yield a template's own elements as they stand there."""
    return (_format_element(element) for element in elements)


def _format_element(element: etree._Element) -> str:
    return etree.tostring(element, encoding="unicode", with_tail=False)


def _format_frame(root: etree._Element) -> str:
    """Return the document element with a mark in the place of its body: the template's namespaces and ours.

    It is made anew, because lxml adds no namespaces to an element that exists.
    """
    namespaces = {prefix: name for prefix, name in root.nsmap.items() if prefix and prefix not in NAMESPACES}
    namespaces |= NAMESPACES
    frame = etree.Element(qn("w:document"), nsmap=namespaces)
    # Word skips what it does not know only where the prefixes in mc:Ignorable are declared, and refuses the file otherwise.
    ignorable = [prefix for prefix in root.get(_IGNORABLE, "").split() if prefix in namespaces]
    frame.set(_IGNORABLE, " ".join(dict.fromkeys([*ignorable, "w16se"])))
    background = root.find(qn("w:background"))
    if background is not None:
        frame.append(copy.deepcopy(background))
    etree.SubElement(frame, qn("w:body")).append(etree.Comment("body"))
    return etree.tostring(frame, encoding="unicode")
