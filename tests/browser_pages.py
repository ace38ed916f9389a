"""What tests in Chromium have in common: pages that are watched for mistakes, and the judge of accessibility."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from playwright.sync_api import Browser, BrowserContext, Page, Playwright, Request

OpenPage = Callable[..., Page]
_AXE = Path(__file__).parent / "judges" / "node_modules" / "axe-core" / "axe.min.js"


def launch_chromium(playwright: Playwright) -> Browser:
    """Start Chromium: the one without windows where it is installed, since a page costs a third of the time there."""
    names = ("chromium-headless-shell", "chromium", "chromium-browser")
    chromium = next((path for name in names if (path := shutil.which(name))), None)
    assert chromium is not None, "this test needs Chromium (Debian: `chromium`)"
    # Many others may run at the same time, which makes everything late and nothing wrong.
    return playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox", "--disable-gpu"], timeout=600_000)


@contextmanager
def watch_pages(addresses: tuple[str, ...] = ("file://",)) -> Iterator[Callable[..., Page]]:
    """Give a function that watches a page, and close what it watched at the end.

    A request to anywhere else than the addresses (how they begin), an error or a message in the console is a failure.
    """
    mistakes: list[str] = []
    contexts: list[BrowserContext] = []

    def judge(request: Request) -> None:
        if not request.url.startswith(addresses):
            mistakes.append(request.url)

    def watch(page: Page, *, console: bool = True) -> Page:
        contexts.append(page.context)
        page.set_default_timeout(120_000)
        page.on("request", judge)
        if console:
            page.on("console", lambda message: mistakes.append(message.text))
        page.on("pageerror", lambda error: mistakes.append(str(error)))
        return page

    yield watch
    for context in contexts:
        context.close()
    assert mistakes == []


def judge_with_axe(page: Page) -> object:
    """Return the rules of accessibility that a page breaks, with the elements that do."""
    assert _AXE.is_file(), "this test needs axe-core (`npm ci` in tests/judges)"
    page.evaluate(_AXE.read_text())
    return page.evaluate("axe.run({preload: false}).then(r => r.violations.map(v => [v.id, v.nodes.map(n => n.html)]))")
