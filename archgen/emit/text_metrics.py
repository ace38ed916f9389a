"""How wide text is, roughly: enough to tell how many lines it takes, and so on which page a heading falls.

The widths are Calibri's, in thousandths of the type size; other fonts are a factor of them. Word lays the pages out itself:
what is estimated here only fills in the page numbers that it shows until the fields are updated, and the widths of columns.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Sequence
from functools import lru_cache

from archgen.frozen import dataclass

_FIRST_CODE = 32
# Calibri from the blank to the tilde; other letters of Europe are close to the mean of these.
_WIDTHS = (
    226, 326, 401, 498, 507, 715, 682, 221, 303, 303, 498, 498, 250, 306, 252, 386, 507, 507, 507, 507, 507, 507, 507, 507,
    507, 507, 268, 268, 498, 498, 498, 463, 894, 579, 544, 533, 615, 488, 459, 631, 623, 252, 319, 520, 420, 855, 646, 662,
    517, 673, 543, 459, 487, 642, 567, 890, 519, 487, 468, 307, 386, 307, 498, 498, 291, 479, 525, 423, 525, 498, 305, 471,
    525, 229, 239, 455, 229, 799, 525, 527, 525, 525, 349, 391, 335, 525, 452, 715, 433, 453, 395, 314, 460, 314, 498,
)  # fmt: skip
_OTHER_WIDTH = 500
_EAST_ASIAN_WIDTH = 1000
_BLANK_WIDTH = _WIDTHS[0] / 1000
_FONT_FACTORS = {
    "calibri": 1.0, "carlito": 1.0, "times new roman": 1.0, "liberation serif": 1.0, "garamond": 0.96, "cambria": 1.06,
    "georgia": 1.12, "arial": 1.11, "helvetica": 1.11, "liberation sans": 1.11, "aptos": 1.07, "segoe ui": 1.1, "tahoma": 1.1,
    "dejavu sans": 1.24, "verdana": 1.26, "consolas": 1.12, "dejavu sans mono": 1.22, "courier new": 1.22, "arial narrow": 0.91,
}  # fmt: skip
_UNKNOWN_FONT_FACTOR = 1.08
BOLD_FACTOR = 1.03
CODE_SCALE = 0.9
"""Type size of identifiers against the text around them, in tables: monospaced letters look larger."""
_CODE_WIDTH = 0.6 * CODE_SCALE
"""Width of a monospaced letter in units of the type size around it. A partner's template may have a narrower one."""
_NAME_PART = re.compile(r"[^_./]*[_./]+|[^_./]+")


def find_font_factor(font: str) -> float:
    """Return how much wider a font runs than Calibri."""
    return _FONT_FACTORS.get(font.casefold(), _UNKNOWN_FONT_FACTOR)


@dataclass(frozen=True, slots=True)
class TextFace:
    """How a paragraph style sets its text, in points. `factor` is its font's width against Calibri's."""

    size: float
    line: float
    before: float = 0
    after: float = 0
    factor: float = 1.0
    left: float = 0
    right: float = 0

    def count_lines(self, text: str, width: float) -> int:
        """Return the number of lines that a text takes in a width in points."""
        # In units of the type size, so that all sizes share what is remembered of a text.
        return count_lines(text, max(width - self.left - self.right, 1) / (self.size * self.factor))


# A report says most of its words and many of its cells again and again.
@lru_cache(maxsize=65536)
def measure_word(word: str) -> float:
    """Return the width of a word, in units of the type size."""
    return math.fsum(_measure_character(ord(sign)) for sign in word) / 1000


def join_hard_blanks(text: str) -> str:
    """Return text in which blanks that do not break are letters, so that it splits where lines may."""
    return text.replace("\u00a0", "_").replace("\u202f", "_")


@lru_cache(maxsize=65536)
def measure_words(text: str) -> tuple[float, ...]:
    """Return the widths of a text's words, in units of the type size; a blank that does not break belongs to its word."""
    return tuple([measure_word(word) for word in join_hard_blanks(text).split()])


@lru_cache(maxsize=65536)
def count_lines(text: str, width: float) -> int:
    """Return the number of lines that a text takes in a width (in units of the type size); at least one."""
    count, position = 1, 0.0
    for word in measure_words(text):
        if position and position + _BLANK_WIDTH + word > width:
            count, position = count + 1, 0.0
        position += word + (_BLANK_WIDTH if position else 0)
        if position > width:
            # Word breaks what is longer than a line at any letter.
            count += int(position // width)
            position %= width
    return count


def measure_code(word: str) -> float:
    """Return the width of an identifier, in units of the type size of the text around it."""
    return len(word) * _CODE_WIDTH


def split_name(name: str) -> list[str]:
    """Return the parts of a name that may stand on different lines: it breaks behind underscores, points and slashes."""
    return _NAME_PART.findall(name) or [name]


def share_width(
    words: Sequence[float], lines: Sequence[float], parts: Sequence[float], weights: Sequence[float], total: float
) -> list[float]:
    """Return the width of each column of a table, by its longest word, its longest line and its longest part of a name.

    Each has the room of its longest line where that is less than its share by weight, and what is left goes to the others;
    none has less than its longest word, as far as there is room.
    """
    least = list(words)
    if math.fsum(least) >= total:
        # Names give way first: they may be broken, other words may not.
        excess, give = math.fsum(least) - total, [max(a - b, 0) for a, b in zip(least, parts, strict=True)]
        share = min(excess / math.fsum(give), 1) if any(give) else 0
        least = [width - room * share for width, room in zip(least, give, strict=True)]
        return [width * total / math.fsum(least) for width in least]
    lines = [max(line, word) for line, word in zip(lines, least, strict=True)]
    if math.fsum(lines) <= total:
        return [line * total / math.fsum(lines) for line in lines]
    # A weight of 0 or less is no mistake to stop at: such a column gets what its words need.
    return _fill_widths(lines, least, [max(weight, 0.01) for weight in weights], total)


def _fill_widths(lines: Sequence[float], least: Sequence[float], weights: Sequence[float], total: float) -> list[float]:
    """Give columns their longest lines, or their longest words, as long as the others' shares by weight allow no more."""
    widths: dict[int, float] = {}
    open_columns = list(range(len(lines)))
    while open_columns:
        room = total - math.fsum(widths.values())
        weight = math.fsum(weights[index] for index in open_columns)
        shares = {index: room * weights[index] / weight for index in open_columns}
        # Who needs more than its share comes first: what it takes, the others lack.
        settled = {index: least[index] for index in open_columns if least[index] > shares[index]} or {
            index: lines[index] for index in open_columns if lines[index] <= shares[index]
        }
        widths |= settled or shares
        open_columns = [index for index in open_columns if index not in (settled or shares)]
    return [widths[index] for index in range(len(lines))]


def _measure_character(code: int) -> int:
    if _FIRST_CODE <= code < _FIRST_CODE + len(_WIDTHS):
        return _WIDTHS[code - _FIRST_CODE]
    return _EAST_ASIAN_WIDTH if unicodedata.east_asian_width(chr(code)) in "WF" else _OTHER_WIDTH
