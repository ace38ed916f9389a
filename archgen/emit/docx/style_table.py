"""Which style of the document plays which part, and what is added where a template has none for it.

Word knows its own styles by an English name, whatever the language and the id; so names come first, then ids, then what a
style does (an outline level makes a heading). python-docx looks up by name alone.

How a style sets its text, as far as that decides heights: read with all that the style stands on.

Not through python-docx's `style.font.size`: it stops at the style itself, and raises ValueError for what Google Docs
writes (`w:line="276.0000000000001"`).
"""

from __future__ import annotations

import copy
from collections.abc import Sequence

from docx.oxml.ns import qn
from lxml import etree

from archgen.emit.docx.word_xml import escape_text
from archgen.emit.text_metrics import BOLD_FACTOR, TextFace, find_font_factor
from archgen.frozen import dataclass, field

HEADING_LEVELS = 9
_PARAGRAPHS = (
    "Normal", "Title", "Subtitle", *(f"heading {n}" for n in range(1, HEADING_LEVELS + 1)), "TOC Heading",
    *(f"toc {n}" for n in range(1, HEADING_LEVELS + 1)), "table of figures", "caption", "Figure", "Table Text", "Table Heading",
    "Small Table Text", "Small Table Heading",
    "List Bullet", "List Number", "Quote", "Code Block", "Note Box", "Warning Box", "Error Box", "header", "footer",
)  # fmt: skip
_CHARACTERS = ("Default Paragraph Font", "Hyperlink", "Inline Code")
_TABLES = ("Normal Table", "Table Grid", "Report Facts")
_REPORT_TABLE = "Report Table"
_DEFAULTS = {"Normal", "Default Paragraph Font", "Normal Table"}
_SILENT = _DEFAULTS | {"header", "footer", "Figure", "Table Text", "Table Heading"} | {
    "Small Table Text", "Small Table Heading", "Code Block", "Inline Code", "Note Box", "Warning Box", "Error Box", "Report Facts",
}  # fmt: skip
"""Styles of archgen's own that no template can be expected to have, and those that stand for "no style"."""
_CAPTION_WORDS = (
    "caption",
    "beschriftung",
    "légende",
    "legende",
    "didascalia",
    "epígrafe",
    "bijschrift",
    "legenda",
    "λεζάντα",
)
_MAX_BASES = 12
_OWN_IDS = {
    "DefaultParagraphFont": "Default Paragraph Font", "TableNormal": "Normal Table", "Caption": "caption",
    "TableText": "Table Text", "TableHeading": "Table Heading",
}  # fmt: skip
"""Ids in archgen's own styles that are not the name of the part."""


@dataclass(slots=True)
class StyleTable:
    """The styles of a document. `ids` has the style id of each part by the part's name; `added` what came from archgen."""

    root: etree._Element
    ids: dict[str, str] = field(default_factory=dict)
    added: tuple[str, ...] = ()
    faces: dict[str, TextFace] = field(default_factory=dict)

    def find_style_id(self, part: str) -> str:
        """Return the id of the style for a part."""
        return self.ids[part]

    def find_heading_id(self, level: int) -> str:
        """Return the id of the style for headings of a level from 1."""
        return self.ids[f"heading {min(level, HEADING_LEVELS)}"]

    def find_face(self, part: str) -> TextFace:
        """Return how the style for a part sets its text."""
        if part not in self.faces:
            self.faces[part] = read_face(self.root, self.list_bases(self.ids[part]))
        return self.faces[part]

    def find_font(self, part: str) -> str:
        """Return the font that the style for a part is set in; empty where it names none."""
        runs = [item for style in self.list_bases(self.ids[part]) if (item := style.find(qn("w:rPr"))) is not None]
        return _read_text(runs, "rFonts", "ascii")

    def find_style(self, style_id: str) -> etree._Element | None:
        """Return the style with an id."""
        return next((item for item in self.root.iterfind(qn("w:style")) if _read_id(item) == style_id), None)

    def list_bases(self, style_id: str) -> list[etree._Element]:
        """Return a style and those that it is based on, nearest first. A circle in a damaged file ends it."""
        styles: list[etree._Element] = []
        while style_id and len(styles) < _MAX_BASES and (item := self.find_style(style_id)) is not None:
            styles.append(item)
            style_id = _read_child_value(item, "basedOn")
        return styles


def match_styles(root: etree._Element, own_styles: etree._Element) -> StyleTable:
    """Find a style for each part in a document's styles; add archgen's own where there is none."""
    table = StyleTable(root)
    own = {_read_child_value(item, "name"): item for item in own_styles.iterfind(qn("w:style"))}
    added = []
    for kind, parts in (("paragraph", _PARAGRAPHS), ("character", _CHARACTERS), ("table", _TABLES)):
        candidates = _list_candidates(root, kind)
        for part in parts:
            style = _find_style(candidates, part)
            if style is None:
                style = _add_style(table, own[part])
                added.append(part)
            table.ids[part] = _read_id(style)
    # A template's plain grid comes before our own "Report Table", which would bring our colours into a partner's house.
    report_table = _find_style(_list_candidates(root, "table"), _REPORT_TABLE)
    table.ids[_REPORT_TABLE] = table.ids["Table Grid"] if report_table is None else _read_id(report_table)
    table.added = tuple(part for part in added if part not in _SILENT)
    return table


