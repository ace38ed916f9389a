"""Ids of elements: which texts are valid, and how to make one from a name."""

from __future__ import annotations

import hashlib
import re
import unicodedata
from collections.abc import Container, Mapping

ElementFiles = Mapping[tuple[str, str], tuple[str, ...]]
"""The files in which elements are written, by kind (`group`, `component`, `node`) and complete id, in order of appearance."""

MAX_ID_LENGTH = 64
RESERVED_IDS = frozenset({"true", "false", "null", "any", "all", "none", "self"})
_ID_PATTERN = re.compile(r"[a-z][a-z0-9]*(?:_[a-z0-9]+)*\Z")
_CAMEL_CASE_HUMP = re.compile(r"(?<=[a-z])(?=[A-Z][a-z])")
# Letters that Unicode's NFKD does not decompose to ASCII (they would be dropped), and `&`.
_LATIN_SPELLINGS = {
    "ß": "ss",
    "æ": "ae",
    "Æ": "Ae",
    "ø": "o",
    "Ø": "O",
    "ł": "l",
    "Ł": "L",
    "đ": "d",
    "Đ": "D",
    "&": " and ",
}
# As in passports (ICAO 9303) and German: whoever reads `hohe` for `Höhe` reads another word. A name does not say its
# language, so the few French and Spanish words with `ü`, and Swedish, Finnish and Turkish names, are spelled so, too.
_UMLAUT_SPELLINGS = {"ä": "ae", "ö": "oe", "ü": "ue", "Ä": "Ae", "Ö": "Oe", "Ü": "Ue", "œ": "oe", "Œ": "Oe", "ẞ": "Ss"}
_CAPITAL_UMLAUT = re.compile(r"[ÄÖÜ](?![a-zäöüß])")
_SPELLING_TABLE = str.maketrans(_LATIN_SPELLINGS | _UMLAUT_SPELLINGS)


def is_id(text: str) -> bool:
    """Whether a text is a valid id of an element."""
    return len(text) <= MAX_ID_LENGTH and text not in RESERVED_IDS and _ID_PATTERN.match(text) is not None


def spell_in_ascii(name: str) -> str:
    """Return a name in ASCII: `Höhe` as `Hoehe`; letters of other alphabets are dropped."""
    # macOS writes an umlaut as a letter and a mark: composed first, both spellings make one id.
    composed_name = unicodedata.normalize("NFC", name)
    # In a word of capitals both letters are: `AeOe` would be two words.
    composed_name = _CAPITAL_UMLAUT.sub(lambda match: _UMLAUT_SPELLINGS[match[0]].upper(), composed_name)
    return unicodedata.normalize("NFKD", composed_name.translate(_SPELLING_TABLE)).encode("ascii", "ignore").decode()


def make_id(name: str, prefix: str) -> str:
    """Make an id from a name: `Object Recognition (3D)` is `object_recognition_3d`, `Höhe` is `hoehe`.

    `prefix` is put in front of names that begin with a digit or are reserved words. A name without any Latin letter or
    digit becomes the prefix and a digest of the name, so that the same name always makes the same id.
    """
    ascii_name = spell_in_ascii(name)
    words = re.findall(r"[a-z0-9]+", _CAMEL_CASE_HUMP.sub(" ", ascii_name).lower())
    # Cutting may leave an underscore at the end, which no id may have.
    element_id = "_".join(words)[:MAX_ID_LENGTH].strip("_")
    if not element_id:
        return f"{prefix}_{hashlib.sha256(name.encode('utf-8', 'replace')).hexdigest()[:6]}"
    if element_id[0].isdigit() or element_id in RESERVED_IDS:
        return f"{prefix}_{element_id}"[:MAX_ID_LENGTH].strip("_")
    return element_id


_FEW_NUMBERS = 100
"""Up to this number each is tried."""


def make_unique_id(wanted_id: str, used_ids: Container[str], first_number: int = 2) -> str:
    """Return the wanted id, or if it is used already the first unused one of `wanted_2`, `wanted_3`, ...

    One that is too long is cut. Behind many used numbers it is one after which no number is used, found by halves: trying
    all of them for each of thousands of elements would take hours.
    """
    element_id = wanted_id[:MAX_ID_LENGTH].strip("_")
    if element_id not in used_ids:
        return element_id
    last_used, number, step = first_number - 1, first_number, 1
    while number_id(wanted_id, number) in used_ids:
        step *= 2 if number > _FEW_NUMBERS else 1
        last_used, number = number, number + step
    while number - last_used > 1:
        middle = (last_used + number) // 2
        if number_id(wanted_id, middle) in used_ids:
            last_used = middle
        else:
            number = middle
    return number_id(wanted_id, number)


def number_id(element_id: str, number: int) -> str:
    """Return an id with a number behind it, cut if it is too long: `arm_2`."""
    ending = f"_{number}"
    return element_id[: MAX_ID_LENGTH - len(ending)].strip("_") + ending
