"""Characters that look like what YAML asks for and are something else: they come with text from word processors."""

from __future__ import annotations

import re

_NAMES = {
    "\u00a0": "no-break blank",
    "\u00ad": "soft hyphen",
    "\u2007": "figure blank",
    "\u200b": "zero-width blank",
    "\u200c": "zero-width non-joiner",
    "\u200d": "zero-width joiner",
    "\u2009": "thin blank",
    "\u2011": "no-break hyphen",
    "\u2013": "en dash",
    "\u2014": "em dash",
    "\u2018": "typographic quote",
    "\u2019": "typographic quote",
    "\u201a": "typographic quote",
    "\u201c": "typographic quote",
    "\u201d": "typographic quote",
    "\u201e": "typographic quote",
    "\u202f": "narrow no-break blank",
    "\u2060": "word joiner",
    "\u2212": "minus sign",
    "\u3000": "wide blank",
    "\ufeff": "byte order mark",
    "\uff0c": "wide comma",
    "\uff1a": "wide colon",
}
_REPLACEMENTS = str.maketrans(
    {
        **dict.fromkeys("\u00a0\u2007\u2009\u202f\u3000", " "),
        **dict.fromkeys("\u00ad\u200b\u200c\u200d\u2060\ufeff", ""),
        **dict.fromkeys("\u2011\u2013\u2014\u2212", "-"),
        **dict.fromkeys("\u201c\u201d\u201e", '"'),
        **dict.fromkeys("\u2018\u2019\u201a", "'"),
        "\uff0c": ",",
        "\uff1a": ":",
    }
)
_ODD_CHARACTER = re.compile(f"[{''.join(_NAMES)}]")
_MISPLACED_CHARACTER = re.compile(
    # In the indentation; as the mark of a list entry; or where a value or a key begins, in place of a quote.
    "^[ \t]*(?P<indent>[\u00a0\u2007\u2009\u200b\u202f\u3000\ufeff])"
    "|^[ \t]*(?P<dash>[\u2011\u2013\u2014\u2212])[ \t]"
    "|(?:^|[:\\[{,-])[ \t]*(?P<quote>[\u2018\u2019\u201a\u201c\u201d\u201e])"
    "|(?P<colon>\uff1a)"
    # Behind the colon of a key, which then is none.
    "|^[ \t]*(?:- +)?[\\w.-]+:(?P<blank>[\u00a0\u2007\u2009\u202f\u3000])"
)


def find_odd_character(text: str) -> int | None:
    """Return the position of the first odd character of a text; None where there is none."""
    match = None if text.isascii() else _ODD_CHARACTER.search(text)
    return match.start() if match else None


def find_misplaced_character(line: str) -> int | None:
    """Return the position of the first odd character that stands where YAML's own signs do; None where there is none.

    In text of its own such a character is nobody's mistake.
    """
    match = None if line.isascii() else _MISPLACED_CHARACTER.search(line)
    return match.start(match.lastgroup or 0) if match else None


def name_character(character: str) -> str:
    """Return an odd character in words: `a no-break blank (U+00A0)`."""
    name = _NAMES[character]
    return f"{'an' if name[0] in 'aeio' else 'a'} {name} (U+{ord(character):04X})"


def replace_odd_characters(text: str) -> str:
    """Return a text with the plain characters that look like its odd ones."""
    return text.translate(_REPLACEMENTS)
