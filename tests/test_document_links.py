"""Each link between the project's own documents leads to a file, and to a heading where it names one."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest

from tests.running import ROOT

DOCUMENTS = [
    file
    for pattern in ("*.md", "docs/**/*.md", "benchmarks/*.md", "examples/**/*.md")
    for file in sorted(ROOT.glob(pattern))
]
CODE = re.compile(r"^ *```.*?^ *```|`[^`\n]*`", re.DOTALL | re.MULTILINE)
FENCED = re.compile(r"^ *```.*?^ *```", re.DOTALL | re.MULTILINE)


def list_headings(file: Path) -> set[str]:
    """Return the anchors of a document, as GitHub makes them of its headings."""
    text, counts, anchors = FENCED.sub("", file.read_text(encoding="utf-8")), Counter[str](), set[str]()
    for heading in re.findall(r"^#+ (.*)$", text, re.MULTILINE):
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
        anchor = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        anchors.add(f"{anchor}-{counts[anchor]}" if counts[anchor] else anchor)
        counts[anchor] += 1
    return anchors | set(re.findall(r'<a (?:id|name)="([^"]+)"', text))


def list_dead_links(file: Path) -> list[str]:
    dead = []
    for link in re.findall(r"\]\(([^)\s]+)\)", CODE.sub("", file.read_text(encoding="utf-8"))):
        path, _, anchor = link.partition("#")
        target = file.parent / path if path else file
        is_there = re.match(r"[a-z]+:", link) or (
            target.exists() and (not anchor or target.suffix != ".md" or anchor in list_headings(target))
        )
        if not is_there:
            dead.append(f"{file.relative_to(ROOT)}: {link}")
    return dead


def test_links_between_documents_lead_somewhere() -> None:
    assert len(DOCUMENTS) > 200
    assert [link for file in DOCUMENTS for link in list_dead_links(file)] == []


def test_a_dead_link_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tests.test_document_links.ROOT", tmp_path)
    (tmp_path / "b.md").write_text("# One `x`\n# One x\n```\n# Code\n```\n")
    file = tmp_path / "a.md"
    links = ("b.md#one-x", "b.md#one-x-1", "https://x.org", "b.md#code", "c.md", "#a")
    file.write_text("".join(f"[x]({link})\n" for link in links) + "`[x](d.md)`\n")
    assert list_dead_links(file) == ["a.md: b.md#code", "a.md: c.md", "a.md: #a"]
