"""Write the navigation of the site: the tree at the side, and the path above the title.

The tree follows the pages' crumbs: a page is below the last of its crumbs. Pages below the start page are always in the
tree, under the heading of their kind; pages below those only where the reader is.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

from archgen.emit.site import html_text
from archgen.emit.site.html_text import escape_breakable, escape_html
from archgen.emit.site.page_links import SiteLinks
from archgen.frozen import dataclass, field
from archgen.views.shapes import Page

MAX_LISTED = 60
"""A longer list is not repeated on each page: the page above has all of it, with a filter.

Of 41,133 pages (10,000 components in 200 groups) a tree of all groups made two thirds of each page, 700 MB in all.
"""
MAX_TREE_PAGES = 10_000
"""With more pages, those in and below long lists show only their own branch of the tree; the start page has all of it.

Of 42,000 pages the tree made 2.3 of 8 kB each.
"""
UNCOUNTED_KINDS = frozenset({"rules", "timing", "matrices", "parts"})
"""Kinds of pages that are no elements: how many there are says nothing about the architecture."""
NEWLINE = "\n"
_NESTED_KIND = "components"
"""The kind of pages below which the tree opens again: components inside of others."""


@dataclass(frozen=True, slots=True)
class SiteNavigation:
    """The navigation of a site.

    `kinds` are the headings (kind, title) in order; `children` holds each page's children by its anchor, and under
    `kind K` those below the start page; `start` is the start page's path, `home_title` what other pages call it.
    """

    kinds: tuple[tuple[str, str], ...]
    children: Mapping[str, Sequence[Page]]
    parents: Mapping[str, str]
    start: str
    home_title: str
    links: SiteLinks
    pages: Mapping[str, Page]
    cached_html: dict[tuple[str, tuple[str, ...], bool], str] = field(default_factory=dict)
    cached_entries: dict[tuple[str, str], str] = field(default_factory=dict)
    cached_kinds: dict[tuple[str, str, bool], str] = field(default_factory=dict)
    cached_counts: dict[str, str] = field(default_factory=dict)

    def write_tree(self, page: Page, root: str) -> str:
        """Write the tree for a page. Trees that differ only in the marked page are made once."""
        ancestry = self._ancestry_of(page.anchor)
        # Unless the list below the page right below the start page is long, a tree depends on that page only, and
        # hundreds of pages share it: of a long list of a kind it shows this page.
        is_special = self._is_long(ancestry[-1], ancestry) or self._opens_further(ancestry)
        key = (root, ancestry if is_special else ancestry[-1:], self._shows_branch(ancestry))
        if key not in self.cached_html:
            self.cached_html[key] = "\n".join(
                self._write_kind(kind, title, ancestry, root) for kind, title in self.kinds
            )
        address = f'href="{root}{self.links.pages[page.anchor]}"'
        # The first hit is the page's own entry: only the start page may be linked to again, further down.
        return self.cached_html[key].replace(address, f'{address} aria-current="page"', 1)

    def page_crumbs(self, page: Page, root: str) -> list[tuple[str, str | None]]:
        """Return the path from the start page: titles, with addresses where there is such a page."""
        crumbs = ((title, self.links.pages.get(anchor)) for title, anchor in page.crumbs)
        return [(title, None if path is None else root + path) for title, path in crumbs]

    def _ancestry_of(self, anchor: str) -> tuple[str, ...]:
        """Return the anchors from this page up to the one right below the start page."""
        ancestry = [anchor]
        # `not in way`: crumbs come from views, and a circle in them must not hang the build.
        while (parent := self.parents.get(anchor)) and parent in self.parents and parent not in ancestry:
            ancestry.append(anchor := parent)
        return tuple(ancestry)

    def _is_long(self, list_name: str, ancestry: tuple[str, ...]) -> bool:
        """Return whether a list is too long to be shown in full to a reader here."""
        length = len(self.children.get(list_name, ()))
        return length > MAX_LISTED or (length > 1 and self._shows_branch(ancestry))

    def _shows_branch(self, ancestry: tuple[str, ...]) -> bool:
        """Return whether a page shows only its own branch of the tree."""
        return len(self.pages) > MAX_TREE_PAGES and any(
            len(self.children.get(self._list_of(self.pages[anchor]), ())) > MAX_LISTED for anchor in ancestry
        )

    def _visible_pages(self, list_name: str, ancestry: tuple[str, ...]) -> Sequence[Page]:
        """Return a list as the tree shows it: all of it, or if it is too long, what leads to the reader's page."""
        if not self._is_long(list_name, ancestry):
            return self.children.get(list_name, ())
        return [page for anchor in ancestry if self._list_of(page := self.pages[anchor]) == list_name]

    def _list_of(self, page: Page) -> str:
        """Return the name of the list that a page stands in."""
        parent = self.parents.get(page.anchor)
        return f"kind {page.kind}" if parent is None or self.links.pages[parent] == self.start else parent

    def _write_kind(self, kind: str, title: str, ancestry: tuple[str, ...], root: str) -> str:
        """Write the list of a kind. It is the same for all readers in a folder who are not below one of its pages."""
        if any(self._list_of(self.pages[anchor]) == f"kind {kind}" for anchor in ancestry):
            return self._write_new_kind(kind, title, ancestry, root)
        key = (root, kind, self._shows_branch(ancestry))
        if key not in self.cached_kinds:
            self.cached_kinds[key] = self._write_new_kind(kind, title, ancestry, root)
        return self.cached_kinds[key]

    def _write_new_kind(self, kind: str, title: str, ancestry: tuple[str, ...], root: str) -> str:
        list_name = f"kind {kind}"
        items = [self._write_entry(page, ancestry, root) for page in self._visible_pages(list_name, ancestry)]
        if self._is_long(list_name, ancestry):
            hidden_count = len(self.children[list_name]) - len(items)
            listing = self.pages.get("page:groups") if kind == "groups" else None
            target, place = (listing.path, "one page") if listing else (self.start, "the start page")
            count = f"{hidden_count} more" if items else f"All {hidden_count}"
            items.append(f'<li><a href="{root}{target}">{count} on {place}</a></li>')
        heading = f"<h2>{escape_html(title)}</h2>\n" if title else ""
        return f"{heading}<ul>\n{NEWLINE.join(items)}\n</ul>" if items else ""

    def _write_entry(self, page: Page, ancestry: tuple[str, ...], root: str) -> str:
        """Write an entry. The one that leads to the reader's page has its own list below it, others its length."""
        if page.anchor == ancestry[-1]:
            return self._write_new_entry(page, ancestry, root)
        # All others are the same on each page of a folder.
        key = (root, page.anchor)
        if key not in self.cached_entries:
            self.cached_entries[key] = self._write_new_entry(page, ancestry, root)
        return self.cached_entries[key]

    def _write_new_entry(self, page: Page, ancestry: tuple[str, ...], root: str) -> str:
        mark = _write_marks(page)
        child_counts = self._count_children(page.anchor)
        count = f' <span class="count" aria-hidden="true">{child_counts}</span>' if child_counts else ""
        visible_children = self._visible_pages(page.anchor, ancestry) if page.anchor == ancestry[-1] else ()
        items = NEWLINE.join(self._write_child(child, ancestry, root) for child in visible_children)
        inner = f"\n<ul>\n{items}\n</ul>\n" if items else ""
        return f"<li>{self._write_link(page, root, f'{mark}{count}')}{inner}</li>"

    def _opens_further(self, ancestry: tuple[str, ...]) -> bool:
        """Whether the tree opens more than the page right below the start page: a component that holds others."""
        return any(self.pages[each].kind == _NESTED_KIND and self.children.get(each) for each in ancestry[:-1])

    def _write_child(self, page: Page, ancestry: tuple[str, ...], root: str) -> str:
        """Write an entry further down. A component that holds others is open where the reader is in it."""
        items: list[str] = []
        if page.kind == _NESTED_KIND and page.anchor in ancestry:
            items = [self._write_child(child, ancestry, root) for child in self._visible_pages(page.anchor, ancestry)]
        inner = f"\n<ul>\n{NEWLINE.join(items)}\n</ul>\n" if items else ""
        return f"<li>{self._write_link(page, root, _write_marks(page))}{inner}</li>"

    def _count_children(self, anchor: str) -> str:
        """Return how many pages are below a page, counted once: there may be thousands, and each shows its parent."""
        if anchor not in self.cached_counts:
            self.cached_counts[anchor] = _count_by_kind(self.children.get(anchor, ()))
        return self.cached_counts[anchor]

    def _write_link(self, page: Page, root: str, suffix: str = "") -> str:
        path = self.links.pages[page.anchor]
        title = self.home_title if path == self.start else page.title
        return f'<a href="{root}{path}">{escape_breakable(title)}{suffix}</a>'


