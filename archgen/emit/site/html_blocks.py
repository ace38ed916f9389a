"""Write the blocks of a section as HTML, and where a time goes: bars as pictures without text, their figures and reasons as
words beside.

These are functions, not template macros: measured on 350 pages they take a quarter of the time. Positions of bars are in
percent, so that they are as wide as the page lets them be and their text keeps its size.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import lru_cache

from archgen.emit.picture import Picture
from archgen.emit.site import html_text, page_pictures
from archgen.emit.site.chapter_html import ChapterWriter
from archgen.emit.site.html_text import (
    escape_breakable,
    escape_html,
    shorten_figures,
    web_address,
    write_figures,
    write_signs,
)
from archgen.emit.site.page_links import CurrentPage
from archgen.frozen import dataclass, field
from archgen.views.sequences.sequence_charts import CHART_PREFIX
from archgen.views.shapes import (
    Block,
    Bullets,
    Dashboard,
    DashboardCard,
    Facts,
    Figure,
    Inlines,
    KeyFigure,
    Markdown,
    Paragraph,
    Section,
    Table,
    Text,
    Waterfall,
    WaterfallPiece,
    WaterfallStep,
)

_HATCH_ID = "waterfall-hatch"
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
    f'<defs><pattern id="{_HATCH_ID}" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">'
    '<rect class="ground" width="7" height="7"/><rect class="line" width="2" height="7"/></pattern></defs>'
)


def _write_label(position: float, text: str, kind: str = "") -> str:
    anchor = "start" if position < _LABEL_GAP else "end" if position > 1 - _LABEL_GAP else "middle"
    class_attribute = f' class="{kind}"' if kind else ""
    return f'<text{class_attribute} x="{_percent(position)}" y="43" text-anchor="{anchor}">{escape_html(text)}</text>'


def _fill_attribute(kind: str) -> str:
    return f' fill="url(#{_HATCH_ID})"' if kind == "unknown" else ""


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


_SPOKEN_PREFIX = {"note": "Note: ", "warning": "Warning: ", "error": "Error: "}
MAX_TABLE_ROWS = 150
"""A longer table of the site is shown page by page."""
_MIN_WIDE_COLUMNS = 3
"""A table with fewer columns is not stretched: its values stay near their names."""
_ALIGNMENT_CLASS = {"left": "", "right": ' class="right"', "centre": ' class="centre"'}


@dataclass(frozen=True, slots=True)
class PageWriter:
    """Writes one page's content. `pictures` has the drawn pictures by the id of their graph."""

    current_page: CurrentPage
    pictures: Mapping[str, Picture]
    chapters: ChapterWriter
    written_anchors: set[str] = field(default_factory=set)
    standalone: bool = False
    """Whether the page is all there is: no picture has a file of its own."""

    def write_content(self, section: Section) -> str:
        """Write a page's section without its title, which is the page's."""
        return self._write_inside(section, 1)

    def write_dashboard(self, dashboard: Dashboard) -> str:
        """Write figures that link to their pages, and cards."""
        figures = "\n".join([f"<li>{self._write_key_figure(figure)}</li>" for figure in dashboard.figures])
        cards = "\n".join([self._write_card(card) for card in dashboard.cards])
        return f'<ul class="figures">\n{figures}\n</ul>\n<div class="cards">\n{cards}\n</div>'

    def write_waterfall(self, waterfall: Waterfall) -> str:
        """Write where the time of a chain goes."""
        return write_waterfall(waterfall, self.write_inlines, self._write_key_figure, self._write_card)

    def _write_key_figure(self, figure: KeyFigure) -> str:
        """Write a figure with its reason, as one link; as plain text where its page is not part of the site."""
        total = f' <span class="total">of {escape_html(figure.total)}</span>' if figure.total else ""
        inner = (
            f'<span class="title">{escape_html(figure.title)}</span> <span class="value">{write_figures(figure.value)}{total}</span>'
            f" {self.write_inlines(figure.note)}"
        )
        href = self.current_page.href(figure.ref)
        return f'<a class="figure" href="{href}">{inner}</a>' if href else f'<div class="figure">{inner}</div>'

    def _write_card(self, card: DashboardCard) -> str:
        remark = f' <span class="muted">{escape_html(card.remark)}</span>' if card.remark else ""
        link = f' <span class="all">{self.write_inlines((card.link,))}</span>' if card.link else ""
        blocks = "\n".join([self._write_block(block, 2) for block in card.blocks])
        classes = f"card w{card.width} {escape_html(card.kind)}".strip()
        return (
            f'<section class="{classes}">\n<div class="head"><h2>{escape_html(card.title)}</h2>{remark}{link}</div>\n'
            f"{blocks}\n</section>"
        )

    def _write_inside(self, section: Section, level: int) -> str:
        parts = [
            # A caption that says what the heading right above it says is for those who go from table to table.
            self._write_table(block, hides_caption=block.caption == section.title and level > 1)
            if isinstance(block, Table)
            else self._write_block(block, level)
            for block in section.blocks
        ]
        parts += [self._write_section(inner, level + 1) for inner in section.sections]
        return "\n".join(parts)

    def _write_section(self, section: Section, level: int) -> str:
        tag = f"h{min(level, 6)}"
        return (
            f"<section{self._id_attribute(section.anchor)}>\n<{tag}>{escape_breakable(section.title)}</{tag}>\n"
            f"{self._write_inside(section, level)}\n</section>"
        )

    def _write_block(self, block: Block, level: int) -> str:
        match block:
            case Paragraph():
                return self.write_paragraph(block)
            case Markdown():
                return f'<div class="prose">\n{self.chapters.write_html(block, level, self.current_page)}</div>'
            case Table():
                return self._write_table(block)
            case Facts():
                return self.write_facts(block)
            case Bullets():
                return self._write_bullets(block)
            case Figure():
                return self._write_figure(block)

    def write_paragraph(self, block: Paragraph) -> str:
        """Write a paragraph. Notes, warnings and errors stand out, and screen readers say so too."""
        if block.kind == "text":
            return f"<p>{self.write_inlines(block.inlines)}</p>"
        spoken = f'<span class="spoken">{_SPOKEN_PREFIX[block.kind]}</span>'
        return f'<p class="notice {block.kind}">{spoken}{self.write_inlines(block.inlines)}</p>'

    def write_inlines(self, runs: Inlines) -> str:
        """Write runs of text."""
        # Most cells have one run. Lists inside of join, here and below: join builds one anyway, and is slower to do so
        # from a generator.
        return self._write_run(runs[0]) if len(runs) == 1 else "".join([self._write_run(run) for run in runs])

    def _write_run(self, run: Text) -> str:
        if run.meter:
            return html_text.write_meter(run.meter)
        if run.code:
            html = f'<code class="place">{self._write_text(run)}</code>' if run.is_place else self._write_code(run)
        elif run.status or run.change or self.standalone:
            html = self._write_text(run)
        else:
            html = write_figures(run.text, is_lower=run.is_lower)  # most runs: a call of `_write_text` costs as much
        if run.strong and not run.status:
            html = f"<strong>{html}</strong>"
        if run.emphasis:
            html = f"<em>{html}</em>"
        if run.ref or run.url:
            href = (self.current_page.href(run.ref) if run.ref else None) or web_address(run.url)
            html = f'<a href="{href}">{html}</a>' if href else html
        if run.change:
            # Outside of the link, so that what was added or removed is marked as a whole.
            html = f'<span class="{run.change}">{html}</span>'
        if run.muted:
            html = f'<span class="muted">{html}</span>'
        return "<br>" + html if run.line_break else html

    def _write_code(self, run: Text) -> str:
        return f"<code>{self._write_text(run)}</code>"

    def _write_text(self, run: Text) -> str:
        # A page that is all there is has no other with the exact figure, and what has changed may be their last digits.
        has_exact_figures = run.code or self.standalone or bool(run.change)
        if run.status:
            text = write_signs(run.text) if has_exact_figures else shorten_figures(run.text)
            return html_text.write_chip(run.status, text)
        if run.code:
            return escape_breakable(run.text)
        return (
            escape_breakable(write_signs(run.text))
            if has_exact_figures
            else write_figures(run.text, is_lower=run.is_lower)
        )

    def _write_table(self, table: Table, *, hides_caption: bool = False) -> str:
        caption = escape_html(table.caption)
        # A table without anchors has an empty tuple, and `zip` is strict.
        anchors = table.row_anchors or (None,) * len(table.rows)
        openings = [f"<td{_ALIGNMENT_CLASS[column.align]}" for column in table.columns]
        rows = [self._write_row(row, anchor, openings) for row, anchor in zip(table.rows, anchors, strict=True)]
        heads = "".join([_write_head(column.title, column.align) for column in table.columns])
        rest = ""
        if len(rows) > MAX_TABLE_ROWS and not self.standalone:
            # A browser with scripts takes this for text, and shows the rows page by page; one without shows all of them.
            rest_rows = "\n".join(rows[MAX_TABLE_ROWS:])
            rows = rows[:MAX_TABLE_ROWS]
            rest = (
                f'<noscript class="rest">\n<table>\n<caption class=spoken>{caption}, continued</caption>\n'
                f"<thead><tr>{heads}</tr></thead>\n<tbody>\n{rest_rows}\n</tbody>\n</table>\n</noscript>\n"
            )
        body = "\n".join(rows)
        return (
            f'<div class="table{" narrow" if len(table.columns) < _MIN_WIDE_COLUMNS else ""}"{self._id_attribute(table.anchor)}>\n'
            f'<div class="scroll" role="group" tabindex="0" aria-label="{caption}">\n<table>\n'
            f"<caption{' class=spoken' if hides_caption else ''}>{caption}</caption>\n"
            f"{_write_widths(tuple([column.weight for column in table.columns]))}"
            f"<thead><tr>{heads}</tr></thead>\n<tbody>\n{body}\n</tbody>\n</table>\n</div>\n{rest}</div>"
        )

    def _write_row(self, row: tuple[Inlines, ...], anchor: str | None, openings: Sequence[str]) -> str:
        write_run = self._write_run
        cells = "".join(
            [
                # Most cells have one run, without a number.
                f"{opening}>{write_run(cell[0])}</td>"
                if len(cell) == 1 and cell[0].sort_number is None
                else f"{opening}{_write_sort_number(cell)}>{self.write_inlines(cell)}</td>"
                for opening, cell in zip(openings, row, strict=True)
            ]
        )
        return f"<tr{self._id_attribute(anchor) if anchor else ''}>{cells}</tr>"

    def write_facts(self, facts: Facts) -> str:
        """Write facts as a list of names and values."""
        rows = "\n".join(
            [
                f"<div><dt>{escape_html(name)}</dt><dd>{self.write_inlines(value)}</dd></div>"
                for name, value in facts.rows
            ]
        )
        return f'<dl class="facts">\n{rows}\n</dl>'

    def _write_bullets(self, bullets: Bullets) -> str:
        tag = "ol" if bullets.ordered else "ul"
        items = "\n".join([f"<li>{self.write_inlines(item)}</li>" for item in bullets.items])
        return f"<{tag}>\n{items}\n</{tag}>"

    def _write_figure(self, figure: Figure) -> str:
        caption, alt = (escape_html(write_signs(text)) for text in (figure.caption, figure.alt or figure.caption))
        picture = self.pictures.get(figure.graph)
        if picture is None or picture.svg is None:
            return (
                f'<figure class="picture"{self._id_attribute(figure.anchor)}>\n<p class="notice warning">'
                f"This picture could not be drawn.</p>\n<figcaption>{caption}</figcaption>\n</figure>"
            )
        svg = page_pictures.inline_svg(picture.svg, self.current_page.href, alt)
        upright = self.pictures.get(figure.narrow or "")
        narrow_svg = (
            page_pictures.inline_svg(upright.svg, self.current_page.href, alt) if upright and upright.svg else ""
        )
        warning = f'<p class="notice warning">{escape_html(picture.warning)}</p>\n' if picture.warning else ""
        canvas = f"canvas {name_natural_width(picture)}" if self.standalone else "canvas"
        # A sequence keeps its size: it is read from step to step, with the canvas moved below it, or as a list of steps.
        is_sequence = figure.graph.startswith(CHART_PREFIX)
        kind, focus = ("picture sequence", ' tabindex="0"') if is_sequence else ("picture", "")
        narrow = f'<div class="canvas narrow"{focus}>{narrow_svg}</div>\n' if narrow_svg else ""
        if narrow and is_sequence:
            canvas += f" {_name_least_room(picture)}"
        return (
            f'<figure class="{kind}"{self._id_attribute(figure.anchor)}>\n<div class="{canvas}"{focus}>{svg}</div>\n{narrow}{warning}'
            f"<figcaption><span>{caption}</span>{self._picture_link(figure.graph, caption)}</figcaption>\n</figure>"
        )

    def _picture_link(self, graph: str, caption: str) -> str:
        """Return the link to the picture's own file."""
        if self.standalone:
            return ""
        file = self.current_page.root + page_pictures.picture_path(graph)
        explorer = self.current_page.href("page:explorer") if graph == "overview" else None
        explorer_link = f' <a class="explore" href="{explorer}">Open in the explorer</a>' if explorer else ""
        return f' <a class="whole" href="{file}">Open picture<span class="spoken">: {caption}</span></a>{explorer_link}'

    def _id_attribute(self, anchor: str) -> str:
        """Return the id attribute of an anchor the first time that it is used on the page, else nothing: ids are
        unique.
        """
        if anchor in self.written_anchors:
            return ""
        self.written_anchors.add(anchor)
        return f' id="{self.current_page.id_for(anchor)}"'


