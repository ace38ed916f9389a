"""The layouts `flow` and `group`: one run of dot, neighbours in the outer ranks, at most one frame."""

from __future__ import annotations

import math
from collections.abc import Sequence

from archgen.emit.graphviz import layout_engine
from archgen.emit.graphviz.box_styles import style_box
from archgen.emit.graphviz.framed_layout import find_rank_distance, read_frames, write_frames
from archgen.emit.graphviz.group_order import WrappedRanks, route_between_rows, wrap_ranks
from archgen.emit.graphviz.label_places import clear_titles, declutter_labels, sample_line
from archgen.emit.graphviz.placed_scene import (
    DotAttributes,
    Scene,
    SceneFrame,
    ScenePart,
    format_attributes,
    read_scene,
)
from archgen.emit.graphviz.styled_graph import (
    StyledGraph,
    frame_attributes,
    measure_nodes,
    place_labels_on_lines,
    read_layout,
    title_attributes,
    write_dot,
)
from archgen.frozen import replace
from archgen.views.picture_shapes import Box, Cluster

_WIDEST_FRAME = 800.0
"""The widest frame whose boxes are not wrapped, in points: about a landscape page."""
_FEW_RANKS = 2
"""With no more ranks of boxes in the frame a picture has room for wider neighbours."""
_RANK_WIDTH = 150.0
"""About the width of a rank of boxes with the space beside it, in points."""


def lay_out_flow(styled_graph: StyledGraph) -> Scene:
    """Lay out boxes and labelled arrows in one run, without frames."""
    graph = styled_graph.graph
    statements = [styled_graph.write_node(item) for item in graph.boxes] + _rank_statements(styled_graph)
    statements += [styled_graph.write_edge(at, item) for at, item in enumerate(graph.arrows)]
    scene = read_layout(
        styled_graph, layout_engine.lay_out_dot(write_dot(_layout_settings(styled_graph, 0.25), statements))
    )
    return declutter_labels(place_labels_on_lines(styled_graph, scene))


def lay_out_group(styled_graph: StyledGraph) -> Scene:
    """Lay out one frame in the middle, with the neighbours that feed it at the left and its readers at the right.

    The frame is drawn round its boxes after the layout. As a cluster of dot's it would keep out every line that has not
    arrived yet: such lines would run round the frame and enter it from above.
    """
    graph = styled_graph.graph
    cluster = graph.clusters[0]
    frame_ids = {each.id for each in graph.clusters}
    inside_boxes = [item for item in graph.boxes if item.cluster in frame_ids]
    inside_names = {styled_graph.dot_names[item.id] for item in inside_boxes}

    def finish(scene: Scene) -> Scene:
        framed_scene = draw_frame(styled_graph, cluster, scene, inside_names)
        return declutter_labels(place_labels_on_lines(styled_graph, clear_titles(framed_scene)))

    if len(graph.clusters) > 1:
        return finish(_lay_out_inner_frames(styled_graph))
    # dot takes longest for lines, and those of a layout that is going to be wrapped are thrown away.
    rank_count = _count_ranks(styled_graph, inside_boxes)
    looks_wide = rank_count * _RANK_WIDTH > _WIDEST_FRAME
    if rank_count <= _FEW_RANKS and graph.direction != "top-bottom":
        styled_graph = unwrap_tall_columns(styled_graph)
    scene = _lay_out_framed_boxes(styled_graph, splines="none" if looks_wide else "spline")
    wrapped_scene = None
    if graph.direction != "top-bottom" and (wrapped := _wrap_wide_frame(scene, inside_names)):
        rows = _lay_out_framed_boxes(styled_graph, wrapped)
        wrapped_scene = finish(route_between_rows(rows, wrapped))
        labels = sum(part.kind == "label" for part in wrapped_scene.parts)
        if len(wrapped_scene.lines) == len(styled_graph.graph.arrows) and labels == len(styled_graph.label_attributes):
            return wrapped_scene
    finished_scene = finish(_lay_out_framed_boxes(styled_graph) if looks_wide else scene)
    # dot loses a line now and then where many run back, and a label may find no place.
    if wrapped_scene and _count_contents(wrapped_scene) >= _count_contents(finished_scene):
        return wrapped_scene
    return finished_scene


