"""Style boxes. Never colour alone: shape, words or place say the same.

| style | form |
|---|---|
| component | rounded box; source: heavy bar at the right, sink: at the left; reactive: octagon |
| composed | rounded box with double frame |
| port | small box with sharp corners, at the rim of a frame |
| group, fold | box with bold title; fold: double frame (it stands for several) |
| node, topic | ellipse, note-coloured box |
| service, action | hexagon, action with double frame |
| external, physical, partner | dashed box |
| host, container, link | plain box, rounded box with list, small plain text |

Where two versions are drawn, what is added has a thick frame, what is removed a dashed one, what changed a double one,
and what was renamed or moved a dotted one. A sign in the title says the same.

Planned things have dashed frames, adapted ones dotted frames, neighbours are grey, the subject has a thick frame. A box
that is filled by its period has a dashed frame where the period is unknown, dotted on demand, double once, and sharp
corners where it runs on events of unknown rate.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

from archgen.emit.graphviz import palette
from archgen.emit.graphviz.dot_text import escape_label, quote_value, safe_address, wrap_text
from archgen.emit.graphviz.placed_scene import DotAttributes, Scene, ScenePart
from archgen.frozen import replace
from archgen.views.picture_shapes import Box

LinkResolver = Callable[[str], str | None]

_BOX_SHAPES = {
    "reactive": "octagon",
    "node": "ellipse",
    "service": "hexagon",
    "action": "hexagon",
}
_ROUNDED_STYLES = {"component", "source", "sink", "physical", "container", "composed"}
_DASHED_STYLES = {"external", "physical", "partner"}
_TABLE_DASHES = ("dashed", "dotted")
_CHANGE_PENS = {"added": "2.6", "removed": "1.4", "changed": "1", "renamed": "2"}
_TITLE_WIDTHS = {
    "topic": 30,
    "service": 30,
    "action": 30,
    "group": 22,
    "fold": 42,
    "host": 26,
    "container": 30,
    "node": 20,
}


def style_box(box: Box, resolve_link: LinkResolver, title_width: int | None = None) -> DotAttributes:
    """Return the DOT attributes of a box, its title wrapped at the usual width of its style or at so many characters."""
    if box.ports_in or box.ports_out:
        return {**_common_attributes(box, resolve_link), "shape": "plain", "label": _port_table(box)}
    if box.members:
        return {**_common_attributes(box, resolve_link), "shape": "plain", "label": write_member_card(box)}
    frame, fill = box_colours(box)
    styles = [
        "filled",
        *(["rounded"] if box.style in _ROUNDED_STYLES and box.fill != "event" else []),
        *_dash_styles(box),
    ]
    return {
        **_common_attributes(box, resolve_link),
        "shape": _BOX_SHAPES.get(box.style, "box"),
        "style": f'"{",".join(styles)}"',
        "color": f'"{frame}"',
        "fillcolor": f'"{fill}"',
        "penwidth": _pen_width(box),
        "peripheries": "2" if _has_double_frame(box) else "1",
        "margin": _box_margin(box),
        "width": "0.3",
        "height": "0.22",
        "label": f"<{_label_html(box, title_width)}>",
    }


def _has_double_frame(box: Box) -> bool:
    if box.change is not None:
        return box.change == "changed"
    return box.style in {"action", "fold", "composed"} or box.fill == "once"


def box_colours(box: Box) -> tuple[str, str]:
    """Return the colours of a box's frame and fill."""
    if box.broken:
        return palette.ERROR, palette.mix_tint(palette.ERROR)
    if box.change is not None:
        return palette.CHANGES[box.change], palette.mix_tint(palette.CHANGES[box.change])
    if box.fill is not None:
        fill = palette.PERIODS[box.fill]
        rim = (
            palette.FRAME if box.fill == "once" else palette.rim_colour_on(fill)
        )  # its outer frame stands on the paper
        return palette.SUBJECT if box.emphasis == "subject" else rim, fill
    if box.emphasis == "neighbour":
        return palette.NEIGHBOUR_FRAME, palette.NEIGHBOUR_FILL
    frame = {"topic": palette.TOPIC_FRAME, "service": palette.SERVICE_FRAME, "action": palette.SERVICE_FRAME}.get(
        box.style, palette.hue_colour(box.colour)
    )
    fill = {"topic": palette.TOPIC_FILL, "service": palette.SERVICE_FILL, "action": palette.SERVICE_FILL}.get(
        box.style, palette.PAPER
    )
    if box.style in {"group", "fold"} and box.colour is not None:
        fill = palette.mix_tint(palette.hue_colour(box.colour))
    return (palette.SUBJECT if box.emphasis == "subject" else frame), fill


