"""A presentation, its template, and slides as python-pptx makes them: titles in their placeholders, text and tables that people edit, pictures."""

from __future__ import annotations

import io
import re
from collections.abc import Iterable, Sequence
from datetime import datetime
from typing import Any

from lxml import etree
from pptx import Presentation
from pptx.dml.color import RGBColor
from pptx.enum.text import MSO_ANCHOR, PP_ALIGN
from pptx.opc.constants import CONTENT_TYPE, RELATIONSHIP_TYPE
from pptx.opc.package import Part
from pptx.opc.packuri import PackURI
from pptx.oxml.ns import qn
from pptx.util import Emu, Pt

from archgen.emit.office_package import STAMP, replace_forbidden
from archgen.emit.own_file_marks import PROGRAM_PART
from archgen.emit.picture import Picture
from archgen.emit.pptx.slide_flow import (
    BODY_TOP,
    FIGURE_SCALE,
    GAP,
    MARGIN,
    SIDE_PADDING,
    SLIDE_HEIGHT,
    SLIDE_WIDTH,
    Place,
    Placed,
    PlacedPicture,
    PlacedTable,
    PlacedText,
    cut_runs,
)
from archgen.emit.state_colours import CHANGE_COLOURS, MUTED_COLOUR, STATUS_COLOURS
from archgen.emit.template_package import TemplateError, parse_part, read_content_types, unpack_template, zip_parts
from archgen.emit.text_metrics import CODE_SCALE
from archgen.frozen import dataclass
from archgen.views.inline_text import cut_text
from archgen.views.shapes import Inlines, Outline, Text
from archgen.views.short_figures import write_comparisons

_EMU_PER_POINT = 12_700
_INK, _LINE, _HEADING_FILL, _ACCENT = "1A2129", "C9D1D8", "EEF2F5", "1F6FB5"
_TITLE_SIZE, _LONG_TITLE_SIZE, _COVER_SIZE = 26, 18, 40
_LONG_TITLE, _MAX_TITLE, _MAX_COVER_TITLE = 58, 170, 120
_MAX_TITLE_LINES = 2
_FOOTER_SIZE = 10
_MAX_FACT = 150
_CODE_FONT = "Consolas"
_PLAIN_TABLE = "{2D5ABB26-0587-4C30-8999-92F81FD0307C}"
"""The style of tables without lines and grounds: both are set here, so that all programs show the same."""
_SVG_EXTENSION = "{96DAC541-7B7A-43D3-8B79-37D633B846F1}"
_SVG_NAMESPACE = "http://schemas.microsoft.com/office/drawing/2016/SVG/main"
_BLANKS = re.compile(r"[\t\r\n\v\f]+")
_APPLICATION = (
    b'<?xml version="1.0" encoding="UTF-8" standalone="yes"?>\n<Properties xmlns='
    b'"http://schemas.openxmlformats.org/officeDocument/2006/extended-properties"><Application></Application></Properties>'
)


@dataclass(frozen=True, slots=True)
class _TextColours:
    """The colours of text: `plain` is that of text without a state (None: that of the theme)."""

    plain: str | None
    is_light: bool = False

    def choose_colour(self, text: Text) -> str | None:
        """Return the colour of a run as digits, made lighter where the ground is dark."""
        colour = STATUS_COLOURS.get(text.status or "") or CHANGE_COLOURS.get(text.change or "")
        colour = colour or (MUTED_COLOUR if text.muted else self.plain)
        if colour and self.is_light:
            return "".join(f"{(each + 2 * 255) // 3:02X}" for each in bytes.fromhex(colour))
        return colour


