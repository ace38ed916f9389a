"""The language as tables, read from `tables.json`, which `make language` writes from the description in `language/`.

A part is a kind (it has keys), a type, or what stands at one key alone: `KIND.KEY`; `PART.*` are the values of a mapping
by id that have no name of their own, `PART[]` the items of such a list.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal, TypedDict

Reach = Literal["text", "system", "timing"]


class KeyFacts(TypedDict, total=False):
    """What the comparison of a key needs to know: `language/README.md` explains each word.

    Without an `effect` a change reaches as far as timing; without `worse` it makes no figure worse; without a `form` the
    value is compared as it is.
    """

    form: str
    inner: str
    attribute: str
    default: str | int | tuple[str, ...]
    names: str
    effect: Reach
    worse: Literal["less", "more", "always"]
    noun: str
    verb: str
    verbs: tuple[str, str]
    new_verb: str


def _make_tuples(table: dict[str, Any]) -> dict[str, Any]:
    return {name: tuple(value) if isinstance(value, list) else value for name, value in table.items()}


_TABLES = json.loads(Path(__file__).with_name("tables.json").read_text(encoding="utf-8"), object_hook=_make_tuples)

KEYS: Mapping[str, Mapping[str, str]] = _TABLES["KEYS"]
"""The part that stands at each key of each kind."""
ENTRIES: Mapping[str, str] = _TABLES["ENTRIES"]
"""Mappings by id: the part of their values."""
ITEMS: Mapping[str, str] = _TABLES["ITEMS"]
"""Lists: the part of their items."""
LIST_ORDERS: Mapping[str, str] = _TABLES["LIST_ORDERS"]
"""Lists whose order says nothing. `gathered`: both sides may begin one; `headed`: the first item says more."""
BARE_PARTS: frozenset[str] = frozenset(_TABLES["BARE_PARTS"])
"""Values that are no text."""
DATA_PARTS: frozenset[str] = frozenset(_TABLES["DATA_PARTS"])
"""What other programs read: it stays as it was written, whatever its keys are called."""
OFFERS: Mapping[str, tuple[str, ...]] = _TABLES["OFFERS"]
"""Which names of a project fit at a part."""
COMMON_SECTIONS: frozenset[str] = frozenset(_TABLES["COMMON_SECTIONS"])
"""Sections that files of other programs may have, too."""
WORDS: Mapping[str, tuple[str, ...]] = _TABLES["WORDS"]
"""The words of which one stands at a part."""
PART_TYPES: Mapping[str, str] = _TABLES["PART_TYPES"]
"""The types of the parts that say more than their type."""
ATTRIBUTES: Mapping[str, tuple[str, ...]] = _TABLES["ATTRIBUTES"]
"""The fields of the model that hold what stands at a key, or keys of a type, where they are not called as it."""
PLACED_KEYS: Mapping[str, tuple[str, ...]] = _TABLES["PLACED_KEYS"]
"""Keys whose values keep their places, each in a field `KEY_at`."""
SECTION_KINDS: Mapping[str, str] = _TABLES["SECTION_KINDS"]
"""Sections whose keys are ids of elements: the kind of these."""
LISTED_PARTS: frozenset[str] = frozenset(_TABLES["LISTED_PARTS"])
"""Lists in whose place a scalar is a list of one."""
SHORT_KEYS: Mapping[str, tuple[str, ...]] = _TABLES["SHORT_KEYS"]
"""The keys that a scalar or a list in the place of an element stands for."""
PLAIN_SECTIONS: Mapping[str, str] = _TABLES["PLAIN_SECTIONS"]
"""Kinds of elements that are named by their id alone, not by a path, and their sections."""
DECLARING_KEYS: Mapping[str, tuple[str, ...]] = _TABLES["DECLARING_KEYS"]
"""Keys of which a new element has one, where any other key only adds to one."""
ANNOTATED_KINDS: tuple[str, ...] = _TABLES["ANNOTATED_KINDS"]
"""Kinds of elements that may have properties and hints."""
OTHER_WORDS: Mapping[str, Mapping[str, str]] = _TABLES["OTHER_WORDS"]
"""What people call the keys of a kind elsewhere."""
SUPPORTING_KEYS: Mapping[str, tuple[str, ...]] = _TABLES["SUPPORTING_KEYS"]
"""Keys that say something of an element that others declare."""
KIND_EFFECTS: Mapping[str, Reach] = _TABLES["KIND_EFFECTS"]
"""How far a change of an element of each kind reaches at most."""
KEY_FACTS: Mapping[str, Mapping[str, KeyFacts]] = _TABLES["KEY_FACTS"]
"""What is compared of each kind, in the order of its keys; a name with a dot stands for all keys that begin with it."""
RECORD_SECTIONS: Mapping[str, str] = _TABLES["RECORD_SECTIONS"]
"""The members of the resolved record in their order, and what stands there."""
LASTING_SECTIONS: frozenset[str] = frozenset(_TABLES["LASTING_SECTIONS"])
"""Those members that are written where they are empty, too."""
RECORD_KEYS: Mapping[str, Mapping[str, str]] = _TABLES["RECORD_KEYS"]
"""The keys of each part of the resolved record in their order, and what stands there.

`flag` where only true is written, a unit for a quantity in it, the name of a part with keys of its own (`part[]` for a list
of such, `part{}` for a mapping by id), `annotations`; an empty text for plain data.
"""
