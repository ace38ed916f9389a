"""Write the frame of every page: its head, the bar, the navigation, and what stands above its content.

A function, not a template: to load Jinja2 and compile one takes a tenth of a second (docs/decisions/0043-frame-of-pages.md).
"""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Sequence

from archgen.emit.site.html_text import escape_html
from archgen.frozen import dataclass


@dataclass(frozen=True, slots=True)
class PageFrame:
    """What the frame of a page shows. Text that is not said to be HTML is escaped when it is written.

    `root` is the way up to the site's folder, `start` the address of the start page, `crumbs` the path from there:
    titles with addresses. `contents` has the titles and ids of the page's sections.
    """

    site_title: str
    revision: str
    version: str
    policy: str
    root: str
    start: str
    heading: str
    lead: str
    crumbs: Sequence[tuple[str, str | None]]
    contents: Sequence[tuple[str, str]]
    navigation: str
    """HTML, as all that follows but the addresses."""
    verdict: str
    place: str
    notices: Sequence[str]
    dashboard: str
    matrix: str
    waterfall: str
    content: str
    explorer_style: str = ""
    explorer_begin: str = ""
    explorer_scripts: Sequence[str] = ()
    explorer_link: str = ""
    report: str = ""
    """The address of the report, where it stands beside the site."""


def write_frame(page: PageFrame) -> str:
    """Write a page's HTML, all of it."""
    # An empty line stands for each of dashboard and matrix where there is none.
    parts = [
        _write_head(page),
        f'<nav id="navigation" class="tree" popover aria-label="Pages">\n{page.navigation}\n</nav>',
        '<main id="content" tabindex="-1">',
        *_write_crumbs(page),
        *_write_heading(page),
        *page.notices,
        *_write_contents(page),
        page.dashboard,
        page.matrix,
        *([page.waterfall] if page.waterfall else ()),
        page.content,
        "</main>\n</div>\n</body>\n</html>",
    ]
    return "\n".join(parts)


def _write_head(page: PageFrame) -> str:
    """Write all from the beginning to the navigation."""
    root = page.root
    heading, title = escape_html(page.heading), escape_html(page.site_title)
    version = escape_html(page.version)
    version_attribute = f' data-version="{version}"' if page.version else ""
    revision = f'<span class="revision">{escape_html(page.revision)}</span>\n' if page.revision else ""
    report = f'<a class="report" href="{escape_html(page.report)}">Report</a>\n' if page.report else ""
    return f"""\
<!DOCTYPE html>
<html lang="en"{version_attribute}>
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{escape_html(page.policy)}">
<meta name="referrer" content="no-referrer">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{heading}{f" · {title}" if page.heading != page.site_title else ""}</title>
<link rel="icon" href="{root}assets/icon.svg">
<link rel="stylesheet" href="{root}assets/site.css">
<link rel="stylesheet" href="{root}assets/pictures.css">
<link rel="stylesheet" href="{root}assets/search.css">
{_write_loaded_files(page)}</head>
<body>
<a class="skip" href="#content">Skip to the content</a>
<header class="bar">
<button type="button" class="menu" popovertarget="navigation" aria-label="Menu"><span aria-hidden="true"></span></button>
<a class="project" href="{escape_html(page.start)}">{title}</a>
{revision}{report}<button type="button" class="theme" hidden>Dark</button>
</header>
<div class="frame">"""


def _write_loaded_files(page: PageFrame) -> str:
    """Write the style sheets of some pages and the scripts, a line for each."""
    root = page.root
    lines: list[str] = []
    if page.explorer_style:
        lines.append(f'<link rel="stylesheet" href="{escape_html(page.explorer_style)}">')
        lines.append(f'<script src="{escape_html(page.explorer_begin)}"></script>')
    if page.matrix:
        lines.append(f'<link rel="stylesheet" href="{root}assets/matrix.css">')
    lines.append(f'<script src="{root}assets/theme.js"></script>')
    if page.version:
        lines.append(f'<link rel="stylesheet" href="{root}live/live.css">')
        lines.append(f'<script src="{root}live/live.js" defer></script>')
    lines.append(f'<script src="{root}assets/site.js" defer></script>')
    lines.append(f'<script src="{root}assets/search.js" defer></script>')
    lines += [f'<script src="{escape_html(script)}" defer></script>' for script in page.explorer_scripts]
    return "".join([f"{line}\n" for line in lines])


def _write_crumbs(page: PageFrame) -> list[str]:
    if not page.crumbs:
        return []
    items = [
        f'<li><a href="{escape_html(href)}">{escape_html(text)}</a></li>' if href else f"<li>{escape_html(text)}</li>"
        for text, href in page.crumbs
    ]
    return ['<nav class="crumbs" aria-label="Breadcrumb">\n<ol>', *items, "</ol>\n</nav>"]


def _write_heading(page: PageFrame) -> list[str]:
    """Write the title with its verdict, and the lines below it."""
    heading = f"<h1>{escape_html(page.heading)}</h1>"
    lines = [f'<div class="title">{heading} {page.verdict}</div>' if page.verdict else heading]
    if page.lead:
        lines.append(f'<p class="lead">{escape_html(page.lead)}</p>')
    if page.explorer_link:
        lines.append(f'<p class="explore"><a href="{escape_html(page.explorer_link)}">Show in explorer</a></p>')
    if page.place:
        lines.append(f'<p class="written">Written in {page.place}</p>')
    return lines


def _write_contents(page: PageFrame) -> list[str]:
    """Write the list of a page's sections, unless there is but one."""
    if len(page.contents) <= 1:
        return []
    items = [f'<li><a href="#{escape_html(name)}">{escape_html(title)}</a></li>' for title, name in page.contents]
    return ['<nav class="contents" aria-label="On this page">\n<ul>', *items, "</ul>\n</nav>"]


_DIRECTIVES = (
    "default-src 'none'",
    "script-src 'self'",
    "style-src 'self'",
    "font-src 'self'",
    # Pictures that a page made itself: a view that is saved is drawn from such an address.
    "img-src 'self' data: blob:",
    # By name, although the default says it: a server of live pages allows itself, and nothing else.
    "connect-src 'none'",
    "base-uri 'none'",
    "form-action 'none'",
)
PAGE_POLICY = "; ".join(_DIRECTIVES)
"""The Content-Security-Policy of each page, in an element of the page: there is no server to send a header.

Neither a script nor a style in the page itself counts, so that no text of a project can ever become one.
"""

LIVE_PAGE_POLICY = PAGE_POLICY.replace("connect-src 'none'", "connect-src 'self'")
"""The policy of a page that is served: it asks its own server for news, and nobody else."""


def write_standalone_policy(style: str) -> str:
    """Return the policy of a page that loads nothing: its one style element counts, by its hash, with the font in it.

    `style` is all that stands in the element, blanks at its ends included.
    """
    digest = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
    return f"default-src 'none'; style-src 'sha256-{digest}'; font-src data:; base-uri 'none'; form-action 'none'"