def _box_margin(box: Box) -> str:
    if box.style in _BOX_SHAPES:
        return '"0.03,0.02"'
    return '"0.13,0.04"' if box.style in {"source", "sink", "topic"} else '"0.08,0.04"'


def _pen_width(box: Box) -> str:
    if box.broken:
        return "2.6"
    if box.change is not None:
        return _CHANGE_PENS[box.change]
    if box.emphasis == "subject":
        return "2"
    if box.fill in {"unknown", "on_demand", "event"}:
        return "1.2"
    return "1.2" if box.colour is not None and box.emphasis == "normal" else "0.8"


def _dash_styles(box: Box) -> list[str]:
    if box.change is not None:
        return {"removed": ["dashed"], "renamed": ["dotted"]}.get(box.change, [])
    if box.fill is not None:
        return {"unknown": ["dashed"], "on_demand": ["dotted"]}.get(box.fill, [])
    if box.style in _DASHED_STYLES or box.status == "planned":
        return ["dashed"]
    return ["dotted"] if box.status == "adapted" else []


def _common_attributes(box: Box, resolve_link: LinkResolver) -> DotAttributes:
    classes = ["box", box.style, box.emphasis]
    classes += [box.status] if box.status else []
    classes += [f"change-{box.change}"] if box.change else []
    classes += ["broken"] if box.broken else []
    classes += [f"hue{box.colour}"] if box.colour is not None else []
    classes += [f"pace-{box.fill.replace('_', '-')}"] if box.fill else []
    return {
        "class": f'"{" ".join(classes)}"',
        **link_attributes(box.ref, box.tooltip or "\n".join((box.title, *box.lines)), resolve_link),
    }


def link_attributes(ref: str | None, tooltip: str, resolve_link: LinkResolver) -> DotAttributes:
    """Return the tooltip, and the address where the target is part of the output."""
    href = safe_address(resolve_link(ref) or "") if ref else ""
    attributes = {"tooltip": quote_value(tooltip)}
    # `_top`: an SVG may be shown in a frame, and its links lead to whole pages.
    return {**attributes, "URL": quote_value(href), "target": '"_top"'} if href else attributes


def _label_html(box: Box, title_width: int | None) -> str:
    _, fill = box_colours(box)
    text_colour = palette.text_colour_on(fill)
    detail_colour = palette.MUTED if text_colour == palette.TEXT else text_colour
    width = title_width or _TITLE_WIDTHS.get(box.style, 18)
    bold = box.emphasis == "subject" or box.style in {"group", "fold", "host"}
    titles = [f"<B>{escape_label(row)}</B>" if bold else escape_label(row) for row in wrap_text(box.title, width)]
    rows = [f'<TR><TD HEIGHT="11"><FONT COLOR="{text_colour}">{row}</FONT></TD></TR>' for row in titles]
    rows += [
        f'<TR><TD HEIGHT="10"><FONT POINT-SIZE="8" COLOR="{detail_colour}">{row}</FONT></TD></TR>'
        for row in _detail_rows(box, width)
    ]
    # As rows of a table: Graphviz sets lines of two fonts solid, so that descenders touch the next line.
    return f'<TABLE BORDER="0" CELLBORDER="0" CELLSPACING="0" CELLPADDING="0">{"".join(rows)}</TABLE>'


