"""The project's own chapters: CommonMark (with tables) turned into paragraphs, lists, code, quotations, pictures and tables.

HTML shows as text. Nothing is fetched; pictures come from the project through the draft's `chapter_files`.
"""

from __future__ import annotations

import posixpath
from collections.abc import Iterator
from dataclasses import dataclass, replace
from urllib.parse import unquote

from markdown_it import MarkdownIt
from markdown_it.tree import SyntaxTreeNode

from archgen.emit.docx import figures, tables, text
from archgen.emit.docx.draft import Draft
from archgen.emit.docx.flow import Piece
from archgen.emit.docx.inlines import plain, runs
from archgen.emit.docx.markup import run
from archgen.emit.docx.numbering import LEVELS
from archgen.views.shapes import Inlines, Markdown, Text

_STEP = 360
_ALIGN = {"text-align:right": '<w:jc w:val="right"/>', "text-align:center": '<w:jc w:val="center"/>'}
_PARSER = MarkdownIt("commonmark", {"html": False}).enable("table")


@dataclass(frozen=True, slots=True)
class _Place:
    """Where a block stands: in how many lists and quotations, and whether its first paragraph carries a list's sign."""

    chapter: Markdown
    anchor: str
    level: int
    appendix: bool
    open: list[tuple[int, int]]
    """The headings that the place stands below: the level that each asked for, and the level that it got."""
    lists: int = 0
    quotes: int = 0
    sign: tuple[int, bool] | None = None


def chapter(draft: Draft, shape: Markdown, anchor: str, level: int, *, appendix: bool) -> Iterator[Piece]:
    """Give a chapter's pieces. `anchor` and `level` are those of its section; headings in it get their own below it."""
    root = SyntaxTreeNode(_PARSER.parse(shape.text))
    yield from _blocks(draft, root, _Place(shape, anchor, level, appendix, []))


def _blocks(draft: Draft, parent: SyntaxTreeNode, place: _Place) -> Iterator[Piece]:
    for node in parent.children:
        yield from _block(draft, node, place)
        place = replace(place, sign=None)


def _block(draft: Draft, node: SyntaxTreeNode, place: _Place) -> Iterator[Piece]:
    if node.type == "heading":
        yield _heading(draft, node, place)
    elif node.type == "paragraph":
        yield from _paragraph(draft, node, place)
    elif node.type in {"bullet_list", "ordered_list"}:
        yield from _list(draft, node, place)
    elif node.type == "blockquote":
        yield from _blocks(draft, node, replace(place, quotes=place.quotes + 1))
    elif node.type in {"fence", "code_block"}:
        yield _code(draft, node.content.removesuffix("\n"), place)
    elif node.type == "table":
        yield from _table(draft, node, place)
    elif node.type == "hr":
        rule = '<w:pBdr><w:bottom w:val="single" w:sz="4" w:space="1" w:color="A9B4BD"/></w:pBdr>'
        yield text.flowing(draft, text.Words("", ""), properties=rule)


def _heading(draft: Draft, node: SyntaxTreeNode, place: _Place) -> Piece:
    """Give a heading. No level is left out: below a section of level 1 the first one has level 2, whatever it asks for."""
    title = plain(span for span in _inlines(draft, node, place, pictures=False) if isinstance(span, Text))
    asked = max(1, int(node.tag[1:]) + place.chapter.shift)
    while place.open and place.open[-1][0] >= asked:
        place.open.pop()
    level = min(asked, (place.open[-1][1] if place.open else place.level) + 1)
    place.open.append((asked, level))
    return text.heading(draft, f"{place.anchor}#{title}", title, level, appendix=place.appendix)


def _paragraph(draft: Draft, node: SyntaxTreeNode, place: _Place) -> Iterator[Piece]:
    inline = node.children[0] if node.children else node
    if len(inline.children) == 1 and inline.children[0].type == "image" and not place.lists:
        shown = _picture(draft, inline.children[0], place)
        if shown is not None:
            yield from shown
            return
    spans = _inlines(draft, node, place)
    words = _words(draft, spans)
    if place.sign is not None:
        yield text.list_item(draft, words, place.sign[0], place.lists - 1, ordered=place.sign[1])
        return
    indent = _STEP * place.lists + 284 * max(place.quotes - 1, 0) + (284 if place.quotes and place.lists else 0)
    part = "Quote" if place.quotes else "Normal"
    yield text.flowing(draft, words, part, _indented(indent), indent / 20)


def _list(draft: Draft, node: SyntaxTreeNode, place: _Place) -> Iterator[Piece]:
    ordered = node.type == "ordered_list"
    depth = min(place.lists + 1, LEVELS)
    start = int(node.attrs.get("start", 1))
    number = draft.numbering.list_from(min(start, 32767), depth - 1) if ordered else draft.numbering.bullet
    for item in node.children:
        yield from _item(draft, item, replace(place, lists=depth, sign=(number, ordered)))


