"""Draw sheets: their parts have their places, and only texts are measured, to stand at the side that they name."""

from __future__ import annotations

from archgen.emit.graphviz import palette
from archgen.emit.graphviz.box_styles import LinkResolver, link_attributes
from archgen.emit.graphviz.chart_layout import fix_node_size, style_stretch_form
from archgen.emit.graphviz.dot_text import escape_label, quote_value
from archgen.emit.graphviz.drawn_legend import add_legend
from archgen.emit.graphviz.placed_scene import DotAttributes, Scene, SceneFrame, SceneLine, ScenePart
from archgen.emit.graphviz.styled_graph import measure_nodes
from archgen.views.picture_shapes import Sheet, SheetBar, SheetColour, SheetLine, SheetText

_COLOURS: dict[SheetColour, str] = {
    "text": palette.TEXT,
    "muted": palette.MUTED,
    "paper": palette.PAPER,
    "line": palette.EDGE,
    "tint": palette.GREY_TINT,
    "blank": palette.NEIGHBOUR_FILL,
    "step1": palette.PERIODS["slower"],
    "step2": palette.PERIODS["to_1_s"],
    "step3": palette.PERIODS["to_100_ms"],
    "step4": palette.PERIODS["to_30_ms"],
    "blue": palette.SUBJECT,
    "amber": palette.FEEDBACK,
    "violet": palette.HUES[6],
    "green": palette.OK,
    "red": palette.ERROR,
    "unknown": palette.NEIGHBOUR_FRAME,
}
_UNSEEN = {"style": '"invis"', "label": '""', "shape": '"point"', "width": "0", "height": "0"}


def lay_out_sheet(sheet: Sheet, resolve_link: LinkResolver) -> Scene:
    """Lay out a sheet as a scene, with its notes below."""
    texts = [_style_text(text, resolve_link) for text in sheet.texts]
    sizes = measure_nodes(texts)
    parts = [_draw_bar(at, bar, resolve_link) for at, bar in enumerate(sheet.bars) if not bar.behind]
    grounds = tuple(
        SceneFrame(f"g{at}", _style_bar(bar), (bar.x, -bar.y - bar.height, bar.x + bar.width, -bar.y))
        for at, bar in enumerate(sheet.bars)
        if bar.behind
    )
    for at, (text, attributes, (width, height)) in enumerate(zip(sheet.texts, texts, sizes, strict=True)):
        x = text.x + {"left": width / 2, "right": -width / 2, "middle": 0.0}[text.side]
        parts.append(ScenePart(f"t{at}", attributes, x, -text.y, width, height, "label"))
    marks, lines = list[ScenePart](), list[SceneLine]()
    for at, line in enumerate(sheet.lines):
        marks += [
            ScenePart(f"p{at}{end}", _UNSEEN, line.points[end][0], -line.points[end][1], 0, 0, "mark")
            for end in (0, -1)
        ]
        lines.append(_draw_line(at, line))
    return add_legend(Scene(grounds, tuple(lines), (*parts, *marks)), (), sheet.notes)


def _style_text(text: SheetText, resolve_link: LinkResolver) -> DotAttributes:
    words = escape_label(text.text)
    words = f"<B>{words}</B>" if text.bold else words
    return {
        "shape": '"plain"',
        "class": '"label"',
        "label": f'<<FONT POINT-SIZE="{text.size:g}" COLOR="{_COLOURS[text.ink]}">{words}</FONT>>',
        **link_attributes(text.ref, text.tooltip or " ", resolve_link),
    }


def _style_bar(bar: SheetBar) -> DotAttributes:
    fill = _COLOURS[bar.fill]
    styles = ["filled", *(["rounded"] if bar.rounded else []), *(["dashed"] if bar.dashed else [])]
    return {
        "class": '"bar"',
        "tooltip": quote_value(bar.tooltip or " "),
        "style": f'"{",".join(styles)}"',
        "color": f'"{_COLOURS[bar.rim] if bar.rim else fill}"',
        "fillcolor": f'"{fill}"',
        "penwidth": "1" if bar.rim else "0",
    }


def _draw_bar(at: int, bar: SheetBar, resolve_link: LinkResolver) -> ScenePart:
    attributes = _style_bar(bar)
    if bar.fill == "unknown":
        attributes = style_stretch_form("unknown", bar.width)
    ink = palette.text_colour_on(_COLOURS[bar.fill])
    label = f'<<FONT POINT-SIZE="8.5" COLOR="{ink}"><B>{escape_label(bar.label)}</B></FONT>>' if bar.label else '""'
    attributes |= fix_node_size(bar.width, bar.height) | {"label": label, "shape": '"box"'}
    attributes |= link_attributes(bar.ref, bar.tooltip or bar.label or " ", resolve_link)
    return ScenePart(
        f"b{at}", attributes, bar.x + bar.width / 2, -bar.y - bar.height / 2, bar.width, bar.height, "mark"
    )


def _draw_line(at: int, line: SheetLine) -> SceneLine:
    points = [(x, -y) for x, y in line.points]
    (x, y), (tip_x, tip_y) = points[-2:]
    head = 5.0 + line.width
    length = max(abs(tip_x - x), abs(tip_y - y)) or 1.0
    if line.head:
        points[-1] = (tip_x - (tip_x - x) * head / length, tip_y - (tip_y - y) * head / length)
    curve = [points[0]]
    for point in points[1:]:
        curve += [curve[-1], point, point]
    spline = " ".join(f"{x:.2f},{y:.2f}" for x, y in curve)
    attributes = {
        "class": '"arrow"',
        "color": f'"{_COLOURS[line.ink]}"',
        "penwidth": f"{line.width:g}",
        # Graphviz makes a head wider with its pen.
        "arrowsize": f"{head / 10 / max(1.0, line.width / 2):.2f}",
        "arrowhead": '"normal"' if line.head else '"none"',
        "tooltip": quote_value(line.tooltip or " "),
        "edgetooltip": quote_value(line.tooltip or " "),
    }
    tip = f"e,{tip_x:.2f},{tip_y:.2f} " if line.head else ""
    return SceneLine(f"{at}", f"line {at}", f"p{at}0", f"p{at}-1", attributes, tip + spline)
