"""The JSON Schema of one project, for editors: the language's own, with the project's names where they fit.

It says no more than the language's schema, since a name that nothing declares yet may be declared next: names are
offered, never required. Its form follows what yaml-language-server and the editors' own YAML support make of a schema.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping

from archgen.emit.data.schema_explanations import (
    NEVER_VALID,
    OFFERED_EXAMPLES,
    SchemaPart,
    allow_empty,
    explain_part,
    list_types,
)
from archgen.language.language_tables import OFFERS, SECTION_KINDS
from archgen.views.offered_names import OfferedName, OfferedNames, keep_plain_names

_LISTED_KINDS = frozenset({"inputs", "waypoints"})
"""Names that are offered in lists only: nobody writes a chain of one element."""

_OTHER_SECTIONS = frozenset({"properties", "libraries"})
"""Sections whose ids no other file adds to: properties are offered at elements, a library is one line."""


_BUILT_IN_NAMES = frozenset(
    {
        *("constructor", "hasOwnProperty", "isPrototypeOf", "propertyIsEnumerable", "toLocaleString", "toString"),
        *("valueOf", "__defineGetter__", "__defineSetter__", "__lookupGetter__", "__lookupSetter__", "__proto__"),
    }
)
"""Names that every object of JavaScript has. yaml-language-server takes an offer of that name for one that it has made
already, and then offers nothing at all; as a key `__proto__` makes the schema unreadable."""


def make_editor_schema(language_schema: bytes, names: OfferedNames, rule_summaries: Mapping[str, str]) -> SchemaPart:
    """Return the schema of a project with these names; `rule_summaries` are those of the rules that may be set."""
    schema: SchemaPart = json.loads(language_schema)
    names = {kind: _leave_out_built_in(kind_names) for kind, kind_names in names.items()}
    definitions: dict[str, SchemaPart] = schema["$defs"]
    _add_rules(definitions["rules"], rule_summaries)
    list_items = dict[str, SchemaPart]()
    for place, kinds in OFFERS.items():
        _offer_names(_inline_part(definitions, place), kinds, names, list_items)
    definitions |= list_items
    for section in (section for section in SECTION_KINDS if section not in _OTHER_SECTIONS):
        _offer_keys(definitions[section], names[section])
    _offer_keys(definitions["timing_uses"], names["resources"])
    _offer_keys(definitions["properties"], names["properties"])
    for name, part in definitions["properties"]["properties"].items():
        if choices := names.get(f"choices:{name}"):
            _inline_reference(part, definitions)
            part["anyOf"] = [{}, _list_words(choices)]
    for part in list(_walk_parts(schema)):
        explain_part(part, keeps_examples=any(part is definitions[name] for name in OFFERED_EXAMPLES))
        if part is not schema:
            allow_empty(part)
    for kind in sorted({kind for kinds in OFFERS.values() for kind in kinds} - _LISTED_KINDS):
        definitions[f"offered_{kind}"] = _list_words(names[kind])
    return schema


def _leave_out_built_in(names: tuple[OfferedName, ...]) -> tuple[OfferedName, ...]:
    return tuple(each for each in names if each.name not in _BUILT_IN_NAMES)


def _walk_parts(part: SchemaPart) -> Iterator[SchemaPart]:
    """Yield every subschema that describes a value."""
    yield part
    for group in ("properties", "$defs"):
        for below in part.get(group, {}).values():
            yield from _walk_parts(below)
    for key in ("additionalProperties", "items", "propertyNames"):
        if isinstance(part.get(key), dict):
            yield from _walk_parts(part[key])


def _inline_part(definitions: Mapping[str, SchemaPart], place: str) -> SchemaPart:
    """Return the part at a place, with a copy of what it refers to: offers for one use must not reach the others."""
    name, _, key = place.partition(".")
    part = definitions[name]["properties"][key] if key else definitions[name]
    _inline_reference(part, definitions)
    if isinstance(part.get("items"), dict):
        part["items"] = dict(part["items"])
        _inline_reference(part["items"], definitions)
    return part


def _inline_reference(part: SchemaPart, definitions: Mapping[str, SchemaPart]) -> None:
    if "$ref" in part:
        target = definitions[part.pop("$ref").rpartition("/")[2]]
        for key, value in target.items():
            part.setdefault(key, value)


def _offer_names(
    part: SchemaPart, kinds: tuple[str, ...], names: OfferedNames, list_items: dict[str, SchemaPart]
) -> None:
    """Offer names as the value of a part, and as entries of its list: for these `list_items` get definitions."""
    if "string" in list_types(part) and kinds[0] not in _LISTED_KINDS:
        part["anyOf"] = [{}, *({"$ref": f"#/$defs/offered_{kind}"} for kind in kinds)]
    if "items" in part:
        # Snippets, and a reference that stands alone: where yaml-language-server sees alternatives of entries (it makes
        # them of what stands beside a reference, too), it offers "- (array item) ..." as well.
        offered_names = [each for kind in kinds for each in keep_plain_names(names[kind])]
        definition = part["items"] | {"offers": [_make_snippet(each) for each in offered_names]}
        name = next((name for name, known in list_items.items() if known == definition), f"item_{len(list_items) + 1}")
        list_items[name] = definition
        part["items"] = {"$ref": f"#/$defs/{name}"}


def _offer_keys(section: SchemaPart, names: tuple[OfferedName, ...]) -> None:
    """Offer the ids of a section as keys, with their titles."""
    section["properties"] = {
        each.name: {**section["additionalProperties"], **({"title": each.meaning} if each.meaning else {})}
        for each in names
    }


def _add_rules(rules: SchemaPart, summaries: Mapping[str, str]) -> None:
    """Offer the names of all rules, each with its summary."""
    for name, summary in sorted(summaries.items()):
        setting = rules["properties"].setdefault(name, json.loads(json.dumps(rules["additionalProperties"])))
        setting |= {"title": name, "description": f"{summary} {setting['description']}"}


def _list_words(names: tuple[OfferedName, ...]) -> SchemaPart:
    words: SchemaPart = {"type": "string", "enum": [each.name for each in names], **NEVER_VALID}
    # An editor that builds a message from hundreds of names at each value would be slow.
    words["errorMessage"] = "no name of this project"
    if any(each.meaning for each in names):
        words["enumDescriptions"] = [each.meaning for each in names]
    return words if names else dict(NEVER_VALID)


def _make_snippet(name: OfferedName) -> SchemaPart:
    return {"bodyText": name.name, **({"description": name.meaning} if name.meaning else {})}
