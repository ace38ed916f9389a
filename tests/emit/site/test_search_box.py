"""The search box in Chromium, opened from the disk: what it finds, how keys lead through it, and that it runs nothing."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from archgen.emit.file_tree import FileTree, write_tree
from archgen.emit.site import build_site
from archgen.views import shapes
from archgen.views.search.search_entry import SearchEntry
from tests.browser_pages import OpenPage, expect, judge_with_axe, watch_pages
from tests.emit.site.conftest import write_bare_site
from tests.running import RAMCIP

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

HOSTILE = '</script><img src=x onerror=document.title="taken"><script>document.title="taken"</script>'


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write the case study's site, without pictures."""
    return write_bare_site(RAMCIP, tmp_path_factory.mktemp("out") / "example")


def site_of(*entries: SearchEntry, title: str = "Robot") -> FileTree:
    section = shapes.Section("page:index", title, ())
    start = shapes.Page("index.html", "page:index", title, "overview", section)
    return build_site(
        (start,), {}, title=title, revision="", notices=(), chapter_files=lambda _: None, search_entries=entries
    )


@pytest.fixture
def visit(browser: Browser, example: Path) -> Iterator[OpenPage]:
    """Open a page from the disk; a request to anywhere else, an error or a message in the console is a failure."""
    with watch_pages() as watch:

        def open_page(  # noqa: PLR0913 - what a reader's browser may be
            path: str = "index.html",
            *,
            root: Path | None = None,
            width: int = 1280,
            scheme: str = "light",
            script: str = "",
            quiet: bool = True,
        ) -> Page:
            context = browser.new_context(viewport={"width": width, "height": 800}, color_scheme=scheme)  # type: ignore[arg-type]
            page = watch(context.new_page(), console=quiet)
            if script:
                page.add_init_script(script)
            page.goto(f"file://{root or example}/{path}")
            return page

        yield open_page


@pytest.fixture(scope="module")
def shared_page(browser: Browser, example: Path) -> Iterator[Page]:
    """Give one page for all that is only searched for: opening it and reading the index takes the time of such a test."""
    with watch_pages() as watch:
        page = watch(browser.new_context(viewport={"width": 1280, "height": 800}).new_page(), console=True)
        page.goto(f"file://{example}/index.html")
        yield page


def search(page: Page, words: str) -> None:
    """Search for some words, and wait until the index is read and the answer is whole."""
    page.keyboard.press("/")
    page.keyboard.type(words)
    expect(page.get_by_role("combobox")).to_have_value(words)
    expect(page.locator("#find-list")).to_have_attribute("aria-busy", "false")


def titles(page: Page) -> list[str]:
    return page.locator(".find-box .title").all_inner_texts()


def said(page: Page) -> str:
    return page.locator(".find-box .note").inner_text()


def test_nothing_of_the_index_is_loaded_before_the_first_key(visit: OpenPage) -> None:
    page = visit()
    loaded = "performance.getEntriesByType('resource').map(e => e.name).filter(n => n.includes('/search/'))"
    assert page.evaluate(loaded) == []
    assert page.evaluate("document.querySelectorAll('head script').length") == 3
    search(page, "navigator")
    # The first results are there before all parts of the index are.
    page.wait_for_function("document.querySelectorAll('head script').length > 20", timeout=120_000)


@pytest.mark.parametrize(
    ("words", "first"),
    [
        ("who reads the skeletons", "Skeletons"),
        ("navigator", "Navigator"),
        ("NAVIGATOR", "Navigator"),
        ("navig", "Navigator"),
        ("skeleton track", "Skeleton Tracking"),
        ("tracking skeleton", "Skeleton Tracking"),
        ("R-80", "R-80 The resident pauses all recording with one touch"),
        ("munchen", "TU München"),
        ("skeletontracker", "/humans/skeleton_tracker"),
        ("ramcip_msgs/msg/Skeleton", "ramcip_msgs/msg/Skeleton"),
        ("handover planner skeletons", "Handover Planner · skeletons"),
    ],
)
def test_what_fits_best_stands_first(shared_page: Page, words: str, first: str) -> None:
    shared_page.keyboard.press("Escape")
    search(shared_page, words)
    assert titles(shared_page)[0] == first
    assert shared_page.locator(".find-box .note").is_hidden() or "Also" in said(shared_page)


