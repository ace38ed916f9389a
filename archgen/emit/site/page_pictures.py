"""Write pictures into pages, and as files of their own: links lead to pages, colours follow light and dark.

The SVGs come from archgen's own drawing, which escapes all text, so their tags can be found without parsing: an
attribute holds no bare `<` or `>`. Whatever an address says, only one that leads to a page or the web stays.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from html import unescape
from urllib.parse import unquote

from archgen.emit.safe_names import make_safe_path
from archgen.emit.site.html_text import escape_html, web_address

HrefResolver = Callable[[str], str | None]

_HEAD = re.compile(r"\A.*?(?=<svg\b)", re.DOTALL)
_COMMENT = re.compile(r"<!--.*?-->\s*", re.DOTALL)
_SVG = re.compile(r"<svg\b([^>]*)>(?:\s*<(title|desc)>[^<]*</\2>)*")
_ROOT = re.compile(r"<svg\b[^>]*>")
_UNUSED = re.compile(r'\s(?:xmlns(?::\w+)?|role|aria-\w+)="[^"]*"')
_LINK = re.compile(r"<a\b([^>]*)>|</a>")
_TARGET = re.compile(r'(?:xlink:)?href="([^"]*)"')
_TIP = re.compile(r'xlink:title="([^"]*)"')
_ID = re.compile(r'<(g|a|svg) id="[^"]*"')
_SIZE = re.compile(r'\s(width|height)="([0-9.]+)(?:pt|px)?"')


def picture_path(picture_id: str) -> str:
    """Return the path of a picture's own file in the site."""
    return make_safe_path(f"figures/{picture_id}.svg")


def inline_svg(svg: bytes, resolve_href: HrefResolver, name: str) -> str:
    """Return the SVG element for a page. `name` (escaped) takes the place of the picture's own title and description.

    Ids are removed: several pictures may be on one page, and nothing refers to them.
    """
    text = _COMMENT.sub("", _HEAD.sub("", svg.decode("utf-8"), count=1))
    text = write_picture_signs(_resolve_links(_ID.sub(r"<\1", text), resolve_href))
    return _SVG.sub(
        lambda found: f'<svg{_keep_attributes(found[1])} role="group" aria-label="{name}">', text, count=1
    ).strip()


def standalone_svg(svg: bytes, resolve_href: HrefResolver, style: str = "") -> bytes:
    """Return a picture as a file of its own: as drawn, with its links and, where one is given, a style."""
    text = _HEAD.sub('<?xml version="1.0" encoding="UTF-8"?>\n', svg.decode("utf-8"), count=1)
    text = _resolve_links(_COMMENT.sub("", text), resolve_href)
    if not style:
        return text.encode()
    return _ROOT.sub(lambda found: f"{found.group()}\n<style>{style}</style>", text, count=1).encode()


def write_picture_signs(text: str) -> str:
    """Write the signs of comparisons in a picture's texts as pages do: they take less room than what was laid out."""
    return text.replace("&lt;= ", "≤ ").replace("&gt;= ", "≥ ")


def _keep_attributes(attributes: str) -> str:
    """Keep the attributes that HTML needs, with the size in pixels (a point is 4/3 of one)."""
    return _SIZE.sub(lambda found: f' {found[1]}="{float(found[2]) * 4 / 3:.0f}"', _UNUSED.sub("", attributes))


def _resolve_links(text: str, resolve_href: HrefResolver) -> str:
    """Resolve all links. A link that leads nowhere becomes a group, so that its tooltip stays."""
    open_tags: list[str] = []

    def replace(match: re.Match[str]) -> str:
        if match[1] is None:
            return open_tags.pop() if open_tags else ""
        target = _TARGET.search(match[1])
        tip = _TIP.search(match[1])
        title = f"<title>{tip[1]}</title>" if tip else ""
        address = target and _resolve_address(unescape(target[1]), resolve_href)
        # A stack, since the closing tag must match what became of the opening one.
        open_tags.append("</a>" if address else "</g>")
        return f'<a href="{address}">{title}' if address else f"<g>{title}"

    return _LINK.sub(replace, text)


def _resolve_address(target: str, resolve_href: HrefResolver) -> str | None:
    """Return the escaped address that a link's target means: `#` and an anchor, or an address of the web."""
    if target.startswith("#"):
        href = resolve_href(unquote(target[1:]))
        return escape_html(href) if href else None
    return web_address(target)


def embedded_style() -> str:
    """Return the style of pictures in pages: dark where the reader or the system wants it, light on paper."""
    chosen, system = _dark_style(":root[data-theme=dark]"), _dark_style(":root:not([data-theme=light])")
    return f"@media screen {{\n{chosen}@media (prefers-color-scheme: dark) {{\n{system}}}\n}}\n"


@cache
def standalone_style(root: str) -> str:
    """Return the style of a picture's own file: the fonts that it was laid out with, and the dark colours."""
    faces = "".join(
        f'@font-face{{font-family:"{family}";font-weight:{weight};src:local("{local}"),url({root}assets/fonts/{file})}}'
        for family, weight, local, file in (
            ("Inter", 400, "Inter Regular", "inter-regular.ttf"),
            ("Inter", 700, "Inter Bold", "inter-bold.ttf"),
            ("DejaVu Sans", 400, "DejaVu Sans", "dejavusans.ttf"),
            ("DejaVu Sans", 700, "DejaVu Sans Bold", "dejavusans-bold.ttf"),
        )
    )
    return f"{faces}@media screen and (prefers-color-scheme:dark){{svg{{background:#14181c}}{_dark_style('').replace(chr(10), '')}}}"


def _dark_style(scope: str) -> str:
    """Return the rules that turn a picture dark: its colours, and text without a colour (which is black)."""
    from archgen.emit.graphviz.palette import dark_rules

    return f"{dark_rules(scope)}{scope} svg.archgen text:not([fill]){{fill:#e6eaee}}\n"
