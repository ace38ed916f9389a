"""What tests in Chromium have in common: pages that are watched for mistakes, and the judge of accessibility."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from tests.outside_tools import find_judge, find_tool

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext, Page, Playwright, Request, expect, sync_playwright
else:
    # `make test` collects these tests without this package.
    def expect(*arguments):  # noqa: ANN002, ANN201 - as above
        return importlib.import_module("playwright.sync_api").expect(*arguments)

    def sync_playwright():  # noqa: ANN201 - as above
        return importlib.import_module("playwright.sync_api").sync_playwright()


__all__ = ["OpenPage", "expect", "judge_with_axe", "launch_chromium", "sync_playwright", "watch_pages"]
OpenPage = Callable[..., "Page"]


def launch_chromium(playwright: Playwright) -> Browser:
    """Start Chromium: the one without windows where it is installed, since a page costs a third of the time there."""
    chromium = find_tool("chromium-headless-shell", "chromium", "chromium-browser")
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
    page.evaluate(find_judge("axe-core/axe.min.js").read_text())
    return page.evaluate("axe.run({preload: false}).then(r => r.violations.map(v => [v.id, v.nodes.map(n => n.html)]))")
