"""The manual as a site: its navigation holds each page once, its anchors are those of GitHub, its links lead out where they must."""

from __future__ import annotations

import runpy
from collections import Counter
from typing import Any

from tests.running import ROOT
from tests.test_document_links import list_headings

DOCS = ROOT / "docs"
HOOKS = runpy.run_path(str(ROOT / "tools" / "manual_hooks.py"))


def list_pages(entry: Any) -> list[str]:  # noqa: ANN401 - as nested as MkDocs has it
    if isinstance(entry, str):
        return [entry]
    return [page for each in (entry.values() if isinstance(entry, dict) else entry) for page in list_pages(each)]


def test_the_navigation_has_each_page_once_in_four_kinds() -> None:
    navigation = HOOKS["list_navigation"]((DOCS / "index.md").read_text(encoding="utf-8"), DOCS)
    assert [next(iter(section)) for section in navigation] == [
        "The manual",
        "First steps",
        "How to",
        "Reference",
        "Background",
    ]
    listed = Counter(list_pages(navigation))
    assert listed == Counter(page.relative_to(DOCS).as_posix() for page in DOCS.rglob("*.md"))


def test_anchors_are_those_of_github() -> None:
    for name in ("timing.md", "language.md", "editors.md"):
        text = (DOCS / name).read_text(encoding="utf-8")
        anchors = {
            HOOKS["make_anchor"](line.lstrip("# ").replace("`", ""), "-")
            for line in text.splitlines()
            if line[:2] == "##"
        }
        assert {anchor for anchor in anchors if "[" not in anchor} & list_headings(DOCS / name)
        assert len(anchors - list_headings(DOCS / name)) <= sum(
            "](" in line for line in text.splitlines() if line[:2] == "##"
        )


def test_links_out_of_the_manual_lead_to_the_repository() -> None:
    repository = HOOKS["REPOSITORY"]
    text = "[a](../README.md#try-it) [b](language.md) [c](../examples/arm) [d](../language.md)"
    assert HOOKS["on_page_markdown"](text, None) == (
        f"[a]({repository}README.md#try-it) [b](language.md) [c]({repository}examples/arm) [d](../language.md)"
    )


def test_its_contents_stand_in_one_file_for_programs() -> None:
    text = HOOKS["write_contents"]((DOCS / "index.md").read_text(encoding="utf-8"), "A description.")
    assert text.startswith("# archgen\n\n> A description.\n\n## First steps\n\n- [The first hour](first_hour.html): ")
    assert text.count("\n## ") == 4
    assert "- [Rules](rules/index.html): " in text
