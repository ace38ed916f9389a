"""The layouts `flow` and `group`: one run of dot, neighbours in the outer ranks, at most one frame.

A frame and texts beside arrows go together in dot as long as there is only one frame.
"""

from __future__ import annotations

import math

from archgen.emit.graphviz import engine
from archgen.emit.graphviz.draft import Draft, document, frame, measure, read, title
from archgen.emit.graphviz.engine import written
from archgen.emit.graphviz.labels import declutter, settle_title
from archgen.emit.graphviz.scene import Frame, Part, Scene
from archgen.views.shapes import Box, Cluster


def flow(drafted: Draft) -> Scene:
    """Lay out boxes and labelled arrows in one run, without frames."""
    graph = drafted.graph
    lines = [drafted.node(item) for item in graph.boxes] + _sides(drafted)
    lines += [drafted.edge(at, item) for at, item in enumerate(graph.arrows)]
    scene = read(drafted, engine.layout(document(_settings(drafted, 0.25), lines)))
    return declutter(scene)


def group(drafted: Draft) -> Scene:
    """Lay out one frame in the middle, with the neighbours that feed it at the left, its readers at the right."""
    graph = drafted.graph
    inner = graph.clusters[0]
    inside = [item for item in graph.boxes if item.cluster == inner.id]
    outside = [item for item in graph.boxes if item.cluster != inner.id]
    heading = title(inner)
    lines = [drafted.node(item) for item in outside if item.side != "right"]
    lines.append(f'subgraph cluster_0 {{ graph [margin="14" label={heading["label"]} fontsize="11" fontname={heading["fontname"]}];')
    lines += [*(drafted.node(item) for item in inside), "}"]
    lines += [drafted.node(item) for item in outside if item.side == "right"]
    lines += _sides(drafted) + _held_right(drafted, inside)
    lines += [drafted.edge(at, item) for at, item in enumerate(graph.arrows)]
    layout = engine.layout(document(_settings(drafted, 0.18) + ' newrank="true"', lines))
    return _framed(drafted, inner, read(drafted, layout), layout)


def _settings(drafted: Draft, nodesep: float) -> str:
    crowd = max((sum(item.head == box.id for item in drafted.graph.arrows) for box in drafted.graph.boxes), default=0)
    labels = bool(drafted.labels)
    ranksep = min(0.45 + 0.02 * crowd + 0.01 * len(drafted.graph.arrows), 1.0) if labels else 0.6
    direction = "LR" if drafted.graph.direction == "left-right" else "TB"
    return f'rankdir="{direction}" nodesep="{nodesep}" ranksep="{ranksep:.2f}" remincross="true" mclimit="3"'


def _sides(drafted: Draft) -> list[str]:
    """Hold neighbours in the first and the last rank."""
    ranks = []
    for side, rank in (("left", "source"), ("right", "sink")):
        names = [drafted.names[item.id] for item in drafted.graph.boxes if item.side == side]
        if names:
            ranks.append(f"{{ rank={rank}; {'; '.join(names)}; }}")
    return ranks


def _held_right(drafted: Draft, inside: list[Box]) -> list[str]:
    """Keep the neighbours at the right behind the frame's last rank."""
    right = [item for item in drafted.graph.boxes if item.side == "right"]
    left = [item for item in drafted.graph.boxes if item.side == "left"]
    names = drafted.names
    held = [f'{names[item.id]} -> {names[right[0].id]} [style="invis" weight="0"];' for item in inside if right]
    return held + [f'{names[left[0].id]} -> {names[item.id]} [style="invis" weight="0"];' for item in inside if left]


def _framed(drafted: Draft, inner: Cluster, scene: Scene, layout: dict[str, object]) -> Scene:
    found = next(item for item in layout["objects"] if item["name"] == "cluster_0")  # type: ignore[attr-defined]
    left, bottom, right, top = (float(number) for number in found["bb"].split(","))
    heading = title(inner)
    ((width, height),) = measure([heading])
    x, y = (float(number) for number in found["lp"].split(","))
    rim = Frame("c0", frame(inner, drafted.link), (left, bottom, right, top))
    part = Part("t0", heading, x, y, width, height, kind="title")
    framed = scene.joined(Scene(frames=(rim,), parts=(part,)))
    return declutter(settle_title(framed, part, rim))


def simple(drafted: Draft) -> Scene:
    """Lay out boxes and arrows and nothing else: what is left when everything else failed."""
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
