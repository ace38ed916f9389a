"""Lay out charts: bars along one scale, at places that are computed here; Graphviz only renders them.

A chart is as wide as the text of a report. From left to right: titles, the scale with its bars, figures. Each kind of
stretch has a form beside its colour: waiting is pale with a dotted frame, response solid, a link striped, the unknown
hatched with a question mark. Grid and limit are thin boxes below and above the bars. docs/decisions/0003-charts.md
says why a chart is not a graph.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from archgen.emit.graphviz import palette
from archgen.emit.graphviz.draft import measure
from archgen.emit.graphviz.legend import under
from archgen.emit.graphviz.marks import Link, linked
from archgen.emit.graphviz.scene import Part, Scene
from archgen.emit.graphviz.text import html, quoted, wrapped
from archgen.views.bars import Bar, Chart, Stretch

Attributes = dict[str, str]
_WIDTH = 440.0
"""As wide as a report's text, 160 mm, less the margin round a picture. In points, as all lengths here."""
_LEAST = 150.0
"""The least width of the scale."""
_GAP = 8.0
_ROW = 21.0
_BAR = 14.0
_HAIR = 0.8
"""The least width of a stretch that is longer than zero."""
_UNKNOWN = 22.0
_TITLE = 26
"""Characters in a line of a title."""
_FAR = 4
"""A limit more than this many times beyond the bars is named at the edge instead of drawn."""
_FORMS: dict[str, tuple[str, str, str]] = {
    "sampling": ("filled,dotted", "#deebf7", "waits for the next activation"),
    "response": ("filled", "#2171b5", "responds"),
    "link": ("striped", "#f7cf9c:#fdf0de", "on the network"),
    "load": ("filled", "#2171b5", ""),
    "other_load": ("filled,dotted", "#9ecae1", ""),
    "met": ("filled", palette.OK, ""),
    "missed": ("filled", palette.ERROR, ""),
    "open": ("filled", palette.NEIGHBOUR_FRAME, ""),
    "best": ("filled", "#e3e6e9", ""),
    "unknown": ("striped,dashed", "#fefefe:#e3e6e9", "unknown"),
}
"""By kind of stretch: Graphviz's style, the fill (two colours make stripes), and the words of the legend."""


@dataclass(frozen=True, slots=True)
class _Scale:
    """Where a chart's columns are: the scale begins at `left`, `factor` points for each unit, up to the value
    `maximum`.
    """

    left: float
    width: float
    factor: float
    most: float

    def x(self, value: float) -> float:
        return self.left + value * self.factor

    @property
    def right(self) -> float:
        return self.left + self.width


def chart(item: Chart, link: Link) -> Scene:
    """Lay out a chart as a scene. y grows upwards: rows go down from 0."""
    inks = [palette.MUTED if bar.around else palette.TEXT for bar in item.bars]
    named = [(_rows(bar.title, strong=bar.strong), _rows(bar.value, strong=bar.strong)) for bar in item.bars]
    titles = [
        _words(name, "left", link, bar.ref, bar.title, ink=ink)
        for (name, _), bar, ink in zip(named, item.bars, inks, strict=True)
    ]
    values = [_words(value, "right", link, ink=ink) for (_, value), ink in zip(named, inks, strict=True)]
    # Both columns at once: measuring runs a layout.
    sizes = measure([*titles, *values])
    names, numbers = sizes[: len(titles)], sizes[len(titles) :]
    scale = _scale(item, max((w for w, _ in names), default=0.0), max((w for w, _ in numbers), default=0.0))
    heights = [max(_ROW, name[1] + 4, number[1] + 4) for name, number in zip(names, numbers, strict=True)]
    end = scale.right + _GAP + max((w for w, _ in numbers), default=0.0)
    parts: list[Part] = []
    y = 0.0
    for at, (bar, height) in enumerate(zip(item.bars, heights, strict=True)):
        if bar.strong:
            parts.append(_thin(f"r{at}", end / 2, y, width=end, height=0.6, colour=palette.NEIGHBOUR_FRAME))
        middle = y - height / 2
        wide, high = names[at]
        parts.append(Part(f"t{at}", titles[at], wide / 2, middle, wide, high, "label"))
        parts += _bar(bar, at, scale, middle)
        wide, high = numbers[at]
        parts.append(Part(f"v{at}", values[at], end - wide / 2, middle, wide, high, "label"))
        y -= height
    body = Scene(parts=(*_grid(item, scale, y), *parts, *_limit(item, scale, y)))
    return under(_headed(item, body), [*_legend(item)], item.notes)


