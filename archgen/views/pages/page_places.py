"""Where the thing that a page is about is written: the line below the page's title says it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.frozen import replace
from archgen.language.language_tables import SECTION_KINDS
from archgen.model.architecture import Architecture
from archgen.model.made_elements import find_made_element
from archgen.views.element_references import place_run
from archgen.views.lookup import Lookup
from archgen.views.shapes import Page

_PLACELESS = frozenset({"types", "variants", "libraries"})
"""What ships with archgen is in none of the project's files, but in those of its packed form; variants are in several."""


def place_pages(lookup: Lookup, pages: Iterable[Page]) -> tuple[Page, ...]:
    """Return the pages, those on something that is written in a file with its place."""
    spans = _list_spans(lookup.architecture)
    return tuple(_place_page(lookup, page, spans[page.anchor]) if page.anchor in spans else page for page in pages)


def _place_page(lookup: Lookup, page: Page, place: Span) -> Page:
    placed_page = replace(page, place=place_run(lookup, place))
    made = find_made_element(lookup.architecture.made_elements, place)
    if made is None or not made.passes:
        return placed_page
    words = str(made).replace("`", "")
    is_phrase = bool(page.lead) and page.lead[-1].isalnum()
    lead = f"{page.lead}, {words}" if is_phrase else f"{page.lead} {words[0].upper()}{words[1:]}.".lstrip()
    return replace(placed_page, lead=lead)


def _list_spans(architecture: Architecture) -> Mapping[str, Span]:
    """Return where each element with a page is written, by the page's anchor."""
    kinds = [("component", architecture.components), ("component", architecture.shells)]
    kinds += [(kind, getattr(architecture, name)) for name, kind in SECTION_KINDS.items() if name not in _PLACELESS]
    spans = {f"{kind}:{name}": element.at for kind, elements in kinds for name, element in elements.items()}
    return {anchor: span for anchor, span in spans.items() if span is not NO_SPAN}
