"""The site before outside judges: the Nu Html Checker, and Chromium with axe-core, opened from the disk."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from archgen.emit.file_tree import FileTree, write_tree
from archgen.emit.site import build_site as make_site
from archgen.views import shapes
from tests.browser_pages import OpenPage, judge_with_axe
from tests.emit.site.conftest import drawn
from tests.outside_tools import ask_nu_checker
from tests.property_sizes import try_some

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page, Route

ROOT = Path(__file__).resolve().parents[3]
JUDGES = ROOT / "tests" / "judges" / "node_modules"
SAMPLE = (
    "index.html",
    "groups/g1.html",
    "components/g1.c2.html",
    "nodes/node_1_1.html",
    "topics/robot/topic_7.html",
    "connections.html",
    "chapters/introduction.html",
)
EXAMPLE = (
    "index.html",
    "chains.html",
    "chains/missed_dose_to_mark.html",
    "findings.html",
    "groups/environment_state.html",
    "components/environment_state.object_recognition.html",
    "hosts.html",
    "messages.html",
    "messages/ramcip_msgs/msg/fallenobject.html",
    "partners.html",
    "partners/certh.html",
    "partners/certh/forth.html",
    "partners/forth/certh/human_state.fall_detector.fall.html",
    "matrix.html",
    "matrix/nodes.html",
    "matrix/requirements.html",
    "nodes/object_recognizer.html",
    "requirements.html",
    "timing/hosts.html",
    "rules/uncovered-requirement.html",
)
HOSTILE = '</title><script>document.title="taken"</script><img src=x onerror=document.title="taken">{{7*7}}'


def needed(path: str | Path | None, package: str) -> str:
    assert path is not None and Path(path).exists(), f"this test needs {package}"  # noqa: PT018 - one fact
    return str(path)


@pytest.fixture(scope="module")
def folder(site: FileTree, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write the site to the disk."""
    place = tmp_path_factory.mktemp("out") / "site"
    write_tree(site, place)
    return place


@pytest.fixture
def visit(browser: Browser, folder: Path) -> Iterator[OpenPage]:
    """Open a page from the disk; a request to anywhere else, an error or a message in the console is a failure."""
    wrong: list[str] = []

    def judge(route: Route) -> None:
        if route.request.url.startswith("file://"):
            route.continue_()
        else:
            wrong.append(route.request.url)
            route.abort()

    def opened(path: str, width: int = 1280, scheme: str = "light", root: Path | None = None) -> Page:
        context = browser.new_context(viewport={"width": width, "height": 800}, color_scheme=scheme)  # type: ignore[arg-type]
        page = context.new_page()
        page.set_default_timeout(120_000)
        page.route("**/*", judge)
        page.on("console", lambda message: wrong.append(message.text))
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("requestfailed", lambda request: wrong.append(f"{request.url} failed"))
        page.goto(f"file://{root or folder}/{path}")
        return page

    yield opened
    for context in browser.contexts:
        context.close()
    assert wrong == []


def said_by_nu(folder: Path) -> list[str]:
    pages = [str(path) for path in sorted(folder.rglob("*.html"))]
    assert len(pages) > 350
    messages = [f"{m.get('url')}:{m.get('lastLine')}: {m['message']}" for m in ask_nu_checker(pages)]
    # To Nu nothing on a disk is a page's own. Browsers see that otherwise: test_page_policy opens each kind in one.
    return [message for message in messages if "blocked by" not in message or "Content Security Policy" not in message]


def test_the_nu_checker_finds_nothing(folder: Path) -> None:
    assert said_by_nu(folder) == []


@pytest.mark.slow
def test_the_nu_checker_finds_nothing_in_the_case_study(example: Path) -> None:
    assert said_by_nu(example) == []


# The other two pairs are tried with the case study.
@pytest.mark.parametrize(("width", "scheme"), try_some([(360, "dark"), (1280, "light")]))
def test_axe_finds_nothing(visit: OpenPage, width: int, scheme: str) -> None:
    for path in SAMPLE:
        assert judge_with_axe(visit(path, width, scheme)) == [], path


@pytest.mark.parametrize(("width", "scheme"), try_some([(360, "light"), (1280, "dark")], 0, 1))
def test_the_case_study_in_chromium(visit: OpenPage, example: Path, width: int, scheme: str) -> None:
    for path in EXAMPLE:
        page = visit(path, width, scheme, example)
        assert judge_with_axe(page) == [], path
        assert page.evaluate("document.documentElement.scrollWidth") == width, path


