"""Find the partners who own the elements, or the other ends of connections, that a comparison touches."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from archgen.compare.change import Change
from archgen.compare.elements import Element, Key
from archgen.compare.told import Told
from archgen.compare.wiring import Wires


def owners(changes: Sequence[Change], told: Told) -> tuple[str, ...]:
    """Return the partners who should look at the changes, sorted: owners of what changed and of its other ends."""
    found = set[str]()
    # Removed elements are reported by their old id, `elements_before` has them by the common one.
    own = {(e.sort, e.own): e for e in told.before.values()}
    for change in _all(changes):
        # Both versions: who read the output before is concerned as much as who reads it now.
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
    for key in _others(change, element, listed, wires):
        other = listed.get(key)
        if other and other.owner:
            yield other.owner


def _others(change: Change, element: Element, listed: Mapping[Key, Element], wires: Wires) -> Iterator[Key]:
    """Yield the keys of what is at the other end of a changed element."""
    match change.sort:
        case "connection":
            yield from (("output", name) for name in wires.sources.get(element.id, ()))
        case "output" if change.key in {None, "type"}:
            yield from (("input", name) for name in wires.readers.get(element.id, ()))
        case "port":
            yield from (("input", name) for port in element.refs for name in wires.readers.get(port, ()))
        case "chain":
            yield from _way(element)
        case "host" | "container" | "link":
            yield from _there(element, listed)
        case "type" | "requirement":
            for key in _users(element, listed):
                yield from (key, *(("input", reader) for reader in wires.readers.get(key[1], ())))
        case "message":
            types = (each for each in listed.values() if each.sort == "type")
            for one in types:
                yield from _users(one, listed) if one.values.get("message") == element.id else ()


def _way(chain: Element) -> Iterator[Key]:
    """Yield the components, nodes and outputs that a chain may lead through."""
    through = chain.values.get("through")
    for point in through if isinstance(through, tuple) else ():
        # A point's id does not say its kind; the keys that do not exist are skipped by `_owners_of_change`.
        yield from (("component", point), ("node", point), ("output", point))


def _there(place: Element, listed: Mapping[Key, Element]) -> Iterator[Key]:
    """Yield the nodes on a host, in a container, or on the hosts that a link connects."""
    hosts = place.values.get("connects") if place.sort == "link" else frozenset({place.id})
    if not isinstance(hosts, frozenset):
        return
    key = "container" if place.sort == "container" else "host"
    held = {name for (sort, name), e in listed.items() if sort == "container" and e.values.get("host") in hosts}
    for found, other in listed.items():
        inside = key == "host" and other.values.get("container") in held
        if found[0] == "node" and (other.values.get(key) in hosts or inside):
            yield found


def _users(element: Element, listed: Mapping[Key, Element]) -> Iterator[Key]:
    """Yield the ports of a type, or the components that serve a requirement."""
    for key, other in listed.items():
        if element.sort == "type" and key[0] in {"output", "input"} and other.values.get("type") == element.id:
            yield key
        named = other.values.get("requirements") if element.sort == "requirement" and key[0] == "component" else None
        if isinstance(named, frozenset) and element.id in named:
            yield key
