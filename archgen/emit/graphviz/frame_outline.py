"""Draw a frame round boxes that are already placed: as large as what it holds, whatever its neighbours need beside it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from archgen.emit.graphviz.label_places import sample_line
from archgen.emit.graphviz.placed_scene import Scene, SceneFrame, ScenePart
from archgen.emit.graphviz.styled_graph import StyledGraph, frame_attributes, measure_nodes, title_attributes
from archgen.views.graph_shapes import Cluster

_FRAME_MARGIN = 12.0
_RIM_DISTANCE = 24.0
"""How far a line from outside must leave a frame, in points, so as not to run along its rim."""


def draw_frame(styled_graph: StyledGraph, cluster: Cluster, scene: Scene, inside_names: set[str]) -> Scene:
    """Add the frame round its boxes and the lines among them, with the title above."""
    boxes = [title_part.rectangle for title_part in scene.parts if title_part.name in inside_names]
    boxes += [inner_frame.rectangle for inner_frame in scene.frames]
    ports = _list_rim_ports(styled_graph, scene)
    heading = title_attributes(cluster)
    ((width, height),) = measure_nodes([heading])
    left, right = min((box[0] for box in boxes), default=0.0), max((box[2] for box in boxes), default=width)
    # Ports stand on the frame's own line.
    centres = [(box[0] + box[2]) / 2 for box in ports]
    rims = [x for x in centres if x < left], [x for x in centres if x > right]
    left, right = min(rims[0], default=left), max(rims[1], default=right)
    # A line may swing out above its boxes. Only what is between the frame's sides counts: neighbours are outside.
    held_names = inside_names | _name_ports(styled_graph)
    inner_edges = {line.edge for line in scene.lines if {line.tail, line.head} <= held_names}
    heights = [
        y for line in scene.lines if line.edge in inner_edges for x, y in sample_line(line) if left <= x <= right
    ]
    heights += [
        part.y + side * part.height / 2
        for part in scene.parts
        if left <= part.x <= right
        and (part.name in held_names or (part.kind == "label" and part.name[1:] in inner_edges))
        for side in (-1, 1)
    ]
    heights += [y for inner_frame in scene.frames for y in (inner_frame.rectangle[1], inner_frame.rectangle[3])]
    heights += _list_near_heights(scene, inner_edges, heights, (left, right))
    # Neighbours are above and below here, so lines to them would stretch the frame over them.
    if styled_graph.graph.direction == "top-bottom":
        heights = [y for box in boxes for y in (box[1], box[3])]
    bottom, top = min(heights, default=0.0) - _FRAME_MARGIN, max(heights, default=0.0) + _FRAME_MARGIN + height
    spare = max(width + 2 * _FRAME_MARGIN - (right - left), 2 * _FRAME_MARGIN) / 2
    left_side, right_side = left - (0 if rims[0] else spare), right + (0 if rims[1] else spare)
    cluster_frame = SceneFrame(
        "c0", frame_attributes(cluster, styled_graph.resolve_link), (left_side, bottom, right_side, top)
    )
    title_part = ScenePart("t0", heading, left_side + 8 + width / 2, top - 5 - height / 2, width, height, kind="title")
    # Behind the frames inside.
    return replace(scene.joined(Scene(parts=(title_part,))), frames=(cluster_frame, *scene.frames))


def _list_near_heights(
    scene: Scene, inner_edges: set[str], heights: Sequence[float], sides: tuple[float, float]
) -> list[float]:
    """Return the heights of lines from outside that leave the frame by little: they would run along its rim.

    Others cross the rim. A frame that held them all was empty for the most part where a few boxes have many neighbours.
    """
    left, right = sides
    near_heights: list[float] = []
    for sign in (1, -1):
        rim = max((sign * y for y in heights), default=0.0)
        reaches = [
            max((sign * y for x, y in sample_line(line) if left <= x <= right), default=rim)
            for line in scene.lines
            if line.edge not in inner_edges
        ]
        for reach in sorted(reaches):
            if rim < reach <= rim + _RIM_DISTANCE:
                rim = reach
        near_heights.append(sign * rim)
    return near_heights


def _name_ports(styled_graph: StyledGraph) -> set[str]:
    return {styled_graph.dot_names[box.id] for box in styled_graph.graph.boxes if box.style == "port"}


def _list_rim_ports(styled_graph: StyledGraph, scene: Scene) -> list[tuple[float, float, float, float]]:
    """Return the rectangles of the ports at the rim of the frame; none where the flow runs down: they stand outside."""
    if styled_graph.graph.direction == "top-bottom":
        return []
    names = _name_ports(styled_graph)
    return [part.rectangle for part in scene.parts if part.name in names]
