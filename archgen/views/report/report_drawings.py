"""The pictures that the report draws anew, so that they are legible on an upright page of A4."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from archgen.frozen import replace
from archgen.views.graphs.graph_folding import add_legend_keys
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import UPRIGHT, Arrow, Box, Drawing, Graph, SequenceChart
from archgen.views.sequences.sequence_charts import CHART_PREFIX, make_printed_charts

_PREFIX = "report/"
LEGEND_NAME = "report/legend"
_MAX_INSIDE_BOXES = 10
"""Groups of more components are drawn without their neighbours."""


def make_report_drawings(
    lookup: Lookup, drawings: Mapping[str, Drawing], *, shows_ros: bool = True
) -> dict[str, Drawing]:
    """Return the report's drawings by the names of the usual ones; those that differ have ids of their own.

    A report of the functional level has no pictures of nodes, and no forms of theirs in its legend.
    """
    fitted = {
        name: _fit_drawing(lookup, drawing)
        for name, drawing in drawings.items()
        if shows_ros or not (isinstance(drawing, Graph) and drawing.kind in {"implementation", "group-timing"})
    }
    fitted |= {name: fitted[f"{name}{UPRIGHT}"] for name in fitted if f"{name}{UPRIGHT}" in fitted}
    fitted = dict(_cut_sequences(lookup, fitted))
    legend = _draw_legend([drawing for drawing in fitted.values() if isinstance(drawing, Graph)])
    fitted = {name: _drop_legend(drawing) for name, drawing in fitted.items()}
    return fitted | ({LEGEND_NAME: legend} if legend.legend else {})


def _cut_sequences(lookup: Lookup, drawings: Mapping[str, Drawing]) -> Iterator[tuple[str, Drawing]]:
    """Yield the drawings by name, sequences that are too large for a page in pieces."""
    for name, drawing in drawings.items():
        if isinstance(drawing, SequenceChart):
            pieces = make_printed_charts(lookup, name.removeprefix(CHART_PREFIX))
            yield from ((piece.id, piece) for piece in pieces)
        else:
            yield name, drawing


def is_piece_of(drawing: Drawing, name: str) -> bool:
    """Whether a drawing is a piece of the sequence of this name."""
    whole, _, number = drawing.id.rpartition("/")
    return isinstance(drawing, SequenceChart) and whole == name and number.isdecimal()


def _draw_legend(graphs: Sequence[Graph]) -> Graph:
    """Return a picture with the legend of all pictures that the report draws anew, under a flow as an example."""
    graphs = [graph for graph in graphs if graph.id.startswith(_PREFIX)]
    keys = {key for graph in graphs for key in add_legend_keys(graph).legend}
    boxes = (
        Box("from", "Neighbour", ("what it gives, or calls",), emphasis="neighbour", side="left"),
        Box("subject", "What it is about", ("role, owner, host",), emphasis="subject"),
        Box("to", "Neighbour", ("what it takes, or serves",), emphasis="neighbour", side="right"),
    )
    arrows = (Arrow("in", "from", "subject", "type"), Arrow("out", "subject", "to", "type"))
    # In the order of a legend, whatever picture a key comes from.
    order = add_legend_keys(_join_graphs(graphs)).legend
    return Graph(
        LEGEND_NAME,
        "How to read the pictures",
        "flow",
        boxes,
        arrows,
        legend=tuple(key for key in order if key in keys),
        notes=(
            "A number on an arrow: how many flows it stands for. W, E, N in a corner: a warning, an error, a note.",
        ),
        asked=2,
        kind="component",
    )


def _join_graphs(graphs: Sequence[Graph]) -> Graph:
    boxes = tuple(box for graph in graphs for box in graph.boxes)
    arrows = tuple(arrow for graph in graphs for arrow in graph.arrows)
    return Graph("", "", "flow", boxes, arrows, kind="component")


def _drop_legend(drawing: Drawing) -> Drawing:
    """Return a picture of the report's own without its legend, which stands once at the beginning."""
    if isinstance(drawing, Graph) and drawing.id.startswith(_PREFIX):
        return replace(drawing, legend=(), legend_colours=())
    return drawing


def _fit_drawing(lookup: Lookup, drawing: Drawing) -> Drawing:
    if not isinstance(drawing, Graph):
        return drawing
    if drawing.kind == "implementation":
        return join_topics(drawing)
    if drawing.kind in {"component", "composed"}:
        return _copy_graph(drawing, boxes=drawing.boxes, arrows=drawing.arrows)
    if drawing.kind == "group-timing":
        return drop_neighbours(drawing)
    if drawing.kind == "group":
        inside = sum(box.emphasis != "neighbour" for box in drawing.boxes)
        return drop_neighbours(drawing) if inside > _MAX_INSIDE_BOXES else fold_neighbouring_groups(lookup, drawing)
    return drawing


