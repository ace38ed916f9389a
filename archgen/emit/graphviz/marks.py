"""Style boxes. Never colour alone: shape, words or place say the same.

| style | form |
|---|---|
| component | rounded box; source: heavy bar at the right, sink: at the left; reactive: octagon |
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

from collections.abc import Callable

from archgen.emit.graphviz import palette
from archgen.emit.graphviz.text import address, html, quoted, wrapped
from archgen.views.shapes import Box

Attributes = dict[str, str]
Link = Callable[[str], str | None]

FONT = "DejaVu Sans"
_SHAPES = {
    "reactive": "octagon",
    "node": "ellipse",
    "service": "hexagon",
    "action": "hexagon",
}
_ROUNDED = {"component", "source", "sink", "physical", "container"}
_DASHED = {"external", "physical", "partner"}
_CHANGE_PENS = {"added": "2.6", "removed": "1.4", "changed": "1", "renamed": "2"}
_WIDTHS = {"topic": 30, "service": 30, "action": 30, "group": 22, "fold": 22, "host": 26, "container": 30, "node": 20}


def box(item: Box, link: Link) -> Attributes:
    """Return the DOT attributes of a box."""
    if item.ports_in or item.ports_out:
        return {**_common(item, link), "shape": "plain", "label": _table(item)}
    frame, fill = colours(item)
    styles = ["filled", *(["rounded"] if item.style in _ROUNDED and item.fill != "event" else []), *_dashes(item)]
    return {
        **_common(item, link),
        "shape": _SHAPES.get(item.style, "box"),
        "style": f'"{",".join(styles)}"',
        "color": f'"{frame}"',
        "fillcolor": f'"{fill}"',
        "penwidth": _pen(item),
        "peripheries": "2" if _double(item) else "1",
        "margin": _margin(item),
        "width": "0.3",
        "height": "0.22",
        "label": f"<{_lines(item)}>",
    }


def _double(item: Box) -> bool:
    if item.change is not None:
        return item.change == "changed"
    return item.style in {"action", "fold"} or item.fill == "once"


def colours(item: Box) -> tuple[str, str]:
    """Return the colours of a box's frame and fill."""
    if item.change is not None:
        return palette.CHANGES[item.change], palette.tint(palette.CHANGES[item.change])
    if item.fill is not None:
        fill = palette.PERIODS[item.fill]
        rim = palette.FRAME if item.fill == "once" else palette.rim_on(fill)  # its outer frame stands on the paper
        return palette.SUBJECT if item.emphasis == "subject" else rim, fill
    if item.emphasis == "neighbour":
        return palette.NEIGHBOUR_FRAME, palette.NEIGHBOUR_FILL
    frame = {"topic": palette.TOPIC_FRAME, "service": palette.SERVICE_FRAME, "action": palette.SERVICE_FRAME}.get(
        item.style, palette.hue(item.colour)
    )
    fill = {"topic": palette.TOPIC_FILL, "service": palette.SERVICE_FILL, "action": palette.SERVICE_FILL}.get(
        item.style, palette.PAPER
    )
    if item.style in {"group", "fold"} and item.colour is not None:
        fill = palette.tint(palette.hue(item.colour))
    return (palette.SUBJECT if item.emphasis == "subject" else frame), fill


def _margin(item: Box) -> str:
    if item.style in _SHAPES:
        return '"0.03,0.02"'
    return '"0.13,0.04"' if item.style in {"source", "sink", "topic"} else '"0.08,0.04"'


def _pen(item: Box) -> str:
    if item.change is not None:
        return _CHANGE_PENS[item.change]
    if item.emphasis == "subject":
        return "2"
    if item.fill in {"unknown", "on_demand", "event"}:
        return "1.2"
    return "1.2" if item.colour is not None and item.emphasis == "normal" else "0.8"


def _dashes(item: Box) -> list[str]:
    if item.change is not None:
        return {"removed": ["dashed"], "renamed": ["dotted"]}.get(item.change, [])
    if item.fill is not None:
        return {"unknown": ["dashed"], "on_demand": ["dotted"]}.get(item.fill, [])
    if item.style in _DASHED or item.status == "planned":
        return ["dashed"]
    return ["dotted"] if item.status == "adapted" else []


