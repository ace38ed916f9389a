"""Loops in graphs of any size, found without recursion."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from typing import TypeVar

T = TypeVar("T", bound=Hashable)


def rings(after: Mapping[T, Sequence[T]]) -> list[tuple[T, ...]]:
    """Give the strongly connected components that hold a loop (R. Tarjan, 1972), each in order of appearance."""
    index: dict[T, int] = {}
    low: dict[T, int] = {}
    open_now: dict[T, None] = {}
    found: list[tuple[T, ...]] = []
    for start in after:
        if start in index:
            continue
        index[start] = low[start] = len(index)
        open_now[start] = None
        work = [(start, iter(after[start]))]
        while work:
            vertex, targets = work[-1]
            target = next(targets, None)
            if target is None:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[vertex])
                if low[vertex] == index[vertex]:
                    _close(vertex, open_now, after, found)
            elif target not in index:
                index[target] = low[target] = len(index)
                open_now[target] = None
                work.append((target, iter(after.get(target, ()))))
            elif target in open_now:
                low[vertex] = min(low[vertex], index[target])
    order = {vertex: at for at, vertex in enumerate(after)}
    sorted_rings = [tuple(sorted(ring, key=lambda v: order.get(v, len(order)))) for ring in found]
    return sorted(sorted_rings, key=lambda ring: order.get(ring[0], len(order)))


def _close(root: T, open_now: dict[T, None], after: Mapping[T, Sequence[T]], found: list[tuple[T, ...]]) -> None:
    members: list[T] = []
    while not members or members[-1] != root:
        members.append(open_now.popitem()[0])
    if len(members) > 1 or root in after.get(root, ()):
        found.append(tuple(members))
