"""Order groups so that little flows backwards, and fold that order into rows."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

Weights = Mapping[tuple[str, str], int]
Rows = tuple[tuple[str, ...], ...]
_ROWS = range(2, 8)
_EXACT = 12
"""Up to this many items the best order is found over all subsets (2 to this power)."""


def forward(items: Sequence[str], weights: Weights) -> tuple[str, ...]:
    """Order items so that as little weight as possible runs from a later to an earlier one."""
    if len(items) <= _EXACT:
        return _exact(items, weights)
    return _greedy(items, weights)


def _exact(items: Sequence[str], weights: Weights) -> tuple[str, ...]:
    """Order items by dynamic programming over subsets: the least weight with exactly this subset placed first."""
    count = len(items)
    cost = [[weights.get((items[a], items[b]), 0) for b in range(count)] for a in range(count)]
    back = [_sums(row) for row in cost]
    best: list[tuple[int, int]] = [(0, -1)] * (1 << count)
    for chosen in range(1, 1 << count):
        tries = []
        for last in range(count):
            if chosen >> last & 1:
                before = chosen & ~(1 << last)
                # Of equal costs `min` takes the largest index as the last item: equals keep the order of the files.
                tries.append((best[before][0] + back[last][before], -last))
        least, last = min(tries)
        best[chosen] = (least, -last)
    order, chosen = [], (1 << count) - 1
    while chosen:
        last = best[chosen][1]
        order.append(items[last])
        chosen &= ~(1 << last)
    return tuple(reversed(order))


def _sums(costs: Sequence[int]) -> list[int]:
    """Return the sum of each subset of costs, by the subset's bits."""
    sums = [0]
    for cost in costs:
        sums += [each + cost for each in sums]
    return sums


def _greedy(items: Sequence[str], weights: Weights) -> tuple[str, ...]:
    """Take the item that feeds most more than it is fed, again and again (Eades, Lin and Smyth, 1993, in its simplest
    form).
    """
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


def folds(order: Sequence[str], judge: Callable[[Rows], float]) -> list[Rows]:
    """Cut an order into two to seven rows. Return the best cut for each number of rows; long orders are cut evenly
    only.
    """
    count = len(order)
    if count > _EXACT:
        return [_even(order, rows) for rows in _ROWS]
    best: dict[int, tuple[float, Rows]] = {}
    # Bit i cuts after item i: at most 2,047 ways of cutting, since longer orders went another way.
    for marks in range(1, 1 << max(count - 1, 0)):
        rows = _cut(order, marks)
        if len(rows) in _ROWS and (worth := judge(rows)) < best.get(len(rows), (math.inf,))[0]:
            best[len(rows)] = (worth, rows)
    return [best[rows][1] for rows in sorted(best)]


def _cut(order: Sequence[str], marks: int) -> Rows:
    """Cut an order after each item whose bit is set."""
    rows: list[list[str]] = [[]]
    for at, item in enumerate(order):
        rows[-1].append(item)
        if marks >> at & 1:
            rows.append([])
    return tuple(tuple(row) for row in rows)


def _even(order: Sequence[str], rows: int) -> Rows:
    size = -(-len(order) // rows)
    return tuple(tuple(order[at : at + size]) for at in range(0, len(order), size))
