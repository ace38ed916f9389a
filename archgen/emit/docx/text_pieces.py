"""Headings, paragraphs, lists and bars, as pieces of the report's flow."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Sequence

from archgen.emit.docx.docx_writer import ContentsEntry, DocxWriter
from archgen.emit.docx.list_numbering import format_heading_number
from archgen.emit.docx.page_flow import FlowPiece
from archgen.emit.docx.style_table import HEADING_LEVELS
from archgen.emit.docx.word_xml import (
    escape_text,
    format_field,
    format_paragraph,
    format_run,
    mark_label,
    name_bookmark,
    name_label_bookmark,
)
from archgen.emit.state_colours import CHANGE_COLOURS, MUTED_COLOUR, STATUS_COLOURS
from archgen.emit.text_metrics import CODE_SCALE, measure_code, measure_word, split_name
from archgen.frozen import dataclass, replace
from archgen.views.shapes import Bullets, Inlines, Paragraph, Text, WaterfallPiece
from archgen.views.short_figures import write_comparisons

MUTED_SETTING = f'<w:color w:val="{MUTED_COLOUR}"/>'
LINE_BREAK = "<w:r><w:br/></w:r>"


@dataclass(frozen=True, slots=True)
class RunSetting:
    """How runs are set in a cell: the type size around them and the width of a line, in points; 0 outside of tables."""

    size: float = 0
    width: float = 0

    def break_names(self, inlines: Sequence[Text]) -> list[str]:
        """Return the runs' texts with places to break in each name that is wider than the line, and in no other.

        A name may run through several runs, where a part of it is a link. Word finds a name by its letters only where
        nothing stands between them.
        """
        # No letter is wider than the type is high.
        if not self.width or sum(len(text.text) + 1 for text in inlines) * self.size < self.width:
            return [text.text for text in inlines]
        pieces = [text.text.split(" ") for text in inlines]
        for word in _list_words(inlines, pieces):
            parts = [(pieces[run][place], inlines[run].code) for run, place in word]
            if _FIGURE.match("".join(part for part, _ in parts)):
                continue
            width = math.fsum(measure_code(part) if is_code else measure_word(part) for part, is_code in parts)
            if width * self.size > self.width:
                for run, place in word:
                    pieces[run][place] = self._break_name(pieces[run][place], is_last=(run, place) == word[-1])
        return [" ".join(words) for words in pieces]

    @staticmethod
    def _break_name(part: str, *, is_last: bool) -> str:
        broken = "\u200b".join(split_name(part)) if part else part
        return broken if is_last or not part.endswith(("_", ".", "/")) else f"{broken}\u200b"


def _list_words(inlines: Sequence[Text], pieces: Sequence[Sequence[str]]) -> list[list[tuple[int, int]]]:
    """Return words as the numbers of their runs and of their places there: a comma behind a name is a part of it."""
    words: list[list[tuple[int, int]]] = []
    for run, places in enumerate(pieces):
        for place in range(len(places)):
            if words and not place and not inlines[run].line_break:
                words[-1].append((run, place))
            else:
                words.append([(run, place)])
    return words


_FIGURE = re.compile(r"[^\w/]*[0-9]")
"""No name: its point is a decimal one."""
_PLAIN_SETTING = RunSetting()


def format_runs(writer: DocxWriter, inlines: Iterable[Text], setting: RunSetting = _PLAIN_SETTING) -> str:
    """Return runs of text as they stand in a paragraph."""
    runs = tuple(inlines)
    return "".join(
        [
            (_format_link if text.ref or text.url else _format_text)(writer, text, shown, setting)
            for text, shown in zip(runs, setting.break_names(runs), strict=True)
        ]
    )


def join_text(inlines: Iterable[Text]) -> str:
    """Return the text alone, each line break as one."""
    return "".join(["\n" + text.text if text.line_break else text.text for text in inlines])


def _format_text(writer: DocxWriter, text: Text, shown: str, setting: RunSetting, link_style: str = "") -> str:
    before = LINE_BREAK if text.line_break else ""
    if text.meter or text.pieces:
        return before + format_bar(text, setting.width) + (format_run(shown) if shown else "")
    shown = shown if text.code else write_comparisons(shown)
    if not (link_style or text.strong or text.emphasis or text.code or text.muted or text.change or text.status):
        return before + format_run(shown, joins_ids=True)
    # In the order of the schema: style, font, bold, italics, colour (ECMA-376 17.3.2.28).
    properties = ""
    if link_style or text.code:
        properties = f'<w:rStyle w:val="{link_style or writer.styles.find_style_id("Inline Code")}"/>'
    if link_style and text.code:
        # A run has one character style, and a link's is the one that readers must see.
        font = escape_text(writer.styles.find_font("Inline Code"))
        properties += f'<w:rFonts w:ascii="{font}" w:hAnsi="{font}" w:cs="{font}"/>' if font else ""
    is_strong = text.strong or text.status in STATUS_COLOURS
    properties += ("<w:b/><w:bCs/>" if is_strong else "") + ("<w:i/><w:iCs/>" if text.emphasis else "")
    if text.status and text.status in STATUS_COLOURS:
        properties += f'<w:color w:val="{STATUS_COLOURS[text.status]}"/>'
    elif text.change:
        properties += f'<w:color w:val="{CHANGE_COLOURS[text.change]}"/>'
    elif text.muted and not link_style:
        properties += MUTED_SETTING
    if text.code and (setting.size or link_style):
        # Rounded up, it would not fit what was measured. A link's style is another one than that of code.
        size = setting.size * CODE_SCALE or writer.styles.find_face("Inline Code").size
        half_points = int(size * 2)
        properties += f'<w:sz w:val="{half_points}"/><w:szCs w:val="{half_points}"/>'
    # In strong type stands the id of what is told here: searched for with the hyphen of the keyboard, it is found.
    return before + format_run(shown, properties, joins_ids=not text.strong and not text.code)


def _format_link(writer: DocxWriter, text: Text, shown: str, setting: RunSetting) -> str:
    if text.is_number and text.ref in writer.anchors:
        # What is only written later has no number yet: `docx_writer` fills it in.
        return format_field(f"REF {name_label_bookmark(text.ref or '')} \\h", mark_label(text.ref or ""))
    if text.ref in writer.anchors:
        target = f'w:anchor="{name_bookmark(text.ref or "")}"'
    elif text.url and (relation := writer.relate_link(text.url)):
        target = f'r:id="{relation}"'
    else:
        return _format_text(writer, text, shown, setting)
    # `history` lets Word show the link as visited, as it does with its own (ECMA-376 17.16.22).
    runs = _format_text(writer, text, shown, setting, writer.styles.find_style_id("Hyperlink"))
    return f'<w:hyperlink {target} w:history="1">{runs}</w:hyperlink>'


_LOOSE_STYLE = re.compile(r'<w:pStyle w:val="[^"]*"/>(?!<w:keepNext/>)')
"""The style of each paragraph that may part from the next one."""
_PARAGRAPH_STYLES = {"text": "Normal", "note": "Note Box", "warning": "Warning Box", "error": "Error Box"}
_LIST_STEP = 18.0
"""Points that a list moves to the right for each level."""


@dataclass(frozen=True, slots=True)
class ParagraphContent:
    """What stands in a paragraph: its runs, their plain text, and the points of height that pictures among them add."""

    runs: str
    text: str
    picture_height: float = 0


@dataclass(frozen=True, slots=True)
class Heading:
    """A heading before it is written. `level` counts from 1."""

    anchor: str
    title: str
    level: int
    appendix: bool = False
    new_page: bool = False


def write_heading(writer: DocxWriter, heading: Heading) -> FlowPiece:
    """Write a numbered heading; it goes into the table of contents."""
    level = min(heading.level, HEADING_LEVELS)
    anchor = writer.find_free_anchor(heading.anchor)
    counts = writer.heading_counts
    counts[level:] = []
    counts += [0] * (level - len(counts))
    counts[level - 1] += 1
    label = format_heading_number(
        writer.numbering.appendices if heading.appendix else writer.numbering.headings, counts
    )
    entry = ContentsEntry(name_bookmark(anchor), label, heading.title, level)
    writer.headings.append(entry)
    # The heading styles number chapters; an appendix has the same style and the lettered list.
    number = _format_number(level - 1, writer.numbering.appendix) if heading.appendix else ""
    properties = ("<w:pageBreakBefore/>" if heading.new_page else "") + number
    face = writer.styles.find_face(f"heading {level}")
    rows = (face.line,) * face.count_lines(f"{label} {heading.title}", writer.paper.base.text_width)
    runs = writer.format_bookmark(anchor) + format_run(heading.title)
    return FlowPiece(
        format_paragraph(writer.styles.find_heading_id(level), runs, properties),
        rows,
        face.before,
        face.after,
        keep_next=True,
        whole=True,
        new_page=heading.new_page,
        marks=(entry.bookmark,),
    )


def write_content(writer: DocxWriter, inlines: Inlines) -> ParagraphContent:
    """Write runs of text with their plain text."""
    return ParagraphContent(format_runs(writer, inlines), join_text(inlines))


def write_paragraph(writer: DocxWriter, shape: Paragraph) -> FlowPiece:
    """Write a paragraph, plain or one that stands out."""
    return write_text(writer, write_content(writer, shape.inlines), _PARAGRAPH_STYLES[shape.kind])


def write_text(
    writer: DocxWriter, content: ParagraphContent, style: str = "Normal", properties: str = "", indent: float = 0
) -> FlowPiece:
    """Write a paragraph in a style, `indent` points from the left margin."""
    face = writer.styles.find_face(style)
    width = writer.paper.base.text_width - indent
    count = sum(face.count_lines(line, width) for line in content.text.split("\n"))
    rows = (*((face.line,) * (count - 1)), face.line + content.picture_height)
    xml = format_paragraph(writer.styles.find_style_id(style), content.runs, properties)
    return FlowPiece(xml, rows, face.before, face.after)


def keep_with_next(piece: FlowPiece) -> FlowPiece:
    """Return a paragraph or a table that stays on the page, and the paper, of what follows it."""
    return replace(piece, xml=_LOOSE_STYLE.sub(r"\g<0><w:keepNext/>", piece.xml), keep_next=True, whole=True)


def write_bullets(writer: DocxWriter, shape: Bullets) -> Iterator[FlowPiece]:
    """Write a list, each item a paragraph."""
    list_id = writer.numbering.add_ordered_list(1) if shape.ordered else writer.numbering.bullet
    for item in shape.items:
        yield write_list_item(writer, write_content(writer, item), list_id, 0, ordered=shape.ordered)


def write_list_item(
    writer: DocxWriter, content: ParagraphContent, list_id: int, depth: int, *, ordered: bool
) -> FlowPiece:
    """Write an item of a list; the outermost list has depth 0."""
    style = "List Number" if ordered else "List Bullet"
    return write_text(writer, content, style, _format_number(depth, list_id), _LIST_STEP * (depth + 1))


def _format_number(depth: int, list_id: int) -> str:
    return f'<w:numPr><w:ilvl w:val="{depth}"/><w:numId w:val="{list_id}"/></w:numPr>'


METER_LENGTH, PIECES_LENGTH = 40.0, 200.0
"""Lengths of a bar in points: of a share, and of stretches on an axis."""
_BLANK = "\u00a0"
_BLANK_WIDTH = measure_word(" ")
_TYPE_SIZE = 5.0
"""Type size of the blanks: how high the bar is."""
_PALE = "E4E9ED"
_COLOURS = {
    "met": "1C6B3C", "not proven": "C78A2B", "open": "C78A2B", "missed": "B3261E", "uncovered": "C78A2B", "warning": "C78A2B",
    "sampling": "9CC5DF", "response": "1F6FB5", "link": "8D99A3",
}  # fmt: skip


def measure_bar(text: Text) -> float:
    """Return the length of a run's bar in points, 0 where it has none."""
    return PIECES_LENGTH if text.pieces else METER_LENGTH if text.meter else 0.0


