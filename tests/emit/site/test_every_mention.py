"""Every mention of an element, an owner, a message or a rule in the case study's tables is a link to its page."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from posixpath import dirname, join, normpath

import pytest
from lxml import etree

from archgen.emit.file_tree import FileTree
from archgen.emit.site import build_site
from archgen.model.architecture import Architecture
from archgen.model.message_types import full_message_name
from archgen.products import project_views
from archgen.products.output_options import OutputOptions
from archgen.views.pages import context_pages, site_pages
from tests.judged_projects import judge_ramcip

ROOT = Path(__file__).resolve().parents[3]


class CellReader:
    """Reads the cells of a page's tables: each piece of text with the address that it links to, if any.

    For lxml, which reads a page in a quarter of the time that Python's own parser takes.
    """

    def __init__(self) -> None:
        self.pieces: list[tuple[str, str | None]] = []
        self._depth, self._text = 0, ""
        self._address: str | None = None

    def start(self, tag: str, attributes: Mapping[str, str]) -> None:
        """Begin a cell, a link, or a new piece of one."""
        if tag in {"td", "dd"}:
            self._depth += 1
        if tag in {"a", "br", "code", "td", "dd", "span"} and not (tag in {"code", "span"} and self._address):
            self._finish()
        if tag == "a":
            self._address = attributes.get("href")

    def end(self, tag: str) -> None:
        """End a link or a cell; `wbr` has no end."""
        if tag in {"a", "td", "dd"} or (tag in {"code", "span"} and not self._address):
            self._finish()
        if tag == "a":
            self._address = None
        if tag in {"td", "dd"}:
            self._depth -= 1

    def data(self, data: str) -> None:
        """Add to the piece at hand."""
        if self._depth:
            self._text += data

    def close(self) -> None:
        """End the page."""

    def _finish(self) -> None:
        if self._text.strip():
            self.pieces.append((self._text.strip(), self._address))
        self._text = ""


CellPieces = Mapping[str, list[tuple[str, str | None]]]
"""The pieces of text in the cells of each page, by its path, with the addresses that they link to."""


@pytest.fixture(scope="module")
def architecture_and_site() -> tuple[Architecture, FileTree]:
    """Make the case study's site without its pictures."""
    checked = judge_ramcip()
    views = project_views.make_views(checked, OutputOptions(revision="test", show_history=False))
    pages = site_pages.make_pages(views.lookup, views.edition)
    made = build_site(pages, {}, title="R", revision="", notices=(), chapter_files=lambda _: None)
    return checked.architecture, made


@pytest.fixture(scope="module")
def cell_pieces(architecture_and_site: tuple[Architecture, FileTree]) -> CellPieces:
    """Read all pages, which takes longer than to make them."""
    pieces = {}
    for path, data in architecture_and_site[1].files.items():
        if path.endswith(".html"):
            reader = CellReader()
            parser = etree.HTMLParser(target=reader, encoding="utf-8")  # type: ignore[arg-type] # comments may be left out
            etree.fromstring(data, parser)
            pieces[path] = reader.pieces
    return pieces


def name_pages(architecture: Architecture) -> Mapping[str, set[str]]:
    """Name what has a page: ids and titles, with the pages that they lead to."""
    # Ids of groups, hosts and partners are common words (`hardware`); their titles stand for them.
    named = [
        *(("components", each.id, name) for each in architecture.components.values() for name in (each.id, each.title)),
        *(("groups", each.id, each.title) for each in architecture.groups.values()),
        *(("nodes", each.id, each.id) for each in architecture.nodes.values()),
        *(("partners", each.id, each.title) for each in architecture.partners.values()),
        *(("hosts", each.id, each.title) for each in architecture.hosts.values()),
        *(("requirements", each.id, each.id) for each in architecture.requirements.values()),
        *(("use_cases", each.id, each.id) for each in architecture.use_cases.values()),
        *(("chains", each.id, each.title) for each in architecture.chains.values()),
        *((f"{each.flow}s", each.name, each.name) for each in architecture.topics.values()),
        *(("messages", each.message, each.message) for each in architecture.types.values() if each.message),
    ]
    pages: dict[str, set[str]] = {}
    for folder, element, name in named:
        pages.setdefault(name, set()).add(f"{folder}/{context_pages.make_page_slug(element)}.html")
    for name in (name for name in pages if full_message_name(name)):
        pages[name] = {f"messages/{name.lower()}.html"}
    return pages


def find_unlinked(cell_pieces: CellPieces, pages: Mapping[str, set[str]]) -> Iterator[str]:
    for path, pieces in cell_pieces.items():
        # What an author wrote by hand is the author's.
        if path.startswith("chapters/"):
            continue
        for text, address in pieces:
            for piece in (piece.strip(" ()") for piece in text.split(", ")):
                # A page does not link to itself.
                if address is None and piece in pages and path not in pages[piece]:
                    yield f"{path}: {piece}"


@pytest.mark.slow
def test_no_element_owner_or_message_is_mentioned_in_a_cell_without_a_link(
    architecture_and_site: tuple[Architecture, FileTree], cell_pieces: CellPieces
) -> None:
    architecture, _ = architecture_and_site
    assert sorted(set(find_unlinked(cell_pieces, name_pages(architecture)))) == []


def test_no_link_in_a_cell_leads_nowhere(
    architecture_and_site: tuple[Architecture, FileTree], cell_pieces: CellPieces
) -> None:
    _, made = architecture_and_site
    wrong = []
    for path, pieces in cell_pieces.items():
        addresses = {address.partition("#")[0] for _, address in pieces if address and ":" not in address}
        wrong += [
            f"{path}: {address}"
            for address in addresses - {""}
            if normpath(join(dirname(path), address)) not in made.files
        ]
    assert wrong == []
