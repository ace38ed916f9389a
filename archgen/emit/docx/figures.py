"""Pictures on the page: sized to the text, on a turned or larger sheet where they would be too small to read, with captions."""

from __future__ import annotations

import re
import struct
import zlib
from collections.abc import Iterator
from typing import Literal

from docx.oxml.ns import nsdecls, qn
from docx.oxml.parser import parse_xml
from docx.oxml.shape import CT_Inline
from docx.shared import Emu
from lxml import etree

from archgen.emit.docx.captions import write_caption
from archgen.emit.docx.docx_writer import DocxWriter
from archgen.emit.docx.page_flow import FlowPiece, PaperSheet, ScalablePicture
from archgen.emit.docx.word_xml import clean_line, format_paragraph, format_run
from archgen.frozen import dataclass, replace
from archgen.views.shapes import Figure

_MM_PER_POINT = 25.4 / 72
_SCREEN_DPI = 96.0
_POINTS_PER_INCH = 72.0
_MIN_DPI, _MAX_DPI = 30.0, 2400.0
"""Resolutions outside of these are mistakes of the program that wrote the file."""
_JPEG_FRAMES = frozenset({0xC0, 0xC1, 0xC2, 0xC3, 0xC5, 0xC6, 0xC7, 0xC9, 0xCA, 0xCB, 0xCD, 0xCE, 0xCF})
"""Markers of segments that hold the size."""
_UNIT_POINTS = {"": 0.75, "px": 0.75, "pt": 1.0, "mm": 72 / 25.4, "cm": 72 / 2.54, "in": 72.0, "pc": 12.0}
_LENGTH = re.compile(r"\s*+((?:[0-9]*+\.)?[0-9]++(?:e[0-9]++)?)\s*+(px|pt|mm|cm|in|pc|)\s*+\Z", re.IGNORECASE)
_MAX_SIDE = 1_000_000.0
_DEFAULT_SIDES = (300.0, 150.0)
"""What browsers take for an SVG without a size."""
_STAND_IN_WIDTH = 200


@dataclass(frozen=True, slots=True)
class ImageFormat:
    """The format of a picture, and its size in points."""

    kind: Literal["png", "jpeg", "gif", "svg"]
    width: float
    height: float


def _recognise_image(data: bytes) -> ImageFormat | None:
    """Return what a picture is by its first bytes; None for what Word cannot show."""
    try:
        image = _read_png(data) or _read_gif(data) or _read_jpeg(data) or _read_svg(data)
    except (struct.error, IndexError, OverflowError):
        return None
    return image if image and 0 < image.width < _MAX_SIDE and 0 < image.height < _MAX_SIDE else None


