"""The letters that a picture brings, in Chromium."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from archgen.emit.picture import Picture
from archgen.emit.picture_files import build_picture_tree
from tests.browser_pages import watch_pages

if TYPE_CHECKING:
    from playwright.sync_api import Browser

SVG = (
    b'<svg xmlns="http://www.w3.org/2000/svg"><text font-family="Inter" y="20">Wide \xc3\xa9</text>'
    b'<text font-family="Inter" font-weight="bold" y="50">A</text></svg>'
)


def test_a_browser_takes_the_faces(browser: Browser, tmp_path: Path) -> None:
    files = build_picture_tree({"a": Picture("a", 1, 1, SVG)}, ("svg",)).files
    (tmp_path / "a.svg").write_bytes(files["a.svg"])
    with watch_pages(("file://", "data:")) as watch:
        page = watch(browser.new_page())
        page.goto(f"file://{tmp_path}/a.svg")
        states = page.evaluate("() => document.fonts.ready.then(() => [...document.fonts].map(({ status }) => status))")
        assert states == ["loaded", "loaded"]
