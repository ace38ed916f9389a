"""Names in double braces in a template ({{title}}, {{subtitle}}, lines of the title page such as {{version}}, {{contents}}), filled in."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence

from docx.opc.constants import RELATIONSHIP_TYPE
from docx.opc.part import XmlPart
from docx.oxml.ns import qn
from docx.oxml.parser import parse_xml
from lxml import etree

from archgen.emit.docx.report_template import ReportTemplate
from archgen.emit.docx.word_xml import NAMESPACES
from archgen.emit.office_package import replace_forbidden
from archgen.frozen import replace

_PLACEHOLDER = re.compile(r"\{\{(?:\s++(?!\}\}))?+([^{}]{1,80}?)(?:(?<!\s)\s++)?+\}\}")
_CONTENTS_MARK = "{{contents}}"
_XML_SPACE = "{http://www.w3.org/XML/1998/namespace}space"


def fill_placeholders(
    template: ReportTemplate, values: Mapping[str, str], contents_mark: int | None = None
) -> tuple[tuple[str, str], ...]:
    """Write values in the place of their names, in headers and footers too.

    `contents_mark` is the place on the cover that the contents will take. Return the names without a value, sorted, each with the words for its place.
    """
    cover = [element for index, element in enumerate(template.before) if index != contents_mark]
    places = (
        ("on its cover", cover),
        ("behind the report", template.after),
        ("in a header or footer", _iter_headers(template)),
    )
    unknown: set[tuple[str, str]] = set()
    for place, roots in places:
        for paragraph in (paragraph for root in roots for paragraph in root.iter(qn("w:p"))):
            unknown.update((name, place) for name in _fill_paragraph(paragraph, values))
    return tuple(sorted(unknown))


def find_contents_mark(elements: Sequence[etree._Element]) -> int | None:
    """Return the place of the paragraph that is nothing but `{{contents}}`, None where there is none."""
    for index, element in enumerate(elements):
        text = "".join(item.text or "" for item in element.iter(qn("w:t")))
        if element.tag == qn("w:p") and text.strip().casefold() == _CONTENTS_MARK:
            return index
    return None


def place_contents(template: ReportTemplate, index: int, contents_xml: str) -> ReportTemplate:
    """Return a template with the contents in the place of a paragraph on its cover."""
    namespaces = " ".join(f'xmlns:{prefix}="{name}"' for prefix, name in NAMESPACES.items())
    body = parse_xml(f"<w:body {namespaces}>{contents_xml}</w:body>")
    return replace(template, before=(*template.before[:index], *body, *template.before[index + 1 :]))


def find_placeholders(elements: Iterable[etree._Element]) -> frozenset[str]:
    """Return the names in double braces that stand in some elements."""
    text = "\n".join(
        "".join(item.text or "" for item in paragraph.iter(qn("w:t")))
        for element in elements
        for paragraph in element.iter(qn("w:p"))
    )
    return frozenset(match.casefold() for match in _PLACEHOLDER.findall(text))


def _iter_headers(template: ReportTemplate) -> Iterator[etree._Element]:
    """Yield the root of each header and footer, those of the template's earlier sections too."""
    for relation in template.document.part.rels.values():
        if relation.reltype in {RELATIONSHIP_TYPE.HEADER, RELATIONSHIP_TYPE.FOOTER} and not relation.is_external:
            part = relation.target_part
            if isinstance(part, XmlPart):
                yield part.element


def _fill_paragraph(paragraph: etree._Element, values: Mapping[str, str]) -> list[str]:
    """Write values in the place of their names. Return the names without a value."""
    # A text box in a paragraph has paragraphs of its own.
    texts = [item for item in paragraph.iter(qn("w:t")) if next(item.iterancestors(qn("w:p")), None) is paragraph]
    whole = "".join(item.text or "" for item in texts)
    if "{{" not in whole or not _PLACEHOLDER.search(whole):
        return []
    # Whatever the case: Word writes a capital where a sentence begins.
    unknown = [name for name in _PLACEHOLDER.findall(whole) if name.casefold() not in values]
    # Word cuts a name into several runs as it pleases: then the paragraph's text goes into the first.
    if all(_PLACEHOLDER.sub("", item.text or "").count("{{") == 0 for item in texts):
        for item in texts:
            _write_text(item, _replace_names(item.text or "", values))
    else:
        _write_text(texts[0], _replace_names(whole, values))
        for item in texts[1:]:
            item.text = ""
    return unknown


def _replace_names(text: str, values: Mapping[str, str]) -> str:
    return _PLACEHOLDER.sub(lambda match: replace_forbidden(values.get(match[1].casefold(), "")), text)


def _write_text(item: etree._Element, text: str) -> None:
    item.text = text
    item.set(_XML_SPACE, "preserve")
