"""Paper: the sheets that a report is set on, taken from the template's last section, and how it turns for what is wide."""

from __future__ import annotations

import copy
from dataclasses import dataclass

from lxml import etree

from archgen.emit.docx.markup import R, twips
from archgen.emit.docx.styles import tag

_A4 = (595.3, 841.9)
_MARGIN = 70.85
_LARGEST = 1584.0
"""Word knows no paper longer than 22 inches."""
_LEAST_TEXT = 100.0


@dataclass(frozen=True, slots=True)
class Sheet:
    """A sheet of paper with its margins, in points."""

    width: float
    height: float
    top: float = _MARGIN
    right: float = _MARGIN
    bottom: float = _MARGIN
    left: float = _MARGIN

    @property
    def text_width(self) -> float:
        """Give the width between the margins."""
        return self.width - self.left - self.right

    @property
    def text_height(self) -> float:
        """Give the height between the margins."""
        return self.height - self.top - self.bottom


@dataclass(frozen=True, slots=True)
class Sheets:
    """The sheets of a report. `large` has twice the area (A3 for A4), upright and turned, empty where Word knows no such paper."""

    base: Sheet
    wide: Sheet
    large: tuple[Sheet, ...]
    section: etree._Element
    """The template's own section properties."""

    def properties(self, sheet: Sheet) -> etree._Element:
        """Give the section properties of a sheet: the template's, with another size and nothing that belongs to a first page."""
        section = copy.deepcopy(self.section)
        for name in ("titlePg", "pgNumType", "cols", "type", "sectPrChange", "formProt", "lnNumType"):
            for item in section.findall(tag(name)):
                section.remove(item)
        size = section.find(tag("pgSz"))
        if size is not None:
            size.attrib.clear()
            size.set(tag("w"), str(twips(sheet.width)))
            size.set(tag("h"), str(twips(sheet.height)))
            if sheet.width > sheet.height:
                size.set(tag("orient"), "landscape")
        kind = etree.Element(tag("type"))
        kind.set(tag("val"), "nextPage")
        before = {"headerReference", "footerReference", "footnotePr", "endnotePr"}
        section.insert(sum(1 for item in section if item.tag in {tag(name) for name in before}), kind)
        return section


def measure(section: etree._Element | None, known: frozenset[str]) -> Sheets:
    """Read the paper from section properties; A4 where they are missing or make no sense. `known` are the part's relationships."""
    section = etree.Element(tag("sectPr")) if section is None else copy.deepcopy(section)
    for item in [*section.iterfind(tag("headerReference")), *section.iterfind(tag("footerReference"))]:
        if item.get(f"{{{R}}}id") not in known:
            section.remove(item)
    base = _read(section)
    if base is None:
        base = Sheet(*_A4)
        _write(section, base)
    wide = base if base.width >= base.height else _turned(base)
    return Sheets(base, wide, _large(base), section)


def _read(section: etree._Element) -> Sheet | None:
    size, margins = section.find(tag("pgSz")), section.find(tag("pgMar"))
    if size is None or margins is None:
        return None
    width, height = _points(size, "w"), _points(size, "h")
    top, right, bottom, left = (abs(_points(margins, side)) for side in ("top", "right", "bottom", "left"))
    sheet = Sheet(width, height, top, right, bottom, left + _points(margins, "gutter"))
    sensible = sheet.text_width >= _LEAST_TEXT and sheet.text_height >= _LEAST_TEXT and max(width, height) <= _LARGEST
    return sheet if sensible else None


def _write(section: etree._Element, sheet: Sheet) -> None:
    """Give section properties a size and margins."""
    for name in ("pgSz", "pgMar"):
        for item in section.findall(tag(name)):
            section.remove(item)
    before = {tag(name) for name in ("headerReference", "footerReference", "footnotePr", "endnotePr", "type")}
    place = sum(1 for item in section if item.tag in before)
    size, margins = etree.Element(tag("pgSz")), etree.Element(tag("pgMar"))
    for item, values in (
        (size, {"w": sheet.width, "h": sheet.height}),
        (
            margins,
            {
                "top": sheet.top,
                "right": sheet.right,
                "bottom": sheet.bottom,
                "left": sheet.left,
                "header": 34,
                "footer": 34,
                "gutter": 0,
            },
        ),
    ):
        for name, value in values.items():
            item.set(tag(name), str(twips(value)))
    section.insert(place, size)
    section.insert(place + 1, margins)


def _turned(sheet: Sheet) -> Sheet:
    return Sheet(sheet.height, sheet.width, sheet.top, sheet.right, sheet.bottom, sheet.left)


def _large(base: Sheet) -> tuple[Sheet, ...]:
    short, long = sorted((base.width, base.height))
    upright = Sheet(long, 2 * short, base.top, base.right, base.bottom, base.left)
    return (upright, _turned(upright)) if 2 * short <= _LARGEST else ()


def _points(item: etree._Element, name: str) -> float:
    try:
        return float(item.get(tag(name), "0")) / 20
    except ValueError:
        return 0.0
