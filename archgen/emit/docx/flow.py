"""The report as a flow of pieces, and an estimate of the page that each of them falls on.

Word shows the stored page numbers until somebody updates the fields, and asks no question if it need not update them itself. So they must
be close. Everything that decides them is known but the exact breaking of lines: heights of lines, rows, pictures and spaces.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from archgen.emit.docx.sheets import Sheet

_TOGETHER = 2
"""Lines of a paragraph that stay together at the foot and at the head of a page."""
_SCRAP = 130.0
"""Points of text that do not deserve a page."""


@dataclass(frozen=True, slots=True)
class Piece:
    """A paragraph, or a table with the empty paragraph behind it. Heights are in points.

    `rows` are the heights of what may stand on different pages: lines or rows. `repeat` is the height of what the next page
    repeats. `sheet` is the paper it needs, None for any. `marks` are the bookmarks at its start.
    """

    xml: str
    rows: tuple[float, ...]
    before: float = 0
    after: float = 0
    keep_next: bool = False
    whole: bool = False
    repeat: float = 0
    sheet: Sheet | None = None
    new_page: bool = False
    marks: tuple[str, ...] = ()

    @property
    def first(self) -> float:
        """Give the height of what stands on the first page at least."""
        return self.before + (
            sum(self.rows) if self.whole or len(self.rows) <= _TOGETHER + 1 else sum(self.rows[:_TOGETHER])
        )


def settle(pieces: Sequence[Piece], base: Sheet) -> tuple[Piece, ...]:
    """Give every piece its sheet: the one it needs, that of the piece it is kept with, or the usual one.

    A scrap of text that would have a usual page to itself, beside a turned one, turns along.
    """
    sheets: list[Sheet] = []
    following: Sheet | None = None
    for piece in reversed(pieces):
        following = piece.sheet or (following if piece.keep_next else None) or base
        sheets.append(following)
    sheets.reverse()
    for start, end in _runs(pieces, sheets, base):
        height = sum(piece.before + sum(piece.rows) + piece.after for piece in pieces[start:end])
        before = sheets[start - 1] if start and not pieces[start].new_page else base
        after = sheets[end] if end < len(pieces) and not pieces[end].new_page else base
        if height <= _SCRAP:
            sheets[start:end] = [after if after != base else before] * (end - start)
    return tuple(replace(piece, sheet=sheet) for piece, sheet in zip(pieces, sheets, strict=True))


def _runs(pieces: Sequence[Piece], sheets: Sequence[Sheet], base: Sheet) -> list[tuple[int, int]]:
    """Give the runs of pieces on the usual sheet between what begins a page."""
    found, start = [], 0
    for index in range(len(pieces) + 1):
        if index == len(pieces) or sheets[index] != base or pieces[index].new_page:
            if start < index:
                found.append((start, index))
            start = index if index < len(pieces) and sheets[index] == base else index + 1
    return found


def pages(pieces: Sequence[Piece], base: Sheet, section: int = 0) -> dict[str, int]:
    """Estimate the page of every bookmark. The pieces have their sheets; at the one numbered `section` a section begins."""
    found: dict[str, int] = {}
    page, used, gap, sheet = 1, 0.0, 0.0, base
    for index, piece in enumerate(pieces):
        height = (piece.sheet or base).text_height
        turned = index > 0 and (index == section or (piece.sheet or base) != sheet)
        sheet = piece.sheet or base
        space = max(gap, piece.before)
        if turned or (piece.new_page and used) or (used and used + space + _needed(pieces, index) > height):
            page, used, space = page + 1, 0.0, piece.before if turned or piece.new_page else 0.0
        found.update(dict.fromkeys(piece.marks, page))
        page, used = _fill(piece, page, used + space, height)
        gap = piece.after
    return found


def _needed(pieces: Sequence[Piece], index: int) -> float:
    """Give the height that must be free for a piece to begin here, with those that it is kept with; spaces before it apart."""
    piece = pieces[index]
    total = piece.first - piece.before
    while piece.keep_next and index + 1 < len(pieces):
        index += 1
        total += max(piece.after - pieces[index].before, 0)
        piece = pieces[index]
        total += piece.first
    return total


def _fill(piece: Piece, page: int, used: float, height: float) -> tuple[int, float]:
    for row in piece.rows:
        if used and used + row > height:
            page, used = page + 1, piece.repeat
        used += row
        while used > height > 0:
            page, used = page + 1, used - height
    return page, used
