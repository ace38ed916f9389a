"""The layout `two-step`: frames as boxes of fixed size in an outer graph, with their insides set into them.

No graph that dot gets has frames and labels at once: it cannot lay these out. The outer graph is tried in several ways:
as dot likes it, downwards and to the right (one of them, where the project says which), and folded into rows or columns
in the order in which least flows backwards. The scene that reads best on a page is taken: large text, few crossings, short arrows. On an
architecture of RAMCIP's shape (61 components, 138 connections) one run of dot with clusters gave about 340 crossings,
two steps, with merged arrows, 3.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache, partial

from archgen.cache.layout_memory import NO_MEMORY, LayoutMemory
from archgen.emit.graphviz import layout_engine
from archgen.emit.graphviz.group_order import GroupRows, fold_order, order_forward, route_between_rows, wrap_ranks
from archgen.emit.graphviz.label_places import count_crossings, declutter_labels, line_length
from archgen.emit.graphviz.placed_scene import Scene, SceneFrame, SceneLine, ScenePart, format_attributes, read_scene
from archgen.emit.graphviz.styled_graph import (
    StyledGraph,
    frame_attributes,
    measure_nodes,
    place_labels_on_lines,
    read_layout,
    title_attributes,
    write_dot,
)
from archgen.frozen import dataclass, replace
from archgen.model.graph_search import find_strong_components
from archgen.views.picture_shapes import Arrow, Box

_PAGE_SIZE = (1105.0, 728.0)
"""A landscape A3 page without its margins, in points: the text size of a scene is judged on it."""
_DIRECTIONS = {None: ("TB", "LR"), "left-right": ("LR",), "top-bottom": ("TB",)}
"""Directions to try by the one that the project asks for."""
_TURNED_PENALTY = 1.2
_TILE_MARGIN = 12.0
LayoutCandidate = tuple[str, Sequence[str]]
"""A way to lay out a graph: settings and statements in DOT."""
RowMeasure = Callable[[tuple[str, ...]], tuple[float, float]]
_INVISIBLE_NODE = {"style": '"invis"', "label": '""', "shape": '"point"'}
"""Attributes of the ends of arrows between frames: lines need nodes to end at."""


@dataclass(frozen=True, slots=True)
class LayoutTile:
    """What the outer graph places: a frame with its inside, or a box without a frame. The lower left corner is 0, 0."""

    name: str
    scene: Scene
    width: float
    height: float


def lay_out_two_step(styled_graph: StyledGraph, memory: LayoutMemory = NO_MEMORY) -> Scene:
    """Lay out each frame by itself, then the frames."""
    home_frames = _find_home_frames(styled_graph)
    numbered_arrows = list(enumerate(styled_graph.graph.arrows))
    outer_arrows = [(at, arrow) for at, arrow in numbered_arrows if home_frames[arrow.tail] != home_frames[arrow.head]]
    inner_arrows = [(at, arrow) for at, arrow in numbered_arrows if home_frames[arrow.tail] == home_frames[arrow.head]]
    tiles = {tile.name: tile for tile in _make_tiles(styled_graph, home_frames, inner_arrows)}
    # The arrows keep their numbers in the graph: ids of lines, labels and attributes are looked up by them.
    frame_arrows = [
        (at, replace(arrow, tail=home_frames[arrow.tail], head=home_frames[arrow.head])) for at, arrow in outer_arrows
    ]
    order = order_forward(tuple(tiles), _sum_weights(frame_arrows))
    tiles = {name: tiles[name] for name in order}  # dot breaks circles in the order in which it meets boxes
    scene = _fill_tiles(_lay_out_best(styled_graph, tiles, frame_arrows, memory), tiles)
    return declutter_labels(place_labels_on_lines(styled_graph, scene))


def _lay_out_best(
    styled_graph: StyledGraph,
    tiles: dict[str, LayoutTile],
    arrows: Sequence[tuple[int, Arrow]],
    memory: LayoutMemory,
) -> Scene:
    """Try all layouts of the outer graph, unless memory tells which one is the best."""
    problem = _describe_problem(styled_graph, tiles, arrows)
    match memory.recall_choice(problem):
        case [str(settings), [*statements]]:
            return _lay_out_tiles(styled_graph, tiles, arrows, (settings, [str(each) for each in statements]))
    candidates = list(_candidate_layouts(styled_graph, tiles, arrows))
    scenes = [_lay_out_tiles(styled_graph, tiles, arrows, each) for each in candidates]
    best = _find_best_scene(scenes, arrows)
    memory.keep_choice(problem, candidates[best])
    return scenes[best]


def _describe_problem(
    styled_graph: StyledGraph, tiles: dict[str, LayoutTile], arrows: Sequence[tuple[int, Arrow]]
) -> str:
    """Describe all that decides how the outer graph is laid out: no words, but for how many lines they take."""
    positions = {name: at for at, name in enumerate(tiles)}
    sizes = [(tile.width, tile.height) for tile in tiles.values()]
    ends = [
        (at, positions[arrow.tail], positions[arrow.head], arrow.count, _count_label_lines(arrow))
        for at, arrow in arrows
    ]
    lines = [_line_attributes(styled_graph, at) for at, _ in arrows]
    return repr((styled_graph.graph.direction, sizes, ends, lines))


def _count_label_lines(arrow: Arrow) -> int:
    return arrow.label.count("\n") + 1 if arrow.label else 0


def _sum_weights(arrows: Sequence[tuple[int, Arrow]]) -> dict[tuple[str, str], int]:
    weights: dict[tuple[str, str], int] = {}
    for _, arrow in arrows:
        weights[arrow.tail, arrow.head] = weights.get((arrow.tail, arrow.head), 0) + arrow.count
    return weights


def _find_home_frames(styled_graph: StyledGraph) -> dict[str, str]:
    """Map each box and frame to the outermost frame that it is in, else to itself."""
    parents = {cluster.id: cluster.parent for cluster in styled_graph.graph.clusters}

    def outermost_frame(frame_id: str) -> str:
        while parents.get(frame_id):
            frame_id = str(parents[frame_id])
        return frame_id

    home_frames = {cluster.id: outermost_frame(cluster.id) for cluster in styled_graph.graph.clusters}
    return {
        **home_frames,
        **{box.id: outermost_frame(box.cluster) if box.cluster else box.id for box in styled_graph.graph.boxes},
    }


def _make_tiles(
    styled_graph: StyledGraph, home_frames: dict[str, str], arrows: Sequence[tuple[int, Arrow]]
) -> Iterator[LayoutTile]:
    graph = styled_graph.graph
    headings = [title_attributes(cluster) for cluster in graph.clusters]
    sizes = measure_nodes(headings)
    # All boxes in one call of Graphviz: what follows asks for them one by one, and the sizes are kept.
    measure_nodes(list(styled_graph.box_attributes.values()))
    for at, cluster in enumerate(graph.clusters):
        scene = lay_out_inside(styled_graph, [box for box in graph.boxes if home_frames[box.id] == cluster.id], arrows)
        _, _, right, top = scene.bounds()
        heading, (width, height) = headings[at], sizes[at]
        wide, high = max(right, width) + 2 * _TILE_MARGIN, top + height + 2.2 * _TILE_MARGIN
        title_part = ScenePart(
            f"t{at}", heading, _TILE_MARGIN + width / 2, high - 7 - height / 2, width, height, "title"
        )
        tile_frame = SceneFrame(f"c{at}", frame_attributes(cluster, styled_graph.resolve_link), (0, 0, wide, high))
        contents = scene.moved((wide - right) / 2, _TILE_MARGIN)
        yield LayoutTile(cluster.id, contents.joined(Scene(frames=(tile_frame,), parts=(title_part,))), wide, high)
    for box in graph.boxes:
        if home_frames[box.id] == box.id:
            scene = lay_out_inside(styled_graph, [box], ())
            _, _, right, top = scene.bounds()
            yield LayoutTile(box.id, scene, right, top)


def _candidate_layouts(
    styled_graph: StyledGraph, tiles: dict[str, LayoutTile], arrows: Sequence[tuple[int, Arrow]]
) -> Iterator[LayoutCandidate]:
    """Yield the ways to lay out the outer graph that are worth a try: settings and statements."""
    positions = {name: at for at, name in enumerate(tiles)}
    names = {name: f"o{at}" for at, name in enumerate(tiles)}
    plain_edges = [
        f'{names[a.tail]} -> {names[a.head]} [id="e{at}" {_line_attributes(styled_graph, at)}];' for at, a in arrows
    ]
    forward_edges = [
        f'{names[a.tail]} -> {names[a.head]} [id="e{at}" {_line_attributes(styled_graph, at)}'
        # An arrow against the order must not push its target behind its source, or the rows would not hold.
        f"{' constraint=false' if positions[a.tail] > positions[a.head] else ''}];"
        for at, a in arrows
    ]
    label_lines = max((_count_label_lines(item) for _, item in arrows), default=0)
    # Labels beside vertical arrows need height for their lines, beside horizontal ones width for their longest words.
    for direction in _DIRECTIONS[styled_graph.graph.direction]:
        ranksep = 0.5 + 0.16 * label_lines if direction == "TB" else 0.5 + 0.9 * bool(label_lines)
        # Two boxes side by side in a row need room for the words of the arrow between them, too.
        nodesep = 0.35 + (0.75 * bool(label_lines) if direction == "TB" else 0.16 * label_lines)
        settings = f'rankdir="{direction}" nodesep="{nodesep:.2f}" ranksep="{ranksep:.2f}" splines="spline"'
        yield settings, plain_edges
        yield settings, forward_edges
        sizes = {name: (each.width, each.height)[:: 1 if direction == "TB" else -1] for name, each in tiles.items()}
        ends = [(item.tail, item.head) for _, item in arrows]
        for rows in fold_order(tuple(tiles), partial(_estimate_cost, _measure_rows(sizes), ends, direction)):
            yield settings, [*_row_statements(rows, names), *forward_edges]


def _measure_rows(sizes: Mapping[str, tuple[float, ...]]) -> RowMeasure:
    """Return the function that measures a row, along it and across. Many ways of cutting an order share their rows."""

    @cache
    def measure_row(row: tuple[str, ...]) -> tuple[float, float]:
        return math.fsum([sizes[item][0] + 30 for item in row]), max([sizes[item][1] for item in row]) + 40

    return measure_row


def _estimate_cost(
    measure_row: RowMeasure, ends: Sequence[tuple[str, str]], direction: str, rows: GroupRows, limit: float
) -> float:
    """Estimate the cost of rows before they are laid out: how large it gets, and how many arrows must pass a box.

    What costs the limit or more need not be exact.
    """
    row_sizes = [measure_row(row) for row in rows]
    along_rows = max([along for along, _ in row_sizes])
    across = math.fsum([size for _, size in row_sizes])
    total_width, total_height = (along_rows, across) if direction == "TB" else (across, along_rows)
    overflow = _page_overflow(total_width, total_height)
    if overflow >= limit:
        return overflow
    positions = {item: (at, to) for at, row in enumerate(rows) for to, item in enumerate(row)}
    passed_boxes = 0
    for tail, head in ends:
        (row, column), (other, to) = positions[tail], positions[head]
        passed_boxes += max(abs(column - to) - 1, 0) if row == other else abs(row - other) - 1
    return overflow * (1 + 0.05 * passed_boxes)


def _page_overflow(width: float, height: float) -> float:
    """Return how many times too large a scene is for a page. The page may be turned; screens like it wide."""
    return min(
        max(width / _PAGE_SIZE[0], height / _PAGE_SIZE[1]),
        _TURNED_PENALTY * max(width / _PAGE_SIZE[1], height / _PAGE_SIZE[0]),
    )


def _row_statements(rows: Sequence[Sequence[str]], names: dict[str, str]) -> list[str]:
    ranks = [f"{{ rank=same; {'; '.join(names[item] for item in run)}; }}" for run in rows]
    # One invisible edge through the first of each row puts the rows in order.
    chain = " -> ".join(names[run[0]] for run in rows)
    return [*ranks, f'{chain} [style="invis" weight="0"];'] if len(rows) > 1 else ranks


def _line_attributes(styled_graph: StyledGraph, index: int) -> str:
    attributes = styled_graph.arrow_attributes[f"e{index}"][1]
    return format_attributes(
        {name: attributes[name] for name in ("arrowsize", "penwidth", "arrowhead") if name in attributes}
    )


def _lay_out_tiles(
    styled_graph: StyledGraph,
    tiles: dict[str, LayoutTile],
    arrows: Sequence[tuple[int, Arrow]],
    candidate: LayoutCandidate,
) -> Scene:
    """Lay out the outer graph: a mark at the middle of each tile, a frame of the tile's size, and the lines."""
    settings, statements = candidate
    tile_of_node = {f"o{at}": tile for at, tile in enumerate(tiles.values())}
    boxes = {
        name: {
            "shape": '"box"',
            "fixedsize": '"true"',
            "label": '""',
            "width": f"{tile.width / 72:.4f}",
            "height": f"{tile.height / 72:.4f}",
        }
        for name, tile in tile_of_node.items()
    }
    nodes = [f"{name} [{format_attributes(each)}];" for name, each in boxes.items()]
    edge_attributes = {f"e{at}": styled_graph.arrow_attributes[f"e{at}"] for at, _ in arrows}
    outer_scene = read_scene(
        layout_engine.lay_out_dot(write_dot(settings, [*nodes, *statements])), boxes, edge_attributes
    )
    anchors = tuple(replace(part, attributes=_INVISIBLE_NODE, kind="mark") for part in outer_scene.parts)
    frames = tuple(SceneFrame(part.name, {}, part.rectangle) for part in outer_scene.parts)
    return Scene(frames, outer_scene.lines, anchors)


