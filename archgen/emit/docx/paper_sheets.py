"""Paper: the sheets that a report is set on, taken from the template's last section, and how it turns for what is wide."""

from __future__ import annotations

import copy
from collections.abc import Collection
from typing import cast

from docx.enum.section import WD_ORIENTATION, WD_SECTION
from docx.oxml.ns import nsdecls, qn
from docx.oxml.parser import parse_xml
from docx.oxml.section import CT_SectPr
from docx.parts.document import DocumentPart
from docx.section import Section
from docx.shared import Length, Twips
from lxml import etree

from archgen.emit.docx.word_xml import points_to_twips
from archgen.frozen import dataclass, replace

_A4 = (595.3, 841.9)
_MARGIN = 70.85  # 25 mm
_NARROW_MARGIN, _NARROW_HEAD = 42.5, 48.2  # 15 and 17 mm
_HEADER_DISTANCE = 34
_COLUMN_GAP = 20.0
_MAX_SIDE = 1584.0
"""Word knows no paper longer than 22 inches."""
_MIN_TEXT_SIDE = 100.0
_FIRST_PAGE_NAMES = ("titlePg", "pgNumType", "cols", "sectPrChange", "formProt", "lnNumType")
"""Section properties that belong to a first page, or to the template's own text."""
_AFTER_COLUMNS = ("vAlign", "noEndnote", "textDirection", "bidi", "rtlGutter", "docGrid", "printerSettings")
"""What stands behind the columns in a section's properties (ECMA-376 17.6.17)."""


@dataclass(frozen=True, slots=True)
class PaperSheet:
    """A sheet of paper with its margins, in points."""

    width: float
    height: float
    top: float = _MARGIN
    right: float = _MARGIN
    bottom: float = _MARGIN
    left: float = _MARGIN
    columns: int = 1

    @property
    def column_width(self) -> float:
        """Return the width of a column."""
        return (self.text_width - _COLUMN_GAP * (self.columns - 1)) / self.columns

    @property
    def text_width(self) -> float:
        """Return the width between the margins."""
        return self.width - self.left - self.right

    @property
    def text_height(self) -> float:
        """Return the height between the margins."""
        return self.height - self.top - self.bottom


@dataclass(frozen=True, slots=True)
class PaperSet:
    """The sheets of a report. `large` has twice the area (A3 for A4), upright and turned, empty where Word knows no such paper.

    `section` is the template's own section properties, `part` the document's part that they belong to.
    """

    base: PaperSheet
    wide: PaperSheet
    large: tuple[PaperSheet, ...]
    section: etree._Element
    part: DocumentPart

    def create_section_properties(self, sheet: PaperSheet) -> etree._Element:
        """Return the section properties of a sheet: the template's, with another size and nothing that belongs to a first page."""
        properties = copy.deepcopy(self.section)
        for name in _FIRST_PAGE_NAMES:
            for item in properties.findall(qn(f"w:{name}")):
                properties.remove(item)
        size = properties.find(qn("w:pgSz"))
        if size is not None:
            # The code of the template's paper would contradict the new size.
            size.attrib.clear()
        section = _open_section(properties, self.part)
        section.page_width, section.page_height = _round_length(sheet.width), _round_length(sheet.height)
        if sheet.width > sheet.height:
            section.orientation = WD_ORIENTATION.LANDSCAPE
        # Another size needs a new page, however the template's own section begins; python-docx takes its `w:type` out for this.
        # Columns begin below what stands on the page.
        section.start_type = WD_SECTION.NEW_PAGE if sheet.columns == 1 else WD_SECTION.CONTINUOUS
        if sheet.columns > 1:
            _write_columns(properties, sheet.columns)
        return properties


