"""Narrow a comparison to what touches the elements that a selector names in either version."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping

from archgen.compare.comparison import BoundaryChange, ChainChange, Change, Comparison
from archgen.compare.concerned_owners import find_concerned_owners
from archgen.compare.version_pair import ComparedElement, ElementKey
from archgen.diagnostics import Diagnostic
from archgen.frozen import replace
from archgen.model.selector_evaluation import Selection


def select_changes(comparison: Comparison, before: Selection, after: Selection) -> Comparison:
    """Keep what touches a selected component or node. Anything outside of them (the project, views) is dropped."""
    old_keys = {common_key(comparison, *key) for key in _selected_keys(before)}
    wanted_keys = old_keys | {*_selected_keys(after)}
    changes = tuple(
        change for change in comparison.changes if not wanted_keys.isdisjoint(_touched_keys(change, comparison))
    )
    wanted_ids = {element_id for _, element_id in wanted_keys}
    chains = tuple(
        _keep_causes(chain, wanted_keys, comparison)
        for chain in comparison.chains
        if not wanted_ids.isdisjoint(_activities_and_nodes(chain))
    )
    boundaries = tuple(
        boundary for boundary in comparison.boundaries if _touches_selection(boundary, wanted_keys, comparison)
    )
    concerned_before = _finding_filter(wanted_keys, comparison.versions.elements_before)
    concerned_after = _finding_filter(wanted_keys, comparison.versions.elements_after)
    return replace(
        comparison,
        changes=changes,
        new_findings=tuple(filter(concerned_after, comparison.new_findings)),
        cured_findings=tuple(filter(concerned_before, comparison.cured_findings)),
        silenced_findings=tuple(filter(concerned_before, comparison.silenced_findings)),
        chains=chains,
        boundaries=boundaries,
        # A load is what all on a host or link add up to: of a part of them it says nothing.
        loads=(),
        concerned_owners=find_concerned_owners(changes, comparison.versions, (*boundaries, *chains)),
    )


def _keep_causes(chain: ChainChange, wanted_keys: set[ElementKey], comparison: Comparison) -> ChainChange:
    """Return a chain with those of its causes that touch what is selected."""
    causes = tuple(cause for cause in chain.causes if not wanted_keys.isdisjoint(_touched_keys(cause, comparison)))
    return replace(chain, causes=causes)


def _touches_selection(boundary: BoundaryChange, wanted_keys: set[ElementKey], comparison: Comparison) -> bool:
    """Whether a selected component gives what flows at a boundary, or reads it."""
    versions = comparison.versions
    readers = {
        reader
        for connections in (versions.connections_before, versions.connections_after)
        for reader in connections.readers_by_output.get(boundary.interface_id, ())
    }
    ports = {boundary.interface_id, *readers}
    return not wanted_keys.isdisjoint(("component", port.rpartition(".")[0]) for port in ports)


def common_key(comparison: Comparison, kind: str, old_id: str) -> ElementKey:
    """Return the key of an element of the first version under its common id."""
    return kind, comparison.matched_ids.common_id(kind, old_id)


def _selected_keys(selection: Selection) -> Iterator[ElementKey]:
    yield from (("component", name) for name in selection.components)
    yield from (("node", name) for name in selection.nodes)


def _activities_and_nodes(chain_change: ChainChange) -> set[str]:
    """Return the activities on a chain in either version, and the nodes that they belong to (`node.component`)."""
    points = {point for side in (chain_change.before, chain_change.after) if side for point in side.through}
    return points | {name.partition(".")[0] for name in points}


def _finding_filter(
    wanted_keys: set[ElementKey], elements: Mapping[ElementKey, ComparedElement]
) -> Callable[[Diagnostic], bool]:
    # Findings name elements by the ids of their own version.
    own_ids = {element.own_id for key, element in elements.items() if key in wanted_keys}

    def concerns_selection(finding: Diagnostic) -> bool:
        outer_ids = itertools.accumulate((finding.element or "").split("."), "{}.{}".format)
        return not own_ids.isdisjoint(outer_ids)

    return concerns_selection


def _touched_keys(change: Change, comparison: Comparison) -> set[ElementKey]:
    """Return the components and nodes that a change is about, parts included, by common ids."""
    touched_keys = {key for part in change.parts for key in _touched_keys(part, comparison)}
    own_id, versions = change.element_id, comparison.versions
    kind = "input" if change.element_kind == "connection" else change.element_kind
    common_id = comparison.matched_ids.common_id(kind, own_id) if change.kind == "removed" else own_id
    for elements in versions.elements:
        element = elements.get((kind, common_id))
        touched_keys |= set(_keys_behind(element, elements)) if element else set()
    return touched_keys


def _keys_behind(element: ComparedElement, elements: Mapping[ElementKey, ComparedElement]) -> Iterator[ElementKey]:
    if element.kind in {"component", "node"}:
        yield element.kind, element.id
    if element.kind in {"node", "component", "output", "input"}:
        yield from (("component", component_ref) for component_ref in element.component_refs)
    elif element.kind == "port":
        yield from ((element.parent_key,) if element.parent_key else ())
        yield from (("component", component_ref.rpartition(".")[0]) for component_ref in element.component_refs)
    elif element.kind == "group":
        yield from (
            key
            for key, other in elements.items()
            if key[0] == "component" and other.parent_key == ("group", element.id)
        )
    else:
        yield from _keys_using(element, elements)


_REFERRING_KEYS = {
    "type": "type",
    "requirement": "requirements",
    "host": "host",
    "container": "container",
    "frame": "frame",
}
"""For each kind, the key with which other elements name an element of it."""


def _keys_using(element: ComparedElement, elements: Mapping[ElementKey, ComparedElement]) -> Iterator[ElementKey]:
    """Yield the components and nodes that name an element, or that it names."""
    if element.kind == "chain" and isinstance(through := element.values.get("through"), tuple):
        for point in through:
            yield from (("component", point), ("component", point.rpartition(".")[0]), ("node", point))
    if element.kind == "frame":
        yield "node", str(element.values.get("by"))
        yield from (("component", writer) for writer in element.component_refs)
    key = _REFERRING_KEYS.get(element.kind)
    for candidate in elements.values() if key or element.kind == "partner" else ():
        value = candidate.values.get(key) if key else candidate.owner
        if candidate.kind != "chain" and (
            value == element.id or (isinstance(value, frozenset) and element.id in value)
        ):
            if candidate.kind in {"host", "container"}:
                # Through hosts and containers to the nodes on them; other kinds are not followed, which also ends the
                # recursion.
                yield from _keys_using(candidate, elements)
            elif candidate.kind != element.kind:
                yield from (
                    _keys_behind(candidate, elements)
                    if candidate.kind in {"component", "node", "output", "input", "port"}
                    else ()
                )