@pytest.mark.parametrize("path", SAMPLE)
def test_nothing_scrolls_sideways_on_a_telephone(visit: OpenPage, path: str) -> None:
    page = visit(path, 360)
    assert page.evaluate("document.documentElement.scrollWidth") == 360
    wide = """[...document.querySelectorAll("main *")].filter(e => !e.closest(".scroll, pre, .spoken") &&
        e.getBoundingClientRect().right > 360).map(e => e.outerHTML.slice(0, 80))"""
    assert page.evaluate(wide) == []


def test_the_font_that_ships_is_loaded(visit: OpenPage) -> None:
    page = visit("index.html")
    assert page.evaluate("document.fonts.ready.then(() => document.fonts.check('16px Inter'))")
    assert page.evaluate("[...document.fonts].filter(f => f.family == 'Inter' && f.status == 'loaded').length") >= 1


def test_light_and_dark_are_remembered(visit: OpenPage) -> None:
    page = visit("index.html", scheme="dark")
    colour = "getComputedStyle(document.body).backgroundColor"
    assert page.evaluate(colour) == "rgb(20, 24, 28)"
    page.get_by_role("button", name="Light").click()
    assert page.evaluate(colour) == "rgb(246, 247, 249)"
    page.get_by_role("link", name="Environment Model").first.click()
    page.wait_for_url("**/groups/g1.html")
    assert page.evaluate(colour) == "rgb(246, 247, 249)"


def test_pictures_follow_light_and_dark(visit: OpenPage) -> None:
    page = visit("index.html")
    colour = "getComputedStyle(document.querySelector('.canvas svg polygon')).fill"
    assert page.evaluate(colour) == "rgb(255, 255, 255)"
    page.get_by_role("button", name="Dark").click()
    assert page.evaluate(colour) == "rgb(20, 24, 28)"


def test_paper_is_light(visit: OpenPage) -> None:
    page = visit("index.html", scheme="dark")
    page.get_by_role("button", name="Light").click()
    page.get_by_role("button", name="Dark").click()
    page.emulate_media(media="print", color_scheme="dark")
    assert page.evaluate("getComputedStyle(document.body).color") == "rgb(27, 33, 39)"
    assert page.evaluate("getComputedStyle(document.querySelector('.canvas svg polygon')).fill") == "rgb(255, 255, 255)"
    assert not page.locator("#navigation").is_visible()


def test_paper_has_tables_as_wide_as_it_is(visit: OpenPage, tmp_path: Path) -> None:
    def make_table(columns: int, rows: int) -> shapes.Table:
        cell = (shapes.Text("geometry_msgs/msg/PoseWithCovarianceStamped", code=True),)
        titles = tuple(shapes.Column(f"Column {at}") for at in range(columns))
        return shapes.Table(f"t{columns}", f"{columns} wide", titles, ((cell,) * columns,) * rows)

    section = shapes.Section("page:index", "R", (make_table(4, 250), make_table(11, 12)))
    start = shapes.Page("index.html", "page:index", "R", "overview", section)
    made = make_site((start,), {}, title="R", revision="", notices=(), chapter_files=lambda _: None)
    write_tree(made, tmp_path / "site")
    page = visit("index.html", root=tmp_path / "site")
    page.set_viewport_size({"width": 703, "height": 1000})
    page.emulate_media(media="print")
    page.wait_for_function("document.querySelectorAll('.as-rows').length == 1")
    assert page.evaluate("document.documentElement.scrollWidth") == 703
    assert page.locator("#t4 table:not(.as-rows) thead").is_visible()
    assert page.locator("#t11 thead").is_hidden()
    assert page.locator(".pager").inner_text() == "1 to 100 of 250"
    # Chromium makes what it prints smaller where tables are too wide before scripts have their turn.
    page.locator(".as-rows").evaluate("table => table.classList.remove('as-rows')")
    assert page.evaluate("document.documentElement.scrollWidth") == 703


def test_links_in_pictures_work(visit: OpenPage) -> None:
    page = visit("index.html")
    page.locator(".canvas a").nth(1).click()
    page.wait_for_url("**/groups/g1.html")
    assert page.title().startswith("Environment Model")
    page.get_by_role("link", name="Open picture").click()
    page.wait_for_url("**/figures/groups/g1.svg")
    page.locator("a").nth(2).click()
    page.wait_for_url("**/components/g1.c2.html")