def _scale(item: Chart, titles: float, values: float) -> _Scale:
    """Choose the scale so that all known stretches fit, the limit too unless it is far away, and unknown ones have
    room.
    """
    ends = [bar.start + sum(each.length or 0.0 for each in bar.stretches) for bar in item.bars]
    most = max([*ends, *(bar.mark for bar in item.bars if bar.mark is not None)], default=0.0)
    if item.limit and (not most or item.limit[0] <= _FAR * most):
        most = max(most, item.limit[0])
    # A little room behind the longest bar; 1.0 for a chart in which everything is unknown or zero.
    most = most * 1.04 or 1.0
    left = titles + _GAP
    width = max(_WIDTH - left - values - _GAP, _LEAST)
    # What is unknown has no length on the scale, but its box with the question mark needs room behind the longest bar.
    spare = _UNKNOWN + 2 if any(each.length is None for bar in item.bars for each in bar.stretches) else 0.0
    return _Scale(left, width, (width - spare) / most, most)


def _bar(bar: Bar, at: int, scale: _Scale, middle: float) -> Iterator[Part]:
    x = scale.x(bar.start)
    known = [each for each in bar.stretches if each.length is not None]
    unknown = [each for each in bar.stretches if each.length is None]
    for number, (each, width) in enumerate(zip(known, _widths(known, scale.factor), strict=True)):
        if width:
            yield Part(f"b{at}.{number}", _stretch(each, width), x + width / 2, middle, width, _BAR)
            x += width
    if unknown:
        said = Stretch(None, unknown[0].kind, "?", "\n".join(each.tooltip for each in unknown if each.tooltip))
        yield Part(f"b{at}.q", _stretch(said, _UNKNOWN), x + _UNKNOWN / 2, middle, _UNKNOWN, _BAR)
    if bar.mark is not None:
        yield _thin(f"m{at}", scale.x(bar.mark), middle, width=1.6, height=_ROW - 1, colour=palette.TEXT)


def _widths(known: Sequence[Stretch], factor: float) -> list[float]:
    """Return the stretches' widths: at least a hairline each, taken from the wider ones, so the bar ends where its sum
    does.
    """
    exact = [(each.length or 0.0) * factor for each in known]
    thin = sum(_HAIR for width in exact if 0 < width < _HAIR)
    thick = sum(width for width in exact if width >= _HAIR)
    share = max(sum(exact) - thin, 0.0) / thick if thick else 1.0
    return [0.0 if not width else _HAIR if width < _HAIR else max(width * share, _HAIR) for width in exact]


def _stretch(item: Stretch, width: float) -> Attributes:
    """Return the attributes of a stretch. Its label is inside where it fits."""
    form = "unknown" if item.length is None else item.kind
    fill = _FORMS[form][1]
    ink = palette.PAPER if ":" not in fill and palette.text_on(fill) == palette.PAPER else palette.INK
    text = html(item.label) if form != "unknown" else f"<B>{html(item.label)}</B>"
    label = f'<<FONT POINT-SIZE="{9 if form == "unknown" else 7.5}" COLOR="{ink}">{text}</FONT>>'
    fits = item.label and form != "link" and measure([{**_PLAIN, "label": label}])[0][0] + 3 <= width
    return {
        **_form(form, width),
        "label": label if fits else '""',
        "tooltip": quoted(item.tooltip or item.label),
    }


def _form(form: str, width: float) -> Attributes:
    style, fill, _ = _FORMS[form]
    rim = palette.RIM if ":" in fill else palette.rim_on(fill)
    return {
        **_sized(width, _BAR),
        "shape": '"box"',
        "class": f'"bar {form}"',
        "style": f'"{style}"',
        "color": f'"{rim}"',
        "fillcolor": f'"{_stripes(fill, width) if ":" in fill else fill}"',
        "penwidth": "0.6" if width > 2 else "0.2",  # noqa: PLR2004 - a hairline keeps its own width
        "label": '""',
    }


def _stripes(fill: str, width: float) -> str:
    """Repeat two colours, one pair for every five points."""
    return ":".join([fill] * max(1, round(width / 5)))


_PLAIN = {"shape": '"plain"'}


def _sized(width: float, height: float) -> Attributes:
    return {
        "fixedsize": '"true"',
        "width": f"{width / 72:.4f}",
        "height": f"{height / 72:.4f}",
        "margin": '"0"',
    }


