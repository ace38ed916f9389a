"""What pages may run and load: the policy stands in each page, nothing in the page breaks it, and no text gets around it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from archgen.emit.file_tree import FileTree
from archgen.emit.picture import Picture
from archgen.emit.site.page_frame import PAGE_POLICY
from archgen.emit.site.standalone_page import write_standalone_page
from archgen.views.shapes import Figure, Outline, Section

if TYPE_CHECKING:
    from playwright.sync_api import Browser

MOST_BYTES = 100_000
"""A page's bytes without its pictures."""
_PICTURE = re.compile(r'<svg\b[^>]*class="archgen".*?</svg>', re.DOTALL)
_INLINE = re.compile(r"<[a-z]+\b[^>]*\s(?:style|on[a-z]+)=|<style\b|<script(?![^>]*\bsrc=)")


def choose_pages(folder: Path) -> list[str]:
    """Choose one page of each kind: those of the folder itself, and of each folder below the first of each depth."""
    paths = sorted(path.relative_to(folder) for path in folder.rglob("*.html"))
    chosen = {(path.parts[0], len(path.parts)): path.as_posix() for path in reversed(paths)}
    return sorted(chosen.values())


def test_each_page_has_the_policy_and_nothing_that_it_refuses(site: FileTree) -> None:
    for path, data in site.files.items():
        if path.endswith(".html"):
            text = data.decode()
            assert PAGE_POLICY in text.replace("&#x27;", "'"), path
            assert '<meta name="referrer" content="no-referrer">' in text, path
            assert _INLINE.findall(text) == [], path


@pytest.mark.slow
def test_the_case_study_has_nothing_in_its_pages_that_the_policy_refuses(example: Path) -> None:
    for path in example.rglob("*.html"):
        assert _INLINE.findall(path.read_text(encoding="utf-8")) == [], path.name


def test_the_policy_refuses_all_but_the_sites_own_files() -> None:
    directives = dict(part.split(" ", 1) for part in PAGE_POLICY.split("; "))
    assert directives["default-src"] == "'none'"
    assert directives["script-src"] == directives["style-src"] == "'self'"
    assert not re.search(r"unsafe|https?:|\*", PAGE_POLICY)


def test_a_browser_refuses_nothing_on_any_kind_of_page_from_the_disk(browser: Browser, example: Path) -> None:
    messages: list[str] = []
    page = browser.new_context(viewport={"width": 1280, "height": 800}).new_page()
    page.set_default_timeout(120_000)
    page.on("console", lambda message: messages.append(f"{page.url}: {message.text}"))
    page.on("pageerror", lambda error: messages.append(f"{page.url}: {error}"))
    for path in choose_pages(example):
        page.goto(f"file://{example}/{path}")
        assert page.evaluate("[...document.fonts].some(face => face.status == 'loaded')"), path
    # The scripts of the search come later, by a script.
    page.keyboard.press("/")
    page.keyboard.type("scan")
    page.get_by_role("option").first.wait_for()
    page.context.close()
    assert messages == []


def test_a_script_in_a_page_would_not_run(browser: Browser, example: Path, tmp_path: Path) -> None:
    text = (example / "chains.html").read_text(encoding="utf-8")
    (tmp_path / "x.html").write_text(
        text.replace(
            "<main", '<script>document.title = "taken"</script><img src=x onerror="document.title = 1"><main', 1
        ),
        encoding="utf-8",
    )
    page = browser.new_page()
    page.set_default_timeout(120_000)
    page.goto(f"file://{tmp_path}/x.html")
    assert page.title() != "taken"
    assert page.title() != "1"
    page.close()


@pytest.mark.slow
def test_no_page_is_heavy_without_its_pictures(example: Path) -> None:
    heavy = {}
    for path in example.rglob("*.html"):
        size = len(_PICTURE.sub("", path.read_text(encoding="utf-8")).encode())
        if size >= MOST_BYTES:
            heavy[path.relative_to(example).as_posix()] = size
    assert heavy == {}


def test_a_place_without_a_repository_can_be_copied(browser: Browser, example: Path) -> None:
    context = browser.new_context()
    context.grant_permissions(["clipboard-read", "clipboard-write"])
    page = context.new_page()
    page.set_default_timeout(120_000)
    page.goto(f"file://{example}/components/cognitive_reasoning.situation_assessment.html")
    page.get_by_role("button", name="Copy groups/cognitive_reasoning.yaml:11").click()
    page.get_by_text("Copied").wait_for()
    assert page.evaluate("navigator.clipboard.readText()") == "groups/cognitive_reasoning.yaml:11"
    context.close()


def test_on_paper_there_is_neither_bar_nor_button(browser: Browser, example: Path) -> None:
    page = browser.new_page()
    page.set_default_timeout(120_000)
    for path in (
        "matrix.html",
        "components/cognitive_reasoning.situation_assessment.html",
        "partners/certh/forth.html",
    ):
        page.goto(f"file://{example}/{path}")
        page.emulate_media(media="print", color_scheme="dark")
        assert not page.locator("#navigation").is_visible()
        assert (
            page.locator("main button:visible:not(.sort, .fold, .back-list button), .bar button:visible").count() == 0
        ), path
        assert page.evaluate("getComputedStyle(document.body).color") == "rgb(27, 33, 39)"
    page.close()


def test_a_browser_refuses_nothing_of_a_page_that_stands_by_itself(browser: Browser, tmp_path: Path) -> None:
    outline = Outline("Hands", sections=(Section("a", "A", (Figure("figure:f", "f", "Flow", "alt"),)),))
    svg = b'<svg xmlns="http://www.w3.org/2000/svg" width="90pt" height="9pt" viewBox="0 0 90 9"><text>x</text></svg>'
    text = write_standalone_page(outline, {"f": Picture("f", 90, 9, svg)}).decode()
    assert "unsafe" not in text
    assert len(_INLINE.findall(text)) == 1  # the element with the style, by its hash
    (tmp_path / "x.html").write_text(text, encoding="utf-8")
    messages: list[str] = []
    page = browser.new_page()
    page.set_default_timeout(120_000)
    page.on("console", lambda message: messages.append(message.text))
    page.goto(f"file://{tmp_path}/x.html")
    assert messages == []
    assert page.evaluate("getComputedStyle(document.querySelector('.canvas')).getPropertyValue('--natural')") == "120px"
    assert page.evaluate("[...document.fonts].some(face => face.status == 'loaded')")
    (tmp_path / "y.html").write_text(text.replace("<main", "<style>h1 { color: red; }</style><main", 1), "utf-8")
    page.goto(f"file://{tmp_path}/y.html")
    assert page.evaluate("getComputedStyle(document.querySelector('h1')).color") != "rgb(255, 0, 0)"
    page.close()
