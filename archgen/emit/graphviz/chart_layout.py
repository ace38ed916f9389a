"""Lay out charts: bars along one scale, at places that are computed here; Graphviz only renders them.

A chart is as wide as the text of a report. From left to right: titles, the scale with its bars, figures. Grid and limit
are thin boxes below and above the bars. docs/decisions/0003-charts.md says why a chart is not a graph.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from archgen.emit.graphviz import palette
from archgen.emit.graphviz.box_styles import LinkResolver, link_attributes
from archgen.emit.graphviz.dot_text import escape_label, quote_value, wrap_text
from archgen.emit.graphviz.drawn_legend import add_legend
from archgen.emit.graphviz.placed_scene import DotAttributes, Scene, ScenePart
from archgen.emit.graphviz.styled_graph import measure_nodes
from archgen.frozen import dataclass, replace
from archgen.views.picture_shapes import BarSegment, Chart, ChartBar
from archgen.views.short_figures import shorten_text

_CHART_WIDTH = 440.0
"""As wide as a report's text, 160 mm, less the margin round a picture. In points, as all lengths here."""
_MIN_SCALE_WIDTH = 150.0
"""The least width of the scale."""
_COLUMN_GAP = 8.0
_ROW_HEIGHT = 21.0
_HAIRLINE = 0.8
"""The least width of a stretch that is longer than zero."""
_UNKNOWN_WIDTH = 22.0
_FAR_LIMIT_FACTOR = 4
"""A limit more than this many times beyond the bars is named at the edge instead of drawn."""


@dataclass(frozen=True, slots=True)
class _ChartScale:
    """Where a chart's columns are: the scale begins at `left`, `factor` points for each unit, up to the value
    `maximum`.
    """

    left: float
    width: float
    factor: float
    maximum: float
    gap: float
    """How far something unknown pushes what follows."""
    known_until: float
    """The value up to which places on the axis are values."""

    def x(self, value: float) -> float:
        return self.left + value * self.factor

    @property
    def right(self) -> float:
        return self.left + self.width


def lay_out_chart(chart: Chart, resolve_link: LinkResolver) -> Scene:
    """Lay out a chart as a scene. y grows upwards: rows go down from 0."""
    chart = _shorten_figures(chart)
    text_colours = [palette.MUTED if bar.is_outside else palette.TEXT for bar in chart.bars]
    row_texts = [
        (wrap_bar_title(bar.title, strong=bar.strong), wrap_bar_title(bar.value, strong=bar.strong))
        for bar in chart.bars
    ]
    title_attributes = [
        style_chart_text(name, "left", resolve_link, bar.ref, bar.title, ink=ink)
        for (name, _), bar, ink in zip(row_texts, chart.bars, text_colours, strict=True)
    ]
    value_attributes = [
        style_chart_text(value, "right", resolve_link, ink=ink)
        for (_, value), ink in zip(row_texts, text_colours, strict=True)
    ]
    # Both columns at once: measuring runs a layout.
    sizes = measure_nodes([*title_attributes, *value_attributes])
    title_sizes, value_sizes = sizes[: len(title_attributes)], sizes[len(title_attributes) :]
    scale = _choose_scale(
        chart, max((w for w, _ in title_sizes), default=0.0), max((w for w, _ in value_sizes), default=0.0)
    )
    heights = [
        max(_ROW_HEIGHT, name[1] + 4, number[1] + 4) for name, number in zip(title_sizes, value_sizes, strict=True)
    ]
    right_edge = scale.right + _COLUMN_GAP + max((w for w, _ in value_sizes), default=0.0)
    parts: list[ScenePart] = []
    y = 0.0
    for index, (bar, height) in enumerate(zip(chart.bars, heights, strict=True)):
        if bar.strong:
            parts.append(
                make_thin_box(
                    f"r{index}", right_edge / 2, y, width=right_edge, height=0.6, colour=palette.NEIGHBOUR_FRAME
                )
            )
        middle = y - height / 2
        wide, high = title_sizes[index]
        parts.append(ScenePart(f"t{index}", title_attributes[index], wide / 2, middle, wide, high, "label"))
        parts += _draw_bar(bar, index, scale, middle)
        wide, high = value_sizes[index]
        parts.append(
            ScenePart(f"v{index}", value_attributes[index], right_edge - wide / 2, middle, wide, high, "label")
        )
        y -= height
    body = Scene(parts=(*_draw_grid(chart, scale, y), *parts, *_draw_limit(chart, scale, y)))
    return add_legend(_add_headline(chart, body), [*_legend_samples(chart)], chart.notes)


