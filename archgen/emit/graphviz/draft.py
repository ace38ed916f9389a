"""Give a graph its DOT names and attributes, write it for a layout, and read the layout back.

Ids of the model never get into DOT text: boxes are `n0`, `n1`, arrows `e0`, `e1`, in the graph's order. So no id can
break the syntax, and a layout does not depend on what things are called.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from archgen.emit.graphviz import engine, marks, palette, strokes
from archgen.emit.graphviz.engine import written
from archgen.emit.graphviz.labels import along
from archgen.emit.graphviz.marks import FONT, Link
from archgen.emit.graphviz.scene import DEFAULTS, Part, Scene, placed
from archgen.emit.graphviz.text import html, quoted, wrapped
from archgen.views.shapes import Arrow, Box, Cluster, Graph

Attributes = dict[str, str]


@dataclass(frozen=True, slots=True)
class Draft:
    """A graph with the DOT names and attributes of its boxes, arrows and arrow labels.

    `dot_names` maps box ids to DOT names. The other mappings have DOT names (`n0`, `e0`) as keys; an arrow comes with
    its id.
    """

    graph: Graph
    link: Link
    names: dict[str, str]
    boxes: dict[str, Attributes]
    arrows: dict[str, tuple[str, Attributes]]
    labels: dict[str, Attributes]

    def node(self, item: Box) -> str:
        """Return a box as a DOT statement."""
        name = self.names[item.id]
        return f"{name} [{written(self.boxes[name])}];"

    def edge(self, at: int, item: Arrow, *, text: bool = True) -> str:
        """Return an arrow as a DOT statement, with its text if the layout shall find room for it. A number is set on
        the line.
        """
        # A number needs no room of its own: it is placed on the line afterwards, and the layout stays denser.
        text = text and not item.label.isdigit()
        ends = [self.names[item.tail] + self._port(item.tail, item.tail_port)]
        ends.append(self.names[item.head] + self._port(item.head, item.head_port))
        attributes = self.arrows[f"e{at}"][1]
        # `dir=back` (see `_reverse_arrow`): with its ends swapped, dot ranks the head's box before the tail's, and the
        # arrow head is still drawn where it belongs.
        if "dir" in attributes:
            ends.reverse()
        label = f" label={self.labels[f'e{at}']['label']}" if text and f"e{at}" in self.labels else ""
        kept = {name: attributes[name] for name in _SIZES if name in attributes}
        return f'{" -> ".join(ends)} [id="e{at}"{label} {written(kept)}];'

    def _port(self, box: str, port: str | None) -> str:
        """Return where an arrow ends at a box with ports: inputs at its left, outputs at its right."""
        item = next((each for each in self.graph.boxes if each.id == box), None)
        if item is None or port is None:
            return ""
        rows = [(name, f":i{at}:w") for at, (name, _) in enumerate(item.ports_in)]
        rows += [(name, f":o{at}:e") for at, (name, _) in enumerate(item.ports_out)]
        return dict(rows).get(port, "")


_SIZES = ("arrowsize", "penwidth", "arrowhead", "arrowtail", "dir")
"""The attributes of an arrow that change its line, so the layout must know them."""


def draft(graph: Graph, link: Link, *, merged: bool = False) -> Draft:
    """Name everything and choose its attributes.

    `merged` draws an arrow's number of flows as its width, and as its text where it has none.
    """
    names = {item.id: f"n{at}" for at, item in enumerate(graph.boxes)}
    texts = {f"e{at}": strokes.label(item, link, merged=merged) for at, item in enumerate(graph.arrows)}
    sides = {item.id: item.side for item in graph.boxes}
    looks = [strokes.arrow(item, link, merged=merged) for item in graph.arrows]
    arrows = [
        (item.id, _turned(look) if sides.get(item.head) == "left" or sides.get(item.tail) == "right" else look)
        for item, look in zip(graph.arrows, looks, strict=True)
    ]
    return Draft(
        graph,
        link,
        names,
        {names[item.id]: marks.box(item, link) for item in graph.boxes},
        {f"e{at}": arrow for at, arrow in enumerate(arrows)},
        {edge: attributes for edge, attributes in texts.items() if attributes},
    )


def _turned(look: Attributes) -> Attributes:
    """Reverse an arrow for the layout: a client may be to the right of its server, so `back` draws the head at the
    tail.
    """
    turned = {name: value for name, value in look.items() if name != "arrowhead"}
    return {**turned, "dir": '"back"', "arrowtail": look.get("arrowhead", '"normal"')}


def document(settings: str, statements: Iterable[str]) -> str:
    """Return a DOT graph of settings and statements, for a layout."""
    return "\n".join(["digraph g {", f"graph [{settings}];", DEFAULTS, *statements, "}"])


def read(drafted: Draft, layout: dict[str, object]) -> Scene:
    """Read a layout back. The arrows' texts become parts of their own, where the layout put them."""
    scene = placed(layout, drafted.boxes, drafted.arrows)
    spots = {
        str(item["id"]): str(item["lp"])
        for item in layout.get("edges", [])  # type: ignore[attr-defined]
        if "lp" in item and item.get("id") in drafted.labels
    }
    sizes = measure([drafted.labels[edge] for edge in spots])
    labels = tuple(
        Part(f"l{edge[1:]}", drafted.labels[edge], *_spot(spot), *size, kind="label")
        for (edge, spot), size in zip(spots.items(), sizes, strict=True)
    )
    return scene.joined(Scene(parts=labels))


