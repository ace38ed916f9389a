"""Which elements of an architecture a name means, whatever their kind, and what stands around them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from archgen.language.language_tables import SECTION_KINDS
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.component_nesting import list_surrounding
from archgen.model.node import Topic
from archgen.model.port_media import name_on_medium
from archgen.views.lookup import Lookup

_COMPONENT_KINDS = frozenset({"component", "composed"})
_NAMED_AFTER_COMPONENTS = frozenset({"node", "frame"})


_UNNAMED_SECTIONS = frozenset({"groups", "component_types", "nodes", "types", "properties", "libraries"})
"""Sections whose elements stand among others above, or are settings."""


def elements_by_kind(architecture: Architecture) -> dict[str, Mapping[str, Any]]:
    """Return all elements by kind; the keys appear as headings of cards."""
    a = architecture
    channels: dict[str, Topic] = {}
    for key, channel in a.channels.items():
        name = name_on_medium(channel)
        if name not in a.outputs:
            channels[key if name in channels or name in a.topics else name] = channel
    return {
        # An id that several kinds share is found in this order.
        "group": a.groups,
        "composed": {shell_id: shell for shell_id, shell in a.shells.items() if shell_id not in a.components},
        "component": a.components,
        "component type": a.component_types,
        "output": {**{port.id: port for each in a.shells.values() for port in each.outputs.values()}, **a.outputs},
        "input": {**{port.id: port for each in a.shells.values() for port in each.inputs.values()}, **a.inputs},
        "node": a.nodes,
        "topic": a.topics,
        "channel": channels,
        "type": a.types,
        **{
            kind.replace("_", " "): getattr(a, section)
            for section, kind in SECTION_KINDS.items()
            if section not in _UNNAMED_SECTIONS
        },
    }


def kinds_by_id(lookup: Lookup) -> dict[str, list[str]]:
    """Return each element's id with the kinds of element that have it."""
    result: dict[str, list[str]] = {}
    for kind, elements in elements_by_kind(lookup.architecture).items():
        for element_id in elements:
            result.setdefault(element_id, []).append(kind)
    return result


def join_surrounding_titles(lookup: Lookup, component: Component) -> str:
    """Join the titles of the composed components around a component, the outermost first; empty where there are none."""
    shells = lookup.architecture.shells
    return " · ".join(shells[name].title for name in list_surrounding(lookup.architecture, component.id))


def find_elements(lookup: Lookup, name: str) -> list[tuple[str, str]]:
    """Find the elements that a name may mean, as (kind, id) pairs.

    Full ids win; then ids that end in the name; then titles of groups and components, ignoring case. A node or a frame
    does not hide the components of its name: most nodes that nobody wrote are called after theirs.
    """
    kinds_of = kinds_by_id(lookup)
    if name in kinds_of:
        has_component_name = _NAMED_AFTER_COMPONENTS.issuperset(kinds_of[name])
        components = _list_components_called(name, kinds_of) if has_component_name else ()
        return [*components, *((kind, name) for kind in kinds_of[name])]
    folded_name = name.casefold()
    # `.` ends a group or component in an id, `/` a namespace in a topic or node: `scan` finds `/lidar/scan`.
    suffix_matches = [
        (kind, key) for key, kinds in kinds_of.items() if key.endswith((f".{name}", f"/{name}")) for kind in kinds
    ]
    if suffix_matches:
        return suffix_matches
    return [
        (kind, key)
        for key, kinds in kinds_of.items()
        for kind in kinds
        if _element_title(lookup, kind, key).casefold() == folded_name
    ]


def _list_components_called(name: str, kinds_of: Mapping[str, Sequence[str]]) -> Iterator[tuple[str, str]]:
    for element_id, kinds in kinds_of.items():
        if element_id.endswith(f".{name}"):
            yield from ((kind, element_id) for kind in kinds if kind in _COMPONENT_KINDS)


def _element_title(lookup: Lookup, kind: str, element_id: str) -> str:
    """Return the title of a group or component, the id of anything else."""
    architecture = lookup.architecture
    if kind == "group":
        return architecture.groups[element_id].title
    if kind == "composed":
        return architecture.shells[element_id].title
    return architecture.components[element_id].title if kind == "component" else element_id
