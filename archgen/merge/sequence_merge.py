"""Merge three versions of a sequence (lines, words, items of a list): what both sides kept ties the changes between."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from difflib import SequenceMatcher
from typing import Generic, TypeVar

from archgen.frozen import dataclass

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
