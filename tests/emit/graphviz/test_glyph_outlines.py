"""Letters of outlined pictures: the same points in fewer bytes."""

from __future__ import annotations

import pytest

from archgen.emit import graphviz
from archgen.emit.graphviz.graph_drawing import shorten_glyphs, shorten_path
from archgen.views.picture_shapes import BarSegment, Chart, ChartBar


@pytest.mark.parametrize(
    ("path", "short"),
    [
        (
            b"M 1 2 L 1.50 2.25 C 1.50 2 0.97 -0.50 1 2 Z M 3 4 L 5 5 Z M 3 4 ",
            b"m1 2l.5 .25c0-.25-.53-2.75-.5-.25zm2 2l2 1z",
        ),
        (b"M 0 0 L 0 0.05 Z", b"m0 0l0 .05z"),
        (b"M 10 0 L 110 0", b"m10 0l100 0"),
        (b"M 1 1 A 5 5 0 0 1 2 2", b"M 1 1 A 5 5 0 0 1 2 2"),
        (b"M 1", b"M 1"),
        (b"", b""),
    ],
)
def test_points_become_steps(path: bytes, short: bytes) -> None:
    assert shorten_path(path) == short


def test_letters_that_no_text_has_are_left_out() -> None:
    symbol = b'<symbol overflow="visible" id="glyph0-%d">\n<path d="M 1 2 L 3 4 Z"/>\n</symbol>\n'
    svg = symbol % 0 + symbol % 1 + b'<use xlink:href="#glyph0-1"/><path d="M 1 2 L 3 4"/>'
    assert shorten_glyphs(svg) == (symbol % 1).replace(b"M 1 2 L 3 4 Z", b"m1 2l2 2z") + svg[len(symbol % 0) * 2 :]


def test_a_drawn_picture_has_its_letters_in_steps() -> None:
    chart = Chart("chains/c", "A chain", "ms", (ChartBar("camera", (BarSegment(1.0, "response"),), "1 ms"),))
    outlines = graphviz.draw_pictures([chart], ["svg_outlines"], resolve_link=lambda _: None)["chains/c"].svg_outlines
    assert outlines is not None
    letters = outlines.partition(b"<clipPath")[0].partition(b"</defs>")[0]
    assert b' d="m' in letters
    assert b' d="M' not in letters