def _count_ranks(styled_graph: StyledGraph, boxes: Sequence[Box]) -> int:
    """Return about how many ranks dot makes of some boxes: the length of the longest way through them, too long where
    they feed each other in a circle.
    """
    ranks = {box.id: 1 for box in boxes}
    inner_arrows = [arrow for arrow in styled_graph.graph.arrows if arrow.tail in ranks and arrow.head in ranks]
    for _ in boxes:
        for arrow in inner_arrows:
            if arrow.tail != arrow.head:
                ranks[arrow.head] = max(ranks[arrow.head], min(ranks[arrow.tail] + 1, len(boxes)))
    return max(ranks.values(), default=0)


def _count_contents(scene: Scene) -> tuple[int, int]:
    return len(scene.lines), len(scene.parts)


def _lay_out_framed_boxes(
    styled_graph: StyledGraph,
    wrapped: WrappedRanks | None = None,
    *,
    splines: str = "spline",
) -> Scene:
    """Lay out the boxes of a frame and their neighbours, the former in these rows."""
    graph, names = styled_graph.graph, styled_graph.dot_names
    statements = [styled_graph.write_node(item) for item in graph.boxes] + _rank_statements(styled_graph)
    statements += _hold_ports(styled_graph)
    statements += [*wrapped.write_statements(), *_join_neighbours(styled_graph, wrapped)] if wrapped else []
    statements += [
        styled_graph.write_edge(
            at, item, is_free=wrapped is not None and wrapped.leaves_row(names[item.tail], names[item.head])
        )
        for at, item in enumerate(graph.arrows)
    ]
    settings = f'{_layout_settings(styled_graph, 0.12)} splines="{splines}"'
    return read_layout(styled_graph, layout_engine.lay_out_dot(write_dot(settings, statements)))


def _lay_out_inner_frames(styled_graph: StyledGraph) -> Scene:
    """Lay out boxes and their neighbours with frames inside of the frame. Labels come later: dot cannot have both."""
    graph = styled_graph.graph
    outer = graph.clusters[0].id
    inner_frames = [cluster for cluster in graph.clusters if cluster.id != outer]
    inner_ids = {cluster.id for cluster in inner_frames}
    statements = [*write_frames(styled_graph, outer)]
    statements += [styled_graph.write_node(box) for box in graph.boxes if box.cluster not in inner_ids]
    statements += [*_rank_statements(styled_graph), *_hold_ports(styled_graph)]
    statements += [styled_graph.write_edge(at, arrow, with_text=False) for at, arrow in enumerate(graph.arrows)]
    # Labels take width: between ranks where the flow runs to the right, between boxes where it runs down.
    gaps = (0.6, 0.7) if graph.direction == "top-bottom" else (0.2, find_rank_distance(graph))
    direction = "TB" if graph.direction == "top-bottom" else "LR"
    settings = f'rankdir="{direction}" nodesep="{gaps[0]}" ranksep="{gaps[1]:.2f}" remincross="true" mclimit="3"'
    layout = layout_engine.lay_out_dot(write_dot(settings, statements))
    scene = read_scene(layout, styled_graph.box_attributes, styled_graph.arrow_attributes)
    return scene.joined(read_frames(styled_graph, layout, inner_frames))


def _hold_ports(styled_graph: StyledGraph) -> list[str]:
    """Return invisible edges that keep the ports of a frame beside its boxes: neighbours stand farther out.

    Only pictures of composed components have ports; in others these edges cost three times the time.
    """
    names, boxes = styled_graph.dot_names, styled_graph.graph.boxes
    inside = [names[box.id] for box in boxes if box.cluster]
    ports = {box.side: names[box.id] for box in reversed(boxes) if box.side and box.style == "port"}
    pairs = [(ports["left"], name) for name in inside if "left" in ports]
    pairs += [(name, ports["right"]) for name in inside if "right" in ports]
    return [f'{tail} -> {head} [style="invis" weight="0"];' for tail, head in pairs]