def _fill_tiles(outer_scene: Scene, tiles: dict[str, LayoutTile]) -> Scene:
    """Set the insides into the frames of the outer graph. Done for the best layout only: moving takes long."""
    tile_of_node = {f"o{at}": tile for at, tile in enumerate(tiles.values())}
    insides = [tile_of_node[part.name].scene.moved(*part.rectangle[:2]) for part in outer_scene.parts]
    return replace(outer_scene, frames=()).joined(*insides)


def _find_best_scene(scenes: Sequence[Scene], arrows: Sequence[tuple[int, Arrow]]) -> int:
    """Return the number of the scene that reads best. Crossings are expensive to count: only where they can still decide."""
    edges = {f"{at}" for at, _ in arrows}
    outer_lines = [[line for line in scene.lines if line.edge in edges] for scene in scenes]
    costs = [_scene_cost(scene, lines, arrows) for scene, lines in zip(scenes, outer_lines, strict=True)]
    best, least = 0, math.inf
    # From the cheapest on: once a scene's cost without crossings reaches the best total, no later one can win.
    for at in sorted(range(len(scenes)), key=lambda each: costs[each]):
        if costs[at] >= least:
            break
        left, bottom, right, top = scenes[at].bounds()
        crossing_cost = 0.02 * _page_overflow(right - left, top - bottom)
        # One more than decides, so that no rounding does.
        limit = (least - costs[at]) / crossing_cost + 1 if crossing_cost else math.inf
        cost = costs[at] + crossing_cost * count_crossings(outer_lines[at], limit)
        if cost < least:
            best, least = at, cost
    return best


