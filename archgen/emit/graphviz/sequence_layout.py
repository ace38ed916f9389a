"""Lay out sequences: heads side by side, a line below each, and a step after the other; Graphviz only renders them.

Columns are as far apart as the words between them need. All lengths are in points, y grows upwards.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Literal

from archgen.emit.graphviz import palette, styled_graph
from archgen.emit.graphviz.box_styles import LinkResolver, link_attributes, style_box
from archgen.emit.graphviz.dot_text import escape_label, wrap_text
from archgen.emit.graphviz.drawn_legend import add_graph_legend
from archgen.emit.graphviz.placed_scene import DotAttributes, Scene, SceneLine, ScenePart, ScenePoint
from archgen.emit.graphviz.styled_graph import measure_nodes
from archgen.views.picture_shapes import Arrow, Box, Graph, Lifeline, MessageStyle, SequenceChart, SequenceMessage

_HEAD_GAP = 10.0
_TEXT_GAP = 14.0
"""Room beside the words of a step, to the lines at both ends."""
_ROW_GAP = 9.0
_LOOP_WIDTH, _LOOP_HEIGHT = 18.0, 11.0
_TEXT_WIDTH = 18
"""Characters in a line of words between neighbours."""
_FEW_MESSAGES = 12
"""With more, the heads stand below the picture once more."""
_HEAD_LENGTHS = {"action": 12.0}
"""How long the head of an arrow is, where it is not that of most."""
_HEAD_LENGTH = 6.0
_BOX_STYLES: dict[str, Literal["external", "component", "composed"]] = {
    "actor": "external",
    "component": "component",
    "composed": "composed",
    "unknown": "external",
}


_ARROW_STYLES: dict[MessageStyle, Literal["data", "physical", "service", "action", "internal"]] = {
    "data": "data",
    "service": "service",
    "action": "action",
    "physical": "physical",
    "inner": "internal",
    "broken": "data",
}


def lay_out_sequence(chart: SequenceChart, resolve_link: LinkResolver) -> Scene:
    """Lay out a sequence as a scene, with its legend and notes."""
    heads = [style_box(_make_head(lifeline), resolve_link) for lifeline in chart.lifelines]
    texts = [_style_text(message, resolve_link) for message in chart.messages]
    sizes = measure_nodes([*heads, *texts])  # all at once: measuring runs a layout
    head_sizes, text_sizes = sizes[: len(heads)], sizes[len(heads) :]
    columns = _place_columns(chart, [width for width, _ in head_sizes], [width for width, _ in text_sizes])
    head_height = max((height for _, height in head_sizes), default=0.0)
    parts, lines = _draw_heads(heads, head_sizes, columns, "h", head_height / 2), list[SceneLine]()
    y = -_ROW_GAP
    for message, attributes, size in zip(chart.messages, texts, text_sizes, strict=True):
        part, line, y = _draw_message(message, attributes, size, columns, y, resolve_link)
        parts.append(part)
        lines.append(line)
    y -= _ROW_GAP
    if len(chart.messages) > _FEW_MESSAGES:
        parts += _draw_heads(heads, head_sizes, columns, "b", y - head_height / 2)
    lifelines = [_draw_lifeline(at, x, y) for at, x in enumerate(columns)]
    return add_graph_legend(
        Scene(lines=(*lifelines, *lines), parts=tuple(parts)),
        Graph(chart.id, chart.title, "flow", (), (), legend=chart.legend, notes=chart.notes, kind="component"),
    )


def _make_head(lifeline: Lifeline) -> Box:
    """Return who takes part as the box that stands for it in all pictures; who stands outside is dashed."""
    style = _BOX_STYLES[lifeline.kind]
    colour = lifeline.colour if style != "external" else None
    return Box("", lifeline.title, style=style, colour=colour, ref=lifeline.ref, tooltip=lifeline.tooltip)


def _style_text(message: SequenceMessage, resolve_link: LinkResolver) -> DotAttributes:
    """Return the attributes of the words of a step: its number and text, and what it runs along below."""
    width = _TEXT_WIDTH * max(abs(message.head - message.tail), 1)
    ink = palette.ERROR if message.style == "broken" else palette.TEXT
    number = f"<B>{message.number}</B> "
    rows = [escape_label(row) for row in wrap_text(message.text, width, 4)] if message.text else [""]
    rows[0] = number + rows[0]
    html = [f'<FONT POINT-SIZE="8" COLOR="{ink}">{row}</FONT>' for row in rows]
    if message.detail:
        muted = palette.ERROR if message.style == "broken" else palette.MUTED
        details = [row for line in message.detail.split("\n") for row in wrap_text(line, width + width // 4, 3)]
        html += [f'<FONT POINT-SIZE="7" COLOR="{muted}">{escape_label(row)}</FONT>' for row in details]
    # As rows of a table: Graphviz sets lines of two fonts solid, so that descenders touch the next line.
    cells = "".join(f"<TR><TD>{row}</TD></TR>" for row in html)
    return {
        "shape": '"plain"',
        "class": '"label"',
        "style": '"filled"',
        "color": f'"{palette.PAPER}00"',
        "fillcolor": f'"{palette.PAPER}"',
        "penwidth": "0",
        "label": f'<<TABLE BORDER="0" CELLBORDER="0" CELLSPACING="0" CELLPADDING="0">{cells}</TABLE>>',
        **link_attributes(message.ref, message.tooltip or message.text or " ", resolve_link),
    }


def _place_columns(chart: SequenceChart, head_widths: Sequence[float], text_widths: Sequence[float]) -> list[float]:
    """Return the x of each lifeline: from left to right, each as near as heads and words allow."""
    # What each column needs from an earlier one, by the position of the later one.
    needs: list[list[tuple[int, float]]] = [[] for _ in chart.lifelines]
    for at in range(1, len(head_widths)):
        needs[at].append((at - 1, (head_widths[at - 1] + head_widths[at]) / 2 + _HEAD_GAP))
    for message, width in zip(chart.messages, text_widths, strict=True):
        first, last = sorted((message.tail, message.head))
        if first != last:
            needs[last].append((first, width + _TEXT_GAP))
        elif first + 1 < len(needs):
            needs[first + 1].append((first, _LOOP_WIDTH + width + _TEXT_GAP))
    columns: list[float] = []
    for column_needs in needs:
        columns.append(max((columns[before] + distance for before, distance in column_needs), default=0.0))
    return columns


def _draw_heads(
    heads: Sequence[DotAttributes], sizes: Sequence[tuple[float, float]], columns: Sequence[float], name: str, y: float
) -> list[ScenePart]:
    return [
        ScenePart(f"{name}{at}", attributes, x, y, width, height)
        for at, (attributes, (width, height), x) in enumerate(zip(heads, sizes, columns, strict=True))
    ]


def _draw_lifeline(at: int, x: float, bottom: float) -> SceneLine:
    attributes = {
        "class": '"arrow lifeline"',
        "style": '"dashed"',
        "color": f'"{palette.NEIGHBOUR_FRAME}"',
        "penwidth": "0.7",
        "arrowhead": '"none"',
        "tooltip": '" "',
    }
    return SceneLine(f"l{at}", "", f"h{at}", f"h{at}", attributes, _write_spline([(x, 0.0), (x, bottom)]))


def _draw_message(  # noqa: PLR0913, PLR0917 - a step, how it looks, and where it stands
    message: SequenceMessage,
    attributes: DotAttributes,
    size: tuple[float, float],
    columns: Sequence[float],
    top: float,
    resolve_link: LinkResolver,
) -> tuple[ScenePart, SceneLine, float]:
    """Draw a step below `top`: return its words, its arrow, and where the next one begins."""
    width, height = size
    tail, head = columns[message.tail], columns[message.head]
    arrow = _make_arrow(message)
    style = styled_graph.style_arrow(arrow, resolve_link)
    name, ends = str(message.number), (f"h{message.tail}", f"h{message.head}")
    if message.tail == message.head:
        row = max(height, _LOOP_HEIGHT)
        middle = top - row / 2
        part = ScenePart(f"t{name}", attributes, tail + _LOOP_WIDTH + 5 + width / 2, middle, width, height, "label")
        corner = tail + _LOOP_WIDTH
        points = list(_walk_loop(tail, corner, middle))
        return (
            part,
            SceneLine(name, arrow.id, *ends, style, _write_spline(points, (tail, points[-1][1]))),
            top - row - _ROW_GAP,
        )
    part = ScenePart(f"t{name}", attributes, (tail + head) / 2, top - height / 2, width, height, "label")
    y = top - height - 3
    length = _HEAD_LENGTHS.get(message.style, _HEAD_LENGTH) * (1 if head > tail else -1)
    line = SceneLine(name, arrow.id, *ends, style, _write_spline([(tail, y), (head - length, y)], (head, y)))
    return part, line, y - _ROW_GAP


def _walk_loop(left: float, right: float, middle: float) -> Iterator[ScenePoint]:
    """Yield the corners of an arrow that leads back to where it begins."""
    upper, lower = middle + _LOOP_HEIGHT / 2, middle - _LOOP_HEIGHT / 2
    yield from ((left, upper), (right, upper), (right, lower), (left + _HEAD_LENGTH, lower))


def _make_arrow(message: SequenceMessage) -> Arrow:
    """Return a step as the arrow that stands for such a flow in all pictures; one without a connection as one that is gone."""
    return Arrow(
        f"m{message.number}",
        "",
        "",
        style=_ARROW_STYLES[message.style],
        ref=message.ref,
        flows=(message.tooltip or message.text or " ",),
        change="removed" if message.style == "broken" else None,
    )


def _write_spline(points: Sequence[ScenePoint], tip: ScenePoint | None = None) -> str:
    """Write straight lines from point to point as Graphviz writes curves; the arrow head ends at `tip`."""
    curve = [points[0]]
    for point in points[1:]:
        (x, y), (next_x, next_y) = curve[-1], point
        # Control points at the thirds: a double line keeps its width.
        curve += [((2 * x + next_x) / 3, (2 * y + next_y) / 3), ((x + 2 * next_x) / 3, (y + 2 * next_y) / 3), point]
    written = " ".join(f"{x:.2f},{y:.2f}" for x, y in curve)
    return f"e,{tip[0]:.2f},{tip[1]:.2f} {written}" if tip else written
