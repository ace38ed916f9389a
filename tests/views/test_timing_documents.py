"""Timing in report and site: the same tables in both, every chain its place, nothing of it where it does not belong."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import pytest

from archgen.views.drawing_set import make_drawings
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.pages import report_outline, site_pages
from archgen.views.pages.report_outline import DocumentEdition
from archgen.views.shapes import Bullets, Facts, Figure, Section, Table
from archgen.views.timing import element_timing, timing_tables
from tests.judged_projects import judge_ramcip
from tests.timings import timed


@pytest.fixture(scope="module")
def view() -> Lookup:
    architecture = judge_ramcip().architecture
    return make_lookup(architecture, timing_lookup=timed(architecture))


@pytest.fixture(scope="module")
def edition(view: Lookup) -> DocumentEdition:
    return DocumentEdition(drawings=make_drawings(view, None, "implementation"))


def _sections(sections: tuple[Section, ...]) -> Iterator[Section]:
    for section in sections:
        yield section
        yield from _sections(section.sections)


def _tables(section: Section) -> dict[str, Table]:
    found = [block for each in _sections((section,)) for block in each.blocks if isinstance(block, Table)]
    return {table.anchor: table for table in found}


def _cells(table: Table, first: str) -> list[str]:
    (row,) = (row for row in table.rows if row[0][0].text == first)
    return ["".join(part.text for part in cell) for cell in row]


def test_the_chapter_has_every_table_and_picture(view: Lookup, edition: DocumentEdition) -> None:
    (chapter,) = (each for each in report_outline.make_report(view, edition).sections if each.anchor == "page:timing")
    assert set(_tables(chapter)) == {
        "table:periods",
        "table:timing",
        "table:load",
        "table:traffic",
        "table:bandwidth",
    }
    shown = {block.graph for each in _sections((chapter,)) for block in each.blocks if isinstance(block, Figure)}
    assert shown == {name for name in edition.drawings if name.split("/")[0] in {"timing", "load"}}


def test_report_and_site_say_the_same(view: Lookup, edition: DocumentEdition) -> None:
    (chapter,) = (each for each in report_outline.make_report(view, edition).sections if each.anchor == "page:timing")
    pages = [each for each in site_pages.make_pages(view, edition) if each.path.startswith("timing")]
    assert {page.title for page in pages[1:]} == {section.title for section in chapter.sections}
    tables = {anchor: table for page in pages for anchor, table in _tables(page.section).items()}
    assert tables == _tables(chapter)
    # The first page leads to all others.
    (links,) = (
        block
        for block in pages[0].section.blocks
        if isinstance(block, Bullets) and (block.items[0][0].ref or "").startswith("timing:")
    )
    assert [item[0].ref for item in links.items] == [page.anchor for page in pages[1:]]


def test_every_activity_has_its_row(view: Lookup) -> None:
    assert view.timing is not None
    table = timing_tables.make_activity_table(view, view.timing)
    assert table is not None
    assert [row[0][0].text for row in table.rows] == list(view.timing.analysis.system.activities)
    assert _cells(table, "object_recognizer")[1:4] == ["periodic", "5 Hz", "200 ms"]
    assert _cells(table, "floor_watch")[4].startswith("from object_recognizer")
    assert _cells(table, "light_engine")[5] == "unknown"


def test_every_chain_has_a_section_and_a_page(view: Lookup, edition: DocumentEdition) -> None:
    outline = report_outline.make_report(view, edition)
    anchors = [section.anchor for section in _sections(outline.sections)]
    assert len(anchors) == len(set(anchors))
    wanted = {f"chain:{name}" for name in view.architecture.chains}
    assert wanted <= set(anchors)
    assert wanted == {page.anchor for page in site_pages.make_pages(view, edition) if page.kind == "chains"}


def test_the_functional_level_has_no_timing_pictures(view: Lookup) -> None:
    functional = DocumentEdition(level="functional", drawings=make_drawings(view, None, "functional"))
    assert [name for name in functional.drawings if name.split("/")[0] in {"timing", "load"}] == []
    assert "page:timing" not in {section.anchor for section in report_outline.make_report(view, functional).sections}


def test_without_timing_the_chains_are_listed_with_their_deadlines(view: Lookup) -> None:
    plain = replace(view, timing=None)
    (chapter,) = (
        each for each in report_outline.make_report(plain, DocumentEdition()).sections if each.anchor == "page:chains"
    )
    assert [column.title for column in _tables(chapter)["table:chains"].columns][2] == "Deadline"


def test_pages_of_elements_say_the_derived_rate(view: Lookup) -> None:
    node = view.architecture.nodes["floor_watch"]
    node_facts = element_timing.make_node_facts(view, node)
    facts = {fact.title: "".join(part.text for part in fact.value) for fact in node_facts}
    assert facts["Rate"].endswith("event, from object_recognizer, semantic_mapper")
    assert facts["Response"] == "within 12 ms (own core assumed)"
    (first, *_) = element_timing.make_load_blocks(view, "vision_pc")
    assert isinstance(first, Figure)
    assert first.graph == "load/vision_pc"


def test_a_chain_names_what_is_missing(view: Lookup) -> None:
    assert view.timing is not None
    (result,) = (each for each in view.timing.chains if each.verdict == "open")
    facts = next(
        block for block in element_timing.make_chain_blocks(view, view.timing, result) if isinstance(block, Facts)
    )
    said = {name: "".join(part.text for part in value) for name, value in facts.rows}
    assert said["Reaction time and data age, at the latest"].endswith(
        "; no bound: execution time of light_engine unknown"
    )


def test_topics_stand_by_what_they_deliver_the_most_first(view: Lookup) -> None:
    assert view.timing is not None
    table = timing_tables.make_bandwidth_table(view, view.timing)
    assert table is not None
    amounts = [float(row[3][0].sort_number or 0) for row in table.rows]
    assert amounts == sorted(amounts, reverse=True)
    assert amounts[0] > amounts[-1] == 0
