"""Lay out the inside of one frame: connected boxes by dot, loose ones in rows, all packed into a rectangle."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from archgen.emit.graphviz import layout_engine
from archgen.emit.graphviz.group_order import route_between_rows, wrap_ranks
from archgen.emit.graphviz.placed_scene import Scene, ScenePart
from archgen.emit.graphviz.styled_graph import StyledGraph, measure_nodes, read_layout, write_dot
from archgen.model.graph_search import find_strong_components
from archgen.views.picture_shapes import Arrow, Box

_PIECE_GAP = 12.0
_WRAPPED_ASPECT = 3.0
"""How many times as wide as high a part may be before it is wrapped."""
NumberedArrow = tuple[int, Arrow]


def lay_out_inside(
    styled_graph: StyledGraph, boxes: Sequence[Box], arrows: Sequence[NumberedArrow], aspect_ratio: float = 2.4
) -> Scene:
    """Lay out boxes and the arrows among them, about `aspect_ratio` times as wide as high. The lower left corner is 0,
    0.
    """
    pieces = [_lay_out_part(styled_graph, part, arrows) for part in _connected_parts(boxes, arrows)]
    sizes = [scene.bounds() for scene in pieces]
    widest = max((bounds[2] - bounds[0] for bounds in sizes), default=0.0)
    total = math.fsum(bounds[2] - bounds[0] + _PIECE_GAP for bounds in sizes)
    widths = [bounds[2] - bounds[0] for bounds in sizes]
    # Row widths from the widest piece alone to everything in one row; narrow steps where most good packings are.
    row_choices = [
        _split_into_rows(widths, widest + share * (total - widest)) for share in (0, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1)
    ]
    scenes = (_stack_rows([[pieces[at] for at in row] for row in rows]) for rows in dict.fromkeys(row_choices))
    return min(scenes, key=lambda scene: _shape_cost(scene, aspect_ratio))


def _shape_cost(scene: Scene, aspect_ratio: float) -> float:
    left, bottom, right, top = scene.bounds()
    width, height = right - left, top - bottom
    # Both count: the side that exceeds the wanted shape, and the area.
    return max(width, height * aspect_ratio) * math.sqrt(width * height)


def _connected_parts(boxes: Sequence[Box], arrows: Sequence[NumberedArrow]) -> list[list[Box]]:
    """Split boxes into connected parts, the largest first, else in order."""
    boxes_by_id = {box.id: box for box in boxes}
    neighbours: dict[str, list[str]] = {box_id: [] for box_id in boxes_by_id}
    for _, arrow in arrows:
        if arrow.tail in boxes_by_id and arrow.head in boxes_by_id:
            neighbours[arrow.tail].append(arrow.head)
            neighbours[arrow.head].append(arrow.tail)
    position = {box_id: number for number, box_id in enumerate(boxes_by_id)}
    parts = find_strong_components(neighbours, neighbours.__getitem__)
    parts.sort(key=lambda part: (-len(part), position[part[0]]))
    return [[boxes_by_id[box_id] for box_id in part] for part in parts]


def _lay_out_part(styled_graph: StyledGraph, boxes: Sequence[Box], arrows: Sequence[NumberedArrow]) -> Scene:
    names = {box.id: None for box in boxes}
    # A single box needs no layout, and Graphviz is what takes the time.
    if len(names) == 1 and not any(arrow.tail in names and arrow.head in names for _, arrow in arrows):
        name = styled_graph.dot_names[boxes[0].id]
        ((width, height),) = measure_nodes([styled_graph.box_attributes[name]])
        return Scene(parts=(ScenePart(name, styled_graph.box_attributes[name], width / 2, height / 2, width, height),))
    direction = "TB" if styled_graph.graph.direction == "top-bottom" else "LR"
    nodes = [styled_graph.write_node(box) for box in boxes]
    inner_arrows = [(at, arrow) for at, arrow in arrows if arrow.tail in names and arrow.head in names]
    edges = [styled_graph.write_edge(at, arrow, with_text=False) for at, arrow in inner_arrows]
    settings = f'rankdir="{direction}" nodesep="0.12" ranksep="0.3"'
    scene = read_layout(styled_graph, layout_engine.lay_out_dot(write_dot(settings, [*nodes, *edges])))
    dot_names = styled_graph.dot_names
    left, bottom, right, top = scene.bounds()
    row_count = math.floor(math.sqrt((right - left) / (_WRAPPED_ASPECT * (top - bottom)))) if direction == "LR" else 1
    wrapped = wrap_ranks(scene, [dot_names[name] for name in names], row_count)
    if wrapped is None:
        return scene
    edges = [
        styled_graph.write_edge(
            at, arrow, with_text=False, is_free=wrapped.leaves_row(dot_names[arrow.tail], dot_names[arrow.head])
        )
        for at, arrow in inner_arrows
    ]
    statements = [*nodes, *wrapped.write_statements(), *edges]
    settings = 'rankdir="LR" nodesep="0.22" ranksep="0.3"'
    rows = read_layout(styled_graph, layout_engine.lay_out_dot(write_dot(settings, statements)))
    # dot loses a line now and then where many run back.
    return route_between_rows(rows, wrapped) if len(rows.lines) == len(scene.lines) else scene


def _split_into_rows(widths: Sequence[float], row_width: float) -> tuple[tuple[int, ...], ...]:
    """Split pieces into rows that are no wider than asked, in order. Return positions in `widths`, row by row."""
    rows: list[list[int]] = []
    used_width = 0.0
    for at, size in enumerate(widths):
        if not rows or used_width + size > row_width + 0.01:
            rows.append([])
            used_width = 0.0
        rows[-1].append(at)
        used_width += size + _PIECE_GAP
    return tuple(tuple(row) for row in rows)


def _stack_rows(rows: Iterable[Sequence[Scene]]) -> Scene:
    """Place the pieces of each row side by side, their middles aligned. The lower left corner of the result is 0, 0."""
    placed_pieces: list[Scene] = []
    top = 0.0
    for row in rows:
        height = max(piece.bounds()[3] - piece.bounds()[1] for piece in row)
        x = 0.0
        for piece in row:
            left, bottom, right, upper = piece.bounds()
            placed_pieces.append(piece.moved(x - left, top - height / 2 - (bottom + upper) / 2))
            x += right - left + _PIECE_GAP
        top -= height + _PIECE_GAP
    scene = Scene().joined(*placed_pieces)
    left, bottom, _, _ = scene.bounds()
    return scene.moved(-left, -bottom)