def _write_marks(page: Page) -> str:
    """Write the marks of an entry: how it stands, and whether it has changed."""
    mark = html_text.write_mark(page.mark) if page.mark else ""
    return mark + html_text.write_mark("changed") if page.is_changed else mark


def _count_by_kind(pages: Sequence[Page]) -> str:
    """Count pages, each kind of its own as in the statistics: `5 + 3` for hosts and containers."""
    counts = Counter(page.kind for page in pages if page.kind not in UNCOUNTED_KINDS)
    return " + ".join(map(str, counts.values()))


def build_navigation(pages: Sequence[Page], links: SiteLinks, kinds: Sequence[tuple[str, str]]) -> SiteNavigation:
    """Build the navigation of a site. Kinds that `kinds` does not name come last, under their own name."""
    anchors = {page.anchor for page in pages}
    start = pages[0].anchor
    parents: dict[str, str] = {}
    children: dict[str, list[Page]] = {}
    kind_titles = dict(kinds)
    parent_anchors = {page.crumbs[-1][1] for page in pages if page.crumbs}
    for page in pages:
        parent = page.crumbs[-1][1] if page.crumbs else start
        if page.anchor != start:
            parents[page.anchor] = parent if parent in anchors else start
        if page.is_empty and page.anchor not in parent_anchors:
            continue
        if page.anchor == start or parents[page.anchor] == start:
            kind_titles.setdefault(page.kind, page.kind.replace("_", " ").capitalize())
            children.setdefault(f"kind {page.kind}", []).append(page)
        else:
            children.setdefault(parents[page.anchor], []).append(page)
    home_title = next((title for page in pages for title, anchor in page.crumbs if anchor == start), pages[0].title)
    return SiteNavigation(
        tuple(kind_titles.items()),
        children,
        parents,
        links.pages[start],
        home_title,
        links,
        {page.anchor: page for page in pages},
    )