def _common(item: Box, link: Link) -> Attributes:
    classes = ["box", item.style, item.emphasis]
    classes += [item.status] if item.status else []
    classes += [f"change-{item.change}"] if item.change else []
    classes += [f"hue{item.colour}"] if item.colour is not None else []
    classes += [f"pace-{item.fill.replace('_', '-')}"] if item.fill else []
    return {
        "class": f'"{" ".join(classes)}"',
        **linked(item.ref, item.tooltip or "\n".join((item.title, *item.lines)), link),
    }


def linked(ref: str | None, tooltip: str, link: Link) -> Attributes:
    """Return the tooltip, and the address where the target is part of the output."""
    href = address(link(ref) or "") if ref else ""
    found = {"tooltip": quoted(tooltip)}
    # `_top`: an SVG may be shown in a frame, and its links lead to whole pages.
    return {**found, "URL": quoted(href), "target": '"_top"'} if href else found


def _lines(item: Box) -> str:
    _, fill = colours(item)
    ink = palette.text_on(fill)
    small = palette.MUTED if ink == palette.TEXT else ink
    width = _WIDTHS.get(item.style, 18)
    bold = item.emphasis == "subject" or item.style in {"group", "fold", "host"}
    title = "<BR/>".join(f"<B>{html(row)}</B>" if bold else html(row) for row in wrapped(item.title, width))
    rows = [f'<FONT COLOR="{ink}">{title}</FONT>']
    rows += [f'<FONT POINT-SIZE="7.5" COLOR="{small}">{small_text}</FONT>' for small_text in _small(item, width)]
    return "<BR/>".join(rows)


def _small(item: Box, width: int) -> list[str]:
    return [html(row) for line in item.lines for row in wrapped(line, width + width // 3)]


def _table(item: Box) -> str:
    """Return the html-like label of a box with its ports as rows: inputs at the left, outputs at the right."""
    frame, fill = colours(item)
    style = "ROUNDED,DASHED" if item.status == "planned" else "ROUNDED"
    # The BORDER of a table is a whole number of points: the first digit of the pen's width, at least 1.
    head = (
        f'<TABLE STYLE="{style}" BORDER="{_pen(item)[0].replace("0", "1")}" COLOR="{frame}" BGCOLOR="{fill}" '
        'CELLBORDER="0" CELLSPACING="0" CELLPADDING="3">'
        f'<TR><TD COLSPAN="2" CELLPADDING="5">{_table_title(item)}</TD></TR><HR/>'
    )
    rows = max(len(item.ports_in), len(item.ports_out))
    return f"<{head}{''.join(_row(item, at) for at in range(rows))}</TABLE>>"


def _table_title(item: Box) -> str:
    title = "<BR/>".join(html(row) for row in wrapped(item.title, 28))
    small = "".join(f'<BR/><FONT POINT-SIZE="8" COLOR="{palette.MUTED}">{row}</FONT>' for row in _small(item, 34))
    return f'<FONT POINT-SIZE="11" COLOR="{palette.TEXT}"><B>{title}</B></FONT>{small}'


def _row(item: Box, at: int) -> str:
    into = _port(item.ports_in[at][1], "▸ ", "") if at < len(item.ports_in) else "\u00a0"
    out = _port(item.ports_out[at][1], "", " ▸") if at < len(item.ports_out) else "\u00a0"
    return f'<TR><TD ALIGN="LEFT" PORT="i{at}">{into}</TD><TD ALIGN="RIGHT" PORT="o{at}">{out}</TD></TR>'


def _port(text: str, before: str, after: str) -> str:
    rows = wrapped(text, 26, 3)
    side = "LEFT" if before else "RIGHT"
    return f'<BR ALIGN="{side}"/>'.join(before * (not at) + html(row) + after * (not at) for at, row in enumerate(rows))
