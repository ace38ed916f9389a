"""Which style of the document plays which part, and what is added where a template has none for it.

Word knows its own styles by an English name, whatever the language and the id; so names come first, then ids, then what a
style does (an outline level makes a heading).
"""

from __future__ import annotations

import copy
from dataclasses import dataclass, field

from lxml import etree

from archgen.emit.docx.markup import W, escape
from archgen.emit.docx.metrics import BOLD, Face, font_factor

HEADINGS = 9
_PARAGRAPHS = (
    "Normal", "Title", "Subtitle", *(f"heading {n}" for n in range(1, HEADINGS + 1)), "TOC Heading",
    *(f"toc {n}" for n in range(1, HEADINGS + 1)), "table of figures", "caption", "Figure", "Table Text", "Table Heading",
    "Small Table Text", "Small Table Heading",
    "List Bullet", "List Number", "Quote", "Code Block", "Note Box", "Warning Box", "Error Box", "header", "footer",
)  # fmt: skip
_CHARACTERS = ("Default Paragraph Font", "Hyperlink", "Inline Code")
_TABLES = ("Normal Table", "Table Grid", "Report Facts")
_REPORT_TABLE = "Report Table"
_SILENT = {"Normal", "Default Paragraph Font", "Normal Table", "header", "footer"} | {"Figure", "Table Text", "Table Heading"} | {
    "Small Table Text", "Small Table Heading", "Code Block", "Inline Code", "Note Box", "Warning Box", "Error Box", "Report Facts",
}  # fmt: skip
"""Styles of archgen's own that no template can be expected to have, and those that stand for "no style"."""
_CAPTIONS = ("beschriftung", "légende", "legende", "didascalia", "epígrafe", "bijschrift", "legenda", "λεζάντα")
_DEFAULT_SIZE = 10.0
_NATURAL_LINE = 1.22
_DEEPEST = 12


def tag(name: str) -> str:
    """Give the full name of an element or attribute of WordprocessingML."""
    return f"{{{W}}}{name}"


@dataclass(slots=True)
class Styles:
    """The document's styles. `ids` has the style id of each part by the part's name; `added` what came from archgen."""

    root: etree._Element
    ids: dict[str, str] = field(default_factory=dict)
    added: tuple[str, ...] = ()
    faces: dict[str, Face] = field(default_factory=dict)

    def id(self, part: str) -> str:
        """Give the id of the style for a part."""
        return self.ids[part]

    def heading(self, level: int) -> str:
        """Give the id of the style for headings of a level from 1."""
        return self.ids[f"heading {min(level, HEADINGS)}"]

    def face(self, part: str) -> Face:
        """Give how the style for a part sets its text."""
        if part not in self.faces:
            self.faces[part] = _face(self, self.ids[part])
        return self.faces[part]

    def element(self, style: str) -> etree._Element | None:
        """Give the style with an id."""
        return next((item for item in self.root.iterfind(tag("style")) if item.get(tag("styleId")) == style), None)

    def chain(self, style: str) -> list[etree._Element]:
        """Give a style and those that it is based on, nearest first. A circle in a damaged file ends it."""
        found: list[etree._Element] = []
        while style and len(found) < _DEEPEST and (item := self.element(style)) is not None:
            found.append(item)
            style = _value(item, "basedOn")
        return found


def settle(root: etree._Element, own: etree._Element) -> Styles:
    """Find a style for each part in a template's styles; add archgen's own where there is none."""
    styles = Styles(root)
    spare = {_value(item, "name"): item for item in own.iterfind(tag("style"))}
    added = []
    for kind, parts in (("paragraph", _PARAGRAPHS), ("character", _CHARACTERS), ("table", _TABLES)):
        known = [item for item in root.iterfind(tag("style")) if item.get(tag("type"), "paragraph") == kind]
        for part in parts:
            found = _find(known, part)
            if found is None:
                found = _add(styles, spare[part])
                added.append(part)
            styles.ids[part] = found.get(tag("styleId"), "")
    report_table = _find(
        [item for item in root.iterfind(tag("style")) if item.get(tag("type")) == "table"], _REPORT_TABLE
    )
    styles.ids[_REPORT_TABLE] = (
        styles.ids["Table Grid"] if report_table is None else report_table.get(tag("styleId"), "")
    )
    styles.added = tuple(part for part in added if part not in _SILENT)
    return styles


def _find(known: list[etree._Element], part: str) -> etree._Element | None:
    """Find the style for a part: by name, by another of its names, by id, and by what it does."""
    wanted = part.casefold()
    # An id that would have to be escaped is none that Word writes.
    known = [item for item in known if (name := item.get(tag("styleId"))) and escape(name) == name]
    for item in known:
        if _value(item, "name").casefold() == wanted:
            return item
    for item in known:
        aliases = f"{_value(item, 'name')},{_value(item, 'aliases')}".casefold().split(",")
        if wanted in aliases or item.get(tag("styleId"), "").casefold() == wanted.replace(" ", ""):
            return item
    return (
        _default(known) if part in {"Normal", "Default Paragraph Font", "Normal Table"} else _by_purpose(known, wanted)
    )


