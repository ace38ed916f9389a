"""One page of the site by itself, for a reader who waits for it: without all others."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from itertools import chain

from archgen.views.changes.site_changes import mark_page
from archgen.views.lookup import Lookup
from archgen.views.pages import (
    context_pages,
    host_pages,
    matrix_pages,
    page_marks,
    page_parts,
    partner_pages,
    requirement_pages,
)
from archgen.views.pages.report_outline import DocumentEdition
from archgen.views.pages.site_pages import PageMaker
from archgen.views.shapes import Page, split_anchor


def make_page_at(lookup: Lookup, edition: DocumentEdition, anchor: str) -> Page | None:
    """Make the page of an anchor as `make_pages` does, but for its path, which takes all pages to know; None where there
    is none.
    """
    page = next((page for page in _list_candidates(PageMaker(lookup, edition), anchor) if page.anchor == anchor), None)
    if page is None:
        return None
    marked_pages = page_marks.mark_pages(lookup, (page,))
    if edition.changes:
        marked_pages = tuple(mark_page(each, edition.changes) for each in marked_pages)
    return page_parts.place_pages(lookup, marked_pages)[0]


def _list_candidates(page_maker: PageMaker, anchor: str) -> Iterable[Page]:  # noqa: PLR0911 - one for each kind
    """Return pages of which one may be that of the anchor: as few as can be where there are many of a kind."""
    architecture, lookup = page_maker.architecture, page_maker.lookup
    kind, name = split_anchor(anchor)
    match kind:
        case "component" if name in architecture.components or name in architecture.shells:
            return (page_maker.component_pages().make_single_page(name),)
        case "group" if name in architecture.groups:
            return (page_maker.component_pages().make_group_page(architecture.groups[name]),)
        case "node" if name in architecture.nodes and page_maker.edition.level == "implementation":
            return (page_maker.make_node_page(architecture.nodes[name]),)
        case "topic" | "channel" if page_maker.edition.level == "implementation":
            return context_pages.make_topic_pages(lookup)
        case "chapter":
            return page_maker.chapter_pages()
        case "rule":
            return page_maker.rule_pages()
        case "chain":
            return page_maker.chain_pages()
        case "timing" | "page" if kind == "timing" or name in {"timing", "chains"}:
            return page_maker.timing_pages()
        case "component" | "group" | "node" | "topic" | "channel":
            return ()
        case _:
            start_page = (page_maker.start_page(),) if anchor == "page:index" else ()
            # Generators: no further page is made when the one looked for is there.
            return chain(
                start_page,
                _UntimedPageMaker(lookup, page_maker.edition).spanning_pages() if kind == "page" else (),
                page_maker.component_pages().list_type_pages() if kind in {"page", "component_type"} else (),
                _make_surrounding_pages(page_maker, kind),
            )


def _make_surrounding_pages(page_maker: PageMaker, kind: str) -> Iterator[Page]:
    """Make the pages on what stands around the elements, one kind after the other, first those where the kind is at home."""
    lookup, edition = page_maker.lookup, page_maker.edition
    makers: tuple[tuple[tuple[str, ...], Callable[[], Iterable[Page]]], ...] = (
        ((), lambda: context_pages.make_context_pages(lookup, page_maker.keep_drawn)),
        (("host",), lambda: host_pages.make_host_pages(lookup, page_maker.keep_drawn)),
        (("requirement",), lambda: requirement_pages.make_requirement_pages(lookup)),
        (("variant",), page_maker.variant_pages),
        ((), lambda: matrix_pages.make_matrix_pages(lookup, with_nodes=edition.level == "implementation")),
        (("message",), lambda: page_maker.message_pages().make_pages()),
        (
            ("partner", "pair", "interface", "late", "todo"),
            lambda: partner_pages.make_partner_pages(
                lookup,
                page_maker.keep_drawn,
                edition.signed_tags,
                edition.changes.comparison if edition.changes else None,
            ),
        ),
    )
    for _, make_pages in sorted(makers, key=lambda each: kind not in each[0]):
        yield from make_pages()


class _UntimedPageMaker(PageMaker):
    """Makes pages as its base does, without those on timing: they are the dearest, and stand between the others."""

    def timing_pages(self) -> Iterator[Page]:
        """Make no page."""
        yield from ()
