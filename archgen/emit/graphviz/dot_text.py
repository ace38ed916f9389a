r"""Prepare text for DOT: clean it of what pictures cannot hold, escape it for its place, wrap it to fit a box.

Titles come from files that anybody may have written. In an html-like label `&`, `<` and `>` are markup and `\N` is replaced
by Graphviz; in a quoted string `"` ends it, and a character reference would be read as one. Both are escaped here and
nowhere else. Control characters make an SVG that is not XML, and the marks that turn the direction of writing make a text
look like another: neither gets into a picture.

Texts that nobody sees in a drawing (tooltips, addresses, the description) are kept out of it until the picture is read: it
is cached by what is visible, with marks for the rest, so that a changed description draws nothing anew.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping, Sequence
from functools import lru_cache
from html import escape
from operator import attrgetter

from archgen.emit.picture import Picture
from archgen.frozen import dataclass, field, fields, replace
from archgen.views.picture_shapes import Arrow, Box, Cluster, Drawing, Graph
from archgen.views.short_figures import write_comparisons

MAX_TEXT_LENGTH = 400
"""A longer text (in characters) is cut, with an ellipsis; pages and tables have all of it."""

_BLANKS = re.compile(r"\s+")
_UNFIT_CHARACTER = re.compile(
    "[\x00-\x1f\x7f-\x9f\u061c\u200b\u200e\u200f\u2028-\u202e\u2060-\u206f\ud800-\udfff\ufeff\ufff0-\uffff]"
)
_SCHEME = re.compile(r"([A-Za-z][A-Za-z0-9+.-]*):")
_BREAKS = (re.compile(r"(?=/)"), re.compile(r"(?<=[-_.:,;])"))
_ESCAPES = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\\": "&#92;"})


def clean_label_text(text: str, max_length: int = MAX_TEXT_LENGTH) -> str:
    """Return the text on one line, without characters that no picture can hold, cut at `max_length`."""
    text = write_comparisons(text)
    # Of all blanks only the space is printable: most texts have nothing to clean.
    if text.isprintable() and "  " not in text:
        text = text.strip()
        return text if len(text) <= max_length else text[: max_length - 1] + "…"
    text = _BLANKS.sub(" ", text)
    if not text.isprintable():
        # Category Cn: unassigned characters, and noncharacters, which XML does not allow.
        text = "".join(c for c in _UNFIT_CHARACTER.sub("", text) if unicodedata.category(c) != "Cn")
    text = text.strip()
    return text if len(text) <= max_length else text[: max_length - 1] + "…"


def escape_label(text: str) -> str:
    """Escape one line of text for an html-like label."""
    return clean_label_text(text).translate(_ESCAPES) or "\u00a0"


def quote_value(text: str) -> str:
    """Quote a value for DOT. Line feeds stay line feeds."""
    lines = (clean_label_text(line, 4000) for line in text.split("\n"))
    # Graphviz reads `&lt;` in a quoted string as a character reference, so `&` is escaped here too.
    escaped = (line.replace("&", "&amp;").replace("\\", "\\\\").replace('"', '\\"') for line in lines)
    return '"' + "\\n".join(escaped) + '"'


def safe_address(href: str) -> str:
    """Return an address that is safe to follow (relative, http, https, mailto), or an empty text."""
    # Cleaned before the scheme is looked at: browsers drop tabs and line feeds, so a scheme may be hidden by them.
    href = _BLANKS.sub("%20", _UNFIT_CHARACTER.sub("", href).strip())
    scheme = _SCHEME.match(href)
    if scheme and scheme[1].lower() not in {"http", "https", "mailto"}:
        return ""
    return href


def wrap_text(text: str, width: int, lines: int = 4) -> tuple[str, ...]:
    """Wrap a text into lines of about `width` characters, wider only where it would take more than `lines` lines."""
    text = clean_label_text(text)
    width = max(width, -(-len(text) // lines))
    rows = [""]
    # Where a line may end: after blanks; in longer words before `/`, then after other signs; else anywhere.
    for piece in (piece for word in re.findall(r"\S+\s*", text) for piece in _cut_word(word, width, _BREAKS)):
        if rows[-1] and len(rows[-1]) + len(piece.rstrip()) > width:
            rows.append("")
        rows[-1] += piece
    return tuple(row.strip() for row in rows if row.strip()) or ("",)


def _cut_word(word: str, width: int, breaks: Sequence[re.Pattern[str]]) -> list[str]:
    if len(word.rstrip()) <= width:
        return [word]
    if not breaks:
        return [word[at : at + width] for at in range(0, len(word), width)]
    return [piece for part in breaks[0].split(word) if part for piece in _cut_word(part, width, breaks[1:])]


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
