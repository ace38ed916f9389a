"""Draw one graph: choose its layout, check that every arrow is there, render it. Runs in a worker process.

Clean up Graphviz's svg for a page: no prologue, real titles, ids of its own, a name and a description.

Hooks for a page's style: the root has the class `archgen`; its parts are `.box`, `.frame`, `.arrow`, `.label`,
`.title`, `.legend`, `.badge`, `.bar`, with the style, emphasis, status and hue (`hue0` to `hue9`) as further classes.
Colours are presentation attributes, so that any rule of the page wins over them; `palette.dark_rules` writes the rules
that turn them dark. Tooltips are `title` elements. Ids begin with the picture's id, so that several fit in one page.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from html import escape

from archgen.cache.layout_memory import NO_MEMORY, LayoutMemory
from archgen.emit.graphviz import (
    chart_layout,
    flow_layout,
    framed_layout,
    layout_engine,
    overview_layout,
    palette,
    sequence_layout,
    two_step_layout,
)
from archgen.emit.graphviz.box_styles import LinkResolver, add_decorations, link_attributes
from archgen.emit.graphviz.chart_layout import fix_node_size, style_stretch_form
from archgen.emit.graphviz.dot_text import clean_label_text, escape_label, quote_value
from archgen.emit.graphviz.drawn_legend import add_graph_legend, add_legend
from archgen.emit.graphviz.placed_scene import DotAttributes, Scene, SceneFrame, SceneLine, ScenePart
from archgen.emit.graphviz.png_writer import render_png
from archgen.emit.graphviz.styled_graph import StyledGraph, measure_nodes, style_graph
from archgen.emit.picture import Picture
from archgen.frozen import replace
from archgen.views.picture_shapes import (
    Chart,
    Drawing,
    Graph,
    SequenceChart,
    Sheet,
    SheetBar,
    SheetColour,
    SheetLine,
    SheetText,
)

_LAYOUT_FUNCTIONS = {
    "flow": flow_layout.lay_out_flow,
    "group": flow_layout.lay_out_group,
    "framed": framed_layout.lay_out_framed,
}
_RENDER_FORMATS = {"svg_outlines": "svg:cairo", "pdf": "pdf"}
_GRAPH_ATTRIBUTES = {"pad": '"0.08"', "bgcolor": '"#ffffff"'}


def lay_out_graph(
    graph: Graph, links: Mapping[str, str], *, simple: bool = False, memory: LayoutMemory = NO_MEMORY
) -> tuple[StyledGraph, Scene]:
    """Lay out a graph with its decorations, legend and notes.

    Raise LayoutError where the layout lost an arrow. `simple` takes the layout without frames and labels.
    """
    styled_graph = style_graph(graph, links.get, merged=graph.layout in {"two-step", "overview"})
    if simple:
        scene = flow_layout.lay_out_simply(styled_graph)
    elif graph.layout == "two-step":
        scene = two_step_layout.lay_out_two_step(styled_graph, memory)
    elif graph.layout == "overview":
        scene = overview_layout.lay_out_overview(styled_graph, memory)
    else:
        scene = _LAYOUT_FUNCTIONS[graph.layout](styled_graph)
    drawn_arrows = {line.arrow for line in scene.lines}
    wanted_arrows = {arrow.id for arrow in graph.arrows}
    if wanted_arrows - drawn_arrows:
        raise layout_engine.LayoutError(f"{len(wanted_arrows - drawn_arrows)} of {len(wanted_arrows)} arrows were lost")
    boxes = {styled_graph.dot_names[box.id]: box for box in graph.boxes}
    return styled_graph, add_graph_legend(add_decorations(scene, boxes), _note_lost_labels(styled_graph, scene))


def _note_lost_labels(styled_graph: StyledGraph, scene: Scene) -> Graph:
    """Add a note to the graph that says how many texts beside arrows found no place."""
    lost_count = len(styled_graph.label_attributes) - sum(part.kind == "label" for part in scene.parts)
    if not lost_count:
        return styled_graph.graph
    note = f"{lost_count} of the texts beside arrows had no place here; the tables have them all."
    return replace(styled_graph.graph, notes=(*styled_graph.graph.notes, note))


_FEW_HUES = 2


def _count_hues(graph: Graph) -> int:
    hues = {box.colour for box in graph.boxes if box.emphasis != "neighbour"} | {arrow.colour for arrow in graph.arrows}
    fills = {box.fill for box in graph.boxes} - {None}
    return len(fills) + len((hues | {cluster.colour for cluster in graph.clusters}) - {None})


def draw_picture(  # noqa: PLR0913 - what to draw, and how, each by its name
    drawing: Drawing,
    links: Mapping[str, str],
    formats: Sequence[str],
    *,
    simple: bool = False,
    warning: str | None = None,
    memory: LayoutMemory = NO_MEMORY,
) -> Picture:
    """Draw a graph or a chart in these formats (names of Picture's fields)."""
    if isinstance(drawing, Chart):
        return render_picture(
            drawing, chart_layout.lay_out_chart(drawing, links.get), formats, quick=True, warning=warning
        )
    if isinstance(drawing, Sheet):
        scene = lay_out_sheet(drawing, links.get)
        return render_picture(drawing, scene, formats, quick=False, warning=warning)
    if isinstance(drawing, SequenceChart):
        # Many hues side by side: gd's own palette would take two pale fills for one.
        return render_picture(
            drawing, sequence_layout.lay_out_sequence(drawing, links.get), formats, quick=False, warning=warning
        )
    _, scene = lay_out_graph(drawing, links, simple=simple, memory=memory)
    return render_picture(drawing, scene, formats, quick=_count_hues(drawing) <= _FEW_HUES, warning=warning)


def render_picture(
    drawing: Drawing, scene: Scene, formats: Sequence[str], *, quick: bool, warning: str | None = None
) -> Picture:
    """Render a placed scene. Raise LayoutError where a line of it is missing in the svg."""
    left, bottom, right, top = scene.bounds()
    dot = scene.to_dot(drawing.id, {**_GRAPH_ATTRIBUTES, "tooltip": '" "'})
    # svg is always rendered, asked for or not: it is what the lost arrows are looked for in.
    vector_formats = [form for form in _RENDER_FORMATS if form in formats]
    svg, *vector_data = layout_engine.render_dot(dot, ["svg", *(_RENDER_FORMATS[form] for form in vector_formats)])
    text = svg.decode()
    # Only lines with an arrow id: samples in the legend have none.
    lost_edges = {line.edge for line in scene.lines if line.arrow} - {edge[1:] for edge in find_drawn_edges(text)}
    if lost_edges:
        raise layout_engine.LayoutError(f"{len(lost_edges)} arrows were not drawn")
    return Picture(
        drawing.id,
        right - left,
        top - bottom,
        svg=clean_graphviz_svg(text, drawing) if "svg" in formats else None,
        png=render_png(scene, drawing.id, _GRAPH_ATTRIBUTES, quick=quick) if "png" in formats else None,
        dot=dot,
        warning=warning,
        **{
            form: clean_outlines(data) if form == "svg_outlines" else data
            for form, data in zip(vector_formats, vector_data, strict=True)
        },
    )


_HEAD = re.compile(r"^.*?<svg ([^>]*)>", re.DOTALL)
_COMMENT = re.compile(r"<!--.*?-->\n?", re.DOTALL)
_ID = re.compile(r'(<g id=")([^"]*)(")')
_GROUP = re.compile(r'(<g id="[^"]*" class="(?:node|edge|cluster)[^"]*">\n)<title>[^<]*</title>\n')
_LINK = re.compile(
    r'<g id="[^"]*"><a (xlink:href="[^"]*" )?xlink:title="([^"]*)"([^>]*)>\n(.*?)</a>\n</g>\n', re.DOTALL
)
_DECIMALS = re.compile(rb"(\.[0-9]{2})[0-9]+")
_SURFACE = re.compile(rb"surface[0-9]+")
# The lookahead keeps the search inside of one edge's group: an edge without a path must not take the next one's.
_DRAWN = re.compile(r'<g id="(e[0-9]+)" class="edge[^"]*">(?:(?!</g>\n<).)*?<path', re.DOTALL)


def find_drawn_edges(svg: str) -> set[str]:
    """Return the ids of the edges that have a line."""
    return set(_DRAWN.findall(svg))


def clean_outlines(outlines: bytes) -> bytes:
    """Renumber cairo's surfaces from 1, since cairo goes on counting from one picture to the next in the same process,
    and keep two decimals: a hundredth of a point is less than any printer shows.
    """
    numbers: dict[bytes, bytes] = {}
    outlines = _SURFACE.sub(lambda found: numbers.setdefault(found[0], b"surface%d" % (len(numbers) + 1)), outlines)
    # Split at the digits that go, and joined: a replacement with a group in it is put together in Python, at seven times the time.
    return shorten_glyphs(b"".join(_DECIMALS.split(outlines)))


def clean_graphviz_svg(svg: str, drawing: Drawing) -> bytes:
    """Return the svg as a single element, without prologue and comments."""
    head = _HEAD.match(svg)
    if head is None:
        return svg.encode()
    prefix = re.sub(r"[^A-Za-z0-9_]+", "-", drawing.id)
    body = _COMMENT.sub("", svg[head.end() :])
    body = _LINK.sub(_write_title, _GROUP.sub(r"\1", body))
    body = re.sub(r"(<g id=\"graph0\"[^>]*>\n)<title>.*?</title>\n", r"\1", body, count=1)
    body = _ID.sub(lambda found: f"{found[1]}{prefix}-{found[2]}{found[3]}", body)
    name = f"<title>{escape(clean_label_text(drawing.title))}</title>\n"
    description = f"<desc>{escape(clean_label_text(drawing.alt, 4000))}</desc>\n" if drawing.alt else ""
    return f'<svg class="archgen" role="group" {head[1]}>\n{name}{description}{body.lstrip()}'.encode()


def _write_title(match: re.Match[str]) -> str:
    """Write a tooltip as a title element. Keep the link where there is an address."""
    href, tooltip, link_attributes, inner = match.groups()
    title = f"<title>{tooltip}</title>\n" if tooltip.strip() else ""
    return f"<a {href}{link_attributes.strip()}>\n{title}{inner}</a>\n" if href else f"{title}{inner}"


_SYMBOL = re.compile(rb'<symbol overflow="visible" id="(glyph[0-9-]+)">\n.*?</symbol>\n', re.DOTALL)
_USE = re.compile(rb'href="#(glyph[0-9-]+)"')
_PATH = re.compile(rb' d="([^"]*)"')
_TOKEN = re.compile(rb"[A-Za-z]|-?[0-9.]+")
_NUMBERS_BY_COMMAND = {b"M": 2, b"L": 2, b"C": 6, b"Z": 0}
_LEADING_ZERO = re.compile(r"^(-?)0\.")
_UNIT = 100
"""Hundredths of a point: as exact as what cairo's numbers are cut to."""


def shorten_glyphs(svg: bytes) -> bytes:
    """Return an svg whose letters are outlined in steps, without those that no text has."""
    used_ids = set(_USE.findall(svg))
    return _SYMBOL.sub(
        lambda found: (
            _PATH.sub(lambda found: b' d="%s"' % shorten_path(found[1]), found[0]) if found[1] in used_ids else b""
        ),
        svg,
    )


@lru_cache(4096)
def shorten_path(path: bytes) -> bytes:
    """Return a path of absolute lines and curves as one of steps; any other path as it is."""
    tokens = _TOKEN.findall(path)
    pieces: list[str] = []
    point, first_point = (0, 0), (0, 0)
    position = 0
    while position < len(tokens):
        command = tokens[position]
        count = _NUMBERS_BY_COMMAND.get(command)
        numbers = [round(float(token) * _UNIT) for token in tokens[position + 1 : position + 1 + (count or 0)]]
        if count is None or len(numbers) < count:
            return path
        position += 1 + count
        if not count:
            pieces.append("z")
            point = first_point
            continue
        if command == b"M" and pieces and position == len(tokens):
            break  # cairo ends with a move to where it is
        pieces.append(
            command.decode().lower() + _join_steps(number - point[at % 2] for at, number in enumerate(numbers))
        )
        point = (numbers[-2], numbers[-1])
        first_point = point if command == b"M" else first_point
    return "".join(pieces).encode()


def _join_steps(steps: Iterable[int]) -> str:
    """Write numbers, a blank between them only where no sign parts them."""
    texts = [_LEADING_ZERO.sub(r"\1.", f"{step / _UNIT:.2f}".rstrip("0").rstrip(".")) for step in steps]
    return "".join([text if text[0] == "-" or not at else f" {text}" for at, text in enumerate(texts)])


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


def _style_hatched_bar(bar: SheetBar) -> DotAttributes:
    """Return the attributes of what is unknown: stripes without a rim, which would make boxes of a bar so low."""
    stripes = f"{palette.PAPER}:{palette.NEIGHBOUR_FRAME}"
    return {**style_stretch_form("unknown", bar.width, stripes), "style": '"striped"', "color": '"transparent"'}


def _draw_bar(at: int, bar: SheetBar, resolve_link: LinkResolver) -> ScenePart:
    attributes = _style_hatched_bar(bar) if bar.fill == "unknown" else _style_bar(bar)
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
