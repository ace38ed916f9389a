"""Draw the legend below a picture: a sample of each form that it uses, with its meaning; then the notes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from archgen.emit.graphviz import box_styles, palette, styled_graph
from archgen.emit.graphviz.box_styles import add_decorations
from archgen.emit.graphviz.dot_text import escape_label, wrap_text
from archgen.emit.graphviz.placed_scene import DotAttributes, Scene, SceneLine, ScenePart
from archgen.emit.graphviz.styled_graph import measure_nodes
from archgen.frozen import replace
from archgen.views.picture_shapes import Arrow, Box, Graph, PeriodStep

_SAMPLE_SIZE = (24.0, 11.0)
_ROW_HEIGHT = 15.0
_MIN_WIDTH = 260.0
_WIDEST_FACE = 1.15
"""How much wider words become where a picture is opened without its fonts; measured with DejaVu Sans for Inter."""

_BOX_SAMPLES: dict[str, tuple[Box, str]] = {
    "subject": (Box("", "", emphasis="subject"), "what the picture is about"),
    "neighbour": (Box("", "", emphasis="neighbour"), "neighbour"),
    "composed": (Box("", "", style="composed"), "has components of its own"),
    "port": (Box("", "", style="port"), "port of the frame"),
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
    "badge:error": (Box("", "", badge="error"), "has an error (E)"),
    "badge:warning": (Box("", "", badge="warning"), "has a warning (W)"),
    "badge:note": (Box("", "", badge="note"), "has a note (N)"),
    "badge:inside": (Box("", "", badge="note", badge_count=2), "the worst finding inside, and how many"),
}
_PERIOD_WORDS: dict[PeriodStep, str] = {
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
_BOX_SAMPLES |= {f"pace:{pace}": (Box("", "", fill=pace), words) for pace, words in _PERIOD_WORDS.items()}
_BOX_SAMPLES |= {
    "change:broken": (Box("", "", broken=True), "! a change breaks what it reads"),
    "change:added": (Box("", "", change="added"), "+ added"),
    "change:removed": (Box("", "", change="removed"), "\u2212 removed"),
    "change:changed": (Box("", "", change="changed"), "~ changed"),
    "change:renamed": (Box("", "", change="renamed"), "→ renamed or moved"),
}
_ARROW_SAMPLES: dict[str, tuple[Arrow, str]] = {
    "data": (Arrow("", "", ""), "data"),
    "optional": (Arrow("", "", "", optional=True), "optional input"),
    "made": (Arrow("", "", "", is_made=True), "joined by autoconnect"),
    "physical": (Arrow("", "", "", style="physical"), "physical"),
    "medium": (Arrow("", "", "", medium="MQTT"), "no ROS, but what stands in brackets"),
    "service": (Arrow("", "", "", style="service"), "service, from client to server"),
    "action": (Arrow("", "", "", style="action"), "action, from client to server"),
    "internal": (Arrow("", "", "", style="internal"), "inside one component"),
    "link": (Arrow("", "", "", style="link"), "network link"),
    "step:data": (Arrow("", "", ""), "step along a topic"),
    "step:service": (Arrow("", "", "", style="service"), "service: request or answer"),
    "step:action": (Arrow("", "", "", style="action"), "action: goal or result"),
    "step:inner": (Arrow("", "", "", style="internal"), "inside"),
    "step:broken": (Arrow("", "", "", change="removed"), "no connection"),
    "line:broken": (Arrow("", "", "", change="changed", broken=True), "! breaks another partner"),
    "line:added": (Arrow("", "", "", change="added"), "+ connection added"),
    "line:removed": (Arrow("", "", "", change="removed"), "\u2212 connection removed"),
    "line:changed": (Arrow("", "", "", change="changed"), "~ something else flows"),
    "line:same": (Arrow("", "", "", faded=True), "as before"),
}
_KEY_SENTENCES = {
    "count": "A number on an arrow: how many flows it stands for; the more, the thicker it is.",
    "heads": "A number at an arrow head: how many flows arrive by it (1 where none stands); the more on a line, the thicker it is. Amber heads run back, against the order of the columns.",
    "star": "* all that it offers is taken.",
}


def add_graph_legend(scene: Scene, graph: Graph) -> Scene:
    """Add a graph's legend and notes below a scene, at its left."""
    entries = [entry for key in graph.legend for entry in _legend_entries(key)]
    entries += [
        (_box_sample(Box("", "", style="group", colour=index), is_partner=graph.kind == "overview"), text)
        for index, text in graph.legend_colours
    ]
    return add_legend(
        scene, entries, [_KEY_SENTENCES[key] for key in graph.legend if key in _KEY_SENTENCES] + list(graph.notes)
    )


def add_legend(scene: Scene, entries: Sequence[tuple[Scene, str]], sentences: Sequence[str]) -> Scene:
    """Add samples with their words, then sentences, below a scene, at its left."""
    left, bottom, right, _ = scene.bounds()
    width = max(right - left, _MIN_WIDTH)
    legend = _lay_out_entries(entries, width)
    notes = _lay_out_notes(sentences, width, -legend.bounds()[1] if entries else 0.0)
    return scene.joined(*(_reserve_width(part).moved(left, bottom - 20) for part in (legend, notes)))


