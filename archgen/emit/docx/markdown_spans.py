"""The words and pictures of a Markdown paragraph: emphasis, code, links to outside and to other chapters."""

from __future__ import annotations

import posixpath
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from urllib.parse import unquote

from markdown_it.tree import SyntaxTreeNode

from archgen.emit.docx.docx_writer import DocxWriter
from archgen.emit.docx.figures import PictureRun, read_chapter_picture
from archgen.emit.docx.text_pieces import ParagraphContent
from archgen.emit.docx.text_runs import format_runs, join_text
from archgen.emit.term_mentions import MentionFinder
from archgen.views.shapes import Inlines, Text


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


def read_content(writer: DocxWriter, node: SyntaxTreeNode, source: ChapterSource) -> ParagraphContent:
    """Return what stands in a paragraph, pictures among the words too."""
    spans = list(_walk_children(writer, node, source))
    runs = [format_runs(writer, (span,)) if isinstance(span, Text) else span.xml for span in spans]
    height = max((span.height for span in spans if isinstance(span, PictureRun)), default=0.0)
    return ParagraphContent("".join(runs), join_text(span for span in spans if isinstance(span, Text)), height)


def read_inlines(node: SyntaxTreeNode, source: ChapterSource) -> Inlines:
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
