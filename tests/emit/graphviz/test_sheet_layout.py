"""Sheets: texts stand at the side that they name, hostile texts are texts, addresses are addresses."""

from __future__ import annotations

from lxml import etree

from archgen.emit.graphviz import draw_pictures
from archgen.emit.graphviz.graph_drawing import lay_out_sheet
from archgen.views.picture_shapes import Sheet, SheetBar, SheetLine, SheetText

HOSTILE = '<script>alert(1)</script>"]; evil [label="x\x00'
SHEET = Sheet(
    "s",
    HOSTILE,
    (SheetBar(0, 0, 30, 10, "step4", label="7", ref="a", tooltip=HOSTILE), SheetBar(40, 0, 30, 10, "unknown")),
    tuple(SheetText(100, 5, HOSTILE, side=side) for side in ("left", "right", "middle")),
    (SheetLine(((0, 40), (50, 40))), SheetLine(((50, 60), (0, 60)), width=4, head=False)),
    notes=(HOSTILE,),
)


def test_texts_stand_at_their_side() -> None:
    left, right, middle = (
        part for part in lay_out_sheet(SHEET, lambda _: None).parts if part.name in {"t0", "t1", "t2"}
    )
    assert (round(left.rectangle[0], 3), round(right.rectangle[2], 3), round(middle.x, 3)) == (100, 100, 100)


def test_a_sheet_is_drawn_in_all_formats() -> None:
    picture = draw_pictures(
        (SHEET,), ("svg", "svg_outlines", "png", "pdf", "dot"), resolve_link=lambda ref: f"{ref}.html"
    )["s"]
    assert picture.warning is None
    assert None not in (picture.svg, picture.svg_outlines, picture.png, picture.pdf)
    root = etree.fromstring(picture.svg or b"")
    assert not list(root.iter("{http://www.w3.org/2000/svg}script"))
    assert [link.get("{http://www.w3.org/1999/xlink}href") for link in root.iter("{http://www.w3.org/2000/svg}a")] == [
        "a.html"
    ]
