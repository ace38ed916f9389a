"""Pages filled to their foot: a picture that would begin the next page is drawn smaller, or changes places with its table.

Both go by the estimate of pages. Where that is wrong, a picture is a little smaller than it need be, or behind its table: nothing
is lost, and sentences name figures and tables by their numbers.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

from archgen.emit.docx.page_flow import FlowPiece, PageCursor
from archgen.emit.docx.paper_sheets import PaperSheet

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