def _shorten_figures(chart: Chart) -> Chart:
    """Return a chart whose figures have three digits; its tips keep all of them."""
    bars = [
        replace(
            bar,
            value=shorten_text(bar.value),
            segments=tuple(
                replace(each, label=shorten_text(each.label), tooltip=each.tooltip or each.label)
                for each in bar.segments
            ),
        )
        for bar in chart.bars
    ]
    limit = chart.limit and (chart.limit[0], shorten_text(chart.limit[1]))
    return replace(chart, bars=tuple(bars), limit=limit, conclusion=shorten_text(chart.conclusion))


def _choose_scale(chart: Chart, title_width: float, value_width: float) -> _ChartScale:
    """Choose the scale so that all known stretches fit, the limit too unless it is far away, and unknown ones have
    room.
    """
    bar_ends = [bar.start + math.fsum(each.length or 0.0 for each in bar.segments) for bar in chart.bars]
    maximum = max([*bar_ends, *(bar.mark for bar in chart.bars if bar.mark is not None)], default=0.0)
    if chart.limit and (not maximum or chart.limit[0] <= _FAR_LIMIT_FACTOR * maximum):
        maximum = max(maximum, chart.limit[0])
    # A little room behind the longest bar; 1.0 for a chart in which everything is unknown or zero.
    maximum = maximum * 1.04 or 1.0
    left = title_width + _COLUMN_GAP
    width = max(_CHART_WIDTH - left - value_width - _COLUMN_GAP, _MIN_SCALE_WIDTH)
    # What is unknown has no length on the scale, but its box with the question mark needs room, and pushes what follows.
    boxes = max(bar.gaps + any(each.length is None for each in bar.segments) for bar in chart.bars) if chart.bars else 0
    gap = min(_UNKNOWN_WIDTH + 2, width / 2 / boxes) if boxes else 0.0
    # Behind the first of them the figures of the axis would be none, where it pushes anything.
    first_pushed = next((at for at, bar in enumerate(chart.bars) if bar.gaps), 0)
    known_ends = [
        bar.start + math.fsum(each.length or 0.0 for each in bar.segments)
        for bar in chart.bars[:first_pushed]
        if any(each.length is None for each in bar.segments)
    ]
    known_until = min(known_ends, default=math.inf)
    return _ChartScale(left, width, (width - gap * boxes) / maximum, maximum, gap, known_until)


def _draw_bar(bar: ChartBar, index: int, scale: _ChartScale, middle: float) -> Iterator[ScenePart]:
    x = scale.x(bar.start) + bar.gaps * scale.gap
    known_stretches = [each for each in bar.segments if each.length is not None]
    unknown_stretches = [each for each in bar.segments if each.length is None]
    for number, (each, width) in enumerate(
        zip(known_stretches, _stretch_widths(known_stretches, scale.factor), strict=True)
    ):
        if width and each.kind != "gap":
            yield ScenePart(f"b{index}.{number}", style_stretch(each, width), x + width / 2, middle, width, BAR_HEIGHT)
        x += width
    if unknown_stretches:
        question_mark = BarSegment(
            None, unknown_stretches[0].kind, "?", "\n".join(each.tooltip for each in unknown_stretches if each.tooltip)
        )
        yield ScenePart(
            f"b{index}.q",
            style_stretch(question_mark, width := min(_UNKNOWN_WIDTH, scale.gap)),
            x + width / 2,
            middle,
            width,
            BAR_HEIGHT,
        )
    if bar.mark is not None:
        yield make_thin_box(
            f"m{index}", scale.x(bar.mark), middle, width=1.6, height=_ROW_HEIGHT - 1, colour=palette.TEXT
        )


def _stretch_widths(stretches: Sequence[BarSegment], factor: float) -> list[float]:
    """Return the stretches' widths: at least a hairline each, taken from the wider ones, so the bar ends where its sum
    does.
    """
    exact_widths = [(each.length or 0.0) * factor for each in stretches]
    thin_total = math.fsum(_HAIRLINE for width in exact_widths if 0 < width < _HAIRLINE)
    thick_total = math.fsum(width for width in exact_widths if width >= _HAIRLINE)
    share = max(math.fsum(exact_widths) - thin_total, 0.0) / thick_total if thick_total else 1.0
    return [
        0.0 if not width else _HAIRLINE if width < _HAIRLINE else max(width * share, _HAIRLINE)
        for width in exact_widths
    ]


def _draw_grid(chart: Chart, scale: _ChartScale, bottom: float) -> Iterator[ScenePart]:
    """Draw thin lines at round figures, and the figures below them."""
    tick_labels = [style_small_text(text) for text, _ in _choose_ticks(scale, chart.unit)]
    for at, ((_, value), size) in enumerate(
        zip(_choose_ticks(scale, chart.unit), measure_nodes(tick_labels), strict=True)
    ):
        x = scale.x(value)
        yield make_thin_box(f"g{at}", x, bottom / 2, width=0.8, height=-bottom, colour=palette.NEIGHBOUR_FILL)
        yield ScenePart(f"a{at}", tick_labels[at], x, bottom - 7, *size, "label")


