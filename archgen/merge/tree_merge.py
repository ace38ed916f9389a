"""Merge what three versions of a slice say: mappings key by key, so that each element is merged by its id.

Only meaning counts here: neither style of writing nor the order of keys, but for that of a message's fields. The text is
merged by `slice_merge`. What one side changed in an element follows the id that the other gave it, within one file.

Merge three versions of a sequence (lines, words, items of a list): what both sides kept ties the changes between.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from typing import Generic, TypeVar

from archgen.compare.element_likeness import CERTAIN, Feature, FeatureMap, find_likely_pairs
from archgen.frozen import NamedTuple, dataclass
from archgen.language.key_paths import find_list_order, find_part
from archgen.language.language_tables import ENTRIES
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, YamlNode

Item = TypeVar("Item", bound=Hashable)


@dataclass(frozen=True, slots=True)
class MergedRun(Generic[Item]):
    """A run of items on which the sides agree, or that only one of them changed."""

    items: tuple[Item, ...]


@dataclass(frozen=True, slots=True)
class ConflictingRun(Generic[Item]):
    """A run that both sides changed, each in its own way; `base` is what stood there before."""

    base: tuple[Item, ...]
    ours: tuple[Item, ...]
    theirs: tuple[Item, ...]


def merge_sequences(
    base: Sequence[Item], ours: Sequence[Item], theirs: Sequence[Item]
) -> Iterator[MergedRun[Item] | ConflictingRun[Item]]:
    """Yield the merged sequence as runs, in order. Runs that are empty are left out."""
    base_at = ours_at = theirs_at = 0
    for base_start, ours_start, theirs_start, length in _list_common_runs(base, ours, theirs):
        yield from _judge_run(
            tuple(base[base_at:base_start]), tuple(ours[ours_at:ours_start]), tuple(theirs[theirs_at:theirs_start])
        )
        if length:
            yield MergedRun(tuple(base[base_start : base_start + length]))
        base_at, ours_at, theirs_at = base_start + length, ours_start + length, theirs_start + length


def _judge_run(
    base: tuple[Item, ...], ours: tuple[Item, ...], theirs: tuple[Item, ...]
) -> Iterator[MergedRun[Item] | ConflictingRun[Item]]:
    if theirs in (base, ours):
        if ours:
            yield MergedRun(ours)
    elif ours == base:
        if theirs:
            yield MergedRun(theirs)
    else:
        yield ConflictingRun(base, ours, theirs)


def _list_common_runs(
    base: Sequence[Item], ours: Sequence[Item], theirs: Sequence[Item]
) -> Iterator[tuple[int, int, int, int]]:
    """Yield where all three versions have the same items: three beginnings and a length. The last is the end of all."""
    ours_blocks, theirs_blocks = _list_matching_blocks(base, ours), _list_matching_blocks(base, theirs)
    ours_index = theirs_index = 0
    while ours_index < len(ours_blocks) and theirs_index < len(theirs_blocks):
        ours_base, ours_start, ours_length = ours_blocks[ours_index]
        theirs_base, theirs_start, theirs_length = theirs_blocks[theirs_index]
        start, end = max(ours_base, theirs_base), min(ours_base + ours_length, theirs_base + theirs_length)
        if start < end:
            yield start, ours_start + start - ours_base, theirs_start + start - theirs_base, end - start
        if ours_base + ours_length < theirs_base + theirs_length:
            ours_index += 1
        else:
            theirs_index += 1
    yield len(base), len(ours), len(theirs), 0


def _list_matching_blocks(base: Sequence[Item], changed: Sequence[Item]) -> list[tuple[int, int, int]]:
    # Without `autojunk`: it takes what is frequent for noise, and the lines of a slice are frequent.
    matcher = SequenceMatcher(None, base, changed, autojunk=False)
    return [(block.a, block.b, block.size) for block in matcher.get_matching_blocks() if block.size]


_MAX_COMPARED = 2_000
"""Items of a list that is compared item by item: that takes time that grows with the square at worst."""
FIELD_PATHS = frozenset({("fields",), ("request",), ("response",), ("feedback",)})
"""Keys of a type below which order counts: fields stand in a message as they are written."""
FIELD_ORDER = "(order)"
"""The key under which the order of fields is merged; no field has such a name."""


class ScalarValue(NamedTuple):
    """A scalar by what it means: `1.10` and `1.1` are two versions, `"a"` and `a` are one text."""

    kind: str
    text: str


class ItemSet(NamedTuple):
    """A list whose order says nothing: its items, sorted by their form."""

    items: tuple[MergedValue, ...]


class ItemList(NamedTuple):
    """A list in which order counts."""

    items: tuple[MergedValue, ...]


class MappingValue(NamedTuple):
    """A mapping: its keys, sorted, and their values; the order of fields is the value of a key of its own."""

    items: tuple[tuple[str, MergedValue], ...]


MergedValue = ScalarValue | ItemSet | ItemList | MappingValue
"""What a node says, comparable and hashable."""
EMPTY_MAPPING = MappingValue(())
_EMPTY_ENTRY = ScalarValue(type(None).__name__, "")
"""`key:` without a value counts as not written."""


class MergeConflictError(Exception):
    """Both sides changed one thing, each in its own way. `path` are the keys that lead to it; `reason` says what they did
    where that is not plain.
    """

    def __init__(self, path: tuple[str, ...], reason: str = "") -> None:
        super().__init__(".".join(path))
        self.path = path
        self.reason = reason


def read_merged_value(node: YamlNode, path: tuple[str, ...] = ()) -> MergedValue:
    """Return what a node says; `path` are the keys that lead to it."""
    if isinstance(node, ScalarNode):
        return ScalarValue(type(node.value).__name__, node.value if isinstance(node.value, str) else node.text)
    if isinstance(node, MappingNode):
        items = [(entry.key, read_merged_value(entry.value, (*path, entry.key))) for entry in node]
        if path[:1] == ("types",) and path[2:] in FIELD_PATHS:
            items.append((FIELD_ORDER, ItemList(tuple(ScalarValue("str", entry.key) for entry in node))))
        return MappingValue(tuple(sorted(items, key=lambda item: item[0])))
    list_items = tuple(read_merged_value(item, path) for item in node.items)
    is_ordered = find_list_order(path) == "counts"
    return ItemList(list_items) if is_ordered else ItemSet(tuple(sorted(list_items, key=repr)))


def merge_values(
    base: MergedValue | None, ours: MergedValue | None, theirs: MergedValue | None, path: tuple[str, ...] = ()
) -> MergedValue | None:
    """Return what both sides say together, None for nothing. Raise MergeConflictError where they contradict.

    None stands for what a version does not have.
    """
    if theirs in (base, ours):
        return ours
    if ours == base:
        return theirs
    # What both sides add under one id is merged, too: a section, or a component that both begin to describe.
    is_begun = base is None or base == _EMPTY_ENTRY
    old_value = EMPTY_MAPPING if is_begun and isinstance(ours, MappingValue) else base
    if is_begun and find_list_order(path) == "gathered":
        old_value = ItemSet(())
    # A scalar in the place of such a list is a list of one.
    if isinstance(base, ScalarValue) and isinstance(ours, ItemSet) and base != _EMPTY_ENTRY:
        old_value = ItemSet((base,))
    if isinstance(old_value, MappingValue) and isinstance(ours, MappingValue) and isinstance(theirs, MappingValue):
        return _merge_mappings(dict(old_value.items), dict(ours.items), dict(theirs.items), path)
    if isinstance(old_value, ItemSet) and isinstance(ours, ItemSet) and isinstance(theirs, ItemSet):
        return _merge_item_sets(old_value.items, ours.items, theirs.items)
    if isinstance(base, ItemList) and isinstance(ours, ItemList) and isinstance(theirs, ItemList):
        return _merge_lists(base.items, ours.items, theirs.items, path)
    raise MergeConflictError(path)


def _merge_mappings(
    base: Mapping[str, MergedValue],
    ours: Mapping[str, MergedValue],
    theirs: Mapping[str, MergedValue],
    path: tuple[str, ...],
) -> MappingValue:
    keys = sorted(base.keys() | ours.keys() | theirs.keys())
    merged_values = ((key, merge_values(base.get(key), ours.get(key), theirs.get(key), (*path, key))) for key in keys)
    return MappingValue(tuple((key, value) for key, value in merged_values if value is not None))


def _merge_item_sets(
    base: Sequence[MergedValue], ours: Sequence[MergedValue], theirs: Sequence[MergedValue]
) -> ItemSet:
    """Keep what neither side took away, and what a side added; an item that both added is there once."""
    old_counts, our_counts, their_counts = Counter(base), Counter(ours), Counter(theirs)
    added_items = (our_counts - old_counts) | (their_counts - old_counts)
    kept_items = our_counts & their_counts & old_counts
    return ItemSet(tuple(sorted((kept_items + added_items).elements(), key=repr)))


def _merge_lists(
    base: Sequence[MergedValue], ours: Sequence[MergedValue], theirs: Sequence[MergedValue], path: tuple[str, ...]
) -> ItemList:
    if max(len(base), len(ours), len(theirs)) > _MAX_COMPARED:
        raise MergeConflictError(path)
    merged_items: list[MergedValue] = []
    for run in merge_sequences(base, ours, theirs):
        if not isinstance(run, MergedRun):
            raise MergeConflictError(path)
        merged_items += run.items
    return ItemList(tuple(merged_items))


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
