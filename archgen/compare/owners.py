"""Whose elements, and whose ends of connections, a comparison touches."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from archgen.compare.change import Change
from archgen.compare.elements import Element, Key
from archgen.compare.told import Told
from archgen.compare.wiring import Wires


def owners(changes: Sequence[Change], told: Told) -> tuple[str, ...]:
    """Name the partners who should look at the changes: owners of what changed and of the other ends of its connections."""
    found = set[str]()
    own = {(e.sort, e.own): e for e in told.before.values()}
    for change in _all(changes):
        for listed, wires in ((told.before, told.old), (told.after, told.new)):
            element = _element(change, listed, own)
            found.update(_of(change, element, listed, wires))
    return tuple(sorted(found))


def _all(changes: Sequence[Change]) -> Iterator[Change]:
    for change in changes:
        yield change
        yield from _all(change.parts)


def _element(change: Change, listed: Mapping[Key, Element], own: Mapping[Key, Element]) -> Element | None:
    sort = "input" if change.sort == "connection" else change.sort
    found = listed.get((sort, change.element))
    if found is None and change.kind == "removed" and (gone := own.get((sort, change.element))):
        return listed.get((sort, gone.id))
    return found


def _of(change: Change, element: Element | None, listed: Mapping[Key, Element], wires: Wires) -> Iterator[str]:
    if element is None:
        return
    if element.owner:
        yield element.owner
    others: list[Key] = []
    if change.sort == "connection":
        others = [("output", name) for name in wires.sources.get(element.id, ())]
    elif change.sort == "output" and change.key in {None, "type"}:
        others = [("input", name) for name in wires.readers.get(element.id, ())]
    elif change.sort in {"type", "requirement"}:
        users = list(_users(element, listed))
        others = [*users, *(("input", reader) for _, name in users for reader in wires.readers.get(name, ()))]
    elif change.sort == "message":
        types = [
            other for other in listed.values() if other.sort == "type" and other.values.get("message") == element.id
        ]
        others = [key for one in types for key in _users(one, listed)]
    for key in others:
        other = listed.get(key)
        if other and other.owner:
            yield other.owner


def _users(element: Element, listed: Mapping[Key, Element]) -> Iterator[Key]:
    """Give the ports of a type, or the components that serve a requirement."""
    for key, other in listed.items():
        if element.sort == "type" and key[0] in {"output", "input"} and other.values.get("type") == element.id:
            yield key
        named = other.values.get("requirements") if element.sort == "requirement" and key[0] == "component" else None
        if isinstance(named, frozenset) and element.id in named:
            yield key
