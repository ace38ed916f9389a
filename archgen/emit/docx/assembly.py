"""Puts a report together: the template, the title page, and the pieces on their sheets become the parts of the package."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from lxml import etree

from archgen.emit.docx import numbering, sheets, styles
from archgen.emit.docx.draft import Draft
from archgen.emit.docx.flow import Piece
from archgen.emit.docx.markup import MC, NAMESPACES, R
from archgen.emit.docx.package import relations_name
from archgen.emit.docx.styles import tag
from archgen.emit.docx.template import Template, own_styles, settings
from archgen.emit.picture import Picture

_IDS = (tag("bookmarkStart"), f"{{{NAMESPACES['wp']}}}docPr", f"{{{NAMESPACES['pic']}}}cNvPr")
_HEAD = '<?xml version="1.0" encoding="UTF-8" standalone="yes"?>\n'
_BODY = "<!--body-->"
_LANGUAGES = {"en": "en-GB", "de": "de-DE", "fr": "fr-FR", "it": "it-IT", "es": "es-ES", "el": "el-GR"}
_OUTSIDE = {"hyperlink"}


def draft(
    template: Template,
    pictures: Mapping[str, Picture],
    chapter_files: Callable[[str], bytes | None],
    anchors: frozenset[str],
    *,
    language: str,
) -> Draft:
    """Begin a report in a template: styles and numbering settled, paper measured."""
    own = own_styles()
    root = template.tree("styles")
    settled = styles.settle(_bare(own) if root is None else root, own)
    if language:
        _speak(settled.root, language)
    return Draft(
        package=template.package,
        folder=template.folder,
        relations=template.relations,
        styles=settled,
        numbering=numbering.settle(template.tree("numbering"), settled),
        sheets=sheets.measure(template.section, frozenset(relation.id for relation in template.relations)),
        pictures=pictures,
        chapter_files=chapter_files,
        anchors=anchors,
        next_id=_highest((*template.before, *template.after)),
    )


def report_template(draft: Draft, unknown: Sequence[str]) -> None:
    """Say what a partner's template lacks, and what it asks for in vain."""
    if draft.styles.added:
        names = ", ".join(f"`{name}`" for name in draft.styles.added)
        draft.warn(f"the template has no style {names}: archgen's own took the place")
    for name in unknown:
        draft.warn(f"the template asks for {{{{{name}}}}}, which the report does not have: it stays empty")
    outside = sorted({relation.kind for relation in draft.relations if relation.external} - _OUTSIDE)
    if outside:
        draft.warn(f"the template points at files outside of itself ({', '.join(outside)}): Word may ask for them")


def finish(template: Template, draft: Draft, first: Sequence[Piece], rest: Sequence[Piece]) -> None:
    """Write the parts: document, styles, numbering, settings, relationships."""
    children = "".join(_children(template, draft, first, rest))
    frame = _frame(template.root).decode()
    template.package.parts[template.main] = (_HEAD + frame.replace(_BODY, children)).encode()
    template.replace("styles", draft.styles.root, f"{R}/styles")
    template.replace("numbering", draft.numbering.root, f"{R}/numbering")
    template.replace("settings", settings(template), f"{R}/settings")
    template.package.relate(template.main, template.relations)
    template.package.types.pop(relations_name(template.main), None)


def _children(template: Template, draft: Draft, first: Sequence[Piece], rest: Sequence[Piece]) -> Iterator[str]:
    """Give what the body holds: cover, title page, pieces with the paper turning between them, and what closes the document."""
    opening = draft.sheets.section
    if template.before:
        yield from _verbatim(template.before)
        yield _section_end(opening)
        opening = draft.sheets.properties(draft.sheets.base)
    yield from (piece.xml for piece in first)
    following = rest[0].sheet if rest and rest[0].sheet else draft.sheets.base
    yield _section_end(opening)
    sheet = following
    for index, piece in enumerate(rest):
        xml = piece.xml
        after = rest[index + 1].sheet if index + 1 < len(rest) else sheet
        sheet = piece.sheet or draft.sheets.base
        yield _closing(xml, draft.sheets.properties(sheet)) if after and after != sheet else xml
    if template.after:
        if sheet != draft.sheets.base:
            yield _section_end(draft.sheets.properties(sheet))
            sheet = draft.sheets.base
        yield from _verbatim(template.after)
    yield _text(draft.sheets.properties(sheet))


def _closing(xml: str, section: etree._Element) -> str:
    """Let a piece's last paragraph end a section. Properties of a paragraph end with those of its section."""
    place = xml.rindex("</w:pPr>")
    return f"{xml[:place]}{_text(section)}{xml[place:]}"


def _section_end(section: etree._Element) -> str:
    """Give a paragraph as good as unseen that ends a section."""
    spacing = '<w:spacing w:before="0" w:after="0" w:line="20" w:lineRule="exact"/>'
    return f"<w:p><w:pPr>{spacing}{_text(section)}</w:pPr></w:p>"


def _verbatim(elements: Iterable[etree._Element]) -> Iterator[str]:
    """Give a template's own elements as they stand there."""
    for element in elements:
        clone = copy.deepcopy(element)
        clone.tail = None
        yield etree.tostring(clone, encoding="unicode")


def _text(element: etree._Element) -> str:
    """Give section properties as text without namespaces, which the document declares."""
    text = etree.tostring(element, encoding="unicode", with_tail=False)
    for prefix, name in {**{key: value for key, value in element.nsmap.items() if key}, **NAMESPACES}.items():
        if NAMESPACES.get(prefix or "") == name:
            text = text.replace(f' xmlns:{prefix}="{name}"', "")
    return text


def _frame(root: etree._Element) -> bytes:
    """Give the document element with an empty body: the template's namespaces and ours."""
    names: dict[str, str] = {key: value for key, value in root.nsmap.items() if key and key not in NAMESPACES} | dict(
        NAMESPACES
    )
    frame = etree.Element(tag("document"), nsmap=names)
    # Word skips what it does not know only where the prefixes in mc:Ignorable are declared, and refuses the file otherwise.
    ignorable = [prefix for prefix in root.get(f"{{{MC}}}Ignorable", "").split() if prefix in names]
    frame.set(f"{{{MC}}}Ignorable", " ".join(dict.fromkeys([*ignorable, "w16se"])))
    background = root.find(tag("background"))
    if background is not None:
        frame.append(copy.deepcopy(background))
    etree.SubElement(frame, tag("body")).append(etree.Comment("body"))
    return etree.tostring(frame)


def _bare(own: etree._Element) -> etree._Element:
    """Give styles for a template that has none at all: the defaults alone."""
    root = etree.Element(tag("styles"), nsmap={"w": NAMESPACES["w"]})
    defaults = own.find(tag("docDefaults"))
    if defaults is not None:
        root.append(copy.deepcopy(defaults))
    return root


def _speak(root: etree._Element, language: str) -> None:
    for item in root.iterfind(f"{tag('docDefaults')}/{tag('rPrDefault')}/{tag('rPr')}/{tag('lang')}"):
        item.set(tag("val"), _LANGUAGES.get(language, language))


def _highest(elements: Sequence[etree._Element]) -> int:
    """Give the highest id that a template's own elements use."""
    found = [0]
    for element in elements:
        for item in element.iter(*_IDS):
            number = item.get("id") or item.get(tag("id")) or "0"
            found.append(int(number) if number.isdecimal() and int(number) < 2**30 else 0)
    return max(found)
