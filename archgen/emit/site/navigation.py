"""The way round the site: the tree at the side, and the path above the title.

The tree is what the pages' crumbs say: a page hangs below the last of its crumbs. Those below the start page stand in
the tree always, under their kind's heading; those below them where the reader is.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from archgen.emit.site.links import Links
from archgen.emit.site.markup import escape, words
from archgen.views.shapes import Page


@dataclass(frozen=True, slots=True)
class Navigation:
    """The tree. `kinds` are the headings (kind, title) in order; `below` holds each page's children by its anchor;
    `start` is the start page's path, `home` what other pages call it.
    """

    kinds: tuple[tuple[str, str], ...]
    below: Mapping[str, Sequence[Page]]
    parents: Mapping[str, str]
    start: str
    home: str
    links: Links
    made: dict[tuple[str, str | None], str] = field(default_factory=dict)

    def html(self, page: Page, root: str) -> str:
        """Write the tree for a page; trees that differ only in where the reader is are made once."""
        top = self._top(page.anchor)
        key = (root, top)
        if key not in self.made:
            self.made[key] = "\n".join(self._kind(kind, title, top, root) for kind, title in self.kinds)
        address = f'href="{root}{self.links.pages[page.anchor]}"'
        return self.made[key].replace(address, f'{address} aria-current="page"', 1)

    def crumbs(self, page: Page, root: str) -> list[tuple[str, str | None]]:
        """Give the path from the start page: titles with addresses, where there is such a page."""
        found = ((title, self.links.pages.get(anchor)) for title, anchor in page.crumbs)
        return [(title, None if path is None else root + path) for title, path in found]

    def _top(self, anchor: str) -> str | None:
        """Give the page right below the start page that leads to this one."""
        seen = {anchor}
        while (parent := self.parents.get(anchor)) and parent in self.parents and parent not in seen:
            anchor = parent
            seen.add(anchor)
        return anchor

    def _kind(self, kind: str, title: str, top: str | None, root: str) -> str:
        items = "\n".join(self._item(page, top, root) for page in self.below.get(f"kind {kind}", ()))
        heading = f"<h2>{escape(title)}</h2>\n" if title else ""
        return f"{heading}<ul>\n{items}\n</ul>" if items else ""

    def _item(self, page: Page, top: str | None, root: str) -> str:
        children = self.below.get(page.anchor, ())
        count = f' <span class="count" aria-hidden="true">{len(children)}</span>' if children else ""
        inner = ""
        if children and page.anchor == top:
            items = "\n".join(f"<li>{self._link(child, root)}</li>" for child in children)
            inner = f"\n<ul>\n{items}\n</ul>\n"
        return f"<li>{self._link(page, root, count)}{inner}</li>"

    def _link(self, page: Page, root: str, more: str = "") -> str:
        path = self.links.pages[page.anchor]
        title = self.home if path == self.start else page.title
        return f'<a href="{root}{path}">{words(title)}{more}</a>'


def navigation(pages: Sequence[Page], links: Links, kinds: Sequence[tuple[str, str]]) -> Navigation:
    """Make the tree of a site's pages. Kinds that nobody named come last, under their own name."""
    known = {page.anchor for page in pages}
    start = pages[0].anchor
    parents: dict[str, str] = {}
    below: dict[str, list[Page]] = {}
    named = dict(kinds)
    for page in pages:
        parent = page.crumbs[-1][1] if page.crumbs else start
        if page.anchor != start:
            parents[page.anchor] = parent if parent in known else start
        if page.anchor == start or parents[page.anchor] == start:
            named.setdefault(page.kind, page.kind.replace("_", " ").capitalize())
            below.setdefault(f"kind {page.kind}", []).append(page)
        else:
            below.setdefault(parents[page.anchor], []).append(page)
    home = next((title for page in pages for title, anchor in page.crumbs if anchor == start), pages[0].title)
    return Navigation(tuple(named.items()), below, parents, links.pages[start], home, links)
