"""The document that a report is written into: archgen's own template, or a partner's with its styles, cover, headers and paper.

What stands in a partner's template comes before the report as its cover, up to a paragraph `{{report}}` if there is one; what
stands behind that paragraph closes the document.
"""

from __future__ import annotations

import io
from dataclasses import dataclass
from typing import cast

import docx
from docx.document import Document
from docx.oxml.ns import qn
from docx.package import Package
from lxml import etree

from archgen import resources
from archgen.emit.docx.template_checks import TemplateError, unpack_template
from archgen.emit.docx.template_repair import repair_package

_REPORT_MARK = "{{report}}"
_VISIBLE_TAGS = [
    qn(f"w:{name}") for name in ("t", "drawing", "pict", "object", "sym", "fldSimple", "instrText", "sdt", "tbl")
]


@dataclass(frozen=True, slots=True)
class ReportTemplate:
    """An opened template. `before` and `after` are what stands in it around the report, `section` its last section properties."""

    document: Document
    before: tuple[etree._Element, ...]
    after: tuple[etree._Element, ...]
    section: etree._Element | None

    @property
    def package(self) -> Package:
        """Return the package that holds all parts."""
        return cast("Package", self.document.part.package)


def open_template(data: bytes | None) -> ReportTemplate:
    """Return a partner's template, or archgen's own for None. Raise TemplateError if it cannot be used."""
    if data is None:
        # python-docx opens a folder as it opens a zip, so ours lies unpacked, where it can be read and compared.
        document = docx.Document(str(resources.resource_path("backends", "report", "template")))
    else:
        document = _open_document(repair_package(unpack_template(data)))
    # Nobody sees comments, and their `tag` is no text.
    etree.strip_tags(document.element, etree.Comment, etree.ProcessingInstruction)
    body = document.element.body
    section = body.find(qn("w:sectPr"))
    if section is not None:
        body.remove(section)
    before, after = _split_body(list(body))
    return ReportTemplate(document, before, after, section)


def _open_document(data: bytes) -> Document:
    try:
        return docx.Document(io.BytesIO(data))
    # What python-docx raises for files that are damaged in ways that nobody has thought of; it has no error of its own for them.
    # It walks from part to part by recursion: a chain of a thousand parts is too long.
    except (KeyError, ValueError, AttributeError, TypeError, RecursionError, etree.XMLSyntaxError) as error:
        message = f"the template is damaged: it cannot be opened as a Word document ({error})"
        raise TemplateError(message) from None


def _split_body(
    children: list[etree._Element],
) -> tuple[tuple[etree._Element, ...], tuple[etree._Element, ...]]:
    """Return what stands before and behind the report. A body that shows nothing is no cover."""
    if not any(True for child in children for _ in child.iter(*_VISIBLE_TAGS)):
        return (), ()
    for index, child in enumerate(children):
        text = "".join(item.text or "" for item in child.iter(qn("w:t")))
        if child.tag == qn("w:p") and text.strip().casefold() == _REPORT_MARK:
            return tuple(children[:index]), tuple(children[index + 1 :])
    return tuple(children), ()
