"""Find each anchor of a site: on which page it is, and with which id."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from archgen.emit.names import safe_paths
from archgen.emit.site.markup import element_id
from archgen.views.shapes import Figure, Page, Section, Table

RESERVED = ("content", "navigation")
"""Ids that the page's template uses."""


@dataclass(frozen=True, slots=True)
class Links:
    """The addresses of a site.

    `pages`: anchor -> path; `places`: anchor -> the first place, as path#id; `ids`: path -> anchors on that page with
    their ids; `files`: the page's path as asked for -> its safe path.
    """

    pages: Mapping[str, str]
    places: Mapping[str, str]
    ids: Mapping[str, Mapping[str, str]]
    files: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class Here:
    """The page that is being written. Links are relative to it; `root` is the way up to the site's folder."""

    path: str
    root: str
    links: Links

    def href(self, ref: str) -> str | None:
        """Return the address of an anchor from this page, or None where it leads nowhere, or to this page itself."""
        page = self.links.pages.get(ref)
        if page is not None:
            return None if page == self.path else self.root + page
        own = self.links.ids.get(self.path, {}).get(ref)
        if own is not None:
            return f"#{own}"
        place = self.links.places.get(ref)
        return None if place is None else self.root + place

    def id(self, anchor: str) -> str:
        """Return the id of an anchor on this page."""
        return self.links.ids[self.path][anchor]


def collect(pages: Iterable[Page]) -> Links:
    """Find every anchor of a site. An anchor on several pages belongs to the first, but each page prefers its own."""
    listed = tuple(pages)
    files = safe_paths(page.path for page in listed)
    found, places = dict[str, str](), dict[str, str]()
    ids = dict[str, Mapping[str, str]]()
    for page in listed:
        path = files[page.path]
        found.setdefault(page.anchor, path)
        ids[path] = own = _ids(page)
        for anchor, name in own.items():
            places.setdefault(anchor, f"{path}#{name}")
    return Links(found, places, ids, files)


def here(path: str, links: Links) -> Here:
    """Return the position from which a page's links are written."""
    return Here(path, "../" * path.count("/"), links)


def _ids(page: Page) -> dict[str, str]:
    """Assign each anchor on the page an id of its own, in order of appearance."""
    taken = set(RESERVED)
    ids = dict[str, str]()
    for anchor in _anchors(page.section):
        if anchor in ids:
            continue
        name = base = element_id(anchor)
        number = 2
        while name in taken:
            name = f"{base}-{number}"
            number += 1
        taken.add(name)
        ids[anchor] = name
    return ids


def _anchors(section: Section) -> Iterator[str]:
    yield section.anchor
    for block in section.blocks:
        if isinstance(block, (Table, Figure)):
            yield block.anchor
        if isinstance(block, Table):
            yield from (anchor for anchor in block.row_anchors if anchor)
    for inner in section.sections:
        yield from _anchors(inner)
