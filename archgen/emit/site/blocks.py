"""Write the blocks of a section as HTML.

These are functions, not template macros: measured on 350 pages they take a quarter of the time.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from archgen.emit.picture import Picture
from archgen.emit.site import pictures
from archgen.emit.site.chapters import Chapters
from archgen.emit.site.links import Here
from archgen.emit.site.markup import escape, web, words
from archgen.views.shapes import (
    Block,
    Bullets,
    Column,
    Facts,
    Figure,
    Inlines,
    Markdown,
    Paragraph,
    Section,
    Table,
    Text,
)

_SPOKEN = {"note": "Note: ", "warning": "Warning: ", "error": "Error: "}
_WIDE = 3
"""A table with fewer columns is not stretched: its values stay near their names."""
_ALIGNED = {"left": "", "right": ' class="right"', "centre": ' class="centre"'}


@dataclass(frozen=True, slots=True)
class Writer:
    """Writes one page's content. `pictures` has the drawn pictures by the id of their graph."""

    here: Here
    drawn: Mapping[str, Picture]
    chapters: Chapters
    seen: set[str] = field(default_factory=set)
    alone: bool = False
    """Whether the page is all there is: no picture has a file of its own."""

    def content(self, section: Section) -> str:
        """Write a page's section without its title, which is the page's."""
        return self._inside(section, 1)

    def _inside(self, section: Section, level: int) -> str:
        parts = [self._block(block, level) for block in section.blocks]
        parts += [self._section(inner, level + 1) for inner in section.sections]
        return "\n".join(parts)

    def _section(self, section: Section, level: int) -> str:
        tag = f"h{min(level, 6)}"
        return (
            f"<section{self._id(section.anchor)}>\n<{tag}>{words(section.title)}</{tag}>\n"
            f"{self._inside(section, level)}\n</section>"
        )

    def _block(self, block: Block, level: int) -> str:
        match block:
            case Paragraph():
                return self.paragraph(block)
            case Markdown():
                return f'<div class="prose">\n{self.chapters.html(block, level, self.here)}</div>'
            case Table():
                return self._table(block)
            case Facts():
                return self.facts(block)
            case Bullets():
                return self._bullets(block)
            case Figure():
                return self._figure(block)

    def paragraph(self, block: Paragraph) -> str:
        """Write a paragraph. Notes, warnings and errors stand out, and screen readers say so too."""
        if block.kind == "text":
            return f"<p>{self.inlines(block.inlines)}</p>"
        spoken = f'<span class="spoken">{_SPOKEN[block.kind]}</span>'
        return f'<p class="notice {block.kind}">{spoken}{self.inlines(block.inlines)}</p>'

    def inlines(self, runs: Inlines) -> str:
        """Write runs of text."""
        # Lists inside of join, here and below: join builds one anyway, and is slower to do so from a generator.
        return "".join([self._run(run) for run in runs])

    def _run(self, run: Text) -> str:
        html = words(run.text)
        if run.code:
            html = f"<code>{html}</code>"
        if run.strong:
            html = f"<strong>{html}</strong>"
        if run.emphasis:
            html = f"<em>{html}</em>"
        href = (self.here.href(run.ref) if run.ref else None) or web(run.url)
        if href:
            html = f'<a href="{href}">{html}</a>'
        if run.change:
            # Outside of the link, so that what was added or removed is marked as a whole.
            html = f'<span class="{run.change}">{html}</span>'
        if run.muted:
            html = f'<span class="muted">{html}</span>'
        return "<br>" + html if run.line_break else html

    def _table(self, table: Table) -> str:
        caption = escape(table.caption)
        # A table without anchors has an empty tuple, and `zip` is strict.
        anchors = table.row_anchors or (None,) * len(table.rows)
        body = "\n".join([self._row(row, anchor, table) for row, anchor in zip(table.rows, anchors, strict=True)])
        return (
            f'<div class="table{" narrow" if len(table.columns) < _WIDE else ""}"{self._id(table.anchor)}>\n'
            f'<div class="scroll" role="group" tabindex="0" aria-label="{caption}">\n<table>\n'
            f"<caption>{caption}</caption>\n{_widths(table.columns)}"
            f"<thead><tr>{_heads(table.columns)}</tr></thead>\n<tbody>\n{body}\n</tbody>\n</table>\n</div>\n</div>"
        )

    def _row(self, row: tuple[Inlines, ...], anchor: str | None, table: Table) -> str:
        cells = "".join(
            [
                f"<td{_ALIGNED[column.align]}>{self.inlines(cell)}</td>"
                for column, cell in zip(table.columns, row, strict=True)
            ]
        )
        return f"<tr{self._id(anchor) if anchor else ''}>{cells}</tr>"

    def facts(self, facts: Facts) -> str:
        """Write facts as a list of names and values."""
        rows = "\n".join(
            [f"<div><dt>{escape(name)}</dt><dd>{self.inlines(value)}</dd></div>" for name, value in facts.rows]
        )
        return f'<dl class="facts">\n{rows}\n</dl>'

    def _bullets(self, bullets: Bullets) -> str:
        tag = "ol" if bullets.ordered else "ul"
        items = "\n".join([f"<li>{self.inlines(item)}</li>" for item in bullets.items])
        return f"<{tag}>\n{items}\n</{tag}>"

    def _figure(self, figure: Figure) -> str:
        caption, alt = escape(figure.caption), escape(figure.alt or figure.caption)
        picture = self.drawn.get(figure.graph)
        if picture is None or picture.svg is None:
            return (
                f'<figure class="picture"{self._id(figure.anchor)}>\n<p class="notice warning">'
                f"This picture could not be drawn.</p>\n<figcaption>{caption}</figcaption>\n</figure>"
            )
        svg = pictures.inline(picture.svg, self.here.href, alt)
        warning = f'<p class="notice warning">{escape(picture.warning)}</p>\n' if picture.warning else ""
        return (
            f'<figure class="picture"{self._id(figure.anchor)}>\n<div class="canvas"{self._natural(picture)}>{svg}</div>\n{warning}'
            f"<figcaption><span>{caption}</span>{self._whole(figure.graph, caption)}</figcaption>\n</figure>"
        )

    def _natural(self, picture: Picture) -> str:
        """Return the style for a picture that has no file of its own: it scrolls before it gets too small to read."""
        return f' style="--natural: {picture.width * 4 / 3:.0f}px"' if self.alone else ""

    def _whole(self, graph: str, caption: str) -> str:
        """Return the link to the picture's own file."""
        if self.alone:
            return ""
        file = self.here.root + pictures.path(graph)
        return f' <a class="whole" href="{file}">Open picture<span class="spoken">: {caption}</span></a>'

    def _id(self, anchor: str) -> str:
        """Return the id attribute of an anchor the first time that it is used on the page, else nothing: ids are
        unique.
        """
        if anchor in self.seen:
            return ""
        self.seen.add(anchor)
        return f' id="{self.here.id(anchor)}"'


def _heads(columns: Iterable[Column]) -> str:
    return "".join([f'<th scope="col"{_ALIGNED[column.align]}>{escape(column.title)}</th>' for column in columns])


def _widths(columns: tuple[Column, ...]) -> str:
    """Return the columns' shares of the width, where they differ. A browser takes them as hints."""
    total = sum(column.weight for column in columns)
    if len({column.weight for column in columns}) == 1 or not total:
        return ""
    cols = "".join([f'<col style="width:{column.weight / total * 100:.3g}%">' for column in columns])
    return f"<colgroup>{cols}</colgroup>\n"
