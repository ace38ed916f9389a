"""Write a graph as a Mermaid flowchart. What changed between two versions is shown by signs, lines and colours."""

from __future__ import annotations

import re
from collections.abc import Iterator

from archgen.emit.text import template_filters
from archgen.views.shapes import Arrow, Box, ElementChange, Graph

_MAX_LABEL_LENGTH = 60
_BOX_SHAPES = {"topic": "[]", "service": "{{}}", "action": "{{}}", "node": "([])"}
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
_ARROW_SIGNS = {"service": "-.->", "action": "==>", "physical": "-.->"}


def write_flowchart(graph: Graph) -> Iterator[str]:
    """Yield the lines of a flowchart. Boxes are `n0`, `n1`: no text of the model is a name or a word of Mermaid."""
    names = {box.id: f"n{at}" for at, box in enumerate(graph.boxes)}
    yield f"flowchart {'LR' if graph.direction == 'left-right' else 'TB'}"
    cluster_ids = {cluster.id for cluster in graph.clusters}
    for at, cluster in enumerate(graph.clusters):
        yield f'  subgraph g{at}["{_label_text(cluster.title)}"]'
        yield from (f"    {_write_box(box, names)}" for box in graph.boxes if box.cluster == cluster.id)
        yield "  end"
    yield from (f"  {_write_box(box, names)}" for box in graph.boxes if box.cluster not in cluster_ids)
    yield from (f"  {_write_arrow(arrow, names)}" for arrow in graph.arrows)
    yield from _write_styles(graph)


def _write_box(box: Box, names: dict[str, str]) -> str:
    shape = "[[]]" if box.change == "changed" and box.style not in _BOX_SHAPES else _BOX_SHAPES.get(box.style, "()")
    half = len(shape) // 2
    text = "<br>".join(_label_text(line) for line in (box.title, *box.lines))
    style_class = box.change or ("neighbour" if box.emphasis == "neighbour" else "")
    return f'{names[box.id]}{shape[:half]}"{text}"{shape[half:]}' + (f":::{style_class}" if style_class else "")


def _write_arrow(arrow: Arrow, names: dict[str, str]) -> str:
    line = _ARROW_SIGNS.get(arrow.style, "-->")
    label = "<br>".join(_label_text(line) for line in arrow.label.split("\n")) if arrow.label else ""
    return f"{names[arrow.tail]} {line}" + (f'|"{label}"|' if label else "") + f" {names[arrow.head]}"


def _write_styles(graph: Graph) -> Iterator[str]:
    kinds = {box.change for box in graph.boxes}
    yield from (f"  classDef {kind} {style}" for kind, style in _BOX_STYLES.items() if kind in kinds)
    if any(box.emphasis == "neighbour" and not box.change for box in graph.boxes):
        yield "  classDef neighbour stroke:#8a8a8a,stroke-width:1px"
    for kind, style in _LINK_STYLES.items() if any(arrow.change for arrow in graph.arrows) else ():
        # linkStyle addresses arrows by their position, so all of them must be counted in the order written.
        lines = [str(at) for at, arrow in enumerate(graph.arrows) if arrow.change == kind]
        if lines:
            yield f"  linkStyle {','.join(lines)} {style}"


def _label_text(text: str) -> str:
    """Return one line of a label, shortened."""
    line = " ".join(text.split())
    line = line if len(line) <= _MAX_LABEL_LENGTH else f"{line[: _MAX_LABEL_LENGTH - 1]}…"
    # Mermaid reads labels as Markdown, and some beginnings as a list: a zero-width space prevents that.
    return ("#8203;" if _LIST_START.match(line) else "") + template_filters.escape_mermaid(line)