class SlideDrawing:
    """The presentation, with its first slide made; the others are added."""

    def __init__(self, outline: Outline, template: bytes | None) -> None:
        """Open a partner's template, or take python-pptx's to 16:9 for None, and make the first slide.

        Raise TemplateError if the template cannot be used.
        """
        self._has_template = template is not None
        self._presentation: Any = Presentation() if template is None else open_template(template)
        if template is None:
            self._widen_pages()
        self._cover_layout = find_layout(self._presentation, "title")
        self._body_layout = find_layout(self._presentation, "titleOnly", self._cover_layout)
        self._colours = (
            _TextColours(None, has_light_text(self._presentation)) if self._has_template else _TextColours(_INK)
        )
        self._scale = self._presentation.slide_width / _measure(SLIDE_WIDTH)
        self._pictures: dict[str, Part] = {}
        properties = outline.properties
        footer = (
            outline.title,
            properties.get("version", ""),
            properties.get("date", ""),
            properties.get("revision", ""),
        )
        self._footer = cut_text(" · ".join(filter(None, footer)), _MAX_FACT)
        self._write_properties(outline)
        self._add_cover(outline)

    def _widen_pages(self) -> None:
        width = self._presentation.slide_width
        self._presentation.slide_width, self._presentation.slide_height = _measure(SLIDE_WIDTH), _measure(SLIDE_HEIGHT)
        for page in (self._presentation.slide_master, *self._presentation.slide_layouts):
            for shape in page.placeholders:
                if shape._element.spPr.xfrm is not None:  # noqa: SLF001 - what it takes over stays taken over
                    shape.left, shape.width = (
                        round(side * _measure(SLIDE_WIDTH) / width) for side in (shape.left, shape.width)
                    )

    def _write_properties(self, outline: Outline) -> None:
        package = self._presentation.part.package
        core = self._presentation.core_properties
        core.title = _clean(outline.title)[:255]
        core.author = _clean(outline.properties.get("authors", ""))[:255]
        core.last_modified_by, core.revision = "", 1
        core.created = core.modified = datetime(*STAMP[:3])  # noqa: DTZ001 - no clock
        for key, relation in list(package._rels.items()):  # noqa: SLF001 - it shows a slide that is not there
            if relation.reltype.endswith("/thumbnail"):
                package._rels.pop(key)  # noqa: SLF001
        for key, relation in list(package._rels.items()):  # noqa: SLF001 - python-pptx has no such part
            if relation.reltype == RELATIONSHIP_TYPE.EXTENDED_PROPERTIES:
                package._rels.pop(key)  # noqa: SLF001
        program = Part(PackURI(f"/{PROGRAM_PART}"), CONTENT_TYPE.OFC_EXTENDED_PROPERTIES, package, _APPLICATION)
        package.relate_to(program, RELATIONSHIP_TYPE.EXTENDED_PROPERTIES)

    def _add_cover(self, outline: Outline) -> None:
        slide = self._presentation.slides.add_slide(self._cover_layout)
        title, subtitle = slide.shapes.title, _keep_subtitle(slide)
        if not self._has_template:
            _set_place(title, Place(2 * MARGIN, 110, SLIDE_WIDTH - 4 * MARGIN, 130))
            title.text_frame.vertical_anchor = MSO_ANCHOR.BOTTOM
        if subtitle is None or not self._has_template:
            subtitle = subtitle or slide.shapes.add_textbox(0, 0, 1, 1)
            _set_place(subtitle, Place(2 * MARGIN, 262, SLIDE_WIDTH - 4 * MARGIN, 220))
        self._write_title(title, outline.title, is_cover=True)
        lines: list[Inlines] = [(Text(outline.subtitle, strong=True),)] if outline.subtitle else []
        for name, value in outline.facts:
            text = cut_text("".join(run.text for run in value), _MAX_FACT)
            lines.append((Text(f"{name}: ", muted=True), Text(text)))
        lines += [notice.inlines for notice in outline.notices]
        _write_paragraphs(subtitle.text_frame, lines or ((Text(""),),), 16, colours=self._colours)
        if self._has_template:
            scale_slide(slide, self._scale)
            return
        rule = slide.shapes.add_shape(1, *_list_sides(Place(2 * MARGIN + 7, 250, 90, 3)))
        rule.fill.solid()
        rule.fill.fore_color.rgb = _read_colour(_ACCENT)
        rule.line.fill.background()

    def add_slide(self, title: str, number: str, placed: Iterable[Placed]) -> None:
        """Add a slide; `number` says which one of several of the same title it is."""
        slide = self._presentation.slides.add_slide(self._body_layout)
        shape = slide.shapes.title
        for other in [each for each in slide.placeholders if each.shape_id != shape.shape_id]:
            other._element.getparent().remove(other._element)  # noqa: SLF001 - else it asks for text
        if not self._has_template or shape.top + shape.height > _measure(BODY_TOP) * self._scale:
            _set_place(shape, Place(MARGIN - 7, 22, SLIDE_WIDTH - 2 * MARGIN + 14, 50))
        shape.text_frame.vertical_anchor = MSO_ANCHOR.MIDDLE
        self._write_title(shape, title, number)
        for each in placed:
            match each:
                case PlacedText():
                    box = slide.shapes.add_textbox(*_list_sides(each.place))
                    _clear_margins(box.text_frame)
                    _write_paragraphs(box.text_frame, each.paragraphs, each.size, colours=self._colours)
                case PlacedTable():
                    _add_table(slide, each, self._colours)
                case PlacedPicture():
                    self._add_picture(slide, each)
        self._add_footer(slide)
        if self._has_template:
            scale_slide(slide, self._scale)

    def _write_title(self, shape: Any, title: str, number: str = "", *, is_cover: bool = False) -> None:  # noqa: ANN401
        text = cut_text(" ".join(title.split()), _MAX_COVER_TITLE if is_cover else _MAX_TITLE)
        runs = (Text(text, strong=not self._has_template), *((Text(f"  {number}", muted=True),) if number else ()))
        sizes = (_COVER_SIZE, _TITLE_SIZE) if is_cover else (_TITLE_SIZE, _LONG_TITLE_SIZE)
        size = sizes[0] if len(text) <= _LONG_TITLE else sizes[1]
        runs = cut_runs(runs, SLIDE_WIDTH - 4 * MARGIN, size, _MAX_TITLE_LINES)
        _write_paragraphs(shape.text_frame, (runs,), size, colours=self._colours)

    def _add_picture(self, slide: Any, placed: PlacedPicture) -> None:  # noqa: ANN401 - as python-pptx gives it
        picture = placed.picture
        shape = slide.shapes.add_picture(io.BytesIO(picture.png or b""), *_list_sides(placed.place))
        shape._element.nvPicPr.cNvPr.set("descr", _clean(placed.alt))  # noqa: SLF001 - python-pptx has no such property
        if picture.svg_outlines:
            # PowerPoint 2016 and later show the SVG, all other programs the PNG.
            relation = slide.part.relate_to(self._keep_drawing(picture, picture.svg_outlines), RELATIONSHIP_TYPE.IMAGE)
            blip = shape._element.find(".//" + qn("a:blip"))  # noqa: SLF001
            extension = etree.SubElement(etree.SubElement(blip, qn("a:extLst")), qn("a:ext"), {"uri": _SVG_EXTENSION})
            etree.SubElement(
                extension, f"{{{_SVG_NAMESPACE}}}svgBlip", {qn("r:embed"): relation}, nsmap={"asvg": _SVG_NAMESPACE}
            )

    def _keep_drawing(self, picture: Picture, data: bytes) -> Part:
        if picture.id not in self._pictures:
            name = PackURI(f"/ppt/media/drawing{len(self._pictures) + 1}.svg")
            self._pictures[picture.id] = Part(name, "image/svg+xml", self._presentation.part.package, data)
        return self._pictures[picture.id]

    def _add_footer(self, slide: Any) -> None:  # noqa: ANN401 - as python-pptx gives it
        top = SLIDE_HEIGHT - 28
        box = slide.shapes.add_textbox(*_list_sides(Place(MARGIN, top, SLIDE_WIDTH - 2 * MARGIN - 60, 16)))
        _clear_margins(box.text_frame)
        _write_paragraphs(box.text_frame, ((Text(self._footer, muted=True),),), _FOOTER_SIZE, colours=self._colours)
        box = slide.shapes.add_textbox(*_list_sides(Place(SLIDE_WIDTH - MARGIN - 60, top, 60, 16)))
        _clear_margins(box.text_frame)
        number = str(len(self._presentation.slides))
        _write_paragraphs(box.text_frame, ((Text(number, muted=True),),), _FOOTER_SIZE, colours=self._colours)
        paragraph = box.text_frame.paragraphs[0]
        paragraph.alignment = PP_ALIGN.RIGHT
        # A field, so that the number stays right where slides are moved.
        run = paragraph._p.find(qn("a:r"))  # noqa: SLF001
        run.tag = qn("a:fld")
        run.set("id", "{B6F15528-21DE-4FAA-801E-634DDDAF4B2B}")
        run.set("type", "slidenum")

    def save(self) -> bytes:
        """Return the presentation as python-pptx saves it."""
        stream = io.BytesIO()
        self._presentation.save(stream)
        return stream.getvalue()


