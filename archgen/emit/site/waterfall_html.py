"""Write where a time goes as HTML: bars as pictures without text, their figures and reasons as words beside them.

Positions are in percent, so that bars are as wide as the page lets them be and their text keeps its size.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from archgen.emit.site.html_text import escape_html, shorten_figures, write_figures
from archgen.views.shapes import DashboardCard, Inlines, KeyFigure, Waterfall, WaterfallPiece, WaterfallStep

HATCH_ID = "waterfall-hatch"
_BAR_HEIGHT = 16
_LATE_SHARE = 0.5
"""Words of what begins behind this share of the axis stand at its right."""
_MOST_BESIDE = 12
"""The letters that stand beside a bar, on a phone too; more of them stand below it."""
_LABEL_GAP = 0.12
"""Two labels that are nearer to each other than this share would lie on each other: the first one goes."""


def write_waterfall(
    waterfall: Waterfall,
    write_inlines: Callable[[Inlines], str],
    write_figure: Callable[[KeyFigure], str],
    write_card: Callable[[DashboardCard], str],
) -> str:
    """Write the whole against its limit, the figures, the steps, and the cards. The functions write what is not special."""
    figures = "\n".join([f"<li>{write_figure(figure)}</li>" for figure in waterfall.figures])
    rows = "\n".join([_write_step(step, waterfall, write_inlines) for step in waterfall.steps])
    cards = "\n".join([write_card(card) for card in waterfall.cards])
    remark = f'<p class="muted">{write_figures(waterfall.remark)}</p>\n' if waterfall.remark else ""
    known = (
        f'<div class="card known">\n<p>{write_inlines(waterfall.lead)}</p>\n'
        f'{_write_total(waterfall)}\n<ul class="figures">\n{figures}\n</ul>\n</div>\n'
        if waterfall.total
        else ""
    )
    return (
        f'<div class="cards waterfall">\n{known}'
        f'<section class="card">\n<div class="head"><h2>{escape_html(waterfall.title)}</h2>'
        f'<span class="legend" aria-hidden="true">{_write_legend(waterfall)}</span></div>\n'
        f'{_write_axis(waterfall)}\n<ol class="steps">\n{rows}\n</ol>\n{remark}</section>\n{cards}\n</div>'
    )


def _percent(share: float) -> str:
    return f"{100 * share:.4g}%"


def _write_total(waterfall: Waterfall) -> str:
    limit = waterfall.limits[0]
    mark = (
        f'<rect class="limit" x="{_percent(min(limit, 0.998))}" width="2" y="0" height="28"/>'
        if limit is not None
        else ""
    )
    labels = list(waterfall.labels)
    # Words at the left and at the right end keep their places; what lies between gives way.
    shown = [
        label
        for at, label in enumerate(labels)
        if at == 0 or (label[0] > _LABEL_GAP and (limit is None or abs(limit - label[0]) > _LABEL_GAP * 1.5))
    ]
    words = "".join([_write_label(position, text) for position, text in shown])
    limit_word = _write_label(limit, waterfall.limit_text, "limit") if limit is not None else ""
    return (
        f'<svg class="scale whole" width="100%" height="48" aria-hidden="true">{_HATCH}'
        f"{''.join([_write_piece(piece, 5, 18) for piece in waterfall.total])}{mark}{words}{limit_word}</svg>"
    )


_HATCH = (
    f'<defs><pattern id="{HATCH_ID}" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">'
    '<rect class="ground" width="7" height="7"/><rect class="line" width="2" height="7"/></pattern></defs>'
)


def _write_label(position: float, text: str, kind: str = "") -> str:
    anchor = "start" if position < _LABEL_GAP else "end" if position > 1 - _LABEL_GAP else "middle"
    class_attribute = f' class="{kind}"' if kind else ""
    return f'<text{class_attribute} x="{_percent(position)}" y="43" text-anchor="{anchor}">{escape_html(text)}</text>'


def _fill_attribute(kind: str) -> str:
    return f' fill="url(#{HATCH_ID})"' if kind == "unknown" else ""


def _write_piece(piece: WaterfallPiece, top: int, height: int) -> str:
    tip = f"<title>{escape_html(shorten_figures(piece.tip))}</title>" if piece.tip else ""
    length = max(piece.end - piece.start, 0.002)
    html = (
        f'<rect class="{piece.kind}" x="{_percent(piece.start)}" width="{_percent(length)}" y="{top}" height="{height}"{_fill_attribute(piece.kind)}>'
        f"{tip}</rect>"
    )
    if piece.is_cut:
        middle = (piece.start + piece.end) / 2
        html += "".join(
            [
                f'<line class="cut" x1="{_percent(middle + offset - 0.004)}" x2="{_percent(middle + offset + 0.004)}" '
                f'y1="{top + height}" y2="{top}"/>'
                for offset in (-0.007, 0.007)
            ]
        )
    return html


def _write_legend(waterfall: Waterfall) -> str:
    kinds = {piece.kind for pieces in (waterfall.total, *(step.pieces for step in waterfall.steps)) for piece in pieces}
    return "".join(
        [
            f'<span><svg width="16" height="10"><rect class="{kind}" width="16" height="10"{_fill_attribute(kind)}/></svg> {escape_html(words)}</span>'
            for kind, words in waterfall.legend
            if kind in kinds
        ]
    )


def _write_axis(waterfall: Waterfall) -> str:
    ticks = "".join(
        [
            f'<text x="{_percent(place)}" y="12" text-anchor="{_anchor_tick(place)}">{escape_html(text)}</text>'
            for place, text in waterfall.ticks
        ]
    )
    # The pattern stands once on a page, with the first picture.
    hatch = "" if waterfall.total else _HATCH
    return f'<div class="axis" aria-hidden="true"><span></span><svg class="scale" width="100%" height="16">{hatch}{ticks}</svg></div>'


def _anchor_tick(place: float) -> str:
    return "start" if place == 0 else "middle" if place < 1 else "end"


def _write_step(step: WaterfallStep, waterfall: Waterfall, write_inlines: Callable[[Inlines], str]) -> str:
    lines = "".join(_write_lines(waterfall))
    pieces = "".join([_write_piece(piece, 4, _BAR_HEIGHT) for piece in step.pieces])
    limit = waterfall.limits[1]
    mark = (
        f'<rect class="limit" x="{_percent(min(limit, 0.998))}" width="2" y="0" height="24"/>'
        if limit is not None
        else ""
    )
    is_late = bool(step.pieces) and step.pieces[0].start > _LATE_SHARE
    beside = _write_beside(step)
    note = f'<span class="muted">{write_inlines(step.note)}</span>' if step.note else ""
    return (
        f'<li><div class="who">{write_inlines((step.title,))}{note}</div>'
        f'<div class="when{" late" if is_late else ""}"><svg class="scale" width="100%" height="24" aria-hidden="true">{lines}{pieces}'
        f"{mark}{beside}</svg><p{' class=spoken' if beside else ''}>{write_figures(step.words)}</p></div></li>"
    )


def _write_beside(step: WaterfallStep) -> str:
    """Write short words at the end of their bar, or before it where it ends late; empty for longer ones."""
    words = shorten_figures(step.words)
    if not step.pieces or len(words) > _MOST_BESIDE:
        return ""
    start, end = step.pieces[0].start, step.pieces[-1].end
    if end < 1 - 2 * _LABEL_GAP:
        return f'<text x="{_percent(end)}" dx="6" y="16">{escape_html(words)}</text>'
    if start > 2 * _LABEL_GAP:
        return f'<text x="{_percent(start)}" dx="-6" y="16" text-anchor="end">{escape_html(words)}</text>'
    return ""


def _write_lines(waterfall: Waterfall) -> Iterable[str]:
    """Yield the lines of the axis behind the bars."""
    for place, _ in waterfall.ticks:
        yield f'<line class="grid" x1="{_percent(place)}" x2="{_percent(place)}" y1="0" y2="24"/>'
