"""Elements that have another id on one side: what the other side changed in them follows, and two new ids contradict.

Within one file, and by what stands below the id. A rename is sure where all of it is as it was; where both sides take an id
away and write something alike under another one, they renamed it, each in its own way.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from archgen.compare.element_likeness import MIN_LIKENESS
from archgen.language.key_paths import find_part
from archgen.language.language_tables import ENTRIES
from archgen.merge.tree_merge import FIELD_ORDER, MappingValue, MergeConflictError, MergedValue, ScalarValue

_SURE_LEAVES = 2
"""As many values have to stand below an id for an equal mapping under another id to be surely the same element."""


class KeyRename(NamedTuple):
    """A key with another name on one side; `path` leads to the mapping, and `is_ours` says which side renamed it."""

    path: tuple[str, ...]
    old_key: str
    new_key: str
    is_ours: bool


def find_renames(
    base: MergedValue, ours: MergedValue, theirs: MergedValue, path: tuple[str, ...] = ()
) -> Iterator[KeyRename]:
    """Yield the ids that one side renamed and below which the other side changed something.

    Raise MergeConflictError where both sides renamed one, or one side took away what the other one renamed.
    """
    if not (isinstance(base, MappingValue) and isinstance(ours, MappingValue) and isinstance(theirs, MappingValue)):
        return
    if base in {ours, theirs}:
        return
    old, our, their = (dict(value.items) for value in (base, ours, theirs))
    if find_part(path) in ENTRIES:
        for key in old.keys() - {FIELD_ORDER}:
            if key not in our or key not in their:
                yield from _judge_key(key, old, our, their, path)
    for key in old.keys() & our.keys() & their.keys():
        yield from find_renames(old[key], our[key], their[key], (*path, key))


def _judge_key(
    key: str,
    old: Mapping[str, MergedValue],
    our: Mapping[str, MergedValue],
    their: Mapping[str, MergedValue],
    path: tuple[str, ...],
) -> Iterator[KeyRename]:
    if key not in our and key not in their:
        our_key, their_key = _find_likeliest(key, old, our), _find_likeliest(key, old, their)
        # What both sides call alike is one element, also where one of them changed much of it.
        common_key = next((each for each in (our_key, their_key) if each in our and each in their), "")
        if our_key != their_key and not common_key:
            raise MergeConflictError((*path, key), _describe_contradiction((*path, key), our_key, their_key))
        if common_key and our[common_key] != their[common_key]:
            yield KeyRename(path, key, common_key, is_ours=True)
        return
    is_ours = key not in our
    renamed, edited = (our, their) if is_ours else (their, our)
    new_key = _find_same(key, old, renamed)
    # What the other side wrote under the new id is another element.
    if new_key and edited[key] != old[key] and new_key not in edited:
        yield KeyRename(path, key, new_key, is_ours)


def _describe_contradiction(path: tuple[str, ...], our_key: str, their_key: str) -> str:
    name = ".".join(path)
    if our_key and their_key:
        return f"both sides renamed `{name}`: it is `{our_key}` and `{their_key}` now"
    return f"one side renamed `{name}` to `{our_key or their_key}`, the other one took it away"


def _find_same(key: str, old: Mapping[str, MergedValue], new: Mapping[str, MergedValue]) -> str:
    """Return the only new id below which all of an old one stands, empty where it is not sure."""
    value = old[key]
    if not isinstance(value, MappingValue) or sum(_count_leaves(value).values()) < _SURE_LEAVES:
        return ""
    new_keys = [each for each in new.keys() - old.keys() if new[each] == value]
    lost_keys = [each for each in old.keys() - new.keys() if old[each] == value]
    return new_keys[0] if len(new_keys) == len(lost_keys) == 1 else ""


def _find_likeliest(key: str, old: Mapping[str, MergedValue], new: Mapping[str, MergedValue]) -> str:
    """Return the new id that is the likeliest for what stood below an old one, empty where none is likely."""
    old_leaves = _count_leaves(old[key])
    likenesses = [(_measure_likeness(old_leaves, _count_leaves(new[each])), each) for each in new.keys() - old.keys()]
    likeness, new_key = max(likenesses, key=lambda pair: (pair[0], pair[1]), default=(0.0, ""))
    return new_key if likeness >= MIN_LIKENESS else ""


def _measure_likeness(old_leaves: Counter[str], new_leaves: Counter[str]) -> float:
    common_count = (old_leaves & new_leaves).total()
    return common_count / (old_leaves | new_leaves).total() if common_count else 0.0


def _count_leaves(value: MergedValue, path: str = "") -> Counter[str]:
    """Return the values that stand below something, each with the keys that lead to it."""
    if isinstance(value, ScalarValue):
        return Counter([f"{path}={value.text}"])
    items = value.items if isinstance(value, MappingValue) else tuple(("-", item) for item in value.items)
    return sum((_count_leaves(item, f"{path}.{key}") for key, item in items if key != FIELD_ORDER), Counter[str]())
