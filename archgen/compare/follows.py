"""Keys that only follow from another change, and would say it a second time."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.compare.elements import MAPPED, SOME, Element, Key
from archgen.compare.values import Title
from archgen.model.names import made_title

Listed = Mapping[Key, Element]
_OWNERS = frozenset({"owner", "co_owners"})
_TO = {"implements": "component", "requirements": "requirement", "use_cases": "use_case", "connects": "host"}
"""Keys that name elements, by their sort: who no longer names what is removed says nothing new."""


def follows(key: str, old: Element, new: Element, before: Listed, after: Listed) -> bool:
    """Say whether a key only follows: a made title its id, an owner or a timing what it is taken from."""
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
            moved = _host(old, before) != _host(new, after)
            return not moved if key == "host" else key.startswith("timing.") and _orphaned(old, new, before, after)
        case "message":
            return key == "parts" and old.values.get("fields") != new.values.get("fields")
    unnamed = new.sort == "project" and key in {"id", "title"} and None in {one, other}
    return unnamed or key == "carried" or (key == "chapters" and _only_chapters(one, other))


def _retitled(one: Title, other: Title, old: Element, new: Element) -> bool:
    """Say whether a title is the same, or the id in words in both versions, be it written or not."""
    both = old.own != new.own and _made(old, one) and _made(new, other)
    return both or one.text == other.text or (one.made and other.made)


def _made(element: Element, title: Title) -> bool:
    return title.text.casefold() == made_title(element.own.rpartition(".")[2]).casefold()


def _no_longer_there(one: object, other: object, sort: str, after: Listed) -> bool:
    """Say whether a list lost nothing but what was removed, and gained nothing."""
    old, new = (each if isinstance(each, frozenset) else frozenset[str]() for each in (one, other))
    return old > new and not any((sort, name) in after for name in old - new)


def _unmapped(key: str, old: Element, new: Element) -> bool:
    """Say whether a component's timing came or went with its node."""
    came_or_went = old.values.get(MAPPED) != new.values.get(MAPPED)
    missing = key not in old.values or key not in new.values
    return key == MAPPED or (key.startswith("timing.") and came_or_went and missing)


def _host(node: Element, listed: Listed) -> object:
    """Give the host that a node runs on: its own, or its container's."""
    container = listed.get(("container", str(node.values.get("container"))))
    return node.values.get("host") or (container.values.get("host") if container else None)


def _orphaned(old: Element, new: Element, before: Listed, after: Listed) -> bool:
    """Say whether a node's component came or went: what the node takes from it went along."""
    gone = any(("component", ref) not in after for ref in old.refs)
    return new.sort == "node" and (gone or any(("component", ref) not in before for ref in new.refs))


def _same_giver(key: str, old: Element, new: Element, before: Listed, after: Listed) -> bool:
    """Say whether an owner is given by what stands above, which changed hands itself."""
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
    """Say whether chapters came or went, but none changed its place."""
    if not isinstance(one, tuple) or not isinstance(other, tuple):
        return False
    return [name for name in one if name in other] == [name for name in other if name in one] and any(
        name.endswith(".md") for name in {*one} ^ {*other}
    )