@pytest.mark.parametrize(
    ("words", "nearest"),
    [
        ("skeletom", "skeleton"),  # wrong
        ("kkeleton", "skeleton"),
        ("skelton", "skeleton"),  # missing
        ("keleton", None),  # part of a word as it is written
        ("skeeleton", "skeleton"),  # additional
        ("xskeleton", "skeleton"),
        ("skeletno", "skeleton"),  # exchanged
        ("kseleton", "skeleton"),
        ("seklet", "skeleton"),  # while typing
        ("sekleton trakcing", "skeleton, tracking"),  # one in each word
        ("Skelton", "skeleton"),
    ],
)
def test_one_wrong_letter_in_a_word_is_found_and_said(shared_page: Page, words: str, nearest: str | None) -> None:
    shared_page.keyboard.press("Escape")
    search(shared_page, words)
    assert "Skeleton Tracking" in titles(shared_page)
    if nearest:
        assert said(shared_page).startswith(f"Nothing is spelt “{words}”. Nearest: {nearest}")
    else:
        assert shared_page.locator(".find-box .note").is_hidden()


def test_a_wrong_letter_that_makes_another_word_is_found_behind_it(visit: OpenPage, tmp_path: Path) -> None:
    entries = [SearchEntry("node", title, "", ("page:index",)) for title in ("form_filler", "from_camera")]
    write_tree(site_of(*entries), tmp_path / "site")
    page = visit(root=tmp_path / "site")
    search(page, "form")
    assert titles(page) == ["form_filler", "from_camera"]
    assert said(page) == "Also what is spelt nearly so: from"


def test_every_kind_of_thing_is_found(visit: OpenPage) -> None:
    page = visit()
    for words, kind in (
        ("human state", "group"),
        ("/humans/skeletons", "topic"),
        ("nobody reads call_state", "finding"),
        ("SkeletonArray", "message"),
        ("skeleton joints", "field"),
        ("skeletons fall detector", "connection"),
        ("base computer", "host"),
        ("risks", "chapter"),
        ("object pose", "type"),
        ("UC-3", "use case"),
    ):
        search(page, words)
        assert kind in page.locator(".find-box a .kind").all_inner_texts(), words
        page.keyboard.press("Escape")


def test_keys_lead_to_a_page_and_escape_gives_the_focus_back(visit: OpenPage) -> None:
    page = visit("components/human_state.skeleton_tracking.html")
    page.get_by_role("link", name="Overview").first.focus()
    search(page, "skeleton")
    field = page.get_by_role("combobox")
    expect(field).to_have_attribute("aria-activedescendant", "find-0")
    page.keyboard.press("ArrowDown")
    expect(field).to_have_attribute("aria-activedescendant", "find-1")
    page.keyboard.press("ArrowUp")
    page.keyboard.press("ArrowUp")
    expect(field).to_have_attribute("aria-activedescendant", f"find-{len(titles(page)) - 1}")
    assert page.locator("[aria-selected=true]").count() == 1
    page.keyboard.press("Escape")
    assert page.evaluate("document.activeElement.textContent") == "Overview"
    page.keyboard.press("Control+k")
    page.keyboard.type("navigator")
    expect(page.locator(".find-box [aria-selected=true] .title")).to_have_text("Navigator")
    page.keyboard.press("Enter")
    page.wait_for_url("**/components/robot_action_planner.navigator.html")


