"""Pictures on the page: sized to the text, on a turned or larger sheet where they would be too small to read, with their captions."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.emit.docx.draft import Draft, Entry
from archgen.emit.docx.flow import Piece
from archgen.emit.docx.images import recognise, stand_in
from archgen.emit.docx.markup import bookmark_name, escape, field, paragraph, run
from archgen.emit.docx.sheets import Sheet
from archgen.views.shapes import Figure

_EMU = 12700
_TYPE = 9.0
"""Type size of the pictures that archgen draws."""
_LEGIBLE = 5.8
_LEGIBLE_TURNED = 5.5
_SVG = "{96DAC541-7B7A-43D3-8B79-37D633B846F1}"
_DRAWING = "http://schemas.microsoft.com/office/drawing/2016/SVG/main"
_CAPTION_ROOM = 60.0
"""Points kept free below a picture for its caption."""
_BARELY = 1.05


def figure(draft: Draft, shape: Figure) -> Iterator[Piece]:
    """Give a drawn picture with its caption below, or a sentence where there is no picture."""
    picture = draft.pictures.get(shape.graph)
    if picture is None or not (picture.png or picture.svg_outlines):
        if draft.pictures:  # where there is none at all, who draws has said why, once
            why = (picture.warning if picture else None) or "it was not drawn"
            draft.warn(f"the report lacks the picture `{shape.graph}`: {why}")
        yield from missing(draft, shape)
        return
    sheet, scale = fitting(draft, picture.width, picture.height)
    width, height = picture.width * scale, picture.height * scale
    png = picture.png or stand_in(picture.width, picture.height)
    relation = draft.image(f"graph:{shape.graph}", "png", png)
    vector = draft.image(f"graph:{shape.graph}", "svg", picture.svg_outlines) if picture.svg_outlines else ""
    content = drawing(draft, (relation, vector), (width, height), shape.alt or shape.caption)
    yield picture_piece(draft, content, height, sheet)
    yield caption(draft, shape.anchor, shape.caption, sheet)
    if picture.warning:
        yield note(draft, picture.warning, sheet)


def missing(draft: Draft, shape: Figure) -> Iterator[Piece]:
    """Give what stands in a picture's place."""
    text = f"This picture could not be drawn. {shape.alt}".strip()
    face = draft.styles.face("Note Box")
    rows = (face.line,) * face.lines(text, draft.sheets.base.text_width)
    yield Piece(
        paragraph(draft.styles.id("Note Box"), run(text), "<w:keepNext/>"),
        rows,
        face.before,
        face.after,
        keep_next=True,
    )
    yield caption(draft, shape.anchor, shape.caption, None)


def note(draft: Draft, text: str, sheet: Sheet | None) -> Piece:
    """Give what must be said about a picture."""
    face = draft.styles.face("Note Box")
    width = (sheet or draft.sheets.base).text_width
    return Piece(
        paragraph(draft.styles.id("Note Box"), run(text)),
        (face.line,) * face.lines(text, width),
        face.before,
        face.after,
        sheet=sheet,
    )


def fitting(draft: Draft, width: float, height: float) -> tuple[Sheet | None, float]:
    """Choose the sheet for a picture, and its scale: the usual one while its type can be read there, else a turned one,
    else the large one on which it is largest (few printers have such paper, so less must do on the turned one).
    """
    sheets = draft.sheets
    best: tuple[Sheet | None, float] = (None, _scale(sheets.base, width, height))
    for enough, others in ((_LEGIBLE, (sheets.wide,)), (_LEGIBLE_TURNED, sheets.large)):
        if best[1] * _TYPE >= enough:
            break
        for sheet in others:
            scale = _scale(sheet, width, height)
            if scale > best[1] * _BARELY:
                best = (sheet, scale)
    return best


def _scale(sheet: Sheet, width: float, height: float) -> float:
    return min(1.0, sheet.text_width / width, (sheet.text_height - _CAPTION_ROOM) / height)


def picture_piece(draft: Draft, content: str, height: float, sheet: Sheet | None, *, keep_next: bool = True) -> Piece:
    """Give a paragraph that holds a picture alone."""
    face = draft.styles.face("Figure")
    properties = "" if keep_next else '<w:keepNext w:val="0"/>'
    return Piece(
        paragraph(draft.styles.id("Figure"), content, properties),
        (height + 2,),
        face.before,
        face.after,
        keep_next=keep_next,
        sheet=sheet,
    )


