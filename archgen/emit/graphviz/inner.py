"""Lay out the inside of one frame: connected boxes by dot, loose ones in rows, all packed into a rectangle."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from archgen.emit.graphviz import engine
from archgen.emit.graphviz.draft import Draft, document, measure, read
from archgen.emit.graphviz.scene import Part, Scene
from archgen.views.shapes import Arrow, Box

_GAP = 12.0
Numbered = tuple[int, Arrow]


def inside(drafted: Draft, boxes: Sequence[Box], arrows: Sequence[Numbered], shape: float = 2.4) -> Scene:
    """Lay out boxes and the arrows among them, about `aspect_ratio` times as wide as high. The lower left corner is 0,
    0.
    """
    pieces = [_laid_out(drafted, part, arrows) for part in _connected(boxes, arrows)]
    sizes = [scene.bounds() for scene in pieces]
    widest = max((bounds[2] - bounds[0] for bounds in sizes), default=0.0)
    total = sum(bounds[2] - bounds[0] + _GAP for bounds in sizes)
    wide = [bounds[2] - bounds[0] for bounds in sizes]
    # Row widths from the widest piece alone to everything in one row; narrow steps where most good packings are.
    tries = [_shelves(wide, widest + share * (total - widest)) for share in (0, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1)]
    scenes = (_stacked([[pieces[at] for at in row] for row in rows]) for rows in dict.fromkeys(tries))
    return min(scenes, key=lambda scene: _cost(scene, shape))


def _cost(scene: Scene, shape: float) -> float:
    left, bottom, right, top = scene.bounds()
    width, height = right - left, top - bottom
    # Both count: the side that exceeds the wanted shape, and the area.
    return max(width, height * shape) * math.sqrt(width * height)


def _connected(boxes: Sequence[Box], arrows: Sequence[Numbered]) -> list[list[Box]]:
    """Split boxes into connected parts, the largest first, else in order."""
    # Union-find: each box points to another one of its part, its root to itself.
    root = {box.id: box.id for box in boxes}

    def find(name: str) -> str:
        while root[name] != name:
            name = root[name]
        return name

    for _, arrow in arrows:
        if arrow.tail in root and arrow.head in root:
            root[find(arrow.head)] = find(arrow.tail)
    parts: dict[str, list[Box]] = {}
    for box in boxes:
        parts.setdefault(find(box.id), []).append(box)
    return sorted(parts.values(), key=lambda part: -len(part))


def _laid_out(drafted: Draft, boxes: Sequence[Box], arrows: Sequence[Numbered]) -> Scene:
    names = {box.id for box in boxes}
    # A single box needs no layout, and Graphviz is what takes the time.
    if len(names) == 1 and not any(arrow.tail in names and arrow.head in names for _, arrow in arrows):
        name = drafted.names[boxes[0].id]
        ((width, height),) = measure([drafted.boxes[name]])
        return Scene(parts=(Part(name, drafted.boxes[name], width / 2, height / 2, width, height),))
    direction = "LR" if drafted.graph.direction == "left-right" else "TB"
    lines = [drafted.node(box) for box in boxes]
    lines += [
        drafted.edge(at, arrow, text=False) for at, arrow in arrows if arrow.tail in names and arrow.head in names
    ]
    settings = f'rankdir="{direction}" nodesep="0.12" ranksep="0.3"'
    return read(drafted, engine.layout(document(settings, lines)))


def _shelves(sizes: Sequence[float], width: float) -> tuple[tuple[int, ...], ...]:
    """Split pieces into rows that are no wider than asked, in order. Return positions in `widths`, row by row."""
    rows: list[list[int]] = []
    used = 0.0
    for at, size in enumerate(sizes):
        if not rows or used + size > width + 0.01:
            rows.append([])
            used = 0.0
        rows[-1].append(at)
        used += size + _GAP
    return tuple(tuple(row) for row in rows)


def _stacked(rows: Iterable[Sequence[Scene]]) -> Scene:
    """Place the pieces of each row side by side, their middles aligned. The lower left corner of the result is 0, 0."""
    done: list[Scene] = []
    top = 0.0
    for row in rows:
        height = max(piece.bounds()[3] - piece.bounds()[1] for piece in row)
        x = 0.0
        for piece in row:
            left, bottom, right, upper = piece.bounds()
            done.append(piece.moved(x - left, top - height / 2 - (bottom + upper) / 2))
            x += right - left + _GAP
        top -= height + _GAP
    scene = Scene().joined(*done)
    left, bottom, _, _ = scene.bounds()
    return scene.moved(-left, -bottom)