def _join_neighbours(styled_graph: StyledGraph, wrapped: WrappedRanks) -> list[str]:
    """Return invisible edges from a neighbour at the left to the first column, and from the last to one at the right.

    `rank=source` and `rank=sink` hold the neighbours outside, but in parts that nothing joins dot broke down in 4 of
    1,200 random groups. From and to every box the edges cost three times the time, and all lines ran round them.
    """
    # Ports first: they are nearer to the frame than the neighbours.
    outside = sorted(styled_graph.graph.boxes, key=lambda box: box.style != "port")
    ends = {box.side: styled_graph.dot_names[box.id] for box in reversed(outside) if box.side}
    first, last = (next(name for row in wrapped.columns[at] for name in row) for at in (0, -1))
    pairs = [(ends[side], first) if side == "left" else (last, ends[side]) for side in sorted(ends)]
    return [f'{tail} -> {head} [style="invis" weight="0"];' for tail, head in pairs]


def _wrap_wide_frame(scene: Scene, inside_names: set[str]) -> WrappedRanks | None:
    """Wrap the boxes of a frame that is wider than a page, and wider than high."""
    boxes = [part.rectangle for part in scene.parts if part.name in inside_names]
    width, height = (
        (max(box[at + 2] for box in boxes) - min(box[at] for box in boxes) for at in (0, 1)) if boxes else (0, 0)
    )
    row_count = math.ceil(width / _WIDEST_FRAME) if width > _WIDEST_FRAME and width > height else 1
    return wrap_ranks(scene, sorted(inside_names), row_count)


def _layout_settings(styled_graph: StyledGraph, nodesep: float) -> str:
    # The more arrows end at one box, the steeper they get: the ranks move apart, up to one inch.
    most_arrows_in = max(
        (sum(item.head == box.id for item in styled_graph.graph.arrows) for box in styled_graph.graph.boxes), default=0
    )
    labels = bool(styled_graph.label_attributes)
    ranksep = min(0.45 + 0.02 * most_arrows_in + 0.01 * len(styled_graph.graph.arrows), 1.0) if labels else 0.6
    direction = "TB" if styled_graph.graph.direction == "top-bottom" else "LR"
    return f'rankdir="{direction}" nodesep="{nodesep}" ranksep="{ranksep:.2f}" remincross="true" mclimit="3"'


def _rank_statements(styled_graph: StyledGraph) -> list[str]:
    """Return statements that keep neighbours in the first and the last rank."""
    ranks = []
    for side, rank in (("left", "source"), ("right", "sink")):
        outside = [item for item in styled_graph.graph.boxes if item.side == side]
        names = [styled_graph.dot_names[item.id] for item in outside if item.style != "port"]
        ports = [styled_graph.dot_names[item.id] for item in outside if item.style == "port"]
        if names and ports:
            # Ports stand on the frame's line, neighbours farther out.
            ends = (names[0], ports[0]) if side == "left" else (ports[0], names[0])
            ranks += [f"{{ rank=same; {'; '.join(ports)}; }}", f'{" -> ".join(ends)} [style="invis" weight="0"];']
        if names or ports:
            ranks.append(f"{{ rank={rank}; {'; '.join(names or ports)}; }}")
    return ranks


def lay_out_simply(styled_graph: StyledGraph) -> Scene:
    """Lay out boxes and arrows, nothing else: the last resort when the graph's own layout failed or took too long."""
    graph = styled_graph.graph
    statements = [
        f"{styled_graph.dot_names[item.id]} [{format_attributes(styled_graph.box_attributes[styled_graph.dot_names[item.id]])}];"
        for item in graph.boxes
    ]
    box_ids = set(styled_graph.dot_names)
    statements += [
        f'{styled_graph.dot_names[item.tail]} -> {styled_graph.dot_names[item.head]} [id="e{at}"];'
        for at, item in enumerate(graph.arrows)
        if item.tail in box_ids and item.head in box_ids
    ]
    columns = max(1, math.isqrt(len(graph.boxes)))
    pack = f'pack="12" packmode="array_u{columns}" ' if not graph.arrows else ""
    return read_layout(
        styled_graph,
        layout_engine.lay_out_dot(write_dot(f'{pack}rankdir="LR" nodesep="0.2" ranksep="0.6"', statements)),
    )


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
