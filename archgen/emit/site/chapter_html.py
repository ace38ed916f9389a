"""Write the project's CommonMark as HTML: no HTML of its own, no request to anywhere, pictures copied to the site."""

from __future__ import annotations

import posixpath
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING
from urllib.parse import unquote

from archgen.emit.safe_names import make_safe_path
from archgen.emit.site.html_text import escape_html, web_address
from archgen.emit.site.page_links import CurrentPage
from archgen.emit.term_mentions import MentionFinder, begin_text
from archgen.frozen import dataclass, field
from archgen.views.shapes import Markdown

if TYPE_CHECKING:
    from markdown_it import MarkdownIt
    from markdown_it.token import Token

ChapterFiles = Callable[[str], bytes | None]
"""Returns a file of the project by its path (`/`, relative to the project), or None if there is none."""

_CELL_CLASSES = {"text-align:right": ' class="right"', "text-align:center": ' class="centre"'}
_PICTURE_SIGNATURES = (
    (b"\x89PNG\r\n\x1a\n", ".png"),
    (b"\xff\xd8\xff", ".jpg"),
    (b"GIF8", ".gif"),
    (b"RIFF", ".webp"),
    (b"<svg", ".svg"),
    (b"<?xml", ".svg"),
)


@dataclass(frozen=True, slots=True)
class ChapterWriter:
    """Writes CommonMark as HTML, and gathers the pictures that it needs (`files`: path in the site -> bytes)."""

    source: ChapterFiles
    files: dict[str, bytes] = field(default_factory=dict)
    copied_paths: dict[str, str | None] = field(default_factory=dict)

    def write_html(self, block: Markdown, level: int, current_page: CurrentPage) -> str:
        """Write a text below a heading of this level."""
        parser = _chapter_parser()
        tokens = parser.parse(block.text)
        _nest_headings(tokens, level)
        for token in tokens:
            self._resolve_targets(token.children or (), block.folder, current_page)
        if finder := begin_text(current_page.links.terms):
            _link_terms(tokens, finder, current_page)
        return str(parser.renderer.render(tokens, parser.options, {}))

    def _resolve_targets(self, tokens: Sequence[Token], folder: str, current_page: CurrentPage) -> None:
        """Resolve where links and pictures lead. The render rules find the answer in the token's `meta`."""
        open_links: list[str] = []
        for token in tokens:
            if token.type == "link_open":
                open_links.append(_resolve_address(str(token.attrs.get("href", "")), folder, current_page))
                token.meta["address"] = open_links[-1]
            elif token.type == "link_close":
                token.meta["address"] = open_links.pop()
            elif token.type == "image":
                source = str(token.attrs.get("src", ""))
                copied_path = self._copy_picture(_project_path(folder, unquote(source)))
                token.meta["source"] = current_page.root + copied_path if copied_path else ""
                # A picture of the web inside of a link becomes plain words: HTML has no link in a link.
                token.meta["address"] = "" if any(open_links) else web_address(source) or ""

    def _copy_picture(self, path: str | None) -> str | None:
        """Copy a picture into the site. Return its path there, or None where there is no such picture."""
        if path is None:
            return None
        if path not in self.copied_paths:
            data = self.source(path)
            # By its first bytes, not by its name: a file called .png may hold HTML, which a browser would run.
            ending = data and next(
                (end for start, end in _PICTURE_SIGNATURES if data.lstrip()[:8].startswith(start)), None
            )
            self.copied_paths[path] = self._add_picture(path, data, ending) if data and ending else None
        return self.copied_paths[path]

    def _add_picture(self, path: str, data: bytes, ending: str) -> str:
        stem = make_safe_path(f"pictures/{posixpath.splitext(path)[0]}")
        name, number = stem + ending, 2
        while name in self.files:
            name, number = f"{stem}-{number}{ending}", number + 1
        self.files[name] = data
        return name


def _link_terms(tokens: Sequence[Token], finder: MentionFinder, current_page: CurrentPage) -> None:
    """Lead from the first mention of each term to the glossary; headings, links and code stay as they are."""
    for before, token in pairwise(tokens):
        if token.type == "inline" and token.children and before.type != "heading_open":
            token.children = list(_split_mentions(token.children, finder, current_page))


