"""Keep texts that nobody sees in a drawing out of it until it is drawn: tooltips, addresses, the description.

A picture is cached by what is visible. Marks stand for the rest, and the texts take their place when the picture is
read: a changed description of a component draws nothing anew.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from html import escape

from archgen.emit.graphviz.dot_text import clean_label_text, quote_value, safe_address
from archgen.emit.picture import Picture
from archgen.views.chart_shapes import Drawing
from archgen.views.graph_shapes import Arrow, Box, Cluster, Graph

_ALT = "archgen.alt"
_SVG_LINK = re.compile(r'<a xlink:href="archgen\.link/([bac][0-9]+)"([^>]*)>\n(.*?)</a>\n', re.DOTALL)
_SVG_TIP = re.compile(r"<title>archgen\.tip/([bac][0-9]+)</title>\n")
_SVG_ALT = re.compile(rf"<desc>{re.escape(_ALT)}</desc>\n")
_DOT_LINK = re.compile(r'URL="archgen\.link/([bac][0-9]+)" target="_top" ?')
_DOT_TIP = re.compile(r'"archgen\.tip/([bac][0-9]+)"')
_MAX_ALT = 4000


@dataclass(frozen=True, slots=True)
class HiddenTexts:
    """A drawing with marks for what nobody sees, and what stands behind the marks."""

    drawing: Drawing
    links: Mapping[str, str]
    """The addresses to draw with, by ref."""
    tips: Mapping[str, str] = field(default_factory=dict)
    addresses: Mapping[str, str] = field(default_factory=dict)
    alt: str = ""

    def restore_texts(self, picture: Picture) -> Picture:
        """Return a picture with the texts in the places of their marks."""
        if not self.tips:
            return picture
        svg = picture.svg if picture.svg is None else self._restore_svg(picture.svg.decode()).encode()
        dot = _DOT_LINK.sub(self._write_dot_link, picture.dot)
        dot = _DOT_TIP.sub(lambda found: quote_value(self.tips[found[1]]), dot)
        return replace(picture, svg=svg, dot=dot)

    def _restore_svg(self, svg: str) -> str:
        svg = _SVG_LINK.sub(self._write_svg_link, svg)
        svg = _SVG_TIP.sub(lambda found: f"<title>{_escape_tip(self.tips[found[1]])}</title>\n", svg)
        description = f"<desc>{escape(clean_label_text(self.alt, _MAX_ALT))}</desc>\n" if self.alt else ""
        return _SVG_ALT.sub(lambda _: description, svg, count=1)

    def _write_svg_link(self, found: re.Match[str]) -> str:
        mark, attributes, inner = found.groups()
        address = self.addresses.get(mark)
        return f'<a xlink:href="{escape(address)}"{attributes}>\n{inner}</a>\n' if address else inner

    def _write_dot_link(self, found: re.Match[str]) -> str:
        address = self.addresses.get(found[1])
        return f'URL={quote_value(address)} target="_top" ' if address else ""


def _escape_tip(text: str) -> str:
    """Escape a tooltip; line feeds as references, as Graphviz writes them."""
    return "&#10;".join(escape(clean_label_text(line, _MAX_ALT)) for line in text.split("\n"))


def hide_texts(drawing: Drawing, links: Mapping[str, str]) -> HiddenTexts:
    """Put marks in the places of a graph's tooltips and addresses: only svg and dot have them, PNG and PDF have none.

    Charts stay as they are: they have few.
    """
    if not isinstance(drawing, Graph):
        return HiddenTexts(drawing, links)
    marked = dict(_iterate_marks(drawing))
    tips = {mark: _tip_of(item) for mark, item in marked.items()}
    hidden_links = {mark: f"archgen.link/{mark}" for mark in marked}
    addresses = {
        mark: address
        for mark, item in marked.items()
        if item.ref and (address := safe_address(links.get(item.ref, "")))
    }
    hidden_drawing = replace(
        drawing,
        boxes=tuple(replace(box, ref=f"b{at}", tooltip=f"archgen.tip/b{at}") for at, box in enumerate(drawing.boxes)),
        arrows=tuple(
            replace(arrow, ref=f"a{at}", flows=(f"archgen.tip/a{at}",)) for at, arrow in enumerate(drawing.arrows)
        ),
        clusters=tuple(
            replace(cluster, ref=f"c{at}", tooltip=f"archgen.tip/c{at}") for at, cluster in enumerate(drawing.clusters)
        ),
        alt=_ALT,
    )
    return HiddenTexts(hidden_drawing, hidden_links, tips, addresses, drawing.alt)


def _iterate_marks(graph: Graph) -> Iterator[tuple[str, Box | Arrow | Cluster]]:
    yield from ((f"b{at}", box) for at, box in enumerate(graph.boxes))
    yield from ((f"a{at}", arrow) for at, arrow in enumerate(graph.arrows))
    yield from ((f"c{at}", cluster) for at, cluster in enumerate(graph.clusters))


def _tip_of(item: Box | Arrow | Cluster) -> str:
    if isinstance(item, Arrow):
        return "\n".join(item.flows) or item.label or "flow"
    return item.tooltip or "\n".join((item.title, *item.lines))