def join_topics(graph: Graph) -> Graph:
    """Return a picture of nodes with the topics as lines of the neighbours' boxes: three boxes side by side, not five.

    What no neighbour is at the other end of stays a box of its own.
    """
    boxes = {box.id: box for box in graph.boxes}
    topics = {box.id for box in graph.boxes if box.style in {"topic", "service", "action"}}
    names: dict[str, list[str]] = {}
    flows: dict[tuple[str, str, str], list[Arrow]] = {}
    plain_arrows: list[Arrow] = []
    plain_topics: set[str] = set()
    for topic in sorted(topics):
        entering = [arrow for arrow in graph.arrows if arrow.head == topic]
        leaving = [arrow for arrow in graph.arrows if arrow.tail == topic]
        if not entering or not leaving or any(_is_inner(boxes, a, b) for a in entering for b in leaving):
            plain_topics.add(topic)
            plain_arrows += [*entering, *leaving]
            continue
        for first in entering:
            for second in leaving:
                ends = (first.tail, second.head)
                for end in ends:
                    if boxes[end].emphasis == "neighbour":
                        lines = boxes[topic].lines if topic.startswith("topic * ") else (boxes[topic].title,)
                        names.setdefault(end, []).extend(line for line in lines if line not in names.get(end, ()))
                style = second.style if boxes[first.tail].emphasis == "neighbour" else first.style
                flows.setdefault((*ends, style), []).append(first)
    arrows = tuple(
        replace(each[0], id=f"{tail}>{head} {style}", tail=tail, head=head, style=style, count=len(each), label="")  # type: ignore[arg-type]
        for (tail, head, style), each in flows.items()
    )
    shown = tuple(
        replace(box, lines=tuple(names[box.id])) if box.id in names else box
        for box in graph.boxes
        if box.id not in topics or box.id in plain_topics
    )
    # Nodes one behind the other, with topics between them, are too long for a line.
    direction = (
        "top-bottom"
        if plain_arrows and graph.direction is None and _has_inner_flow(boxes, plain_arrows)
        else graph.direction
    )
    joined = _copy_graph(graph, boxes=shown, arrows=(*arrows, *plain_arrows))
    return replace(joined, direction=direction)


def _has_inner_flow(boxes: Mapping[str, Box], arrows: Sequence[Arrow]) -> bool:
    """Whether a topic that stays a box joins nodes of the subject."""
    ends = {
        (arrow.tail if arrow.head == box.id else arrow.head)
        for box in boxes.values()
        for arrow in arrows
        if box.id in (arrow.tail, arrow.head)
    }
    subjects = [end for end in sorted(ends) if end in boxes and boxes[end].emphasis == "subject"]
    return len(subjects) > 1


def _is_inner(boxes: Mapping[str, Box], first: Arrow, second: Arrow) -> bool:
    """Whether what enters a topic by one arrow and leaves it by another joins two neighbours, or two nodes of the subject."""
    return (boxes[first.tail].emphasis == "neighbour") == (boxes[second.head].emphasis == "neighbour")


def drop_neighbours(graph: Graph) -> Graph:
    """Return a group's picture with what runs inside it alone."""
    boxes = tuple(box for box in graph.boxes if box.emphasis != "neighbour")
    inside = {box.id for box in boxes}
    arrows = tuple(arrow for arrow in graph.arrows if arrow.tail in inside and arrow.head in inside)
    notes = ("Inside the group only; the tables of its components name the neighbours.",)
    return _copy_graph(graph, boxes=boxes, arrows=arrows, notes=notes)


def fold_neighbouring_groups(lookup: Lookup, graph: Graph) -> Graph:
    """Return a group's picture with a box for each neighbouring group; arrows from and to them have counts for names."""
    folded: dict[str, Box] = {}
    members: dict[str, list[str]] = {}
    new_ids: dict[str, str] = {}
    for box in graph.boxes:
        group = (box.ref or "").removeprefix("component:").partition(".")[0]
        if box.emphasis != "neighbour" or group not in lookup.architecture.groups:
            folded[box.id], new_ids[box.id] = box, box.id
            continue
        new_ids[box.id] = f"{'<' if box.side == 'left' else '>'}{group}"
        members.setdefault(new_ids[box.id], []).append(box.title)
        title = lookup.architecture.groups[group].title
        folded.setdefault(
            new_ids[box.id], replace(box, id=new_ids[box.id], title=title, ref=f"group:{group}", status=None)
        )
    boxes = tuple(
        replace(box, lines=tuple(dict.fromkeys(members[box.id]))) if box.id in members else box
        for box in folded.values()
    )
    merged: dict[tuple[str, str, str], list[Arrow]] = {}
    for arrow in graph.arrows:
        merged.setdefault((new_ids[arrow.tail], new_ids[arrow.head], arrow.style), []).append(arrow)
    arrows = tuple(_merge_arrows(ends, each, members) for ends, each in merged.items())
    return _copy_graph(graph, boxes=boxes, arrows=arrows)


def _merge_arrows(ends: tuple[str, str, str], arrows: Sequence[Arrow], folded: Collection[str]) -> Arrow:
    tail, head, style = ends
    count = sum(arrow.count for arrow in arrows)
    if tail not in folded and head not in folded and len(arrows) == 1:
        return arrows[0]
    label = str(count) if count > 1 else ""
    flows = tuple(flow for arrow in arrows for flow in arrow.flows)
    optional = all(arrow.optional for arrow in arrows)
    return replace(
        arrows[0],
        id=f"{tail}>{head} {style}",
        tail=tail,
        head=head,
        tail_port=None if tail in folded else arrows[0].tail_port,
        head_port=None if head in folded else arrows[0].head_port,
        label=label,
        count=count,
        flows=flows,
        optional=optional,
    )


def _copy_graph(
    graph: Graph, *, boxes: tuple[Box, ...], arrows: tuple[Arrow, ...], notes: tuple[str, ...] | None = None
) -> Graph:
    return replace(
        graph,
        id=f"{_PREFIX}{graph.id}",
        boxes=boxes,
        arrows=arrows,
        notes=graph.notes if notes is None else notes,
        asked=sum(arrow.count for arrow in arrows),
    )
