"""Make the tables of `archgen/language/tables.json`: what a run needs to know of the language, without its words."""

from __future__ import annotations

import json
from collections.abc import Mapping

from language_description import SLICE, Description, Part, PlainData, list_accepted

_FACTS = ("order", "listed", "bare", "data", "offers")
"""Words by which a key says more of its value than its type."""
_TEXTLESS_KINDS = frozenset({"integer", "boolean", "number"})


_SECTIONS_OF_NO_ELEMENTS = frozenset({"agreements"})
"""Sections by id that say something of several elements: nothing refers to their ids."""


def make_tables(description: Description) -> dict[str, PlainData]:
    """Return the tables by name; `archgen/language/language_tables.py` says what each holds."""
    parts = _name_parts(description)
    keys = {name: part["keys"] for name, part in parts.items() if "keys" in part}
    entries = {name: part["entries"] for name, part in parts.items() if "entries" in part}
    sections = {
        section: entries[part]
        for section, part in keys[SLICE].items()
        if entries.get(part) in description.kinds and section not in _SECTIONS_OF_NO_ELEMENTS
    }
    return {
        "KEYS": keys,
        "ENTRIES": entries,
        "ITEMS": {name: part["items"] for name, part in parts.items() if "items" in part},
        "LIST_ORDERS": {name: part["order"] for name, part in parts.items() if part.get("order", "counts") != "counts"},
        "BARE_PARTS": sorted(name for name, part in parts.items() if _is_bare(part)),
        "DATA_PARTS": sorted(name for name, part in parts.items() if part.get("data")),
        "OFFERS": {name: _as_list(part["offers"]) for name, part in parts.items() if "offers" in part},
        "WORDS": {name: part["values"] for name, part in parts.items() if _is_word(part)},
        "PART_TYPES": {name: part["type"] for name, part in parts.items() if "type" in part},
        "SECTION_KINDS": sections,
        "LISTED_PARTS": sorted(name for name, part in parts.items() if part.get("listed")),
        "PLAIN_SECTIONS": {
            kind: section for section, kind in sections.items() if description.kinds[kind].get("named_by_id")
        },
        "OTHER_WORDS": description.other_words,
        **_make_kind_tables(description),
    }


def _make_kind_tables(description: Description) -> dict[str, PlainData]:
    """Return the tables of what kinds and their keys say."""
    keys_by_kind = {kind: description.keys_of(kind) for kind in description.kinds}
    modelled = {kind: keys_by_kind[kind] for kind, part in description.kinds.items() if part.get("element", True)}
    named = ((f"{kind}.{name}", key) for kind, keys in modelled.items() for name, key in keys.items())
    parts_with_fields = (*description.types.items(), *named)
    declaring = (kind for kind, part in description.kinds.items() if not part.keys() & {"supporting", "like"})
    return {
        "COMMON_SECTIONS": sorted(name for name, key in keys_by_kind[SLICE].items() if key.get("common_word")),
        "ATTRIBUTES": {name: _as_list(part["attribute"]) for name, part in parts_with_fields if "attribute" in part},
        "PLACED_KEYS": {
            kind: names
            for kind, keys in modelled.items()
            if (names := [name for name in keys if "place" in keys[name]])
        },
        "SHORT_KEYS": {kind: _as_list(part["short"]) for kind, part in description.kinds.items() if "short" in part},
        "DECLARING_KEYS": {
            kind: names
            for kind in declaring
            if (names := [name for name, key in keys_by_kind[kind].items() if key.get("declares")])
        },
        "ANNOTATED_KINDS": description.kinds_with("properties"),
        "SUPPORTING_KEYS": {
            kind: sorted(name for name, key in keys_by_kind[kind].items() if key["declares"] is False)
            for kind, part in description.kinds.items()
            if part.get("supporting")
        },
    }


def _name_parts(description: Description) -> dict[str, Part]:
    """Return all parts by name; what they refer to is a name, too."""
    parts: dict[str, Part] = {}
    for name, part in description.types.items():
        parts[name] = _name_references(name, part, description, parts)
    for kind, part in description.kinds.items():
        parts[kind] = _name_references(kind, {**part, "keys": description.keys_of(kind)}, description, parts)
    return parts


def _name_references(place: str, part: Part, description: Description, parts: dict[str, Part]) -> Part:
    """Return a part with a name for each part in it; those that stand here alone are added to `parts`."""

    def name_part(name: str, inner: Part | str) -> str:
        if isinstance(inner, str):
            return inner
        own_facts = {word: inner[word] for word in _FACTS if word in inner}
        if "type" in inner and not own_facts:
            return str(inner["type"])
        # A key that says more than its type of what stands there is a part of its own.
        base = parts_of(inner["type"]) if "type" in inner else inner
        parts[name] = _name_references(name, {**base, **own_facts}, description, parts)
        parts[name] |= {"type": inner["type"]} if "type" in inner else {}
        return name

    def parts_of(name: str) -> Part:
        shared = description.parts[name]
        return {**shared, "keys": description.keys_of(name)} if name in description.kinds else shared

    named = dict(part)
    if "keys" in part:
        named["keys"] = {key: name_part(f"{place}.{key}", inner) for key, inner in part["keys"].items()}
    if "entries" in part:
        named["entries"] = name_part(f"{place}.*", part["entries"])
    if "also_entries" in part:
        named["entries"] = part["also_entries"]
    if "items" in part:
        named["items"] = name_part(f"{place}[]", part["items"])
    return named


def _is_bare(part: Part) -> bool:
    scalars = set(list_accepted(part)) - {"null", "object", "array"}
    return bool(part.get("bare")) or (bool(scalars) and scalars <= _TEXTLESS_KINDS)


def _is_word(part: Part) -> bool:
    return "values" in part and "string" in list_accepted(part)


def _as_list(value: str | list[str]) -> list[str]:
    return [value] if isinstance(value, str) else value


def format_tables(tables: Mapping[str, PlainData]) -> str:
    """Return tables as JSON in which each row has a line."""
    return "{\n" + ",\n".join(f"{json.dumps(name)}: {_format_table(table)}" for name, table in tables.items()) + "\n}\n"


def _format_table(table: PlainData) -> str:
    if not isinstance(table, Mapping):
        return json.dumps(table)
    return "{\n" + ",\n".join(f"  {json.dumps(name)}: {json.dumps(row)}" for name, row in table.items()) + "\n}"