def test_tab_goes_through_the_kinds(visit: OpenPage) -> None:
    page = visit()
    search(page, "skeleton")
    pressed = page.locator(".find-box .chips [aria-pressed=true]")
    counts = page.locator(".find-box .chips button").all_inner_texts()
    assert counts[0].startswith("All ")
    page.keyboard.press("Tab")
    expect(pressed).to_have_text(counts[1])
    assert set(page.locator(".find-box a .kind").all_inner_texts()) == {"component"}
    page.keyboard.press("Shift+Tab")
    page.keyboard.press("Shift+Tab")
    expect(pressed).to_have_text(counts[-1])
    assert len(titles(page)) == int(counts[-1].split()[-1])
    assert page.evaluate("document.activeElement.id") == "find-field"


def test_a_slash_in_a_field_is_a_slash(visit: OpenPage) -> None:
    page = visit("connections.html")
    page.get_by_role("searchbox").first.focus()
    page.keyboard.press("/")
    assert not page.get_by_role("combobox").is_visible()
    assert page.get_by_role("searchbox").first.input_value() == "/"
    page.keyboard.press("Control+k")
    assert page.get_by_role("combobox").is_visible()


def test_an_empty_box_teaches(visit: OpenPage) -> None:
    page = visit("components/robot_action_planner.navigator.html")
    page.goto(page.url.replace("components/robot_action_planner.navigator", "index"))
    page.get_by_role("button", name="Search everything").click()
    headings = page.locator(".find-box .heading")
    expect(headings).to_have_text(["Last opened", "Open points", "Also understood"])
    assert titles(page)[0] == "Navigator"
    assert "R-80" in titles(page)[1]
    page.get_by_role("button", name="Clear last opened").click()
    expect(headings).to_have_text(["Open points", "Also understood"])
    page.locator(".find-box button[role=option]").first.click()
    expect(page.get_by_role("combobox")).to_have_value("owner:certh")
    expect(page.locator(".find-box .title").first).to_be_visible()
    assert all("CERTH-ITI" in text for text in page.locator(".find-box a").all_inner_texts())


REFUSED = "Object.defineProperty(window, 'localStorage', {get() { throw new DOMException('no', 'SecurityError'); }});"
POISONED = (
    "const keep = Storage.prototype.getItem; Storage.prototype.getItem = function (key) {"
    ' return key.startsWith("archgen-opened") ? JSON.stringify([["a", "b", "c", "javascript:alert(1)"],'
    ' ["a", "b", "c", "https://example.org/"], ["a"], 7, null]) : keep.call(this, key); };'
)


@pytest.mark.parametrize("script", [REFUSED, POISONED])
def test_it_works_where_nothing_can_be_remembered_or_trusted(visit: OpenPage, script: str) -> None:
    page = visit(script=script)
    page.keyboard.press("/")
    expect(page.locator(".find-box .heading")).to_have_text(["Open points", "Also understood"])
    page.keyboard.press("Escape")
    search(page, "navigator")
    assert titles(page)[0] == "Navigator"


@pytest.mark.parametrize(("width", "scheme"), [(360, "dark"), (1280, "light")])
def test_axe_finds_nothing_in_the_box(visit: OpenPage, width: int, scheme: str) -> None:
    page = visit("components/robot_action_planner.navigator.html", width=width, scheme=scheme)
    page.keyboard.press("/")
    expect(page.locator(".find-box .heading").last).to_have_text("Also understood")
    assert judge_with_axe(page) == []
    for words in ("skeleton", "sekleton", "zzzqqq"):
        page.keyboard.press("Escape")
        search(page, words)
        assert judge_with_axe(page) == [], words
        assert page.evaluate("document.documentElement.scrollWidth") == width


def test_a_screen_reader_hears_the_counts(visit: OpenPage) -> None:
    page = visit()
    search(page, "sekleton trakcing")
    status = page.locator(".find-box [role=status]")
    expect(status).to_contain_text("1 component, 1 node")
    expect(status).to_contain_text("Nearest: skeleton, tracking")


