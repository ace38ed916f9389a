"""Cards: boxes with a bar of load and a table of rows, as labels for Graphviz."""

from __future__ import annotations

from archgen.emit.graphviz import palette
from archgen.emit.graphviz.dot_text import escape_label, wrap_text
from archgen.views.graph_shapes import Box

_CARD_WIDTH = 200
"""The least width of a card's contents, in points: all bars are as wide, so that loads can be compared."""
_FULL = 100.0
_TABLE = '<TABLE BORDER="0" CELLBORDER="0" CELLSPACING="0" CELLPADDING="0">'


def write_card(box: Box, frame: str, fill: str) -> str:
    """Return the html-like label of a card: title, lines, bar and rows."""
    titles = "<BR/>".join(f"<B>{escape_label(row)}</B>" for row in wrap_text(box.title, 34))
    parts = [f'<TR><TD HEIGHT="14"><FONT POINT-SIZE="10" COLOR="{frame}">{titles}</FONT></TD></TR>']
    parts += [f'<TR><TD HEIGHT="11">{_small_text(line)}</TD></TR>' for line in box.lines]
    parts += [f"<TR><TD>{_write_bar(*box.load)}</TD></TR>"] if box.load else []
    if box.rows:
        rows = "".join(_write_row(name, words) for name, words in box.rows)
        parts.append(f"<HR/><TR><TD>{_TABLE}{rows}</TABLE></TD></TR>")
    return (
        f'<<TABLE STYLE="ROUNDED" BORDER="1" COLOR="{frame}" BGCOLOR="{fill}" CELLBORDER="0" CELLSPACING="0" '
        f'CELLPADDING="3">{"".join(parts)}</TABLE>>'
    )


def _small_text(text: str, colour: str = palette.MUTED) -> str:
    return f'<FONT POINT-SIZE="8" COLOR="{colour}">{escape_label(text)}</FONT>'


def _write_bar(percent: float | None, words: str) -> str:
    """Return a bar as long as the load, red above 100 per cent, with its words below; without a figure the words alone."""
    if percent is None:
        return _small_text(words, palette.TEXT)
    used = max(1, round(_CARD_WIDTH * min(percent, _FULL) / _FULL))
    colour = palette.ERROR if percent > _FULL else palette.SUBJECT
    cells = [(used, colour), (_CARD_WIDTH - used, palette.NEIGHBOUR_FILL)]
    bar = "".join(
        f'<TD FIXEDSIZE="TRUE" WIDTH="{width}" HEIGHT="6" BGCOLOR="{fill}"></TD>' for width, fill in cells if width > 0
    )
    # Of fixed size: a table fills its cell, and in a wider card the two parts of the bar would come apart.
    return (
        f'{_TABLE}<TR><TD FIXEDSIZE="TRUE" WIDTH="{_CARD_WIDTH}" HEIGHT="6">{_TABLE}<TR>{bar}</TR></TABLE></TD></TR>'
        f'<TR><TD HEIGHT="11">{_small_text(words, palette.TEXT)}</TD></TR></TABLE>'
    )


def _write_row(name: str, words: str) -> str:
    title = "<BR/>".join(escape_label(row) for row in wrap_text(name, 40))
    if not words:
        return (
            f'<TR><TD COLSPAN="2" ALIGN="LEFT" HEIGHT="14" WIDTH="{_CARD_WIDTH}"><FONT POINT-SIZE="8"><B>'
            f"{title.replace('<BR/>', '</B><BR/><B>')}</B></FONT></TD></TR>"
        )
    detail = "<BR/>".join(escape_label(row) for part in words.split("\n") for row in wrap_text(part, 40))
    return (
        f'<TR><TD ALIGN="LEFT" HEIGHT="11" WIDTH="{_CARD_WIDTH // 2}"><FONT POINT-SIZE="8">{title}</FONT></TD>'
        f'<TD ALIGN="RIGHT" WIDTH="{_CARD_WIDTH // 2}"><FONT POINT-SIZE="8" COLOR="{palette.MUTED}">\u00a0{detail}</FONT></TD></TR>'
    )
