"""The document that a report is written into: archgen's own template, or a partner's with its styles, cover, headers and paper.

What stands in a partner's template comes before the report as its cover, up to a paragraph `{{report}}` if there is one; what
stands behind that paragraph closes the document.

A template is mended so that python-docx opens what Word opens: it refuses .dotx files, and raises KeyError for a part without a
content type.
"""

from __future__ import annotations

import copy
import io
import posixpath
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import cast
from urllib.parse import unquote

import docx
from docx.document import Document
from docx.opc.constants import CONTENT_TYPE, NAMESPACE, RELATIONSHIP_TYPE
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
from archgen.emit.docx.page_flow import measure_paper
from archgen.emit.docx.style_table import match_styles
from archgen.emit.picture import Picture
from archgen.emit.template_package import TemplateError, parse_part, read_content_types, unpack_template, zip_parts
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
        raise TemplateError(f"the template is damaged: it cannot be opened as a Word document ({error})") from None


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


_PACKAGE_RELATIONS = "_rels/.rels"
_ROOT_TAG = f"{{{NAMESPACE.OPC_RELATIONSHIPS}}}Relationships"
_SINGLE_KINDS = {
    "styles": CONTENT_TYPE.WML_STYLES,
    "numbering": CONTENT_TYPE.WML_NUMBERING,
    "settings": CONTENT_TYPE.WML_SETTINGS,
}
"""Parts of which a document has one, by the last word of the relationship's type; their root bears the same name."""
_KIND_TYPES = _SINGLE_KINDS | {"header": CONTENT_TYPE.WML_HEADER, "footer": CONTENT_TYPE.WML_FOOTER}


def _find_main_target(parts: dict[str, bytes]) -> str:
    """Return the name of the part that the package calls its document, empty if it calls none so."""
    relations = _parse_relations(parts, _PACKAGE_RELATIONS) if _PACKAGE_RELATIONS in parts else ()
    targets = (
        _resolve_target("", item.get("Target", ""))
        for item in relations
        if _read_relation_kind(item) == "officeDocument" and not _is_external(item)
    )
    return next(targets, "")


def _repair_relations(parts: dict[str, bytes], types: dict[str, str], main: str) -> None:
    """Mend the relationships of the package, of its document and of all other parts; `types` are the parts' content types."""
    for name in [name for name in parts if "_rels/" in name and name.endswith(".rels")]:
        root = _parse_relations(parts, name)
        folder, file = posixpath.split(name)
        source = posixpath.join(posixpath.dirname(folder), file.removesuffix(".rels"))
        if name == _PACKAGE_RELATIONS:
            _repair_package_relations(root, parts, main)
        elif source == main:
            _repair_main_relations(root, parts, types, main)
        else:
            _repair_other_relations(root, parts, source)
        parts[name] = etree.tostring(root)


def _parse_relations(parts: dict[str, bytes], name: str) -> etree._Element:
    """Return the root of a part of relationships, with each id once; an empty one if the part holds something else."""
    root = parse_part(parts[name], name)
    if root.tag != _ROOT_TAG:
        return etree.fromstring(f'<Relationships xmlns="{NAMESPACE.OPC_RELATIONSHIPS}"/>')
    ids = {""}
    for item in list(root):
        if item.get("Id", "") in ids:
            root.remove(item)
        ids.add(item.get("Id", ""))
    return root


def _repair_package_relations(root: etree._Element, parts: dict[str, bytes], main: str) -> None:
    """Keep of the package's relationships the document, and custom properties, which a cover's fields may show.

    The template's title, author, dates and preview are not the report's: python-docx never reads them.
    """
    kinds = {"officeDocument", "custom-properties"}
    for item in list(root):
        kind, target = _read_relation_kind(item), _resolve_target("", item.get("Target", ""))
        if kind not in kinds or target not in parts or _is_external(item):
            root.remove(item)
            continue
        kinds.remove(kind)
        item.set("Target", f"/{target}")
        if target == main:
            item.set("Type", RELATIONSHIP_TYPE.OFFICE_DOCUMENT)


