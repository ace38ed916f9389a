"""What the legend below a picture explains."""

from __future__ import annotations

from archgen.emit.graphviz.drawn_legend import add_graph_legend
from archgen.emit.graphviz.placed_scene import Scene
from archgen.views.graphs.graph_folding import add_legend_keys
from archgen.views.picture_shapes import Arrow, Box, Graph


def test_widths_of_arrows_are_explained_with_their_numbers() -> None:
    boxes = (Box("a", "A"), Box("b", "B"))
    arrows = tuple(Arrow(str(count), "a", "b", str(count), count=count) for count in (1, 3, 7))
    graph = add_legend_keys(Graph("g", "G", "two-step", boxes, arrows, kind="components"))
    drawn = add_graph_legend(Scene(), graph)
    # A sentence, no samples: three of them took more room than all other forms of a large picture.
    assert [part.name for part in drawn.parts if part.kind == "label"] == ["notes"]
    assert drawn.lines == ()
    assert "the more, the thicker it is." in drawn.parts[0].attributes["label"]


def test_a_picture_reaches_as_far_as_its_legend_in_the_widest_face() -> None:
    graph = Graph("g", "G", "overview", (), (), kind="overview", legend=("count",))
    drawn = add_graph_legend(Scene(), graph)
    (words,) = (part for part in drawn.parts if part.name == "notes")
    left, _, right, _ = drawn.bounds()
    # DejaVu Sans needs 15 % more than Inter for this sentence.
    assert right - left >= words.width * 1.15
