"""Runs of text: emphasis, code, links inside the document and to the outside (python-docx reads links, and writes none)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from archgen.emit.docx.docx_writer import DocxWriter
from archgen.emit.docx.text_metrics import CODE_SCALE, measure_code, measure_word, split_name
from archgen.emit.docx.word_xml import format_field, format_run, mark_label, name_bookmark, name_label_bookmark
from archgen.views.shapes import Text
from archgen.views.short_figures import write_comparisons

MUTED_COLOUR = '<w:color w:val="55606A"/>'
_CHANGE_COLOURS = {"added": "1C6B3C", "removed": "B3261E", "changed": "8A5300"}
_STATUS_COLOURS = {
    "met": "1C6B3C",
    "not proven": "8A5300",
    "open": "8A5300",
    "uncovered": "8A5300",
    "warning": "8A5300",
    "missed": "B3261E",
    "error": "B3261E",
}
"""Colours of states, which are bold as well: their words say the same on grey paper."""
_MONOSPACE_FONT = '<w:rFonts w:ascii="Consolas" w:hAnsi="Consolas" w:cs="Consolas"/>'
LINE_BREAK = "<w:r><w:br/></w:r>"


@dataclass(frozen=True, slots=True)
class RunSetting:
    """How runs are set in a cell: the type size around them and the width of a line, in points; 0 outside of tables."""

    size: float = 0
    width: float = 0

    def break_names(self, text: Text) -> str:
        """Return text with places to break in each name that is wider than the line, and in no other.

        Word finds a name by its letters only where nothing stands between them.
        """
        # No letter is wider than the type is high.
        if not self.width or (len(text.text) + 1) * self.size < self.width:
            return text.text
        return " ".join(self._break_name(word, is_code=text.code) for word in text.text.split(" "))

    def _break_name(self, word: str, *, is_code: bool) -> str:
        # A comma may follow, and stays with its word.
        width = (measure_code(word) if is_code else measure_word(word)) * self.size + _COMMA_WIDTH * self.size
        return "\u200b".join(split_name(word)) if width > self.width else word


_COMMA_WIDTH = measure_word(",")
_PLAIN_SETTING = RunSetting()


def format_runs(writer: DocxWriter, inlines: Iterable[Text], setting: RunSetting = _PLAIN_SETTING) -> str:
    """Return runs of text as they stand in a paragraph."""
    return "".join(
        [
            _format_link(writer, text, setting) if text.ref or text.url else _format_text(writer, text, setting)
            for text in inlines
        ]
    )


def join_text(inlines: Iterable[Text]) -> str:
    """Return the text alone, each line break as one."""
    return "".join(["\n" + text.text if text.line_break else text.text for text in inlines])


def _format_text(writer: DocxWriter, text: Text, setting: RunSetting, link_style: str = "") -> str:
    before = LINE_BREAK if text.line_break else ""
    shown = setting.break_names(text) if text.code else write_comparisons(setting.break_names(text))
    if not (link_style or text.strong or text.emphasis or text.code or text.muted or text.change or text.status):
        return before + format_run(shown)
    # In the order of the schema: style, font, bold, italics, colour (ECMA-376 17.3.2.28).
    properties = ""
    if link_style or text.code:
        properties = f'<w:rStyle w:val="{link_style or writer.styles.find_style_id("Inline Code")}"/>'
    if link_style and text.code:
        # A run has one character style, and a link's is the one that readers must see.
        properties += _MONOSPACE_FONT
    is_strong = text.strong or text.status in _STATUS_COLOURS
    properties += ("<w:b/><w:bCs/>" if is_strong else "") + ("<w:i/><w:iCs/>" if text.emphasis else "")
    if text.status in _STATUS_COLOURS:
        properties += f'<w:color w:val="{_STATUS_COLOURS[text.status]}"/>'
    elif text.change:
        properties += f'<w:color w:val="{_CHANGE_COLOURS[text.change]}"/>'
    elif text.muted and not link_style:
        properties += MUTED_COLOUR
    if text.code and setting.size:
        half_points = int(setting.size * CODE_SCALE * 2)  # rounded up, it would not fit what was measured
        properties += f'<w:sz w:val="{half_points}"/><w:szCs w:val="{half_points}"/>'
    return before + format_run(shown, properties)


def _format_link(writer: DocxWriter, text: Text, setting: RunSetting) -> str:
    if text.is_number and text.ref in writer.anchors:
        # What is only written later has no number yet: `docx_writer` fills it in.
        return format_field(f"REF {name_label_bookmark(text.ref or '')} \\h", mark_label(text.ref or ""))
    if text.ref in writer.anchors:
        target = f'w:anchor="{name_bookmark(text.ref or "")}"'
    elif text.url and (relation := writer.relate_link(text.url)):
        target = f'r:id="{relation}"'
    else:
        return _format_text(writer, text, setting)
    # `history` lets Word show the link as visited, as it does with its own (ECMA-376 17.16.22).
    runs = _format_text(writer, text, setting, writer.styles.find_style_id("Hyperlink"))
    return f'<w:hyperlink {target} w:history="1">{runs}</w:hyperlink>'
