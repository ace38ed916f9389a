"""Runs of text: emphasis, code, links inside the document and to the outside."""

from __future__ import annotations

from collections.abc import Iterable

from archgen.emit.docx.draft import Draft
from archgen.emit.docx.markup import bookmark_name, run
from archgen.views.shapes import Text

_MUTED = '<w:color w:val="55606A"/>'
_CHANGES = {"added": "1C6B3C", "removed": "B3261E", "changed": "8A5300"}
_MONOSPACE = '<w:rFonts w:ascii="Consolas" w:hAnsi="Consolas" w:cs="Consolas"/>'


def runs(draft: Draft, inlines: Iterable[Text]) -> str:
    """Give runs of text as they stand in a paragraph."""
    return "".join([_linked(draft, text) if text.ref or text.url else _plain(draft, text) for text in inlines])


def plain(inlines: Iterable[Text]) -> str:
    """Give the text alone."""
    return "".join(["\n" + text.text if text.line_break else text.text for text in inlines])


def _plain(draft: Draft, text: Text, link: str = "") -> str:
    before = "<w:r><w:br/></w:r>" if text.line_break else ""
    if not (link or text.strong or text.emphasis or text.code or text.muted or text.change):
        return before + run(text.text)
    properties = ""
    if link or text.code:
        properties = f'<w:rStyle w:val="{link or draft.styles.id("Inline Code")}"/>'
    if link and text.code:
        properties += _MONOSPACE
    properties += ("<w:b/><w:bCs/>" if text.strong else "") + ("<w:i/><w:iCs/>" if text.emphasis else "")
    if text.change:
        properties += f'<w:color w:val="{_CHANGES[text.change]}"/>'
    elif text.muted and not link:
        properties += _MUTED
    return before + run(text.text, properties)


def _linked(draft: Draft, text: Text) -> str:
    if text.ref in draft.anchors:
        target = f'w:anchor="{bookmark_name(text.ref or "")}"'
    elif text.url and (relation := draft.link(text.url)):
        target = f'r:id="{relation}"'
    else:
        return _plain(draft, text)
    return f'<w:hyperlink {target} w:history="1">{_plain(draft, text, draft.styles.id("Hyperlink"))}</w:hyperlink>'