def _detail_rows(box: Box, width: int) -> list[str]:
    return [escape_label(row) for line in box.lines for row in wrap_text(line, width + width // 3)]


def _port_table(box: Box) -> str:
    """Return the html-like label of a box with its ports as rows: inputs at the left, outputs at the right."""
    frame, fill = box_colours(box)
    style = ",".join(["ROUNDED", *(dash.upper() for dash in _dash_styles(box) if dash in _TABLE_DASHES)])
    # The BORDER of a table is a whole number of points.
    border = max(1, round(float(_pen_width(box))))
    head = (
        f'<TABLE STYLE="{style}" BORDER="{border}" COLOR="{frame}" BGCOLOR="{fill}" '
        'CELLBORDER="0" CELLSPACING="0" CELLPADDING="3">'
        f'<TR><TD COLSPAN="2" CELLPADDING="5">{_write_table_title(box)}</TD></TR><HR/>'
    )
    rows = max(len(box.ports_in), len(box.ports_out))
    return f"<{head}{''.join(_write_port_row(box, at) for at in range(rows))}</TABLE>>"


def _write_table_title(box: Box) -> str:
    titles = [escape_label(row) for row in wrap_text(box.title, 28)]
    rows = [
        f'<TR><TD HEIGHT="13"><FONT POINT-SIZE="11" COLOR="{palette.TEXT}"><B>{row}</B></FONT></TD></TR>'
        for row in titles
    ]
    rows += [
        f'<TR><TD HEIGHT="10"><FONT POINT-SIZE="8" COLOR="{palette.MUTED}">{row}</FONT></TD></TR>'
        for row in _detail_rows(box, 34)
    ]
    return f'<TABLE BORDER="0" CELLBORDER="0" CELLSPACING="0" CELLPADDING="0">{"".join(rows)}</TABLE>'


def _write_port_row(box: Box, index: int) -> str:
    input_cell = _write_port_cell(box.ports_in[index][1], "▸ ", "") if index < len(box.ports_in) else "\u00a0"
    output_cell = _write_port_cell(box.ports_out[index][1], "", " ▸") if index < len(box.ports_out) else "\u00a0"
    return f'<TR><TD ALIGN="LEFT" PORT="i{index}">{input_cell}</TD><TD ALIGN="RIGHT" PORT="o{index}">{output_cell}</TD></TR>'


def _write_port_cell(text: str, before: str, after: str) -> str:
    rows = wrap_text(text, 26, 3)
    side = "LEFT" if before else "RIGHT"
    return f'<BR ALIGN="{side}"/>'.join(
        before * (not at) + escape_label(row) + after * (not at) for at, row in enumerate(rows)
    )


_MEMBER_WIDTH = 104
"""How wide the squares of a box are together at most, in points: 13 of 6 points."""
_SQUARE_STEPS = ((13, 6, 2), (26, 3, 1))
"""Up to how many squares, their width and the space between two, in points; more are a bar with a piece for each hue."""


def write_member_card(box: Box, width: int = 0) -> str:
    """Return the html-like label of a box that stands for members: title, lines, and a square for each member."""
    frame, fill = box_colours(box)
    titles = [escape_label(row) for row in wrap_text(box.title, 22, 3)]
    rows = [f'<TR><TD ALIGN="LEFT" HEIGHT="13"><FONT POINT-SIZE="10.5"><B>{row}</B></FONT></TD></TR>' for row in titles]
    rows += [
        f'<TR><TD ALIGN="LEFT" HEIGHT="11"><FONT POINT-SIZE="8.5" COLOR="{palette.MUTED}">{row}</FONT></TD></TR>'
        for row in _detail_rows(box, 24)
    ]
    rows.append(f'<TR><TD ALIGN="LEFT" HEIGHT="17" VALIGN="BOTTOM">{_write_squares(box.members)}</TD></TR>')
    style = ",".join(["ROUNDED", *(dash.upper() for dash in _dash_styles(box) if dash in _TABLE_DASHES)])
    border = max(1, round(float(_pen_width(box)))) if box.change or box.broken else 1
    inner = f'<TABLE BORDER="0" CELLBORDER="0" CELLSPACING="0" CELLPADDING="0">{"".join(rows)}</TABLE>'
    return (
        f'<<TABLE STYLE="{style}" BORDER="{border}" COLOR="{frame}" BGCOLOR="{fill}" CELLBORDER="0" CELLSPACING="0" '
        f'CELLPADDING="7" WIDTH="{width}"><TR><TD ALIGN="LEFT">{inner}</TD></TR></TABLE>>'
    )


def _write_squares(members: Sequence[tuple[int | None, int]]) -> str:
    total = sum(count for _, count in members)
    size, gap = next((step[1:] for step in _SQUARE_STEPS if total <= step[0]), (0, 0))
    if size:
        cells = [(size, hue) for hue, count in members for _ in range(count)]
    else:
        cells = [(max(2, count * _MEMBER_WIDTH // total), hue) for hue, count in members]
    squares = "".join(
        f'<TD FIXEDSIZE="TRUE" WIDTH="{width}" HEIGHT="6" BGCOLOR="{palette.partner_colour(hue)}"></TD>'
        for width, hue in cells
    )
    # Of fixed size: in a wider cell the squares would come apart.
    wide = sum(width + gap for width, _ in cells) + gap
    return (
        f'<TABLE ALIGN="LEFT" FIXEDSIZE="TRUE" WIDTH="{wide}" HEIGHT="10" BORDER="0" CELLBORDER="0" '
        f'CELLSPACING="{gap}" CELLPADDING="0"><TR>{squares}</TR></TABLE>'
    )


_BAR_WIDTH = 3.5
_BADGE_DIAMETER = 10.0
_DIGIT_WIDTH = 4.4
_BADGE_LETTERS = {"error": ("E", palette.ERROR), "warning": ("W", palette.WARNING), "note": ("N", palette.NOTE)}


def add_decorations(scene: Scene, boxes: Mapping[str, Box]) -> Scene:
    """Add the decorations of each box, by the DOT names of the boxes."""
    decorations = tuple(
        mark for part in scene.parts if part.name in boxes for mark in _decorate_box(part, boxes[part.name])
    )
    return replace(scene, parts=scene.parts + decorations)


def _decorate_box(part: ScenePart, box: Box) -> Iterator[ScenePart]:
    left, _, right, top = part.rectangle
    if box.style in {"source", "sink"}:
        x = right - _BAR_WIDTH / 2 - 0.4 if box.style == "source" else left + _BAR_WIDTH / 2 + 0.4
        # As parts of kind `mark`, since Graphviz has no node with one heavy side; marks may overlap their box.
        yield ScenePart(
            f"{part.name}bar", _bar_attributes(box, part.height), x, part.y, _BAR_WIDTH, part.height, "mark"
        )
    if box.badge:
        width = _BADGE_DIAMETER + (_DIGIT_WIDTH * (len(str(box.badge_count)) + 0.5) if box.badge_count else 0)
        x = right - 3 - (width - _BADGE_DIAMETER) / 2
        yield ScenePart(f"{part.name}badge", _badge_attributes(box, width), x, top - 1, width, _BADGE_DIAMETER, "mark")


def _bar_attributes(box: Box, height: float) -> dict[str, str]:
    frame, _ = box_colours(box)
    return {
        **_fixed_shape(_BAR_WIDTH, max(height - 9, 4)),
        "shape": '"box"',
        "color": f'"{frame}"',
        "fillcolor": f'"{frame}"',
        "penwidth": "0",
        "label": '""',
        "class": '"bar"',
        "tooltip": f'"{box.style}"',
    }


def _badge_attributes(box: Box, width: float) -> dict[str, str]:
    letter, colour = _BADGE_LETTERS[box.badge or "note"]
    text = f"{letter} {box.badge_count}" if box.badge_count else letter
    subject = f"{box.badge_count} finding{'s' * (box.badge_count > 1)} inside" if box.badge_count else "has findings"
    return {
        **_fixed_shape(width, _BADGE_DIAMETER),
        **({"shape": '"box"', "style": '"filled,rounded"'} if box.badge_count else {"shape": '"circle"'}),
        "color": f'"{palette.PAPER}"',
        "fillcolor": f'"{colour}"',
        "penwidth": "0.6",
        "label": f'<<FONT POINT-SIZE="6.5" COLOR="{palette.PAPER}"><B>{text}</B></FONT>>',
        "class": f'"badge {box.badge}"',
        "tooltip": f'"{subject}, the worst is: {box.badge}"',
    }


def _fixed_shape(width: float, height: float) -> dict[str, str]:
    return {
        "style": '"filled"',
        "fixedsize": '"true"',
        "width": f"{width / 72:.4f}",
        "height": f"{height / 72:.4f}",
        "margin": '"0"',
    }
