"""Report, pages, record and cards of the case study: what they must never get wrong, whatever the project."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import jsonschema_rs
import pytest

from archgen import pipeline, resources
from archgen.emit import site
from archgen.model.document_chapters import GENERATED_CHAPTERS
from archgen.pipeline import CheckedProject
from archgen.products.output_options import OutputOptions
from archgen.products.project_views import make_scoped_lookup, select_elements
from archgen.views import inline_text
from archgen.views.elements import element_card, element_names
from archgen.views.graphs import make_all_graphs
from archgen.views.lookup import Lookup
from archgen.views.pages import report_outline, site_pages
from archgen.views.pages.report_outline import DocumentEdition
from archgen.views.records import resolved_record
from archgen.views.shapes import Block, Bullets, Facts, Figure, Inlines, Paragraph, Section, Table, Text
from archgen.views.tables import element_rows, statistics_tables
from tests.judged_projects import judge_ramcip

WITHOUT_PAGE = {"frame", "link", "chain", "view", "policy"}
"""Sorts of element that stand in a table or a chapter of their own and have no page."""


@pytest.fixture(scope="module")
def checked() -> CheckedProject:
    return judge_ramcip()


@pytest.fixture(scope="module")
def whole(checked: CheckedProject) -> Lookup:
    return make_scoped_lookup(checked, OutputOptions())


def _edition(checked: CheckedProject, index: Lookup) -> DocumentEdition:
    graphs = {graph.id: graph for graph in make_all_graphs(index.architecture)}
    return DocumentEdition(
        revision="r",
        chapter_names=checked.chapters.order,
        project_chapters=checked.chapters.texts,
        drawings=graphs,
        statistics=statistics_tables.make_statistics_tables(index.architecture),
        rule_pages={finding.rule: "Why." for finding in checked.findings},
    )


def _sections(sections: tuple[Section, ...]) -> Iterator[Section]:
    for section in sections:
        yield section
        yield from _sections(section.sections)


def _runs(block: Block) -> Iterator[Inlines]:
    if isinstance(block, Paragraph):
        yield block.inlines
    elif isinstance(block, Bullets):
        yield from block.items
    elif isinstance(block, Facts):
        yield from (value for _, value in block.rows)
    elif isinstance(block, Table):
        yield from (cell for row in block.rows for cell in row)


def _texts(sections: tuple[Section, ...]) -> Iterator[Text]:
    for section in _sections(sections):
        for block in section.blocks:
            for run in _runs(block):
                yield from run


def _anchors(sections: tuple[Section, ...]) -> list[str]:
    found = []
    for section in _sections(sections):
        found.append(section.anchor)
        found += [block.anchor for block in section.blocks if isinstance(block, (Table, Figure))]
    return found


def test_the_report_names_every_place_once(checked: CheckedProject, whole: Lookup) -> None:
    outline = report_outline.make_report(whole, _edition(checked, whole))
    twice = [anchor for anchor, count in Counter(_anchors(outline.sections)).items() if count > 1]
    assert twice == []


def test_the_report_keeps_the_order_of_chapters(checked: CheckedProject, whole: Lookup) -> None:
    outline = report_outline.make_report(whole, _edition(checked, whole))
    titles = [section.title for section in outline.sections]
    assert titles[:5] == ["Introduction", "Scenarios", "Between partners", "Use cases", "Overview"]
    assert titles[-5:] == ["Type mapping", "Connections", "Requirements trace", "Open points", "Statistics"]
    assert [section.appendix for section in outline.sections] == [False] * (len(titles) - 5) + [True] * 5


def test_every_table_is_whole(checked: CheckedProject, whole: Lookup) -> None:
    edition = _edition(checked, whole)
    sections = report_outline.make_report(whole, edition).sections + tuple(
        page.section for page in site_pages.make_pages(whole, edition)
    )
    tables = [block for section in _sections(sections) for block in section.blocks if isinstance(block, Table)]
    assert len(tables) > 300
    for table in tables:
        assert table.rows, table.anchor
        assert {len(row) for row in table.rows} == {len(table.columns)}, table.anchor


def test_every_mention_leads_to_a_page(checked: CheckedProject, whole: Lookup) -> None:
    made = site_pages.make_pages(whole, _edition(checked, whole))
    known = {page.anchor for page in made}
    assert len(known) == len(made) == len({page.path for page in made})
    refs = {text.ref for text in _texts(tuple(page.section for page in made)) if text.ref}
    assert {ref for ref in refs - known if ref.split(":")[0] not in WITHOUT_PAGE} == set()


def test_every_element_has_a_page(checked: CheckedProject, whole: Lookup) -> None:
    known = {page.anchor for page in site_pages.make_pages(whole, _edition(checked, whole))}
    found = whole.architecture
    wanted = {f"group:{name}" for name in found.groups} | {f"component:{name}" for name in found.components}
    wanted |= {f"node:{name}" for name in found.nodes} | {f"topic:{topic.name}" for topic in found.topics.values()}
    wanted |= {f"type:{name}" for name in found.types} | {f"requirement:{name}" for name in found.requirements}
    wanted |= {f"host:{name}" for name in found.hosts} | {f"partner:{name}" for name in found.partners}
    assert wanted - known == set()


def test_a_part_holds_nothing_of_others(checked: CheckedProject) -> None:
    selection, problems = select_elements(checked, "owner:certh")
    assert problems == ()
    part = make_scoped_lookup(checked, OutputOptions(selection, "owner:certh"))
    outline = report_outline.make_report(part, _edition(checked, part))
    shown = {
        anchor.removeprefix("component:") for anchor in _anchors(outline.sections) if anchor.startswith("component:")
    }
    owners = {checked.architecture.components[name].owner for name in shown}
    assert owners == {"certh"}
    assert shown == selection.components
    assert "owner:certh" in [text.text for notice in outline.notices for text in notice.inlines]


def test_the_functional_level_speaks_of_no_node(checked: CheckedProject, whole: Lookup) -> None:
    edition = DocumentEdition(level="functional", chapter_names=checked.chapters.order)
    anchors = _anchors(report_outline.make_report(whole, edition).sections)
    assert [anchor for anchor in anchors if anchor.split(":")[0] in {"node", "implementation"}] == []
    assert {page.kind for page in site_pages.make_pages(whole, edition)}.isdisjoint(
        {"nodes", "topics", "services", "actions"}
    )


def test_the_record_follows_its_schema(whole: Lookup) -> None:
    schema = json.loads(resources.resource_path("schemas", "resolved.schema.json").read_text(encoding="utf-8"))
    data = json.loads(json.dumps(resolved_record.make_record(whole)))
    assert [error.message for error in jsonschema_rs.Draft202012Validator(schema).iter_errors(data)] == []
    assert len(data["components"]) == 61
    assert data["edges"][0].keys() >= {"from", "to", "type", "message"}


@pytest.mark.parametrize("sort", ["components", "nodes", "groups", "connections", "edges", "topics", "types", "hosts"])
def test_lists_are_whole(whole: Lookup, sort: str) -> None:
    columns, rows = element_rows.list_element_rows(whole, sort)
    assert rows
    assert {len(row) for row in rows} == {len(columns)}


def test_all_connections_are_listed(whole: Lookup) -> None:
    _, rows = element_rows.list_element_rows(whole, "connections")
    assert len(rows) == 138


def test_every_element_has_a_card(whole: Lookup) -> None:
    for name, sorts in element_names.kinds_by_id(whole).items():
        for sort in sorts:
            made = element_card.make_card(whole, sort, name)
            assert made.id == name
            assert all(value for _, value in made.facts)


def test_a_card_is_found_by_the_end_of_an_id_or_by_a_title(whole: Lookup) -> None:
    wanted = [("component", "environment_state.object_recognition")]
    assert element_names.find_elements(whole, "object_recognition") == wanted
    assert element_names.find_elements(whole, "environment_state.object_recognition") == wanted
    assert element_names.find_elements(whole, "object Recognition") == wanted
    assert element_names.find_elements(whole, "nothing of this name") == []


def test_empty_projects_have_all_documents(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text("archgen: 1\n", encoding="utf-8")
    empty = pipeline.check_project(tmp_path)
    index = make_scoped_lookup(empty, OutputOptions())
    edition = _edition(empty, index)
    assert report_outline.make_report(index, edition).title
    assert next(page.path for page in site_pages.make_pages(index, edition)) == "index.html"
    assert resolved_record.make_record(index)["components"] == {}


def test_what_a_finding_names_is_code() -> None:
    said = inline_text.message_to_inlines("nobody reads `x` of `g.c`, or `it")
    assert [(run.text, run.code) for run in said] == [
        ("nobody reads ", False),
        ("x", True),
        (" of ", False),
        ("g.c", True),
        (", or `it", False),
    ]
    assert inline_text.message_to_inlines("take `x` out", muted=True)[1] == Text("x", code=True, muted=True)


def test_every_generated_chapter_has_what_makes_it() -> None:
    assert tuple(report_outline._GENERATED_SECTIONS) == GENERATED_CHAPTERS  # noqa: SLF001 - the registry itself


def test_no_two_pages_have_one_address(tmp_path: Path) -> None:
    outputs = ", ".join(f'o{number}: {{type: "{name}"}}' for number, name in enumerate(("A b", "A/b", "a-b-2", "A:b")))
    (tmp_path / "archgen.yaml").write_text(f"groups: {{g: {{components: {{c: {{outputs: {{{outputs}}}}}}}}}}}\n")
    project = pipeline.check_project(tmp_path)
    lookup = make_scoped_lookup(project, OutputOptions())
    page_list = site_pages.make_pages(lookup, _edition(project, lookup))
    # The page whose own name ends in a number keeps its address.
    assert {page.title: page.path for page in page_list if page.path.startswith("types/")} == {
        "A b": "types/a-b.html",
        "A/b": "types/a-b-3.html",
        "a-b-2": "types/a-b-2.html",
        "A:b": "types/a-b-4.html",
    }
    files = site.build_site(page_list, {}, title="", revision="", notices=(), chapter_files=lambda _path: None)
    assert {page.path for page in page_list} <= set(files.files)
