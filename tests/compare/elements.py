"""Elements and connections of two versions, made by hand."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import replace

from archgen.compare.version_pair import ComparedElement, ConnectionMap, ElementKey, VersionPair


def element(
    key: str, parent: str = "", own_id: str = "", refs: str = "", owner: str = "", **values: object
) -> ComparedElement:
    """Make an element: `element("output g.a.x", parent="component g.a", type="T")`."""
    kind, name = key.split(" ")
    parent_kind, _, parent_id = parent.partition(" ")
    return ComparedElement(
        kind,
        name,
        own_id or name,
        {name.replace("__", "."): value for name, value in values.items()},
        (parent_kind, parent_id) if parent else None,
        owner or None,
        component_refs=tuple(refs.split()),
    )


def with_values(key: str, values: Mapping[str, object]) -> ComparedElement:
    """Return an element whose keys have any names."""
    return replace(element(key), values=values)


def by_key(*elements: ComparedElement) -> dict[ElementKey, ComparedElement]:
    """Return elements by kind and id; a text is an element without values."""
    return {(each.kind, each.id): each for each in elements}


def some(*keys: str) -> dict[ElementKey, ComparedElement]:
    """Return elements of which nothing matters but that they are there."""
    return by_key(*map(element, keys))


def connections(text: str) -> ConnectionMap:
    """Read `input <- output output, input <- output`."""
    sources: dict[str, frozenset[str]] = {}
    readers: dict[str, set[str]] = defaultdict(set)
    for entry in filter(None, text.split(", ")):
        reader, outputs = entry.split(" <- ")
        sources[reader] = frozenset(outputs.split())
        for output in outputs.split():
            readers[output].add(reader)
    return ConnectionMap(sources, {output: frozenset(names) for output, names in readers.items()})


def pair(
    before: dict[ElementKey, ComparedElement],
    after: dict[ElementKey, ComparedElement],
    reads: tuple[str, str] = ("", ""),
    lost: tuple[str, str] = ("", ""),
    serving: tuple[dict[str, frozenset[str]], dict[str, frozenset[str]]] | None = None,
) -> VersionPair:
    """Make a pair of versions; `reads` are the connections before and after, `lost` the keys that could not be read.

    `serving` are the components that name each requirement, before and after.
    """
    return VersionPair(
        connections(reads[0]),
        connections(reads[1]),
        _add_servers(before, serving[0]) if serving else before,
        _add_servers(after, serving[1]) if serving else after,
        (frozenset(lost[0].split()), frozenset(lost[1].split())),
    )


def _add_servers(
    elements: dict[ElementKey, ComparedElement], serving: dict[str, frozenset[str]]
) -> dict[ElementKey, ComparedElement]:
    requirements: defaultdict[str, set[str]] = defaultdict(set)
    for requirement, component_ids in serving.items():
        for component_id in component_ids:
            requirements[component_id].add(requirement)
    return elements | {
        ("component", name): ComparedElement("component", name, name, {"requirements": frozenset(each)})
        for name, each in requirements.items()
    }
