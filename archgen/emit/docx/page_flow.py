"""The report as a flow of pieces on the sheets that the template's last section gives, and an estimate of the page of each
of them.

Word shows the stored page numbers until somebody updates the fields, and asks no question if it need not update them
itself. So they must be close. Everything that decides them is known but the exact breaking of lines: heights of lines,
rows, pictures and spaces.
"""

from __future__ import annotations

import copy
import itertools
import math
from collections.abc import Callable, Collection, Sequence
from typing import Literal, cast

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


_SLACK = 6.0
"""Points that a picture is smaller than the estimate asks for, which may be off by a line."""
_GOOD_SHARE = 0.8
"""Above this share of its size a picture is drawn smaller, below it rather changes places with its table."""
_MIN_VOID = 0.12
"""Share of a page that must stay empty at its foot for that change."""
_MAX_CHAPTER_PAGES = 20
"""Longest chapter all of whose pictures become smaller where that saves a page."""
_CHAPTER_SHARES = (0.96, 0.92, 0.88, 0.84)


@dataclass(frozen=True, slots=True)
class FilledChapter:
    """The pieces of a chapter as they fill its pages, and how many these are."""

    pieces: list[FlowPiece]
    page_count: int


def fill_pages(pieces: Sequence[FlowPiece], base: PaperSheet) -> list[FlowPiece]:
    """Return the pieces, which have their sheets, so that fewer pages end early. The first one begins a page."""
    starts = [index for index, piece in enumerate(pieces) if piece.new_page or index == 0]
    chapters = itertools.pairwise((*starts, len(pieces)))
    return [piece for start, end in chapters for piece in _fill_chapter(pieces[start:end], base)]


def _fill_chapter(pieces: Sequence[FlowPiece], base: PaperSheet) -> list[FlowPiece]:
    """Return a chapter's pieces; all of its pictures are a little smaller where that saves a page."""
    usual = _fill_at_share(pieces, base, 1.0)
    if usual.page_count <= _MAX_CHAPTER_PAGES:
        for share in _CHAPTER_SHARES:
            smaller = _fill_at_share(pieces, base, share)
            if smaller.page_count < usual.page_count:
                return smaller.pieces
    return usual.pieces


def _fill_at_share(pieces: Sequence[FlowPiece], base: PaperSheet, share: float) -> FilledChapter:
    """Return a chapter with all pictures at a share of their size, or at their least one."""
    flow = [_shrink_picture(piece, share) for piece in pieces]
    cursor = PageCursor(base)
    for index in range(len(flow)):
        if index and flow[index].sheet == base == cursor.sheet and cursor.measure_shortage(flow, index) > 0:
            flow = _use_foot(flow, index, cursor)
        cursor.place_piece(flow, index, base, in_new_section=False)
    return FilledChapter(flow, cursor.page)


def _use_foot(flow: list[FlowPiece], index: int, cursor: PageCursor) -> list[FlowPiece]:
    """Return the flow so that its piece at an index begins on this page with the picture that it is kept with, or as it is."""
    place = index
    while flow[place].keep_next and flow[place].picture is None and place + 1 < len(flow):
        place += 1
    picture = flow[place].picture
    if picture is None:
        return flow
    share = (flow[place].rows[0] - cursor.measure_shortage(flow, index) - _SLACK) / picture.height
    if share < _GOOD_SHARE:
        exchanged = _exchange_with_table(flow, place)
        void = cursor.sheet.text_height - cursor.position
        if void > cursor.sheet.text_height * _MIN_VOID and cursor.measure_shortage(exchanged, index) <= 0:
            return exchanged
    return [*flow[:place], _shrink_picture(flow[place], share), *flow[place + 1 :]] if share >= picture.least else flow


def _exchange_with_table(flow: list[FlowPiece], place: int) -> list[FlowPiece]:
    """Return the flow with the picture at a place, and its caption, behind the table that follows them, if one does."""
    captions = [piece.captions for piece in flow[place : place + 3]]
    if captions != [None, "Figure", "Table"]:
        return flow
    after_figure, after_table = place + 2, place + 4
    return [*flow[:place], *flow[after_figure:after_table], *flow[place:after_figure], *flow[after_table:]]


def _shrink_picture(piece: FlowPiece, share: float) -> FlowPiece:
    """Return a piece with its picture at a share of its size, as far as it can be read there; others as they are."""
    picture = piece.picture
    if picture is None or share >= 1:
        return piece
    return picture.draw_piece(max(share, picture.least))


_WIDOW_LINES = 2
"""Lines of a paragraph that stay together at the foot and at the head of a page."""
_MIN_PAGE_TEXT = 130.0
"""Points of text that deserve a page."""


@dataclass(frozen=True, slots=True)
class ScalablePicture:
    """A picture that may be drawn smaller: `draw_piece` returns its piece at a share of `height` (points), `least` or more."""

    height: float
    least: float
    draw_piece: Callable[[float], FlowPiece]


