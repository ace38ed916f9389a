"""A frame is as large as what it holds, whatever its neighbours need beside it."""

from __future__ import annotations

import pytest

from archgen.emit.graphviz import graph_drawing
from archgen.emit.graphviz.flow_layout import draw_frame, unwrap_tall_columns
from archgen.emit.graphviz.placed_scene import Scene, SceneLine, ScenePart
from archgen.emit.graphviz.styled_graph import style_graph
from archgen.views.picture_shapes import Arrow, Box, Cluster, Graph

FRAME = Cluster("g", "G")


def draw_group(feeders: int) -> Graph:
    """Return a group of two boxes, of which one has many feeders, and one of these feeds both."""
    boxes: tuple[Box, ...] = (Box("a", "A", cluster="g"), Box("b", "B", cluster="g"))
    boxes += tuple(
        Box(f"f{at}", f"Feeder of the signal {at}", ("Far away",), side="left", emphasis="neighbour")
        for at in range(feeders)
    )
    arrows: tuple[Arrow, ...] = (Arrow("ab", "a", "b", "Result"), Arrow("f0b", "f0", "b", "Other signal"))
    arrows += tuple(Arrow(f"{at}", f"f{at}", "a", f"Signal {at}") for at in range(feeders))
    return Graph("groups/g", "G", "group", boxes, arrows, (FRAME,), kind="group")


def test_many_neighbours_do_not_stretch_a_frame() -> None:
    _, scene = graph_drawing.lay_out_graph(draw_group(12), {})
    (frame,) = scene.frames
    inside = [part.rectangle for part in scene.parts if part.name in {"n0", "n1"}]
    assert frame.rectangle[3] - frame.rectangle[1] < 0.6 * (scene.bounds()[3] - scene.bounds()[1])
    assert all(
        box[0] > frame.rectangle[0] and box[1] > frame.rectangle[1] and box[3] < frame.rectangle[3] for box in inside
    )


@pytest.mark.parametrize(("peak", "held_height"), [(40, 18), (90, 0)])
def test_a_line_from_outside_does_not_run_along_the_rim(peak: float, held_height: float) -> None:
    styled_graph = style_graph(draw_group(1), lambda _: None)
    boxes = tuple(ScenePart(name, {}, x, 0, 40, 20) for name, x in (("n0", 0), ("n1", 100), ("n2", -200)))
    line = SceneLine("1", "f0b", "n2", "n1", {}, f"-180,0 -60,{peak} 40,{peak} 60,0")
    framed = draw_frame(styled_graph, FRAME, Scene((), (line,), boxes), {"n0", "n1"})
    title = next(part for part in framed.parts if part.kind == "title")
    # What the frame needs for its boxes, its margin and its title.
    least = 10 + 12 + title.height
    assert framed.frames[0].rectangle[3] - least == pytest.approx(held_height, abs=1)


def test_titles_of_a_tall_column_are_not_wrapped() -> None:
    few, many = (style_graph(draw_group(count), lambda _: None) for count in (8, 18))
    assert unwrap_tall_columns(few) is few
    unwrapped = unwrap_tall_columns(many)
    assert "Feeder of the signal 3" not in many.box_attributes["n5"]["label"]
    assert "Feeder of the signal 3" in unwrapped.box_attributes["n5"]["label"]
    # Those inside stay as they are.
    assert unwrapped.box_attributes["n0"] == many.box_attributes["n0"]