_MAX_MILLISECONDS = 3000
"""Longer axes are told in seconds, as the figures beside the bars are."""


def _choose_ticks(scale: _ChartScale, unit: str) -> list[tuple[str, float]]:
    """Return four to eight round figures along the scale, as text and value. The last names the unit."""
    # Aim at 48 points or more between two figures, room for their texts.
    smallest_step = scale.maximum / (scale.width / 48)
    power = 10.0 ** math.floor(math.log10(smallest_step))
    step = next(each * power for each in (1, 2, 5, 10) if each * power >= smallest_step)
    count = int(scale.maximum / step)
    if unit == "ms" and scale.maximum > _MAX_MILLISECONDS:
        per_unit, unit = 1000, "s"
    else:
        per_unit = 1
    ticks = [(f"{at * step / per_unit:.10g}{f' {unit}' if at == count else ''}", at * step) for at in range(count + 1)]
    known_ticks = [(text, value) for text, value in ticks if value <= scale.known_until]
    if len(known_ticks) == len(ticks):
        return ticks
    # Behind what nobody knows the figures would be no times.
    text, value = known_ticks[-1]
    return [*known_ticks[:-1], (f"{text} {unit} + ?", value)]


def _draw_limit(chart: Chart, scale: _ChartScale, bottom: float) -> Iterator[ScenePart]:
    """Draw the limit across all bars with its name above. One that is far away is only named, at the edge."""
    if chart.limit is None:
        return
    limit_value, text = chart.limit
    is_far = limit_value > min(scale.maximum, scale.known_until)
    attributes = style_small_text(f"{text} →" if is_far else text, palette.ERROR)
    ((wide, high),) = measure_nodes([attributes])
    x = scale.right if is_far else scale.x(limit_value)
    middle = min(max(x, scale.left + wide / 2), scale.right - wide / 2) if wide < scale.width else scale.left + wide / 2
    if not is_far:
        yield make_thin_box(
            "limit", x, (bottom + 4) / 2, width=1.4, height=4 - bottom, colour=palette.ERROR, tooltip=text
        )
    yield ScenePart("limits", attributes, middle, 5 + high / 2, wide, high, "label")


def _add_headline(chart: Chart, body: Scene) -> Scene:
    """Add the chart's sentence above everything."""
    if not chart.conclusion:
        return body
    left, _, right, top = body.bounds()
    rows = [escape_label(row) for row in wrap_text(chart.conclusion, max(40, int((right - left) / 5)), 6)]
    text = "\n".join(f"<B>{row}</B>" for row in rows)
    attributes = style_chart_text(text, "left", lambda _: None)
    ((wide, high),) = measure_nodes([attributes])
    part = ScenePart("said", attributes, left + wide / 2, top + 5 + high / 2, wide, high, "label")
    # Joined after the body, since the legend goes below the bounds of both.
    return body.joined(Scene(parts=(part,)))


def _legend_samples(chart: Chart) -> Iterator[tuple[Scene, str]]:
    for key in chart.legend:
        kind, _, words = key.partition(": ")
        if kind == "mark":
            sample = make_thin_box("s", 12, 0, width=1.6, height=11, colour=palette.TEXT)
        else:
            attributes = style_stretch_form(kind, 24)
            sample = ScenePart("s", {**attributes, **fix_node_size(24, 11), "tooltip": '" "'}, 12, 0, 24, 11)
        yield Scene(parts=(sample,)), words or STRETCH_FORMS[kind][2]


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


def style_stretch_form(form: str, width: float, fill: str = "") -> DotAttributes:
    """Return the attributes of an empty stretch of one form, `width` in points; with another fill than the form has."""
    style, form_fill, _ = STRETCH_FORMS[form]
    fill = fill or form_fill
    rim = palette.RIM if ":" in fill else palette.rim_colour_on(fill)
    return {
        **fix_node_size(width, BAR_HEIGHT),
        "shape": '"box"',
        "class": f'"bar {form}"',
        "style": f'"{style}"',
        "color": f'"{rim}"',
        # Two colours are stripes: one pair for every five points.
        "fillcolor": f'"{":".join([fill] * (max(1, round(width / 5)) if ":" in fill else 1))}"',
        "penwidth": "0.6" if width > 2 else "0.2",  # noqa: PLR2004 - a hairline keeps its own width
        "label": '""',
    }


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
