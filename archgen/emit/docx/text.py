"""Headings, paragraphs and lists."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from archgen.emit.docx.draft import Draft, Entry
from archgen.emit.docx.flow import Piece
from archgen.emit.docx.inlines import plain, runs
from archgen.emit.docx.markup import bookmark_name, paragraph, run
from archgen.emit.docx.numbering import label
from archgen.emit.docx.styles import HEADINGS
from archgen.views.shapes import Bullets, Inlines, Paragraph

_KINDS = {"text": "Normal", "note": "Note Box", "warning": "Warning Box", "error": "Error Box"}
_STEP = 18.0
"""Points that a list moves to the right for each level."""


def heading(  # noqa: PLR0913 - two of them are marks of the section
    draft: Draft, anchor: str, title: str, level: int, *, appendix: bool = False, new_page: bool = False
) -> Piece:
    """Give a numbered heading; it goes into the table of contents."""
    level = min(level, HEADINGS)
    formats = draft.numbering.appendices if appendix else draft.numbering.headings
    draft.counts[level:] = []
    draft.counts += [0] * (level - len(draft.counts) - 1) + ([0] if len(draft.counts) < level else [])
    draft.counts[level - 1] += 1
    anchor = draft.fresh(anchor)
    entry = Entry(bookmark_name(anchor), label(formats, draft.counts), title, level)
    draft.headings.append(entry)
    number = (
        f'<w:numPr><w:ilvl w:val="{level - 1}"/><w:numId w:val="{draft.numbering.appendix}"/></w:numPr>'
        if appendix
        else ""
    )
    properties = ("<w:pageBreakBefore/>" if new_page else "") + number
    face = draft.styles.face(f"heading {level}")
    rows = (face.line,) * face.lines(f"{entry.label} {title}", draft.sheets.base.text_width)
    xml = paragraph(draft.styles.heading(level), draft.mark(anchor) + run(title), properties)
    return Piece(xml, rows, face.before, face.after, keep_next=True, whole=True, new_page=new_page, marks=(entry.mark,))


@dataclass(frozen=True, slots=True)
class Words:
    """What stands in a paragraph: its runs, what they say, and the height that pictures among them add."""

    content: str
    text: str
    more: float = 0


def words(draft: Draft, inlines: Inlines) -> Words:
    """Give runs of text with what they say."""
    return Words(runs(draft, inlines), plain(inlines))


def said(draft: Draft, shape: Paragraph) -> Piece:
    """Give a paragraph, plain or one that stands out."""
    return flowing(draft, words(draft, shape.inlines), _KINDS[shape.kind])


def flowing(draft: Draft, held: Words, part: str = "Normal", properties: str = "", indent: float = 0) -> Piece:
    """Give a paragraph."""
    face = draft.styles.face(part)
    width = draft.sheets.base.text_width - indent
    count = sum(face.lines(line, width) for line in held.text.split("\n"))
    rows = (*((face.line,) * (count - 1)), face.line + held.more)
    return Piece(paragraph(draft.styles.id(part), held.content, properties), rows, face.before, face.after)


def bullets(draft: Draft, shape: Bullets) -> Iterator[Piece]:
    """Give a list, each item a paragraph."""
    number = draft.numbering.list_from(1) if shape.ordered else draft.numbering.bullet
    for item in shape.items:
        yield list_item(draft, words(draft, item), number, 0, ordered=shape.ordered)


def list_item(draft: Draft, held: Words, number: int, depth: int, *, ordered: bool) -> Piece:
    """Give an item of a list."""
    properties = f'<w:numPr><w:ilvl w:val="{depth}"/><w:numId w:val="{number}"/></w:numPr>'
    return flowing(draft, held, "List Number" if ordered else "List Bullet", properties, _STEP * (depth + 1))
