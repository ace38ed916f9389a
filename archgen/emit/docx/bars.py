"""Bars in the text: stretches of blanks on coloured ground, which any program shows and prints."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.emit.docx.word_xml import format_run
from archgen.emit.text_metrics import measure_word
from archgen.views.shapes import Text, WaterfallPiece

METER_LENGTH, PIECES_LENGTH = 40.0, 200.0
"""Lengths of a bar in points: of a share, and of stretches on an axis."""
_BLANK = "\u00a0"
_BLANK_WIDTH = measure_word(" ")
_TYPE_SIZE = 5.0
"""Type size of the blanks: how high the bar is."""
_PALE = "E4E9ED"
_COLOURS = {
    "met": "1C6B3C", "not proven": "C78A2B", "open": "C78A2B", "missed": "B3261E", "uncovered": "C78A2B", "warning": "C78A2B",
    "sampling": "9CC5DF", "response": "1F6FB5", "link": "8D99A3",
}  # fmt: skip


def measure_bar(text: Text) -> float:
    """Return the length of a run's bar in points, 0 where it has none."""
    return PIECES_LENGTH if text.pieces else METER_LENGTH if text.meter else 0.0


def format_bar(text: Text, width: float) -> str:
    """Return the runs of a run's bar, `width` points long where that is known and less than usual."""
    length = min(measure_bar(text), width or METER_LENGTH * 4)
    count = max(int(length / (_BLANK_WIDTH * _TYPE_SIZE)), 1)
    return "".join(_format_stretch(size, colour) for size, colour in _list_stretches(text, count))


def _list_stretches(text: Text, count: int) -> Iterator[tuple[int, str]]:
    """Yield the stretches of a bar of so many blanks, each with its colour: empty for none."""
    if text.meter and not text.pieces:
        filled = min(max(round(text.meter.share * count), 1 if text.meter.share else 0), count)
        yield filled, _COLOURS.get(text.meter.status, _PALE)
        yield count - filled, _PALE
        return
    position = 0
    for piece in text.pieces:
        start, end = round(piece.start * count), round(piece.end * count)
        start = max(start, position)
        yield start - position, ""
        position = max(end, start + 1)
        yield from _list_piece(piece, position - start)
    if text.meter:
        yield count - position, _PALE


def _list_piece(piece: WaterfallPiece, size: int) -> Iterator[tuple[int, str]]:
    colour = _COLOURS.get(piece.kind, "")
    if piece.is_cut and size > 4:  # noqa: PLR2004 - two halves, and what parts them
        # Drawn short: two halves with a gap.
        yield from ((size // 2 - 1, colour), (1, ""), (size - size // 2, colour))
    else:
        yield size, colour or "unknown"


def _format_stretch(size: int, colour: str) -> str:
    if size <= 0:
        return ""
    half_points = round(_TYPE_SIZE * 2)
    shade = ""
    if colour == "unknown":
        shade = '<w:shd w:val="diagStripe" w:color="C78A2B" w:fill="FBF1E4"/>'
    elif colour:
        shade = f'<w:shd w:val="clear" w:color="auto" w:fill="{colour}"/>'
    return format_run(_BLANK * size, f'<w:sz w:val="{half_points}"/><w:szCs w:val="{half_points}"/>{shade}')
