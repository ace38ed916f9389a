"""Pictures on the page: sized to the text, on a turned or larger sheet where they would be too small to read, with captions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from docx.oxml.ns import nsdecls, qn
from docx.oxml.parser import parse_xml
from docx.oxml.shape import CT_Inline
from docx.shared import Emu
from lxml import etree

from archgen.emit.docx.captions import write_caption
from archgen.emit.docx.docx_writer import DocxWriter
from archgen.emit.docx.image_formats import draw_stand_in, recognise_image
from archgen.emit.docx.page_flow import FlowPiece, ScalablePicture
from archgen.emit.docx.paper_sheets import PaperSheet
from archgen.emit.docx.word_xml import clean_line, format_paragraph, format_run
from archgen.views.shapes import Figure

_TYPE_SIZE = 9.0
"""Type size in points of the pictures that archgen draws."""
_LEGIBLE_SIZE = 5.4
_LEGIBLE_SIZE_TURNED = 5.5
"""Below these sizes the next larger sheet is tried; turning a printed page is a price, finding A3 paper a higher one."""
_LEAST_SIZE = 6.5
"""A picture that would leave the foot of a page empty is drawn smaller, down to this size of its type."""
_CAPTION_HEIGHT = 60.0
"""Points kept free below a picture for its caption."""
_MIN_GAIN = 1.05
"""A sheet on which a picture is hardly larger is no gain."""


@dataclass(frozen=True, slots=True)
class PictureRun:
    """A picture as a run, and its height in points."""

    xml: str
    height: float


def write_figure(writer: DocxWriter, shape: Figure) -> Iterator[FlowPiece]:
    """Write a drawn picture with its caption below, or a sentence where there is no picture."""
    picture = writer.pictures.get(shape.graph)
    if picture is None or not (picture.png or picture.svg_outlines):
        if writer.pictures:  # where there is none at all, who draws has said why, once
            reason = (picture.warning if picture else None) or "it was not drawn"
            writer.warn(f"the report lacks the picture `{shape.graph}`: {reason}")
        yield from _write_missing(writer, shape)
        return
    sheet, scale = choose_sheet(writer, picture.width, picture.height)
    width, height = picture.width * scale, picture.height * scale
    png = picture.png or draw_stand_in(picture.width, picture.height)
    raster = writer.relate_image(f"graph:{shape.graph}", "png", png)
    svg = picture.svg_outlines
    drawing = writer.relate_image(f"graph:{shape.graph}", "svg", svg) if svg else ""

    def draw_piece(share: float) -> FlowPiece:
        size = (width * share, height * share)
        run = format_picture(writer, (raster, drawing), size, shape.alt or shape.caption)
        piece = write_picture_paragraph(writer, PictureRun(run, size[1]), sheet, keep_next=shape.numbered)
        return replace(piece, picture=scalable_picture)

    least = _LEAST_SIZE / (_TYPE_SIZE * scale)
    scalable_picture = ScalablePicture(height, least, draw_piece) if sheet is None and least < 1 else None
    yield draw_piece(1.0)
    if shape.numbered:
        yield write_caption(writer, shape.anchor, _note_scale(shape.caption, scale), sheet)
    # Whoever reads the page must know what the picture lacks, not only whoever wrote it.
    if picture.warning:
        yield _write_note(writer, picture.warning, sheet)


def _note_scale(caption: str, scale: float) -> str:
    """Return a caption; one below a picture that is hard to read says by how much it was made smaller."""
    return f"{caption} (reduced to {scale:.0%})" if scale * _TYPE_SIZE < _LEGIBLE_SIZE else caption


def choose_sheet(writer: DocxWriter, width: float, height: float) -> tuple[PaperSheet | None, float]:
    """Return the sheet for a picture (None for the usual one) and its scale.

    It is the usual one while its type can be read there, else a turned one, else the large one on which it is largest (few
    printers have such paper, so less must do on the turned one).
    """
    paper = writer.paper
    sheet, scale = None, _scale_to_sheet(paper.base, width, height)
    for legible_size, others in ((_LEGIBLE_SIZE, (paper.wide,)), (_LEGIBLE_SIZE_TURNED, paper.large)):
        if scale * _TYPE_SIZE >= legible_size:
            break
        for other in others:
            other_scale = _scale_to_sheet(other, width, height)
            if other_scale > scale * _MIN_GAIN:
                sheet, scale = other, other_scale
    return sheet, scale


def write_picture_paragraph(
    writer: DocxWriter, picture: PictureRun, sheet: PaperSheet | None, *, keep_next: bool = True
) -> FlowPiece:
    """Write a paragraph that holds a picture alone."""
    face = writer.styles.find_face("Figure")
    properties = "" if keep_next else '<w:keepNext w:val="0"/>'
    xml = format_paragraph(writer.styles.find_style_id("Figure"), picture.xml, properties)
    # Two points are what a line has below the foot of a picture.
    return FlowPiece(xml, (picture.height + 2,), face.before, face.after, keep_next=keep_next, sheet=sheet)


def read_chapter_picture(writer: DocxWriter, path: str, alt: str) -> PictureRun | None:
    """Return a chapter's picture as a run; None (and a warning) if it cannot be shown."""
    data = None if "://" in path else writer.chapter_files(path)
    image = recognise_image(data) if data else None
    if data is None or image is None:
        reason = "is not a file of the project" if data is None else "is no PNG, JPEG, GIF or SVG"
        writer.warn(f"the picture `{path}` {reason}: its text stands in its place")
        return None
    scale = _scale_to_sheet(writer.paper.base, image.width, image.height)
    size = (image.width * scale, image.height * scale)
    if image.kind == "svg":
        raster = _read_raster(writer, path, size)
        relations = (
            writer.relate_image(f"chapter:{path}", "png", raster),
            writer.relate_image(f"chapter:{path}", "svg", data),
        )
    else:
        relations = (writer.relate_image(f"chapter:{path}", image.kind, data), "")
    return PictureRun(format_picture(writer, relations, size, alt or path), size[1])


