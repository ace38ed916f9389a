"""Make text from files safe to print: whatever could move a terminal's cursor, or hide or reorder text, becomes
visible.
"""

from __future__ import annotations

import json
import unicodedata

_KEPT = frozenset("\u200c\u200d")
"""Joiners: some scripts need them, and they do no harm."""


def visible(text: str) -> str:
    """Return the text with every control, formatting and line-separating character replaced by a visible one.

    Control characters become their pictures (escape is `␛`), all others that do not print become `�`.
    """
    # Nearly every text: both tests run in C.
    if text.isascii() and text.isprintable():
        return text
    return "".join(_visible(character) for character in text)


def plain_line(line: str) -> str:
    """Return a visible line that no workflow takes for one of its commands, which begin with `::` after blanks."""
    blanks = len(line) - len(line.lstrip())
    return f"{line[:blanks]}\\{line[blanks:]}" if line.startswith("::", blanks) else line


def json_text(data: object) -> str:
    """Return JSON in which everything that does not print is escaped: the data are the same, and terminals are safe."""
    text = json.dumps(data, ensure_ascii=False, indent=2) + "\n"
    if text.isascii() and "\x7f" not in text:
        return text
    # Such characters occur inside of strings only, where an escape means the same; [1:-1] takes the quotes off.
    return "".join(c if c == "\n" or c in _KEPT or _visible(c) == c else json.dumps(c)[1:-1] for c in text)


def width(text: str) -> int:
    """Return the columns that a visible text takes in a terminal: wide characters take two, combining ones none."""
    if text.isascii():
        return len(text)
    return sum(_width(character) for character in text)


def _visible(character: str) -> str:
    code = ord(character)
    if code < 0x20:  # noqa: PLR2004 - the C0 controls
        return chr(0x2400 + code)
    if code == 0x7F:  # noqa: PLR2004 - delete
        return "\u2421"
    # Joiners belong to the category Cf, which is replaced below.
    if character in _KEPT:
        return character
    return "\ufffd" if unicodedata.category(character) in {"Cc", "Cf", "Cs", "Zl", "Zp"} else character


def _width(character: str) -> int:
    if character in _KEPT or unicodedata.category(character) in {"Mn", "Me"}:
        return 0
    return 2 if unicodedata.east_asian_width(character) in "WF" else 1
