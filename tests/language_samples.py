"""What the schema gives as examples, put into projects: so a new key or kind is in them without an edit."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterator, Mapping
from typing import Any

from archgen.language.key_paths import SLICE, find_inner_part
from archgen.language.language_tables import KEYS, OFFERS, SECTION_KINDS
from archgen.syntax.yaml_parser import parse_yaml
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, YamlNode
from tests.running import ROOT

SCHEMA = json.loads((ROOT / "schemas" / "archgen.schema.json").read_text(encoding="utf-8"))


def read_data(text: str) -> dict[str, Any]:
    """Read YAML as archgen does: no word of it is a date or a truth value that the text does not have."""
    document, diagnostics = parse_yaml("text.yaml", text)
    assert document is not None
    assert diagnostics == ()
    data = _read_plain(document.root)
    assert isinstance(data, dict)
    return data


def _read_plain(node: YamlNode) -> object:
    if isinstance(node, MappingNode):
        return {entry.key: _read_plain(entry.value) for entry in node}
    return node.value if isinstance(node, ScalarNode) else [_read_plain(item) for item in node.items]


def list_samples(part: Mapping[str, Any]) -> list[Any]:
    """Return the values that a part of the schema gives as examples, or its type where it gives none."""
    own = [*part.get("examples", ()), *(snippet["body"] for snippet in part.get("defaultSnippets", ()))]
    return own or (list_samples(SCHEMA["$defs"][part["$ref"].rpartition("/")[2]]) if "$ref" in part else [])


def list_elements(data: object, part: str = SLICE) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield each mapping of a project that is of a kind, with the kind."""
    if isinstance(data, dict):
        if part in KEYS:
            yield part, data
        for key, value in data.items():
            yield from list_elements(value, find_inner_part(part, key))
    elif isinstance(data, list):
        for item in data:
            yield from list_elements(item, find_inner_part(part, 0))


def complete_project(data: dict[str, Any], wanted: Mapping[str, Collection[str]]) -> dict[str, Any]:
    """Add to a project the sections of the wanted kinds that it leaves out, and the wanted keys that no element has."""
    for section, kind in SECTION_KINDS.items():
        if kind in wanted:
            data.setdefault(section, {"added-other" if kind == "agreement" else "added": {}})
    written: dict[str, list[dict[str, Any]]] = {}
    for kind, element in list_elements(data):
        written.setdefault(kind, []).append(element)
    for kind, elements in written.items():
        known = {key for element in elements for key in element}
        for key in sorted(set(wanted.get(kind, ())) - known):
            if (part := SCHEMA["$defs"][kind]["properties"].get(key)) is not None:
                elements[0][key] = _name_offered(kind, key, list_samples(part)[0], data)
    return data


def _name_offered(kind: str, key: str, sample: object, data: Mapping[str, Any]) -> object:
    """Return a sample; where it names elements, those of the project."""
    for section in OFFERS.get(KEYS[kind][key], ()):
        if data.get(section):
            name = next(iter(data[section]))
            return [name] if isinstance(sample, list) else name
    return sample
