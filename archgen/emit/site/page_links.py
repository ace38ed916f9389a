"""Find each anchor of a site: on which page it is, and with which id."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from archgen.emit.safe_names import assign_safe_paths
from archgen.emit.site.html_text import make_element_id
from archgen.emit.term_mentions import TERM_KIND
from archgen.frozen import dataclass, replace
from archgen.views.shapes import Block, Figure, Page, Section, Table, split_anchor

RESERVED_IDS = ("content", "navigation", "waterfall-hatch")
"""Ids that the page's template uses."""


@dataclass(frozen=True, slots=True)
class SiteLinks:
    """The addresses of a site.

    `pages`: anchor -> path; `places`: anchor -> the first place, as path#id; `ids`: path -> anchors on that page with
    their ids; `files`: the page's path as asked for -> its safe path.
    """

    pages: Mapping[str, str]
    places: Mapping[str, str]
    ids: Mapping[str, Mapping[str, str]]
    files: Mapping[str, str]
    terms: tuple[str, ...] = ()
    """The anchors of the glossary's terms."""


@dataclass(frozen=True, slots=True)
class CurrentPage:
    """The page that is being written. Links are relative to it; `root` is the way up to the site's folder."""

    path: str
    root: str
    links: SiteLinks

    def href(self, ref: str) -> str | None:
        """Return the address of an anchor from this page, or None where it leads nowhere, or to this page itself."""
        page = self.links.pages.get(ref)
        if page is not None:
            return None if page == self.path else self.root + page
        local_id = self.links.ids.get(self.path, {}).get(ref)
        if local_id is not None:
            return f"#{local_id}"
        target = self.links.places.get(ref)
        return None if target is None else self.root + target

    def id_for(self, anchor: str) -> str:
        """Return the id of an anchor on this page."""
        return self.links.ids[self.path][anchor]


def collect_links(pages: Iterable[Page]) -> SiteLinks:
    """Find every anchor of a site. An anchor on several pages belongs to the first, but each page prefers its own."""
    page_list = tuple(pages)
    files = assign_safe_paths(page.path for page in page_list)
    pages_by_anchor, places = dict[str, str](), dict[str, str]()
    ids = dict[str, Mapping[str, str]]()
    for page in page_list:
        path = files[page.path]
        pages_by_anchor.setdefault(page.anchor, path)
        ids[path] = own_ids = _assign_ids(page)
        for anchor, name in own_ids.items():
            places.setdefault(anchor, f"{path}#{name}")
    terms = tuple(anchor for anchor in places if split_anchor(anchor)[0] == TERM_KIND)
    return SiteLinks(pages_by_anchor, places, ids, files, terms)


def renew_ids(links: SiteLinks, path: str, page: Page) -> SiteLinks:
    """Return the links with the ids of a page that was made anew. Places on other pages stay as they were."""
    return replace(links, ids={**links.ids, path: _assign_ids(page)})


def open_page(path: str, links: SiteLinks) -> CurrentPage:
    """Return the position from which a page's links are written."""
    return CurrentPage(path, "../" * path.count("/"), links)


def _assign_ids(page: Page) -> dict[str, str]:
    """Assign each anchor on the page an id of its own, in order of appearance."""
    taken_ids = set(RESERVED_IDS)
    ids = dict[str, str]()
    card_lists = (part.cards for part in (page.dashboard, page.waterfall) if part)
    card_blocks = (block for cards in card_lists for card in cards for block in card.blocks)
    for anchor in (*_list_block_anchors(card_blocks), *_list_anchors(page.section)):
        if anchor in ids:
            continue
        name = base = make_element_id(anchor)
        number = 2
        while name in taken_ids:
            name = f"{base}-{number}"
            number += 1
        taken_ids.add(name)
        ids[anchor] = name
    return ids


def _list_anchors(section: Section) -> Iterator[str]:
    yield section.anchor
    yield from _list_block_anchors(section.blocks)
    for inner in section.sections:
        yield from _list_anchors(inner)


def _list_block_anchors(blocks: Iterable[Block]) -> Iterator[str]:
    for block in blocks:
        if isinstance(block, (Table, Figure)):
            yield block.anchor
        if isinstance(block, Table):
            yield from (anchor for anchor in block.row_anchors if anchor)