def test_a_picture_can_be_looked_at_closely(visit: OpenPage, tmp_path: Path) -> None:
    page = visit("groups/g1.html")
    page.get_by_role("button", name="Look closer").click()
    drawing = page.locator("dialog svg")
    before = drawing.bounding_box()
    page.keyboard.press("+")
    after = drawing.bounding_box()
    assert before is not None
    assert after is not None
    assert after["width"] == pytest.approx(before["width"] * 1.25)
    page.keyboard.press("0")
    for form in ("SVG", "PNG"):
        with page.expect_download() as download:
            page.get_by_role("button", name=f"Save as {form}").click()
        assert download.value.suggested_filename == f"groups-g1.{form.lower()}"
        download.value.save_as(tmp_path / form)
    text = (tmp_path / "SVG").read_text("utf-8")
    assert all(word not in text for word in ("<a", "class=", "var(", "href"))
    # Whoever opens it may lack the font: it is inside, of its alphabets those that occur.
    assert text.count("@font-face{font-family:Inter;font-weight:100 900;src:url(data:font/woff2;base64,d09GMg") == 1
    assert text.count("textLength=") == text.count("<text")
    # A picture of its own keeps the room, colours and words that it has in the page.
    page.goto((tmp_path / "SVG").rename(tmp_path / "saved.svg").as_uri())
    assert page.evaluate("getComputedStyle(document.querySelector('polygon')).fill") == "rgb(255, 255, 255)"
    page.go_back()
    assert (tmp_path / "PNG").read_bytes().startswith(b"\x89PNG")
    page.get_by_role("button", name="Look closer").click()
    page.keyboard.press("Escape")
    # The page takes the dialog away when the browser has told it of the closing.
    page.locator("dialog").wait_for(state="detached")
    assert page.locator("dialog").count() == 0
    page.get_by_role("button", name="Look closer").click()
    page.locator("dialog a").nth(2).click()
    page.wait_for_url("**/components/g1.c2.html")


def test_tables_sort_and_filter(visit: OpenPage) -> None:
    page = visit("connections.html")
    column = "[...document.querySelectorAll('tbody tr')].filter(r => !r.hidden).map(r => r.cells[1].innerText)"
    page.get_by_role("button", name="Topic").click()
    assert page.evaluate(column)[:3] == ["/robot/topic_0", "/robot/topic_1", "/robot/topic_2"]
    page.get_by_role("button", name="Topic").click()
    assert page.evaluate(column)[0] == "/robot/topic_137"
    assert page.locator("th").nth(1).get_attribute("aria-sort") == "descending"
    page.get_by_role("searchbox").fill("person topic_8")
    assert page.evaluate(column) == ["/robot/topic_85", "/robot/topic_8"]
    assert page.locator("output").inner_text() == "2 of 138"


def test_a_long_table_is_shown_by_pages_and_sorted_filtered_and_copied_as_a_whole(
    visit: OpenPage, browser: Browser, tmp_path: Path
) -> None:
    rows = tuple(
        ((shapes.Text(f"n{at}"),), (shapes.Text("=x" if at == 7 else "a.yaml:1", is_place=at != 7, code=at != 7),))
        for at in range(380)
    )
    anchors = tuple(f"component:n{at}" for at in range(380))
    table = shapes.Table("t", "Many", (shapes.Column("Name"), shapes.Column("What")), rows, anchors)
    start = shapes.Page("index.html", "page:index", "R", "overview", shapes.Section("page:index", "R", (table,)))
    write_tree(
        make_site((start,), {}, title="R", revision="", notices=(), chapter_files=lambda _: None), tmp_path / "site"
    )
    page = visit("index.html", root=tmp_path / "site")
    names = "[...document.querySelectorAll('tbody tr')].map(r => r.cells[0].innerText)"
    assert page.evaluate(names) == [f"n{at}" for at in range(100)]
    assert page.locator(".pager output").inner_text() == "1 to 100 of 380"
    for _ in range(3):
        page.get_by_role("button", name="Next").click()
    assert page.evaluate(names) == [f"n{at}" for at in range(300, 380)]
    assert page.get_by_role("button", name="Next").is_disabled()
    assert page.get_by_role("button", name="Copy a.yaml:1").count() == 80
    assert "page=4" in page.url
    page.reload()
    assert page.evaluate(names)[0] == "n300"
    page.get_by_role("button", name="Name", exact=True).click()
    page.get_by_role("button", name="Name", exact=True).click()
    assert page.evaluate(names)[:2] == ["n379", "n378"]
    page.get_by_role("searchbox").first.fill("=x")
    assert page.evaluate(names) == ["n7"]
    page.evaluate(
        "navigator.clipboard ? (navigator.clipboard.writeText = words => ((window.copied = words), Promise.resolve())) : 0"
    )
    page.get_by_role("button", name="Copy as CSV").click()
    assert page.evaluate("window.copied") == '"Name","What"\r\n"n7","\'=x"\r\n'
    page.get_by_role("searchbox").first.fill("n250")
    page.get_by_role("button", name="Copy as CSV").or_(
        page.get_by_role("button", name="Copied", exact=True)
    ).first.click()
    assert page.evaluate("window.copied").endswith('"n250","a.yaml:1"\r\n')
    page = visit("index.html#component:n250", root=tmp_path / "site")
    assert "n250" in page.evaluate(names)
    quiet = browser.new_context(java_script_enabled=False).new_page()
    quiet.goto(f"file://{tmp_path}/site/index.html")
    assert quiet.locator("tbody tr").count() == 380


