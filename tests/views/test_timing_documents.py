"""Timing in report and site: the same tables in both, every chain its place, nothing of it where it does not belong."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import pytest

from archgen import pipeline, resources
from archgen.views import pages, report, timing, timing_of
from archgen.views.drawings import drawings
from archgen.views.index import Index, index
from archgen.views.report import Edition
from archgen.views.shapes import Facts, Figure, Section, Table
from tests.timings import timed


@pytest.fixture(scope="module")
def view() -> Index:
    architecture = pipeline.check(resources.path("example_ramcip")).architecture
    return index(architecture, timed=timed(architecture))


@pytest.fixture(scope="module")
def edition(view: Index) -> Edition:
    return Edition(graphs=drawings(view, None, "implementation"))


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


def test_the_chapter_has_every_table_and_picture(view: Index, edition: Edition) -> None:
    (chapter,) = (each for each in report.report(view, edition).sections if each.anchor == "page:timing")
    assert set(_tables(chapter)) == {
        "table:periods",
        "table:timing",
        "table:load",
        "table:traffic",
        "table:bandwidth",
    }
    shown = {block.graph for each in _sections((chapter,)) for block in each.blocks if isinstance(block, Figure)}
    assert shown == {name for name in edition.graphs if name.split("/")[0] in {"timing", "load"}}


def test_report_and_site_say_the_same(view: Index, edition: Edition) -> None:
    (chapter,) = (each for each in report.report(view, edition).sections if each.anchor == "page:timing")
    (page,) = (each for each in pages.pages(view, edition) if each.path == "timing.html")
    assert _tables(page.section) == _tables(chapter)


def test_every_activity_has_its_row(view: Index) -> None:
    assert view.timed is not None
    table = timing.elements(view, view.timed)
    assert table is not None
    assert [row[0][0].text for row in table.rows] == list(view.timed.analysis.system.activities)
    assert _cells(table, "object_recognizer")[1:4] == ["periodic", "5 Hz", "200 ms"]
    assert _cells(table, "floor_watch")[4].startswith("from object_recognizer")
    assert _cells(table, "light_engine")[5] == "unknown"


def test_every_chain_has_a_section_and_a_page(view: Index, edition: Edition) -> None:
    outline = report.report(view, edition)
    anchors = [section.anchor for section in _sections(outline.sections)]
    assert len(anchors) == len(set(anchors))
    wanted = {f"chain:{name}" for name in view.architecture.chains}
    assert wanted <= set(anchors)
    assert wanted == {page.anchor for page in pages.pages(view, edition) if page.kind == "chains"}


def test_the_functional_level_has_no_timing_pictures(view: Index) -> None:
    functional = Edition(level="functional", graphs=drawings(view, None, "functional"))
    assert [name for name in functional.graphs if name.split("/")[0] in {"timing", "load"}] == []
    assert "page:timing" not in {section.anchor for section in report.report(view, functional).sections}


def test_without_timing_the_chains_are_listed_with_their_deadlines(view: Index) -> None:
    plain = replace(view, timed=None)
    (chapter,) = (each for each in report.report(plain, Edition()).sections if each.anchor == "page:chains")
    assert [column.title for column in _tables(chapter)["table:chains"].columns][2] == "Deadline"


def test_pages_of_elements_say_the_derived_rate(view: Index) -> None:
    node = view.architecture.nodes["floor_watch"]
    facts = {name: "".join(part.text for part in value) for name, value in timing_of.node_facts(view, node)}
    assert facts["Rate"].endswith("event, from object_recognizer, semantic_mapper")
    assert facts["Response"] == "within 12 ms (own core assumed)"
    (first, *_) = timing_of.host_blocks(view, "vision_pc")
    assert isinstance(first, Figure)
    assert first.graph == "load/vision_pc"


def test_a_chain_names_what_is_missing(view: Index) -> None:
    assert view.timed is not None
    (result,) = (each for each in view.timed.chains if each.verdict == "open")
    facts = next(block for block in timing_of.chain_blocks(view, view.timed, result) if isinstance(block, Facts))
    said = {name: "".join(part.text for part in value) for name, value in facts.rows}
    assert said["Reaction time and data age, at the latest"].endswith(
        "; no bound: execution time of light_engine unknown"
    )
