"""Draw the legend below a picture: a sample of each form that it uses, with its meaning; then the notes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from archgen.emit.graphviz import marks, palette, strokes
from archgen.emit.graphviz.decorations import decorated
from archgen.emit.graphviz.draft import measure
from archgen.emit.graphviz.scene import Line, Part, Scene
from archgen.emit.graphviz.text import html, wrapped
from archgen.views.shapes import Arrow, Box, Graph, Pace

Attributes = dict[str, str]
_SAMPLE = (24.0, 11.0)
_ROW = 15.0
_LEAST = 260.0

_BOXES: dict[str, tuple[Box, str]] = {
    "subject": (Box("", "", emphasis="subject"), "what the picture is about"),
    "neighbour": (Box("", "", emphasis="neighbour"), "neighbour"),
    "source": (Box("", "", style="source"), "source"),
    "sink": (Box("", "", style="sink"), "sink"),
    "reactive": (Box("", "", style="reactive"), "reactive: serves requests"),
    "external": (Box("", "", style="external"), "outside the architecture"),
    "node": (Box("", "", style="node"), "node"),
    "topic": (Box("", "", style="topic"), "topic"),
    "service-box": (Box("", "", style="service"), "service"),
    "action-box": (Box("", "", style="action"), "action"),
    "planned": (Box("", "", status="planned"), "planned"),
    "adapted": (Box("", "", status="adapted"), "adapted"),
    "fold": (Box("", "", style="fold"), "stands for several"),
}
_PACES: dict[Pace, str] = {
    "to_10_ms": "period up to 10 ms",
    "to_30_ms": "30 ms",
    "to_100_ms": "100 ms",
    "to_300_ms": "300 ms",
    "to_1_s": "1 s",
    "slower": "longer",
    "event": "on an event, rate not known",
    "on_demand": "on demand",
    "once": "once, at the start",
    "unknown": "? unknown",
}
_BOXES |= {f"pace:{pace}": (Box("", "", fill=pace), words) for pace, words in _PACES.items()}
_BOXES |= {
    "change:added": (Box("", "", change="added"), "+ added"),
    "change:removed": (Box("", "", change="removed"), "\u2212 removed"),
    "change:changed": (Box("", "", change="changed"), "~ changed"),
    "change:renamed": (Box("", "", change="renamed"), "→ renamed or moved"),
}
_ARROWS: dict[str, tuple[Arrow, str]] = {
    "data": (Arrow("", "", ""), "data"),
    "optional": (Arrow("", "", "", optional=True), "optional input"),
    "physical": (Arrow("", "", "", style="physical"), "physical"),
    "service": (Arrow("", "", "", style="service"), "service, from client to server"),
    "action": (Arrow("", "", "", style="action"), "action, from client to server"),
    "internal": (Arrow("", "", "", style="internal"), "inside one component"),
    "link": (Arrow("", "", "", style="link"), "network link"),
    "line:added": (Arrow("", "", "", change="added"), "+ connection added"),
    "line:removed": (Arrow("", "", "", change="removed"), "\u2212 connection removed"),
    "line:changed": (Arrow("", "", "", change="changed"), "~ something else flows"),
    "line:same": (Arrow("", "", "", faded=True), "as before"),
}
_WIDTHS = ((1, "1 flow"), (2, "2 or 3 flows"), (4, "4 flows and more"))
_WORDS = {"count": "A number on an arrow: how many flows it stands for.", "star": "* all that it offers is taken."}


def below(scene: Scene, graph: Graph) -> Scene:
    """Add a graph's legend and notes below a scene, at its left."""
    entries = [entry for key in graph.legend for entry in _entries(key)]
    entries += [(_swatch(index), text) for index, text in graph.legend_colours]
    return under(scene, entries, [_WORDS[key] for key in graph.legend if key in _WORDS] + list(graph.notes))


def under(scene: Scene, entries: Sequence[tuple[Scene, str]], said: Sequence[str]) -> Scene:
    """Add samples with their words, then sentences, below a scene, at its left."""
    left, bottom, right, _ = scene.bounds()
    width = max(right - left, _LEAST)
    legend = _rows(entries, width)
    notes = _notes(said, width, -legend.bounds()[1] if entries else 0.0)
    return scene.joined(*(part.moved(left, bottom - 20) for part in (legend, notes)))


