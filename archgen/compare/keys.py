"""The keys of an element that changed, without those that only follow from another change."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.compare.elements import MAPPED, SOME, Element, Key
from archgen.compare.nodes import default_qos
from archgen.compare.values import Title, plain
from archgen.model.names import made_title

Row = tuple[str, object, object]
_TO = {"implements": "component", "requirements": "requirement", "use_cases": "use_case", "connects": "host"}
"""Keys that name elements, by their sort: who no longer names what is removed says nothing new."""
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
        made = one.made and other.made
        return one.text == other.text or made or (old.own != new.own and _made(old, one) and _made(new, other))
    if new.sort == "component" and (key == MAPPED or key.startswith("timing.")):
        came_or_went = old.values.get(MAPPED) != new.values.get(MAPPED)
        return key == MAPPED or (came_or_went and None in {one, other})
    if key in _TO and isinstance(one, frozenset) and isinstance(other, frozenset | None):
        return one > (other or frozenset()) and all(
            (_TO[key], name) not in after for name in one - (other or frozenset())
        )
    if new.sort == "node" and key == "host":
        return _host(old, before) == _host(new, after)
    if key in _OWNERS or (new.sort == "node" and key.startswith("timing.")):
        return _orphaned(old, new, before, after) or (key in _OWNERS and _same_giver(key, old, new, before, after))
    if key in {"inputs", "outputs"}:
        return SOME in {one, other}
    if new.sort == "project":
        return (key in {"id", "title"} and None in {one, other}) or (key == "chapters" and _only_chapters(one, other))
    return new.sort == "port" and key == "carried"


def _made(element: Element, title: Title) -> bool:
    """Say whether a title is the id in words: it follows a rename, be it written or not."""
    return title.text.casefold() == made_title(element.own.rpartition(".")[2]).casefold()


def _host(node: Element, listed: Mapping[Key, Element]) -> object:
    """Give the host that a node runs on: its own, or its container's."""
    container = listed.get(("container", str(node.values.get("container"))))
    return node.values.get("host") or (container.values.get("host") if container else None)


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
