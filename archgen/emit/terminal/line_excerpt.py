"""Quote one line of a file with marks below it: tabs expanded, wide characters counted, long lines cut around the
marks.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from typing import TYPE_CHECKING, NamedTuple

from archgen.diagnostics.safe_text import make_visible, measure_width

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

TAB_WIDTH = 4
_CUT_SIGN = "…"
_MAX_CHARACTERS = 4000
"""The characters of a line that are looked at on each side of a mark: no screen is wider."""


class ExcerptMark(NamedTuple):
    """Characters `start` to `end` (from 0, exclusive) of a line to point at, with which sign, and what to say."""

    start: int
    end: int
    sign: str
    text: str = ""


def quote_line(line: str, marks: Iterable[ExcerptMark], limit: int) -> Iterator[tuple[str, ExcerptMark | None]]:
    """Yield the line, then a line for each mark, at most `limit` columns wide apart from the marks' texts.

    A mark that ends beyond the line points at its end; an empty one is one sign wide.
    """
    marks = tuple(marks)
    # Cut before anything is measured: a line may be megabytes long.
    first_character = max(0, min((mark.start for mark in marks), default=0) - _MAX_CHARACTERS)
    line = line[first_character : first_character + 2 * _MAX_CHARACTERS + limit]
    cells, columns = _printed_cells(line)
    placed_marks = [(mark, *_mark_columns(mark, first_character, columns)) for mark in marks]
    # The window follows the first mark, which is the primary one.
    left, right = _choose_window(
        columns[-1], placed_marks[0][1] if placed_marks else 0, placed_marks[0][2] if placed_marks else 0, limit
    )
    begin, end = bisect_left(columns, left), bisect_right(columns, right) - 1
    cut_before = _CUT_SIGN if begin > 0 or first_character else ""
    cut_after = _CUT_SIGN if end < len(cells) else ""
    yield (cut_before + "".join(cells[begin:end]) + cut_after).rstrip(), None
    for mark, start, stop in placed_marks:
        mark_start = min(max(start, columns[begin]), columns[end])
        mark_end = min(stop, columns[end])
        blank = " " * (mark_start - columns[begin] + len(cut_before))
        yield (
            f"{blank}{mark.sign * max(1, mark_end - mark_start)}{' ' + make_visible(mark.text) if mark.text else ''}",
            mark,
        )


def _printed_cells(line: str) -> tuple[Sequence[str], Sequence[int]]:
    """Return what each character of the line prints as, and the columns where they begin; last, where the line ends."""
    if line.isascii() and line.isprintable():  # nearly always
        return line, range(len(line) + 1)
    cells, columns = [], [0]
    for character in line:
        cell = " " * (TAB_WIDTH - columns[-1] % TAB_WIDTH) if character == "\t" else make_visible(character)
        cells.append(cell)
        columns.append(columns[-1] + measure_width(cell))
    return cells, columns


def _mark_columns(mark: ExcerptMark, base: int, columns: Sequence[int]) -> tuple[int, int]:
    """Return the first column of a mark and the one behind it."""
    last = len(columns) - 1
    # At least one column wide, so that an empty mark is seen.
    start = columns[min(max(mark.start - base, 0), last)]
    return start, max(columns[min(max(mark.end - base, 0), last)], start + 1)


def _choose_window(total: int, start: int, stop: int, limit: int) -> tuple[int, int]:
    """Choose the columns to show: all if they fit, else a window with the mark in it and room for both cut signs."""
    if total <= limit:
        return 0, total
    room = max(limit - 2, 1)
    if stop <= room:
        return 0, room
    # A long mark shows its beginning, a short one is centred.
    left = start - room // 4 if stop - start > room * 3 // 4 else min((start + stop) // 2 - room // 2, total - room)
    return max(left, 0), max(left, 0) + room
