"""docs/modules.md is the table of contents of timing and views: it is fresh, and each module says what it is for."""

from __future__ import annotations

import runpy

from tests.running import ROOT

TOOL = runpy.run_path(str(ROOT / "tools" / "make_module_pages.py"))


def test_the_page_is_fresh() -> None:
    assert TOOL["make_page"]() == (ROOT / "docs" / "modules.md").read_text(encoding="utf-8"), "run `make pages`"


def test_every_module_says_what_it_is_for() -> None:
    rows = [line for line in TOOL["make_page"]().splitlines() if line.startswith("| `")]
    assert len(rows) > 80
    assert [row for row in rows if not row.rstrip(" |").partition("` | ")[2]] == []
