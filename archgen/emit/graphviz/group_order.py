"""Order groups so that little flows backwards, and fold that order into rows."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise

FlowWeights = Mapping[tuple[str, str], int]
GroupRows = tuple[tuple[str, ...], ...]
RowJudge = Callable[[GroupRows, float], float]
"""Returns the cost of rows; of what costs as much as the limit or more it need not be exact."""
_ROW_COUNTS = range(2, 8)
_MAX_TRIED_CUTS = 3
"""Of a long order: dot takes 20 to 50 ms for each. In short ones the estimate is too coarse to leave one out."""
_MAX_EXACT = 12
"""Up to this many items the best order is found over all subsets (2 to this power)."""


def order_forward(items: Sequence[str], weights: FlowWeights) -> tuple[str, ...]:
    """Order items so that as little weight as possible runs from a later to an earlier one."""
    if len(items) <= _MAX_EXACT:
        return _order_exactly(items, weights)
    return _order_greedily(items, weights)


def _order_exactly(items: Sequence[str], weights: FlowWeights) -> tuple[str, ...]:
    """Order items by dynamic programming over subsets: the least weight with exactly this subset placed first."""
    count = len(items)
    cost = [[weights.get((items[a], items[b]), 0) for b in range(count)] for a in range(count)]
    backward_costs = [_subset_sums(row) for row in cost]
    best: list[tuple[int, int]] = [(0, -1)] * (1 << count)
    for chosen in range(1, 1 << count):
        choices = []
        for last in range(count):
            if chosen >> last & 1:
                before = chosen & ~(1 << last)
                # Of equal costs `min` takes the largest index as the last item: equals keep the order of the files.
                choices.append((best[before][0] + backward_costs[last][before], -last))
        least, last = min(choices)
        best[chosen] = (least, -last)
    order, chosen = [], (1 << count) - 1
    while chosen:
        last = best[chosen][1]
        order.append(items[last])
        chosen &= ~(1 << last)
    return tuple(reversed(order))


def _subset_sums(costs: Sequence[int]) -> list[int]:
    """Return the sum of each subset of costs, by the subset's bits."""
    sums = [0]
    for cost in costs:
        sums += [each + cost for each in sums]
    return sums


def _order_greedily(items: Sequence[str], weights: FlowWeights) -> tuple[str, ...]:
    """Take the item that feeds most more than it is fed, again and again (Eades, Lin and Smyth, 1993, in its simplest
    form).
    """
    remaining, order = list(items), list[str]()
    while remaining:
        remaining_set = set(remaining)
        surplus = dict.fromkeys(remaining, 0)
        for (tail, head), weight in weights.items():
            if tail in remaining_set and head in remaining_set:
                surplus[tail] += weight
                surplus[head] -= weight
        first = max(remaining, key=lambda item: surplus[item])
        order.append(first)
        remaining.remove(first)
    return tuple(order)


def fold_order(order: Sequence[str], judge_rows: RowJudge) -> list[GroupRows]:
    """Cut an order into two to seven rows. Return the best cut for each number of rows; long orders are cut evenly only,
    and only the cuts that are judged best are worth a layout.
    """
    count = len(order)
    if count > _MAX_EXACT:
        cuts = [_cut_evenly(order, rows) for rows in _ROW_COUNTS]
        tried = sorted(cuts, key=lambda rows: judge_rows(rows, math.inf))[:_MAX_TRIED_CUTS]
        return [rows for rows in cuts if rows in tried]
    best: dict[int, tuple[float, GroupRows]] = {}
    # Bit i cuts after item i: at most 2,047 ways of cutting, since longer orders went another way.
    for cut_bits in range(1, 1 << max(count - 1, 0)):
        row_count = cut_bits.bit_count() + 1
        least = best.get(row_count, (math.inf,))[0]
        if row_count in _ROW_COUNTS and (score := judge_rows(rows := _cut_order(order, cut_bits), least)) < least:
            best[row_count] = (score, rows)
    return [best[rows][1] for rows in sorted(best)]


def _cut_order(order: Sequence[str], cut_bits: int) -> GroupRows:
    """Cut an order after each item whose bit is set."""
    items = tuple(order)
    ends = [at + 1 for at in range(len(items)) if cut_bits >> at & 1]
    return tuple([items[start:end] for start, end in pairwise([0, *ends, len(items)])])


def _cut_evenly(order: Sequence[str], row_count: int) -> GroupRows:
    size = -(-len(order) // row_count)
    return tuple(tuple(order[at : at + size]) for at in range(0, len(order), size))
