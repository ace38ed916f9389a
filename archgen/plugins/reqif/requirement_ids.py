"""Ids for the objects of a ReqIF file: the same object gets the same id in each import."""

from __future__ import annotations

import hashlib
import re

from archgen.plugin.importing import MAX_ID_LENGTH, needs_quotes, spell_in_ascii

_VALID = re.compile(r"[A-Za-z][A-Za-z0-9._-]*\Z")
_OTHER_SIGNS = re.compile(r"[^A-Za-z0-9._-]+")
_DIGEST_LENGTH = 8


def join_prefix(foreign_id: str, prefix: str) -> str:
    """Return the other tool's id as it shows it, on one line: its prefix, which may end in a blank, stands in front."""
    name, prefix = foreign_id.strip(), prefix.lstrip()
    return " ".join((name if name.startswith(prefix.rstrip()) else f"{prefix}{name}").split())


def make_requirement_id(foreign_id: str, prefix: str, identifier: str) -> str:
    """Return the id of an object: `SRS 12` is `SRS-12`, `Höhe 1` is `Hoehe-1`, a bare number 12 is `R-12`.

    `prefix` stands in front of it unless it does already; without a foreign id the object's own `identifier` is taken.
    """
    name = join_prefix(foreign_id.strip() or identifier, prefix)
    made_id = _OTHER_SIGNS.sub("-", spell_in_ascii(name)).strip("-._")
    if not made_id or (not name.isascii() and not re.search(r"[A-Za-z0-9]", made_id)):
        return f"R-{_digest(name)}"
    # YAML readers take `on`, `no` and the like for something else than text.
    if not made_id[0].isalpha() or needs_quotes(made_id):
        made_id = f"R-{made_id}"
    if len(made_id) > MAX_ID_LENGTH:
        made_id = f"{made_id[: MAX_ID_LENGTH - _DIGEST_LENGTH - 1].rstrip('-._')}-{_digest(name)}"
    return made_id


def make_distinct_id(wanted_id: str, identifier: str) -> str:
    """Return another id for an object whose id is taken: the same in each import."""
    return f"{wanted_id[: MAX_ID_LENGTH - _DIGEST_LENGTH - 1]}-{_digest(identifier)}"


def is_requirement_id(text: str) -> bool:
    """Whether a text is a valid id of a requirement."""
    return len(text) <= MAX_ID_LENGTH and _VALID.match(text) is not None


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "replace")).hexdigest()[:_DIGEST_LENGTH]
