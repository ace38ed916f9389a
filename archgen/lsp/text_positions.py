"""Positions in texts: archgen counts lines and characters from 1, the protocol from 0, in units that both sides agree on."""

from __future__ import annotations

from collections.abc import Callable

from lsprotocol import types
from pygls.workspace import PositionCodec

from archgen.diagnostics import Span

FindLine = Callable[[str, int], str | None]
"""Returns a line of a file without its end, by its number from 1; None where there is none."""


def to_range(span: Span, find_line: FindLine, codec: PositionCodec) -> types.Range:
    """Return the range of a span; what is nowhere in a text is at its beginning."""
    start = _to_position(span.file, span.line, span.column, find_line, codec)
    return types.Range(start, _to_position(span.file, span.end_line, span.end_column, find_line, codec))


def _to_position(file: str, line: int, column: int, find_line: FindLine, codec: PositionCodec) -> types.Position:
    before = (find_line(file, line) or "")[: max(column - 1, 0)]
    return types.Position(max(line - 1, 0), codec.client_num_units(before))


def to_place(position: types.Position, line_text: str, codec: PositionCodec) -> tuple[int, int]:
    """Return line and column, from 1, of a position; one beyond the end of its line is at the end."""
    units = 0
    for column, character in enumerate(line_text, 1):
        if units >= position.character:
            return position.line + 1, column
        units += codec.client_num_units(character)
    return position.line + 1, len(line_text) + 1


def has_place(span: Span, line: int, column: int) -> bool:
    """Whether a place stands in a span, or right behind it."""
    return (span.line, span.column) <= (line, column) <= (span.end_line, span.end_column)
