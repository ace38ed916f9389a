"""Columns of neighbours that would be taller than a page: the titles in them are not wrapped, which takes a third of the height."""

from __future__ import annotations

import math

from archgen.emit.graphviz.box_styles import style_box
from archgen.emit.graphviz.placed_scene import DotAttributes
from archgen.emit.graphviz.styled_graph import StyledGraph, measure_nodes
from archgen.frozen import replace

_TALLEST = 600.0
"""The tallest column of neighbours whose titles are wrapped, in points: about a page with its heading and caption."""
_BOX_GAP = 11.5
"""How far apart the boxes of a column are, in points."""
_TITLE_WIDTH = 30
"""How many characters of a title stand in a line where it is not wrapped for a narrow column."""


def unwrap_tall_columns(styled_graph: StyledGraph) -> StyledGraph:
    """Return a graph with the titles of neighbours in one line where they make a column taller than a page."""
    new_attributes: dict[str, DotAttributes] = {}
    for side in ("left", "right"):
        boxes = [box for box in styled_graph.graph.boxes if box.side == side and box.style != "port"]
        names = [styled_graph.dot_names[box.id] for box in boxes]
        sizes = measure_nodes([styled_graph.box_attributes[name] for name in names])
        # From Python 3.12 on `sum` rounds floats otherwise than before: a picture would depend on the version.
        if math.fsum(height + _BOX_GAP for _, height in sizes) > _TALLEST:
            new_attributes |= {
                name: style_box(box, styled_graph.resolve_link, _TITLE_WIDTH)
                for name, box in zip(names, boxes, strict=True)
            }
    if not new_attributes:
        return styled_graph
    return replace(styled_graph, box_attributes=styled_graph.box_attributes | new_attributes)
