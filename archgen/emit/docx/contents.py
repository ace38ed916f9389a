"""The tables of contents, figures and tables: every entry a link with the number of its page.

Word gets a real field around them, which somebody can update. LibreOffice keeps what such a field holds as it is, wrong numbers too, while it computes
the page of an entry that stands outside of one. So the outer field is written for those alone who know Word 2016's additions.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from archgen.emit.docx.draft import Draft, Entry
from archgen.emit.docx.flow import Piece
from archgen.emit.docx.markup import escape, field, paragraph, run, twips

_DEEPEST = 3
"""Levels of headings in the table of contents."""
_NUMBER_ROOM = 30.0


def front(draft: Draft, pages: Mapping[str, int]) -> Iterator[Piece]:
    """Give the three lists; one without entries is left out."""
    shown = [entry for entry in draft.headings if entry.level <= _DEEPEST]
    levels = [f"toc {entry.level}" for entry in shown]
    contents = f'TOC \\o "1-{_DEEPEST}" \\h \\z \\u'
    yield from _list(draft, "Contents", contents, list(zip(shown, levels, strict=True)), pages)
    for title, kind, entries in (("Figures", "Figure", draft.figures), ("Tables", "Table", draft.tables)):
        styled = [(entry, "table of figures") for entry in entries]
        yield from _list(draft, title, f'TOC \\h \\z \\c "{kind}"', styled, pages)


def _list(
    draft: Draft, title: str, code: str, entries: Sequence[tuple[Entry, str]], pages: Mapping[str, int]
) -> Iterator[Piece]:
    if not entries:
        return
    face = draft.styles.face("TOC Heading")
    properties = '<w:numPr><w:numId w:val="0"/></w:numPr><w:outlineLvl w:val="9"/>'
    xml = paragraph(draft.styles.id("TOC Heading"), run(title), properties)
    yield Piece(xml, (face.line,), face.before, face.after, keep_next=True)
    last = len(entries) - 1
    for index, (entry, part) in enumerate(entries):
        before = _outer(code) if index == 0 else ""
        after = _in_word('<w:fldChar w:fldCharType="end"/>') if index == last else ""
        yield _line(draft, entry, part, pages.get(entry.mark, 1), (before, after))


def _line(draft: Draft, entry: Entry, part: str, page: int, around: tuple[str, str]) -> Piece:
    """Give an entry with the number of its page. `around` are the runs of the field that begins or ends with it."""
    face = draft.styles.face(part)
    width = draft.sheets.base.text_width
    separator = ": " if part == "table of figures" else "  " if entry.label else ""
    words = f"{entry.label}{separator}{entry.title}"
    link = run(words) + "<w:r><w:tab/></w:r>" + field(f"PAGEREF {entry.mark} \\h", str(page))
    content = f'{around[0]}<w:hyperlink w:anchor="{entry.mark}" w:history="1">{link}</w:hyperlink>{around[1]}'
    tabs = f'<w:tabs><w:tab w:val="right" w:leader="dot" w:pos="{twips(width)}"/></w:tabs>'
    rows = (face.line,) * face.lines(words, width - (0 if face.right else _NUMBER_ROOM))
    return Piece(paragraph(draft.styles.id(part), content, tabs), rows, face.before, face.after, whole=True)


def _outer(code: str) -> str:
    return (
        _in_word('<w:fldChar w:fldCharType="begin"/>')
        + _in_word(f'<w:instrText xml:space="preserve"> {escape(code)} </w:instrText>')
        + _in_word('<w:fldChar w:fldCharType="separate"/>')
    )


def _in_word(content: str) -> str:
    """Give a run whose content is only for programs that know Word 2016's additions."""
    return f'<w:r><mc:AlternateContent><mc:Choice Requires="w16se">{content}</mc:Choice><mc:Fallback/></mc:AlternateContent></w:r>'