def _thin(  # noqa: PLR0913 - a place, a size and a colour
    name: str, x: float, middle: float, *, width: float, height: float, colour: str, tooltip: str = " "
) -> Part:
    attributes = {
        **_sized(width, height),
        "shape": '"box"',
        "style": '"filled"',
        "class": '"bar"',
        "penwidth": "0",
        "color": f'"{colour}"',
        "fillcolor": f'"{colour}"',
        "label": '""',
        "tooltip": quoted(tooltip),
    }
    return Part(name, attributes, x, middle, width, height, "mark")


def _rows(text: str, *, strong: bool) -> str:
    rows = [html(row) for row in wrapped(text, _TITLE, 3)]
    return "\n".join(f"<B>{row}</B>" if strong else row for row in rows)


def _words(  # noqa: PLR0913 - a text, and how it stands
    rows: str, side: str, link: Link, ref: str | None = None, tooltip: str = " ", *, ink: str = palette.TEXT
) -> Attributes:
    turned = f'<BR ALIGN="{side.upper()}"/>'
    text = turned.join(rows.split("\n")) + (turned if "\n" in rows else "")
    return {
        **_PLAIN,
        "class": '"label"',
        "label": f'<<FONT POINT-SIZE="8" COLOR="{ink}">{text}</FONT>>',
        **linked(ref, tooltip, link),
    }


def _small(text: str, colour: str = palette.MUTED) -> Attributes:
    label = f'<<FONT POINT-SIZE="7.5" COLOR="{colour}">{html(text)}</FONT>>'
    return {**_PLAIN, "class": '"label"', "tooltip": '" "', "label": label}


def _grid(item: Chart, scale: _Scale, bottom: float) -> Iterator[Part]:
    """Draw thin lines at round figures, and the figures below them."""
    ticks = [_small(text) for text, _ in _ticks(scale, item.unit)]
    for at, ((_, value), size) in enumerate(zip(_ticks(scale, item.unit), measure(ticks), strict=True)):
        x = scale.x(value)
        yield _thin(f"g{at}", x, bottom / 2, width=0.8, height=-bottom, colour=palette.NEIGHBOUR_FILL)
        yield Part(f"a{at}", ticks[at], x, bottom - 7, *size, "label")


def _ticks(scale: _Scale, unit: str) -> list[tuple[str, float]]:
    """Return four to eight round figures along the scale, as text and value. The last names the unit."""
    # Aim at 48 points or more between two figures, room for their texts.
    raw = scale.most / (scale.width / 48)
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(each * power for each in (1, 2, 5, 10) if each * power >= raw)
    count = int(scale.most / step)
    return [(f"{at * step:.10g}{f' {unit}' if at == count else ''}", at * step) for at in range(count + 1)]


def _limit(item: Chart, scale: _Scale, bottom: float) -> Iterator[Part]:
    """Draw the limit across all bars with its name above. One that is far away is only named, at the edge."""
    if item.limit is None:
        return
    place, text = item.limit
    far = place > scale.most
    attributes = _small(f"{text} →" if far else text, palette.ERROR)
    ((wide, high),) = measure([attributes])
    x = scale.right if far else scale.x(place)
    middle = min(max(x, scale.left + wide / 2), scale.right - wide / 2) if wide < scale.width else scale.left + wide / 2
    if not far:
        yield _thin("limit", x, (bottom + 4) / 2, width=1.4, height=4 - bottom, colour=palette.ERROR, tooltip=text)
    yield Part("limits", attributes, middle, 5 + high / 2, wide, high, "label")


def _headed(item: Chart, body: Scene) -> Scene:
    """Add the chart's sentence above everything."""
    if not item.said:
        return body
    left, _, right, top = body.bounds()
    rows = [html(row) for row in wrapped(item.said, max(40, int((right - left) / 5)), 6)]
    text = "\n".join(f"<B>{row}</B>" for row in rows)
    attributes = _words(text, "left", lambda _: None)
    ((wide, high),) = measure([attributes])
    part = Part("said", attributes, left + wide / 2, top + 5 + high / 2, wide, high, "label")
    # Joined after the body, since the legend goes below the bounds of both.
    return body.joined(Scene(parts=(part,)))


def _legend(item: Chart) -> Iterator[tuple[Scene, str]]:
    for key in item.legend:
        kind, _, words = key.partition(": ")
        if kind == "mark":
            sample = _thin("s", 12, 0, width=1.6, height=11, colour=palette.TEXT)
        else:
            attributes = _form(kind, 24)
            sample = Part("s", {**attributes, **_sized(24, 11), "tooltip": '" "'}, 12, 0, 24, 11)
        yield Scene(parts=(sample,)), words or _FORMS[kind][2]