def name_natural_width(picture: Picture) -> str:
    """Return the class that tells how wide a picture is by itself: a page's policy refuses style attributes."""
    return f"n{picture.width * 4 / 3:.0f}"


_LEAST_SCALE = 0.8
"""The smallest scale at which the words of a picture with lanes are easily read."""


def _name_least_room(picture: Picture) -> str:
    """Return the class that tells how many pixels a picture needs, in fifties; with less room its list is shown."""
    room = round(picture.width * 4 / 3 * _LEAST_SCALE / 50) * 50
    # No page has more than 1300.
    return f"from-{min(1300, max(700, room))}"


def _write_sort_number(cell: Inlines) -> str:
    """Return the attribute with the number that a cell sorts by: of several, that of the first one."""
    # A loop with `is not None`: most cells have none, and this runs for each cell of the site.
    for run in cell:
        if run.sort_number is not None:
            return f' data-sort="{escape_html(run.sort_number)}"'
    return ""


@lru_cache(8192)  # few columns are called anything else than those of other pages
def _write_head(title: str, align: str) -> str:
    return f'<th scope="col"{_ALIGNMENT_CLASS[align]}>{escape_html(title)}</th>'


@lru_cache(8192)
def _write_widths(weights: tuple[float, ...]) -> str:
    """Return the columns' shares of the width, where they differ, as classes: a page's policy refuses style attributes.

    A browser takes them as hints.
    """
    if len(set(weights)) < 2:  # noqa: PLR2004 - one share for all
        return ""
    total = math.fsum(weights)
    if not total:
        return ""
    cols = "".join([f'<col class="p{weight / total * 100:.0f}">' for weight in weights])
    return f"<colgroup>{cols}</colgroup>\n"
