"""The memory of layouts: asked again, it saves the tries; what it holds never changes a picture."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from archgen.cache.layout_memory import LayoutMemory
from archgen.emit.graphviz import graph_drawing, two_step_layout
from archgen.views.graphs import draw_components, group_columns
from archgen.views.lookup import make_lookup
from archgen.views.picture_shapes import Arrow, Box, Graph
from tests.architectures import robot
from tests.property_sizes import try_some

GRAPH = draw_components(make_lookup(robot(1)))


def retitle(graph: Graph, title: str) -> Graph:
    """Return the graph with another title of its first frame."""
    first, *others = graph.clusters
    return replace(graph, clusters=(replace(first, title=title), *others))


GROUPS = Graph(
    "overview",
    "Groups",
    "overview",
    tuple(Box(name, name.upper()) for name in "abc"),
    (Arrow("ab", "a", "b"), Arrow("ba", "b", "a", count=3), Arrow("bc", "b", "c")),
    kind="overview",
)


def no_tries(*_: object) -> None:
    pytest.fail("layouts were tried")


def test_a_title_that_needs_no_more_room_is_laid_out_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    memory = LayoutMemory(tmp_path, "program")
    graph_drawing.draw_picture(GRAPH, {}, ("svg",), memory=memory)
    changed_graph = retitle(GRAPH, "Xyz")
    fresh_picture = graph_drawing.draw_picture(changed_graph, {}, ("svg",))
    monkeypatch.setattr(two_step_layout, "_candidate_layouts", no_tries)
    assert graph_drawing.draw_picture(changed_graph, {}, ("svg",), memory=memory) == fresh_picture


def test_another_program_tries_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    graph_drawing.draw_picture(GRAPH, {}, ("svg",), memory=LayoutMemory(tmp_path, "old program"))
    monkeypatch.setattr(two_step_layout, "_candidate_layouts", no_tries)
    with pytest.raises(pytest.fail.Exception, match="layouts were tried"):
        graph_drawing.draw_picture(GRAPH, {}, ("svg",), memory=LayoutMemory(tmp_path, "program"))


@pytest.mark.parametrize(
    "change",
    [
        retitle(GRAPH, "A title that is longer than all that stands in its frame " * 3),
        replace(GRAPH, arrows=GRAPH.arrows[1:]),
        replace(GRAPH, direction="top-bottom"),
    ],
    ids=["a longer title", "an arrow less", "another direction"],
)
def test_what_decides_the_layout_is_tried_anew(change: Graph, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    memory = LayoutMemory(tmp_path, "program")
    graph_drawing.draw_picture(GRAPH, {}, ("svg",), memory=memory)
    monkeypatch.setattr(two_step_layout, "_candidate_layouts", no_tries)
    with pytest.raises(pytest.fail.Exception, match="layouts were tried"):
        graph_drawing.draw_picture(change, {}, ("svg",), memory=memory)


@pytest.mark.parametrize(
    "damage", try_some([b'["a", ["b"], 1]', b"", b"null", b'["rankdir"', b"3", b"\xff", b'["a", 3]'])
)
@pytest.mark.parametrize("graph", [GRAPH, GROUPS], ids=["frames", "columns"])
def test_a_damaged_file_is_not_taken(graph: Graph, damage: bytes, tmp_path: Path) -> None:
    memory = LayoutMemory(tmp_path, "program")
    drawn = graph_drawing.draw_picture(graph, {}, ("svg",), memory=memory)
    (file,) = tmp_path.iterdir()
    file.write_bytes(damage)
    assert graph_drawing.draw_picture(graph, {}, ("svg",), memory=memory) == drawn


def test_columns_of_groups_are_searched_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    memory = LayoutMemory(tmp_path, "program")
    drawn = graph_drawing.draw_picture(GROUPS, {}, ("svg",), memory=memory)
    monkeypatch.setattr(group_columns, "_Search", no_tries)
    group_columns._arrange.cache_clear()  # noqa: SLF001 - as another process has it
    assert graph_drawing.draw_picture(GROUPS, {}, ("svg",), memory=memory) == drawn
