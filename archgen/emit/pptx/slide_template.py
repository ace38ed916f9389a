"""The presentation that slides are written into: python-pptx's own at 16:9, or a partner's with its masters and layouts."""

from __future__ import annotations

import io
import re
from typing import Any

from lxml import etree
from pptx import Presentation
from pptx.opc.constants import CONTENT_TYPE, RELATIONSHIP_TYPE
from pptx.oxml.ns import qn

from archgen.emit.template_package import TemplateError, parse_part, read_content_types, unpack_template, zip_parts

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
        message = "the template has no layout with a title: slides are made with one"
        raise TemplateError(message)
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
