"""Columns of groups in which few lines cross and little runs back: the layout of the overview and of the explorer.

All that flows between two groups is one line, in either direction. A line that passes a column has a lane there, an
element of the column beside the groups. The columns are annealed with fixed seeds from the order with least feedback;
in each the order comes from sweeps of barycentres, at the end from several starts and sifting.
"""

from __future__ import annotations

import math
import random
from bisect import bisect_right, insort
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from itertools import pairwise

from archgen.cache.layout_memory import NO_MEMORY, LayoutMemory
from archgen.frozen import NamedTuple, dataclass
from archgen.model.feedback_order import order_by_feedback


class Lane(NamedTuple):
    """Where the line between two groups passes a column."""

    first: str
    last: str
    column: int


ColumnItem = str | Lane
"""A group by its id, or a lane."""


@dataclass(frozen=True, slots=True)
class GroupColumns:
    """Columns from left to right, each from above, and each line with all that it passes, in the order of the columns."""

    columns: tuple[tuple[ColumnItem, ...], ...]
    lines: tuple[tuple[ColumnItem, ...], ...]

    def find_column(self) -> dict[str, int]:
        """Return the column of each group."""
        return {item: at for at, column in enumerate(self.columns) for item in column if isinstance(item, str)}


FEWEST_CROSSINGS = 40
"""Where no drawing has fewer crossings than this, boxes and lines are no picture."""


def count_least_crossings(group_count: int, pair_count: int) -> int:
    """Return the crossings that any drawing has at least: of a plane one Euler's formula bounds the lines."""
    return max(0, pair_count - 3 * group_count + 6) if group_count > 2 else 0  # noqa: PLR2004


_BACK_COST, _SAME_COLUMN_SHARE, _PASSING_COST = 0.6, 0.4, 0.25
"""What counts as much as a crossing: a flow that runs back (of one that stays in its column a share), a column passed."""
_STEPS = 1500
"""Steps of annealing of a picture of 30 lines, for each seed; fewer where there are more lines, so that it takes as long."""
_SEEDS = 2
_STARTS = 12
_SWEEPS = 3
_Adjacency = list[list[int]]


def arrange_groups(
    groups: Sequence[str], weights: Mapping[tuple[str, str], int], memory: LayoutMemory = NO_MEMORY
) -> GroupColumns:
    """Arrange groups by how much flows from one to another; flows of a group to itself are no lines."""
    return _arrange(tuple(groups), tuple(weights.items()), memory)


@lru_cache(4)
def _arrange(
    groups: tuple[str, ...], weights: tuple[tuple[tuple[str, str], int], ...], memory: LayoutMemory
) -> GroupColumns:
    numbers = {group: at for at, group in enumerate(groups)}
    flows: dict[tuple[int, int], int] = {}
    for (tail, head), weight in weights:
        if tail != head and tail in numbers and head in numbers:
            flows[numbers[tail], numbers[head]] = weight
    linked = sorted({end for ends in flows for end in ends})
    chosen = _choose_columns(len(groups), linked, flows, memory)
    order = [list(column) for column in chosen.order] or [[]]
    for single in (at for at in range(len(groups)) if at not in set(linked)):
        # What has no flow fills the shortest columns from below, up to a square of columns.
        if len(order) ** 2 < len(groups):
            order.append([])
        min(order, key=len).append(single)
    lanes = {
        lane: Lane(groups[way[0]], groups[way[-1]], chosen.columns[way[0]] + at)
        for way in chosen.ways
        for at, lane in enumerate(way[1:-1], 1)
    }
    names: dict[int, ColumnItem] = {**dict(enumerate(groups)), **lanes}
    return GroupColumns(
        tuple(tuple(names[each] for each in column) for column in order if column),
        tuple(tuple(names[each] for each in way) for way in chosen.ways),
    )


def _choose_columns(
    group_count: int, linked: Sequence[int], flows: Mapping[tuple[int, int], int], memory: LayoutMemory
) -> _Choice:
    if not linked:
        return _Choice([], [])
    problem = f"columns {group_count} {sorted(flows.items())}"
    match memory.recall_choice(problem):
        case [[*columns], [*order], [*ways]]:
            return _Choice(columns, order, ways)
    chosen = _Search(group_count, linked, flows).run()
    memory.keep_choice(problem, chosen)
    return chosen


