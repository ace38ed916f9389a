"""Frames as people see them: a tree, a table, a list, cards, search, a page and a chapter; nothing of it without frames."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from archgen.diagnostics.diagnostic import Severity
from archgen.products import project_views
from archgen.products.output_options import OutputOptions
from archgen.products.project_views import make_scoped_lookup
from archgen.views.elements.element_card import make_card
from archgen.views.elements.element_names import find_elements
from archgen.views.elements.frame_users import list_shown_frames
from archgen.views.graphs.frame_graph import draw_frames
from archgen.views.lookup import Lookup
from archgen.views.pages import report_outline, site_pages
from archgen.views.search import make_search_entries
from archgen.views.tables.element_rows import list_element_rows
from archgen.views.tables.functional_tables import make_frame_table

ROBOT = """\
archgen: 1
groups:
  driving:
    components:
      localisation: {title: Localiser, inputs: {scan: {from: lidar.scan, frame: laser}}, frames: {odom: {parent: map, rate: 20 Hz}}}
      drive: {title: Drive, outputs: {pose: Pose}}
  sensing: {components: {lidar: {outputs: {scan: sensor_msgs/msg/LaserScan}}}}
frames:
  map: {title: The building}
  base_link: {parent: odom, by: drive}
  laser: {parent: base_link, static: true}
  tool: {parent: flange, by: publisher}
types: {Pose: {message: geometry_msgs/msg/PoseStamped, frame: map}}
nodes: {publisher: {package: robot_state_publisher}, localisation: localisation}
"""


def look_up(folder: Path, text: str = ROBOT, selector: str = "") -> Lookup:
    (folder / "robot.yaml").write_text(text, encoding="utf-8")
    checked = pipeline.check_project(folder / "robot.yaml")
    selection = project_views.select_elements(checked, selector)[0] if selector else None
    return make_scoped_lookup(checked, OutputOptions(selection, selector))


def test_the_tree_shows_parents_writers_and_what_is_wrong(tmp_path: Path) -> None:
    graph = draw_frames(look_up(tmp_path))
    boxes = [(box.title, box.lines, box.colour, box.badge) for box in graph.boxes]
    assert boxes == [
        ("flange", ("not declared",), None, None),
        ("map", ("The building",), None, None),
        ("tool", ("by publisher",), None, "error"),
        ("odom", ("by Localiser",), 0, None),
        ("base_link", ("by Drive",), 0, None),
        ("laser", ("by nobody yet",), None, "note"),
    ]
    arrows = [
        (arrow.tail.removeprefix("frame "), arrow.head.removeprefix("frame "), arrow.label) for arrow in graph.arrows
    ]
    assert arrows == [
        ("flange", "tool", ""),
        ("map", "odom", "20 Hz"),
        ("odom", "base_link", ""),
        ("base_link", "laser", "static"),
    ]
    assert (graph.direction, graph.asked, graph.alt) == ("top-bottom", 4, "5 frames below flange, map.")


def test_a_circle_is_drawn_and_a_large_tree_says_what_it_leaves_out(tmp_path: Path) -> None:
    circle = draw_frames(look_up(tmp_path, "archgen: 1\nframes: {a: b, b: a}\n"))
    assert [(arrow.tail, arrow.head) for arrow in circle.arrows] == [("frame b", "frame a"), ("frame a", "frame b")]
    assert circle.alt == "2 frames below no root."
    links = "".join(f"  link_{at}: base\n" for at in range(100))
    large = draw_frames(look_up(tmp_path, f"archgen: 1\nframes:\n  base:\n{links}"))
    assert (len(large.boxes), len(large.arrows)) == (70, 69)
    assert large.notes == ("31 frames further down not drawn: the table has all of them.",)


def test_the_table_and_the_list_have_every_frame(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    table = make_frame_table(lookup)
    assert table
    rows = [tuple("".join(run.text for run in cell) for cell in row) for row in table.rows]
    assert rows == [
        ("map The building", "a root", "", "", "Drive · pose"),
        ("base_link", "odom", "Drive", "not known yet", ""),
        ("laser", "base_link", "nobody yet", "static", "Localiser · scan"),
        ("tool", "flange", "publisher", "not known yet", ""),
        ("odom", "map", "Localiser", "20 Hz", ""),
    ]
    assert table.row_anchors[0] == "frame:map"
    columns, listed = list_element_rows(lookup, "frames")
    assert columns == ("id", "title", "parent", "by", "rate", "ports", "place")
    assert listed[0] == ("map", "The building", "", "", "", "driving.drive.pose", "robot.yaml:9:3")
    assert listed[2][3:6] == ("", "static", "driving.localisation.scan")


def test_a_card_says_what_stands_in_a_frame_and_who_uses_it(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    assert find_elements(lookup, "laser") == [("frame", "laser")]
    card = make_card(lookup, "frame", "base_link")
    assert card.facts == (("parent", "odom"), ("by", "driving.drive"))
    assert card.lists == (("holds", ("laser",)), ("used by", ()))
    assert make_card(lookup, "frame", "odom").facts[-1] == ("rate", "20 Hz")
    assert make_card(lookup, "frame", "map").lists[1] == ("used by", ("driving.drive.pose",))
    assert ("frame", "map") in make_card(lookup, "output", "driving.drive.pose").facts


def test_search_finds_frames(tmp_path: Path) -> None:
    entries = {entry.title: entry for entry in make_search_entries(look_up(tmp_path), ()) if entry.kind == "frame"}
    assert list(entries) == ["map", "base_link", "laser", "tool", "odom"]
    assert (entries["odom"].line, entries["map"].text) == ("frame · in map · by Localiser", "The building")
    assert entries["odom"].refs == ("frame:odom", "page:frames")


@pytest.mark.parametrize(
    ("selector", "names"),
    [
        ("driving.localisation", ["map", "base_link", "laser", "odom"]),
        ("driving.drive", ["map", "base_link", "odom"]),
        ("sensing", []),
    ],
)
def test_a_part_shows_its_frames_with_all_above(tmp_path: Path, selector: str, names: list[str]) -> None:
    assert [frame.id for frame in list_shown_frames(look_up(tmp_path, selector=selector))] == names


def test_there_is_a_page_and_a_chapter_only_where_frames_are_written(tmp_path: Path) -> None:
    sound = ROBOT.replace("flange", "laser")
    for text, has_frames in ((sound, True), ("archgen: 1\ngroups: {g: {components: {a: }}}\n", False)):
        (tmp_path / "robot.yaml").write_text(text, encoding="utf-8")
        checked = pipeline.check_project(tmp_path / "robot.yaml")
        assert not any(finding.severity is Severity.ERROR for finding in checked.findings)
        views = project_views.make_views(checked, OutputOptions())
        pages = {page.anchor: page for page in site_pages.make_pages(views.lookup, views.edition)}
        chapters = {section.anchor for section in report_outline.make_report(views.lookup, views.edition).sections}
        assert ("frames" in views.drawings, "page:frames" in pages, "page:frames" in chapters) == (has_frames,) * 3
