"""Draw one graph: choose its layout, check that every arrow is there, render it. Runs in a worker process."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from archgen.emit.graphviz import chart, engine, flow, framed, twostep
from archgen.emit.graphviz.decorations import decorated
from archgen.emit.graphviz.draft import Draft, draft
from archgen.emit.graphviz.legend import below
from archgen.emit.graphviz.png import png
from archgen.emit.graphviz.scene import Scene
from archgen.emit.graphviz.svg import drawn_edges, finished, steady
from archgen.emit.picture import Picture
from archgen.views.bars import Chart, Drawing
from archgen.views.shapes import Graph

_LAYOUTS = {
    "flow": flow.flow,
    "group": flow.group,
    "two-step": twostep.two_step,
    "overview": twostep.two_step,
    "framed": framed.framed,
}
_FORMATS = {"svg_outlines": "svg:cairo", "pdf": "pdf"}
_LOOK = {"pad": '"0.08"', "bgcolor": '"#ffffff"'}


def scene(graph: Graph, links: Mapping[str, str], *, simple: bool = False) -> tuple[Draft, Scene]:
    """Lay out a graph with its decorations, legend and notes.

    Raise LayoutError where the layout lost an arrow. `simple` takes the layout without frames and labels.
    """
    drafted = draft(graph, links.get, merged=graph.layout in {"two-step", "overview"})
    laid_out = flow.simple(drafted) if simple else _LAYOUTS[graph.layout](drafted)
    drawn = {line.arrow for line in laid_out.lines}
    wanted = {arrow.id for arrow in graph.arrows}
    if wanted - drawn:
        message = f"{len(wanted - drawn)} of {len(wanted)} arrows were lost"
        raise engine.LayoutError(message)
    boxes = {drafted.names[box.id]: box for box in graph.boxes}
    return drafted, below(decorated(laid_out, boxes), _noted(drafted, laid_out))


def _noted(drafted: Draft, laid_out: Scene) -> Graph:
    """Add a note to the graph that says how many texts beside arrows found no place."""
    lost = len(drafted.labels) - sum(part.kind == "label" for part in laid_out.parts)
    if not lost:
        return drafted.graph
    note = f"{lost} of the texts beside arrows had no place here; the tables have them all."
    return replace(drafted.graph, notes=(*drafted.graph.notes, note))


_FEW = 2


def _hues(graph: Graph) -> int:
    hues = {box.colour for box in graph.boxes if box.emphasis != "neighbour"} | {arrow.colour for arrow in graph.arrows}
    fills = {box.fill for box in graph.boxes} - {None}
    return len(fills) + len((hues | {cluster.colour for cluster in graph.clusters}) - {None})


def picture(
    graph: Drawing,
    links: Mapping[str, str],
    formats: Sequence[str],
    *,
    simple: bool = False,
    warning: str | None = None,
) -> Picture:
    """Draw a graph or a chart in these formats (names of Picture's fields)."""
    if isinstance(graph, Chart):
        return rendered(graph, chart.chart(graph, links.get), formats, quick=False, warning=warning)
    _, laid_out = scene(graph, links, simple=simple)
    return rendered(graph, laid_out, formats, quick=_hues(graph) <= _FEW, warning=warning)


def rendered(
    graph: Drawing, laid_out: Scene, formats: Sequence[str], *, quick: bool, warning: str | None = None
) -> Picture:
    """Render a placed scene. Raise LayoutError where a line of it is missing in the svg."""
    left, bottom, right, top = laid_out.bounds()
    dot = laid_out.dot(graph.id, {**_LOOK, "tooltip": '" "'})
    # svg is always rendered, asked for or not: it is what the lost arrows are looked for in.
    wanted = [form for form in _FORMATS if form in formats]
    svg, *others = engine.render(dot, ["svg", *(_FORMATS[form] for form in wanted)])
    text = svg.decode()
    # Only lines with an arrow id: samples in the legend have none.
    lost = {line.edge for line in laid_out.lines if line.arrow} - {edge[1:] for edge in drawn_edges(text)}
    if lost:
        message = f"{len(lost)} arrows were not drawn"
        raise engine.LayoutError(message)
    return Picture(
        graph.id,
        right - left,
        top - bottom,
        svg=finished(text, graph) if "svg" in formats else None,
        png=png(laid_out, graph.id, _LOOK, quick=quick) if "png" in formats else None,
        dot=dot,
        warning=warning,
        **{form: steady(data) if form == "svg_outlines" else data for form, data in zip(wanted, others, strict=True)},
    )
