"""Values that the rows of several tables have: where an element stands, where it is written, the begin of its description."""

from __future__ import annotations

from archgen.diagnostics.source_span import Span
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.component_nesting import list_surrounding
from archgen.views.element_references import place_run
from archgen.views.explorer.map_places import Path
from archgen.views.explorer.map_shapes import Row
from archgen.views.lookup import Lookup
from archgen.views.search.search_entry import to_plain_text

_MAX_SUMMARY = 280
"""Letters of a description that the panel shows; the element's page has all of it."""


def list_path(architecture: Architecture, component: Component) -> Path:
    """Return what is around one of the architecture's `components` on the map, and itself."""
    # What is not designed yet of a composed one stands inside of its frame, under the same id.
    own_frame = (component.id,) if component.id in architecture.shells else ()
    return (component.group, *list_surrounding(architecture, component.id), *own_frame, component.id)


def list_places(lookup: Lookup, span: Span) -> Row:
    """Return file and line of an element, with its address where a repository is configured; empty for no place."""
    place = place_run(lookup, span)
    return tuple(filter(None, (place.text, place.url))) if place else ()


def shorten_text(*texts: str | None) -> str:
    """Return the begin of a description, on one line."""
    text = to_plain_text(*texts)
    return text if len(text) <= _MAX_SUMMARY else f"{text[:_MAX_SUMMARY].rsplit(' ', 1)[0]} …"
