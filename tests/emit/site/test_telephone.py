"""Pages on a telephone: tables become rows with the names of their figures, and no kind of page scrolls sideways."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.emit.site.test_page_policy import choose_pages

if TYPE_CHECKING:
    from playwright.sync_api import Browser
    from playwright.sync_api import Page as BrowserPage

# What scrolls by itself is left out: sequences, tables, listings, the matrix, and the explorer's bar of tools and its map.
WIDE = """[...document.querySelectorAll("main *")].filter(e => !e.closest(".scroll, pre, .spoken, .matrix-box, .explorer-tools, .map, .sequence .canvas, thead") &&
    e.getBoundingClientRect().right > innerWidth + 1).map(e => e.outerHTML.slice(0, 90))"""


@pytest.fixture
def page(browser: Browser) -> Iterator[BrowserPage]:
    """Open a page as wide as a telephone."""
    opened = browser.new_context(viewport={"width": 390, "height": 844}).new_page()
    opened.set_default_timeout(120_000)
    yield opened
    opened.context.close()


def test_no_kind_of_page_scrolls_sideways(page: BrowserPage, example: Path) -> None:
    wide = {}
    for path in choose_pages(example):
        page.goto(f"file://{example}/{path}")
        if page.evaluate("document.documentElement.scrollWidth") > 390 or page.evaluate(WIDE):
            wide[path] = page.evaluate(WIDE)
    assert wide == {}


def test_rows_of_a_table_stand_below_one_another_with_the_names_of_their_figures(
    page: BrowserPage, example: Path
) -> None:
    page.goto(f"file://{example}/partners/certh/forth.html")
    table = page.get_by_role("table", name="CERTH-ITI gives FORTH-ICS")
    title, figure, size = (table.get_by_role("row").nth(1).get_by_role("cell").nth(at) for at in (0, 2, 5))
    boxes = [cell.bounding_box() for cell in (title, figure, size)]
    assert all(boxes)
    tops = [box["y"] for box in boxes if box]
    assert tops[0] == pytest.approx(tops[1], abs=2)
    assert tops[2] > tops[0]
    assert (
        page.evaluate("getComputedStyle(document.querySelector('.as-rows td[data-label]'), '::before').content")
        == '"Message, topic "'
    )


def test_rows_can_still_be_sorted_and_filtered(page: BrowserPage, example: Path) -> None:
    page.goto(f"file://{example}/messages.html")
    page.get_by_role("searchbox").fill("fallen")
    shown = "[...document.querySelectorAll('tbody tr')].filter(row => row.checkVisibility()).length"
    assert page.evaluate(shown) == 1
    page.get_by_role("searchbox").fill("")
    page.get_by_role("button", name="Fields").click()
    assert page.evaluate("document.querySelector('th[aria-sort]').ariaSort") == "ascending"


def test_a_wider_window_has_tables_again(page: BrowserPage, example: Path) -> None:
    page.goto(f"file://{example}/messages.html")
    assert page.evaluate("getComputedStyle(document.querySelector('tbody tr')).display") == "flex"
    page.set_viewport_size({"width": 1200, "height": 800})
    assert page.evaluate("getComputedStyle(document.querySelector('tbody tr')).display") == "table-row"


@pytest.mark.parametrize(("width", "has_lanes"), [(1440, True), (1024, False), (390, False)])
def test_lanes_are_shown_whole_or_as_a_list(browser: Browser, example: Path, width: int, *, has_lanes: bool) -> None:
    opened = browser.new_context(viewport={"width": width, "height": 900}).new_page()
    opened.goto(f"file://{example}/use_cases/uc-4.html")
    lanes, steps = opened.locator(".sequence .canvas").all()
    assert (lanes.is_visible(), steps.is_visible()) == (has_lanes, not has_lanes)
    shown = lanes if has_lanes else steps
    # On a telephone the list keeps a size that can be read.
    assert shown.evaluate("box => box.scrollWidth <= box.clientWidth") == (width > 600)
    assert shown.get_attribute("tabindex") == "0"
    opened.context.close()


def test_a_word_of_any_length_widens_no_card(browser: Browser, example: Path) -> None:
    opened = browser.new_context(viewport={"width": 1440, "height": 900}).new_page()
    for path in ("index.html", "late/forth.html", "todo/tum.html"):
        opened.goto(f"file://{example}/{path}")
        opened.evaluate(
            "document.querySelectorAll('.card tbody td:first-child').forEach(cell => cell.append('W'.repeat(90)))"
        )
        boxes = "[...document.querySelectorAll('.card .scroll')]"
        assert opened.evaluate(f"{boxes}.filter(box => box.scrollWidth > box.clientWidth + 1).length") == 0
        tallest = "Math.max(...[...document.querySelectorAll('.card tbody tr')].map(row => row.offsetHeight))"
        assert opened.evaluate(tallest) < 500
    opened.context.close()