def test_a_cell_of_many_names_shows_the_first_ones(visit: OpenPage, tmp_path: Path) -> None:
    def write_cell(count: int) -> shapes.Inlines:
        return tuple(run for at in range(count) for run in (shapes.Text(f"n{at}", ref="page:x"), shapes.Text(", ")))

    rows = (((shapes.Text("few"),), write_cell(60)), ((shapes.Text("many"),), write_cell(500)))
    table = shapes.Table("t", "Names", (shapes.Column("Step"), shapes.Column("Which")), rows)
    start = shapes.Page("index.html", "page:index", "R", "overview", shapes.Section("page:index", "R", (table,)))
    other = shapes.Page("x.html", "page:x", "X", "x", shapes.Section("page:x", "X", ()), (("R", "page:index"),))
    made = make_site((start, other), {}, title="R", revision="", notices=(), chapter_files=lambda _: None)
    write_tree(made, tmp_path / "site")
    page = visit("index.html", root=tmp_path / "site")
    assert page.locator("td a").count() == 60 + 30
    page.get_by_role("button", name="470 more").click()
    assert page.locator("td a").count() == 60 + 500
    assert page.evaluate("document.activeElement.textContent") == "n30"
    page = visit("index.html", root=tmp_path / "site")
    page.emulate_media(media="print")
    page.wait_for_function("document.querySelectorAll('td a').length == 560")


COLUMN = "at => [...document.querySelectorAll('tbody tr')].filter(r => !r.hidden).map(r => r.cells[at].innerText)"


def _write_quantities(folder: Path) -> Path:
    """Write a site of one table of times, with units that order differently as text, and a page that it links to."""
    known = {"20 ms": "20000000", "15 s": "15000000000", "60 s": "60000000000", "350 ms": "350000000"}
    known |= {"8.3 ms": "25000000/3", "1/3 ms": "1000000/3"}
    times = ("20 ms", "15 s", "unknown", "60 s", "350 ms", "8.3 ms", "longer", "1/3 ms")
    rows = tuple(
        ((shapes.Text(f"chain {at}", ref="page:x"),), (shapes.Text(text, sort_number=known.get(text)),))
        for at, text in enumerate(times * 2)
    )
    table = shapes.Table("t", "Times", (shapes.Column("Chain"), shapes.Column("Deadline")), rows)
    start = shapes.Page("index.html", "page:index", "R", "overview", shapes.Section("page:index", "R", (table,)))
    other = shapes.Page("x.html", "page:x", "X", "x", shapes.Section("page:x", "X", ()), (("R", "page:index"),))
    made = make_site((start, other), {}, title="R", revision="", notices=(), chapter_files=lambda _: None)
    write_tree(made, folder / "site")
    return folder / "site"


def test_quantities_sort_by_value_and_unknown_ones_stay_last_both_ways(visit: OpenPage, tmp_path: Path) -> None:
    page = visit("index.html", root=_write_quantities(tmp_path))
    known = ["1/3 ms", "8.3 ms", "20 ms", "350 ms", "15 s", "60 s"]
    page.get_by_role("button", name="Deadline").click()
    assert list(dict.fromkeys(page.evaluate(COLUMN, 1)))[:6] == known
    assert set(page.evaluate(COLUMN, 1)[-4:]) == {"unknown", "longer"}
    page.get_by_role("button", name="Deadline").click()
    assert list(dict.fromkeys(page.evaluate(COLUMN, 1)))[:6] == known[::-1]
    assert set(page.evaluate(COLUMN, 1)[-4:]) == {"unknown", "longer"}


