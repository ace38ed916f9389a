"""Clean up Graphviz's svg for a page: no prologue, real titles, ids of its own, a name and a description.

Hooks for a page's style: the root has the class `archgen`; its parts are `.box`, `.frame`, `.arrow`, `.label`,
`.title`, `.legend`, `.badge`, `.bar`, with the style, emphasis, status and hue (`hue0` to `hue9`) as further classes.
Colours are presentation attributes, so that any rule of the page wins over them; `palette.dark_rules` writes the rules
that turn them dark. Tooltips are `title` elements. Ids begin with the picture's id, so that several fit in one page.
"""

from __future__ import annotations

import re
from html import escape

from archgen.emit.graphviz.dot_text import clean_label_text
from archgen.emit.graphviz.glyph_outlines import shorten_glyphs
from archgen.views.chart_shapes import Drawing

_HEAD = re.compile(r"^.*?<svg ([^>]*)>", re.DOTALL)
_COMMENT = re.compile(r"<!--.*?-->\n?", re.DOTALL)
_ID = re.compile(r'(<g id=")([^"]*)(")')
_GROUP = re.compile(r'(<g id="[^"]*" class="(?:node|edge|cluster)[^"]*">\n)<title>[^<]*</title>\n')
_LINK = re.compile(
    r'<g id="[^"]*"><a (xlink:href="[^"]*" )?xlink:title="([^"]*)"([^>]*)>\n(.*?)</a>\n</g>\n', re.DOTALL
)
_DECIMALS = re.compile(rb"(\.[0-9]{2})[0-9]+")
_SURFACE = re.compile(rb"surface[0-9]+")
# The lookahead keeps the search inside of one edge's group: an edge without a path must not take the next one's.
_DRAWN = re.compile(r'<g id="(e[0-9]+)" class="edge[^"]*">(?:(?!</g>\n<).)*?<path', re.DOTALL)


def find_drawn_edges(svg: str) -> set[str]:
    """Return the ids of the edges that have a line."""
    return set(_DRAWN.findall(svg))


def clean_outlines(outlines: bytes) -> bytes:
    """Renumber cairo's surfaces from 1, since cairo goes on counting from one picture to the next in the same process,
    and keep two decimals: a hundredth of a point is less than any printer shows.
    """
    numbers: dict[bytes, bytes] = {}
    outlines = _SURFACE.sub(lambda found: numbers.setdefault(found[0], b"surface%d" % (len(numbers) + 1)), outlines)
    # Split at the digits that go, and joined: a replacement with a group in it is put together in Python, at seven times the time.
    return shorten_glyphs(b"".join(_DECIMALS.split(outlines)))


def clean_graphviz_svg(svg: str, drawing: Drawing) -> bytes:
    """Return the svg as a single element, without prologue and comments."""
    head = _HEAD.match(svg)
    if head is None:
        return svg.encode()
    prefix = re.sub(r"[^A-Za-z0-9_]+", "-", drawing.id)
    body = _COMMENT.sub("", svg[head.end() :])
    body = _LINK.sub(_write_title, _GROUP.sub(r"\1", body))
    body = re.sub(r"(<g id=\"graph0\"[^>]*>\n)<title>.*?</title>\n", r"\1", body, count=1)
    body = _ID.sub(lambda found: f"{found[1]}{prefix}-{found[2]}{found[3]}", body)
    name = f"<title>{escape(clean_label_text(drawing.title))}</title>\n"
    description = f"<desc>{escape(clean_label_text(drawing.alt, 4000))}</desc>\n" if drawing.alt else ""
    return f'<svg class="archgen" role="group" {head[1]}>\n{name}{description}{body.lstrip()}'.encode()


def _write_title(match: re.Match[str]) -> str:
    """Write a tooltip as a title element. Keep the link where there is an address."""
    href, tooltip, link_attributes, inner = match.groups()
    title = f"<title>{tooltip}</title>\n" if tooltip.strip() else ""
    return f"<a {href}{link_attributes.strip()}>\n{title}{inner}</a>\n" if href else f"{title}{inner}"
