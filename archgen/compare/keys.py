"""List the keys of an element that changed, without those that only follow from another change."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.compare.elements import Element, Key
from archgen.compare.follows import follows
from archgen.compare.nodes import default_qos
from archgen.compare.values import plain

Row = tuple[str, object, object]


def changed(old: Element, new: Element, before: Mapping[Key, Element], after: Mapping[Key, Element]) -> Iterator[Row]:
    """Yield each changed key with its old and new value as plain data; all changes of `qos` are combined into one."""
    quality: list[Row] = []
    for key in _ordered(old.values, new.values):
        one, other = old.values.get(key), new.values.get(key)
        if one == other or follows(key, old, new, before, after):
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
