"""Check a document against the JSON Schema, report what differs, and take it out of the tree.

Later stages rely on it: what is left has the kind of value that the schema asks for.
"""

from __future__ import annotations

import functools
import json
import re
from typing import TYPE_CHECKING, Any

import jsonschema_rs

from archgen import resources
from archgen.diagnostic import Diagnostic
from archgen.schema import wording
from archgen.schema.wording import Place
from archgen.syntax.tree import Listing, Scalar, Table

if TYPE_CHECKING:
    from collections.abc import Iterable

    from archgen.syntax.tree import Document, Entry, Value

_USABLE_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,199}\Z", re.ASCII)
"""Ids that only break a rule of style are reported but kept, so that references to them are not reported as well."""


def validate(document: Document) -> tuple[Diagnostic, ...]:
    """Report what the schema does not allow, and remove it from the document's tree in place."""
    data = _data(document.root)
    validator = _validator()
    if validator.is_valid(data):
        return ()
    found: list[Diagnostic] = []
    wrong: list[tuple[Place, str | None]] = []
    seen = set[tuple[str | int, ...]]()
    for error in _by_weight(validator.iter_errors(data)):
        _judge(document, error, found, wrong, seen)
    # Only now: while errors are being located, their paths must still lead through an unchanged tree.
    for place, key in wrong:
        _prune(place, key)
    _drop_holes(document.root)
    return tuple(found)


@functools.cache
def schema() -> dict[str, Any]:
    """Return the JSON Schema of the language. Cached and shared: nobody may change it."""
    text = resources.path("schemas", "archgen.schema.json").read_text(encoding="utf-8")
    return json.loads(text)  # type: ignore[no-any-return]


@functools.cache
def _validator() -> jsonschema_rs.Draft202012Validator:
    return jsonschema_rs.Draft202012Validator(schema())


def sections() -> frozenset[str]:
    """Return the names of the top-level sections."""
    return frozenset(schema()["properties"])


def _data(value: Value) -> object:
    """Turn a tree into what the validator takes.

    Floats go as text, because the validator reads NaN as null and 5.0 as a whole number. Integers are clamped to what
    it can hold.
    """
    if isinstance(value, Table):
        return {_MARK + key if key[0] in _NUMERIC else key: _data(entry.value) for key, entry in value.entries.items()}
    if isinstance(value, Listing):
        return [_data(item) for item in value.items]
    found = value.value
    # `type(...) is`: a bool is an int as well, and must stay a bool.
    if type(found) is float:
        return value.text
    return max(-_BEYOND, min(found, _BEYOND)) if type(found) is int else found


_MARK = "\0"
_NUMERIC = frozenset("0123456789+\0")
"""First characters of keys that get the mark: the validator's paths do not tell the key `0` from the index 0."""
_BEYOND = 1 << 60
"""Larger than any number that the language allows, and small enough for the validator."""


def _by_weight(errors: Iterable[jsonschema_rs.ValidationError]) -> list[jsonschema_rs.ValidationError]:
    """Sort wrong types first: what else the validator says of the same value follows from it and is then left out."""
    return sorted(errors, key=lambda error: error.kind.name != "type")


def _judge(
    document: Document,
    error: jsonschema_rs.ValidationError,
    found: list[Diagnostic],
    wrong: list[tuple[Place, str | None]],
    seen: set[tuple[str | int, ...]],
) -> None:
    # `seen_paths` are those already reported: one finding for each place, the first one, which is a wrong type if any.
    place = _locate(document.root, [_unmarked(step) for step in error.instance_path])
    part = _part(error.schema_path)
    kind = error.kind.name
    # The library reports one error for all unknown keys of a mapping; each becomes a finding of its own, at its key.
    if kind == "additionalProperties" and isinstance(place.value, Table):
        kind_of: Any = error.kind  # its attributes depend on the kind, which the library's types do not say
        for key in map(_unmarked, kind_of.unexpected):
            found.append(wording.unknown_key(place.value.entries[key], part, place.path))
            wrong.append((place, key))
    elif kind == "propertyNames" and isinstance(place.value, Table):
        inner: Any = error.kind
        key = _unmarked(inner.error.instance)
        if (*place.path, key, "") not in seen:  # no key is empty, so this is no value's path
            seen.add((*place.path, key, ""))
            found.append(wording.wrong_key(place.value.entries[key], part, place.path))
            if not _USABLE_ID.match(key):
                wrong.append((place, key))
    elif place.path not in seen:
        seen.add(place.path)
        found.append(wording.wrong(kind, place, part))
        wrong.append((place, None))


