"""The JSON Schema of the language."""

from __future__ import annotations

import functools
import json
from itertools import islice
from typing import TYPE_CHECKING, Any

from archgen import resources
from archgen.diagnostics import find_closest
from archgen.language.language_tables import SECTION_KINDS
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, SequenceNode

if TYPE_CHECKING:
    from collections.abc import Mapping


@functools.cache
def load_schema() -> dict[str, Any]:
    """Return the JSON Schema of the language. Cached and shared: nobody may change it."""
    text = resources.resource_path("schemas", "archgen.schema.json").read_text(encoding="utf-8")
    return json.loads(text)  # type: ignore[no-any-return]


def resolve_part(schema_part: dict[str, Any]) -> dict[str, Any]:
    """Return a part of the schema, or the definition that it refers to."""
    if "$ref" not in schema_part:
        return schema_part
    return load_schema()["$defs"][schema_part["$ref"].rpartition("/")[2]]  # type: ignore[no-any-return]


def find_part_schema(part: str, key: str | None = None) -> dict[str, Any]:
    """Return what the schema says of a part of the language, or of a key of it; empty where it says nothing."""
    name, _, inner = part.removesuffix("[]").partition(".")
    schema_part = load_schema()["$defs"].get(name, load_schema())
    if inner:
        schema_part = _find_property(schema_part, inner)
    if part.endswith("[]"):
        schema_part = resolve_part(schema_part).get("items", {})
    return schema_part if key is None else _find_property(schema_part, key)


def _find_property(schema_part: dict[str, Any], key: str) -> dict[str, Any]:
    resolved = resolve_part(schema_part)
    found = resolved.get("properties", {}).get(key, resolved.get("additionalProperties"))
    return found if isinstance(found, dict) else {}


@functools.cache
def list_keys(kind: str) -> frozenset[str]:
    """Return the keys that elements of a kind have."""
    return frozenset(load_schema()["$defs"][kind]["properties"])


TELLING_NOTHING = frozenset({"title", "description"})
"""Keys that nearly every element has."""
_MAX_KEYS = 20
"""So many keys of an element are compared with those that it may have: other programs' files may have thousands."""
_JUDGED_KINDS = {
    section: kind
    for section, kind in SECTION_KINDS.items()
    if kind not in {"property_declaration", "library", "variant", "frame", "requirement"}
}
"""Sections by whose elements a file of the language is known: those of the others have keys of many meanings, or none."""


def resembles_slice(root: MappingNode) -> bool | None:
    """Whether what a file holds below the names of sections are elements of the language, by their keys; None if nothing tells."""
    is_strange = False
    for entry in root:
        kind = _JUDGED_KINDS.get(entry.key)
        if kind is None:
            continue
        value, keys = entry.value, list_keys(kind)
        if isinstance(value, ScalarNode):
            is_strange |= value.value is not None and len(root.entries) > 1
            continue
        parts = value.items if isinstance(value, SequenceNode) else [part.value for part in value]
        bodies = [part.entries for part in parts if isinstance(part, MappingNode) and part.entries]
        if any(
            2 * len(keys.intersection(body)) >= len(body) and not TELLING_NOTHING.issuperset(body) for body in bodies
        ):
            return True
        is_strange |= bool(bodies) and not any(
            _may_be_slip(body, keys, is_mapping=isinstance(value, MappingNode)) for body in bodies
        )
        # Files that another program lists: no id has a dot or a slash in it.
        is_strange |= isinstance(value, SequenceNode) and any(
            isinstance(part, ScalarNode) and not {*"./"}.isdisjoint(part.text) for part in parts
        )
    return False if is_strange or _has_settings_alone(root) else None


def _has_settings_alone(root: MappingNode) -> bool:
    """Whether a file has settings that are called like ours, such as `project`, beside keys that are no slips of ours."""
    sections = load_schema()["properties"].keys()
    others = [key for key in islice(root.entries, _MAX_KEYS) if key not in sections]
    return (
        0 < len(others) < len(root.entries)
        and SECTION_KINDS.keys().isdisjoint(root.entries)
        and not any(find_closest(key, sections) for key in others)
    )


def _may_be_slip(body: Mapping[str, object], keys: frozenset[str], *, is_mapping: bool) -> bool:
    """Whether an element without a known key of its kind may still be meant as one, or as one of another section."""
    if is_mapping and any(list_keys(kind).issuperset(body) for kind in _JUDGED_KINDS.values()):
        return True
    return any(key in keys or find_closest(key, keys) for key in islice(body, _MAX_KEYS))
