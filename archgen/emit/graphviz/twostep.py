"""The layouts `two-step` and `overview`: frames as boxes of fixed size in an outer graph, with their insides set into
them.

No graph that dot gets has frames and labels at once: it cannot lay these out. The outer graph is tried in several ways:
as dot likes it, downwards and to the right, and folded into two to seven rows or columns in the order in which least
flows backwards. The scene that reads best on a page is taken: large text, few crossings, short arrows. On an
architecture of RAMCIP's shape (61 components, 138 connections) one run of dot with clusters gave about 340 crossings,
two steps, with merged arrows, 3.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

from archgen.emit.graphviz import engine
from archgen.emit.graphviz.crossings import crossings, length
from archgen.emit.graphviz.draft import Draft, document, frame, measure, on_lines, title
from archgen.emit.graphviz.engine import written
from archgen.emit.graphviz.inner import inside
from archgen.emit.graphviz.labels import declutter
from archgen.emit.graphviz.order import Rows, folds, forward
from archgen.emit.graphviz.scene import Frame, Line, Part, Scene, placed
from archgen.views.shapes import Arrow

_PAGE = (1105.0, 728.0)
"""A landscape A3 page without its margins, in points: the text size of a scene is judged on it."""
_TURNED = 1.2
_MARGIN = 12.0
_UNSEEN = {"style": '"invis"', "label": '""', "shape": '"point"'}
"""Attributes of the ends of arrows between frames: lines need nodes to end at."""


@dataclass(frozen=True, slots=True)
class Tile:
    """What the outer graph places: a frame with its inside, or a box without a frame. The lower left corner is 0, 0."""

    name: str
    scene: Scene
    width: float
    height: float


def two_step(drafted: Draft) -> Scene:
    """Lay out each frame by itself, then the frames."""
    home = _homes(drafted)
    numbered = list(enumerate(drafted.graph.arrows))
    outer = [(at, arrow) for at, arrow in numbered if home[arrow.tail] != home[arrow.head]]
    inner = [(at, arrow) for at, arrow in numbered if home[arrow.tail] == home[arrow.head]]
    tiles = {tile.name: tile for tile in _tiles(drafted, home, inner)}
    # The arrows keep their numbers in the graph: ids of lines, labels and attributes are looked up by them.
    ends = [(at, replace(arrow, tail=home[arrow.tail], head=home[arrow.head])) for at, arrow in outer]
    order = forward(tuple(tiles), _weights(ends))
    tiles = {name: tiles[name] for name in order}  # dot breaks circles in the order in which it meets boxes
    tries = [_composed(drafted, tiles, ends, statements) for statements in _candidates(drafted, tiles, ends)]
    return declutter(on_lines(drafted, _best(tries, ends)))


def _weights(arrows: Sequence[tuple[int, Arrow]]) -> dict[tuple[str, str], int]:
    weights: dict[tuple[str, str], int] = {}
    for _, arrow in arrows:
        weights[arrow.tail, arrow.head] = weights.get((arrow.tail, arrow.head), 0) + arrow.count
    return weights


def _homes(drafted: Draft) -> dict[str, str]:
    """Map each box and frame to the outermost frame that it is in, else to itself."""
    parents = {cluster.id: cluster.parent for cluster in drafted.graph.clusters}

    def top(name: str) -> str:
        while parents.get(name):
            name = str(parents[name])
        return name

    homes = {cluster.id: top(cluster.id) for cluster in drafted.graph.clusters}
    return {**homes, **{box.id: top(box.cluster) if box.cluster else box.id for box in drafted.graph.boxes}}


def _tiles(drafted: Draft, home: dict[str, str], arrows: Sequence[tuple[int, Arrow]]) -> Iterator[Tile]:
    graph = drafted.graph
    headings = [title(cluster) for cluster in graph.clusters]
    sizes = measure(headings)
    for at, cluster in enumerate(graph.clusters):
        scene = inside(drafted, [box for box in graph.boxes if home[box.id] == cluster.id], arrows)
        _, _, right, top = scene.bounds()
        heading, (width, height) = headings[at], sizes[at]
        wide, high = max(right, width) + 2 * _MARGIN, top + height + 2.2 * _MARGIN
        text = Part(f"t{at}", heading, _MARGIN + width / 2, high - 7 - height / 2, width, height, "title")
        rim = Frame(f"c{at}", frame(cluster, drafted.link), (0, 0, wide, high))
        filled = scene.moved((wide - right) / 2, _MARGIN)
        yield Tile(cluster.id, filled.joined(Scene(frames=(rim,), parts=(text,))), wide, high)
    for box in graph.boxes:
        if home[box.id] == box.id:
            scene = inside(drafted, [box], ())
            _, _, right, top = scene.bounds()
            yield Tile(box.id, scene, right, top)


def _candidates(
    drafted: Draft, tiles: dict[str, Tile], arrows: Sequence[tuple[int, Arrow]]
) -> Iterator[tuple[str, list[str]]]:
    """Yield the ways to lay out the outer graph that are worth a try: settings and statements."""
    place = {name: at for at, name in enumerate(tiles)}
    names = {name: f"o{at}" for at, name in enumerate(tiles)}
    plain = [f'{names[a.tail]} -> {names[a.head]} [id="e{at}" {_pen(drafted, at)}];' for at, a in arrows]
    onward = [
        f'{names[a.tail]} -> {names[a.head]} [id="e{at}" {_pen(drafted, at)}'
        # An arrow against the order must not push its target behind its source, or the rows would not hold.
        f"{' constraint=false' if place[a.tail] > place[a.head] else ''}];"
        for at, a in arrows
    ]
    lines = max((item.label.count("\n") + 1 for _, item in arrows if item.label), default=0)
    # Labels beside vertical arrows need height for their lines, beside horizontal ones width for their longest words.
    for direction in ("TB", "LR"):
        ranksep = 0.5 + 0.16 * lines if direction == "TB" else 0.5 + 0.9 * bool(lines)
        settings = f'rankdir="{direction}" nodesep="0.35" ranksep="{ranksep:.2f}" splines="spline"'
        yield settings, plain
        yield settings, onward
        sizes = {name: (each.width, each.height)[:: 1 if direction == "TB" else -1] for name, each in tiles.items()}
        ends = [(item.tail, item.head) for _, item in arrows]
        for rows in folds(tuple(tiles), partial(_guess, sizes, ends, direction)):
            yield settings, [*_rows(rows, names), *onward]


def _guess(sizes: dict[str, tuple[float, ...]], ends: Sequence[tuple[str, str]], direction: str, rows: Rows) -> float:
    """Estimate the cost of rows before they are laid out: how large it gets, and how many arrows must pass a box.

    `sizes` are along and across the rows.
    """
    along_rows = max(sum(sizes[item][0] + 30 for item in row) for row in rows)
    across = sum(max(sizes[item][1] for item in row) + 40 for row in rows)
    wide, high = (along_rows, across) if direction == "TB" else (across, along_rows)
    place = {item: (at, to) for at, row in enumerate(rows) for to, item in enumerate(row)}
    passing = 0
    for tail, head in ends:
        (row, column), (other, to) = place[tail], place[head]
        passing += max(abs(column - to) - 1, 0) if row == other else abs(row - other) - 1
    return _scale(wide, high) * (1 + 0.05 * passing)


def _scale(width: float, height: float) -> float:
    """Return how many times too large a scene is for a page. The page may be turned; screens like it wide."""
    return min(max(width / _PAGE[0], height / _PAGE[1]), _TURNED * max(width / _PAGE[1], height / _PAGE[0]))


def _rows(runs: Sequence[Sequence[str]], names: dict[str, str]) -> list[str]:
    ranks = [f"{{ rank=same; {'; '.join(names[item] for item in run)}; }}" for run in runs]
    # One invisible edge through the first of each row puts the rows in order.
    chain = " -> ".join(names[run[0]] for run in runs)
    return [*ranks, f'{chain} [style="invis" weight="0"];'] if len(runs) > 1 else ranks


def _pen(drafted: Draft, at: int) -> str:
    attributes = drafted.arrows[f"e{at}"][1]
    return written({name: attributes[name] for name in ("arrowsize", "penwidth", "arrowhead") if name in attributes})


def _composed(
    drafted: Draft, tiles: dict[str, Tile], arrows: Sequence[tuple[int, Arrow]], candidate: tuple[str, list[str]]
) -> Scene:
    """Lay out the outer graph and set the insides into its boxes."""
    settings, statements = candidate
    names = {f"o{at}": tile for at, tile in enumerate(tiles.values())}
    boxes = {
        name: {
            "shape": '"box"',
            "fixedsize": '"true"',
            "label": '""',
            "width": f"{tile.width / 72:.4f}",
            "height": f"{tile.height / 72:.4f}",
        }
        for name, tile in names.items()
    }
    nodes = [f"{name} [{written(each)}];" for name, each in boxes.items()]
    wanted = {f"e{at}": drafted.arrows[f"e{at}"] for at, _ in arrows}
    outer = placed(engine.layout(document(settings, [*nodes, *statements])), boxes, wanted)
    scenes = [names[part.name].scene.moved(part.x - part.width / 2, part.y - part.height / 2) for part in outer.parts]
    anchors = tuple(replace(part, attributes=_UNSEEN, kind="mark") for part in outer.parts)
    return Scene(lines=outer.lines, parts=anchors).joined(*scenes)


def _best(scenes: Sequence[Scene], arrows: Sequence[tuple[int, Arrow]]) -> Scene:
    """Return the scene that reads best. Crossings are expensive to count: only where they can still decide."""
    edges = {f"{at}" for at, _ in arrows}
    outer = [[line for line in scene.lines if line.edge in edges] for scene in scenes]
    costs = [_cost(scene, lines, arrows) for scene, lines in zip(scenes, outer, strict=True)]
    best, least = scenes[0], math.inf
    # From the cheapest on: once a scene's cost without crossings reaches the best total, no later one can win.
    for at in sorted(range(len(scenes)), key=lambda each: costs[each]):
        if costs[at] >= least:
            break
        left, bottom, right, top = scenes[at].bounds()
        cost = costs[at] + 0.02 * _scale(right - left, top - bottom) * crossings(outer[at])
        if cost < least:
            best, least = scenes[at], cost
    return best


def _cost(scene: Scene, outer: Sequence[Line], arrows: Sequence[tuple[int, Arrow]]) -> float:
    """Return the cost of a scene without crossings: how small it gets on the page, how far arrows run, how many run
    back.
    """
    left, bottom, right, top = scene.bounds()
    run = sum(length(line) for line in outer) / (sum(_PAGE) * max(len(outer), 1))
    missing = len(arrows) - len(outer)
    return _scale(right - left, top - bottom) * (1 + 0.5 * run + 0.6 * _backward(scene, arrows)) + 10 * missing


def _backward(scene: Scene, arrows: Sequence[tuple[int, Arrow]]) -> float:
    """Return the share of flows that run upwards and to the left, against the direction of reading."""
    ends = {line.edge: (line.curve[0], line.curve[-1]) for line in scene.lines if line.curve}
    total = sum(arrow.count for _, arrow in arrows) or 1
    back = 0
    for at, arrow in arrows:
        (x, y), (to_x, to_y) = ends.get(str(at), ((0.0, 0.0), (0.0, 0.0)))
        back += arrow.count * ((to_x - x) + (y - to_y) < 0)
    return back / total
