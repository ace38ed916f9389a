"""The project's own chapters: CommonMark (with tables) as paragraphs, lists, code, quotations, pictures and tables.

HTML shows as text. Nothing is fetched; pictures come from the project through the writer's `chapter_files`.
"""

from __future__ import annotations

import posixpath
from collections.abc import Iterable, Iterator
from urllib.parse import unquote

from markdown_it import MarkdownIt
from markdown_it.tree import SyntaxTreeNode

from archgen.emit.docx.captions import write_caption
from archgen.emit.docx.docx_writer import DocxWriter
from archgen.emit.docx.figures import PictureRun, read_chapter_picture, write_picture_paragraph
from archgen.emit.docx.list_numbering import LIST_LEVELS
from archgen.emit.docx.page_flow import FlowPiece
from archgen.emit.docx.table_pieces import MAX_COLUMNS, write_chapter_table
from archgen.emit.docx.text_pieces import (
    LINE_BREAK,
    Heading,
    ParagraphContent,
    format_runs,
    join_text,
    write_heading,
    write_list_item,
    write_text,
)
from archgen.emit.docx.word_xml import format_run
from archgen.emit.term_mentions import MentionFinder, begin_text
from archgen.frozen import dataclass, field, replace
from archgen.views.shapes import Inlines, Markdown, Text


@dataclass(frozen=True, slots=True)
class ChapterSource:
    """Where a chapter's text stands: its folder in the project, and the anchor of its section."""

    folder: str
    anchor: str
    terms: MentionFinder | None = None
    """Finds the terms of the glossary, where there are some."""

    def resolve_picture(self, node: SyntaxTreeNode) -> str:
        """Return the path of a picture in the project, or its address."""
        source = unquote(str(node.attrs.get("src", "")))
        return source if "://" in source else posixpath.normpath(posixpath.join(self.folder, source))

    def link_text(self, text: Text, target: str) -> Text:
        """Return text with a link: to the outside, or to another chapter of the project."""
        if "://" in target or target.startswith("mailto:"):
            return replace(text, url=target)
        path = target.partition("#")[0]
        if not path:
            return replace(text, ref=self.anchor)
        return replace(text, ref=f"chapter:{posixpath.normpath(posixpath.join(self.folder, unquote(path)))}")


def _read_inlines(node: SyntaxTreeNode, source: ChapterSource) -> Inlines:
    """Return the words of a heading or a table's cell; a picture in it is its text."""
    spans = _walk_children(None, node, source)
    return tuple(span for span in spans if isinstance(span, Text))


def _walk_children(
    writer: DocxWriter | None, node: SyntaxTreeNode, source: ChapterSource
) -> Iterable[Text | PictureRun]:
    for inline in node.children:
        yield from _walk_span(writer, inline, source, Text(""))


def _walk_span(
    writer: DocxWriter | None, node: SyntaxTreeNode, source: ChapterSource, surroundings: Text
) -> Iterator[Text | PictureRun]:
    """Yield the words and pictures below a node; `surroundings` is how the words around it are set. Without a writer none is shown."""
    if node.type == "text" and source.terms and not (surroundings.ref or surroundings.url):
        yield from _split_mentions(replace(surroundings, text=node.content), source.terms)
    elif node.type in {"text", "code_inline", "html_inline"}:
        yield replace(surroundings, text=node.content, code=surroundings.code or node.type == "code_inline")
    elif node.type in {"softbreak", "hardbreak"}:
        yield replace(surroundings, text=" ") if node.type == "softbreak" else Text("", line_break=True)
    elif node.type == "image":
        yield replace(surroundings, text=node.content) if writer is None else _read_picture(writer, node, source)
    else:
        inner = replace(
            surroundings,
            strong=surroundings.strong or node.type == "strong",
            emphasis=surroundings.emphasis or node.type == "em",
        )
        if node.type == "link":
            inner = source.link_text(inner, str(node.attrs.get("href", "")))
        for child in node.children:
            yield from _walk_span(writer, child, source, inner)


def _split_mentions(text: Text, finder: MentionFinder) -> Iterator[Text]:
    """Yield the parts of a text: what first mentions a term leads to the glossary."""
    position = 0
    for mention in finder.find_mentions(text.text):
        if mention.start > position:
            yield replace(text, text=text.text[position : mention.start])
        yield replace(text, text=text.text[mention.start : mention.end], ref=mention.anchor)
        position = mention.end
    if position < len(text.text) or not position:
        yield replace(text, text=text.text[position:])