def _draw_stand_in(width: float, height: float) -> bytes:
    """Return a PNG that is an empty frame of a picture's shape, for programs that cannot show the picture itself."""
    wide = _STAND_IN_WIDTH
    high = max(4, min(2000, round(wide * height / width)))
    edge = bytes([0]) + b"\xa9\xb4\xbd" * wide
    inner = bytes([0]) + b"\xa9\xb4\xbd" + b"\xf3\xf5\xf7" * (wide - 2) + b"\xa9\xb4\xbd"
    data = zlib.compress(edge + inner * (high - 2) + edge, 9)
    header = struct.pack(">IIBBBBB", wide, high, 8, 2, 0, 0, 0)
    chunks = (_pack_chunk(b"IHDR", header), _pack_chunk(b"IDAT", data), _pack_chunk(b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)


def _pack_chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def _create_raster(
    kind: Literal["png", "jpeg", "gif"], pixels: tuple[int, int], dpi: tuple[float, float] = (_SCREEN_DPI, _SCREEN_DPI)
) -> ImageFormat:
    across, down = (value if _MIN_DPI <= value <= _MAX_DPI else _SCREEN_DPI for value in dpi)
    return ImageFormat(kind, pixels[0] * _POINTS_PER_INCH / across, pixels[1] * _POINTS_PER_INCH / down)


def _read_png(data: bytes) -> ImageFormat | None:
    if not data.startswith(b"\x89PNG\r\n\x1a\n") or data[12:16] != b"IHDR":
        return None
    pixels = struct.unpack(">II", data[16:24])
    # The chunk stands before the pixels, in which these letters may mean anything.
    place = data.find(b"pHYs", 0, 4096)
    if place > 0 and data[place + 12] == 1:  # pixels per metre
        across, down = struct.unpack(">II", data[place + 4 : place + 12])
        return _create_raster("png", pixels, (across * 0.0254, down * 0.0254))
    return _create_raster("png", pixels)


def _read_gif(data: bytes) -> ImageFormat | None:
    return _create_raster("gif", struct.unpack("<HH", data[6:10])) if data[:6] in {b"GIF87a", b"GIF89a"} else None


def _read_jpeg(data: bytes) -> ImageFormat | None:
    if not data.startswith(b"\xff\xd8\xff"):
        return None
    place, dpi = 2, (_SCREEN_DPI, _SCREEN_DPI)
    while data[place] == 0xFF:  # noqa: PLR2004 - every segment begins with it
        marker, length = data[place + 1], struct.unpack(">H", data[place + 2 : place + 4])[0]
        if marker in _JPEG_FRAMES:
            height, width = struct.unpack(">HH", data[place + 5 : place + 9])
            return _create_raster("jpeg", (width, height), dpi)
        if marker == 0xE0 and data[place + 4 : place + 8] == b"JFIF" and data[place + 11] in {1, 2}:  # noqa: PLR2004 - APP0
            scale = 1 if data[place + 11] == 1 else 2.54  # per inch, per centimetre
            across, down = struct.unpack(">HH", data[place + 12 : place + 16])
            dpi = (across * scale, down * scale)
        place += 2 + length
    return None


def _read_svg(data: bytes) -> ImageFormat | None:
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False)
    try:
        root = etree.fromstring(data, parser)
    except (etree.XMLSyntaxError, ValueError):
        return None
    # A picture that declares entities may grow to any size in the program that shows it.
    if etree.QName(root).localname != "svg" or b"<!ENTITY" in data:
        return None
    box = re.split(r"[\s,]+", root.get("viewBox", "").strip())
    sides = [_read_length(root.get(name, "")) for name in ("width", "height")]
    if not all(sides) and len(box) == 4:  # noqa: PLR2004 - x, y, width, height
        sides = [_read_length(box[2]), _read_length(box[3])]
    return ImageFormat("svg", sides[0] or _DEFAULT_SIDES[0], sides[1] or _DEFAULT_SIDES[1])


def _read_length(text: str) -> float:
    """Return a length of SVG in points, 0 for a share of the page and for what is no length."""
    match = _LENGTH.match(text)
    return float(match[1]) * _UNIT_POINTS[match[2].lower()] if match else 0.0


_TYPE_SIZE = 8.0
"""Type size in points of the smallest words in the pictures that archgen draws."""
_LEAST_SIZE = 6.5
"""The smallest type on paper: below it the next larger sheet is tried, and what is still smaller is left out."""
_LEAST_SCALE = _LEAST_SIZE / _TYPE_SIZE
_EDGE = 30.0
"""Points from the edge of the paper up to which a picture may reach over the margins, before the page turns for it."""
_CAPTION_HEIGHT = 60.0
"""Points kept free below a picture for its caption."""


@dataclass(frozen=True, slots=True)
class PictureRun:
    """A picture as a run, and its size in points."""

    xml: str
    width: float
    height: float


