"""Make text from files safe to print: whatever could move a terminal's cursor, or hide or reorder text, becomes
visible.
"""

from __future__ import annotations

import json
import unicodedata

_JOINERS = frozenset("\u200c\u200d")
"""Joiners: some scripts need them, and they do no harm."""


def make_visible(text: str) -> str:
    """Return the text with every control, formatting and line-separating character replaced by a visible one.

    Control characters become their pictures (escape is `␛`), all others that do not print become `�`.
    """
    # Nearly every text: both tests run in C.
    if text.isascii() and text.isprintable():
        return text
    return "".join(_visible_character(character) for character in text)


def defuse_command(line: str) -> str:
    """Return a visible line that no workflow takes for one of its commands, which begin with `::` after blanks."""
    blanks = len(line) - len(line.lstrip())
    return f"{line[:blanks]}\\{line[blanks:]}" if line.startswith("::", blanks) else line


def format_json(data: object) -> str:
    """Return JSON in which everything that does not print is escaped: the data are the same, and terminals are safe."""
    text = json.dumps(data, ensure_ascii=False, indent=2) + "\n"
    if text.isascii() and "\x7f" not in text:
        return text
    # Such characters occur inside of strings only, where an escape means the same; [1:-1] takes the quotes off.
    return "".join(
        character
        if character == "\n" or character in _JOINERS or _visible_character(character) == character
        else json.dumps(character)[1:-1]
        for character in text
    )


def measure_width(text: str) -> int:
    """Return the columns that a visible text takes in a terminal: wide characters take two, combining ones none."""
    if text.isascii():
        return len(text)
    return sum(_character_width(character) for character in text)


def _visible_character(character: str) -> str:
    code = ord(character)
    if code < 0x20:  # noqa: PLR2004 - the C0 controls
        return chr(0x2400 + code)
    if code == 0x7F:  # noqa: PLR2004 - delete
        return "\u2421"
    # Joiners belong to the category Cf, which is replaced below.
    if character in _JOINERS:
        return character
    return "\ufffd" if unicodedata.category(character) in {"Cc", "Cf", "Cs", "Zl", "Zp"} else character


def _character_width(character: str) -> int:
    if character in _JOINERS or unicodedata.category(character) in {"Mn", "Me"}:
        return 0
    return 2 if unicodedata.east_asian_width(character) in "WF" else 1


def replace_surrogates(text: str) -> str:
    """Return a text as it comes back from a UTF-8 file, and as YAML can hold it: lone surrogates become `?`."""
    return text.encode("utf-8", "replace").decode("utf-8")