def _unmarked(step: Any) -> Any:  # noqa: ANN401 - a key or a number
    return step[1:] if isinstance(step, str) and step[0] == _MARK else step


def _locate(root: Table, path: list[str | int]) -> Place:
    value: Value = root
    parent: Table | Listing | None = None
    entry: Entry | None = None
    for step in path:
        parent = value if isinstance(value, Table | Listing) else None
        if isinstance(value, Table):
            entry = value.entries[str(step)]
            value = entry.value
        elif isinstance(value, Listing):
            value = value.items[int(step)]
    return Place(tuple(path), value, parent, entry)


def _part(path: Iterable[str | int]) -> dict[str, Any]:
    """Return the part of the schema that an error comes from: all but the last step, which is the keyword."""
    found: Any = schema()
    for step in list(path)[:-1]:
        found = found[step]
    return found  # type: ignore[no-any-return]


# Stands in for a wrong list entry until all are found: removing one at once would shift the indices of the others.
# Compared by identity, and gone from the tree when validation returns.
_HOLE = Scalar(None, "", wording.NO_PLACE)
_KEPT = frozenset({"from", "implements", "through"})
"""Keys whose absence a rule reports. Where nothing sound is left of one, an empty list keeps the fact that it was
written, so that the same mistake is not reported a second time as a missing key.
"""
_KEYED = wording.SECTIONS_BY_ID | {"components", "inputs", "outputs", "publishes", "subscribes", "serves", "calls"}


def _prune(place: Place, key: str | None) -> None:
    """Take a wrong key or value out of its tree.

    An element keeps its id and loses only its content, so that references to it are not reported as well.
    """
    if key is not None and isinstance(place.value, Table):
        place.value.entries.pop(key, None)
    elif isinstance(place.parent, Listing):
        place.parent.items[int(place.path[-1])] = _HOLE
    elif isinstance(place.parent, Table) and place.entry is not None:
        if _is_asked_for(place.path):
            place.entry.value = Listing([], place.value.at)
        # An empty value below an id declares the element, as in `rgbd:`; normalising turns it into `{}`.
        elif len(place.path) > 1 and place.path[-2] in _KEYED:
            place.entry.value = Scalar(None, "", place.value.at)
        else:
            place.parent.entries.pop(place.entry.key, None)


def _is_asked_for(path: tuple[str | int, ...]) -> bool:
    """Whether a path is that of a key in `_KEPT_LIST_KEYS`, not of an element that happens to have such an id."""
    if path[-1] not in _KEPT:
        return False
    if path[-1] == "from":
        return path[-3:-2] == ("inputs",)
    return len(path) == 3 and path[0] in {"nodes", "chains"}  # noqa: PLR2004 - section, id, key


def _drop_holes(value: Value) -> None:
    """Remove the holes from lists, and lists of which nothing is left from their mappings."""
    if isinstance(value, Listing):
        value.items = [item for item in value.items if item is not _HOLE]
        for item in value.items:
            _drop_holes(item)
    elif isinstance(value, Table):
        for entry in tuple(value):
            # A list that was written empty says "known to be none" and must survive.
            had = isinstance(entry.value, Listing) and bool(entry.value.items)
            _drop_holes(entry.value)
            if had and isinstance(entry.value, Listing) and not entry.value.items and entry.key not in _KEPT:
                del value.entries[entry.key]