def test_of_many_results_fifty_are_drawn_and_all_are_counted(visit: OpenPage, tmp_path: Path) -> None:
    entries = [SearchEntry("port", f"Port {at}", "of a group", ("page:index",)) for at in range(9_000)]
    entries += [SearchEntry("component", f"Reporter {at}", "", ("page:index",)) for at in range(1_000)]
    write_tree(site_of(*entries), tmp_path / "site")
    page = visit(root=tmp_path / "site")
    search(page, "port")
    assert len(titles(page)) == 50
    assert page.locator(".find-box .chips button").all_inner_texts() == [
        "All 10,000",
        "Components 1,000",
        "Ports 9,000",
    ]
    expect(page.locator(".find-box [role=status]")).to_contain_text("10000 found, the best 50 shown")
    search_again = page.get_by_role("combobox")
    search_again.fill("prot 8765")
    expect(page.locator(".find-box .title").first).to_have_text("Port 8765")
    search_again.fill("zzzqqq")
    expect(page.locator(".find-box .note")).to_contain_text("Nothing here has all of “zzzqqq”")


def test_hostile_titles_are_text(visit: OpenPage, tmp_path: Path) -> None:
    turned = "abc \u202egnirts\u202c def"
    entries = [SearchEntry("node", title, title, ("page:index",), (), title) for title in (HOSTILE, turned, "😀😀")]
    write_tree(site_of(*entries, title=HOSTILE), tmp_path / "site")
    page = visit(root=tmp_path / "site")
    search(page, "onerror")
    assert titles(page) == [HOSTILE]
    assert page.locator(".find-box img").count() == 0
    page.get_by_role("combobox").fill("gnirts")
    expect(page.locator(".find-box .title")).to_have_text([turned])
    assert page.evaluate("getComputedStyle(document.querySelector('.find-box .title')).unicodeBidi") == "isolate"
    for words in ("😀", "\\", "(", "a" * 5000, "__proto__", "constructor:", ":", '"', "-x"):
        page.get_by_role("combobox").fill(words)
        page.wait_for_timeout(60)
    page.get_by_role("combobox").fill("😀")
    expect(page.locator(".find-box .title")).to_have_text(["😀😀"])
    assert page.title() == HOSTILE


def test_a_strict_policy_is_enough(visit: OpenPage, tmp_path: Path) -> None:
    write_tree(site_of(SearchEntry("node", "skeleton_tracker", "", ("page:index",))), tmp_path / "site")
    page_file = tmp_path / "site" / "index.html"
    policy = "default-src 'none'; script-src file:; style-src file:; font-src file:; img-src file:"
    meta = f'<meta charset="utf-8">\n<meta http-equiv="Content-Security-Policy" content="{policy}">'
    page_file.write_text(page_file.read_text().replace('<meta charset="utf-8">', meta))
    page = visit(root=tmp_path / "site")
    search(page, "sekleton")
    assert titles(page) == ["skeleton_tracker"]


def test_a_part_that_is_missing_is_said(visit: OpenPage, example: Path, tmp_path: Path) -> None:
    shutil.copytree(example, tmp_path / "site")
    (tmp_path / "site/assets/search/node-1.js").unlink()
    page = visit(root=tmp_path / "site", quiet=False)
    page.keyboard.press("/")
    page.keyboard.type("navigator")
    expect(page.locator(".find-box .note")).to_have_text("A part of the index could not be read.")
    assert titles(page)[0] == "Navigator"


def test_without_script_nothing_is_missing_but_the_box(browser: Browser, example: Path) -> None:
    page = browser.new_context(java_script_enabled=False).new_page()
    page.goto(f"file://{example}/index.html")
    assert page.get_by_role("button", name="Search everything").count() == 0
    assert page.get_by_role("link", name="Connections").count() > 0
    page.context.close()
