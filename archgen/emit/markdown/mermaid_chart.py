"""Write a graph as a Mermaid flowchart, and a sequence as a sequence diagram: the only place that knows Mermaid."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from archgen.emit.safe_names import make_identifier
from archgen.frozen import replace
from archgen.views.graphs.graph_folding import fold_graph
from archgen.views.picture_shapes import (
    Arrow,
    Box,
    Cluster,
    ElementChange,
    Graph,
    Lifeline,
    SequenceChart,
    SequenceMessage,
)

_MAX_LABEL_LENGTH = 60
_BOX_SHAPES = {"topic": "[]", "service": "{{}}", "action": "{{}}", "node": "([])", "composed": "[[]]", "port": "[]"}
_LIST_START = re.compile(r"^(?=[-+*#>]|\d+[.)])")
_BOX_STYLES: dict[ElementChange, str] = {
    "added": "stroke:#2e8b57,stroke-width:4px",
    "removed": "stroke:#d1473f,stroke-width:2px,stroke-dasharray:6 4",
    "changed": "stroke:#b7791f,stroke-width:2px",
    "renamed": "stroke:#2f81c7,stroke-width:3px,stroke-dasharray:2 3",
}
"""Lines that can be seen on a light and on a dark page: GitHub shows both."""
_LINK_STYLES: dict[ElementChange | None, str] = {
    "added": "stroke:#2e8b57,stroke-width:3px",
    "removed": _BOX_STYLES["removed"],
    "changed": _BOX_STYLES["changed"],
    None: "stroke:#8a8a8a,stroke-width:1px",
}
_BROKEN_STYLE = "stroke:#d1242f,stroke-width:4px"
_ARROW_SIGNS = {"service": "-.->", "action": "==>", "physical": "-.->", "link": "---"}
_SUBJECT_STYLE = "stroke:#0072b2,stroke-width:2px"
_NEIGHBOUR_STYLE = "fill:#eeeeee,stroke:#8a8a8a,color:#1b2127"
# Where changes are shown, a grey fill would stand out more than their lines.
_NEIGHBOUR_OF_CHANGES_STYLE = "stroke:#8a8a8a,stroke-width:1px"


def write_flowchart(graph: Graph, *, has_stable_names: bool = False) -> Iterator[str]:
    """Yield the lines of a flowchart. Boxes are `n0`, `n1`: no text of the model is a name or a word of Mermaid.

    With `has_stable_names`, for files under version control, names are made from ids, so that a new box changes no other line.
    """
    frames = {
        cluster.id: make_identifier(f"cluster {cluster.id}") if has_stable_names else f"g{at}"
        for at, cluster in enumerate(graph.clusters)
    }
    boxes = {box.id: make_identifier(box.id) if has_stable_names else f"n{at}" for at, box in enumerate(graph.boxes)}
    # Arrows of large pictures lead from frame to frame.
    names = {**frames, **boxes}
    yield f"flowchart {'TB' if graph.direction == 'top-bottom' else 'LR'}"
    yield from (f"  {_write_box(box, names)}" for box in graph.boxes if box.cluster not in frames)
    for cluster in graph.clusters:
        if cluster.parent not in frames:
            yield from (f"  {line}" for line in _write_frame(graph, cluster, names))
    yield from (f"  {_write_arrow(arrow, names)}" for arrow in graph.arrows)
    yield from _write_styles(graph)


def _write_frame(graph: Graph, cluster: Cluster, names: Mapping[str, str]) -> Iterator[str]:
    """Yield a frame with its boxes and the frames inside."""
    yield f'subgraph {names[cluster.id]}["{_label_text(cluster.title)}"]'
    yield from (f"  {_write_box(box, names)}" for box in graph.boxes if box.cluster == cluster.id)
    for inner in graph.clusters:
        if inner.parent == cluster.id:
            yield from (f"  {line}" for line in _write_frame(graph, inner, names))
    yield "end"


def escape_mermaid(text: object) -> str:
    """Escape text for a Mermaid label in double quotes."""
    line = " ".join(str(text).split())
    return re.sub(r"[^\w .,:/()+·→-]", lambda found: f"#{ord(found.group())};", line) or " "


def _write_box(box: Box, names: Mapping[str, str]) -> str:
    shape = "[[]]" if box.change == "changed" and box.style not in _BOX_SHAPES else _BOX_SHAPES.get(box.style, "()")
    half = len(shape) // 2
    rows = [": ".join(words.replace("\n", ", ") for words in row if words) for row in box.rows]
    load = [box.load[1]] if box.load else []
    text = "<br>".join(_label_text(line) for line in (box.title, *box.lines, *load, *rows))
    style_class = "broken" if box.broken else box.change or (box.emphasis if box.emphasis != "normal" else "")
    return f'{names[box.id]}{shape[:half]}"{text}"{shape[half:]}' + (f":::{style_class}" if style_class else "")


def _write_arrow(arrow: Arrow, names: dict[str, str]) -> str:
    line = "-.->" if arrow.is_made else _ARROW_SIGNS.get(arrow.style, "-->")
    text = arrow.label or (str(arrow.count) if arrow.count > 1 else "")
    if arrow.medium:
        # Mermaid has no head with a square behind it: a round end says the same.
        line = f"{line.removesuffix('>')}o" if line.endswith("->") else "==o" if line == "==>" else line
        medium = f"({arrow.medium})"
        text = text if medium in text else "\n".join(filter(None, (text, medium)))
    label = "<br>".join(_label_text(line) for line in text.split("\n")) if text else ""
    return f"{names[arrow.tail]} {line}" + (f'|"{label}"|' if label else "") + f" {names[arrow.head]}"


def _write_styles(graph: Graph) -> Iterator[str]:
    kinds = {box.change for box in graph.boxes}
    yield from (f"  classDef {kind} {style}" for kind, style in _BOX_STYLES.items() if kind in kinds)
    if any(box.broken for box in graph.boxes):
        yield f"  classDef broken {_BROKEN_STYLE}"
    shows_changed_arrows = any(arrow.change or arrow.broken for arrow in graph.arrows)
    shows_changes = any(kinds) or shows_changed_arrows
    emphases = {box.emphasis for box in graph.boxes if not box.change and not box.broken}
    if "neighbour" in emphases:
        yield f"  classDef neighbour {_NEIGHBOUR_OF_CHANGES_STYLE if shows_changes else _NEIGHBOUR_STYLE}"
    if "subject" in emphases:
        yield f"  classDef subject {_SUBJECT_STYLE}"
    # linkStyle addresses arrows by their position, so all of them must be counted in the order written.
    if shows_changed_arrows:
        for kind, style in _LINK_STYLES.items():
            lines = [str(at) for at, arrow in enumerate(graph.arrows) if arrow.change == kind and not arrow.broken]
            if lines:
                yield f"  linkStyle {','.join(lines)} {style}"
    broken_lines = [str(at) for at, arrow in enumerate(graph.arrows) if arrow.broken]
    if broken_lines:
        yield f"  linkStyle {','.join(broken_lines)} {_BROKEN_STYLE}"


def _label_text(text: str) -> str:
    """Return one line of a label, shortened."""
    line = " ".join(text.split())
    line = line if len(line) <= _MAX_LABEL_LENGTH else f"{line[: _MAX_LABEL_LENGTH - 1]}…"
    # Mermaid reads labels as Markdown, and some beginnings as a list: a zero-width space prevents that.
    return ("#8203;" if _LIST_START.match(line) else "") + escape_mermaid(line)


_MAX_MERMAID_ARROWS = 40


def fold_for_mermaid(graph: Graph) -> Graph:
    """Fold a graph with too many arrows: what runs between a neighbour and a frame becomes one arrow, then frames become
    boxes.
    """
    if len(graph.arrows) <= _MAX_MERMAID_ARROWS:
        return graph
    merged_graph = _lead_to_frames(graph)
    return (
        merged_graph
        if len(merged_graph.arrows) <= _MAX_MERMAID_ARROWS
        else fold_graph(merged_graph, _MAX_MERMAID_ARROWS)
    )


def _lead_to_frames(graph: Graph) -> Graph:
    """Lead arrows that cross a frame to the frame itself, one for all with the same ends."""
    frame_ids = {cluster.id for cluster in graph.clusters}
    frames = {box.id: box.cluster for box in graph.boxes if box.cluster in frame_ids}
    bundles: dict[tuple[str, str], list[Arrow]] = {}
    arrows = []
    for arrow in graph.arrows:
        tail_frame, head_frame = frames.get(arrow.tail), frames.get(arrow.head)
        if tail_frame == head_frame:
            arrows.append(arrow)
        else:
            bundles.setdefault((tail_frame or arrow.tail, head_frame or arrow.head), []).append(arrow)
    for (tail, head), bundle in bundles.items():
        first = replace(bundle[0], tail=tail, head=head, tail_port=None, head_port=None)
        flows = tuple(flow for arrow in bundle for flow in arrow.flows)
        count = sum(arrow.count for arrow in bundle)
        style = first.style if len({arrow.style for arrow in bundle}) == 1 else "data"
        label = first.label if len(bundle) == 1 else ""
        arrows.append(replace(first, label=label, style=style, count=count, flows=flows))
    return replace(graph, arrows=tuple(arrows))


_MAX_LENGTH = 60
_ARROWS = {"service": "-->>", "action": "-->>", "broken": "-x"}


def write_sequence_diagram(chart: SequenceChart) -> Iterator[str]:
    """Yield the lines of a sequence diagram. Who takes part is `p0`, `p1`: no text of the model is a name or a word of Mermaid."""
    yield "sequenceDiagram"
    yield from (f"  {_write_lifeline(at, lifeline)}" for at, lifeline in enumerate(chart.lifelines))
    yield from (f"  {_write_message(message)}" for message in chart.messages)


def _write_lifeline(at: int, lifeline: Lifeline) -> str:
    word = "actor" if lifeline.kind == "actor" else "participant"
    return f"{word} p{at} as {_escape_text(lifeline.title)}"


def _write_message(message: SequenceMessage) -> str:
    arrow = _ARROWS.get(message.style, "->>")
    details = [part for part in message.detail.split("\n") if part]
    # The number comes first, so that no text can begin with a word that Mermaid knows.
    words = "<br>".join([_escape_text(f"{message.number} {message.text}"), *map(_escape_text, details)])
    return f"p{message.tail}{arrow}p{message.head}: {words}"


def _escape_text(text: str) -> str:
    line = " ".join(text.split())
    line = line if len(line) <= _MAX_LENGTH else f"{line[: _MAX_LENGTH - 1]}…"
    # A colon may begin a directive (`wrap:`).
    return escape_mermaid(line).replace(":", "#58;")
