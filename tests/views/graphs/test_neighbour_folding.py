"""Surroundings of a change as one box a group."""

from __future__ import annotations

from archgen.views.graphs.changes.merged_versions import fold_neighbours
from archgen.views.picture_shapes import Arrow, Box, Cluster, Graph


def fold(boxes: tuple[Box, ...], arrows: tuple[Arrow, ...], *titles: str) -> Graph:
    frames = tuple(Cluster(title.strip("+ ").lower(), title, tooltip=title.strip("+ ")) for title in titles)
    return fold_neighbours(Graph("g", "G", "framed", boxes, arrows, frames, kind="component-changes"))


def neighbour(name: str, frame: str, *lines: str) -> Box:
    return Box(name, name.title(), lines, emphasis="neighbour", cluster=frame)


def test_a_group_of_many_names_the_first_and_counts_the_others() -> None:
    readers = tuple(neighbour(f"reader {at}", "far") for at in range(8))
    arrows = tuple(Arrow(str(at), "core", box.id, faded=True, flows=(box.id,)) for at, box in enumerate(readers))
    folded = fold((Box("core", "~ Core", change="changed", cluster="near"), *readers), arrows, "Near", "Far")
    core, group = folded.boxes
    assert core.cluster == "near"
    assert (group.title, group.cluster) == ("Far", None)
    assert group.lines == ("Reader 0", "Reader 1", "Reader 2", "Reader 3", "Reader 4", "and 3 more")
    assert group.tooltip.splitlines()[-1] == "Reader 7"
    (arrow,) = folded.arrows
    assert (arrow.tail, arrow.head, arrow.count) == ("core", group.id, 8)
    assert arrow.flows == tuple(box.id for box in readers)


def test_arrows_of_different_forms_stay_apart() -> None:
    boxes = (Box("core", "~ Core", change="changed", cluster="near"), neighbour("a", "far"), neighbour("b", "far"))
    arrows = (Arrow("1", "core", "a"), Arrow("2", "core", "b", style="action"), Arrow("3", "core", "b", optional=True))
    folded = fold(boxes, arrows, "Near", "Far")
    assert [(arrow.style, arrow.count, arrow.optional) for arrow in folded.arrows] == [
        ("data", 2, False),
        ("action", 1, False),
    ]
    assert len({arrow.id for arrow in folded.arrows}) == len(folded.arrows)


def test_a_group_that_is_renamed_keeps_its_frame() -> None:
    boxes = (Box("core", "~ Core", change="changed", cluster="near"), neighbour("a", "far"))
    folded = fold(boxes, (Arrow("1", "core", "a"),), "Near", "+ Far")
    assert [cluster.id for cluster in folded.clusters] == ["near", "far"]
    assert folded.boxes == boxes


def test_a_component_says_what_it_stands_in_behind_its_group() -> None:
    boxes = (Box("core", "~ Core", change="changed", cluster="near"), neighbour("a", "far", "Left arm"))
    (_, box) = fold(boxes, (Arrow("1", "a", "core"),), "Near", "Far").boxes
    assert (box.title, box.lines) == ("A", ("Far · Left arm",))
