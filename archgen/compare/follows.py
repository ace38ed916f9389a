"""Recognise keys that differ only as a consequence of another change, and would report it a second time."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.compare.elements import MAPPED, SOME, Element, Key
from archgen.compare.values import Title
from archgen.model.names import made_title

Listed = Mapping[Key, Element]
_OWNERS = frozenset({"owner", "co_owners"})
_TO = {"implements": "component", "requirements": "requirement", "use_cases": "use_case", "connects": "host"}
"""Keys that name elements, with the kind of these: that a removed element is no longer named is no news."""


def follows(key: str, old: Element, new: Element, before: Listed, after: Listed) -> bool:
    """Whether a key only follows another change: a generated title its id, an owner or timing the element it is
    inherited from.
    """
    one, other = old.values.get(key), new.values.get(key)
    if isinstance(one, Title) and isinstance(other, Title):
        return _retitled(one, other, old, new)
    if key in _TO:
        return _no_longer_there(one, other, _TO[key], after)
    if key in _OWNERS:
        return _orphaned(old, new, before, after) or _same_giver(key, old, new, before, after)
    return _by_sort(key, old, new, before, after)


def _by_sort(key: str, old: Element, new: Element, before: Listed, after: Listed) -> bool:
    one, other = old.values.get(key), new.values.get(key)
    match new.sort:
        case "component":
            return SOME in {one, other} if key in {"inputs", "outputs"} else _unmapped(key, old, new)
        case "node":
            # A node may move into a container on the same host: "host" vanishes from its values, but it runs where it
            # ran.
            moved = _host(old, before) != _host(new, after)
            return not moved if key == "host" else key.startswith("timing.") and _orphaned(old, new, before, after)
        case "message":
            return key == "parts" and old.values.get("fields") != new.values.get("fields")
    unnamed = new.sort == "project" and key in {"id", "title"} and None in {one, other}
    return unnamed or key == "carried" or (key == "chapters" and _only_chapters(one, other))


def _retitled(one: Title, other: Title, old: Element, new: Element) -> bool:
    """Whether both titles are the same, or both are the id in words, be it written or generated."""
    # After a rename a written title that merely repeats the id follows it; with the same id only generated or equal
    # titles are the same.
    both = old.own != new.own and _made(old, one) and _made(new, other)
    return both or one.text == other.text or (one.made and other.made)


def _made(element: Element, title: Title) -> bool:
    return title.text.casefold() == made_title(element.own.rpartition(".")[2]).casefold()


def _no_longer_there(one: object, other: object, sort: str, after: Listed) -> bool:
    """Whether a list lost only elements that were removed, and gained nothing."""
    old, new = (each if isinstance(each, frozenset) else frozenset[str]() for each in (one, other))
    return old > new and not any((sort, name) in after for name in old - new)


def _unmapped(key: str, old: Element, new: Element) -> bool:
    """Whether a component's timing was added or removed with its node."""
    came_or_went = old.values.get(MAPPED) != new.values.get(MAPPED)
    missing = key not in old.values or key not in new.values
    return key == MAPPED or (key.startswith("timing.") and came_or_went and missing)


def _host(node: Element, listed: Listed) -> object:
    """Return the host that a node runs on: its own, or its container's."""
    container = listed.get(("container", str(node.values.get("container"))))
    return node.values.get("host") or (container.values.get("host") if container else None)


def _orphaned(old: Element, new: Element, before: Listed, after: Listed) -> bool:
    """Whether a component of a node was added or removed: what the node inherits from it changed along."""
    gone = any(("component", ref) not in after for ref in old.refs)
    return new.sort == "node" and (gone or any(("component", ref) not in before for ref in new.refs))


def _same_giver(key: str, old: Element, new: Element, before: Listed, after: Listed) -> bool:
    """Whether an owner is inherited from an element whose own owner changed in the same way."""
    givers = [("component", ref) for ref in new.refs] if new.sort == "node" else [new.parent] if new.parent else []
    return any(
        giver in before
        and giver in after
        and old.parent == new.parent
        and before[giver].values.get(key) == old.values.get(key)
        and after[giver].values.get(key) == new.values.get(key)
        for giver in givers
    )


def _only_chapters(one: object, other: object) -> bool:
    """Whether chapters were added or removed while all others kept their order."""
    if not isinstance(one, tuple) or not isinstance(other, tuple):
        return False
    return [name for name in one if name in other] == [name for name in other if name in one] and any(
        name.endswith(".md") for name in {*one} ^ {*other}
    )
