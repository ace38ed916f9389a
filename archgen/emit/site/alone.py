"""Write a standalone HTML page: an outline with its pictures, style and font inside. It loads nothing from anywhere."""

from __future__ import annotations

import base64
import re
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from archgen.emit import backends
from archgen.emit.picture import Picture
from archgen.emit.site import pictures as drawing
from archgen.emit.site.blocks import Writer
from archgen.emit.site.chapters import Chapters
from archgen.emit.site.links import Here, collect, here
from archgen.emit.site.markup import clean, escape, words
from archgen.views.shapes import Facts, Outline, Page, Section

if TYPE_CHECKING:
    from jinja2 import Template

_PATH = "index.html"
_FACE = re.compile(r"@font-face \{[^}]*\}\n?")
_FONT = "inter-latin-wght-normal.woff2"
"""The only font inside the page; letters that it lacks come from the reader's system."""
_PICTURES = 'svg.archgen text { font-family: "DejaVu Sans", "Bitstream Vera Sans", Verdana, sans-serif; }\n'
"""Fonts as wide as the one that pictures are laid out with, so that texts fit their boxes without it."""


def write(outline: Outline, pictures: Mapping[str, Picture]) -> bytes:
    """Write the page. Links in the pictures must be `#` and the anchor that they lead to."""
    section = Section("page:index", outline.title, sections=outline.sections)
    page = Page(_PATH, section.anchor, outline.title, "page", section)
    place = here(_PATH, collect([page]))
    # Pictures of chapters would be files of their own, so there are none here.
    writer = Writer(place, pictures, Chapters(lambda _path: None), alone=True)
    folder = backends.shipped("site").folder
    frame = {
        "heading": clean(outline.title),
        "lead": clean(outline.subtitle),
        "language": clean(outline.language),
        "style": _style(folder),
        "facts": writer.facts(Facts(outline.facts)) if outline.facts else "",
        "notices": [writer.paragraph(notice) for notice in outline.notices],
        "navigation": "\n".join(_navigation(outline, place)),
        "content": writer.content(section),
    }
    return _template(folder).render(frame).encode()


def _navigation(outline: Outline, place: Here) -> Iterator[str]:
    """Yield a list of the chapters with their sections, as HTML."""
    yield "<ul>"
    for section in outline.sections:
        inner = "".join(f"<li>{_link(below, place)}</li>" for below in section.sections)
        yield f"<li>{_link(section, place)}{f'<ul>{inner}</ul>' if inner else ''}</li>"
    yield "</ul>"


def _link(section: Section, place: Here) -> str:
    return f'<a href="#{escape(place.id(section.anchor))}">{words(section.title)}</a>'


@cache
def _style(folder: Path) -> str:
    """Return the site's style with its font inside, the style of pictures, and what only this page needs."""
    style = (folder / "assets" / "site.css").read_text("utf-8")
    data = base64.b64encode((folder / "assets" / "fonts" / _FONT).read_bytes()).decode()
    address = f'url(data:font/woff2;base64,{data}) format("woff2")'
    face = f"@font-face {{ font-family: Inter; font-weight: 100 900; font-display: swap; src: {address}; }}\n"
    own = (folder / "templates" / "alone.css").read_text("utf-8")
    return face + _FACE.sub("", style) + drawing.style_embedded() + _PICTURES + own


@cache
def _template(folder: Path) -> Template:
    from archgen.emit.site import environment

    return environment(folder).get_template("alone.html.j2")
