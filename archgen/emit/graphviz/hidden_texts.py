"""Keep texts that nobody sees in a drawing out of it until it is drawn: tooltips, addresses, the description.

A picture is cached by what is visible. Marks stand for the rest, and the texts take their place when the picture is
read: a changed description of a component draws nothing anew.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import lru_cache
from html import escape
from operator import attrgetter

from archgen.emit.graphviz.dot_text import clean_label_text, quote_value, safe_address
from archgen.emit.picture import Picture
from archgen.frozen import dataclass, field, fields, replace
from archgen.views.picture_shapes import Arrow, Box, Cluster, Drawing, Graph

_ALT = "archgen.alt"
_SVG_LINK = re.compile(r'<a xlink:href="archgen\.link/([bac][0-9]+)"([^>]*)>\n(.*?)</a>\n', re.DOTALL)
_SVG_TIP = re.compile(r"<title>archgen\.tip/([bac][0-9]+)</title>\n")
_SVG_ALT = re.compile(rf"<desc>{re.escape(_ALT)}</desc>\n")
_DOT_LINK = re.compile(r'URL="archgen\.link/([bac][0-9]+)" target="_top" ?')
_DOT_TIP = re.compile(r'"archgen\.tip/([bac][0-9]+)"')
_MAX_ALT = 4000


def _read_visible(shape: type, *hidden_fields: str) -> attrgetter[tuple[object, ...]]:
    """Return the function that reads the fields of a shape that are drawn."""
    return attrgetter(*(each.name for each in fields(shape) if each.name not in hidden_fields))


_VISIBLE_OF_GRAPH = _read_visible(Graph, "boxes", "arrows", "clusters", "alt")
_VISIBLE_OF_BOX = _read_visible(Box, "ref", "tooltip")
_VISIBLE_OF_ARROW = _read_visible(Arrow, "ref", "flows")
_VISIBLE_OF_CLUSTER = _read_visible(Cluster, "ref", "tooltip")


@dataclass(frozen=True, slots=True)
class HiddenTexts:
    """What nobody sees of a drawing, by the marks that take its place."""

    drawing: Drawing
    """As it was."""
    links: Mapping[str, str]
    """The addresses of a chart, by ref; the marks take the places of a graph's."""
    tips: Mapping[str, str] = field(default_factory=dict)
    addresses: Mapping[str, str] = field(default_factory=dict)

    @property
    def alt(self) -> str:
        """What the picture shows, in words."""
        return self.drawing.alt

    def describe_visible(self) -> str:
        """Describe all that is seen of the drawing: what a picture is cached by."""
        if not isinstance(self.drawing, Graph):
            return f"{self.drawing!r}\n{sorted(self.links.items())!r}"
        graph = self.drawing
        # Tuples of fields, not copies of the shapes without their texts: those take five times as long to make. `repr`
        # is the same in every process (shapes have tuples, no sets). Whether there is a description shows nowhere.
        visible_marks = (
            list(map(_VISIBLE_OF_BOX, graph.boxes)),
            list(map(_VISIBLE_OF_ARROW, graph.arrows)),
            list(map(_VISIBLE_OF_CLUSTER, graph.clusters)),
        )
        return f"{_VISIBLE_OF_GRAPH(graph)!r}\n{visible_marks!r}"

    def mark_drawing(self) -> tuple[Drawing, Mapping[str, str]]:
        """Return the drawing with marks for what nobody sees, and the addresses to draw it with, by ref."""
        drawing = self.drawing
        if not isinstance(drawing, Graph):
            return drawing, self.links
        boxes = tuple(replace(box, ref=f"b{at}", tooltip=f"archgen.tip/b{at}") for at, box in enumerate(drawing.boxes))
        arrows = tuple(
            replace(arrow, ref=f"a{at}", flows=(f"archgen.tip/a{at}",)) for at, arrow in enumerate(drawing.arrows)
        )
        clusters = tuple(
            replace(cluster, ref=f"c{at}", tooltip=f"archgen.tip/c{at}") for at, cluster in enumerate(drawing.clusters)
        )
        hidden_drawing = replace(drawing, boxes=boxes, arrows=arrows, clusters=clusters, alt=_ALT)
        return hidden_drawing, {mark: f"archgen.link/{mark}" for mark in self.tips}

    def restore_texts(self, picture: Picture, *, with_dot: bool) -> Picture:
        """Return a picture with the texts in the places of their marks; its source only `with_dot`: few ask for it."""
        if not self.tips:
            return picture if with_dot else replace(picture, dot="")
        svg = picture.svg if picture.svg is None else self._restore_svg(picture.svg.decode()).encode()
        return replace(picture, svg=svg, dot=self._restore_dot(picture.dot) if with_dot else "")

    def _restore_dot(self, dot: str) -> str:
        dot = _DOT_LINK.sub(self._write_dot_link, dot)
        return _DOT_TIP.sub(lambda match: quote_value(self.tips[match[1]]), dot)

    def _restore_svg(self, svg: str) -> str:
        svg = _SVG_LINK.sub(self._write_svg_link, svg)
        svg = _SVG_TIP.sub(lambda match: f"<title>{_escape_tip(self.tips[match[1]])}</title>\n", svg)
        description = f"<desc>{escape(clean_label_text(self.alt, _MAX_ALT))}</desc>\n" if self.alt else ""
        return _SVG_ALT.sub(lambda _: description, svg, count=1)

    def _write_svg_link(self, match: re.Match[str]) -> str:
        mark, attributes, inner = match.groups()
        address = self.addresses.get(mark)
        return f'<a xlink:href="{escape(address)}"{attributes}>\n{inner}</a>\n' if address else inner

    def _write_dot_link(self, match: re.Match[str]) -> str:
        address = self.addresses.get(match[1])
        return f'URL={quote_value(address)} target="_top" ' if address else ""


@lru_cache(65536)
def _escape_tip(text: str) -> str:
    """Escape a tooltip; line feeds as references, as Graphviz writes them."""
    return "&#10;".join(escape(clean_label_text(line, _MAX_ALT)) for line in text.split("\n"))


def hide_texts(drawing: Drawing, links: Mapping[str, str]) -> HiddenTexts:
    """Find a graph's tooltips and addresses: only svg and dot have them, PNG and PDF have none.

    Charts stay as they are: they have few.
    """
    if not isinstance(drawing, Graph):
        return HiddenTexts(drawing, links)
    tips: dict[str, str] = {}
    addresses: dict[str, str] = {}
    marked_items: tuple[tuple[str, Sequence[Box | Arrow | Cluster]], ...] = (
        ("b", drawing.boxes),
        ("a", drawing.arrows),
        ("c", drawing.clusters),
    )
    for letter, items in marked_items:
        for at, item in enumerate(items):
            mark = f"{letter}{at}"
            tips[mark] = _tip_of(item)
            address = safe_address(links.get(item.ref, "")) if item.ref else ""
            if address:
                addresses[mark] = address
    return HiddenTexts(drawing, {}, tips, addresses)


def _tip_of(item: Box | Arrow | Cluster) -> str:
    if isinstance(item, Arrow):
        return "\n".join(item.flows) or item.label or "flow"
    return item.tooltip or "\n".join((item.title, *item.lines))
