"""What the attributes of ReqIF files mean, by the names that Doors, Polarion and others give them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

from archgen.plugins.reqif.reqif_document import ReqifDocument, ReqifObject

_NAMES_BY_MEANING: Mapping[str, tuple[str, ...]] = {
    "id": ("foreignid", "objectidentifier", "identifier", "id", "reqid", "requirementid"),
    "prefix": ("prefix", "idprefix"),
    "deleted": ("foreigndeleted",),
    "name": ("name", "title", "objectshorttext", "summary", "shorttext"),
    "text": ("text", "objecttext", "primarytext"),
    "description": ("description",),
    "heading": ("chaptername", "objectheading", "heading"),
    "sort": ("objecttype", "artifacttype", "reqtype", "type"),
    "kind": ("kind", "requirementtype", "requirementkind", "category"),
    "priority": ("priority", "importance"),
    "rationale": ("rationale", "justification"),
    "source": ("source", "origin"),
    "tags": ("tags", "labels"),
}
"""Names without case, blanks and signs, and without `ReqIF.` in front; the first that an object has counts."""
MEANING_BY_NAME = {name: meaning for meaning, names in _NAMES_BY_MEANING.items() for name in names}
_RANKS = {name: rank for names in _NAMES_BY_MEANING.values() for rank, name in enumerate(names)}
HEADING_SORTS = frozenset(
    {"heading", "chapter", "ueberschrift", "überschrift", "information", "info", "folder", "document"}
)
"""What an object of these types says is no requirement."""
PART_RELATIONS = frozenset(
    {
        "partof",
        "ispartof",
        "parent",
        "hasparent",
        "childof",
        "refines",
        "derives",
        "derivedfrom",
        "decomposes",
        "archgenpartof",
    }
)
"""Relations from a part to what it is part of."""


@lru_cache(4096)
def fold_attribute_name(name: str) -> str:
    """Return a name as names are compared: `ReqIF.ForeignID` is `foreignid`."""
    folded = "".join(letter for letter in name.casefold() if letter.isalnum())
    return folded.removeprefix("reqif") or folded


@dataclass(frozen=True, slots=True)
class ReadMeanings:
    """An object's values by what they mean; those of an enumeration with several values one by one; other attributes."""

    values: dict[str, str]
    chosen: dict[str, list[str]]
    unknown_names: list[str]


def read_meanings(document: ReqifDocument, entry: ReqifObject) -> ReadMeanings:
    """Return what an object's attributes mean."""
    values: dict[str, tuple[int, str]] = {}
    chosen: dict[str, list[str]] = {}
    unknown_names: list[str] = []
    choices = {key: [document.names.get(each, each) for each in ids] for key, ids in entry.choices.items()}
    texts = {key: ", ".join(words) for key, words in choices.items()}
    for definition, text in (*entry.values.items(), *texts.items()):
        name = document.names.get(definition, "")
        folded = fold_attribute_name(name)
        meaning = MEANING_BY_NAME.get(folded)
        if meaning is None:
            unknown_names.append(name or definition)
        elif meaning not in values or _RANKS[folded] < values[meaning][0]:
            # A blank at the end of a prefix stands between it and the number.
            values[meaning] = (_RANKS[folded], text if meaning == "prefix" else text.strip())
            chosen[meaning] = choices.get(definition, [])
    found_values = {meaning: text for meaning, (_, text) in values.items()}
    return ReadMeanings(found_values, {key: words for key, words in chosen.items() if words}, unknown_names)