def _scene_cost(scene: Scene, outer_lines: Sequence[SceneLine], arrows: Sequence[tuple[int, Arrow]]) -> float:
    """Return the cost of a scene without crossings: how small it gets on the page, how far arrows run, how many run
    back.
    """
    left, bottom, right, top = scene.bounds()
    relative_length = math.fsum(line_length(line) for line in outer_lines) / (
        math.fsum(_PAGE_SIZE) * max(len(outer_lines), 1)
    )
    missing = len(arrows) - len(outer_lines)
    return (
        _page_overflow(right - left, top - bottom) * (1 + 0.5 * relative_length + 0.6 * _backward_share(scene, arrows))
        + 10 * missing
    )


def _backward_share(scene: Scene, arrows: Sequence[tuple[int, Arrow]]) -> float:
    """Return the share of flows that run upwards and to the left, against the direction of reading."""
    line_ends = {line.edge: (line.curve[0], line.curve[-1]) for line in scene.lines if line.curve}
    total = sum(arrow.count for _, arrow in arrows) or 1
    backward_count = 0
    for at, arrow in arrows:
        (x, y), (to_x, to_y) = line_ends.get(str(at), ((0.0, 0.0), (0.0, 0.0)))
        backward_count += arrow.count * ((to_x - x) + (y - to_y) < 0)
    return backward_count / total


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
