"""Write the frame of every page: head, bar, navigation, and what stands above the content.

A function, not a template: on 5,339 pages it takes a fifth of the time, and a run that writes only pages need not load
a template engine.
"""

from __future__ import annotations

from collections.abc import Sequence

from archgen.emit.site.html_text import escape_html
from archgen.frozen import dataclass


@dataclass(frozen=True, slots=True)
class FrameParts:
    """What stands in the frame of one page. Names that end in `html` are HTML already; all else is escaped."""

    title: str
    revision: str
    version: str
    policy: str
    root: str
    start: str
    heading: str
    lead: str
    crumbs: Sequence[tuple[str, str | None]]
    """Titles from the start page down, with addresses where there is such a page."""
    contents: Sequence[tuple[str, str]]
    """Titles and ids of the page's sections."""
    explorer_style: str
    explorer_begin: str
    explorer_scripts: Sequence[str]
    explorer_link: str
    navigation_html: str
    place_html: str
    verdict_html: str
    notices_html: Sequence[str]
    dashboard_html: str
    matrix_html: str
    waterfall_html: str
    content_html: str


def write_frame(parts: FrameParts) -> str:
    """Write a page."""
    version = f' data-version="{escape_html(parts.version)}"' if parts.version else ""
    revision = f'<span class="revision">{escape_html(parts.revision)}</span>\n' if parts.revision else ""
    waterfall = f"{parts.waterfall_html}\n" if parts.waterfall_html else ""
    return (
        f'<!DOCTYPE html>\n<html lang="en"{version}>\n'
        f"<head>\n{_write_head(parts)}</head>\n"
        '<body>\n<a class="skip" href="#content">Skip to the content</a>\n<header class="bar">\n'
        '<button type="button" class="menu" popovertarget="navigation" aria-label="Menu">'
        '<span aria-hidden="true"></span></button>\n'
        f'<a class="project" href="{escape_html(parts.start)}">{escape_html(parts.title)}</a>\n{revision}'
        '<button type="button" class="theme" hidden>Dark</button>\n</header>\n<div class="frame">\n'
        f'<nav id="navigation" class="tree" popover aria-label="Pages">\n{parts.navigation_html}\n</nav>\n'
        f'<main id="content" tabindex="-1">\n{_write_opening(parts)}{_write_contents(parts.contents)}'
        f"{parts.dashboard_html}\n{parts.matrix_html}\n{waterfall}"
        f"{parts.content_html}\n</main>\n</div>\n</body>\n</html>"
    )


def _write_head(parts: FrameParts) -> str:
    root = escape_html(parts.root)
    policy = parts.policy.replace("'", "&#39;")
    heading, title = escape_html(parts.heading), escape_html(parts.title)
    return "".join(
        [
            f'<meta charset="utf-8">\n<meta http-equiv="Content-Security-Policy" content="{policy}">\n',
            '<meta name="referrer" content="no-referrer">\n',
            '<meta name="viewport" content="width=device-width, initial-scale=1">\n',
            f"<title>{heading if heading == title else f'{heading} · {title}'}</title>\n",
            f'<link rel="icon" href="{root}assets/icon.svg">\n',
            _write_style(f"{root}assets/site.css"),
            _write_style(f"{root}assets/pictures.css"),
            _write_style(f"{root}assets/search.css"),
            _write_style(escape_html(parts.explorer_style)) if parts.explorer_style else "",
            f'<script src="{escape_html(parts.explorer_begin)}"></script>\n' if parts.explorer_style else "",
            _write_style(f"{root}assets/matrix.css") if parts.matrix_html else "",
            f'<script src="{root}assets/theme.js"></script>\n',
            _write_style(f"{root}live/live.css") + _write_script(f"{root}live/live.js") if parts.version else "",
            _write_script(f"{root}assets/site.js"),
            _write_script(f"{root}assets/search.js"),
            *[_write_script(escape_html(script)) for script in parts.explorer_scripts],
        ]
    )


def _write_style(address: str) -> str:
    return f'<link rel="stylesheet" href="{address}">\n'


def _write_script(address: str) -> str:
    return f'<script src="{address}" defer></script>\n'


def _write_opening(parts: FrameParts) -> str:
    """Write what stands above the content: the way from the start page, the title, what kind of thing it is."""
    heading = f"<h1>{escape_html(parts.heading)}</h1>"
    if parts.verdict_html:
        heading = f'<div class="title">{heading} {parts.verdict_html}</div>'
    link = escape_html(parts.explorer_link)
    return "".join(
        [
            _write_crumbs(parts.crumbs),
            f"{heading}\n",
            f'<p class="lead">{escape_html(parts.lead)}</p>\n' if parts.lead else "",
            f'<p class="explore"><a href="{link}">Show in explorer</a></p>\n' if link else "",
            f'<p class="written">Written in {parts.place_html}</p>\n' if parts.place_html else "",
            *[f"{notice}\n" for notice in parts.notices_html],
        ]
    )


def _write_crumbs(crumbs: Sequence[tuple[str, str | None]]) -> str:
    if not crumbs:
        return ""
    items = [
        f'<li><a href="{escape_html(href)}">{escape_html(text)}</a></li>\n'
        if href
        else f"<li>{escape_html(text)}</li>\n"
        for text, href in crumbs
    ]
    return f'<nav class="crumbs" aria-label="Breadcrumb">\n<ol>\n{"".join(items)}</ol>\n</nav>\n'


def _write_contents(contents: Sequence[tuple[str, str]]) -> str:
    """Write the links to the page's sections, where there are several."""
    if len(contents) < 2:  # noqa: PLR2004 - one section needs no list
        return ""
    items = [f'<li><a href="#{escape_html(name)}">{escape_html(text)}</a></li>\n' for text, name in contents]
    return f'<nav class="contents" aria-label="On this page">\n<ul>\n{"".join(items)}</ul>\n</nav>\n'
