"""How wide text is, roughly: enough to tell how many lines it takes, and so on which page a heading falls.

The widths are Calibri's, in thousandths of the type size; other fonts are a factor of them. Word lays the pages out itself:
what is reckoned here only fills in the page numbers that it shows until the fields are updated, and the widths of columns.
"""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass
from functools import lru_cache

_FIRST = 32
_WIDTHS = (
    226, 326, 401, 498, 507, 715, 682, 221, 303, 303, 498, 498, 250, 306, 252, 386, 507, 507, 507, 507, 507, 507, 507, 507,
    507, 507, 268, 268, 498, 498, 498, 463, 894, 579, 544, 533, 615, 488, 459, 631, 623, 252, 319, 520, 420, 855, 646, 662,
    517, 673, 543, 459, 487, 642, 567, 890, 519, 487, 468, 307, 386, 307, 498, 498, 291, 479, 525, 423, 525, 498, 305, 471,
    525, 229, 239, 455, 229, 799, 525, 527, 525, 525, 349, 391, 335, 525, 452, 715, 433, 453, 395, 314, 460, 314, 498,
)  # fmt: skip
_OTHER = 500
_WIDE = 1000
_SPACE = _WIDTHS[0] / 1000
_FACTORS = {
    "calibri": 1.0, "carlito": 1.0, "times new roman": 1.0, "liberation serif": 1.0, "garamond": 0.96, "cambria": 1.06,
    "georgia": 1.12, "arial": 1.11, "helvetica": 1.11, "liberation sans": 1.11, "aptos": 1.07, "segoe ui": 1.1, "tahoma": 1.1,
    "dejavu sans": 1.24, "verdana": 1.26, "consolas": 1.12, "courier new": 1.22, "arial narrow": 0.91,
}  # fmt: skip
_UNKNOWN_FONT = 1.08
BOLD = 1.03
MONOSPACE = 1.16


def font_factor(font: str) -> float:
    """Give how much wider a font runs than Calibri."""
    return _FACTORS.get(font.casefold(), _UNKNOWN_FONT)


@dataclass(frozen=True, slots=True)
class Face:
    """How a paragraph style sets its text, in points. `factor` is its font's width against Calibri's."""

    size: float
    line: float
    before: float = 0
    after: float = 0
    factor: float = 1.0
    left: float = 0
    right: float = 0
    contextual: bool = False

    def lines(self, text: str, width: float) -> int:
        """Give the number of lines that a text takes in a width."""
        return lines(text, max(width - self.left - self.right, 1) / (self.size * self.factor))


@lru_cache(maxsize=65536)
def word_width(word: str) -> float:
    """Give the width of a word, in units of the type size."""
    return sum(_character(ord(sign)) for sign in word) / 1000


@lru_cache(maxsize=65536)
def word_widths(text: str) -> tuple[float, ...]:
    """Give the widths of a text's words, in units of the type size; a blank that holds belongs to its word."""
    return tuple([word_width(word) for word in text.replace("\u00a0", "_").split()])


@lru_cache(maxsize=65536)
def lines(text: str, width: float) -> int:
    """Give the number of lines that a text takes in a width (in units of the type size); at least one."""
    count, used = 1, 0.0
    for wide in word_widths(text):
        if used and used + _SPACE + wide > width:
            count, used = count + 1, 0.0
        used += wide + (_SPACE if used else 0)
        if used > width:
            count += int(used // width)
            used %= width
    return count


def _character(code: int) -> int:
    if _FIRST <= code < _FIRST + len(_WIDTHS):
        return _WIDTHS[code - _FIRST]
    return _WIDE if unicodedata.east_asian_width(chr(code)) in "WF" else _OTHER
