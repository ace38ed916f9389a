"""A matrix as a page: a table without a script, and one to fold, order and walk through by keys with it; CSV and SVG."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

import pytest

from archgen.emit.file_tree import FileTree, write_tree
from archgen.emit.site import build_site
from archgen.views.matrix_shapes import Matrix, MatrixEntry, MatrixFlow
from archgen.views.shapes import Page, Section
from tests.browser_pages import watch_pages

if TYPE_CHECKING:
    from playwright.sync_api import Browser
    from playwright.sync_api import Page as BrowserPage

HOSTILE = '=1+1</script><b>"x"'


def make_matrix(members: int = 20) -> Matrix:
    """Make two groups of components: all of the first feed the first of the second, which feeds back."""
    rows = tuple(
        MatrixEntry(f"{name} {at}", f"component:{name}{at}", "Owner", group)
        for group, name in enumerate("AB")
        for at in range(members)
    )
    flows = [MatrixFlow(at, members, "Picture", "component:A0") for at in range(members)]
    flows += [MatrixFlow(members, 0, "Plan", ""), MatrixFlow(0, 1, HOSTILE, "")]
    groups = (MatrixEntry("Group A", "group:a"), MatrixEntry(HOSTILE, "group:b"))
    return Matrix("components", "Components", rows, tuple(flows), groups=groups, order="the best order")


def build(matrix: Matrix) -> FileTree:
    page = Page("index.html", "page:index", "Matrix", "spanning", Section("page:index", "Matrix"), matrix=matrix)
    other = Page("a.html", "component:A0", "A 0", "x", Section("component:A0", "A 0"), (("Matrix", "page:index"),))
    return build_site((page, other), {}, title="R", revision="", notices=(), chapter_files=lambda _: None)


def test_without_a_script_a_large_matrix_is_that_of_its_groups() -> None:
    html = build(make_matrix()).files["index.html"].decode()
    table = html.partition('<table class="matrix">')[2].partition("</table>")[0]
    assert table.count("<tr>") == 3
    assert '<td class="f8"><a href="a.html">20</a></td>' in table
    assert '<td class="f1 back"><b>1<span class=spoken> runs back</span></b></td>' in table
    assert "rows give, columns take; 21 flows between 2 groups, 1 of them runs back" in html
    assert "the best order" in html


def test_without_a_script_a_small_matrix_is_whole() -> None:
    html = build(make_matrix(3)).files["index.html"].decode()
    assert html.partition('<table class="matrix">')[2].count("<tr>") == 7


def test_a_matrix_that_is_too_large_for_a_table_says_so() -> None:
    matrix = make_matrix(40)
    flat = Matrix("components", "Components", matrix.rows, matrix.flows)
    html = build(flat).files["index.html"].decode()
    assert "80 components are too many for a table without a script" in html


def test_what_no_script_can_draw_is_a_list_of_its_filled_cells() -> None:
    rows = tuple(MatrixEntry(f"c{at}", "") for at in range(400))
    matrix = Matrix("components", "Components", rows, (MatrixFlow(399, 1, "x"), MatrixFlow(0, 399, "x")))
    files = build(matrix).files
    assert files["matrix/components.csv"].decode().splitlines() == ["row,column,flows", "c0,c399,1", "c399,c1,1"]
    assert not {"matrix/components.js", "matrix/components.svg"} & set(files)
    assert b"matrix.js" not in files["index.html"]


def test_the_csv_has_all_rows_and_no_formula() -> None:
    lines = list(csv.reader(io.StringIO(build(make_matrix(2)).files["matrix/components.csv"].decode())))
    assert lines[1] == ["", "A 0", "A 1", "B 0", "B 1"]
    assert lines[2] == ["A 0", "", "1", "1", ""]
    assert lines[4] == ["B 0", "1", "", "", ""]


def test_the_svg_draws_each_cell() -> None:
    svg = ET.fromstring(build(make_matrix(2)).files["matrix/components.svg"])  # noqa: S314 - our own
    texts = [text.text for text in svg.iter("{http://www.w3.org/2000/svg}text")]
    assert texts.count("A 0") == 2
    assert texts.count("1") == 4


def test_the_data_is_a_script_that_no_title_can_end() -> None:
    data = build(make_matrix()).files["matrix/components.js"].decode()
    assert data.startswith("const archgenMatrix = {")
    assert "</script><b>" in data  # in a file of its own it ends nothing


@pytest.fixture
def page(browser: Browser, tmp_path: Path) -> Iterator[BrowserPage]:
    """Open the matrix from the disk; an error or a message in the console is a failure."""
    write_tree(build(make_matrix(3)), tmp_path / "site")
    with watch_pages() as watch:
        opened = watch(browser.new_context(viewport={"width": 1280, "height": 800}).new_page())
        opened.goto(f"file://{tmp_path}/site/index.html")
        yield opened


ROWS = "[...document.querySelectorAll('.matrix tbody th')].map(head => head.innerText.split('\\n')[0].replace(/^[▸▾]\\s*/, ''))"


def test_groups_fold_and_the_address_says_so(page: BrowserPage) -> None:
    page.get_by_role("button", name="Groups").click()
    assert page.evaluate(ROWS) == ["Group A", HOSTILE]
    page.get_by_role("button", name="Unfold Group A").click()
    assert page.evaluate(ROWS) == ["A 0", "A 1", "A 2", HOSTILE]
    assert "open=Group+A" in page.url
    page.reload()
    assert page.evaluate(ROWS) == ["A 0", "A 1", "A 2", HOSTILE]
    page.get_by_role("button", name="Components").click()
    assert page.evaluate("document.querySelectorAll('.matrix tbody tr').length") == 6


def test_rows_are_ordered_by_name_or_by_flows_within_their_groups(page: BrowserPage) -> None:
    page.get_by_role("combobox", name="Order").select_option("flows")
    # B 0 has four flows, A 0 three.
    assert page.evaluate(ROWS)[0] == "A 0"
    page.get_by_role("combobox", name="Order").select_option("name")
    assert page.evaluate(ROWS)[:3] == ["B 0", "B 1", "B 2"]  # `=1+1...` comes before `Group A`
    assert "order=name" in page.url


def test_arrows_go_from_filled_cell_to_filled_cell_and_focus_shows_what_hover_shows(page: BrowserPage) -> None:
    page.locator("td > a").first.focus()
    assert page.evaluate("document.activeElement.ariaLabel") == "A 0 to A 1: 1 flow"
    page.keyboard.press("ArrowRight")
    assert page.evaluate("document.activeElement.ariaLabel") == "A 0 to B 0: 1 flow"
    card = page.locator(".matrix-card")
    assert card.is_visible()
    assert "Loop: A 0 → B 0 → back" in card.inner_text()
    page.keyboard.press("Escape")
    assert not card.is_visible()
    page.keyboard.press("ArrowDown")
    assert page.evaluate("document.activeElement.ariaLabel") == "A 1 to B 0: 1 flow"


def test_a_hundred_groups_are_few_elements_with_all_their_cells(browser: Browser, tmp_path: Path) -> None:
    rows = tuple(MatrixEntry(f"r{at}", f"component:r{at}", "", at // 2) for at in range(200))
    groups = tuple(MatrixEntry(f"G{at}", f"group:{at}") for at in range(100))
    flows = [MatrixFlow(2 * at, 2 * ((at + step) % 100), "x", "") for at in range(100) for step in (1, 3, 10)]
    write_tree(build(Matrix("components", "Components", rows, tuple(flows), groups=groups)), tmp_path / "site")
    with watch_pages(("file://",)) as watch:
        page = watch(browser.new_context(viewport={"width": 1280, "height": 800}).new_page())
        page.goto(f"file://{tmp_path}/site/index.html")
        assert page.locator("tbody tr").count() == 100
        assert page.evaluate("document.querySelectorAll('*').length") < 3000
        # Each filled cell stands below the head of its column, and the cross of what is looked at goes through gaps.
        places = """() => [...document.querySelectorAll("td > a")].every((link) => {
          const head = document.querySelectorAll("thead th")[link.dataset.column].getBoundingClientRect();
          const cell = link.parentElement.getBoundingClientRect();
          return Math.abs(head.left - cell.left) < 1 && Math.abs(head.width - cell.width) < 1; })"""
        assert page.evaluate(places)
        page.locator('a[data-row="2"][data-column="3"]').focus()
        assert page.locator("td.crossed").count() > 80
        assert page.evaluate(
            "[...document.querySelectorAll('.crossed')].every((gap) => gap.colSpan > gap.style.getPropertyValue('--from'))"
        )
        page.keyboard.press("ArrowRight")
        assert page.evaluate("document.activeElement.dataset.column") == "5"


def test_a_wide_matrix_fits_on_paper_that_lies_on_its_side(browser: Browser, tmp_path: Path) -> None:
    rows = tuple(MatrixEntry(f"Component {at}", f"component:r{at}") for at in range(60))
    flows = tuple(MatrixFlow(at, at + 1, "x", "") for at in range(59))
    write_tree(build(Matrix("components", "Components", rows, flows)), tmp_path / "site")
    with watch_pages() as watch:
        # A4 without margins of 1 cm.
        page = watch(browser.new_context(viewport={"width": 1047, "height": 700}).new_page())
        page.emulate_media(media="print")
        page.goto(f"file://{tmp_path}/site/index.html")
        assert page.locator(".matrix.dense").bounding_box()["width"] > 700  # type: ignore[index]
        assert page.evaluate("document.documentElement.scrollWidth") == 1047
        assert page.evaluate("getComputedStyle(document.body).page") == "wide"


def test_hover_shows_both_partners_and_what_flows_as_text(page: BrowserPage) -> None:
    page.locator("td > a").first.hover()
    card = page.locator(".matrix-card")
    card.wait_for()
    assert card.locator(".pair").inner_text() == "A 0 → A 1"
    assert HOSTILE in card.inner_text()


def test_what_runs_back_is_listed(page: BrowserPage) -> None:
    page.get_by_role("button", name="B 0 → A 0").click()
    assert page.evaluate("document.activeElement.ariaLabel") == "B 0 to A 0: 1 flow, runs back"