def test_back_brings_back_field_rows_count_and_order(visit: OpenPage, tmp_path: Path) -> None:
    page = visit("index.html", root=_write_quantities(tmp_path))
    page.get_by_role("searchbox").fill("ms")
    page.get_by_role("button", name="Deadline").click()
    page.get_by_role("button", name="Deadline").click()
    left = page.evaluate(COLUMN, 1)
    assert left == ["350 ms", "350 ms", "20 ms", "20 ms", "8.3 ms", "8.3 ms", "1/3 ms", "1/3 ms"]
    # A font that is still under way when the page is left would be a request that failed.
    page.wait_for_load_state("networkidle")
    page.get_by_role("link", name="chain 0").click()
    page.wait_for_load_state("networkidle")
    page.wait_for_url("**/x.html")
    page.go_back()
    page.wait_for_url("**/index.html?q=ms&sort=-Deadline")
    assert page.get_by_role("searchbox").input_value() == "ms"
    assert page.evaluate(COLUMN, 1) == left
    assert page.locator("output").inner_text() == "8 of 16"
    assert page.locator("th").nth(1).get_attribute("aria-sort") == "descending"


def test_a_link_with_filter_and_order_shows_what_the_sender_saw(visit: OpenPage, tmp_path: Path) -> None:
    page = visit("index.html?q=15&sort=Deadline", root=_write_quantities(tmp_path))
    assert page.evaluate(COLUMN, 0) == ["chain 15", "chain 1", "chain 9"]
    # The name of no column, and a filter that nothing matches: obeyed as far as it goes, and no error.
    page = visit("index.html?q=zzz&sort=Nothing", root=tmp_path / "site")
    assert page.evaluate(COLUMN, 0) == []
    assert page.locator("output").inner_text() == "0 of 16"


def test_the_keyboard_gets_past_the_tree(visit: OpenPage) -> None:
    page = visit("components/g1.c2.html")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.textContent") == "Skip to the content"
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.id") == "content"


def test_the_tree_opens_on_a_telephone(visit: OpenPage) -> None:
    page = visit("components/g1.c2.html", 360)
    tree = page.locator("#navigation")
    assert not tree.is_visible()
    page.get_by_role("button", name="Menu").click()
    assert tree.is_visible()
    page.keyboard.press("Escape")
    assert not tree.is_visible()


def test_hostile_titles_run_nothing(visit: OpenPage, tmp_path: Path) -> None:
    table = shapes.Table("t", HOSTILE, (shapes.Column(HOSTILE),), (((shapes.Text(HOSTILE),),),) * 12)
    section = shapes.Section("page:index", HOSTILE, (table, shapes.Markdown(HOSTILE)))
    start = shapes.Page("index.html", "page:index", HOSTILE, "overview", section)
    made = make_site((start,), {}, title=HOSTILE, revision=HOSTILE, notices=(), chapter_files=lambda _: None)
    write_tree(made, tmp_path / "site")
    page = visit("index.html", root=tmp_path / "site")
    assert page.title() == HOSTILE
    assert page.locator("h1").inner_text() == HOSTILE
    assert page.locator("main img").count() == 0


@pytest.mark.parametrize("width", [1280, 390])
def test_long_words_do_not_widen_a_page(visit: OpenPage, tmp_path: Path, width: int) -> None:
    word = "Donaudampfschiff" * 20
    table = shapes.Table("t", word, (shapes.Column(word), shapes.Column("x")), (((shapes.Text(word),),) * 2,))
    parts = (shapes.Section("page:index#a", word), shapes.Section("page:index#b", word))
    section = shapes.Section("page:index", word, (table, shapes.Figure("f", "f", word, word)), parts)
    start = shapes.Page("index.html", "page:index", word, "overview", section)
    pictures = {"f": drawn("f", {"a": word})}
    made = make_site((start,), pictures, title=word, revision=word, notices=(), chapter_files=lambda _: None)
    write_tree(made, tmp_path / "site")
    page = visit("index.html", width, root=tmp_path / "site")
    assert page.evaluate("document.documentElement.scrollWidth") == width


def test_everything_is_there_without_script(browser: Browser, folder: Path) -> None:
    page = browser.new_context(java_script_enabled=False).new_page()
    page.goto(f"file://{folder}/connections.html")
    assert page.locator("tbody tr").count() == 138
    assert not page.locator("button.theme").is_visible()
    assert page.locator("#navigation").is_visible()
    page.context.close()