def measure_paper(section: etree._Element | None, relation_ids: Collection[str], part: DocumentPart) -> PaperSet:
    """Return the sheets by a template's section properties; A4 where they are missing or make no sense.

    Headers without a relationship among `relation_ids` are left out.
    """
    # A copy: the template's own section stays at the end of its cover.
    section = parse_xml(f"<w:sectPr {nsdecls('w')}/>") if section is None else copy.deepcopy(section)
    for item in [*section.iterfind(qn("w:headerReference")), *section.iterfind(qn("w:footerReference"))]:
        if item.get(qn("r:id")) not in relation_ids:
            section.remove(item)
    base = _read_sheet(section)
    if base is None:
        base = PaperSheet(*_A4)
        _write_sheet(section, base, part)
    wide = base if base.width >= base.height else _turn_sheet(base)
    short, long = sorted((base.width, base.height))
    upright = PaperSheet(long, 2 * short, base.top, base.right, base.bottom, base.left)
    return PaperSet(base, wide, (upright, _turn_sheet(upright)) if 2 * short <= _MAX_SIDE else (), section, part)


def narrow_margins(paper: PaperSet) -> PaperSet:
    """Return the sheets of a report with less space at the sides and at head and foot."""
    section = copy.deepcopy(paper.section)
    base = replace(paper.base, left=_NARROW_MARGIN, right=_NARROW_MARGIN, top=_NARROW_HEAD, bottom=_NARROW_HEAD)
    _write_sheet(section, base, paper.part)
    return replace(paper, base=base, wide=_turn_sheet(base), section=section)


def _read_sheet(section: etree._Element) -> PaperSheet | None:
    """Return the sheet of section properties, None where they make no sense.

    Not through python-docx's `Section`: it raises ValueError for the `1440.0000000000002` that Google Docs writes.
    """
    size, margins = section.find(qn("w:pgSz")), section.find(qn("w:pgMar"))
    if size is None or margins is None:
        return None
    width, height = _read_points(size, "w"), _read_points(size, "h")
    # A negative margin lets the header overlap the text (ECMA-376 17.6.11); its size counts.
    top, right, bottom, left = (abs(_read_points(margins, side)) for side in ("top", "right", "bottom", "left"))
    sheet = PaperSheet(width, height, top, right, bottom, left + _read_points(margins, "gutter"))
    # Written so that "NaN", which float() takes, makes no sense either.
    roomy = sheet.text_width >= _MIN_TEXT_SIDE and sheet.text_height >= _MIN_TEXT_SIDE
    return sheet if roomy and max(width, height) <= _MAX_SIDE else None


def _write_sheet(properties: etree._Element, sheet: PaperSheet, part: DocumentPart) -> None:
    """Give section properties a size and margins in the place of theirs."""
    for name in ("pgSz", "pgMar"):
        for item in properties.findall(qn(f"w:{name}")):
            properties.remove(item)
    section = _open_section(properties, part)
    section.page_width, section.page_height = _round_length(sheet.width), _round_length(sheet.height)
    section.top_margin, section.right_margin = _round_length(sheet.top), _round_length(sheet.right)
    section.bottom_margin, section.left_margin = _round_length(sheet.bottom), _round_length(sheet.left)
    section.header_distance = section.footer_distance = _round_length(_HEADER_DISTANCE)
    section.gutter = _round_length(0)


def _write_columns(properties: etree._Element, count: int) -> None:
    """Give section properties columns of one width."""
    columns = parse_xml(f'<w:cols {nsdecls("w")} w:num="{count}" w:space="{points_to_twips(_COLUMN_GAP)}"/>')
    followers = {qn(f"w:{name}") for name in _AFTER_COLUMNS}
    place = next((index for index, item in enumerate(properties) if item.tag in followers), len(properties))
    properties.insert(place, columns)


def _round_length(points: float) -> Length:
    """Return points as the nearest length that Word can hold."""
    return Twips(points_to_twips(points))


def _open_section(properties: etree._Element, part: DocumentPart) -> Section:
    return Section(cast("CT_SectPr", properties), part)


def _turn_sheet(sheet: PaperSheet) -> PaperSheet:
    return PaperSheet(sheet.height, sheet.width, sheet.top, sheet.right, sheet.bottom, sheet.left)


def _read_points(item: etree._Element, name: str) -> float:
    try:
        return float(item.get(qn(f"w:{name}"), "0")) / 20
    except ValueError:
        return 0.0
