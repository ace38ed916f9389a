"""Order groups so that little flows backwards, and fold that order into rows."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise

from archgen.emit.graphviz.placed_scene import Rectangle, Scene
from archgen.frozen import dataclass, replace

_SAME_RANK = 4.0
"""Boxes whose middles are no farther apart than this, in points, are in one rank."""
_LEAST_SPACE = 6.0
_HOOK = 11.0
_HEAD_LENGTH = 6.0


@dataclass(frozen=True, slots=True)
class WrappedRanks:
    """Boxes (by their DOT names) in columns, and the row of each."""

    columns: Sequence[Sequence[Sequence[str]]]
    """For each column the names in each of its rows."""
    rows: Mapping[str, int]

    def write_statements(self) -> list[str]:
        """Return DOT statements that hold the boxes in their columns and rows."""
        statements = []
        for column in self.columns:
            names = [name for row in column for name in row]
            statements.append(f"{{ rank=same; {'; '.join(names)}; }}")
            # Boxes of one rank stand in any order to dot; invisible arrows keep the upper row above the lower one.
            statements += [
                f'{above[-1]} -> {below[0]} [style="invis"];' for above, below in pairwise(column) if above and below
            ]
        firsts = [next(name for row in column for name in row) for column in self.columns]
        return statements + [f'{left} -> {right} [style="invis"];' for left, right in pairwise(firsts)]

    def leaves_row(self, tail: str, head: str) -> bool:
        """Return whether an arrow runs from one row to another; none does from outside of the rows."""
        return tail in self.rows and head in self.rows and self.rows[tail] != self.rows[head]


def wrap_ranks(scene: Scene, names: Sequence[str], row_count: int) -> WrappedRanks | None:
    """Wrap boxes that are laid out to the right into rows; None where there are too few ranks for so many."""
    ranks = _read_ranks([(part.x, -part.y, part.name) for part in scene.parts if part.name in names])
    if row_count < 2 or len(ranks) < 2 * row_count:  # noqa: PLR2004 - two rows, each of two ranks or more
        return None
    # Rounded up: the last row may be shorter, and no row is added.
    width = -(-len(ranks) // row_count)
    columns = [[ranks[at] for at in range(column, len(ranks), width)] for column in range(width)]
    rows = {name: at // width for at, rank in enumerate(ranks) for name in rank}
    return WrappedRanks(columns, rows)


def route_between_rows(scene: Scene, wrapped: WrappedRanks) -> Scene:
    """Lead arrows that run back to the left into the next row through the space between the two rows.

    dot would lead them round below all rows.
    """
    parts = {part.name: part for part in scene.parts}
    row_count = max(wrapped.rows.values()) + 1
    inside: list[list[Rectangle]] = [[] for _ in range(row_count)]
    for name, row in wrapped.rows.items():
        inside[row].append(parts[name].rectangle)
    bottoms, tops = [min(box[1] for box in row) for row in inside], [max(box[3] for box in row) for row in inside]
    lines = []
    for line in scene.lines:
        row, next_row = (wrapped.rows.get(name, -1) for name in (line.tail, line.head))
        if (
            row >= 0
            and next_row == row + 1
            and bottoms[row] - tops[next_row] > _LEAST_SPACE
            and "dir" not in line.attributes
        ):
            tail, head = parts[line.tail].rectangle, parts[line.head].rectangle
            if head[0] <= tail[2]:
                line = replace(line, spline=_hooked_spline(tail, head, (bottoms[row] + tops[next_row]) / 2))  # noqa: PLW2901
        lines.append(line)
    return replace(scene, lines=tuple(lines))


def _hooked_spline(tail: Rectangle, head: Rectangle, space: float) -> str:
    """Return a line out of the tail's right side, back to the left at the height of the space, into the head's left
    side.
    """
    right, left = tail[2], head[0]
    start, end = (tail[1] + tail[3]) / 2, (head[1] + head[3]) / 2
    points = [
        (right, start),
        *((right + _HOOK, start), (right + _HOOK, space), (right, space)),
        *((right, space), (left, space), (left, space)),
        *((left - _HOOK, space), (left - _HOOK, end), (left - _HEAD_LENGTH, end)),
    ]
    return " ".join([f"e,{left:.2f},{end:.2f}", *(f"{x:.2f},{y:.2f}" for x, y in points)])


def _read_ranks(places: Sequence[tuple[float, float, str]]) -> list[list[str]]:
    """Return the names in each rank from left to right; in a rank from the top down."""
    ranks: list[list[tuple[float, float, str]]] = []
    for place in sorted(places):
        if not ranks or place[0] - ranks[-1][0][0] > _SAME_RANK:
            ranks.append([])
        ranks[-1].append(place)
    return [[name for _, _, name in sorted(rank, key=lambda place: place[1])] for rank in ranks]


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
