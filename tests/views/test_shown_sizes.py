"""The size of a type's messages, where documents, pages, lists and cards show it: written, computed, or why neither."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from archgen.products.output_options import OutputOptions
from archgen.products.project_views import make_scoped_lookup
from archgen.views.elements import element_card
from archgen.views.lookup import Lookup
from archgen.views.pages import context_pages
from archgen.views.shapes import Facts, Page
from archgen.views.tables import element_rows, functional_tables

PROJECT = """
archgen: 1
ros:
  distro: jazzy
  definitions:
    demo_msgs/msg/Word: "string<=8 text"
groups:
  driving:
    components:
      guard: {outputs: {velocity: Speed, picture: Image, bell: Bell, word: Word, big: Cloud}}
types:
  Speed: geometry_msgs/msg/Twist
  Image: sensor_msgs/msg/Image
  Bell: {message: std_msgs/msg/Empty, size: 1 kB}
  Word: demo_msgs/msg/Word
  Cloud: std_srvs/srv/Trigger
"""
SIZES = {"Speed": "52 B (computed)", "Image": "", "Bell": "1 kB", "Word": "at most 17 B (computed)", "Cloud": ""}


@pytest.fixture
def index(tmp_path: Path) -> Lookup:
    (tmp_path / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    return make_scoped_lookup(pipeline.check_project(tmp_path), OutputOptions())


def fact(page: Page) -> str:
    facts = next(block for block in page.section.blocks if isinstance(block, Facts))
    return "".join(text.text for name, value in facts.rows if name == "Size" for text in value)


def test_tables_lists_and_cards(index: Lookup) -> None:
    table = functional_tables.make_type_table(index)
    assert table is not None
    assert {row[0][0].text: "".join(text.text for text in row[2]) for row in table.rows} == SIZES
    assert {row[0]: row[2] for row in element_rows.list_element_rows(index, "types")[1]} == SIZES
    assert {name: dict(element_card.make_card(index, "type", name).facts).get("size", "") for name in SIZES} == SIZES


def test_the_page_of_a_type_says_why_its_size_is_not_known(index: Lookup) -> None:
    made = {
        page.title: fact(page)
        for page in context_pages.make_context_pages(index, tuple)
        if page.section.anchor[:5] == "type:"
    }
    assert made == {**SIZES, "Image": "unknown: the field header.frame_id may have any length (string)"}


def test_the_page_of_a_topic(index: Lookup) -> None:
    made = {page.title: fact(page) for page in context_pages.make_topic_pages(index)}
    assert made["/driving/guard/velocity"] == "52 B (computed)"
    assert made["/driving/guard/bell"] == "1 kB"
    assert made["/driving/guard/picture"] == ""
