"""Narrow a comparison to what touches the elements that a selector names in either version."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

from archgen.compare.change import Change, Comparison
from archgen.compare.elements import Element, Key
from archgen.compare.owners import owners
from archgen.diagnostic import Diagnostic
from archgen.model.selector import Selection


def selected(found: Comparison, before: Selection, after: Selection) -> Comparison:
    """Keep what touches a selected component or node. Anything outside of them (the project, views) is dropped."""
    old = {names(found, sort, one) for sort, ids in _ids(before) for one in ids}
    wanted = old | {(sort, one) for sort, ids in _ids(after) for one in ids}
    changes = tuple(change for change in found.changes if not wanted.isdisjoint(_touched(change, found)))
    ways = [{point for side in (c.before, c.after) if side for point in side.through} for c in found.chains]
    nodes = {one for _, one in wanted}
    return replace(
        found,
        changes=changes,
        new=tuple(filter(_about(wanted, found.told.after), found.new)),
        cured=tuple(filter(_about(old | wanted, found.told.before), found.cured)),
        silenced=tuple(filter(_about(old | wanted, found.told.before), found.silenced)),
        chains=tuple(c for c, way in zip(found.chains, ways, strict=True) if not nodes.isdisjoint(_parts(way))),
        owners=owners(changes, found.told),
    )


def names(found: Comparison, sort: str, one: str) -> Key:
    """Return the key of an element of the first version under its common id."""
    return sort, found.names.to(sort, one)


def _ids(selection: Selection) -> Iterator[tuple[str, frozenset[str]]]:
    yield "component", selection.components
    yield "node", selection.nodes


def _parts(names_of: set[str]) -> set[str]:
    """Return activities together with the nodes that they belong to (`node.component`)."""
    return names_of | {name.partition(".")[0] for name in names_of}


def _about(wanted: set[Key], listed: Mapping[Key, Element]) -> Callable[[Diagnostic], bool]:
    # Findings name elements by the ids of their own version.
    own = {element.own for key, element in listed.items() if key in wanted}

    def about(finding: Diagnostic) -> bool:
        parts = (finding.element or "").split(".")
        return any(".".join(parts[:end]) in own for end in range(1, len(parts) + 1))

    return about


def _touched(change: Change, found: Comparison) -> set[Key]:
    """Return the components and nodes that a change is about, parts included, by common ids."""
    touched = {key for part in change.parts for key in _touched(part, found)}
    own, told = change.element, found.told
    sort = "input" if change.sort == "connection" else change.sort
    common = found.names.to(sort, own) if change.kind == "removed" else own
    for listed in (told.before, told.after):
        element = listed.get((sort, common))
        touched |= set(_behind(element, listed)) if element else set()
    return touched


def _behind(element: Element, listed: Mapping[Key, Element]) -> Iterator[Key]:
    if element.sort in {"component", "node"}:
        yield element.sort, element.id
    if element.sort in {"node", "component", "output", "input"}:
        yield from (("component", ref) for ref in element.refs)
    elif element.sort == "port":
        yield from ((element.parent,) if element.parent else ())
        yield from (("component", ref.rpartition(".")[0]) for ref in element.refs)
    elif element.sort == "group":
        yield from (
            key for key, other in listed.items() if key[0] == "component" and other.parent == ("group", element.id)
        )
    else:
        yield from _users(element, listed)


_KEYS = {"type": "type", "requirement": "requirements", "host": "host", "container": "container"}
"""For each kind, the key with which other elements name an element of it."""


def _users(element: Element, listed: Mapping[Key, Element]) -> Iterator[Key]:
    """Yield the components and nodes that name an element, or that it names."""
    if element.sort == "chain" and isinstance(through := element.values.get("through"), tuple):
        for point in through:
            yield from (("component", point), ("component", point.rpartition(".")[0]), ("node", point))
    key = _KEYS.get(element.sort)
    for other in listed.values() if key or element.sort == "partner" else ():
        value = other.values.get(key) if key else other.owner
        if other.sort != "chain" and (value == element.id or (isinstance(value, frozenset) and element.id in value)):
            if other.sort in {"host", "container"}:
                # Through hosts and containers to the nodes on them; other kinds are not followed, which also ends the
                # recursion.
                yield from _users(other, listed)
            elif other.sort != element.sort:
                yield from (
                    _behind(other, listed) if other.sort in {"component", "node", "output", "input", "port"} else ()
                )