def _read_picture(writer: DocxWriter, node: SyntaxTreeNode, source: ChapterSource) -> Text | PictureRun:
    picture = read_chapter_picture(writer, source.resolve_picture(node), node.content)
    return Text(node.content, emphasis=True) if picture is None else picture


_LIST_STEP = 360
_QUOTE_STEP = 284
"""Twips to the right for each list and each quotation."""
_MAX_START = 32767
"""Word's dialogue takes no larger number for a list to begin with."""
_ALIGNMENTS = {"text-align:right": '<w:jc w:val="right"/>', "text-align:center": '<w:jc w:val="center"/>'}
_RULE = '<w:pBdr><w:bottom w:val="single" w:sz="4" w:space="1" w:color="A9B4BD"/></w:pBdr>'
# Without HTML: whatever a chapter holds, what Word shows is text.
_PARSER = MarkdownIt("commonmark", {"html": False}).enable("table")


@dataclass(frozen=True, slots=True)
class ListSign:
    """The bullet or number that stands before an item: its list, and whether that counts."""

    list_id: int
    ordered: bool


@dataclass(frozen=True, slots=True)
class ChapterSection:
    """The section that a chapter stands in. `shift` is added to the levels of its headings.

    `open_headings` are those that the text stands below: the level that each asks for, and the level that it got.
    """

    level: int
    shift: int
    appendix: bool
    open_headings: list[tuple[int, int]] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class BlockContext:
    """Where a block stands: in how many lists and quotations, and the sign that its first paragraph carries."""

    source: ChapterSource
    section: ChapterSection
    lists: int = 0
    quotes: int = 0
    sign: ListSign | None = None


def write_chapter(
    writer: DocxWriter, shape: Markdown, anchor: str, level: int, *, appendix: bool
) -> Iterator[FlowPiece]:
    """Write a chapter. `anchor` and `level` are those of its section; headings in it get their own below it."""
    root = SyntaxTreeNode(_PARSER.parse(shape.text))
    section = ChapterSection(level, shape.shift, appendix)
    yield from _write_blocks(
        writer, root, BlockContext(ChapterSource(shape.folder, anchor, begin_text(writer.anchors)), section)
    )


def _write_blocks(writer: DocxWriter, parent: SyntaxTreeNode, context: BlockContext) -> Iterator[FlowPiece]:
    for node in parent.children:
        yield from _write_block(writer, node, context)
        context = replace(context, sign=None)


def _write_block(writer: DocxWriter, node: SyntaxTreeNode, context: BlockContext) -> Iterator[FlowPiece]:
    match node.type:
        case "heading":
            yield _write_heading(writer, node, context)
        case "paragraph":
            yield from _write_paragraph(writer, node, context)
        case "bullet_list" | "ordered_list":
            yield from _write_list(writer, node, context)
        case "blockquote":
            yield from _write_blocks(writer, node, replace(context, quotes=context.quotes + 1))
        case "fence" | "code_block":
            yield _write_code(writer, node.content.removesuffix("\n"), context)
        case "table":
            yield from _write_table(writer, node, context)
        case "hr":
            yield write_text(writer, ParagraphContent("", ""), properties=_RULE)


def _write_heading(writer: DocxWriter, node: SyntaxTreeNode, context: BlockContext) -> FlowPiece:
    """Write a heading. No level is left out: below a section of level 1 the first one has level 2, whatever it asks for."""
    title = join_text(_read_inlines(node, replace(context.source, terms=None)))
    section = context.section
    desired = max(1, int(node.tag[1:]) + section.shift)
    while section.open_headings and section.open_headings[-1][0] >= desired:
        section.open_headings.pop()
    level = min(desired, (section.open_headings[-1][1] if section.open_headings else section.level) + 1)
    section.open_headings.append((desired, level))
    return write_heading(writer, Heading(f"{context.source.anchor}#{title}", title, level, section.appendix))


