"""How a style sets its text, as far as that decides heights: read with all that the style stands on.

Not through python-docx's `style.font.size`: it stops at the style itself, and raises ValueError for what Google Docs
writes (`w:line="276.0000000000001"`).
"""

from __future__ import annotations

from collections.abc import Sequence

from docx.oxml.ns import qn
from lxml import etree

from archgen.emit.docx.text_metrics import BOLD_FACTOR, TextFace, find_font_factor

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
