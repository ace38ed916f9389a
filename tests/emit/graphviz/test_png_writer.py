"""A PNG keeps each fill of the drawing exactly, with whichever of Graphviz's writers is there."""

from __future__ import annotations

import struct
from collections.abc import Sequence

import pytest

from archgen.emit.graphviz import graph_drawing, layout_engine, png_writer
from archgen.emit.graphviz.placed_scene import Scene
from archgen.views.picture_shapes import Arrow, Box, Graph

_ATTRIBUTES = {"pad": '"0.08"', "bgcolor": '"#ffffff"'}


@pytest.fixture(scope="module")
def scene() -> Scene:
    """Place two boxes and an arrow."""
    graph = Graph(
        "tiny", "Tiny", "flow", (Box("a", "A"), Box("b", "B")), (Arrow("x", "a", "b", "Data"),), kind="component"
    )
    return graph_drawing.lay_out_graph(graph, {})[1]


def _read_head(png: bytes) -> tuple[int, int]:
    """Return the width in pixels and the kind of colours: 3 is a palette, 2 and 6 are plain."""
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">I", png[16:20])[0], png[25]


@pytest.mark.parametrize("quick", [True, False])
def test_a_small_picture_has_a_palette_and_two_pixels_to_a_point(scene: Scene, quick: bool) -> None:  # noqa: FBT001
    left, _, right, _ = scene.bounds()
    width, colours = _read_head(png_writer.render_png(scene, "tiny", _ATTRIBUTES, quick=quick))
    assert colours == 3
    assert abs(width - (right - left + 14) * 2) <= 2


def test_one_that_is_wider_than_a_page_has_fewer_pixels(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    left, _, right, _ = scene.bounds()
    monkeypatch.setattr(png_writer, "_UPRIGHT_WIDTH", right - left - 1)
    width, _ = _read_head(png_writer.render_png(scene, "tiny", _ATTRIBUTES, quick=False))
    assert abs(width - (right - left + 14) * 110 / 72) <= 2


@pytest.mark.parametrize("missing", [("gd",), ("gd", "cairo")])
def test_without_gd_or_cairo_there_is_a_picture_all_the_same(
    scene: Scene, missing: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    render_dot = layout_engine.render_dot

    def refuse(*_: object) -> bytes:
        raise layout_engine.LayoutError

    def render_without(dot: str, formats: Sequence[str]) -> list[bytes]:
        if any(part in missing for form in formats for part in form.split(":")):
            raise layout_engine.LayoutError
        return list(render_dot(dot, formats))

    monkeypatch.setattr(layout_engine, "render_to_file", refuse)
    monkeypatch.setattr(layout_engine, "render_dot", render_without)
    width, _ = _read_head(png_writer.render_png(scene, "tiny", _ATTRIBUTES, quick=True))
    assert width > 100
