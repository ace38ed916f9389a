"""Titles of frames stand where no line passes."""

from __future__ import annotations

from archgen.emit.graphviz.label_places import clear_titles, count_cut_titles
from archgen.emit.graphviz.placed_scene import Scene, SceneFrame, SceneLine, ScenePart

FRAME = SceneFrame("c0", {}, (0, 0, 300, 100))
TITLE = ScenePart("t0", {}, 38, 88, 60, 16, "title")


def upright_line(x: float) -> SceneLine:
    return SceneLine("0", "a>b", "n0", "n1", {}, f"{x},150 {x},120 {x},80 {x},50")


def test_a_title_moves_to_the_nearest_place_at_its_right() -> None:
    scene = Scene((FRAME,), (upright_line(30),), (TITLE,))
    assert count_cut_titles(scene) == 1
    cleared = clear_titles(scene)
    (title,) = cleared.parts
    assert (title.x, title.y) == (62, 88)
    assert count_cut_titles(cleared) == 0
    assert cleared.lines == scene.lines


def test_a_title_without_a_line_stays_where_it_is() -> None:
    scene = Scene((FRAME,), (upright_line(200),), (TITLE,))
    assert clear_titles(scene) == scene
    assert clear_titles(Scene()) == Scene()


def test_a_title_never_leaves_its_frame() -> None:
    narrow = SceneFrame("c0", {}, (0, 0, 80, 100))
    scene = clear_titles(Scene((narrow,), (upright_line(40),), (TITLE,)))
    assert scene.parts[0].rectangle[2] <= 80
    assert count_cut_titles(scene) == 1