def _keep_subtitle(slide: Any) -> Any:  # noqa: ANN401 - as python-pptx gives it
    """Return the first placeholder of text beside the title, without the others; None where there is none."""
    others = [each for each in slide.placeholders if each.shape_id != slide.shapes.title.shape_id]
    kept = next((each for each in others if each.has_text_frame), None)
    for each in others:
        if each is not kept:
            each._element.getparent().remove(each._element)  # noqa: SLF001 - else it asks for text
    return kept


def _add_table(slide: Any, placed: PlacedTable, colours: _TextColours) -> None:  # noqa: ANN401 - as python-pptx gives it
    table = placed.table
    size = (len(placed.heights), len(table.columns))
    frame = slide.shapes.add_table(*size, *_list_sides(placed.place))
    frame._element.nvGraphicFramePr.cNvPr.set("descr", _clean(table.caption))  # noqa: SLF001 - no such property
    shown = frame.table
    properties = shown._tbl.tblPr  # noqa: SLF001
    properties.set("firstRow", "1" if placed.has_heading else "0")
    properties.set("bandRow", "0")
    properties.find(qn("a:tableStyleId")).text = _PLAIN_TABLE
    for column, width in zip(shown.columns, placed.widths, strict=True):
        column.width = _measure(width)
    for row, height in zip(shown.rows, placed.heights, strict=True):
        row.height = _measure(height)
    rows = list(table.rows)
    if placed.has_heading:
        rows.insert(0, tuple((Text(each.title, strong=True),) for each in table.columns))
    for number, row in enumerate(rows):
        is_heading = placed.has_heading and number == 0
        for cell, runs, column in zip(shown.rows[number].cells, row, table.columns, strict=True):
            _write_cell(
                cell, runs, placed.size, colours=colours, is_heading=is_heading, is_figure=not placed.has_heading
            )
            if column.align == "right":
                cell.text_frame.paragraphs[0].alignment = PP_ALIGN.RIGHT


