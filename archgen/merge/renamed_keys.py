"""Elements that have another id on one side: what the other side changed in them follows, and two new ids contradict.

Within one file, and by what stands below the id: a file alone cannot be linked, so that values stand for features.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from archgen.compare.element_likeness import CERTAIN, Feature, FeatureMap, find_likely_pairs
from archgen.frozen import NamedTuple
from archgen.language.key_paths import find_part
from archgen.language.language_tables import ENTRIES
from archgen.merge.tree_merge import FIELD_ORDER, MappingValue, MergeConflictError, MergedValue, ScalarValue

_LEAF_WEIGHT = 2.5
"""What one value below an id weighs: two that are the same make a sure rename, one a likely one."""


class KeyRename(NamedTuple):
    """A key with another name on one side; `path` leads to the mapping, and `is_ours` says which side renamed it."""

    path: tuple[str, ...]
    old_key: str
    new_key: str
    is_ours: bool


_Entries = Mapping[str, MergedValue]


class _KeyPair(NamedTuple):
    new_key: str
    is_sure: bool


def find_renames(
    base: MergedValue, ours: MergedValue, theirs: MergedValue, path: tuple[str, ...] = ()
) -> Iterator[KeyRename]:
    """Yield the ids that one side renamed and below which the other side changed something.

    Raise MergeConflictError where both sides renamed one, or one side took away what the other one renamed.
    """
    if not (isinstance(base, MappingValue) and isinstance(ours, MappingValue) and isinstance(theirs, MappingValue)):
        return
    if base in (ours, theirs):
        return
    old, our, their = (dict(value.items) for value in (base, ours, theirs))
    if find_part(path) in ENTRIES:
        our_keys, their_keys = _pair_keys(old, our), _pair_keys(old, their)
        for key in old:
            if key in our_keys or key in their_keys:
                yield from _judge_key(key, (old, our, their), our_keys.get(key), their_keys.get(key), path)
    for key in old:
        if key in our and key in their:
            yield from find_renames(old[key], our[key], their[key], (*path, key))


def follow_renames(
    base: MergedValue, ours: MergedValue, theirs: MergedValue
) -> tuple[MergedValue, MergedValue, MergedValue]:
    """Return the versions with the new ids in all of them. Raise MergeConflictError."""
    for rename in find_renames(base, ours, theirs):
        base = _rename_key(base, rename.path, rename)
        ours, theirs = (
            (ours, _rename_key(theirs, rename.path, rename))
            if rename.is_ours
            else (_rename_key(ours, rename.path, rename), theirs)
        )
    return base, ours, theirs


def _rename_key(value: MergedValue, path: tuple[str, ...], rename: KeyRename) -> MergedValue:
    if not isinstance(value, MappingValue):
        return value
    if not path:
        items = ((rename.new_key if key == rename.old_key else key, item) for key, item in value.items)
    else:
        items = ((key, _rename_key(item, path[1:], rename) if key == path[0] else item) for key, item in value.items)
    return MappingValue(tuple(sorted(items, key=lambda item: item[0])))


def _judge_key(
    key: str,
    versions: tuple[_Entries, _Entries, _Entries],
    our_pair: _KeyPair | None,
    their_pair: _KeyPair | None,
    path: tuple[str, ...],
) -> Iterator[KeyRename]:
    old, our, their = versions
    if key in our or key in their:
        pair, edited = (their_pair, our) if key in our else (our_pair, their)
        # What the other side wrote under the new id is another element.
        if pair and pair.is_sure and edited[key] != old[key] and pair.new_key not in edited:
            yield KeyRename(path, key, pair.new_key, is_ours=key not in our)
        return
    new_keys = [pair.new_key for pair in (our_pair, their_pair) if pair]
    # What both sides call alike is one element, also where one of them changed much of it.
    common_key = next((each for each in new_keys if each in our and each in their), "")
    if not common_key:
        raise MergeConflictError((*path, key), _describe_contradiction((*path, key), new_keys))
    if our[common_key] != their[common_key]:
        yield KeyRename(path, key, common_key, is_ours=True)


def _describe_contradiction(path: tuple[str, ...], new_keys: Sequence[str]) -> str:
    name = ".".join(path)
    if len(new_keys) > 1:
        return f"both sides renamed `{name}`: it is `{new_keys[0]}` and `{new_keys[1]}` now"
    return f"one side renamed `{name}` to `{new_keys[0]}`, the other one took it away"


def _pair_keys(old: _Entries, new: _Entries) -> Mapping[str, _KeyPair]:
    """Return the new ids of what is gone, as archgen recognises renamed elements in a comparison."""
    lost, added = (
        {key: _describe_value(value) for key, value in side.items() if key not in other and key != FIELD_ORDER}
        for side, other in ((old, new), (new, old))
    )
    if not (lost and added):
        return {}
    return {
        old_key: _KeyPair(new_key, confidence >= CERTAIN and old[old_key] == new[new_key])
        for old_key, new_key, confidence in find_likely_pairs(lost, added)
    }


def _describe_value(value: MergedValue) -> FeatureMap:
    leaves = frozenset(_list_leaves(value, ""))
    return {"leaves": Feature(_LEAF_WEIGHT * len(leaves), leaves)}


def _list_leaves(value: MergedValue, path: str) -> Iterator[str]:
    """Yield the values that stand below something, each with the keys that lead to it."""
    if isinstance(value, ScalarValue):
        yield f"{path}={value.text}"
        return
    items = value.items if isinstance(value, MappingValue) else tuple(("-", item) for item in value.items)
    for key, item in items:
        if key != FIELD_ORDER:
            yield from _list_leaves(item, f"{path}.{key}")
