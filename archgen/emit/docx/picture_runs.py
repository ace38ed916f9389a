"""A picture among the words: python-docx's inline picture, with the SVG beside the PNG and with alternative text."""

from __future__ import annotations

from docx.oxml.ns import nsdecls, qn
from docx.oxml.parser import parse_xml
from docx.oxml.shape import CT_Inline
from docx.shared import Emu
from lxml import etree

from archgen.emit.docx.docx_writer import DocxWriter
from archgen.emit.docx.word_xml import clean_line

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