def _write_cell(  # noqa: PLR0913 - how it is set
    cell: Any,  # noqa: ANN401 - as python-pptx gives it
    runs: Inlines,
    size: float,
    *,
    colours: _TextColours,
    is_heading: bool,
    is_figure: bool,
) -> None:
    cell.margin_left = cell.margin_right = _measure(SIDE_PADDING)
    cell.margin_top = cell.margin_bottom = _measure(3)
    cell.vertical_anchor = MSO_ANCHOR.BOTTOM if is_heading else MSO_ANCHOR.TOP
    _write_paragraphs(cell.text_frame, (runs,), size, strong_scale=FIGURE_SCALE if is_figure else 1.0, colours=colours)
    properties = cell._tc.get_or_add_tcPr()  # noqa: SLF001 - python-pptx has no lines of cells
    line = etree.SubElement(properties, qn("a:lnB"), {"w": "6350"})
    etree.SubElement(etree.SubElement(line, qn("a:solidFill")), qn("a:srgbClr"), {"val": _LINE})
    if is_heading and colours.plain:
        etree.SubElement(etree.SubElement(properties, qn("a:solidFill")), qn("a:srgbClr"), {"val": _HEADING_FILL})
    else:
        etree.SubElement(properties, qn("a:noFill"))


def _write_paragraphs(
    frame: Any,  # noqa: ANN401 - as python-pptx gives it
    paragraphs: Sequence[Inlines],
    size: float,
    *,
    strong_scale: float = 1.0,
    colours: _TextColours,
) -> None:
    frame.word_wrap = True
    for number, inlines in enumerate(paragraphs):
        paragraph = frame.paragraphs[0] if number == 0 else frame.add_paragraph()
        paragraph.alignment = PP_ALIGN.LEFT
        paragraph.space_after = Pt(GAP if number + 1 < len(paragraphs) else 0)
        for text in inlines:
            if text.line_break:
                paragraph.add_line_break()
            run = paragraph.add_run()
            run.text = _clean(write_comparisons(text.text))
            font = run.font
            font.size = Pt(round(size * (strong_scale if text.strong else CODE_SCALE if text.code else 1), 1))
            font.bold = text.strong or text.status in STATUS_COLOURS or None
            font.italic = text.emphasis or None
            colour = colours.choose_colour(text)
            if colour:
                font.color.rgb = _read_colour(colour)
            if text.code:
                font.name = _CODE_FONT
        if not inlines:
            paragraph.font.size = Pt(size)


def _read_colour(digits: str) -> RGBColor:
    return RGBColor(*bytes.fromhex(digits))  # type: ignore[no-untyped-call] # as all of this module of python-pptx


def _clean(text: str) -> str:
    return _BLANKS.sub(" ", replace_forbidden(_BLANKS.sub(" ", text)))


def _clear_margins(frame: Any) -> None:  # noqa: ANN401 - as python-pptx gives it
    frame.margin_left = frame.margin_right = frame.margin_top = frame.margin_bottom = 0


def _measure(points: float) -> Emu:
    return Emu(round(points * _EMU_PER_POINT))


def _list_sides(place: Place) -> tuple[Emu, Emu, Emu, Emu]:
    return _measure(place.left), _measure(place.top), _measure(place.width), _measure(place.height)


def _set_place(shape: Any, place: Place) -> None:  # noqa: ANN401 - as python-pptx gives it
    shape.left, shape.top, shape.width, shape.height = _list_sides(place)


