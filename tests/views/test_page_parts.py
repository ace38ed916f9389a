"""Pages in parts: long tables and many pictures."""

from __future__ import annotations

import re

from archgen.emit.site import build_site
from archgen.views.pages.page_parts import MAX_FIGURES, MAX_ROWS, split_pages
from archgen.views.shapes import Block, Bullets, Column, Figure, Page, Section, Table, Text


def _split(*blocks: Block) -> tuple[Page, ...]:
    page = Page("things.html", "page:things", "Things", "spanning", Section("page:things", "Things", blocks))
    return tuple(split_pages([page]))


def _make_table(row_count: int) -> Table:
    rows = tuple(((Text(f"row {number}"),),) for number in range(1, row_count + 1))
    return Table(
        "table:things", "All things", (Column("Name", 1),), rows, tuple(f"row:{row[0][0].text}" for row in rows)
    )


def _make_figures(count: int) -> tuple[Figure, ...]:
    return tuple(Figure(f"figure:things/{n}", f"things/{n}", f"Thing {n}", "") for n in range(count))


def test_a_page_of_usual_length_stays_whole() -> None:
    (page,) = _split(*_make_figures(MAX_FIGURES), _make_table(MAX_ROWS))
    assert len(page.section.blocks) == MAX_FIGURES + 1


def test_the_rows_of_a_long_table_stand_on_several_pages_each_once() -> None:
    pages = _split(_make_table(2 * MAX_ROWS + 1))
    tables = [block for page in pages for block in page.section.blocks if isinstance(block, Table)]
    assert [page.path for page in pages] == ["things.html", "things-1501.html", "things-3001.html"]
    assert [table.caption for table in tables] == [
        "All things: 1 to 1,500",
        "All things: 1,501 to 3,000",
        "All things: 3,001 to 3,001",
    ]
    assert [row[0][0].text for table in tables for row in table.rows] == [f"row {n}" for n in range(1, 3002)]
    assert tables[1].row_anchors[0] == "row:row 1501"
    assert pages[1].crumbs == (("Things", "page:things"),)


def test_many_pictures_have_a_page_each_and_a_list_of_links() -> None:
    first_page, *further_pages = _split(*_make_figures(MAX_FIGURES + 1))
    (links,) = first_page.section.blocks
    assert isinstance(links, Bullets)
    assert [item[0].ref for item in links.items] == [f"figure:things/{n}" for n in range(MAX_FIGURES + 1)]
    assert [page.path for page in further_pages][:2] == ["things/0.html", "things/1.html"]
    figures = [block for page in further_pages for block in page.section.blocks if isinstance(block, Figure)]
    assert [figure.anchor for figure in figures] == [item[0].ref for item in links.items]


def test_further_pages_are_not_counted_as_elements() -> None:
    home = Page("index.html", "page:index", "Home", "home", Section("page:index", "Home"))
    nodes = Page("nodes/a.html", "node:a", "a", "nodes", Section("node:a", "a"), (("Things", "page:things"),))
    pages = [home, *_split(_make_table(MAX_ROWS + 1)), nodes]
    files = build_site(pages, {}, title="R", revision="", notices=(), chapter_files=lambda _path: None).files
    assert re.findall(r'Things <span class="count" aria-hidden="true">([^<]*)<', files["index.html"].decode()) == ["1"]


def test_a_page_without_content_is_not_in_the_tree() -> None:
    home = Page("index.html", "page:index", "Home", "home", Section("page:index", "Home"))
    things, views = (
        Page(f"{name}.html", f"page:{name}", name, "spanning", Section(f"page:{name}", name), is_empty=True)
        for name in ("things", "views")
    )
    thing = Page("things/a.html", "thing:a", "a", "things", Section("thing:a", "a"), (("things", "page:things"),))
    pages = [home, things, views, thing]
    files = build_site(pages, {}, title="R", revision="", notices=(), chapter_files=lambda _path: None).files
    html = files["index.html"].decode()
    assert "things.html" in html
    assert "views.html" not in html
    assert "views.html" in files
