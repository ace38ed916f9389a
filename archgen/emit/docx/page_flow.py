"""The report as a flow of pieces, and an estimate of the page that each of them falls on.

Word shows the stored page numbers until somebody updates the fields, and asks no question if it need not update them itself. So they must
be close. Everything that decides them is known but the exact breaking of lines: heights of lines, rows, pictures and spaces.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from typing import Literal

from archgen.emit.docx.paper_sheets import PaperSheet
from archgen.frozen import dataclass, replace

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
