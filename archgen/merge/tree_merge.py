"""Merge what three versions of a slice say: mappings key by key, so that each element is merged by its id.

Only meaning counts here: neither style of writing nor the order of keys, but for that of a message's fields. The text is
merged by `slice_merge`.

Merge three versions of a sequence (lines, words, items of a list): what both sides kept ties the changes between.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from typing import Generic, TypeVar

from archgen.frozen import NamedTuple, dataclass
from archgen.language.key_paths import find_list_order
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