def caption(draft: Draft, anchor: str, text: str, sheet: Sheet | None, kind: str = "Figure") -> Piece:
    """Give a caption with its number as a field; it goes into the list of figures or tables."""
    entries = draft.figures if kind == "Figure" else draft.tables
    anchor = draft.fresh(anchor)
    number = str(len(entries) + 1)
    entries.append(Entry(bookmark_name(anchor), f"{kind} {number}", text))
    content = draft.mark(anchor) + run(f"{kind} ") + field(f"SEQ {kind} \\* ARABIC", number) + run(f": {text}")
    face = draft.styles.face("caption")
    rows = (face.line,) * face.lines(f"{kind} {number}: {text}", (sheet or draft.sheets.base).text_width)
    above = kind == "Table"
    return Piece(
        paragraph(draft.styles.id("caption"), content, "<w:keepNext/>" if above else ""),
        rows,
        face.before,
        face.after,
        keep_next=above,
        whole=True,
        sheet=sheet,
        marks=(bookmark_name(anchor),),
    )


def drawing(draft: Draft, relations: tuple[str, str], size: tuple[float, float], alt: str) -> str:
    """Give the run that shows a picture: the raster's relationship, and the drawing's where there is one."""
    raster, vector = relations
    number, across, down = draft.number(), round(size[0] * _EMU), round(size[1] * _EMU)
    extension = (
        f'<a:extLst><a:ext uri="{_SVG}"><asvg:svgBlip xmlns:asvg="{_DRAWING}" r:embed="{vector}"/></a:ext></a:extLst>'
        if vector
        else ""
    )
    return (
        f'<w:r><w:drawing><wp:inline distT="0" distB="0" distL="0" distR="0"><wp:extent cx="{across}" cy="{down}"/>'
        f'<wp:docPr id="{number}" name="Picture {number}" descr="{escape(alt)}"/>'
        '<wp:cNvGraphicFramePr><a:graphicFrameLocks noChangeAspect="1"/></wp:cNvGraphicFramePr><a:graphic>'
        '<a:graphicData uri="http://schemas.openxmlformats.org/drawingml/2006/picture"><pic:pic>'
        f'<pic:nvPicPr><pic:cNvPr id="{number}" name="Picture {number}" descr="{escape(alt)}"/><pic:cNvPicPr/></pic:nvPicPr>'
        f'<pic:blipFill><a:blip r:embed="{raster}">{extension}</a:blip><a:stretch><a:fillRect/></a:stretch></pic:blipFill>'
        f'<pic:spPr><a:xfrm><a:off x="0" y="0"/><a:ext cx="{across}" cy="{down}"/></a:xfrm>'
        '<a:prstGeom prst="rect"><a:avLst/></a:prstGeom></pic:spPr></pic:pic></a:graphicData></a:graphic></wp:inline></w:drawing></w:r>'
    )


def chapter_image(draft: Draft, path: str, alt: str) -> tuple[str, float, float, Sheet | None] | None:
    """Give a chapter's picture as a run, with its size and sheet; None (and a warning) if it cannot be shown."""
    data = None if "://" in path else draft.chapter_files(path)
    image = recognise(data) if data else None
    if data is None or image is None:
        why = "is not a file of the project" if data is None else "is no PNG, JPEG, GIF or SVG"
        draft.warn(f"the picture `{path}` {why}: its text stands in its place")
        return None
    scale = _scale(draft.sheets.base, image.width, image.height)
    size = (image.width * scale, image.height * scale)
    if image.kind == "svg":
        raster = draft.chapter_files(path.rpartition(".")[0] + ".png")
        if raster is None or (beside := recognise(raster)) is None or beside.kind != "png":
            draft.warn(
                f"the picture `{path}` has no PNG of the same name beside it: programs that know no SVG show an empty frame"
            )
            raster = stand_in(image.width, image.height)
        relations = (draft.image(f"chapter:{path}", "png", raster), draft.image(f"chapter:{path}", "svg", data))
    else:
        relations = (draft.image(f"chapter:{path}", image.kind, data), "")
    return drawing(draft, relations, size, alt or path), *size, None
