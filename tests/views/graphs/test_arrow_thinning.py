"""Pictures of the whole architecture that no folding makes small enough."""

from __future__ import annotations

from itertools import permutations

from archgen.views.graphs import graph_folding
from archgen.views.graphs.graph_folding import MAX_ARROWS, fold_graph
from archgen.views.picture_shapes import Arrow, Box, Graph, GraphKind


def whole(boxes: int, arrows: list[tuple[int, int, int]], kind: GraphKind = "overview") -> Graph:
    """Make a picture of boxes with arrows (tail, head, flows)."""
    return Graph(
        "overview",
        "Whole",
        "overview",
        tuple(Box(f"b{at}", f"B{at}") for at in range(boxes)),
        tuple(Arrow(f"{tail}>{head}", f"b{tail}", f"b{head}", count=count) for tail, head, count in arrows),
        kind=kind,
    )


def test_of_too_many_arrows_the_largest_from_each_box_are_drawn() -> None:
    ends = list(permutations(range(20), 2))
    graph = fold_graph(whole(20, [(tail, head, 9 if head == (tail + 1) % 20 else 1) for tail, head in ends]))
    assert len(graph.arrows) == MAX_ARROWS
    assert len(graph.boxes) == 20
    assert sum(arrow.count == 9 for arrow in graph.arrows) == 20
    assert {sum(arrow.tail == box.id for arrow in graph.arrows) for box in graph.boxes} == {8}
    assert graph.asked == sum(arrow.count for arrow in graph.arrows)
    assert graph.notes == (
        "160 of 380 arrows are drawn, the largest from each box first. The explorer, the matrices and the tables have all.",
    )


def test_of_too_many_boxes_those_with_most_flows_are_drawn_in_their_order() -> None:
    graph = fold_graph(whole(200, [(at, at + 1, 1) for at in range(50, 199)]))
    # Of boxes with as many flows the first ones, and none that would have no arrow.
    assert [box.id for box in graph.boxes] == [f"b{at}" for at in range(50, 200)]
    assert graph.notes[0].startswith("150 of 200 boxes are drawn, those with most flows. The explorer")
    assert {end for arrow in graph.arrows for end in (arrow.tail, arrow.head)} <= {box.id for box in graph.boxes}


def test_the_same_picture_comes_out_each_time() -> None:
    graph = whole(180, [(tail, head, 1 + tail % 3) for tail, head in permutations(range(0, 180, 9), 2)])
    assert graph_folding.thin_graph(graph, 100) == graph_folding.thin_graph(graph, 100)


def test_nothing_is_left_out_of_what_somebody_chose_or_agreed_upon() -> None:
    ends = [(tail, head, 1) for tail, head in permutations(range(20), 2)]
    for kind in ("view", "agreement"):
        graph = fold_graph(whole(20, ends, kind))
        assert len(graph.arrows) == len(ends)
        assert graph.notes == ("This picture is larger than 70 boxes and 160 arrows: select a part to see it well.",)
