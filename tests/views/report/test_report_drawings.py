"""The report's own pictures: narrower, with nothing lost of what runs between nodes."""

from __future__ import annotations

from archgen.views.picture_shapes import Arrow, Box, Graph
from archgen.views.report.report_drawings import drop_neighbours, join_topics


def _graph(*arrows: tuple[str, str], kind: str = "implementation") -> Graph:
    boxes = (
        Box("a", "a", style="node", emphasis="subject"),
        Box("b", "b", style="node", emphasis="subject"),
        Box("<n", "n", style="node", emphasis="neighbour", side="left"),
        Box("topic /x", "/x", ("pkg/msg/X",), style="topic"),
        Box("topic /y", "/y", style="topic"),
    )
    drawn = tuple(Arrow(f"{tail}>{head}", tail, head) for tail, head in arrows)
    return Graph("implementation/c", "C", "flow", boxes, drawn, asked=len(drawn), kind=kind)  # type: ignore[arg-type]


def test_topics_become_lines_of_the_neighbour_and_one_arrow() -> None:
    joined = join_topics(_graph(("<n", "topic /x"), ("topic /x", "a"), ("<n", "topic /y"), ("topic /y", "a")))
    assert joined.id == "report/implementation/c"
    assert [box.lines for box in joined.boxes if box.id == "<n"] == [("/x", "/y")]
    assert [(arrow.tail, arrow.head, arrow.count) for arrow in joined.arrows] == [("<n", "a", 2)]
    assert joined.asked == 2
    assert not [box for box in joined.boxes if box.style == "topic"]


def test_a_topic_between_nodes_of_the_component_stays_and_the_picture_stands_upright() -> None:
    joined = join_topics(_graph(("a", "topic /x"), ("topic /x", "b"), ("a", "topic /y")))
    assert {box.id for box in joined.boxes if box.style == "topic"} == {"topic /x", "topic /y"}
    assert len(joined.arrows) == 3
    assert joined.direction == "top-bottom"


def test_a_group_without_its_neighbours_says_so() -> None:
    inside = drop_neighbours(_graph(("a", "b"), ("<n", "a"), kind="group"))
    assert [(arrow.tail, arrow.head) for arrow in inside.arrows] == [("a", "b")]
    assert inside.notes == ("Inside the group only; the tables of its components name the neighbours.",)
