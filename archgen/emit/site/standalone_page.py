"""Write a standalone HTML page: an outline with its pictures, style and font inside. It loads nothing from anywhere."""

from __future__ import annotations

import base64
import re
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from archgen.emit import backend_manifests
from archgen.emit.picture import Picture
from archgen.emit.site import page_pictures as drawing
from archgen.emit.site.chapter_html import ChapterWriter
from archgen.emit.site.html_blocks import PageWriter, name_natural_width
from archgen.emit.site.html_text import escape_breakable, escape_html, replace_forbidden
from archgen.emit.site.page_frame import write_standalone_policy
from archgen.emit.site.page_links import CurrentPage, collect_links, open_page
from archgen.views.shapes import Facts, Outline, Page, Section

if TYPE_CHECKING:
    from jinja2 import Template

_PAGE_PATH = "index.html"
_FONT_FACE = re.compile(r"@font-face \{[^}]*\}\n?")
_FONT_FILE = "inter-latin-wght-normal.woff2"
"""The only font inside the page; letters that it lacks come from the reader's system."""
_PICTURE_FONTS = 'svg.archgen text { font-family: Inter, "DejaVu Sans", "Bitstream Vera Sans", Verdana, sans-serif; }\n'
"""The font that pictures are laid out with, then fonts that are as wide for the letters that it lacks."""


def write_standalone_page(outline: Outline, pictures: Mapping[str, Picture]) -> bytes:
    """Write the page. Links in the pictures must be `#` and the anchor that they lead to."""
    section = Section("page:index", outline.title, sections=outline.sections)
    page = Page(_PAGE_PATH, section.anchor, outline.title, "page", section)
    current_page = open_page(_PAGE_PATH, collect_links([page]))
    # Pictures of chapters would be files of their own, so there are none here.
    writer = PageWriter(current_page, pictures, ChapterWriter(lambda _path: None), standalone=True)
    folder = backend_manifests.read_shipped_backend("site").folder
    style = f"\n{_page_style(folder)}{_write_natural_widths(pictures.values())}\n"
    variables = {
        "heading": replace_forbidden(outline.title),
        "lead": replace_forbidden(outline.subtitle),
        "language": replace_forbidden(outline.language),
        "policy": write_standalone_policy(style),
        "style": style,
        "facts": writer.write_facts(Facts(outline.facts)) if outline.facts else "",
        "notices": [writer.write_paragraph(notice) for notice in outline.notices],
        "navigation": "\n".join(_navigation_html(outline, current_page)),
        "content": writer.write_content(section),
    }
    return _standalone_template(folder).render(variables).encode()


def _write_natural_widths(pictures: Iterable[Picture]) -> str:
    """Return the style of pictures that scroll before they get too small to read, a class for each width."""
    return "".join(
        f".{name} {{ --natural: {name[1:]}px; }}\n" for name in sorted(set(map(name_natural_width, pictures)))
    )


def _navigation_html(outline: Outline, current_page: CurrentPage) -> Iterator[str]:
    """Yield a list of the chapters with their sections, as HTML."""
    yield "<ul>"
    for section in outline.sections:
        subsection_items = "".join(f"<li>{_section_link(below, current_page)}</li>" for below in section.sections)
        yield f"<li>{_section_link(section, current_page)}{f'<ul>{subsection_items}</ul>' if subsection_items else ''}</li>"
    yield "</ul>"


def _section_link(section: Section, current_page: CurrentPage) -> str:
    return f'<a href="#{escape_html(current_page.id_for(section.anchor))}">{escape_breakable(section.title)}</a>'


@cache
def _page_style(folder: Path) -> str:
    """Return the site's style with its font inside, the style of pictures, and what only this page needs."""
    style = (folder / "assets" / "site.css").read_text("utf-8")
    data = base64.b64encode((folder / "assets" / "fonts" / _FONT_FILE).read_bytes()).decode()
    address = f'url(data:font/woff2;base64,{data}) format("woff2")'
    face = f"@font-face {{ font-family: Inter; font-weight: 100 900; font-display: swap; src: {address}; }}\n"
    extra_style = (folder / "templates" / "alone.css").read_text("utf-8")
    return face + _FONT_FACE.sub("", style) + drawing.embedded_style() + _PICTURE_FONTS + extra_style


@cache
def _standalone_template(folder: Path) -> Template:
    """Compile the template of the page: all that is not marked safe is escaped."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(folder / "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template("alone.html.j2")
