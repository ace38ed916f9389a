"""Templates of slides: a company's masters and layouts are taken; what is none, or dangerous, is refused in words."""

from __future__ import annotations

import io
import re
import zipfile
from typing import Any

import pytest

from archgen.emit.pptx import write_slides
from archgen.emit.template_package import TemplateError
from archgen.views.shapes import Column, Outline, Paragraph, Section, Table, Text

pptx = pytest.importorskip("pptx")
MAIN = r"presentationml\.presentation\.main\+xml"


def make_template(width: float = 10, height: float = 5.625, *, is_dark: bool = False) -> bytes:
    """Return a presentation with a slide and a section of it, as wide and high in inches."""
    presentation: Any = pptx.Presentation()
    presentation.slide_width, presentation.slide_height = (round(914_400 * each) for each in (width, height))
    presentation.slides.add_slide(presentation.slide_layouts[1]).shapes.title.text = "A sample"
    presentation.slide_layouts[5].name = "House title"
    if is_dark:
        colours = presentation.slide_master.element.find(pptx.oxml.ns.qn("p:clrMap"))
        colours.set("bg1", "dk1")
        colours.set("tx1", "lt1")
    stream = io.BytesIO()
    presentation.save(stream)
    return stream.getvalue()


def change_template(part: str, old: str, new: str) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(make_template())) as source, zipfile.ZipFile(stream, "w") as target:
        for name in source.namelist():
            content = source.read(name)
            if re.fullmatch(part, name):
                content = re.sub(old.encode(), new.encode(), content)
            target.writestr(name, content)
    return stream.getvalue()


def write(template: bytes) -> Any:  # noqa: ANN401 - as python-pptx gives it
    table = Table("table:t", "T", (Column("Who"),), (((Text("late", status="missed"),),),))
    outline = Outline("Lamp", "Software", (), sections=(Section("s", "Lines", (Paragraph((Text("one"),)), table)),))
    data = write_slides(outline, {}, template)
    assert data == write_slides(outline, {}, template)
    return pptx.Presentation(io.BytesIO(data))


@pytest.mark.parametrize(
    "change", [("x", "", ""), (r"\[Content_Types\].xml", MAIN, "presentationml.template.main+xml")]
)
def test_layouts_and_size_are_those_of_the_template(change: tuple[str, str, str]) -> None:
    presentation = write(change_template(*change))
    cover, slide = presentation.slides
    assert (cover.slide_layout.name, slide.slide_layout.name) == ("Title Slide", "House title")
    assert [slide.shapes.title.text, cover.shapes.title.text] == ["Lines", "Lamp"]
    assert presentation.slide_width == 9_144_000
    for shape in slide.shapes:
        assert shape.left + shape.width <= presentation.slide_width
        assert shape.top + shape.height <= presentation.slide_height
    sizes = {int(size) for size in re.findall(r'sz="(\d+)"', slide.part.blob.decode())}
    assert max(sizes) == 1950  # 26 points where a slide is as wide as PowerPoint's


@pytest.mark.parametrize(("is_dark", "colour"), [(False, "B3261E"), (True, "E5B6B4")])
def test_text_has_the_colour_of_the_theme_and_states_stand_out(colour: str, *, is_dark: bool) -> None:
    slide = write(make_template(is_dark=is_dark)).slides[1].part.blob.decode()
    assert "1A2129" not in slide
    assert colour in slide


@pytest.mark.parametrize(
    ("template", "words"),
    [
        (b"no zip", "is no PowerPoint file"),
        (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "save it as .pptx"),
        (make_template(10, 7.5), "1.33 times as wide as high: slides are made for 16:9"),
        (change_template(r"\[Content_Types\].xml", MAIN, "ms-powerpoint.presentation.macroEnabled.main+xml"), "macros"),
        (change_template(r"\[Content_Types\].xml", MAIN, "x+xml"), "is no PowerPoint file"),
        (change_template("ppt/presentation.xml", "<p:sldMasterIdLst>", "<p:sldMasterIdLst"), "not well-formed"),
        (
            change_template("ppt/presentation.xml", r"\?>", '?><!DOCTYPE a [<!ENTITY b "c">]>'),
            "declares a document type",
        ),
        (
            change_template(r"ppt/slideLayouts/.*", 'type="(ctrT|t)itle"', 'type="body" idx="99"'),
            "no layout with a title",
        ),
        # What python-pptx only comes to when it draws.
        (
            change_template(r".*slideMaster1.xml.rels", r'"../theme/[^"]*"', '"http://x/y" TargetMode="External"'),
            "damaged",
        ),
        (change_template(r"ppt/slideLayouts/.*", 'idx="', 'idx="r'), "damaged"),
        (change_template(r"ppt/slideLayouts/.*", 'type="title"', 'type="nosuch"'), "damaged"),
    ],
    ids=["text", "old", "4:3", "macros", "other", "torn", "entity", "titles", "external theme", "index", "kind"],
)
def test_what_is_no_template_is_refused_in_words(template: bytes, words: str) -> None:
    with pytest.raises(TemplateError, match=re.escape(words)):
        write(template)
