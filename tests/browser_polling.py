"""Waits in browsers for what a page's policy lets no evaluated script wait for."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from playwright.sync_api import Page


_SECONDS = 120.0


def wait_until(page: Page, expression: str) -> None:
    """Wait until an expression is true in a page. `Page.wait_for_function` uses `eval`, which our pages forbid."""
    end = time.monotonic() + _SECONDS
    while not page.evaluate(expression):
        assert time.monotonic() < end, f"not true within {_SECONDS:g} s: {expression}"
        page.wait_for_timeout(20)
