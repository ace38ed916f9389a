"""A drawn picture, in every format that documents and pages need."""

from __future__ import annotations

from archgen.frozen import dataclass


@dataclass(frozen=True, slots=True)
class Picture:
    """One graph, drawn. Sizes are in points (1/72 inch).

    `svg` has links, tooltips and text as text. `svg_outlines` has text as outlines: it needs no font, and has no links.
    Formats that were not asked for are None. `warning` says what could not be drawn as asked. The fields are called as
    the formats are: writers and the cache read them by name.
    """

    id: str
    width: float
    height: float
    svg: bytes | None = None
    svg_outlines: bytes | None = None
    png: bytes | None = None
    pdf: bytes | None = None
    dot: str = ""
    warning: str | None = None