def _write_paragraph(writer: DocxWriter, node: SyntaxTreeNode, context: BlockContext) -> Iterator[FlowPiece]:
    inline = node.children[0] if node.children else node
    if len(inline.children) == 1 and inline.children[0].type == "image" and not context.lists:
        pieces = _write_picture(writer, inline.children[0], context)
        if pieces:
            yield from pieces
            return
    spans = list(_walk_children(writer, node, context.source))
    runs = [format_runs(writer, (span,)) if isinstance(span, Text) else span.xml for span in spans]
    height = max((span.height for span in spans if isinstance(span, PictureRun)), default=0.0)
    content = ParagraphContent("".join(runs), join_text(span for span in spans if isinstance(span, Text)), height)
    if context.sign is not None:
        yield _write_item_text(writer, content, context.sign, context.lists)
        return
    # Further paragraphs of an item are plain ones with its indent: with the list's number they would count.
    # The style of quotations indents the outermost one itself, but not within a list.
    quotes = max(context.quotes - 1, 0) + (1 if context.quotes and context.lists else 0)
    yield _write_indented(
        writer, content, "Quote" if context.quotes else "Normal", _LIST_STEP * context.lists + _QUOTE_STEP * quotes
    )


def _write_list(writer: DocxWriter, node: SyntaxTreeNode, context: BlockContext) -> Iterator[FlowPiece]:
    ordered = node.type == "ordered_list"
    depth = min(context.lists + 1, LIST_LEVELS)
    start = min(int(node.attrs.get("start", 1)), _MAX_START)
    list_id = writer.numbering.add_ordered_list(start, depth - 1) if ordered else writer.numbering.bullet
    for item in node.children:
        yield from _write_item(writer, item, replace(context, lists=depth, sign=ListSign(list_id, ordered)))


def _write_item(writer: DocxWriter, item: SyntaxTreeNode, context: BlockContext) -> Iterator[FlowPiece]:
    """Write a list's item. One that does not begin with a paragraph gets an empty one, so that its sign is seen."""
    if context.sign is not None and (not item.children or item.children[0].type != "paragraph"):
        yield _write_item_text(writer, ParagraphContent("", ""), context.sign, context.lists)
        context = replace(context, sign=None)
    yield from _write_blocks(writer, item, context)


def _write_item_text(writer: DocxWriter, content: ParagraphContent, sign: ListSign, lists: int) -> FlowPiece:
    return write_list_item(writer, content, sign.list_id, lists - 1, ordered=sign.ordered)


def _write_code(writer: DocxWriter, code: str, context: BlockContext) -> FlowPiece:
    """Write code as one paragraph of many lines, so that its frame has no gaps."""
    runs = LINE_BREAK.join(format_run(line) for line in code.split("\n"))
    return _write_indented(
        writer, ParagraphContent(runs, code), "Code Block", _LIST_STEP * (context.lists + context.quotes)
    )


def _write_indented(writer: DocxWriter, content: ParagraphContent, style: str, indent: int) -> FlowPiece:
    """Write a paragraph some twips to the right."""
    properties = f'<w:ind w:left="{indent}"/>' if indent else ""
    return write_text(writer, content, style, properties, indent / 20)


def _write_table(writer: DocxWriter, node: SyntaxTreeNode, context: BlockContext) -> Iterator[FlowPiece]:
    rows = [row for part in node.children for row in part.children]
    cells = [[_read_inlines(cell, context.source) for cell in row.children] for row in rows]
    if len(cells[0]) > MAX_COLUMNS:
        folder = context.source.folder or "."
        writer.warn(
            f"a table in `{folder}` has {len(cells[0])} columns, and Word opens {MAX_COLUMNS}: it stands as text"
        )
        for row in cells:
            line = " | ".join(join_text(cell) for cell in row)
            yield write_text(writer, ParagraphContent(format_run(line), line))
        return
    aligns = [_ALIGNMENTS.get(str(cell.attrs.get("style", "")), "") for cell in rows[0].children]
    yield write_chapter_table(writer, cells, aligns)


def _write_picture(writer: DocxWriter, node: SyntaxTreeNode, context: BlockContext) -> list[FlowPiece]:
    """Write a picture that is a paragraph of its own: a numbered figure, by its title or else by its text. Nothing if it cannot be shown."""
    picture = read_chapter_picture(writer, context.source.resolve_picture(node), node.content)
    if picture is None:
        return []
    title = " ".join(str(node.attrs.get("title", "") or node.content).split())
    pieces = [write_picture_paragraph(writer, picture, None, keep_next=bool(title))]
    if title:
        pieces.append(write_caption(writer, f"{context.source.anchor}!{title}", title, None))
    return pieces