def _repair_main_relations(root: etree._Element, parts: dict[str, bytes], types: dict[str, str], main: str) -> None:
    """Drop what leads nowhere from the document's relationships, and let parts be of the kind that they are used as."""
    single_kinds: set[str] = set()
    for item in [item for item in root if not _is_external(item)]:
        kind, target = _read_relation_kind(item), _resolve_target(posixpath.dirname(main), item.get("Target", ""))
        if target not in parts or kind in single_kinds or not _fits_kind(parts, target, kind):
            root.remove(item)
            continue
        item.set("Target", f"/{target}")
        if kind in _KIND_TYPES:
            item.set("Type", f"{NAMESPACE.OFC_RELATIONSHIPS}/{kind}")
            types[target] = _KIND_TYPES[kind]
        if kind in _SINGLE_KINDS:
            single_kinds.add(kind)


def _repair_other_relations(root: etree._Element, parts: dict[str, bytes], source: str) -> None:
    """Let relationships of headers and the like that lead nowhere point outside of the file.

    They cannot go: a header's drawing still names them, and a name without a relationship is a damaged file to Word.
    """
    for item in [item for item in root if not _is_external(item)]:
        target = _resolve_target(posixpath.dirname(source), item.get("Target", ""))
        if target in parts:
            item.set("Target", f"/{target}")
        else:
            item.set("TargetMode", "External")


def _fits_kind(parts: dict[str, bytes], name: str, kind: str) -> bool:
    """Tell whether a part that should be styles, numbering or settings is that."""
    return kind not in _SINGLE_KINDS or parse_part(parts[name], name).tag == qn(f"w:{kind}")


def _is_external(relation: etree._Element) -> bool:
    return relation.get("TargetMode") == "External"


def _read_relation_kind(relation: etree._Element) -> str:
    """Return the last word of a relationship's type: `styles`, `image`, `hyperlink`."""
    return relation.get("Type", "").rpartition("/")[2]


def _resolve_target(folder: str, target: str) -> str:
    """Return the name of the part that a relationship's target means; python-docx does not know percent signs."""
    path = unquote(target.partition("#")[0])
    joined = path if path.startswith("/") else posixpath.join("/", folder, path)
    return posixpath.normpath(joined).lstrip("/")


_TEMPLATE_MAIN = "application/vnd.openxmlformats-officedocument.wordprocessingml.template.main+xml"
_STRICT_DOCUMENT = "{http://purl.oclc.org/ooxml/wordprocessingml/main}document"
_PARSED_TYPES = {*_KIND_TYPES.values(), CONTENT_TYPE.WML_COMMENTS}
"""Content types that python-docx parses as soon as it opens a file, beside the main part."""


def repair_package(parts: dict[str, bytes]) -> bytes:
    """Return a template as a package that python-docx opens. Raise TemplateError if it is no Word document."""
    types = read_content_types(parts)
    main = _find_main_part(parts, types)
    _check_document(parts, main)
    # A .dotx differs from a .docx in this alone.
    types[main] = CONTENT_TYPE.WML_DOCUMENT_MAIN
    _repair_relations(parts, types, main)
    for name, content_type in types.items():
        if content_type in _PARSED_TYPES:
            parse_part(parts[name], name)
    return zip_parts(parts, types)


def _find_main_part(parts: dict[str, bytes], types: dict[str, str]) -> str:
    """Return the name of the part that holds the document."""
    main = _find_main_target(parts)
    if main not in parts or types[main] not in {CONTENT_TYPE.WML_DOCUMENT_MAIN, _TEMPLATE_MAIN}:
        message = "the template is no Word file: its main part is not a Word document (.docx) or template (.dotx)"
        raise TemplateError(message)
    return main


def _check_document(parts: dict[str, bytes], main: str) -> None:
    root = parse_part(parts[main], main)
    if root.tag == _STRICT_DOCUMENT:
        message = 'the template is a "Strict Open XML Document": save it as an ordinary Word document (.docx)'
        raise TemplateError(message)
    if root.tag != qn("w:document") or root.find(qn("w:body")) is None:
        raise TemplateError(f"the template is no Word file: its part `{main}` holds no document")
