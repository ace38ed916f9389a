"""Give a graph its DOT names and attributes, write it for a layout, and read the layout back.

Ids of the model never get into DOT text: boxes are `n0`, `n1`, arrows `e0`, `e1`, in the graph's order. So no id can
break the syntax, and a layout does not depend on what things are called.

Arrows say by their style what they are:

| style | line |
|---|---|
| data | solid, filled head; optional input: hollow head |
| physical | double line |
| service | dashed, open head, from client to server |
| action | bold, double head, from client to server |
| internal | dotted |
| made by autoconnect | dotted, with the head of what runs along it |
| link | thick, without head |
| no ROS | a square behind the head |

Where two versions are drawn: what is added is thick, what is removed dashed, what changed a double line, what breaks
another partner heavy and red.

An arrow that stands for several flows is wider: 1, 2 to 3, 4 and more flows are 1, 2 and 3.2 points.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from archgen.emit.graphviz import box_styles, layout_engine, palette
from archgen.emit.graphviz.box_styles import LinkResolver, link_attributes
from archgen.emit.graphviz.dot_text import escape_label, quote_value, wrap_text
from archgen.emit.graphviz.label_places import sample_line
from archgen.emit.graphviz.placed_scene import (
    DOT_DEFAULTS,
    FONT_NAME,
    DotAttributes,
    Scene,
    ScenePart,
    format_attributes,
    read_scene,
)
from archgen.frozen import dataclass
from archgen.views.picture_shapes import Arrow, Box, Cluster, Graph


@dataclass(frozen=True, slots=True)
class StyledGraph:
    """A graph with the DOT names and attributes of its boxes, arrows and arrow labels.

    `dot_names` maps box ids to DOT names. The other mappings have DOT names (`n0`, `e0`) as keys; an arrow comes with
    its id.
    """

    graph: Graph
    resolve_link: LinkResolver
    dot_names: dict[str, str]
    box_attributes: dict[str, DotAttributes]
    arrow_attributes: dict[str, tuple[str, DotAttributes]]
    label_attributes: dict[str, DotAttributes]

    def write_node(self, box: Box) -> str:
        """Return a box as a DOT statement."""
        name = self.dot_names[box.id]
        return f"{name} [{format_attributes(self.box_attributes[name])}];"

    def write_edge(self, index: int, arrow: Arrow, *, with_text: bool = True, is_free: bool = False) -> str:
        """Return an arrow as a DOT statement, with its text if the layout shall find room for it. A number is set on
        the line. With `is_free` it may run in any direction.
        """
        # A number needs no room of its own: it is placed on the line afterwards, and the layout stays denser.
        with_text = with_text and not arrow.label.isdigit()
        endpoints = [self.dot_names[arrow.tail] + self._write_port(arrow.tail, arrow.tail_port)]
        endpoints.append(self.dot_names[arrow.head] + self._write_port(arrow.head, arrow.head_port))
        attributes = self.arrow_attributes[f"e{index}"][1]
        # `dir=back` (see `_reverse_arrow`): with its ends swapped, dot ranks the head's box before the tail's, and the
        # arrow head is still drawn where it belongs.
        if "dir" in attributes:
            endpoints.reverse()
        label = (
            f" label={self.label_attributes[f'e{index}']['label']}"
            if with_text and f"e{index}" in self.label_attributes
            else ""
        )
        line_attributes = {name: attributes[name] for name in _LAYOUT_ATTRIBUTES if name in attributes}
        line_attributes |= {"constraint": '"false"'} if is_free else {}
        return f'{" -> ".join(endpoints)} [id="e{index}"{label} {format_attributes(line_attributes)}];'

    def _write_port(self, box_id: str, port_name: str | None) -> str:
        """Return where an arrow ends at a box with ports: inputs at its left, outputs at its right."""
        if port_name is None:
            return ""
        box = next((each for each in self.graph.boxes if each.id == box_id), None)
        if box is None:
            return ""
        rows = [(name, f":i{at}:w") for at, (name, _) in enumerate(box.ports_in)]
        rows += [(name, f":o{at}:e") for at, (name, _) in enumerate(box.ports_out)]
        return dict(rows).get(port_name, "")


_LAYOUT_ATTRIBUTES = ("arrowsize", "penwidth", "arrowhead", "arrowtail", "dir")
"""The attributes of an arrow that change its line, so the layout must know them."""


def style_graph(graph: Graph, resolve_link: LinkResolver, *, merged: bool = False) -> StyledGraph:
    """Name everything and choose its attributes.

    `merged` draws an arrow's number of flows as its width, and as its text where it has none.
    """
    dot_names = {item.id: f"n{at}" for at, item in enumerate(graph.boxes)}
    label_attributes = {
        f"e{at}": style_label(item, resolve_link, merged=merged) for at, item in enumerate(graph.arrows)
    }
    side_of_box = {item.id: item.side for item in graph.boxes}
    arrow_looks = [style_arrow(item, resolve_link, merged=merged) for item in graph.arrows]
    arrows = [
        (
            item.id,
            _reverse_arrow(look)
            if side_of_box.get(item.head) == "left" or side_of_box.get(item.tail) == "right"
            else look,
        )
        for item, look in zip(graph.arrows, arrow_looks, strict=True)
    ]
    return StyledGraph(
        graph,
        resolve_link,
        dot_names,
        {dot_names[item.id]: box_styles.style_box(item, resolve_link) for item in graph.boxes},
        {f"e{at}": arrow for at, arrow in enumerate(arrows)},
        {edge: attributes for edge, attributes in label_attributes.items() if attributes},
    )


def _reverse_arrow(attributes: DotAttributes) -> DotAttributes:
    """Reverse an arrow for the layout: a client may be to the right of its server, so `back` draws the head at the
    tail.
    """
    reversed_attributes = {name: value for name, value in attributes.items() if name != "arrowhead"}
    return {**reversed_attributes, "dir": '"back"', "arrowtail": attributes.get("arrowhead", '"normal"')}


def write_dot(settings: str, statements: Iterable[str]) -> str:
    """Return a DOT graph of settings and statements, for a layout."""
    return "\n".join(["digraph g {", f"graph [{settings}];", DOT_DEFAULTS, *statements, "}"])


def read_layout(styled_graph: StyledGraph, layout: dict[str, object]) -> Scene:
    """Read a layout back. The arrows' texts become parts of their own, where the layout put them."""
    scene = read_scene(layout, styled_graph.box_attributes, styled_graph.arrow_attributes)
    label_points = {
        str(item["id"]): str(item["lp"])
        for item in layout.get("edges", [])  # type: ignore[attr-defined]
        if "lp" in item and item.get("id") in styled_graph.label_attributes
    }
    sizes = measure_nodes([styled_graph.label_attributes[edge] for edge in label_points])
    labels = tuple(
        ScenePart(f"l{edge[1:]}", styled_graph.label_attributes[edge], *_parse_point(spot), *size, kind="label")
        for (edge, spot), size in zip(label_points.items(), sizes, strict=True)
    )
    return scene.joined(Scene(parts=labels))


