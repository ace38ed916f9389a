"""The overview: few crossings on the drawn curves, no line through a box, every flow counted at a head."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path
from typing import Literal

import pytest

from archgen import pipeline
from archgen.emit.graphviz import graph_drawing, palette
from archgen.emit.graphviz.label_places import count_crossings, sample_line
from archgen.emit.graphviz.overview_layout import lay_out_overview
from archgen.emit.graphviz.placed_scene import Scene, SceneLine
from archgen.emit.graphviz.styled_graph import style_graph
from archgen.views.graphs import draw_overview
from archgen.views.lookup import make_lookup
from archgen.views.picture_shapes import Arrow, Box, Graph
from tests.architectures import robot
from tests.emit.graphviz.overlaps import overlapping_parts

RAMCIP = Path(__file__).parents[3] / "example_ramcip"
Direction = Literal["left-right", "top-bottom"]


def list_lines(graph: Graph, scene: Scene) -> list[SceneLine]:
    """Return the lines themselves, without their rims and heads."""
    return [line for line in scene.lines if int(line.edge) < len(graph.arrows)]


def count_crossing_pairs(lines: list[SceneLine]) -> int:
    """Count the pairs of curves that cross at least once."""
    return sum(count_crossings(pair) > 0 for pair in combinations(lines, 2))


def list_cut_boxes(graph: Graph, scene: Scene) -> list[tuple[str, str]]:
    """Return each box that a line which does not end there runs through."""
    boxes = [part for part in scene.parts if part.kind == "box"]
    return [
        (line.edge, box.name)
        for line in list_lines(graph, scene)
        for box in boxes
        if any(
            box.rectangle[0] + 1 < x < box.rectangle[2] - 1 and box.rectangle[1] + 1 < y < box.rectangle[3] - 1
            for x, y in sample_line(line, 40)
        )
    ]


@pytest.mark.slow
@pytest.mark.parametrize(("direction", "most"), [("left-right", 15), ("top-bottom", 17)])
def test_few_lines_of_the_case_study_cross(direction: Direction, most: int) -> None:
    architecture = pipeline.check_project(RAMCIP).architecture
    graph = draw_overview(make_lookup(architecture), direction)
    _, scene = graph_drawing.lay_out_graph(graph, {})
    lines = list_lines(graph, scene)
    assert len(lines) == 30, "one line for each pair"
    assert count_crossing_pairs(lines) <= most
    assert list_cut_boxes(graph, scene) == []
    assert list(overlapping_parts(scene)) == []
    numbers = [part.attributes["label"] for part in scene.parts if part.name[0] == "l" and part.name[1:].isdigit()]
    shown = [int(label.partition("<B>")[2].partition("</B>")[0]) for label in numbers]
    assert sum(shown) + sum(arrow.count == 1 for arrow in graph.arrows) == graph.asked == 101
    heads = [line for line in scene.lines if len(graph.arrows) <= int(line.edge) < 2 * len(graph.arrows)]
    assert sorted(line.arrow for line in heads) == sorted(arrow.id for arrow in graph.arrows)


def test_another_robot_crosses_little() -> None:
    graph = draw_overview(make_lookup(robot(1)))
    _, scene = graph_drawing.lay_out_graph(graph, {})
    assert count_crossing_pairs(list_lines(graph, scene)) <= 4
    assert list_cut_boxes(graph, scene) == []


def test_a_graph_without_lines_or_boxes() -> None:
    for boxes in ((), (Box("a", "A"),), tuple(Box(str(at), "B") for at in range(40))):
        scene = lay_out_overview(style_graph(Graph("g", "G", "overview", boxes, (), kind="overview"), lambda _: None))
        assert len(scene.parts) == len(boxes)
        assert list(overlapping_parts(scene)) == []


def test_what_runs_back_has_an_amber_head() -> None:
    boxes = tuple(Box(name, name, members=((1, 2), (None, 1))) for name in "abc")
    arrows = (Arrow("ab", "a", "b", count=4), Arrow("bc", "b", "c", count=4), Arrow("ca", "c", "a"))
    _, scene = graph_drawing.lay_out_graph(Graph("g", "G", "overview", boxes, arrows, kind="overview"), {})
    colours = {line.arrow: line.attributes["color"] for line in scene.lines if 3 <= int(line.edge) < 6}
    assert colours == {"ab": '"#66717a"', "bc": '"#66717a"', "ca": '"#b25e00"'}


@pytest.mark.parametrize("count", [1, 13, 14, 26, 27, 400])
def test_squares_of_many_members_stay_in_their_box(count: int) -> None:
    box = Box("a", "A", members=((1, count), (2, 1)))
    _, scene = graph_drawing.lay_out_graph(Graph("g", "G", "overview", (box,), (), kind="overview"), {})
    (part,) = (part for part in scene.parts if part.kind == "box")
    assert part.width < 140
    label = part.attributes["label"]
    assert label.count(f'BGCOLOR="{palette.PARTNER_HUES[0]}"') == (count if count < 26 else 1)