def write_figure(writer: DocxWriter, shape: Figure) -> Iterator[FlowPiece]:
    """Write a drawn picture with its caption below, or a sentence where there is no picture."""
    picture = writer.pictures.get(shape.graph)
    sheet, scale = choose_sheet(writer, picture.width, picture.height) if picture else (None, 0.0)
    if picture is None or not (picture.png or picture.svg_outlines) or not scale:
        is_drawn = picture is not None and (picture.png or picture.svg_outlines)
        if writer.pictures and not is_drawn:  # where there is none at all, who draws has said why, once
            reason = (picture.warning if picture else None) or "it was not drawn"
            writer.warn(f"the report lacks the picture `{shape.graph}`: {reason}")
        lack = (
            "This picture is too large to be read on paper; the site has it"
            if is_drawn
            else "This picture could not be drawn"
        )
        yield _write_note(writer, f"{lack}. {shape.alt}".strip(), None, keep_next=True)
        yield write_caption(writer, shape.anchor, shape.caption, None)
        return
    if shape.max_height and sheet is None:
        scale = max(min(scale, shape.max_height / _MM_PER_POINT / picture.height), min(scale, _LEAST_SCALE))
    width, height = picture.width * scale, picture.height * scale
    png = picture.png or _draw_stand_in(picture.width, picture.height)
    raster = writer.relate_image(f"graph:{shape.graph}", "png", png)
    svg = picture.svg_outlines
    drawing = writer.relate_image(f"graph:{shape.graph}", "svg", svg) if svg else ""

    def draw_piece(share: float) -> FlowPiece:
        size = (width * share, height * share)
        run = format_picture(writer, (raster, drawing), size, shape.alt or shape.caption)
        piece = write_picture_paragraph(writer, PictureRun(run, *size), sheet, keep_next=shape.numbered)
        return replace(piece, picture=scalable_picture)

    least = _LEAST_SCALE / scale
    scalable_picture = ScalablePicture(height, least, draw_piece) if sheet is None and least < 1 else None
    yield draw_piece(1.0)
    if shape.numbered:
        yield write_caption(
            writer,
            shape.anchor,
            shape.caption,
            sheet,
        )
    # Whoever reads the page must know what the picture lacks, not only whoever wrote it.
    if picture.warning:
        yield _write_note(writer, picture.warning, sheet)


def choose_sheet(writer: DocxWriter, width: float, height: float) -> tuple[PaperSheet | None, float]:
    """Return the sheet for a picture (None for the usual one) and its scale.

    It is the usual one while its type can be read there, over the margins if need be, else a turned one, else the large one
    on which it is largest. Where it can be read on none, the scale is 0.
    """
    paper, base = writer.paper, writer.paper.base
    over = max(0.0, min(base.left, base.right) - _EDGE)
    over_margins = replace(base, left=base.left - over, right=base.right - over)
    sheets = ((None, base), (None, over_margins), *((each, each) for each in (paper.wide, *paper.large)))
    scales = ((sheet, _scale_to_sheet(area, width, height)) for sheet, area in sheets)
    return next((found for found in scales if found[1] >= _LEAST_SCALE), (None, 0.0))


def write_picture_paragraph(
    writer: DocxWriter, picture: PictureRun, sheet: PaperSheet | None, *, keep_next: bool = True
) -> FlowPiece:
    """Write a paragraph that holds a picture alone."""
    face = writer.styles.find_face("Figure")
    properties = "" if keep_next else '<w:keepNext w:val="0"/>'
    over = picture.width - (sheet or writer.paper.base).text_width
    if over > 0:
        side = -round(10 * over)  # half of it, in twentieths of a point
        properties += f'<w:ind w:left="{side}" w:right="{side}"/>'
    xml = format_paragraph(writer.styles.find_style_id("Figure"), picture.xml, properties)
    # Two points are what a line has below the foot of a picture.
    return FlowPiece(xml, (picture.height + 2,), face.before, face.after, keep_next=keep_next, sheet=sheet)


def read_chapter_picture(writer: DocxWriter, path: str, alt: str) -> PictureRun | None:
    """Return a chapter's picture as a run; None (and a warning) if it cannot be shown."""
    data = None if "://" in path else writer.chapter_files(path)
    image = _recognise_image(data) if data else None
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
    return PictureRun(format_picture(writer, relations, size, alt or path), *size)


def _read_raster(writer: DocxWriter, path: str, size: tuple[float, float]) -> bytes:
    """Return the PNG beside an SVG of the project, or a stand-in and a warning."""
    raster = writer.chapter_files(path.rpartition(".")[0] + ".png")
    image = _recognise_image(raster) if raster else None
    if raster is not None and image is not None and image.kind == "png":
        return raster
    writer.warn(
        f"the picture `{path}` has no PNG of the same name beside it: programs that know no SVG show an empty frame"
    )
    return _draw_stand_in(*size)


def _scale_to_sheet(sheet: PaperSheet, width: float, height: float) -> float:
    return min(1.0, sheet.text_width / width, (sheet.text_height - _CAPTION_HEIGHT) / height)


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
