r"""Prepare text for DOT: clean it of what pictures cannot hold, escape it for its place, wrap it to fit a box.

Titles come from files that anybody may have written. In an html-like label `&`, `<` and `>` are markup and `\N` is
replaced by Graphviz; in a quoted string `"` ends it, and a character reference would be read as one. Both are
escaped here and nowhere else. Control characters make an SVG that is not XML, and the marks that turn the direction of
writing make a text look like another: neither gets into a picture.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence

from archgen.views.short_figures import write_comparisons

MAX_TEXT_LENGTH = 400
"""A longer text (in characters) is cut, with an ellipsis; pages and tables have all of it."""

_BLANKS = re.compile(r"\s+")
_UNFIT_CHARACTER = re.compile(
    "[\x00-\x1f\x7f-\x9f\u061c\u200b\u200e\u200f\u2028-\u202e\u2060-\u206f\ud800-\udfff\ufeff\ufff0-\uffff]"
)
_SCHEME = re.compile(r"([A-Za-z][A-Za-z0-9+.-]*):")
_BREAKS = (re.compile(r"(?=/)"), re.compile(r"(?<=[-_.:,;])"))
_ESCAPES = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\\": "&#92;"})


def clean_label_text(text: str, max_length: int = MAX_TEXT_LENGTH) -> str:
    """Return the text on one line, without characters that no picture can hold, cut at `max_length`."""
    text = write_comparisons(text)
    # Of all blanks only the space is printable: most texts have nothing to clean.
    if text.isprintable() and "  " not in text:
        text = text.strip()
        return text if len(text) <= max_length else text[: max_length - 1] + "…"
    text = _BLANKS.sub(" ", text)
    if not text.isprintable():
        # Category Cn: unassigned characters, and noncharacters, which XML does not allow.
        text = "".join(c for c in _UNFIT_CHARACTER.sub("", text) if unicodedata.category(c) != "Cn")
    text = text.strip()
    return text if len(text) <= max_length else text[: max_length - 1] + "…"


def escape_label(text: str) -> str:
    """Escape one line of text for an html-like label."""
    return clean_label_text(text).translate(_ESCAPES) or "\u00a0"


def quote_value(text: str) -> str:
    """Quote a value for DOT. Line feeds stay line feeds."""
    lines = (clean_label_text(line, 4000) for line in text.split("\n"))
    # Graphviz reads `&lt;` in a quoted string as a character reference, so `&` is escaped here too.
    escaped = (line.replace("&", "&amp;").replace("\\", "\\\\").replace('"', '\\"') for line in lines)
    return '"' + "\\n".join(escaped) + '"'


def safe_address(href: str) -> str:
    """Return an address that is safe to follow (relative, http, https, mailto), or an empty text."""
    # Cleaned before the scheme is looked at: browsers drop tabs and line feeds, so a scheme may be hidden by them.
    href = _BLANKS.sub("%20", _UNFIT_CHARACTER.sub("", href).strip())
    scheme = _SCHEME.match(href)
    if scheme and scheme[1].lower() not in {"http", "https", "mailto"}:
        return ""
    return href


def wrap_text(text: str, width: int, lines: int = 4) -> tuple[str, ...]:
    """Wrap a text into lines of about `width` characters, wider only where it would take more than `lines` lines."""
    text = clean_label_text(text)
    width = max(width, -(-len(text) // lines))
    rows = [""]
    # Where a line may end: after blanks; in longer words before `/`, then after other signs; else anywhere.
    for piece in (piece for word in re.findall(r"\S+\s*", text) for piece in _cut_word(word, width, _BREAKS)):
        if rows[-1] and len(rows[-1]) + len(piece.rstrip()) > width:
            rows.append("")
        rows[-1] += piece
    return tuple(row.strip() for row in rows if row.strip()) or ("",)


def _cut_word(word: str, width: int, breaks: Sequence[re.Pattern[str]]) -> list[str]:
    if len(word.rstrip()) <= width:
        return [word]
    if not breaks:
        return [word[at : at + width] for at in range(0, len(word), width)]
    return [piece for part in breaks[0].split(word) if part for piece in _cut_word(part, width, breaks[1:])]
