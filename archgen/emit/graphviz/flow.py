"""The layouts `flow` and `group`: one run of dot, neighbours in the outer ranks, at most one frame."""

from __future__ import annotations

import math

from archgen.emit.graphviz import engine
from archgen.emit.graphviz.draft import Draft, document, frame, measure, on_lines, read, title
from archgen.emit.graphviz.engine import written
from archgen.emit.graphviz.labels import along, declutter
from archgen.emit.graphviz.scene import Frame, Part, Scene
from archgen.views.shapes import Box, Cluster

_MARGIN = 12.0


def flow(drafted: Draft) -> Scene:
    """Lay out boxes and labelled arrows in one run, without frames."""
    graph = drafted.graph
    lines = [drafted.node(item) for item in graph.boxes] + _sides(drafted)
    lines += [drafted.edge(at, item) for at, item in enumerate(graph.arrows)]
    scene = read(drafted, engine.layout(document(_settings(drafted, 0.25), lines)))
    return declutter(on_lines(drafted, scene))


def group(drafted: Draft) -> Scene:
    """Lay out one frame in the middle, with the neighbours that feed it at the left and its readers at the right.

    The frame is drawn round its boxes after the layout. As a cluster of dot's it would keep out every line that has not
    arrived yet: such lines would run round the frame and enter it from above.
    """
    graph = drafted.graph
    inner = graph.clusters[0]
    inside = [item for item in graph.boxes if item.cluster == inner.id]
    lines = [drafted.node(item) for item in graph.boxes] + _sides(drafted) + _held_between(drafted, inside)
    lines += [drafted.edge(at, item) for at, item in enumerate(graph.arrows)]
    scene = read(drafted, engine.layout(document(_settings(drafted, 0.16), lines)))
    framed = _framed(drafted, inner, scene, {drafted.names[item.id] for item in inside})
    return declutter(on_lines(drafted, framed))


def _settings(drafted: Draft, nodesep: float) -> str:
    # The more arrows end at one box, the steeper they get: the ranks move apart, up to one inch.
    crowd = max((sum(item.head == box.id for item in drafted.graph.arrows) for box in drafted.graph.boxes), default=0)
    labels = bool(drafted.labels)
    ranksep = min(0.45 + 0.02 * crowd + 0.01 * len(drafted.graph.arrows), 1.0) if labels else 0.6
    direction = "LR" if drafted.graph.direction == "left-right" else "TB"
    return f'rankdir="{direction}" nodesep="{nodesep}" ranksep="{ranksep:.2f}" remincross="true" mclimit="3"'


def _sides(drafted: Draft) -> list[str]:
    """Return statements that keep neighbours in the first and the last rank."""
    ranks = []
    for side, rank in (("left", "source"), ("right", "sink")):
        names = [drafted.names[item.id] for item in drafted.graph.boxes if item.side == side]
        if names:
            ranks.append(f"{{ rank={rank}; {'; '.join(names)}; }}")
    return ranks


def _held_between(drafted: Draft, inside: list[Box]) -> list[str]:
    """Return invisible edges that keep the neighbours out of the ranks of the frame."""
    names = drafted.names
    left = next((item for item in drafted.graph.boxes if item.side == "left"), None)
    right = next((item for item in drafted.graph.boxes if item.side == "right"), None)
    # One neighbour of each side is enough, since `rank=source` and `rank=sink` hold the others beside it.
    held = [f'{names[item.id]} -> {names[right.id]} [style="invis" weight="0"];' for item in inside if right]
    return held + [f'{names[left.id]} -> {names[item.id]} [style="invis" weight="0"];' for item in inside if left]


def _framed(drafted: Draft, inner: Cluster, scene: Scene, inside: set[str]) -> Scene:
    """Add the frame round its boxes and all lines that pass between them, with the title above."""
    boxes = [part.rectangle for part in scene.parts if part.name in inside]
    heading = title(inner)
    ((width, height),) = measure([heading])
    left, right = min((box[0] for box in boxes), default=0.0), max((box[2] for box in boxes), default=width)
    # A line may swing out above its boxes. Only what is between the frame's sides counts: neighbours are outside.
    within = [y for line in scene.lines for x, y in along(line) if left <= x <= right]
    within += [part.y + side * part.height / 2 for part in scene.parts if left <= part.x <= right for side in (-1, 1)]
    # Neighbours are above and below here, so lines to them would stretch the frame over them.
    if drafted.graph.direction == "top-bottom":
        within = [y for box in boxes for y in (box[1], box[3])]
    bottom, top = min(within, default=0.0) - _MARGIN, max(within, default=0.0) + _MARGIN + height
    spare = max(width + 2 * _MARGIN - (right - left), 2 * _MARGIN) / 2
    rim = Frame("c0", frame(inner, drafted.link), (left - spare, bottom, right + spare, top))
    part = Part("t0", heading, left - spare + 8 + width / 2, top - 5 - height / 2, width, height, kind="title")
    return scene.joined(Scene(frames=(rim,), parts=(part,)))


def simple(drafted: Draft) -> Scene:
    """Lay out boxes and arrows, nothing else: the last resort when the graph's own layout failed or took too long."""
    graph = drafted.graph
    lines = [f"{drafted.names[item.id]} [{written(drafted.boxes[drafted.names[item.id]])}];" for item in graph.boxes]
    ends = set(drafted.names)
    lines += [
        f'{drafted.names[item.tail]} -> {drafted.names[item.head]} [id="e{at}"];'
        for at, item in enumerate(graph.arrows)
        if item.tail in ends and item.head in ends
    ]
    columns = max(1, math.isqrt(len(graph.boxes)))
    pack = f'pack="12" packmode="array_u{columns}" ' if not graph.arrows else ""
    return read(drafted, engine.layout(document(f'{pack}rankdir="LR" nodesep="0.2" ranksep="0.6"', lines)))
