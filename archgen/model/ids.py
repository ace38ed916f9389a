"""Ids of elements: which texts are valid, and how to make one from a name."""

from __future__ import annotations

import hashlib
import re
import unicodedata

LONGEST = 64
RESERVED = frozenset({"true", "false", "null", "any", "all", "none", "self"})
_ID = re.compile(r"[a-z][a-z0-9]*(?:_[a-z0-9]+)*\Z")
_HUMP = re.compile(r"(?<=[a-z])(?=[A-Z][a-z])")
# Letters that Unicode's NFKD does not decompose to ASCII (they would be dropped), and `&`.
_LETTERS = {"ß": "ss", "æ": "ae", "Æ": "Ae", "ø": "o", "Ø": "O", "ł": "l", "Ł": "L", "đ": "d", "Đ": "D", "&": " and "}
_EXPANDED = str.maketrans(_LETTERS)


def is_id(text: str) -> bool:
    """Whether a text is a valid id of an element."""
    return len(text) <= LONGEST and text not in RESERVED and _ID.match(text) is not None


def made(name: str, prefix: str) -> str:
    """Make an id from a name: `Object Recognition (3D)` is `object_recognition_3d`.

    `prefix` is put in front of names that begin with a digit or are reserved words. A name without any Latin letter or
    digit becomes the prefix and a digest of the name, so that the same name always makes the same id.
    """
    plain = unicodedata.normalize("NFKD", name.translate(_EXPANDED)).encode("ascii", "ignore").decode()
    words = re.findall(r"[a-z0-9]+", _HUMP.sub(" ", plain).lower())
    # Cutting may leave an underscore at the end, which no id may have.
    found = "_".join(words)[:LONGEST].strip("_")
    if not found:
        return f"{prefix}_{hashlib.sha256(name.encode('utf-8', 'replace')).hexdigest()[:6]}"
    if found[0].isdigit() or found in RESERVED:
        return f"{prefix}_{found}"[:LONGEST].strip("_")
    return found


def free(wanted: str, taken: frozenset[str] | set[str]) -> str:
    """Return the wanted id, or if it is used already the first unused one of `wanted_2`, `wanted_3`, ..."""
    found, number = wanted, 2
    while found in taken:
        ending = f"_{number}"
        found = wanted[: LONGEST - len(ending)].strip("_") + ending
        number += 1
    return found
