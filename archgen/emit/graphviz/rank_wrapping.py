"""Wrap a long row of boxes into several rows, as text is wrapped into lines: a chain of ten fits a page then.

The ranks of a first layout are dealt out to columns, row after row. dot lays that out again, and is told that arrows from
one row to the next say nothing about the columns.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from archgen.emit.graphviz.placed_scene import Rectangle, Scene

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