def _split_mentions(tokens: Sequence[Token], finder: MentionFinder, current_page: CurrentPage) -> Iterator[Token]:
    link_depth = 0
    for token in tokens:
        link_depth += token.nesting if token.type in {"link_open", "link_close"} else 0
        if token.type != "text" or link_depth:
            yield token
            continue
        position = 0
        for mention in finder.find_mentions(token.content):
            address = current_page.href(mention.anchor) or ""
            yield token.copy(content=token.content[position : mention.start])
            yield token.copy(type="link_open", tag="a", nesting=1, content="", meta={"address": address})
            yield token.copy(content=token.content[mention.start : mention.end])
            yield token.copy(type="link_close", tag="a", nesting=-1, content="", meta={"address": address})
            position = mention.end
        yield token.copy(content=token.content[position:])


def _project_path(folder: str, path: str) -> str | None:
    """Return the path in the project that a relative address means, or None where it leaves the project."""
    if not path or "\\" in path or ":" in path.split("/", maxsplit=1)[0]:
        return None
    joined = posixpath.normpath(posixpath.join("/" if path.startswith("/") else folder, path)).lstrip("/")
    return None if joined == ".." or joined.startswith("../") else joined


def _resolve_address(target: str, folder: str, current_page: CurrentPage) -> str:
    """Return the address of a link: the web, a chapter's page or an element. Any other link leads nowhere: only its
    words stay.
    """
    path = _project_path(folder, unquote(target.partition("#")[0]))
    return (
        web_address(target)
        or (path and current_page.href(f"chapter:{path}"))
        or current_page.href(unquote(target))
        or ""
    )


def _nest_headings(tokens: Sequence[Token], level: int) -> None:
    """Shift headings so that the largest is one level below the heading above the text, and deeper ones follow."""
    levels = [int(token.tag[1]) for token in tokens if token.type in {"heading_open", "heading_close"}]
    shift = level + 1 - min(levels, default=0)
    for token in tokens:
        if token.type in {"heading_open", "heading_close"}:
            token.tag = f"h{min(6, int(token.tag[1]) + shift)}"


@cache
def _chapter_parser() -> MarkdownIt:
    from markdown_it import MarkdownIt

    # The rules below replace all that writes an address or raw text; everything else is markdown-it's own HTML.
    parser = MarkdownIt("commonmark", {"html": False}).enable("table")
    rules: dict[str, Callable[[Token], str]] = {
        "link_open": lambda token: f'<a href="{token.meta["address"]}">' if token.meta["address"] else "<span>",
        "link_close": lambda token: "</a>" if token.meta["address"] else "</span>",
        "image": _render_image,
        **dict.fromkeys(("fence", "code_block"), _render_code),
        "text": lambda token: escape_html(token.content),
        "table_open": lambda _: '<div class="scroll" role="group" tabindex="0" aria-label="Table"><table>\n',
        "table_close": lambda _: "</table></div>\n",
        # Alignment as a class: a page's policy refuses style attributes.
        **dict.fromkeys(
            ("th_open", "td_open"),
            lambda token: f"<{token.tag}{_CELL_CLASSES.get(str(token.attrs.get('style', '')), '')}>",
        ),
    }
    for name, rule in rules.items():
        parser.add_render_rule(name, _take_token(rule))
    return parser


def _take_token(rule: Callable[[Token], str]) -> Callable[..., str]:
    """Return what markdown-it calls with its renderer, all tokens and the place of one, to write this one."""
    return lambda _renderer, tokens, index, *_options: rule(tokens[index])


def _render_image(token: Token) -> str:
    """Render a copied picture; one from the web as a link (a page loads nothing from elsewhere), a missing one as its
    words.
    """
    alt = escape_html("".join(child.content for child in token.children or ()))
    if token.meta["source"]:
        return f'<img src="{token.meta["source"]}" alt="{alt}">'
    if token.meta["address"]:
        return f'<a href="{token.meta["address"]}">{alt or token.meta["address"]}</a>'
    return f'<span class="muted">[{alt or "a picture"}: not shown]</span>'


def _render_code(token: Token) -> str:
    return f'<pre tabindex="0"><code>{escape_html(token.content)}</code></pre>\n'