@dataclass(frozen=True, slots=True)
class FlowPiece:
    """A paragraph, or a table with the empty paragraph behind it. Heights are in points.

    `rows` are the heights of what may stand on different pages: lines or rows. `repeat` is the height of what the next page
    repeats. `sheet` is the paper it needs, None for any. `marks` are the bookmarks at its start. `captions` is what it is the
    caption of, `picture` what it shows where that may be drawn smaller.
    """

    xml: str
    rows: tuple[float, ...]
    before: float = 0
    after: float = 0
    keep_next: bool = False
    whole: bool = False
    repeat: float = 0
    sheet: PaperSheet | None = None
    new_page: bool = False
    marks: tuple[str, ...] = ()
    captions: Literal["Figure", "Table"] | None = None
    picture: ScalablePicture | None = None

    @property
    def first_height(self) -> float:
        """Return the height of what stands on the first page at least, with the space before it."""
        whole = self.whole or len(self.rows) <= _WIDOW_LINES + 1
        return self.before + math.fsum(self.rows if whole else self.rows[:_WIDOW_LINES])

    @property
    def height(self) -> float:
        """Return the height of all of it, with the spaces around it."""
        return self.before + math.fsum(self.rows) + self.after


def assign_sheets(pieces: Sequence[FlowPiece], base: PaperSheet) -> tuple[FlowPiece, ...]:
    """Return every piece with its sheet: the one it needs, that of the piece it is kept with, or the usual one.

    A little text that would have a usual page to itself, beside a turned one, turns along.
    """
    sheets: list[PaperSheet] = []
    # From the end, since what is kept with the next piece follows that one's sheet.
    following: PaperSheet | None = None
    for piece in reversed(pieces):
        following = piece.sheet or (following if piece.keep_next else None) or base
        sheets.append(following)
    sheets.reverse()
    for start, end in _find_base_stretches(pieces, sheets, base):
        if math.fsum(piece.height for piece in pieces[start:end]) <= _MIN_PAGE_TEXT:
            before = sheets[start - 1] if start and not pieces[start].new_page else base
            after = sheets[end] if end < len(pieces) and not pieces[end].new_page else base
            neighbour = after if after != base else before
            # Columns are for short lines alone, and need no page of their own.
            if neighbour.columns == 1:
                sheets[start:end] = [neighbour] * (end - start)
    return tuple(replace(piece, sheet=sheet) for piece, sheet in zip(pieces, sheets, strict=True))


@dataclass(slots=True)
class PageCursor:
    """Where the next piece goes: its page, the height in use there, and the space that the last piece asks for below it."""

    sheet: PaperSheet
    page: int = 1
    position: float = 0.0
    gap: float = 0.0

    def measure_shortage(self, pieces: Sequence[FlowPiece], index: int) -> float:
        """Return the height that lacks for a piece to begin on this page with those that it is kept with; 0 where it fits."""
        # Of two spaces that meet Word takes the larger one.
        space = max(self.gap, pieces[index].before)
        required = self.position + space + _measure_required_height(pieces, index)
        return max(required - self.sheet.text_height, 0.0) if self.position else 0.0

    def place_piece(self, pieces: Sequence[FlowPiece], index: int, base: PaperSheet, *, in_new_section: bool) -> int:
        """Go behind a piece, and return the page that it begins on."""
        piece = pieces[index]
        sheet = piece.sheet or base
        turned = in_new_section or (index > 0 and sheet != self.sheet and sheet.columns == 1)
        self.sheet = sheet
        space = max(self.gap, piece.before)
        if turned or (piece.new_page and self.position) or self.measure_shortage(pieces, index) > 0:
            self.page, self.position = self.page + 1, 0.0
            # At the head of a page that came by itself Word leaves the space before a paragraph out.
            space = piece.before if turned or piece.new_page else 0.0
        first_page = self.page
        self.page, self.position = _fill_pages(piece, self.page, self.position + space, sheet.text_height)
        self.gap = piece.after
        return first_page


def estimate_pages(pieces: Sequence[FlowPiece], base: PaperSheet, section_start: int = 0) -> dict[str, int]:
    """Return the page of every bookmark. The pieces have their sheets; a section begins at the one with index `section_start`."""
    pages: dict[str, int] = {}
    cursor = PageCursor(base)
    for index, piece in enumerate(pieces):
        page = cursor.place_piece(pieces, index, base, in_new_section=index == section_start > 0)
        pages.update(dict.fromkeys(piece.marks, page))
    return pages


def _find_base_stretches(
    pieces: Sequence[FlowPiece], sheets: Sequence[PaperSheet], base: PaperSheet
) -> list[tuple[int, int]]:
    """Return start and end of each stretch of pieces on the usual sheet between what begins a page."""
    stretches, start = [], 0
    for index in range(len(pieces) + 1):
        if index == len(pieces) or sheets[index] != base or pieces[index].new_page:
            if start < index:
                stretches.append((start, index))
            start = index if index < len(pieces) and sheets[index] == base else index + 1
    return stretches


def _measure_required_height(pieces: Sequence[FlowPiece], index: int) -> float:
    """Return the height that must be free for a piece to begin here, with those that it is kept with; space before it apart."""
    piece = pieces[index]
    total = piece.first_height - piece.before
    while piece.keep_next and index + 1 < len(pieces):
        index += 1
        total += max(piece.after - pieces[index].before, 0)
        piece = pieces[index]
        total += piece.first_height
    return total


def _fill_pages(piece: FlowPiece, page: int, position: float, height: float) -> tuple[int, float]:
    """Return the page on which a piece ends, and the height that is in use there."""
    for row in piece.rows:
        if position and position + row > height:
            page, position = page + 1, piece.repeat
        position += row
        while position > height > 0:
            page, position = page + 1, position - height
    return page, position