def format_bar(text: Text, width: float) -> str:
    """Return the runs of a run's bar, `width` points long where that is known and less than usual."""
    length = min(measure_bar(text), width or METER_LENGTH * 4)
    count = max(int(length / (_BLANK_WIDTH * _TYPE_SIZE)), 1)
    return "".join(_format_stretch(size, colour) for size, colour in _list_stretches(text, count))


def _list_stretches(text: Text, count: int) -> Iterator[tuple[int, str]]:
    """Yield the stretches of a bar of so many blanks, each with its colour: empty for none."""
    if text.meter and not text.pieces:
        filled = min(max(round(text.meter.share * count), 1 if text.meter.share else 0), count)
        yield filled, _COLOURS.get(text.meter.status, _PALE)
        yield count - filled, _PALE
        return
    position = 0
    for piece in text.pieces:
        start, end = round(piece.start * count), round(piece.end * count)
        start = max(start, position)
        yield start - position, ""
        position = max(end, start + 1)
        yield from _list_piece(piece, position - start)
    if text.meter:
        yield count - position, _PALE


def _list_piece(piece: WaterfallPiece, size: int) -> Iterator[tuple[int, str]]:
    colour = _COLOURS.get(piece.kind, "")
    if piece.is_cut and size > 4:  # noqa: PLR2004 - two halves, and what parts them
        # Drawn short: two halves with a gap.
        yield from ((size // 2 - 1, colour), (1, ""), (size - size // 2, colour))
    else:
        yield size, colour or "unknown"


def _format_stretch(size: int, colour: str) -> str:
    if size <= 0:
        return ""
    half_points = round(_TYPE_SIZE * 2)
    shade = ""
    if colour == "unknown":
        shade = '<w:shd w:val="diagStripe" w:color="C78A2B" w:fill="FBF1E4"/>'
    elif colour:
        shade = f'<w:shd w:val="clear" w:color="auto" w:fill="{colour}"/>'
    return format_run(_BLANK * size, f'<w:sz w:val="{half_points}"/><w:szCs w:val="{half_points}"/>{shade}')
