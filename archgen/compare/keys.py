"""The keys of an element that changed, without those that only follow from another change."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.compare.elements import SOME, Element, Key
from archgen.compare.nodes import default_qos
from archgen.compare.values import Title, plain

Row = tuple[str, object, object]
_OWNERS = frozenset({"owner", "co_owners"})


def changed(old: Element, new: Element, before: Mapping[Key, Element], after: Mapping[Key, Element]) -> Iterator[Row]:
    """Give each key that changed, with its values as plain data; all that changed of `qos` is one."""
    quality: list[Row] = []
    for key in _ordered(old.values, new.values):
        one, other = old.values.get(key), new.values.get(key)
        if one == other or _follows(key, old, new, before, after):
            continue
        if key.startswith("qos."):
            name = key.removeprefix("qos.")
            was, now = (plain(default_qos(name) if v is None else v) for v in (one, other))
            quality.append((name, was, now))
        else:
            yield key, plain(one), plain(other)
    if quality:
        yield "qos", {key: value for key, value, _ in quality}, {key: value for key, _, value in quality}


def _ordered(one: Mapping[str, object], other: Mapping[str, object]) -> list[str]:
    return sorted(one.keys() | other.keys())


def _follows(key: str, old: Element, new: Element, before: Mapping[Key, Element], after: Mapping[Key, Element]) -> bool:
    """Say whether a key only follows: a made title its id, an owner or a timing what it is taken from."""
    one, other = old.values.get(key), new.values.get(key)
    if isinstance(one, Title) and isinstance(other, Title):
        return one.text == other.text or (one.made and other.made)
    if key in _OWNERS or (new.sort == "node" and key.startswith("timing.")):
        return _orphaned(old, new, before, after) or (key in _OWNERS and _same_giver(key, old, new, before, after))
    if key in {"inputs", "outputs"}:
        return SOME in {one, other}
    if new.sort == "project":
        return (key in {"id", "title"} and None in {one, other}) or (key == "chapters" and _only_chapters(one, other))
    if new.sort == "message":
        return key == "parts" and old.values.get("fields") != new.values.get("fields")
    return new.sort == "port" and key == "carried"


def _orphaned(old: Element, new: Element, before: Mapping[Key, Element], after: Mapping[Key, Element]) -> bool:
    """Say whether a node's component came or went: what the node takes from it went along."""
    gone = any(("component", ref) not in after for ref in old.refs)
    return new.sort == "node" and (gone or any(("component", ref) not in before for ref in new.refs))


def _same_giver(
    key: str, old: Element, new: Element, before: Mapping[Key, Element], after: Mapping[Key, Element]
) -> bool:
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