_TEMPLATE_MAIN = "application/vnd.openxmlformats-officedocument.presentationml.template.main+xml"
_WIDE, _TOLERANCE = 16 / 9, 0.02
_DIGITS = re.compile("[0-9A-Fa-f]{6}")
_LIGHT = 3 * 128
"""The sum of red, green and blue above which a colour is light."""
_OF_SLIDES = ("custShowLst", "extLst")
"""What a presentation says of its slides beside their list; its extensions hold the list of sections."""
_PLACE_ATTRIBUTES = {
    "off": ("x", "y"),
    "ext": ("cx", "cy"),
    "gridCol": ("w",),
    "tr": ("h",),
    "rPr": ("sz",),
    "endParaRPr": ("sz",),
    "defRPr": ("sz",),
    "tcPr": ("marL", "marR", "marT", "marB"),
    "bodyPr": ("lIns", "rIns", "tIns", "bIns"),
}


def open_template(data: bytes) -> Any:  # noqa: ANN401 - as python-pptx gives it
    """Return a partner's presentation without its slides.

    Raise TemplateError if it cannot be used, and whatever python-pptx raises where it is damaged.
    """
    parts = unpack_template(data, "PowerPoint")
    types = read_content_types(parts, "PowerPoint")
    for name, content in parts.items():
        if name.endswith((".xml", ".rels")):
            parse_part(content, name)
    # A .potx differs from a .pptx in this alone.
    types = {
        name: CONTENT_TYPE.PML_PRESENTATION_MAIN if each == _TEMPLATE_MAIN else each for name, each in types.items()
    }
    presentation = Presentation(io.BytesIO(zip_parts(parts, types)))
    shape = presentation.slide_width / presentation.slide_height
    _drop_slides(presentation)
    if abs(shape - _WIDE) > _TOLERANCE:
        message = f"the template's slides are {shape:.2f} times as wide as high: slides are made for 16:9 (1.78)"
        raise TemplateError(message)
    return presentation


def _drop_slides(presentation: Any) -> None:  # noqa: ANN401 - as python-pptx gives it
    element = presentation.part._element  # noqa: SLF001 - python-pptx removes no slides
    for slide in list(element.sldIdLst if element.sldIdLst is not None else ()):
        presentation.part.drop_rel(slide.rId)
        slide.getparent().remove(slide)
    for name in _OF_SLIDES:
        for each in element.findall(qn(f"p:{name}")):
            element.remove(each)


def find_layout(presentation: Any, kind: str, other: Any = None) -> Any:  # noqa: ANN401 - as python-pptx gives it
    """Return the layout of a kind (`title`, `titleOnly`), else the barest one with a title; `other` where there is a choice.

    Raise TemplateError if there is none.
    """
    titled = [each for each in presentation.slide_layouts if any(_is_title(shape) for shape in each.placeholders)]
    fitting = [each for each in titled if each._element.get("type") == kind]  # noqa: SLF001 - no property says it
    barest = sorted(titled, key=lambda layout: (layout == other, len(layout.placeholders)))
    if not titled:
        raise TemplateError("the template has no layout with a title: slides are made with one")
    return (fitting or barest)[0]


def _is_title(shape: Any) -> bool:  # noqa: ANN401 - as python-pptx gives it
    return bool(shape.placeholder_format.idx == 0)


def has_light_text(presentation: Any) -> bool:  # noqa: ANN401 - as python-pptx gives it
    """Return whether the text of a template's theme is light, and so its ground dark."""
    master = presentation.slide_master
    mapped = master._element.find(qn("p:clrMap"))  # noqa: SLF001 - python-pptx knows no themes
    name = "dk1" if mapped is None else mapped.get("tx1", "dk1")
    for relation in master.part.rels.values():
        if relation.reltype == RELATIONSHIP_TYPE.THEME:
            colours = parse_part(relation.target_part.blob, "theme").find(f".//{qn(f'a:{name}')}")
            colour = colours[0] if colours is not None and len(colours) else None
            digits = "" if colour is None else colour.get("lastClr") or colour.get("val") or ""
            return bool(_DIGITS.fullmatch(digits)) and sum(bytes.fromhex(digits)) > _LIGHT
    return False


def scale_slide(slide: Any, factor: float) -> None:  # noqa: ANN401 - as python-pptx gives it
    """Make places and type of a slide larger or smaller, for a template whose slides are as wide as others but not as large."""
    for element in slide.shapes._spTree.iter("*"):  # noqa: SLF001 - all that is drawn
        for name in _PLACE_ATTRIBUTES.get(etree.QName(element).localname, ()):
            value = element.get(name)
            if value is not None:
                element.set(name, str(round(int(value) * factor)))
