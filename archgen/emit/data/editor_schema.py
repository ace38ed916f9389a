"""The JSON Schema of one project, for editors: the language's own, with the project's names where they fit.

It says no more than the language's schema, since a name that nothing declares yet may be declared next: names are
offered, never required. Its form follows what yaml-language-server and the editors' own YAML support make of a schema.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from typing import Any

from archgen.diagnostics import join_words
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
    names = {
        kind: tuple(each for each in kind_names if each.name not in _BUILT_IN_NAMES)
        for kind, kind_names in names.items()
    }
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
        _explain_part(part, keeps_examples=any(part is definitions[name] for name in _OFFERED_EXAMPLES))
        if part is not schema:
            _allow_empty(part)
    for kind in sorted({kind for kinds in OFFERS.values() for kind in kinds} - _LISTED_KINDS):
        definitions[f"offered_{kind}"] = _list_words(names[kind])
    return schema


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
    if "string" in _list_types(part) and kinds[0] not in _LISTED_KINDS:
        part["anyOf"] = [{}, *({"$ref": f"#/$defs/offered_{kind}"} for kind in kinds)]
    if "items" in part:
        # Snippets, and a reference that stands alone: where yaml-language-server sees alternatives of entries (it makes
        # them of what stands beside a reference, too), it offers "- (array item) ..." as well.
        offered_names = [each for kind in kinds for each in keep_plain_names(names[kind])]
        definition = part["items"] | {
            "offers": [
                {"bodyText": each.name, **({"description": each.meaning} if each.meaning else {})}
                for each in offered_names
            ]
        }
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
    words: SchemaPart = {"type": "string", "enum": [each.name for each in names], **_NEVER_VALID}
    # An editor that builds a message from hundreds of names at each value would be slow.
    words["errorMessage"] = "no name of this project"
    if any(each.meaning for each in names):
        words["enumDescriptions"] = [each.meaning for each in names]
    return words if names else dict(_NEVER_VALID)


SchemaPart = dict[str, Any]
_OFFERED_EXAMPLES = frozenset(
    {"bandwidth", "duration", "frequency", "size", "percentage", "latency", "execution_time", "timing_use"}
    | {"constant_type", "field_type"}
)
"""Definitions whose examples are offered: they show the form, and mean no element of another project."""
_WORD_PATTERN = re.compile(r"\^\(\?:([a-z0-9_|]+)\)\$\Z")
"""A pattern that lists words, as in the short form of `qos`."""
_PLAIN_TEXT = re.compile(r"(?![0-9.]+\Z)[A-Za-z0-9/](?:[^:#,\[\]{}\n]|:(?=\S))*\Z")
"""Text that needs no quotes in YAML, in lists neither."""
_TYPE_PHRASES = {
    "object": "a mapping",
    "array": "a list",
    "string": "text",
    "number": "a number",
    "integer": "a whole number",
    "boolean": "`true` or `false`",
}
_NEVER_VALID: SchemaPart = {"not": {}}
"""What makes an alternative an offer only: editors list its words, but do not take it for what a value is. Else a hover
over one name would list all of them."""


def _explain_part(part: SchemaPart, *, keeps_examples: bool) -> None:
    """Move the examples into the explanation, where they explain and are not offered as values."""
    examples = part.pop("examples", []) if not keeps_examples else []
    examples = [*examples, *(snippet["body"] for snippet in part.pop("defaultSnippets", []))]
    if "offers" in part:
        part["defaultSnippets"] = part.pop("offers")
    if "description" not in part:
        return
    if part.get("$ref", "").rpartition("/")[2] in _OFFERED_EXAMPLES:
        examples = []
    blocks = [f"```yaml\n{_write_example(example)}\n```" for example in examples if example not in ({}, [])]
    part["markdownDescription"] = "\n\n".join((part["description"], *(f"Example:\n\n{block}" for block in blocks)))


def _write_example(value: object) -> str:
    """Return an example as YAML, in block style as far as a person would write it so."""
    if isinstance(value, dict):
        return "\n".join(_write_entry(key, below) for key, below in value.items())
    return _write_flow(value)


def _write_entry(key: str, value: object) -> str:
    if isinstance(value, dict):
        return "\n".join((f"{key}:", *(f"  {line}" for line in _write_example(value).splitlines())))
    return f"{key}: {_write_flow(value)}"


def _write_flow(value: object) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(_write_flow, value))}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key}: {_write_flow(below)}' for key, below in value.items())}}}"
    is_plain = isinstance(value, str) and _PLAIN_TEXT.match(value)
    return str(value) if is_plain else json.dumps(value, ensure_ascii=False)


def _allow_empty(part: SchemaPart) -> None:
    """Take an empty value as it is, without offering `null` for it, and say in words which kinds of value are right.

    Language servers offer what `type` names: `null` everywhere, and `true` for a title. Below `else` they do not look
    for offers.
    """
    types = _list_types(part)
    if "null" not in types:
        if "boolean" in types:
            part |= {"if": {}, "then": {"type": part.pop("type")}}
        return
    del part["type"]
    words = [word for word in part.pop("enum", []) if word is not None]
    kinds = [kind for kind in types if kind != "null"]
    # What stands outside of `else` decides what an editor writes behind the key: a value, or a list or mapping below it.
    moved_keys = ("if", "then", *(("items", "properties", "additionalProperties") if kinds[0] == "string" else ()))
    rest = {key: part.pop(key) for key in moved_keys if key in part}
    if kinds[0] == "array":
        # Else the entries of a list would be offered as the value behind the key.
        rest["items"], part["items"] = part["items"], {}
    part["if"] = {"type": "null"}
    part["else"] = {"type": kinds, "errorMessage": _describe_types(part, kinds, words), **rest}
    if words:
        part["else"]["enum"] = words
    _show_kind(part, kinds, words or _list_pattern_words(part, rest))


def _show_kind(part: SchemaPart, kinds: list[str], words: list[str]) -> None:
    """Give a part without `type` what editors need to write its key: `key:`, then a value or a new line."""
    offers = part.pop("anyOf", [{}])
    if kinds == ["boolean"]:
        offers.append({"enum": [True, False], **_NEVER_VALID})
    if words:
        offers.append({"type": "string", "enum": words, **_NEVER_VALID})
    if kinds[0] == "object":
        part.setdefault("properties", {})
    # A second alternative at least: with one that always holds, a hover would show it in place of the part.
    part["anyOf"] = offers if len(offers) > 1 else [*offers, dict(_NEVER_VALID)]


def _list_pattern_words(part: SchemaPart, rest: SchemaPart) -> list[str]:
    """Return the words of a pattern that lists them, or of the enumeration that a text is held against."""
    match = _WORD_PATTERN.match(part.get("pattern", ""))
    return match[1].split("|") if match else rest.get("then", {}).get("enum", [])


def _describe_types(part: SchemaPart, kinds: list[str], words: list[str]) -> str:
    if words:
        return f"write {join_words([f'`{word}`' for word in words], 'or')}"
    explanation = part.get("patternErrorMessage")
    if explanation and "unit" in explanation:
        return f"write the unit, too: {explanation}"
    phrases = [_TYPE_PHRASES[kind] for kind in kinds if kind != "boolean" or "string" not in kinds]
    return explanation or f"write {join_words(phrases, 'or')}"


def _list_types(part: SchemaPart) -> list[str]:
    """Return the types that a value of a part may have, in the words of JSON Schema."""
    types = part.get("type", [])
    return [types] if isinstance(types, str) else types
