"""What the legend below a picture explains."""

from __future__ import annotations

import re

import pytest

from archgen.emit.graphviz.drawn_legend import add_graph_legend
from archgen.emit.graphviz.placed_scene import Scene
from archgen.views.graph_shapes import Arrow, Graph


@pytest.mark.parametrize(
    ("counts", "samples"),
    [
        ((1, 4), ["width1", "width4"]),
        ((2, 3, 5), ["width2", "width4"]),
        ((1, 2, 9), ["width1", "width2", "width4"]),
    ],
)
def test_only_the_widths_of_the_picture_are_explained(counts: tuple[int, ...], samples: list[str]) -> None:
    arrows = tuple(Arrow(str(count), "a", "b", count=count) for count in counts)
    scene = add_graph_legend(Scene(), Graph("g", "G", "overview", (), arrows, kind="overview", legend=("width",)))
    names = {found[1] for part in scene.parts if (found := re.fullmatch(r"k[0-9]+(width[0-9])[0-9]", part.name))}
    assert sorted(names) == samples


def test_a_picture_reaches_as_far_as_its_legend_in_the_widest_face() -> None:
    graph = Graph("g", "G", "overview", (), (), kind="overview", legend=("count",))
    drawn = add_graph_legend(Scene(), graph)
    (words,) = (part for part in drawn.parts if part.name == "notes")
    left, _, right, _ = drawn.bounds()
    # DejaVu Sans needs 15 % more than Inter for this sentence.
    assert right - left >= words.width * 1.15