def _entries(key: str) -> Iterator[tuple[Scene, str]]:
    if key in _BOXES:
        box, words = _BOXES[key]
        yield _box(box), words
    if key in _ARROWS:
        arrow, words = _ARROWS[key]
        yield _arrow(key, arrow, merged=False), words
    if key == "width":
        for count, words in _WIDTHS:
            yield _arrow(f"{key}{count}", Arrow("", "", "", count=count), merged=True), words


def _box(item: Box) -> Scene:
    # A second frame is drawn outside of the node's size: less of it keeps all samples equally large.
    double = (
        6 if item.style in {"fold", "action"} or item.fill == "once" or item.change == "changed" else 0
    )  # the second frame stands outside
    width, height = _SAMPLE[0] - double, _SAMPLE[1] - double
    attributes = {
        **marks.box(item, lambda _: None),
        "label": '""',
        "fixedsize": '"true"',
        "width": f"{width / 72:.4f}",
        "height": f"{height / 72:.4f}",
        "tooltip": '" "',
    }
    return decorated(Scene(parts=(Part("s", attributes, _SAMPLE[0] / 2, 0, width, height),)), {"s": item})


def _swatch(index: int) -> Scene:
    return _box(Box("", "", style="group", colour=index))


def _arrow(key: str, item: Arrow, *, merged: bool) -> Scene:
    width = _SAMPLE[0]
    ends = tuple(
        Part(f"{key}{at}", {"style": '"invis"', "label": '""', "shape": '"point"'}, x, 0, 0, 0, "mark")
        for at, x in enumerate((0.0, width))
    )
    attributes = {**strokes.arrow(item, lambda _: None, merged=merged), "tooltip": '" "', "edgetooltip": '" "'}
    tip = 12.0 if item.style == "action" else 0.0 if item.style == "link" else 6.0
    third = (width - tip) / 3
    # The line must end where the arrow head begins: Graphviz draws heads at the `e,` point, beyond the curve.
    middle = f"0,0 {third:.2f},0 {2 * third:.2f},0 {3 * third:.2f},0"
    spline = f"e,{width:.2f},0 {middle}" if tip else middle
    return Scene(lines=(Line(f"x{key}", "", ends[0].name, ends[1].name, attributes, spline),), parts=ends)


def _text(words: str) -> Attributes:
    return {
        "shape": '"plain"',
        "class": '"legend"',
        "tooltip": '" "',
        "label": f'<<FONT POINT-SIZE="8" COLOR="{palette.MUTED}">{words}</FONT>>',
    }


def _rows(entries: Sequence[tuple[Scene, str]], width: float) -> Scene:
    """Place samples and words side by side, in as many rows as the width needs."""
    texts = [_text(html(words)) for _, words in entries]
    done: list[Scene] = []
    x, y = 0.0, -_ROW / 2
    for at, ((sample, _), text, size) in enumerate(zip(entries, texts, measure(texts), strict=True)):
        wide = _SAMPLE[0] + 5 + size[0] + 16
        if x and x + wide > width:
            x, y = 0.0, y - _ROW
        words = Part(f"legend{at}", text, x + _SAMPLE[0] + 5 + size[0] / 2, y, *size, kind="label")
        # The same sample may be used twice, and names of nodes must be unique in a picture.
        done += [_renamed(sample.moved(x, y), f"k{at}"), Scene(parts=(words,))]
        x += wide
    return Scene().joined(*done)


def _renamed(scene: Scene, prefix: str) -> Scene:
    return Scene(
        scene.frames,
        tuple(
            replace(line, edge=prefix, tail=f"{prefix}{line.tail}", head=f"{prefix}{line.head}") for line in scene.lines
        ),
        tuple(replace(part, name=f"{prefix}{part.name}") for part in scene.parts),
    )


def _notes(said: Iterable[str], width: float, down: float) -> Scene:
    rows = [row for words in said for row in wrapped(words, max(40, int(width / 4.4)), 12)]
    if not rows:
        return Scene()
    text = _text('<BR ALIGN="LEFT"/>'.join(html(row) for row in rows) + '<BR ALIGN="LEFT"/>')
    ((wide, high),) = measure([text])
    return Scene(parts=(Part("notes", text, wide / 2, -down - high / 2 - 4, wide, high, "label"),))
