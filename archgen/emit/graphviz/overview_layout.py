"""The layout `overview`: boxes in columns, one line for each pair of them with a head at each end that something arrives
at, and beside it how many flows arrive by it. With the direction `top-bottom` the same columns are rows.

Everything is placed by how far along the flow it lies, and how far across; turned into x and y at the end.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise

from archgen.cache.layout_memory import NO_MEMORY, LayoutMemory
from archgen.emit.graphviz import palette
from archgen.emit.graphviz.box_styles import write_member_card
from archgen.emit.graphviz.chart_layout import fix_node_size
from archgen.emit.graphviz.placed_scene import DotAttributes, Scene, SceneLine, ScenePart
from archgen.emit.graphviz.styled_graph import StyledGraph, measure_nodes
from archgen.frozen import dataclass
from archgen.views.graphs.group_columns import ColumnItem, GroupColumns, Lane, align_columns, arrange_groups
from archgen.views.picture_shapes import Arrow

_BOX_GAPS = {"left-right": 30.0, "top-bottom": 40.0}
"""Between two boxes of a column, in points: between boxes side by side a line has room for two numbers."""
_LANE_GAP = 15.0
"""Between a line and what it passes."""
_COLUMN_GAPS = {"left-right": 66.0, "top-bottom": 36.0}
"""Between two columns, by the direction."""
_PORT_STEPS = {"left-right": 9.75, "top-bottom": 13.0}
"""Between two lines at a side, by the direction: numbers stand one above the other, or side by side."""
_PORT_MARGIN = 8.0
_HEAD_LENGTH = 6.0
_SWING = 17.0
"""How far a line swings out that passes a box of its own column."""
_RIM = 2.6
"""The paper on both sides of a line together: where two cross, one is seen to pass over the other."""
_UNSEEN = {"style": '"invis"', "label": '""', "shape": '"point"', "width": "0", "height": "0"}

Spot = tuple[float, float]
"""How far along the flow, and how far across."""


@dataclass(frozen=True, slots=True)
class _DrawnLine:
    """A line from its first end to its last one, the points of its Bézier curves, and which way it arrives at both ends."""

    line: tuple[ColumnItem, ...]
    curve: tuple[Spot, ...]
    first_way: Spot
    last_way: Spot


def lay_out_overview(styled_graph: StyledGraph, memory: LayoutMemory = NO_MEMORY) -> Scene:
    """Place boxes, lines, heads and numbers."""
    graph = styled_graph.graph
    weights: dict[tuple[str, str], int] = {}
    for arrow in graph.arrows:
        weights[arrow.tail, arrow.head] = weights.get((arrow.tail, arrow.head), 0) + arrow.count
    arranged = arrange_groups([box.id for box in graph.boxes], weights, memory)
    direction = graph.direction or "left-right"
    cards, sizes = _size_boxes(styled_graph, upright=direction == "top-bottom")
    flip = direction == "top-bottom"
    spots, sizes = _place_items(arranged, sizes, direction)
    drawn_lines = _draw_lines(arranged, spots, sizes, _PORT_STEPS[direction])

    def turn(spot: Spot) -> Spot:
        return (spot[1], -spot[0]) if flip else (spot[0], -spot[1])

    parts = tuple(
        ScenePart(name, attributes, *turn(spots[box.id]), *(sizes[box.id][::-1] if flip else sizes[box.id]))
        for box in graph.boxes
        for name, attributes in [(styled_graph.dot_names[box.id], cards[box.id])]
    )
    writer = _LineWriter(styled_graph, arranged.find_column(), turn)
    scenes = [writer.write_line(at, drawn) for at, drawn in enumerate(drawn_lines)]
    return Scene(parts=parts).joined(*scenes)


def _size_boxes(styled_graph: StyledGraph, *, upright: bool) -> tuple[dict[str, DotAttributes], dict[str, Spot]]:
    """Return the attributes of each box, and how long it is along the flow and across. In columns all are as wide."""
    boxes = styled_graph.graph.boxes
    cards = {box.id: styled_graph.box_attributes[styled_graph.dot_names[box.id]] for box in boxes}
    measured = dict(zip(cards, measure_nodes(list(cards.values())), strict=True))
    if upright:
        return cards, {name: (height, width) for name, (width, height) in measured.items()}
    widest = math.ceil(max((width for width, _ in measured.values()), default=0))
    for box in boxes:
        if box.members:
            cards[box.id] = {**cards[box.id], "label": write_member_card(box, widest)}
    return cards, {
        name: (float(widest) if cards[name].get("shape") == "plain" else size[0], size[1])
        for name, size in measured.items()
    }


def _place_items(
    arranged: GroupColumns, sizes: Mapping[str, Spot], direction: str
) -> tuple[dict[ColumnItem, Spot], dict[str, Spot]]:
    """Return the middle of each box and lane, and the sizes of boxes, which have room for the lines at their sides."""
    ends: dict[tuple[str, int], int] = {}
    columns = arranged.find_column()
    for line in arranged.lines:
        if columns[str(line[0])] != columns[str(line[-1])]:
            for end in ((str(line[0]), 1), (str(line[-1]), 0)):
                ends[end] = ends.get(end, 0) + 1
    grown = {
        name: (
            along,
            max(
                across,
                _PORT_STEPS[direction] * (max(ends.get((name, side), 1) for side in (0, 1)) - 1) + 2 * _PORT_MARGIN,
            ),
        )
        for name, (along, across) in sizes.items()
    }

    def find_distance(one: ColumnItem, other: ColumnItem) -> float:
        halves = [grown[each][1] / 2 for each in (one, other) if isinstance(each, str)]
        return math.fsum(halves) + (_BOX_GAPS[direction] if len(halves) == 2 else _LANE_GAP)  # noqa: PLR2004 - two boxes

    across = align_columns(arranged, find_distance)
    spots: dict[ColumnItem, Spot] = {}
    along = 0.0
    for column in arranged.columns:
        depth = max((grown[each][0] for each in column if isinstance(each, str)), default=0.0)
        spots |= {each: (along + depth / 2, across[each]) for each in column}
        along += depth + _COLUMN_GAPS[direction]
    return spots, grown


def _draw_lines(
    arranged: GroupColumns, spots: Mapping[ColumnItem, Spot], sizes: Mapping[str, Spot], port_step: float
) -> list[_DrawnLine]:
    """Draw each line from port to port: level at both ends and where it passes a column."""
    columns = arranged.find_column()
    order = {item: at for column in arranged.columns for at, item in enumerate(column)}
    depths = [
        max((sizes[each][0] for each in column if isinstance(each, str)), default=0.0) for column in arranged.columns
    ]
    loops = {line: _find_loop_side(arranged, line, order, columns) for line in arranged.lines}
    ports = _place_ports(arranged, spots, sizes, loops, port_step)
    drawn = []
    for number, line in enumerate(arranged.lines):
        first, last = str(line[0]), str(line[-1])
        if columns[first] == columns[last]:
            ends = (ports[first, number], ports[last, number]) if loops[line] else None
            drawn.append(_draw_in_column(line, loops[line] * (depths[columns[first]] / 2 + _SWING), ends, spots, sizes))
            continue
        points: list[Spot] = []
        for item in line:
            half = depths[columns[first] + len(points) // 2] / 2
            height = spots[item][1] if isinstance(item, Lane) else ports[item, number][1]
            points += [(spots[item][0] - half, height), (spots[item][0] + half, height)]
        # From the sides of the boxes, which may be less deep than their column.
        points[0], points[-1] = ports[first, number], ports[last, number]
        curve = [points[0]]
        for at, (start, end) in enumerate(pairwise(points)):
            bend = (start[0] + end[0]) / 2
            curve += [start, end, end] if at % 2 == 0 else [(bend, start[1]), (bend, end[1]), end]
        drawn.append(_DrawnLine(line, tuple(curve), (-1.0, 0.0), (1.0, 0.0)))
    return drawn


def _find_loop_side(
    arranged: GroupColumns, line: tuple[ColumnItem, ...], order: Mapping[ColumnItem, int], columns: Mapping[str, int]
) -> int:
    """Return at which side a line inside of a column swings round what stands between: 1 behind it, -1 before it, 0 straight."""
    first, last = str(line[0]), str(line[-1])
    if columns[first] != columns[last]:
        return 0
    upper, lower = sorted((order[first], order[last]))
    between = set(arranged.columns[columns[first]][upper + 1 : lower])
    if not any(isinstance(each, str) for each in between):
        return 0
    behind = sum(one in between for each in arranged.lines for one, _ in pairwise(each))
    before = sum(other in between for each in arranged.lines for _, other in pairwise(each))
    return 1 if behind <= before else -1


def _place_ports(
    arranged: GroupColumns,
    spots: Mapping[ColumnItem, Spot],
    sizes: Mapping[str, Spot],
    loops: Mapping[tuple[ColumnItem, ...], int],
    port_step: float,
) -> dict[tuple[str, int], Spot]:
    """Return where each line ends at its boxes, by box and number of the line: at each side in the order of what comes next."""
    columns = arranged.find_column()
    sides: dict[tuple[str, int], list[tuple[float, int]]] = {}
    for number, line in enumerate(arranged.lines):
        first, last = str(line[0]), str(line[-1])
        if columns[first] != columns[last]:
            sides.setdefault((first, 1), []).append((spots[line[1]][1], number))
            sides.setdefault((last, -1), []).append((spots[line[-2]][1], number))
        elif loops[line]:
            # Beyond all other lines: it turns before they part.
            far = math.inf if spots[last][1] > spots[first][1] else -math.inf
            sides.setdefault((first, loops[line]), []).append((far, number))
            sides.setdefault((last, loops[line]), []).append((-far, number))
    ports: dict[tuple[str, int], Spot] = {}
    for (name, side), ends in sides.items():
        (along, across), (depth, width) = spots[name], sizes[name]
        step = min(port_step, (width - 2 * _PORT_MARGIN) / max(1, len(ends) - 1))
        for at, (_, number) in enumerate(sorted(ends)):
            ports[name, number] = (along + side * depth / 2, across + (at - (len(ends) - 1) / 2) * step)
    return ports


def _draw_in_column(
    line: tuple[ColumnItem, ...],
    swing: float,
    ends: tuple[Spot, Spot] | None,
    spots: Mapping[ColumnItem, Spot],
    sizes: Mapping[str, Spot],
) -> _DrawnLine:
    """Draw a line between two boxes of one column: straight without ends at a side, else so far out round what stands between."""
    first, last = str(line[0]), str(line[-1])
    curve: tuple[Spot, ...]
    way = 1.0 if spots[last][1] > spots[first][1] else -1.0
    if ends is None:
        along = spots[first][0]
        start = (along, spots[first][1] + way * sizes[first][1] / 2)
        end = (along, spots[last][1] - way * sizes[last][1] / 2)
        third = (end[1] - start[1]) / 3
        curve = (start, (along, start[1] + third), (along, end[1] - third), end)
        return _DrawnLine(line, curve, (0.0, -way), (0.0, way))
    start, end = ends
    out = spots[first][0] + swing
    side = math.copysign(1.0, swing)
    bend = min(_SWING, abs(end[1] - start[1]) / 2) * way
    curve = (
        start,
        *((out, start[1]), (out, start[1]), (out, start[1] + bend)),
        *((out, start[1] + bend), (out, end[1] - bend), (out, end[1] - bend)),
        *((out, end[1]), (out, end[1]), end),
    )
    return _DrawnLine(line, curve, (-side, 0.0), (-side, 0.0))


@dataclass(frozen=True, slots=True)
class _LineWriter:
    """Writes lines with their heads and numbers as parts of a scene."""

    styled_graph: StyledGraph
    columns: Mapping[str, int]
    turn: Callable[[Spot], Spot]

    def write_line(self, number: int, drawn: _DrawnLine) -> Scene:
        """Write a line, on a rim of paper, with a head for each of its arrows."""
        first, last = drawn.line[0], drawn.line[-1]
        arrows = [
            (at, arrow)
            for at, arrow in enumerate(self.styled_graph.graph.arrows)
            if {arrow.tail, arrow.head} == {first, last}
        ]
        heads = [(at, arrow, arrow.head == last) for at, arrow in arrows]
        # The line ends inside of the heads.
        curve = list(drawn.curve)
        for is_last in sorted({is_last for *_, is_last in heads}):
            index, way = (-1, drawn.last_way) if is_last else (0, drawn.first_way)
            curve[index] = _step(curve[index], way, -_HEAD_LENGTH + 1)
        spline = _write_spline([self.turn(spot) for spot in curve])
        main_at, main_arrow = max(arrows, key=lambda each: each[1].count)
        arrow_id, attributes = self.styled_graph.arrow_attributes[f"e{main_at}"]
        total = sum(arrow.count for _, arrow in arrows)
        pen = "2.4" if total > 3 else "1.5" if total > 1 else "0.9"  # noqa: PLR2004 - one, some, many
        attributes = {
            **attributes,
            "dir": '"none"',
            **({} if main_arrow.change or main_arrow.broken else {"penwidth": pen}),
        }
        rim = {
            "color": f'"{palette.PAPER}"',
            "penwidth": f"{float(attributes['penwidth']) + _RIM}",
            "dir": '"none"',
            "class": '"rim"',
        }
        ends = (f"p{number}a", f"p{number}b")
        marks = tuple(
            ScenePart(name, _UNSEEN, *self.turn(spot), 0, 0, "mark")
            for name, spot in zip(ends, (drawn.curve[0], drawn.curve[-1]), strict=True)
        )
        base = len(self.styled_graph.graph.arrows)
        lines = [
            SceneLine(f"{2 * base + number}", "", *ends, rim, spline),
            SceneLine(f"{main_at}", arrow_id, *ends, attributes, spline),
        ]
        labels: list[ScenePart] = []
        for at, arrow, is_last in heads:
            tip, way = (drawn.curve[-1], drawn.last_way) if is_last else (drawn.curve[0], drawn.first_way)
            lines.append(self._write_head(at, arrow, ends, tip, way))
            labels += self._write_number(at, arrow, tip, way)
        return Scene(lines=tuple(lines), parts=(*marks, *labels))

    def _runs_back(self, arrow: Arrow) -> bool:
        return self.columns[arrow.tail] > self.columns[arrow.head]

    def _write_head(self, at: int, arrow: Arrow, ends: tuple[str, str], tip: Spot, way: Spot) -> SceneLine:
        arrow_id, attributes = self.styled_graph.arrow_attributes[f"e{at}"]
        plain = {} if arrow.change or arrow.broken else {"style": '"solid"'}
        colour = {"color": f'"{palette.FEEDBACK}"'} if self._runs_back(arrow) and plain else {}
        head = {"penwidth": "1", "arrowsize": f"{_HEAD_LENGTH / 10 + 0.1 * (arrow.count > 1):.1f}"}
        base = _step(tip, way, -_HEAD_LENGTH)
        start = _step(base, way, -0.6)
        points = [self.turn(spot) for spot in (start, start, base, base)]
        spline = f"e,{_write_spline([self.turn(tip)])} {_write_spline(points)}"
        edge = len(self.styled_graph.graph.arrows) + at
        return SceneLine(f"{edge}", arrow_id, *ends, {**attributes, **plain, **colour, **head}, spline)

    def _write_number(self, at: int, arrow: Arrow, tip: Spot, way: Spot) -> list[ScenePart]:
        attributes = self.styled_graph.label_attributes.get(f"e{at}")
        if attributes is None:
            return []
        colour = palette.FEEDBACK if self._runs_back(arrow) and not arrow.change and not arrow.broken else palette.TEXT
        text = f'<<FONT POINT-SIZE="8" COLOR="{colour}"><B>{arrow.count}</B></FONT>>'
        attributes = {**attributes, "label": text} if not arrow.change and not arrow.broken else attributes
        ((width, _),) = measure_nodes([attributes])
        # No higher than the lines are apart.
        height = _PORT_STEPS["left-right"] - 0.3
        attributes |= fix_node_size(width, height)
        x, y = self.turn(_step(tip, way, -_HEAD_LENGTH - 1))
        right, up = self.turn(way)
        # Before the head of a level line; beside an upright one, at its other side for each way.
        x, y = (x - right * width / 2, y) if abs(right) > abs(up) else (x - up * (width / 2 + 3), y - up * height / 2)
        return [ScenePart(f"l{at}", attributes, x, y, width, height, "label")]


def _step(spot: Spot, way: Spot, distance: float) -> Spot:
    return spot[0] + way[0] * distance, spot[1] + way[1] * distance


def _write_spline(points: Sequence[Spot]) -> str:
    return " ".join(f"{x:.2f},{y:.2f}" for x, y in points)