def _default(known: list[etree._Element]) -> etree._Element | None:
    return next((item for item in known if item.get(tag("default")) in {"1", "true", "on"}), None)


def _by_purpose(known: list[etree._Element], wanted: str) -> etree._Element | None:
    if wanted.startswith("heading "):
        level = str(int(wanted.removeprefix("heading ")) - 1)
        return next((item for item in known if _value(item, "pPr", "outlineLvl") == level), None)
    if wanted == "caption":
        names = {id(item): f"{_value(item, 'name')} {item.get(tag('styleId'))}".casefold() for item in known}
        matches = ("caption", *_CAPTIONS)
        return next((item for item in known if any(match in names[id(item)] for match in matches)), None)
    return None


def _add(styles: Styles, spare: etree._Element) -> etree._Element:
    """Put a style of archgen's own into the template, under an id that is free, standing on the template's own base."""
    new = copy.deepcopy(spare)
    taken = {item.get(tag("styleId")) for item in styles.root.iterfind(tag("style"))}
    style = new.get(tag("styleId"), "")
    while style in taken:
        style += "Archgen"
    new.set(tag("styleId"), style)
    if any(
        item.get(tag("type")) == new.get(tag("type"))
        for item in styles.root.iterfind(tag("style"))
        if item.get(tag("default"))
    ):
        new.attrib.pop(tag("default"), "")
    for reference in ("basedOn", "next"):
        item = new.find(tag(reference))
        if item is not None:
            _point(styles, item)
    styles.root.append(new)
    return new


def _point(styles: Styles, item: etree._Element) -> None:
    """Let a reference of an added style point at the style that plays the same part in the template."""
    target = item.get(tag("val"), "")
    names = {
        "DefaultParagraphFont": "Default Paragraph Font", "TableNormal": "Normal Table", "Caption": "caption",
        "TableText": "Table Text", "TableHeading": "Table Heading",
    }  # fmt: skip
    part = names.get(target, target)
    if part in styles.ids:
        item.set(tag("val"), styles.ids[part])
    elif styles.element(target) is None:
        parent = item.getparent()
        if parent is not None:
            parent.remove(item)


def _face(styles: Styles, style: str) -> Face:
    chain = styles.chain(style)
    defaults = styles.root.find(tag("docDefaults"))
    run_defaults = [] if defaults is None else defaults.findall(f"{tag('rPrDefault')}/{tag('rPr')}")
    paragraph_defaults = [] if defaults is None else defaults.findall(f"{tag('pPrDefault')}/{tag('pPr')}")
    runs = [found for item in chain if (found := item.find(tag("rPr"))) is not None] + run_defaults
    paragraphs = [found for item in chain if (found := item.find(tag("pPr"))) is not None] + paragraph_defaults
    size = _number(runs, "sz", "val", _DEFAULT_SIZE * 2) / 2
    bold = any(item.find(tag("b")) is not None for item in runs)
    return Face(
        size=size,
        line=_line(paragraphs, size),
        before=_number(paragraphs, "spacing", "before", 0) / 20,
        after=_number(paragraphs, "spacing", "after", 0) / 20,
        factor=font_factor(_text(runs, "rFonts", "ascii")) * (BOLD if bold else 1),
        left=_number(paragraphs, "ind", "left", 0) / 20,
        right=_number(paragraphs, "ind", "right", 0) / 20,
        contextual=any(item.find(tag("contextualSpacing")) is not None for item in paragraphs),
    )


def _line(paragraphs: list[etree._Element], size: float) -> float:
    """Give the height of a line: a multiple of the font's own, a least, or an exact one."""
    height = _number(paragraphs, "spacing", "line", 240)
    rule = _text(paragraphs, "spacing", "lineRule") or "auto"
    natural = size * _NATURAL_LINE
    if rule == "auto":
        return natural * height / 240
    return height / 20 if rule == "exact" else max(natural, height / 20)


def _number(holders: list[etree._Element], name: str, attribute: str, default: float) -> float:
    text = _text(holders, name, attribute)
    try:
        value = float(text)
    except ValueError:
        return default
    return value if 0 <= value < 10_000 else default  # noqa: PLR2004 - beyond it the file is damaged


def _text(holders: list[etree._Element], name: str, attribute: str) -> str:
    for holder in holders:
        item = holder.find(tag(name))
        if item is not None and item.get(tag(attribute)) is not None:
            return item.get(tag(attribute), "")
    return ""


def _value(item: etree._Element, *path: str) -> str:
    """Give the value of an element's child, empty if it has none."""
    found = item.find("/".join(tag(part) for part in path))
    return "" if found is None else found.get(tag("val"), "")
