"""Write the project's CommonMark as HTML: no HTML of its own, no request to anywhere, pictures copied to the site."""

from __future__ import annotations

import posixpath
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING
from urllib.parse import unquote

from archgen.emit.names import safe_path
from archgen.emit.site.links import Here
from archgen.emit.site.markup import escape, web
from archgen.views.shapes import Markdown

if TYPE_CHECKING:
    from markdown_it import MarkdownIt
    from markdown_it.token import Token

ChapterFiles = Callable[[str], bytes | None]
"""Returns a file of the project by its path (`/`, relative to the project), or None if there is none."""

_PICTURES = (
    (b"\x89PNG\r\n\x1a\n", ".png"),
    (b"\xff\xd8\xff", ".jpg"),
    (b"GIF8", ".gif"),
    (b"RIFF", ".webp"),
    (b"<svg", ".svg"),
    (b"<?xml", ".svg"),
)


@dataclass(frozen=True, slots=True)
class Chapters:
    """Writes CommonMark as HTML, and gathers the pictures that it needs (`files`: path in the site -> bytes)."""

    source: ChapterFiles
    files: dict[str, bytes] = field(default_factory=dict)
    known: dict[str, str | None] = field(default_factory=dict)

    def html(self, block: Markdown, level: int, here: Here) -> str:
        """Write a text below a heading of this level."""
        parser = _parser()
        tokens = parser.parse(block.text)
        _nest_headings(tokens, level)
        for token in tokens:
            self._inline(token.children or (), block.folder, here)
        return str(parser.renderer.render(tokens, parser.options, {}))

    def _inline(self, tokens: Sequence[Token], folder: str, here: Here) -> None:
        """Resolve where links and pictures lead. The render rules find the answer in the token's `meta`."""
        around: list[str] = []
        for token in tokens:
            if token.type == "link_open":
                around.append(_address(str(token.attrs.get("href", "")), folder, here))
                token.meta["address"] = around[-1]
            elif token.type == "link_close":
                token.meta["address"] = around.pop()
            elif token.type == "image":
                source = str(token.attrs.get("src", ""))
                file = self._copy(_joined(folder, unquote(source)))
                token.meta["source"] = here.root + file if file else ""
                # A picture of the web inside of a link becomes plain words: HTML has no link in a link.
                token.meta["address"] = "" if any(around) else web(source) or ""

    def _copy(self, path: str | None) -> str | None:
        """Copy a picture into the site. Return its path there, or None where there is no such picture."""
        if path is None:
            return None
        if path not in self.known:
            data = self.source(path)
            # By its first bytes, not by its name: a file called .png may hold HTML, which a browser would run.
            ending = data and next((end for start, end in _PICTURES if data.lstrip()[:8].startswith(start)), None)
            self.known[path] = self._keep(path, data, ending) if data and ending else None
        return self.known[path]

    def _keep(self, path: str, data: bytes, ending: str) -> str:
        stem = safe_path(f"pictures/{posixpath.splitext(path)[0]}")
        name, number = stem + ending, 2
        while name in self.files:
            name, number = f"{stem}-{number}{ending}", number + 1
        self.files[name] = data
        return name


def _joined(folder: str, path: str) -> str | None:
    """Return the path in the project that a relative address means, or None where it leaves the project."""
    if not path or "\\" in path or ":" in path.split("/", maxsplit=1)[0]:
        return None
    joined = posixpath.normpath(posixpath.join("/" if path.startswith("/") else folder, path)).lstrip("/")
    return None if joined == ".." or joined.startswith("../") else joined


def _address(target: str, folder: str, here: Here) -> str:
    """Return the address of a link: the web, a chapter's page or an element. Any other link leads nowhere: only its
    words stay.
    """
    path = _joined(folder, unquote(target.partition("#")[0]))
    return web(target) or (path and here.href(f"chapter:{path}")) or here.href(unquote(target)) or ""


def _nest_headings(tokens: Sequence[Token], level: int) -> None:
    """Shift headings so that the largest is one level below the heading above the text, and deeper ones follow."""
    levels = [int(token.tag[1]) for token in tokens if token.type in {"heading_open", "heading_close"}]
    shift = level + 1 - min(levels, default=0)
    for token in tokens:
        if token.type in {"heading_open", "heading_close"}:
            token.tag = f"h{min(6, int(token.tag[1]) + shift)}"


@cache
def _parser() -> MarkdownIt:
    from markdown_it import MarkdownIt

    # The rules below replace all that writes an address or raw text; everything else is markdown-it's own HTML.
    parser = MarkdownIt("commonmark", {"html": False}).enable("table")
    for name, rule in (
        ("link_open", _link_open),
        ("link_close", _link_close),
        ("image", _image),
        ("fence", _code),
        ("code_block", _code),
        ("text", _text),
        ("table_open", _table_open),
        ("table_close", _table_close),
    ):
        parser.add_render_rule(name, rule)
    return parser


def _link_open(_: object, tokens: Sequence[Token], place: int, *__: object) -> str:
    address = tokens[place].meta["address"]
    return f'<a href="{address}">' if address else "<span>"


def _link_close(_: object, tokens: Sequence[Token], place: int, *__: object) -> str:
    return "</a>" if tokens[place].meta["address"] else "</span>"


def _image(_: object, tokens: Sequence[Token], place: int, *__: object) -> str:
    """Render a copied picture; one from the web as a link (a page loads nothing from elsewhere), a missing one as its
    words.
    """
    token = tokens[place]
    alt = escape("".join(child.content for child in token.children or ()))
    if token.meta["source"]:
        return f'<img src="{token.meta["source"]}" alt="{alt}">'
    if token.meta["address"]:
        return f'<a href="{token.meta["address"]}">{alt or token.meta["address"]}</a>'
    return f'<span class="muted">[{alt or "a picture"}: not shown]</span>'


def _code(_: object, tokens: Sequence[Token], place: int, *__: object) -> str:
    return f'<pre tabindex="0"><code>{escape(tokens[place].content)}</code></pre>\n'


def _text(_: object, tokens: Sequence[Token], place: int, *__: object) -> str:
    return escape(tokens[place].content)


def _table_open(*_: object) -> str:
    return '<div class="scroll" role="group" tabindex="0" aria-label="Table"><table>\n'


def _table_close(*_: object) -> str:
    return "</table></div>\n"
