"""Style arrows and the labels beside them.

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

from archgen.emit.graphviz import palette
from archgen.emit.graphviz.box_styles import LinkResolver, link_attributes
from archgen.emit.graphviz.dot_text import escape_label, quote_value, wrap_text
from archgen.emit.graphviz.placed_scene import FONT_NAME, DotAttributes
from archgen.views.picture_shapes import Arrow

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
