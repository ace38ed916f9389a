"""How the parts of a chart look: stretches by their kind, thin lines and texts, as attributes for Graphviz.

Each kind of stretch has a form beside its colour: waiting is pale with a dotted frame, response solid, a link striped,
the unknown hatched with a question mark.
"""

from __future__ import annotations

from archgen.emit.graphviz import palette
from archgen.emit.graphviz.box_styles import LinkResolver, link_attributes
from archgen.emit.graphviz.dot_text import escape_label, quote_value, wrap_text
from archgen.emit.graphviz.placed_scene import DotAttributes, ScenePart
from archgen.emit.graphviz.styled_graph import measure_nodes
from archgen.views.picture_shapes import BarSegment

BAR_HEIGHT = 14.0
"""In points, as all lengths here."""
_PLAIN_NODE = {"shape": '"plain"'}
_TITLE_CHARACTERS = 26
"""Characters in a line of a title."""
STRETCH_FORMS: dict[str, tuple[str, str, str]] = {
    "sampling": ("filled,dotted", "#deebf7", "waits for the next activation"),
    "response": ("filled", "#2171b5", "responds"),
    "link": ("striped", "#f7cf9c:#fdf0de", "on the network"),
    "load": ("filled", "#2171b5", ""),
    "other_load": ("filled,dotted", "#9ecae1", ""),
    "met": ("filled", palette.OK, ""),
    "missed": ("filled", palette.ERROR, ""),
    "late_wait": ("filled,dotted", "#f8d7d4", "waits"),
    "unproven": ("filled", palette.WARNING, ""),
    "open": ("filled", palette.NEIGHBOUR_FRAME, ""),
    "best": ("filled", "#e3e6e9", ""),
    "unknown": ("striped,dashed", "#fefefe:#e3e6e9", "unknown"),
}
"""By kind of stretch: Graphviz's style, the fill (two colours make stripes), and the words of the legend."""


def style_stretch(stretch: BarSegment, width: float) -> DotAttributes:
    """Return the attributes of a stretch. Its label is inside where it fits."""
    form = "unknown" if stretch.length is None else stretch.kind
    fill = STRETCH_FORMS[form][1]
    ink = palette.PAPER if ":" not in fill and palette.text_colour_on(fill) == palette.PAPER else palette.INK
    text = escape_label(stretch.label) if form != "unknown" else f"<B>{escape_label(stretch.label)}</B>"
    label = f'<<FONT POINT-SIZE="{9 if form == "unknown" else 7.5}" COLOR="{ink}">{text}</FONT>>'
    label_fits = (
        stretch.label and form != "link" and measure_nodes([{**_PLAIN_NODE, "label": label}])[0][0] + 3 <= width
    )
    return {
        **style_stretch_form(form, width),
        "label": label if label_fits else '""',
        "tooltip": quote_value(stretch.tooltip or stretch.label),
    }


def style_stretch_form(form: str, width: float) -> DotAttributes:
    """Return the attributes of an empty stretch of one form, `width` in points."""
    style, fill, _ = STRETCH_FORMS[form]
    rim = palette.RIM if ":" in fill else palette.rim_colour_on(fill)
    return {
        **fix_node_size(width, BAR_HEIGHT),
        "shape": '"box"',
        "class": f'"bar {form}"',
        "style": f'"{style}"',
        "color": f'"{rim}"',
        "fillcolor": f'"{_repeat_stripes(fill, width) if ":" in fill else fill}"',
        "penwidth": "0.6" if width > 2 else "0.2",  # noqa: PLR2004 - a hairline keeps its own width
        "label": '""',
    }


def _repeat_stripes(fill: str, width: float) -> str:
    """Repeat two colours, one pair for every five points."""
    return ":".join([fill] * max(1, round(width / 5)))


def fix_node_size(width: float, height: float) -> DotAttributes:
    """Return the attributes that hold a node to a size in points; Graphviz takes inches."""
    return {
        "fixedsize": '"true"',
        "width": f"{width / 72:.4f}",
        "height": f"{height / 72:.4f}",
        "margin": '"0"',
    }


def make_thin_box(  # noqa: PLR0913 - a place, a size and a colour
    name: str, x: float, middle: float, *, width: float, height: float, colour: str, tooltip: str = " "
) -> ScenePart:
    """Make a line of the grid, a limit or a mark: a box of one colour, all lengths in points."""
    attributes = {
        **fix_node_size(width, height),
        "shape": '"box"',
        "style": '"filled"',
        "class": '"bar"',
        "penwidth": "0",
        "color": f'"{colour}"',
        "fillcolor": f'"{colour}"',
        "label": '""',
        "tooltip": quote_value(tooltip),
    }
    return ScenePart(name, attributes, x, middle, width, height, "mark")


def wrap_bar_title(text: str, *, strong: bool) -> str:
    """Wrap the title or the figure of a bar: lines of escaped text, at most three."""
    rows = [escape_label(row) for row in wrap_text(text, _TITLE_CHARACTERS, 3)]
    return "\n".join(f"<B>{row}</B>" if strong else row for row in rows)


def style_chart_text(  # noqa: PLR0913 - a text, and how it stands
    rows: str,
    side: str,
    resolve_link: LinkResolver,
    ref: str | None = None,
    tooltip: str = " ",
    *,
    ink: str = palette.TEXT,
) -> DotAttributes:
    """Return the attributes of a text of several lines; `side` is where its lines begin (`left`) or end (`right`)."""
    line_break = f'<BR ALIGN="{side.upper()}"/>'
    text = line_break.join(rows.split("\n")) + (line_break if "\n" in rows else "")
    return {
        **_PLAIN_NODE,
        "class": '"label"',
        "label": f'<<FONT POINT-SIZE="8" COLOR="{ink}">{text}</FONT>>',
        **link_attributes(ref, tooltip, resolve_link),
    }


def style_small_text(text: str, colour: str = palette.MUTED) -> DotAttributes:
    """Return the attributes of a line of small text."""
    label = f'<<FONT POINT-SIZE="7.5" COLOR="{colour}">{escape_label(text)}</FONT>>'
    return {**_PLAIN_NODE, "class": '"label"', "tooltip": '" "', "label": label}