def place_labels_on_lines(styled_graph: StyledGraph, scene: Scene) -> Scene:
    """Place each text that has no place yet on the middle of its arrow."""
    placed_names = {part.name for part in scene.parts if part.kind == "label"}
    lines = [
        line
        for line in scene.lines
        if f"e{line.edge}" in styled_graph.label_attributes and f"l{line.edge}" not in placed_names
    ]
    sizes = measure_nodes([styled_graph.label_attributes[f"e{line.edge}"] for line in lines])
    parts = []
    for line, size in zip(lines, sizes, strict=True):
        points = list(sample_line(line))
        parts.append(
            ScenePart(
                f"l{line.edge}",
                styled_graph.label_attributes[f"e{line.edge}"],
                *points[len(points) // 2],
                *size,
                kind="label",
            )
        )
    return scene.joined(Scene(parts=tuple(parts)))


def _parse_point(text: str) -> tuple[float, float]:
    x, y = text.split(",")
    return float(x), float(y)


def measure_nodes(attribute_sets: Sequence[DotAttributes]) -> tuple[tuple[float, float], ...]:
    """Return the width and height, in points, that nodes with these attributes take."""
    dot_texts = [format_attributes(each) for each in attribute_sets]
    unmeasured = [text for text in dict.fromkeys(dot_texts) if text not in _MEASURED_SIZES]
    if unmeasured:
        # Only Graphviz knows how wide a text gets in its font. `nop2` lays nothing out, so all texts can be at one
        # place.
        nodes = (f'm{at} [{text} pos="0,0"];' for at, text in enumerate(unmeasured))
        objects = layout_engine.lay_out_dot(write_dot("", nodes), "nop2")["objects"]
        sizes = {item["name"]: (float(item["width"]) * 72, float(item["height"]) * 72) for item in objects}
        _MEASURED_SIZES.update((text, sizes[f"m{at}"]) for at, text in enumerate(unmeasured))
    return tuple(_MEASURED_SIZES[text] for text in dot_texts)


_MEASURED_SIZES: dict[str, tuple[float, float]] = {}
"""Sizes by DOT text, for the life of the process: pictures of one project show the same texts again and again."""


def title_attributes(cluster: Cluster) -> DotAttributes:
    """Return the attributes of a frame's title, a text on the frame's own fill."""
    text_colour = palette.MUTED if cluster.emphasis == "neighbour" else palette.hue_colour(cluster.colour)
    rows = "<BR/>".join(f"<B>{escape_label(row)}</B>" for row in wrap_text(cluster.title, 40, 2))
    detail_rows = '<BR ALIGN="LEFT"/>'.join(
        f'<FONT POINT-SIZE="7.5" COLOR="{palette.MUTED}">{escape_label(line)}</FONT>' for line in cluster.lines
    )
    if detail_rows:
        rows, detail_rows = f'{rows}<BR ALIGN="LEFT"/>', detail_rows + '<BR ALIGN="LEFT"/>'
    return {
        "shape": '"box"',
        "style": '"filled"',
        "class": '"title"',
        "color": f'"{palette.PAPER}00"',
        "fillcolor": f'"{choose_frame_fill(cluster)}"',
        "penwidth": "0",
        "margin": '"0.03,0.01"',
        "width": "0.1",
        "height": "0.1",
        "fontname": f'"{FONT_NAME}"',
        "fontsize": "11",
        "label": f'<<FONT COLOR="{text_colour}">{rows}</FONT>{detail_rows}>',
    }


def choose_frame_fill(cluster: Cluster) -> str:
    """Return the fill of a frame."""
    return (
        palette.mix_tint(palette.hue_colour(cluster.colour)) if cluster.emphasis != "neighbour" else palette.GREY_TINT
    )


def frame_attributes(cluster: Cluster, resolve_link: LinkResolver) -> DotAttributes:
    """Return the attributes of a frame."""
    is_neighbour = cluster.emphasis == "neighbour"
    colour = palette.NEIGHBOUR_FRAME if is_neighbour else palette.hue_colour(cluster.colour)
    classes = f"frame {cluster.emphasis}" + (f" hue{cluster.colour}" if cluster.colour is not None else "")
    return {
        "style": '"filled,rounded"',
        "class": quote_value(classes),
        "color": f'"{colour}"',
        "fillcolor": f'"{choose_frame_fill(cluster)}"',
        "penwidth": "2" if cluster.emphasis == "subject" else "1.2",
        **box_styles.link_attributes(
            cluster.ref, cluster.tooltip or "\n".join((cluster.title, *cluster.lines)), resolve_link
        ),
    }


PEN_WIDTHS = ((4, "3.2"), (2, "2"), (1, "1"))
"""The pen width by the least number of flows, the largest first."""


def pen_width(count: int) -> str:
    """Return the pen width of an arrow that stands for `count` flows."""
    return next((pen for least, pen in PEN_WIDTHS if count >= least), "1")


def style_arrow(arrow: Arrow, resolve_link: LinkResolver, *, merged: bool = False) -> DotAttributes:
    """Return the DOT attributes of an arrow, without its label."""
    colour = _arrow_colour(arrow)
    classes = [
        "arrow",
        arrow.style,
        *(["faded"] if arrow.faded else []),
        *([f"change-{arrow.change}"] if arrow.change else []),
        *(["broken"] if arrow.broken else []),
    ]
    attributes = {
        "class": quote_value(" ".join(classes)),
        "color": f'"{colour}"',
        "arrowsize": "0.6",
        "penwidth": pen_width(arrow.count) if merged else "0.8",
        **_add_square(arrow, _form_attributes(arrow, colour)),
        **({"style": '"dotted"', "penwidth": "1.2"} if arrow.is_made else {}),
        **_tooltip_attributes(arrow, resolve_link),
    }
    if merged:
        # Graphviz scales heads with the pen: wider lines need a smaller factor for heads of about the same size.
        attributes["arrowsize"] = {"1": "0.7", "2": "0.6", "3.2": "0.5"}[pen_width(arrow.count)]
    if arrow.broken:
        # Red and heavy, with the head of what runs along it; dashed where it is gone.
        line = "dashed" if arrow.change == "removed" else "solid"
        return {**attributes, "style": f'"{line}"', "color": f'"{colour}"', "penwidth": "2.6", "arrowsize": "0.5"}
    return {**attributes, **_change_attributes(arrow, colour)} if arrow.change else attributes


def _arrow_colour(arrow: Arrow) -> str:
    if arrow.broken:
        return palette.ERROR
    if arrow.change is not None:
        return palette.CHANGES[arrow.change]
    return palette.FADED if arrow.faded else palette.EDGE if arrow.colour is None else palette.hue_colour(arrow.colour)


def _change_attributes(arrow: Arrow, colour: str) -> DotAttributes:
    """Return attributes that show what happened by the line. The head still shows what runs along it."""
    if arrow.change == "added":
        return {"style": '"solid"', "color": f'"{colour}"', "penwidth": "2.2", "arrowsize": "0.5"}
    if arrow.change == "removed":
        return {"style": '"dashed"', "color": f'"{colour}"', "penwidth": "1.3"}
    return {"style": '"solid"', "color": f'"{colour}:{palette.PAPER}:{colour}"', "penwidth": "1.1"}


def _form_attributes(arrow: Arrow, colour: str) -> DotAttributes:
    if arrow.style == "service":
        return {"style": '"dashed"', "arrowhead": '"vee"'}
    if arrow.style == "action":
        return {"style": '"bold"', "penwidth": "1.6", "arrowhead": '"normalnormal"'}
    if arrow.style == "physical":
        return {"color": f'"{colour}:{palette.PAPER}:{colour}"'}
    if arrow.style == "internal":
        return {"style": '"dotted"', "penwidth": "1.2"}
    if arrow.style == "link":
        return {"arrowhead": '"none"', "penwidth": "2"}
    return {"arrowhead": '"onormal"'} if arrow.optional else {}


def _add_square(arrow: Arrow, attributes: DotAttributes) -> DotAttributes:
    """Return attributes with the sign of what is data but no ROS behind the head."""
    if not arrow.medium:
        return attributes
    head = attributes.get("arrowhead", '"normal"').strip('"')
    return {**attributes, "arrowhead": f'"{head}obox"'}


def _tooltip_attributes(arrow: Arrow, resolve_link: LinkResolver) -> DotAttributes:
    attributes = link_attributes(arrow.ref, "\n".join(arrow.flows) or arrow.label or "flow", resolve_link)
    # Graphviz has two tooltips for an edge: on its line (`edgetooltip`) and on the edge as a whole; both say the same.
    return {("edgetooltip" if name == "tooltip" else name): value for name, value in attributes.items()} | {
        "tooltip": attributes["tooltip"]
    }


def style_label(
    arrow: Arrow, resolve_link: LinkResolver, *, merged: bool = False, line_width: int = 20
) -> DotAttributes | None:
    """Return the DOT attributes of an arrow's label, a part of its own on paper-coloured ground; None if it has no
    text.
    """
    text = arrow.label or (str(arrow.count) if merged and arrow.count > 1 else "")
    if not text:
        return None
    text_colour = (
        palette.MUTED if arrow.faded else palette.hue_colour(arrow.colour) if arrow.colour is not None else palette.TEXT
    )
    text_colour = palette.CHANGES[arrow.change] if arrow.change else text_colour
    text_colour = palette.ERROR if arrow.broken else text_colour
    rows = "<BR/>".join(escape_label(row) for line in text.split("\n") for row in wrap_text(line, line_width, 3))
    return {
        "shape": '"box"',
        "style": '"filled,rounded"',
        "class": '"label"',
        "color": f'"{palette.PAPER}00"',
        "fillcolor": f'"{palette.PAPER}e0"',
        "penwidth": "0",
        "margin": '"0.02,0.005"',
        "width": "0.05",
        "height": "0.05",
        "fontname": f'"{FONT_NAME}"',
        "label": f'<<FONT POINT-SIZE="8" COLOR="{text_colour}">{rows}</FONT>>',
        **link_attributes(arrow.ref, "\n".join(arrow.flows) or text, resolve_link),
    }