def _reserve_width(legend: Scene) -> Scene:
    """Return a part of the legend with an unseen point where its words end in the widest face: the picture reaches as far."""
    ends = [part.rectangle[0] + part.width * _WIDEST_FACE for part in legend.parts if part.kind == "label"]
    if not ends:
        return legend
    mark = _create_mark(f"{legend.parts[-1].name}end", max(ends), legend.parts[-1].y)
    return legend.joined(Scene(parts=(mark,)))


def _legend_entries(key: str) -> Iterator[tuple[Scene, str]]:
    if key in _BOX_SAMPLES:
        box, words = _BOX_SAMPLES[key]
        yield _box_sample(box), words
    if key in _ARROW_SAMPLES:
        arrow, words = _ARROW_SAMPLES[key]
        yield _arrow_sample(key, arrow), words


def _box_sample(box: Box, *, is_partner: bool = False) -> Scene:
    # A second frame is drawn outside of the node's size: less of it keeps all samples equally large.
    frame_space = (
        6 if box.style in {"fold", "action", "composed"} or box.fill == "once" or box.change == "changed" else 0
    )  # the second frame stands outside
    width, height = _SAMPLE_SIZE[0] - frame_space, _SAMPLE_SIZE[1] - frame_space
    attributes = {
        **box_styles.style_box(box, lambda _: None),
        **(dict.fromkeys(("color", "fillcolor"), f'"{palette.partner_colour(box.colour)}"') if is_partner else {}),
        "label": '""',
        "fixedsize": '"true"',
        "width": f"{width / 72:.4f}",
        "height": f"{height / 72:.4f}",
        "tooltip": '" "',
    }
    return add_decorations(
        Scene(parts=(ScenePart("s", attributes, _SAMPLE_SIZE[0] / 2, 0, width, height),)), {"s": box}
    )


def _arrow_sample(key: str, arrow: Arrow) -> Scene:
    width = _SAMPLE_SIZE[0]
    ends = tuple(_create_mark(f"{key}{at}", x, 0) for at, x in enumerate((0.0, width)))
    attributes = {
        **styled_graph.style_arrow(arrow, lambda _: None),
        "tooltip": '" "',
        "edgetooltip": '" "',
    }
    head_length = 12.0 if arrow.style == "action" or arrow.medium else 0.0 if arrow.style == "link" else 6.0
    third = (width - head_length) / 3
    # The line must end where the arrow head begins: Graphviz draws heads at the `e,` point, beyond the curve.
    middle = f"0,0 {third:.2f},0 {2 * third:.2f},0 {3 * third:.2f},0"
    spline = f"e,{width:.2f},0 {middle}" if head_length else middle
    return Scene(lines=(SceneLine(f"x{key}", "", ends[0].name, ends[1].name, attributes, spline),), parts=ends)


def _create_mark(name: str, x: float, y: float) -> ScenePart:
    """Return a point that nobody sees."""
    return ScenePart(name, {"style": '"invis"', "label": '""', "shape": '"point"'}, x, y, 0, 0, "mark")


def _legend_text(words: str) -> DotAttributes:
    return {
        "shape": '"plain"',
        "class": '"legend"',
        "tooltip": '" "',
        "label": f'<<FONT POINT-SIZE="8" COLOR="{palette.MUTED}">{words}</FONT>>',
    }


def _lay_out_entries(entries: Sequence[tuple[Scene, str]], width: float) -> Scene:
    """Place samples and words side by side, in as many rows as the width needs."""
    texts = [_legend_text(escape_label(words_part)) for _, words_part in entries]
    scenes: list[Scene] = []
    x, y = 0.0, -_ROW_HEIGHT / 2
    for at, ((sample, _), text, size) in enumerate(zip(entries, texts, measure_nodes(texts), strict=True)):
        entry_width = _SAMPLE_SIZE[0] + 5 + size[0] * _WIDEST_FACE + 10
        if x and x + entry_width > width:
            x, y = 0.0, y - _ROW_HEIGHT
        words_part = ScenePart(f"legend{at}", text, x + _SAMPLE_SIZE[0] + 5 + size[0] / 2, y, *size, kind="label")
        # The same sample may be used twice, and names of nodes must be unique in a picture.
        scenes += [_prefix_names(sample.moved(x, y), f"k{at}"), Scene(parts=(words_part,))]
        x += entry_width
    return Scene().joined(*scenes)


def _prefix_names(scene: Scene, prefix: str) -> Scene:
    return Scene(
        scene.frames,
        tuple(
            replace(line, edge=prefix, tail=f"{prefix}{line.tail}", head=f"{prefix}{line.head}") for line in scene.lines
        ),
        tuple(replace(part, name=f"{prefix}{part.name}") for part in scene.parts),
    )


def _lay_out_notes(sentences: Iterable[str], width: float, distance: float) -> Scene:
    rows = [row for words in sentences for row in wrap_text(words, max(40, int(width / (4.4 * _WIDEST_FACE))), 12)]
    if not rows:
        return Scene()
    text = _legend_text('<BR ALIGN="LEFT"/>'.join(escape_label(row) for row in rows) + '<BR ALIGN="LEFT"/>')
    ((wide, high),) = measure_nodes([text])
    return Scene(parts=(ScenePart("notes", text, wide / 2, -distance - high / 2 - 4, wide, high, "label"),))