class _Choice(NamedTuple):
    columns: Sequence[int]
    """The column of each group."""
    order: Sequence[Sequence[int]]
    """The groups and lanes of each column, from above."""
    ways: Sequence[Sequence[int]] = ()
    """Each line with its lanes, in the order of the columns."""


class _Graph(NamedTuple):
    """Groups in their columns, with a lane wherever a line passes one."""

    columns: Sequence[int]
    members: list[list[int]]
    before: _Adjacency
    after: _Adjacency
    level: list[tuple[int, int]]
    """Lines between two groups of one column."""
    ways: list[list[int]]


class _Search:
    """One arrangement after the other, each judged by its crossings and by what runs back."""

    def __init__(self, group_count: int, linked: Sequence[int], flows: Mapping[tuple[int, int], int]) -> None:
        self.linked, self.flows = linked, flows
        # Lanes have the numbers behind those of all groups, of those without a line too.
        self.group_count = group_count
        self.pairs = list(dict.fromkeys((min(ends), max(ends)) for ends in flows))
        count = len(linked)
        wanted = 5 if count <= 12 else round(math.sqrt(2.2 * count))  # noqa: PLR2004 - as wide as a screen
        self.column_count = min(wanted, count)
        self.most = max(3 if count <= 12 else 4, -(-count // self.column_count))  # noqa: PLR2004
        self.first = order_by_feedback(linked, flows).elements
        self.known: dict[tuple[int, ...], tuple[float, dict[int, float]]] = {}

    def run(self) -> _Choice:
        """Return the best arrangement of all seeds."""
        columns = min((self._anneal(seed) for seed in range(_SEEDS)), key=lambda each: each[0])[1]
        graph = self._expand(columns)
        dice = random.Random(len(self.pairs))  # noqa: S311 - the same for the same groups
        orders = []
        for start in range(_STARTS):
            heights = self.known[tuple(columns)][1] if not start else {each: dice.random() for each in self.linked}
            orders.append(_sweep(graph, self._place_lanes(graph, heights), 4 * _SWEEPS))
        order = _sift(graph, min(orders, key=lambda each: each[0])[1])
        return _Choice(columns, order, graph.ways)

    def _anneal(self, seed: int) -> tuple[float, list[int]]:
        """Move single groups to the next column, or exchange two, and keep the best columns met."""
        dice = random.Random(seed)  # noqa: S311 - the same in every run
        count, linked = len(self.linked), self.linked
        columns = [0] * self.group_count
        for at, group in enumerate(self.first):
            columns[group] = at * self.column_count // count
        cost, heights = self._judge(columns, math.inf, {})
        best = (cost, columns)
        sizes = [0] * self.column_count
        for group in linked:
            sizes[columns[group]] += 1
        fixed = self.first[0] if self._gives_to_most(self.first[0]) else -1
        steps = max(60, _STEPS * 30 // max(30, len(self.pairs)))
        for step in range(steps):
            one, other = dice.choice(linked), dice.choice(linked)
            aside = columns[one] + dice.choice((-1, 1))
            target = columns[:]
            if dice.random() < 0.6:  # noqa: PLR2004 - three moves for two exchanges
                if not 0 <= aside < self.column_count or sizes[aside] >= self.most or sizes[columns[one]] == 1:
                    continue
                target[one] = aside
            else:
                target[one], target[other] = target[other], target[one]
            if target == columns or (fixed >= 0 and target[fixed]):
                continue
            limit = cost - (2.05 - 2 * step / steps) * math.log(1 - dice.random())
            new_cost, new_heights = self._judge(target, limit, heights)
            if new_cost < limit:
                sizes[columns[one]] -= 1
                sizes[target[one]] += 1
                if target[other] != columns[other] and other != one:
                    sizes[columns[other]] -= 1
                    sizes[target[other]] += 1
                columns, cost, heights = target, new_cost, new_heights
                best = min(best, (cost, columns), key=lambda each: each[0])
        return best

    def _gives_to_most(self, group: int) -> bool:
        """Whether a group gives to more than half of all others, as hardware does: it stands in the first column."""
        return 2 * sum(tail == group for tail, _ in self.flows) > len(self.linked) - 1

    def _judge(
        self, columns: Sequence[int], limit: float, heights: Mapping[int, float]
    ) -> tuple[float, dict[int, float]]:
        """Return what an arrangement costs and the heights of its groups. Where the columns alone cost the limit, nothing is ordered."""
        key = tuple(columns)
        if key in self.known:
            return self.known[key]
        base = self._price_columns(columns)
        if base >= limit:
            return base, {}
        graph = self._expand(columns)
        crossings, order = _sweep(graph, self._place_lanes(graph, heights), _SWEEPS)
        new_heights = {
            item: (at + 0.5) / len(column)
            for column in order
            for at, item in enumerate(column)
            if item < self.group_count
        }
        self.known[key] = base + crossings, new_heights
        return self.known[key]

    def _price_columns(self, columns: Sequence[int]) -> float:
        back_count, level_count, passed_count = 0, 0, 0
        for (tail, head), weight in self.flows.items():
            if columns[tail] > columns[head]:
                back_count += weight
            elif columns[tail] == columns[head]:
                level_count += weight
        for tail, head in self.pairs:
            passed_count += max(0, abs(columns[tail] - columns[head]) - 1)
        return _BACK_COST * (back_count + _SAME_COLUMN_SHARE * level_count) + _PASSING_COST * passed_count

    def _expand(self, columns: Sequence[int]) -> _Graph:
        members: list[list[int]] = [[] for _ in range(self.column_count)]
        for group in self.linked:
            members[columns[group]].append(group)
        before: _Adjacency = [[] for _ in range(self.group_count)]
        after: _Adjacency = [[] for _ in range(self.group_count)]
        level, ways = list[tuple[int, int]](), list[list[int]]()
        for ends in self.pairs:
            first, last = ends if columns[ends[0]] <= columns[ends[1]] else ends[::-1]
            way = [first]
            for column in range(columns[first] + 1, columns[last]):
                members[column].append(len(before))
                way.append(len(before))
                before.append([])
                after.append([])
            way.append(last)
            ways.append(way)
            if columns[first] == columns[last]:
                level.append((first, last))
                continue
            for one, other in pairwise(way):
                after[one].append(other)
                before[other].append(one)
        return _Graph(columns, members, before, after, level, ways)

    def _place_lanes(self, graph: _Graph, heights: Mapping[int, float]) -> list[list[int]]:
        """Return the members of each column by their heights: a lane lies on the straight line between the ends."""
        place = [heights.get(each, 0.5) for each in range(len(graph.before))]
        for way in graph.ways:
            for at, lane in enumerate(way[1:-1], 1):
                share = at / (len(way) - 1)
                place[lane] = place[way[0]] * (1 - share) + place[way[-1]] * share
        return [sorted(column, key=place.__getitem__) for column in graph.members]


def _sweep(graph: _Graph, order: list[list[int]], sweeps: int) -> tuple[int, list[list[int]]]:
    """Order each column by the mean place of what stands in the next one, forth and back. Return the best crossings met."""
    place = [0] * len(graph.before)
    for column in order:
        for at, item in enumerate(column):
            place[item] = at
    least, best = _count_crossings(graph, order, place), [column[:] for column in order]
    for sweep in range(sweeps):
        forth = sweep % 2 == 0
        for column in order[1:] if forth else order[-2::-1]:
            neighbours = graph.before if forth else graph.after
            means: dict[int, float] = {}
            for item in column:
                near = neighbours[item]
                means[item] = sum([place[each] for each in near]) / len(near) if near else place[item]
            column.sort(key=means.__getitem__)
            for at, item in enumerate(column):
                place[item] = at
        crossings = _count_crossings(graph, order, place)
        if crossings < least:
            least, best = crossings, [column[:] for column in order]
    return least, best


def _count_crossings(graph: _Graph, order: Sequence[Sequence[int]], place: Sequence[int]) -> int:
    """Count the crossings between columns, and of lines inside of a column with what stands between their ends."""
    total = 0
    after = graph.after
    for column in order[:-1]:
        seen: list[int] = []
        for item in column:
            ends = sorted([place[each] for each in after[item]])
            for end in ends:
                if seen and seen[-1] > end:
                    total += len(seen) - bisect_right(seen, end)
            for end in ends:
                insort(seen, end)
    for one, other in graph.level:
        upper, lower = sorted((place[one], place[other]))
        if lower - upper > 1:
            between = order[graph.columns[one]][upper + 1 : lower]
            total += min(
                sum([len(graph.before[each]) for each in between]), sum([len(after[each]) for each in between])
            )
    return total


def _sift(graph: _Graph, order: list[list[int]]) -> list[list[int]]:
    """Move each item to the best place of its column, until nothing gets better."""
    place = [0] * len(graph.before)

    def count_at(column: list[int]) -> int:
        for at, item in enumerate(column):
            place[item] = at
        return _count_crossings(graph, order, place)

    for column in order:
        least = count_at(column)
    is_better = True
    while is_better:
        is_better = False
        for column in order:
            for item in tuple(column):
                home = column.index(item)
                best = home
                for at in range(len(column)):
                    column.remove(item)
                    column.insert(at, item)
                    crossings = count_at(column)
                    if crossings < least:
                        least, best = crossings, at
                column.remove(item)
                column.insert(best, item)
                count_at(column)
                is_better = is_better or best != home
    return order


_ROUNDS = 60
_LEVEL_WEIGHT = 4


def align_columns(
    arranged: GroupColumns, find_distance: Callable[[ColumnItem, ColumnItem], float]
) -> dict[ColumnItem, float]:
    """Return the heights of all items, at least as far apart as they must be, so that lines, and lanes above all, lie level."""
    near: dict[ColumnItem, list[tuple[ColumnItem, int]]] = {item: [] for column in arranged.columns for item in column}
    for line in arranged.lines:
        for one, other in pairwise(line):
            weight = _LEVEL_WEIGHT if isinstance(one, Lane) and isinstance(other, Lane) else 1
            near[one].append((other, weight))
            near[other].append((one, weight))
    steps = [[find_distance(one, other) for one, other in pairwise(column)] for column in arranged.columns]
    heights: dict[ColumnItem, float] = {}
    for column, gaps in zip(arranged.columns, steps, strict=True):
        height = -math.fsum(gaps) / 2
        for item, gap in zip(column, [0.0, *gaps], strict=True):
            height += gap
            heights[item] = height
    for at in range(_ROUNDS):
        for number in range(len(arranged.columns)) if at % 2 == 0 else reversed(range(len(arranged.columns))):
            column = arranged.columns[number]
            wishes = []
            for item in column:
                total = math.fsum([weight for _, weight in near[item]])
                mean = math.fsum([heights[other] * weight for other, weight in near[item]])
                wishes.append(mean / total if total else heights[item])
            heights.update(zip(column, spread_apart(wishes, steps[number]), strict=True))
    return heights


def spread_apart(wishes: Sequence[float], steps: Sequence[float]) -> list[float]:
    """Return heights at least the steps apart, in this order, that are as near to the wished ones as can be.

    Neighbours that would overlap are moved together as a block (pool adjacent violators).
    """
    offsets = [0.0]
    for step in steps[: max(0, len(wishes) - 1)]:
        offsets.append(offsets[-1] + step)
    blocks: list[tuple[float, int]] = []
    for wish, offset in zip(wishes, offsets, strict=False):
        # Without the distance that it needs from the first item, so that blocks are plain means.
        blocks.append((wish - offset, 1))
        while len(blocks) > 1 and blocks[-2][0] > blocks[-1][0]:
            (upper, upper_size), (lower, lower_size) = blocks[-2:]
            size = upper_size + lower_size
            blocks[-2:] = [((upper * upper_size + lower * lower_size) / size, size)]
    middles = [middle for middle, size in blocks for _ in range(size)]
    return [middle + offset for middle, offset in zip(middles, offsets, strict=False)]
