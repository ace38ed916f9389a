"""How a report begins in a template: styles and numbering completed, paper measured, and what the template lacks."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from docx.oxml.ns import qn
from lxml import etree

from archgen.emit.docx.document_parts import find_numbering, find_styles, read_own_styles
from archgen.emit.docx.docx_writer import DocxWriter
from archgen.emit.docx.list_numbering import prepare_numbering
from archgen.emit.docx.paper_sheets import measure_paper
from archgen.emit.docx.report_template import ReportTemplate
from archgen.emit.docx.style_table import match_styles
from archgen.emit.picture import Picture

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
    own_styles = read_own_styles()
    styles = match_styles(find_styles(document, own_styles), own_styles)
    if language:
        _write_language(styles.root, language)
    return DocxWriter(
        document=document,
        styles=styles,
        numbering=prepare_numbering(find_numbering(document), styles),
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