def _list_candidates(root: etree._Element, kind: str) -> list[etree._Element]:
    """Return the styles of a kind. An id that would have to be escaped is none that Word writes."""
    return [
        item
        for item in root.iterfind(qn("w:style"))
        if item.get(qn("w:type"), "paragraph") == kind
        and _read_id(item)
        and escape_text(_read_id(item)) == _read_id(item)
    ]


def _find_style(candidates: Sequence[etree._Element], part: str) -> etree._Element | None:
    """Return the style for a part: by name, by another of its names, by id, and by what it does."""
    name = part.casefold()
    for item in candidates:
        if _read_child_value(item, "name").casefold() == name:
            return item
    for item in candidates:
        aliases = f"{_read_child_value(item, 'name')},{_read_child_value(item, 'aliases')}".casefold().split(",")
        if name in aliases or _read_id(item).casefold() == name.replace(" ", ""):
            return item
    if part in _DEFAULTS:
        return next((item for item in candidates if item.get(qn("w:default")) in {"1", "true", "on"}), None)
    return _find_by_purpose(candidates, name)


def _find_by_purpose(candidates: Sequence[etree._Element], name: str) -> etree._Element | None:
    if name.startswith("heading "):
        level = str(int(name.removeprefix("heading ")) - 1)
        return next((item for item in candidates if _read_child_value(item, "pPr", "outlineLvl") == level), None)
    if name == "caption":
        for item in candidates:
            names = f"{_read_child_value(item, 'name')} {_read_id(item)}".casefold()
            if any(word in names for word in _CAPTION_WORDS):
                return item
    return None


def _add_style(table: StyleTable, own: etree._Element) -> etree._Element:
    """Put a style of archgen's own into the document, under an id that is free, standing on the document's own base."""
    new = copy.deepcopy(own)
    styles = table.root.findall(qn("w:style"))
    style_id, used_ids = _read_id(new), {_read_id(item) for item in styles}
    while style_id in used_ids:
        style_id += "Archgen"
    new.set(qn("w:styleId"), style_id)
    # A document has one default style of each type (ECMA-376 17.7.4.17).
    if any(item.get(qn("w:type")) == new.get(qn("w:type")) and item.get(qn("w:default")) for item in styles):
        new.attrib.pop(qn("w:default"), "")
    for name in ("basedOn", "next"):
        reference = new.find(qn(f"w:{name}"))
        if reference is not None:
            target = reference.get(qn("w:val"), "")
            part = _OWN_IDS.get(target, target)
            if part in table.ids:
                reference.set(qn("w:val"), table.ids[part])
            elif table.find_style(target) is None:
                new.remove(reference)
    table.root.append(new)
    return new


def _read_id(style: etree._Element) -> str:
    return style.get(qn("w:styleId"), "")


def _read_child_value(style: etree._Element, *path: str) -> str:
    """Return the value of a style's child, empty if it has none."""
    child = style.find("/".join(qn(f"w:{name}") for name in path))
    return "" if child is None else child.get(qn("w:val"), "")


_DEFAULT_SIZE = 10.0
"""Points of type where nothing says otherwise (ECMA-376 17.3.2.38)."""
_NATURAL_LINE = 1.22
"""Height of a line of Calibri in units of its type size."""
_SANE_LIMIT = 10_000


def read_face(root: etree._Element, styles: Sequence[etree._Element]) -> TextFace:
    """Return how a style and those that it is based on (nearest first) set their text; `root` has the document's defaults."""
    runs = [item for style in styles if (item := style.find(qn("w:rPr"))) is not None]
    paragraphs = [item for style in styles if (item := style.find(qn("w:pPr"))) is not None]
    runs += root.findall("/".join(map(qn, ("w:docDefaults", "w:rPrDefault", "w:rPr"))))
    paragraphs += root.findall("/".join(map(qn, ("w:docDefaults", "w:pPrDefault", "w:pPr"))))
    size = _read_number(runs, "sz", "val", _DEFAULT_SIZE * 2) / 2
    bold = any(item.find(qn("w:b")) is not None for item in runs)
    return TextFace(
        size=size,
        line=_read_line_height(paragraphs, size),
        before=_read_number(paragraphs, "spacing", "before", 0) / 20,
        after=_read_number(paragraphs, "spacing", "after", 0) / 20,
        factor=find_font_factor(_read_text(runs, "rFonts", "ascii")) * (BOLD_FACTOR if bold else 1),
        left=_read_number(paragraphs, "ind", "left", 0) / 20,
        right=_read_number(paragraphs, "ind", "right", 0) / 20,
    )


def _read_line_height(paragraphs: Sequence[etree._Element], size: float) -> float:
    """Return the height of a line in points: a multiple of the font's own, a least, or an exact one (ECMA-376 17.3.1.33)."""
    height = _read_number(paragraphs, "spacing", "line", 240)
    rule = _read_text(paragraphs, "spacing", "lineRule") or "auto"
    natural = size * _NATURAL_LINE
    if rule == "auto":
        return natural * height / 240
    return height / 20 if rule == "exact" else max(natural, height / 20)


def _read_number(holders: Sequence[etree._Element], name: str, attribute: str, default: float) -> float:
    try:
        value = float(_read_text(holders, name, attribute))
    except ValueError:
        return default
    return value if 0 <= value < _SANE_LIMIT else default


def _read_text(holders: Sequence[etree._Element], name: str, attribute: str) -> str:
    """Return an attribute from the first of some properties that has it."""
    for holder in holders:
        item = holder.find(qn(f"w:{name}"))
        if item is not None and item.get(qn(f"w:{attribute}")) is not None:
            return item.get(qn(f"w:{attribute}"), "")
    return ""
