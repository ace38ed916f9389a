"""Runs of text: emphasis, code, links inside the document and to the outside (python-docx reads links, and writes none)."""

from __future__ import annotations

from collections.abc import Iterable

from archgen.emit.docx.docx_writer import DocxWriter
from archgen.emit.docx.word_xml import format_run, name_bookmark
from archgen.views.shapes import Text

MUTED_COLOUR = '<w:color w:val="55606A"/>'
_CHANGE_COLOURS = {"added": "1C6B3C", "removed": "B3261E", "changed": "8A5300"}
_MONOSPACE_FONT = '<w:rFonts w:ascii="Consolas" w:hAnsi="Consolas" w:cs="Consolas"/>'
LINE_BREAK = "<w:r><w:br/></w:r>"


def format_runs(writer: DocxWriter, inlines: Iterable[Text]) -> str:
    """Return runs of text as they stand in a paragraph."""
    return "".join(
        [_format_link(writer, text) if text.ref or text.url else _format_text(writer, text) for text in inlines]
    )


def join_text(inlines: Iterable[Text]) -> str:
    """Return the text alone, each line break as one."""
    return "".join(["\n" + text.text if text.line_break else text.text for text in inlines])


def _format_text(writer: DocxWriter, text: Text, link_style: str = "") -> str:
    before = LINE_BREAK if text.line_break else ""
    if not (link_style or text.strong or text.emphasis or text.code or text.muted or text.change):
        return before + format_run(text.text)
    # In the order of the schema: style, font, bold, italics, colour (ECMA-376 17.3.2.28).
    properties = ""
    if link_style or text.code:
        properties = f'<w:rStyle w:val="{link_style or writer.styles.find_style_id("Inline Code")}"/>'
    if link_style and text.code:
        # A run has one character style, and a link's is the one that readers must see.
        properties += _MONOSPACE_FONT
    properties += ("<w:b/><w:bCs/>" if text.strong else "") + ("<w:i/><w:iCs/>" if text.emphasis else "")
    if text.change:
        properties += f'<w:color w:val="{_CHANGE_COLOURS[text.change]}"/>'
    elif text.muted and not link_style:
        properties += MUTED_COLOUR
    return before + format_run(text.text, properties)


def _format_link(writer: DocxWriter, text: Text) -> str:
    if text.ref in writer.anchors:
        target = f'w:anchor="{name_bookmark(text.ref or "")}"'
    elif text.url and (relation := writer.relate_link(text.url)):
        target = f'r:id="{relation}"'
    else:
        return _format_text(writer, text)
    # `history` lets Word show the link as visited, as it does with its own (ECMA-376 17.16.22).
    runs = _format_text(writer, text, writer.styles.find_style_id("Hyperlink"))
    return f'<w:hyperlink {target} w:history="1">{runs}</w:hyperlink>'
