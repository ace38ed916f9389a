"""Where in a slice names stand: each key that is an id, and each scalar at a place that takes names of the project.

What a place takes says the description of the language (`offers`); how names are spelt there is said here once.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Literal

from archgen.diagnostics import Span
from archgen.frozen import NamedTuple
from archgen.language.key_paths import OWN_DATA, SLICE, find_inner_part
from archgen.language.language_tables import ENTRIES, KEYS, OFFERS, SECTION_KINDS
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, SequenceNode, YamlNode

Spelling = Literal["path", "plain", "type", "component_type", "selector"]
"""How a name is written: as a dotted path that the resolvers tell of, as an id alone, among `<`, `,` and `[3]`, as the
same behind a library, or as a word of a selector."""
_PATH_OFFERS = ("sources", "implemented", "startable", "step_ends", "waypoints", "inputs", "requirements")
SPELLINGS: Mapping[str, Spelling] = MappingProxyType(
    {
        **dict.fromkeys(SECTION_KINDS, "plain"),
        **dict.fromkeys(_PATH_OFFERS, "path"),
        "requirements": "plain",
        "types": "type",
        "component_type_names": "component_type",
        "selectors": "selector",
    }
)
"""By what a place offers, how names are spelt there."""
DECLARING_PARTS: Mapping[str, str] = MappingProxyType(
    {
        **{section: kind for section, kind in SECTION_KINDS.items() if section != "properties"},
        "property_declarations": "property_declaration",
        "changed_component_types": "component_type",
        "components": "component",
        "inputs": "input",
        "type_inputs": "input",
        "outputs": "output",
        "actors": "actor",
    }
)
"""The mappings whose keys are ids of elements, with their kinds."""
NAMING_PARTS: Mapping[str, str] = MappingProxyType(
    {
        **dict.fromkeys(("topics", "calls", "timing_inputs", "timing_outputs", "timing_calls", "timing_uses"), "path"),
        "policy_exceptions": "path",
        "properties": "property_declaration",
        "review.accepted": "accepted",
        "agreement.interfaces": "accepted",
    }
)
"""The mappings whose keys name elements: by a path that the resolvers tell of, or by their kind."""


class WrittenPlace(NamedTuple):
    """A key that is an id (then `part` is its mapping's), or a scalar with the part that it is."""

    path: tuple[str | int, ...]
    part: str
    text: str
    span: Span
    is_key: bool


def list_written_places(node: YamlNode, part: str = SLICE, path: tuple[str | int, ...] = ()) -> Iterator[WrittenPlace]:
    """Yield the keys that are ids and the scalars below a node, in order; what other programs read is left out."""
    if isinstance(node, ScalarNode):
        if node.value is not None:
            yield WrittenPlace(path, part, node.text, node.span, is_key=False)
    elif isinstance(node, SequenceNode):
        inner = find_inner_part(part, 0)
        # What is offered in a list, its items take; a list in the place of an element stands for one of its keys.
        inner = part if inner == OWN_DATA or (part in OFFERS and inner not in OFFERS) else inner
        for index, item in enumerate(node.items):
            yield from list_written_places(item, inner, (*path, index))
    elif isinstance(node, MappingNode):
        keys, has_ids = KEYS.get(part, {}), part in ENTRIES
        for entry in node:
            if has_ids and entry.key not in keys:
                yield WrittenPlace((*path, entry.key), part, entry.key, entry.key_span, is_key=True)
            if (inner := find_inner_part(part, entry.key)) != OWN_DATA:
                yield from list_written_places(entry.value, inner, (*path, entry.key))