def _item(draft: Draft, item: SyntaxTreeNode, place: _Place) -> Iterator[Piece]:
    """Give a list's item. One that does not begin with a paragraph gets an empty one, so that its sign is seen."""
    if place.sign is not None and (not item.children or item.children[0].type != "paragraph"):
        yield text.list_item(draft, text.Words("", ""), place.sign[0], place.lists - 1, ordered=place.sign[1])
        place = replace(place, sign=None)
    yield from _blocks(draft, item, place)


def _code(draft: Draft, code: str, place: _Place) -> Piece:
    lines = code.split("\n")
    content = "<w:r><w:br/></w:r>".join(run(line) for line in lines)
    indent = _STEP * (place.lists + place.quotes)
    return text.flowing(draft, text.Words(content, code), "Code Block", _indented(indent), indent / 20)


def _indented(indent: int) -> str:
    return f'<w:ind w:left="{indent}"/>' if indent else ""


def _table(draft: Draft, node: SyntaxTreeNode, place: _Place) -> Iterator[Piece]:
    rows = [row for part in node.children for row in part.children]
    cells = [[_texts(draft, cell, place) for cell in row.children] for row in rows]
    if len(cells[0]) > tables.MOST_COLUMNS:
        draft.warn(
            f"a table in `{place.chapter.folder or '.'}` has {len(cells[0])} columns, and Word opens {tables.MOST_COLUMNS}: it stands as text"
        )
        for row in cells:
            words = " | ".join(plain(cell) for cell in row)
            yield text.flowing(draft, text.Words(run(words), words))
        return
    aligns = [_ALIGN.get(str(cell.attrs.get("style", "")), "") for cell in rows[0].children]
    yield tables.simple(draft, cells[0], cells[1:], aligns)


@dataclass(frozen=True, slots=True)
class _Shown:
    """A picture among words."""

    xml: str
    height: float


def _words(draft: Draft, spans: list[Text | _Shown]) -> text.Words:
    parts = [runs(draft, (span,)) if isinstance(span, Text) else span.xml for span in spans]
    height = max((span.height for span in spans if isinstance(span, _Shown)), default=0.0)
    return text.Words("".join(parts), plain(span for span in spans if isinstance(span, Text)), height)


def _texts(draft: Draft, node: SyntaxTreeNode, place: _Place) -> Inlines:
    """Give the words of a table's cell; a picture in it is its text."""
    return tuple(span for span in _inlines(draft, node, place, pictures=False) if isinstance(span, Text))


def _inlines(draft: Draft, node: SyntaxTreeNode, place: _Place, *, pictures: bool = True) -> list[Text | _Shown]:
    return [span for inline in node.children for span in _walk(draft, inline, place, Text(""), pictures=pictures)]


def _walk(draft: Draft, node: SyntaxTreeNode, place: _Place, mood: Text, *, pictures: bool) -> Iterator[Text | _Shown]:
    """Give the words and pictures below a node; `mood` is how its surroundings are set."""
    if node.type in {"text", "code_inline", "html_inline"}:
        yield replace(mood, text=node.content, code=mood.code or node.type == "code_inline")
    elif node.type in {"softbreak", "hardbreak"}:
        yield replace(mood, text=" ") if node.type == "softbreak" else Text("", line_break=True)
    elif node.type == "image":
        yield _inline_picture(draft, node, place) if pictures else replace(mood, text=node.content)
    else:
        mood = replace(mood, strong=mood.strong or node.type == "strong", emphasis=mood.emphasis or node.type == "em")
        mood = _linking(mood, str(node.attrs.get("href", "")), place) if node.type == "link" else mood
        for child in node.children:
            yield from _walk(draft, child, place, mood, pictures=pictures)


def _linking(mood: Text, target: str, place: _Place) -> Text:
    """Give text the link of its surroundings: outside, or another chapter of the project."""
    if "://" in target or target.startswith("mailto:"):
        return replace(mood, url=target)
    path = target.partition("#")[0]
    inside = posixpath.normpath(posixpath.join(place.chapter.folder, unquote(path))) if path else ""
    return replace(mood, ref=f"chapter:{inside}" if inside else place.anchor)


def _inline_picture(draft: Draft, node: SyntaxTreeNode, place: _Place) -> Text | _Shown:
    shown = figures.chapter_image(draft, _path(node, place), node.content)
    return Text(node.content, emphasis=True) if shown is None else _Shown(shown[0], shown[2])


def _picture(draft: Draft, node: SyntaxTreeNode, place: _Place) -> Iterator[Piece] | None:
    """Give a picture that is a paragraph of its own; with a title it is a numbered figure."""
    shown = figures.chapter_image(draft, _path(node, place), node.content)
    if shown is None:
        return None
    title = str(node.attrs.get("title", "") or "")
    pieces = [figures.picture_piece(draft, shown[0], shown[2], None, keep_next=bool(title))]
    if title:
        pieces.append(figures.caption(draft, f"{place.anchor}!{title}", title, None))
    return iter(pieces)


def _path(node: SyntaxTreeNode, place: _Place) -> str:
    source = unquote(str(node.attrs.get("src", "")))
    return source if "://" in source else posixpath.normpath(posixpath.join(place.chapter.folder, source))
