"""The document that a report is written into: archgen's own template, or a partner's with its styles, cover, headers and paper.

What stands in a partner's template comes before the report as its cover, up to a paragraph `{{report}}` if there is one; what
stands behind that paragraph closes the document.
"""

from __future__ import annotations

import copy
import io
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import cast

import docx
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
from archgen.emit.docx.docx_writer import DocxWriter
from archgen.emit.docx.list_numbering import prepare_numbering
from archgen.emit.docx.paper_sheets import measure_paper
from archgen.emit.docx.style_table import match_styles
from archgen.emit.docx.template_repair import repair_package
from archgen.emit.picture import Picture
from archgen.emit.template_package import TemplateError, unpack_template
from archgen.frozen import dataclass

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


_NUMBERED_TAGS = [qn("w:bookmarkStart"), qn("wp:docPr"), qn("pic:cNvPr")]
_LOCALES = {"en": "en-GB", "de": "de-DE", "fr": "fr-FR", "it": "it-IT", "es": "es-ES", "el": "el-GR"}
_MAX_ID = 2**30
"""Word finds ids from 2**31 damaged; a template's that are near to it are not counted on from."""


def create_writer(
    template: ReportTemplate,
    pictures: Mapping[str, Picture],
    chapter_files: Callable[[str], bytes | None],
    anchors: frozenset[str],
    language: str,
) -> DocxWriter:
    """Return the writer of a report in a template, whose text is in a language (of two letters; empty for the template's)."""
    document = template.document
    own_styles = parse_xml(resources.resource_path("backends", "report", "template", "word", "styles.xml").read_bytes())
    styles = match_styles(_find_styles(document, own_styles), own_styles)
    if language:
        _write_language(styles.root, language)
    return DocxWriter(
        document=document,
        styles=styles,
        numbering=prepare_numbering(_find_numbering(document), styles),
        paper=measure_paper(template.section, document.part.rels.keys(), document.part),
        pictures=pictures,
        chapter_files=chapter_files,
        anchors=anchors,
        part_names={str(part.partname) for part in template.package.iter_parts()},
        last_id=_find_last_id((*template.before, *template.after)),
    )


def warn_of_template(writer: DocxWriter, unknown_names: Sequence[tuple[str, str]]) -> None:
    """Warn of what a partner's template lacks, and of what it asks for in vain."""
    if writer.styles.added:
        names = ", ".join(f"`{name}`" for name in writer.styles.added)
        writer.warn(f"the template has no style {names}: archgen's own took the place")
    for name, place in unknown_names:
        # The contents are a list of paragraphs: they fit on no line with other words, and in no header.
        advice = " (it goes into a paragraph of its own on the cover)" if name.casefold() == "contents" else ""
        writer.warn(
            f"the template asks for {{{{{name}}}}} {place}, which the report does not have: it stays empty{advice}"
        )
    relations = writer.document.part.rels.values()
    kinds = {item.reltype.rpartition("/")[2] for item in relations if item.is_external} - {"hyperlink"}
    if kinds:
        writer.warn(
            f"the template points at files outside of itself ({', '.join(sorted(kinds))}): Word may ask for them"
        )


def _write_language(styles: etree._Element, language: str) -> None:
    path = "/".join(map(qn, ("w:docDefaults", "w:rPrDefault", "w:rPr", "w:lang")))
    for item in styles.iterfind(path):
        item.set(qn("w:val"), _LOCALES.get(language, language))


def _find_last_id(elements: Iterable[etree._Element]) -> int:
    """Return the highest id that a template's own bookmarks and drawings have."""
    ids = (
        item.get("id") or item.get(qn("w:id")) or "0" for element in elements for item in element.iter(*_NUMBERED_TAGS)
    )
    return max((int(number) for number in ids if number.isdecimal() and int(number) < _MAX_ID), default=0)


_UNWANTED_SETTINGS = ("updateFields", "attachedTemplate", "mailMerge", "documentProtection", "writeProtection")
"""Settings that make Word ask a question, fetch something, or lock the report."""
_UNWANTED_RELATIONS = ("/attachedTemplate", "/mailMergeSource", "/mailMergeHeaderSource")


def _find_styles(document: Document, own_styles: etree._Element) -> etree._Element:
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


def _find_numbering(document: Document) -> etree._Element:
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
