"""Style arrows and the labels beside them.

| style | line |
|---|---|
| data | solid, filled head; optional input: hollow head |
| physical | double line |
| service | dashed, open head, from client to server |
| action | bold, double head, from client to server |
| internal | dotted |
| link | thick, without head |

Where two versions are drawn: what is added is thick, what is removed dashed, what changed a double line.

An arrow that stands for several flows is wider: 1, 2 to 3, 4 and more flows are 1, 2 and 3.2 points.
"""

from __future__ import annotations

from archgen.emit.graphviz import palette
from archgen.emit.graphviz.marks import FONT, Link, linked
from archgen.emit.graphviz.text import html, quoted, wrapped
from archgen.views.shapes import Arrow

Attributes = dict[str, str]

WIDTHS = ((4, "3.2"), (2, "2"), (1, "1"))
"""The pen width by the least number of flows, the largest first."""


def width(count: int) -> str:
    """Return the pen width of an arrow that stands for `count` flows."""
    return next((pen for least, pen in WIDTHS if count >= least), "1")


def arrow(item: Arrow, link: Link, *, merged: bool = False) -> Attributes:
    """Return the DOT attributes of an arrow, without its label."""
    colour = _colour(item)
    classes = [
        "arrow",
        item.style,
        *(["faded"] if item.faded else []),
        *([f"change-{item.change}"] if item.change else []),
    ]
    found = {
        "class": quoted(" ".join(classes)),
        "color": f'"{colour}"',
        "arrowsize": "0.6",
        "penwidth": width(item.count) if merged else "0.8",
        **_form(item, colour),
        **_tooltip(item, link),
    }
    if merged:
        # Graphviz scales heads with the pen: wider lines need a smaller factor for heads of about the same size.
        found["arrowsize"] = {"1": "0.7", "2": "0.6", "3.2": "0.5"}[width(item.count)]
    return {**found, **_changed(item, colour)} if item.change else found


def _colour(item: Arrow) -> str:
    if item.change is not None:
        return palette.CHANGES[item.change]
    return palette.FADED if item.faded else palette.EDGE if item.colour is None else palette.hue(item.colour)


def _changed(item: Arrow, colour: str) -> Attributes:
    """Return attributes that show what happened by the line. The head still shows what runs along it."""
    if item.change == "added":
        return {"style": '"solid"', "color": f'"{colour}"', "penwidth": "2.2", "arrowsize": "0.5"}
    if item.change == "removed":
        return {"style": '"dashed"', "color": f'"{colour}"', "penwidth": "1.3"}
    return {"style": '"solid"', "color": f'"{colour}:{palette.PAPER}:{colour}"', "penwidth": "1.1"}


def _form(item: Arrow, colour: str) -> Attributes:
    if item.style == "service":
        return {"style": '"dashed"', "arrowhead": '"vee"'}
    if item.style == "action":
        return {"style": '"bold"', "penwidth": "1.6", "arrowhead": '"normalnormal"'}
    if item.style == "physical":
        return {"color": f'"{colour}:{palette.PAPER}:{colour}"'}
    if item.style == "internal":
        return {"style": '"dotted"', "penwidth": "1.2"}
    if item.style == "link":
        return {"arrowhead": '"none"', "penwidth": "2"}
    return {"arrowhead": '"onormal"'} if item.optional else {}


def _tooltip(item: Arrow, link: Link) -> Attributes:
    found = linked(item.ref, "\n".join(item.flows) or item.label or "flow", link)
    # Graphviz has two tooltips for an edge: on its line (`edgetooltip`) and on the edge as a whole; both say the same.
    return {("edgetooltip" if name == "tooltip" else name): value for name, value in found.items()} | {
        "tooltip": found["tooltip"]
    }


def label(item: Arrow, link: Link, *, merged: bool = False, at: int = 20) -> Attributes | None:
    """Return the DOT attributes of an arrow's label, a part of its own on paper-coloured ground; None if it has no
    text.
    """
    text = item.label or (str(item.count) if merged and item.count > 1 else "")
    if not text:
        return None
    ink = palette.MUTED if item.faded else palette.hue(item.colour) if item.colour is not None else palette.TEXT
    ink = palette.CHANGES[item.change] if item.change else ink
    rows = "<BR/>".join(html(row) for line in text.split("\n") for row in wrapped(line, at, 3))
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
        "fontname": f'"{FONT}"',
        "label": f'<<FONT POINT-SIZE="8" COLOR="{ink}">{rows}</FONT>>',
        **linked(item.ref, "\n".join(item.flows) or text, link),
    }