def _read_raster(writer: DocxWriter, path: str, size: tuple[float, float]) -> bytes:
    """Return the PNG beside an SVG of the project, or a stand-in and a warning."""
    raster = writer.chapter_files(path.rpartition(".")[0] + ".png")
    image = recognise_image(raster) if raster else None
    if raster is not None and image is not None and image.kind == "png":
        return raster
    writer.warn(
        f"the picture `{path}` has no PNG of the same name beside it: programs that know no SVG show an empty frame"
    )
    return draw_stand_in(*size)


def _scale_to_sheet(sheet: PaperSheet, width: float, height: float) -> float:
    return min(1.0, sheet.text_width / width, (sheet.text_height - _CAPTION_HEIGHT) / height)


def _write_missing(writer: DocxWriter, shape: Figure) -> Iterator[FlowPiece]:
    """Write what stands in a picture's place."""
    yield _write_note(writer, f"This picture could not be drawn. {shape.alt}".strip(), None, keep_next=True)
    yield write_caption(writer, shape.anchor, shape.caption, None)


def _write_note(writer: DocxWriter, text: str, sheet: PaperSheet | None, *, keep_next: bool = False) -> FlowPiece:
    """Write what must be said about a picture."""
    face = writer.styles.find_face("Note Box")
    rows = (face.line,) * face.count_lines(text, (sheet or writer.paper.base).text_width)
    properties = "<w:keepNext/>" if keep_next else ""
    xml = format_paragraph(writer.styles.find_style_id("Note Box"), format_run(text), properties)
    return FlowPiece(xml, rows, face.before, face.after, keep_next=keep_next, sheet=sheet)


_EMU_PER_POINT = 12_700
_SVG_EXTENSION = "{96DAC541-7B7A-43D3-8B79-37D633B846F1}"
_SVG_NAMESPACE = "http://schemas.microsoft.com/office/drawing/2016/SVG/main"


def format_picture(writer: DocxWriter, relations: tuple[str, str], size: tuple[float, float], alt: str) -> str:
    """Return the run that shows a picture, its size in points.

    `relations` are that of the raster, and that of the drawing or nothing: Word 2016 and later show the SVG of the extension,
    all other programs the PNG. python-docx has neither the extension nor the alternative text.
    """
    raster, drawing = relations
    number = writer.take_id()
    # Not `Pt`, which cuts what is behind the point: a picture as wide as the text is 5760720 EMU, not 5760719.
    across, down = (Emu(round(side * _EMU_PER_POINT)) for side in size)
    inline = CT_Inline.new_pic_inline(number, raster, f"Picture {number}", across, down)
    # Without distances, which python-docx leaves out, LibreOffice keeps a space round the picture and shifts it.
    for side in ("distT", "distB", "distL", "distR"):
        inline.set(side, "0")
    description = clean_line(alt)
    for properties in inline.iter(qn("wp:docPr"), qn("pic:cNvPr")):
        properties.set("descr", description)
    if drawing:
        inline.graphic.graphicData.pic.blipFill.blip.append(_create_svg_extension(drawing))
    return f"<w:r><w:drawing>{etree.tostring(inline, encoding='unicode')}</w:drawing></w:r>"


def _create_svg_extension(relation: str) -> etree._Element:
    drawing = f'<asvg:svgBlip xmlns:asvg="{_SVG_NAMESPACE}" r:embed="{relation}"/>'
    extension = f'<a:ext uri="{_SVG_EXTENSION}">{drawing}</a:ext>'
    return parse_xml(f"<a:extLst {nsdecls('a', 'r')}>{extension}</a:extLst>")