def on_lines(drafted: Draft, scene: Scene) -> Scene:
    """Place each text that has no place yet on the middle of its arrow."""
    done = {part.name for part in scene.parts if part.kind == "label"}
    lines = [line for line in scene.lines if f"e{line.edge}" in drafted.labels and f"l{line.edge}" not in done]
    sizes = measure([drafted.labels[f"e{line.edge}"] for line in lines])
    parts = []
    for line, size in zip(lines, sizes, strict=True):
        points = list(along(line))
        parts.append(
            Part(f"l{line.edge}", drafted.labels[f"e{line.edge}"], *points[len(points) // 2], *size, kind="label")
        )
    return scene.joined(Scene(parts=tuple(parts)))


def _spot(text: str) -> tuple[float, float]:
    x, y = text.split(",")
    return float(x), float(y)


def measure(labels: Sequence[Attributes]) -> tuple[tuple[float, float], ...]:
    """Return the width and height, in points, that nodes with these attributes take."""
    wanted = [written(each) for each in labels]
    new = [text for text in dict.fromkeys(wanted) if text not in _SIZES_KNOWN]
    if new:
        # Only Graphviz knows how wide a text gets in its font. `nop2` lays nothing out, so all texts can be at one
        # place.
        nodes = (f'm{at} [{text} pos="0,0"];' for at, text in enumerate(new))
        objects = engine.layout(document("", nodes), "nop2")["objects"]
        sizes = {item["name"]: (float(item["width"]) * 72, float(item["height"]) * 72) for item in objects}
        _SIZES_KNOWN.update((text, sizes[f"m{at}"]) for at, text in enumerate(new))
    return tuple(_SIZES_KNOWN[text] for text in wanted)


_SIZES_KNOWN: dict[str, tuple[float, float]] = {}
"""Sizes by DOT text, for the life of the process: pictures of one project show the same texts again and again."""


def title(item: Cluster) -> Attributes:
    """Return the attributes of a frame's title, a text on the frame's own fill."""
    ink = palette.MUTED if item.emphasis == "neighbour" else palette.hue(item.colour)
    rows = "<BR/>".join(f"<B>{html(row)}</B>" for row in wrapped(item.title, 40, 2))
    small = '<BR ALIGN="LEFT"/>'.join(
        f'<FONT POINT-SIZE="7.5" COLOR="{palette.MUTED}">{html(line)}</FONT>' for line in item.lines
    )
    if small:
        rows, small = f'{rows}<BR ALIGN="LEFT"/>', small + '<BR ALIGN="LEFT"/>'
    return {
        "shape": '"box"',
        "style": '"filled"',
        "class": '"title"',
        "color": f'"{palette.PAPER}00"',
        "fillcolor": f'"{frame_fill(item)}"',
        "penwidth": "0",
        "margin": '"0.03,0.01"',
        "width": "0.1",
        "height": "0.1",
        "fontname": f'"{FONT}"',
        "fontsize": "11",
        "label": f'<<FONT COLOR="{ink}">{rows}</FONT>{small}>',
    }


def frame_fill(item: Cluster) -> str:
    """Return the fill of a frame."""
    return palette.tint(palette.hue(item.colour)) if item.emphasis != "neighbour" else palette.GREY_TINT


def frame(item: Cluster, link: Link) -> Attributes:
    """Return the attributes of a frame."""
    grey = item.emphasis == "neighbour"
    colour = palette.NEIGHBOUR_FRAME if grey else palette.hue(item.colour)
    classes = f"frame {item.emphasis}" + (f" hue{item.colour}" if item.colour is not None else "")
    return {
        "style": '"filled,rounded"',
        "class": quoted(classes),
        "color": f'"{colour}"',
        "fillcolor": f'"{frame_fill(item)}"',
        "penwidth": "2" if item.emphasis == "subject" else "1.2",
        **marks.linked(item.ref, item.tooltip or "\n".join((item.title, *item.lines)), link),
    }
