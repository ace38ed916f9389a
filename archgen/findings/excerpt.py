"""Quote one line of a file with marks below it: tabs expanded, wide characters counted, long lines cut around the
marks.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from typing import TYPE_CHECKING, NamedTuple

from archgen.findings.escape import visible, width

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

TAB = 4
_CUT = "…"
_LONGEST = 4000
"""The characters of a line that are looked at on each side of a mark: no screen is wider."""


class Mark(NamedTuple):
    """Characters `start` to `end` (from 0, exclusive) of a line to point at, with which sign, and what to say."""

    start: int
    end: int
    sign: str
    text: str = ""


def quote(line: str, marks: Iterable[Mark], limit: int) -> Iterator[tuple[str, Mark | None]]:
    """Yield the line, then a line for each mark, at most `limit` columns wide apart from the marks' texts.

    A mark that ends beyond the line points at its end; an empty one is one sign wide.
    """
    marks = tuple(marks)
    # Cut before anything is measured: a line may be megabytes long.
    base = max(0, min((mark.start for mark in marks), default=0) - _LONGEST)
    line = line[base : base + 2 * _LONGEST + limit]
    cells, columns = _cells(line)
    placed = [(mark, *_place(mark, base, columns)) for mark in marks]
    # The window follows the first mark, which is the primary one.
    left, right = _window(columns[-1], placed[0][1] if placed else 0, placed[0][2] if placed else 0, limit)
    begin, end = bisect_left(columns, left), bisect_right(columns, right) - 1
    head = _CUT if begin > 0 or base else ""
    tail = _CUT if end < len(cells) else ""
    yield (head + "".join(cells[begin:end]) + tail).rstrip(), None
    for mark, start, stop in placed:
        low = min(max(start, columns[begin]), columns[end])
        high = min(stop, columns[end])
        blank = " " * (low - columns[begin] + len(head))
        yield f"{blank}{mark.sign * max(1, high - low)}{' ' + visible(mark.text) if mark.text else ''}", mark


def _cells(line: str) -> tuple[Sequence[str], Sequence[int]]:
    """Return what each character of the line prints as, and the columns where they begin; last, where the line ends."""
    if line.isascii() and line.isprintable():  # nearly always
        return line, range(len(line) + 1)
    cells, columns = [], [0]
    for character in line:
        cell = " " * (TAB - columns[-1] % TAB) if character == "\t" else visible(character)
        cells.append(cell)
        columns.append(columns[-1] + width(cell))
    return cells, columns


def _place(mark: Mark, base: int, columns: Sequence[int]) -> tuple[int, int]:
    """Return the first column of a mark and the one behind it."""
    last = len(columns) - 1
    # At least one column wide, so that an empty mark is seen.
    start = columns[min(max(mark.start - base, 0), last)]
    return start, max(columns[min(max(mark.end - base, 0), last)], start + 1)


def _window(total: int, start: int, stop: int, limit: int) -> tuple[int, int]:
    """Choose the columns to show: all if they fit, else a window with the mark in it and room for both cut signs."""
    if total <= limit:
        return 0, total
    room = max(limit - 2, 1)
    if stop <= room:
        return 0, room
    # A long mark shows its beginning, a short one is centred.
    left = start - room // 4 if stop - start > room * 3 // 4 else min((start + stop) // 2 - room // 2, total - room)
    return max(left, 0), max(left, 0) + room
