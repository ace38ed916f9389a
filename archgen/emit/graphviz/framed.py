"""The layout `framed`: one run of dot with frames round the boxes, arrows from box to box.

Frames and labels together break dot (it may crash), so the labels are set on the arrows afterwards: for few boxes only.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from archgen.emit.graphviz import engine
from archgen.emit.graphviz.draft import Draft, document, frame, measure, on_lines, title
from archgen.emit.graphviz.labels import declutter
from archgen.emit.graphviz.scene import Frame, Part, Scene, placed

_PAD = 14
_PAGE = (1000.0, 700.0)
_DIRECTIONS = {"left-right": ("LR", "TB"), "top-bottom": ("TB", "LR")}
"""Directions to try by the one that is asked for, which comes first: it is taken where both are as good."""


def framed(drafted: Draft) -> Scene:
    """Lay out boxes in frames, then place the labels on the arrows. Try two directions and return the better scene."""
    tries = [_laid_out(drafted, direction) for direction in _DIRECTIONS[drafted.graph.direction]]
    # `min` returns the first of equals: the direction that was asked for.
    return min(tries, key=lambda scene: (_lost(drafted, scene), _scale(scene)))


def _lost(drafted: Draft, scene: Scene) -> int:
    """Count the labels that found no place."""
    return len(drafted.labels) - sum(part.kind == "label" for part in scene.parts)


def _scale(scene: Scene) -> float:
    """Return how many times too large a scene is for a page on a screen. All that fit are equally good (1.0)."""
    left, bottom, right, top = scene.bounds()
    return max(1.0, (right - left) / _PAGE[0], (top - bottom) / _PAGE[1])


def _laid_out(drafted: Draft, direction: str) -> Scene:
    graph = drafted.graph
    headings = [title(cluster) for cluster in graph.clusters]
    sizes = measure(headings)
    lines = list(_clusters(drafted, sizes))
    lines += [drafted.node(item) for item in graph.boxes if item.cluster not in _names(drafted)]
    lines += [drafted.edge(at, item, text=False) for at, item in enumerate(graph.arrows)]
    layout = engine.layout(document(_settings(drafted, direction), lines))
    scene = placed(layout, drafted.boxes, drafted.arrows)
    found: Mapping[str, Any] = {item["name"]: item for item in layout.get("objects", [])}
    rims, titles = [], []
    for at, cluster in enumerate(graph.clusters):
        item = found.get(f"cluster_{at}")
        if item is None:
            continue
        left, bottom, right, top = (float(number) for number in item["bb"].split(","))
        width, height = sizes[at]
        rims.append(Frame(f"c{at}", frame(cluster, drafted.link), (left, bottom, right, top)))
        place = left + 6 + width / 2, top - 5 - height / 2
        titles.append(Part(f"t{at}", headings[at], *place, width, height, kind="title"))
    return declutter(on_lines(drafted, scene.joined(Scene(frames=tuple(rims), parts=tuple(titles)))))


def _names(drafted: Draft) -> dict[str | None, int]:
    return {cluster.id: at for at, cluster in enumerate(drafted.graph.clusters)}


def _clusters(drafted: Draft, sizes: tuple[tuple[float, float], ...]) -> Iterator[str]:
    """Yield the frames with their boxes. An empty label as large as the title keeps its place free."""
    for name, at in _names(drafted).items():
        inside = [item for item in drafted.graph.boxes if item.cluster == name]
        width, height = sizes[at]
        room = (
            f'<<TABLE BORDER="0" FIXEDSIZE="TRUE" WIDTH="{width:.0f}" HEIGHT="{height:.0f}"><TR><TD></TD></TR></TABLE>>'
        )
        boxes = " ".join(drafted.node(item) for item in inside)
        yield f'subgraph "cluster_{at}" {{ graph [label={room} labeljust="l" margin="{_PAD}"]; {boxes} }}'


def _settings(drafted: Draft, direction: str) -> str:
    """Return the settings of dot, with room between the ranks for the longest line of a label."""
    longest = max((len(line) for arrow in drafted.graph.arrows for line in arrow.label.split("\n")), default=0)
    ranksep = min(0.5 + 0.065 * longest, 1.8) if direction == "LR" else 0.7
    return f'rankdir="{direction}" nodesep="0.28" ranksep="{ranksep:.2f}" remincross="true" mclimit="3"'
