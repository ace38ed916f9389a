"""In which order groups should stand, so that little flows backwards, and how to fold that order into rows."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

Weights = Mapping[tuple[str, str], int]
_EXACT = 12
"""Up to so many items the best order is found by looking at all sets (2 to this power)."""


def forward(items: Sequence[str], weights: Weights) -> tuple[str, ...]:
    """Order items so that as little weight as possible runs from a later to an earlier one."""
    if len(items) <= _EXACT:
        return _exact(items, weights)
    return _greedy(items, weights)


def _exact(items: Sequence[str], weights: Weights) -> tuple[str, ...]:
    """Dynamic programming over sets: the cheapest way to have placed exactly this set first."""
    count = len(items)
    cost = [[weights.get((items[a], items[b]), 0) for b in range(count)] for a in range(count)]
    best: list[tuple[int, int]] = [(0, -1)] * (1 << count)
    for chosen in range(1, 1 << count):
        tries = []
        for last in range(count):
            if chosen >> last & 1:
                before = chosen & ~(1 << last)
                back = sum(cost[last][each] for each in range(count) if before >> each & 1)
                tries.append((best[before][0] + back, last))
        best[chosen] = min(tries, key=lambda each: (each[0], -each[1]))
    order, chosen = [], (1 << count) - 1
    while chosen:
        last = best[chosen][1]
        order.append(items[last])
        chosen &= ~(1 << last)
    return tuple(reversed(order))


def _greedy(items: Sequence[str], weights: Weights) -> tuple[str, ...]:
    """Take what feeds more than it is fed, again and again (Eades, Lin and Smyth, 1993, in its simplest form)."""
    left, order = list(items), list[str]()
    while left:
        inside = set(left)
        surplus = dict.fromkeys(left, 0)
        for (tail, head), weight in weights.items():
            if tail in inside and head in inside:
                surplus[tail] += weight
                surplus[head] -= weight
        first = max(left, key=lambda item: surplus[item])
        order.append(first)
        left.remove(first)
    return tuple(order)


def folded(order: Sequence[str], lengths: Mapping[str, float], rows: int, gap: float) -> tuple[tuple[str, ...], ...]:
    """Cut an order into so many runs that the longest is as short as can be."""

    def runs(limit: float) -> list[list[str]]:
        found: list[list[str]] = [[]]
        used = 0.0
        for item in order:
            if found[-1] and used + lengths[item] > limit:
                found.append([])
                used = 0.0
            found[-1].append(item)
            used += lengths[item] + gap
        return found

    limits = sorted(set(_spans(order, lengths, gap)))
    best = next((found for limit in limits if len(found := runs(limit)) <= rows), [list(order)])
    return tuple(tuple(run) for run in best)


def _spans(order: Sequence[str], lengths: Mapping[str, float], gap: float) -> Iterator[float]:
    for first in range(len(order)):
        used = -gap
        for item in order[first:]:
            used += lengths[item] + gap
            yield used + 0.01
