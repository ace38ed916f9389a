"""The preview in a real browser: a saved file's change is on the page, and the reader stays where he is."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from archgen.serve.live_site import LiveSite
from archgen.serve.site_server import SiteServer
from tests.browser_pages import OpenPage, expect, judge_with_axe, watch_pages
from tests.browser_polling import wait_until
from tests.property_sizes import try_some
from tests.serve.conftest import ROBOT

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

LONG_TEXT = "# Words\n\n" + "".join(f"## Part {number}\n\n{'Some words. ' * 80}\n\n" for number in range(30))


@pytest.fixture
def visit(browser: Browser, server: SiteServer) -> Iterator[OpenPage]:
    """Open a page of the preview; a request to another server, an error in the console or a reload is a failure."""
    with watch_pages((server.url, "data:")) as watch:

        def open_page(path: str, width: int = 1280, scheme: str = "light") -> Page:
            context = browser.new_context(viewport={"width": width, "height": 700}, color_scheme=scheme)  # type: ignore[arg-type]
            page = watch(context.new_page())
            page.goto(server.url + path)
            page.evaluate("window.stayed = true")
            return page

        yield open_page
        pages = [page for context in browser.contexts for page in context.pages]
        stayed = [page.evaluate("window.stayed === true") for page in pages]
    assert all(stayed)


@pytest.fixture
def save(live_site: LiveSite, robot: Path) -> Callable[[str], None]:
    """Save the robot with another text, and notice it."""

    def saved(text: str, file: str = "archgen.yaml") -> None:
        (robot / file).write_text(text)
        live_site.refresh()

    return saved


Save = Callable[..., None]


def test_a_change_is_on_the_page_without_a_reload(visit: OpenPage, save: Save) -> None:
    page = visit("components/g.eye.html")
    tree = page.locator("#navigation")
    save(ROBOT.replace("Looks.", "Sees.").replace("title: Robot", "title: Other robot"))
    expect(page.locator("main")).to_contain_text("Sees.")
    expect(page.locator(".bar .project")).to_have_text("Other robot")
    expect(page).to_have_title("Eye · Other robot")
    save(ROBOT.replace("components:", "title: Senses\n    components:", 1))
    expect(tree).to_contain_text("Senses")
    assert tree.locator("[aria-current]").count() == 1


def test_errors_stand_on_the_page_until_they_are_mended(visit: OpenPage, save: Save) -> None:
    page = visit("components/g.eye.html")
    save(ROBOT.replace("Looks.", "Sees.").replace("inputs: {i: eye.o}", "imputs: {i: <img src=x onerror=alert(1)>}"))
    mistake = page.locator(".live .mistake")
    expect(mistake.locator(".place")).to_contain_text("archgen.yaml:10:")
    expect(mistake).to_contain_text("did you mean inputs?")
    expect(mistake.locator("pre code")).to_contain_text("<img src=x onerror=alert(1)>")
    expect(mistake.locator("mark")).to_have_text("imputs")
    expect(page.locator(".live .state")).to_contain_text("The page shows the last sound state, of ")
    expect(page.locator("main")).to_contain_text("Looks.")
    save(ROBOT.replace("Looks.", "Sees."))
    expect(page.locator("main")).to_contain_text("Sees.")
    expect(mistake).to_have_count(0)


def test_an_error_is_there_when_a_page_is_opened(visit: OpenPage, save: Save) -> None:
    save(ROBOT.replace("inputs:", "imputs:"))
    expect(visit("index.html").locator(".live .mistake")).to_have_count(1)


def test_the_reader_stays_where_he_is(visit: OpenPage, save: Save) -> None:
    save(LONG_TEXT, "docs/text.md")
    page = visit("chapters/docs-text.html")
    expect(page.locator("main")).to_contain_text("Part 29")
    page.evaluate("window.scrollTo(0, 2000)")
    wait_until(page, "window.scrollY === 2000")
    save(LONG_TEXT.replace("Part 29", "Part the last"), "docs/text.md")
    expect(page.locator("main")).to_contain_text("Part the last")
    assert page.evaluate("window.scrollY") == 2000


def test_a_filter_its_words_and_the_focus_stay(visit: OpenPage, save: Save) -> None:
    many = "".join(f"      c{number}: {{functionality: Does {number}.}}\n" for number in range(12))
    robot = ROBOT.replace("      eye:", f"{many}      eye:")
    save(robot)
    page = visit("components.html")
    field = page.locator("input[type=search]").first
    field.fill("Does 1")
    page.keyboard.press("ArrowLeft")
    assert page.locator("tbody tr:visible").count() == 3
    save(robot.replace("Does 2.", "Does 1 and 2."))
    expect(page.locator("main")).to_contain_text("Does 1 and 2.")
    expect(page.locator("tbody tr:visible")).to_have_count(4)
    field = page.locator("input[type=search]").first
    expect(field).to_have_value("Does 1")
    expect(field).to_be_focused()
    assert field.evaluate("field => field.selectionStart") == 5
    assert page.locator("input[type=search]").count() == 1


def test_a_picture_that_somebody_looks_at_is_exchanged_in_its_place(visit: OpenPage, save: Save) -> None:
    page = visit("components/g.eye.html")
    page.locator("button.closer").first.click()
    for _ in range(3):
        page.keyboard.press("+")
    page.keyboard.press("ArrowLeft")
    before = page.locator("dialog.look svg").get_attribute("style")
    save(ROBOT.replace("brake: {owner", "brake: {title: Stopper, owner"))
    expect(page.locator("dialog.look svg")).to_contain_text("Stopper")
    after = page.locator("dialog.look svg").get_attribute("style")
    assert before is not None
    assert after is not None
    assert before.partition("transform:")[2] == after.partition("transform:")[2]
    page.keyboard.press("Escape")
    expect(page.locator("dialog")).to_have_count(0)


def test_the_search_finds_what_is_new(visit: OpenPage, save: Save) -> None:
    page = visit("components/g.eye.html")
    page.keyboard.press("/")
    page.locator("#find-field").fill("brake")
    expect(page.locator("#find-list")).to_contain_text("Brake")
    page.keyboard.press("Escape")
    save(ROBOT.replace("Looks.", "Sees.").replace("      brake:", "      zebra: {}\n      brake:"))
    expect(page.locator("main")).to_contain_text("Sees.")
    page.keyboard.press("/")
    page.locator("#find-field").fill("zebra")
    expect(page.locator("#find-list")).to_contain_text("Zebra")
    page.locator("#find-field").fill("brake")
    expect(page.locator("#find-list [role=option]").first).to_contain_text("Brake")


def test_a_page_that_is_gone_says_so_and_comes_back(browser: Browser, server: SiteServer, save: Save) -> None:
    # Without the judge of the console: Chromium itself reports the missing page there.
    page = browser.new_context().new_page()
    page.goto(f"{server.url}components/g.brake.html")
    save(re_without_brake())
    expect(page.locator(".live .lost")).to_contain_text("no longer part of the project")
    expect(page.locator(".live a")).to_have_attribute("href", f"{server.url}index.html")
    save(ROBOT)
    expect(page.locator(".live .lost")).to_have_count(0)
    page.context.close()


def re_without_brake() -> str:
    """Return the robot without its brake."""
    return ROBOT.partition("      brake:")[0] + "nodes: {eye: {implements: eye, host: pc}}\n"


def test_a_figure_is_tried_out_and_nothing_is_written(visit: OpenPage, robot: Path) -> None:
    page = visit("chains/stop.html")
    card = page.locator(".what-if")
    card.get_by_label("Execution time of eye").fill("150 ms")
    card.get_by_label("Period of eye").fill("1 s")
    row = card.locator(".answer tbody tr").first
    expect(row).to_contain_text("Stops in time")
    expect(row.locator(".chip").nth(0)).to_have_text("met · 90 ms left")
    expect(row.locator(".chip").nth(1)).to_contain_text("missed")
    expect(card.locator(".command")).to_contain_text("--set 'eye.timing.wcet=150 ms'")
    card.get_by_label("Execution time of eye").fill("soon")
    expect(card.locator(".wrong")).to_contain_text("`wcet` takes a duration")
    card.get_by_role("button", name="As written").click()
    expect(card.get_by_label("Execution time of eye")).to_have_value("5 ms")
    expect(card.locator(".answer")).to_be_empty()
    card.get_by_label("Host of eye").select_option("box")
    expect(row).to_be_visible()
    assert (robot / "archgen.yaml").read_text() == ROBOT


def test_what_is_tried_out_stays_when_a_file_changes(visit: OpenPage, save: Save) -> None:
    page = visit("chains/stop.html")
    page.get_by_label("Execution time of eye").fill("50 ms")
    page.get_by_label("Execution time of eye").blur()
    expect(page.locator(".what-if .answer tbody tr").first).to_be_visible()
    save(ROBOT.replace("title: Stops in time", "title: Halts in time"))
    expect(page.locator(".what-if .answer")).to_contain_text("Halts in time")
    expect(page.get_by_label("Execution time of eye")).to_have_value("50 ms")


@pytest.mark.parametrize("scheme", try_some(["light", "dark"]))
@pytest.mark.parametrize("width", try_some([360, 1280]))
def test_axe_finds_nothing(visit: OpenPage, save: Save, width: int, scheme: str) -> None:
    page = visit("chains/stop.html", width=width, scheme=scheme)
    page.get_by_label("Execution time of eye").fill("150 ms")
    expect(page.locator(".what-if .answer tbody tr").first).to_be_visible()
    save(ROBOT.replace("inputs:", "imputs:"))
    expect(page.locator(".live .mistake")).to_have_count(1)
    assert judge_with_axe(page) == []
    assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")
