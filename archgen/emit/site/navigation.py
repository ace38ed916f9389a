"""Write the navigation of the site: the tree at the side, and the path above the title.

The tree follows the pages' crumbs: a page is below the last of its crumbs. Pages below the start page are always in the
tree, under the heading of their kind; pages below those only where the reader is.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from archgen.emit.site.links import Links
from archgen.emit.site.markup import escape, words
from archgen.views.shapes import Page

LISTED = 200
"""A longer list is not repeated on each of its pages: the page above has all of it, with a filter."""
NEWLINE = "\n"


@dataclass(frozen=True, slots=True)
class Navigation:
    """The navigation of a site.

    `kinds` are the headings (kind, title) in order; `children` holds each page's children by its anchor, and under
    `kind K` those below the start page; `start` is the start page's path, `home_title` what other pages call it.
    """

    kinds: tuple[tuple[str, str], ...]
    below: Mapping[str, Sequence[Page]]
    parents: Mapping[str, str]
    start: str
    home: str
    links: Links
    made: dict[tuple[str, tuple[str, ...]], str] = field(default_factory=dict)

    def html(self, page: Page, root: str) -> str:
        """Write the tree for a page. Trees that differ only in the marked page are made once."""
        way = self._way(page.anchor)
        # Without long lists a tree depends on the page right below the start page only, and hundreds of pages share it.
        key = (root, way if any(map(self._long, self._lists(way))) else way[-1:])
        if key not in self.made:
            self.made[key] = "\n".join(self._kind(kind, title, way, root) for kind, title in self.kinds)
        address = f'href="{root}{self.links.pages[page.anchor]}"'
        # The first hit is the page's own entry: only the start page may be linked to again, further down.
        return self.made[key].replace(address, f'{address} aria-current="page"', 1)

    def crumbs(self, page: Page, root: str) -> list[tuple[str, str | None]]:
        """Return the path from the start page: titles, with addresses where there is such a page."""
        found = ((title, self.links.pages.get(anchor)) for title, anchor in page.crumbs)
        return [(title, None if path is None else root + path) for title, path in found]

    def _way(self, anchor: str) -> tuple[str, ...]:
        """Return the anchors from this page up to the one right below the start page."""
        way = [anchor]
        # `not in way`: crumbs come from views, and a circle in them must not hang the build.
        while (parent := self.parents.get(anchor)) and parent in self.parents and parent not in way:
            way.append(anchor := parent)
        return tuple(way)

    def _lists(self, way: tuple[str, ...]) -> tuple[str, ...]:
        """Return the names of the lists that the tree shows to a reader here."""
        return (*(f"kind {kind}" for kind, _ in self.kinds), way[-1])

    def _long(self, name: str) -> bool:
        return len(self.below.get(name, ())) > LISTED

    def _shown(self, name: str, way: tuple[str, ...]) -> Sequence[Page]:
        """Return a list as the tree shows it: all of it, or if it is too long, what leads to the reader's page."""
        pages = self.below.get(name, ())
        return [page for page in pages if page.anchor in way] if self._long(name) else pages

    def _kind(self, kind: str, title: str, way: tuple[str, ...], root: str) -> str:
        name = f"kind {kind}"
        items = [self._item(page, way, root) for page in self._shown(name, way)]
        if self._long(name):
            more = len(self.below[name]) - len(items)
            items.append(f'<li><a href="{root}{self.start}">{more} more on the start page</a></li>')
        heading = f"<h2>{escape(title)}</h2>\n" if title else ""
        return f"{heading}<ul>\n{NEWLINE.join(items)}\n</ul>" if items else ""

    def _item(self, page: Page, way: tuple[str, ...], root: str) -> str:
        """Write an entry. The one that leads to the reader's page has its own list below it, others its length."""
        children = len(self.below.get(page.anchor, ()))
        count = f' <span class="count" aria-hidden="true">{children}</span>' if children else ""
        shown = self._shown(page.anchor, way) if page.anchor == way[-1] else ()
        items = NEWLINE.join(f"<li>{self._link(child, root)}</li>" for child in shown)
        inner = f"\n<ul>\n{items}\n</ul>\n" if items else ""
        return f"<li>{self._link(page, root, count)}{inner}</li>"

    def _link(self, page: Page, root: str, more: str = "") -> str:
        path = self.links.pages[page.anchor]
        title = self.home if path == self.start else page.title
        return f'<a href="{root}{path}">{words(title)}{more}</a>'


def navigation(pages: Sequence[Page], links: Links, kinds: Sequence[tuple[str, str]]) -> Navigation:
    """Build the navigation of a site. Kinds that `kinds` does not name come last, under their own name."""
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
