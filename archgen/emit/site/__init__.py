"""Build the static site: pages and pictures in, a tree of files out. It opens from the disk and loads nothing from
elsewhere.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from archgen.emit import backends
from archgen.emit.picture import Picture
from archgen.emit.site import pictures as drawing
from archgen.emit.site.blocks import Writer
from archgen.emit.site.chapters import ChapterFiles, Chapters
from archgen.emit.site.links import Links, collect, here
from archgen.emit.site.markup import clean
from archgen.emit.site.navigation import Navigation, navigation
from archgen.emit.tree import FileTree, tree
from archgen.views.shapes import Page, Paragraph

if TYPE_CHECKING:
    from jinja2 import Environment, Template

FONTS = Path(__file__).resolve().parent.parent / "fonts"
"""The font that pictures are laid out with. Pages load the same, so that text fits its boxes in every browser."""


def write(  # noqa: PLR0913 - what a site is made of
    pages: Sequence[Page],
    pictures: Mapping[str, Picture],
    *,
    title: str,
    revision: str,
    notices: Sequence[Paragraph],
    chapter_files: ChapterFiles,
) -> FileTree:
    """Build the site. The first page is the start page; `chapter_files` returns the pictures that chapters show.

    Links in the pictures must be `#` and the anchor that they lead to.
    """
    backend = backends.shipped("site")
    links = collect(pages)
    way = navigation(pages, links, _kinds(backend))
    chapters = Chapters(chapter_files)
    template = _template(backend.folder)
    found = [*_assets(backend.folder), *_pictures(pictures, links)]
    for page in pages:
        path = links.files[page.path]
        writer = Writer(here(path, links), pictures, chapters)
        frame = _frame(page, writer, way, notices)
        # The writer fills `chapters.files` while it writes, so these files are added only when all pages are done.
        found.append((path, template.render(frame, title=clean(title), revision=clean(revision)).encode()))
    return tree((*found, *chapters.files.items()))


def _frame(page: Page, writer: Writer, way: Navigation, notices: Sequence[Paragraph]) -> dict[str, object]:
    """Return the variables of a page's template."""
    place = writer.here
    return {
        "heading": clean(page.title),
        "lead": clean(page.lead),
        "root": place.root,
        "start": place.root + way.start,
        "crumbs": [(clean(text), href) for text, href in way.crumbs(page, place.root)],
        "navigation": way.html(page, place.root),
        "notices": [writer.paragraph(notice) for notice in notices],
        "contents": [(clean(section.title), place.id(section.anchor)) for section in page.section.sections],
        "content": writer.content(page.section),
    }


def _kinds(backend: backends.Backend) -> tuple[tuple[str, str], ...]:
    return tuple((entry["kind"], entry["title"]) for entry in backend.options["navigation"])


@cache
def _template(folder: Path) -> Template:
    """Compile the template of pages, once for all pages and all runs of a process."""
    return environment(folder).get_template("page.html.j2")


def environment(folder: Path) -> Environment:
    """Create Jinja's environment for the site's own templates: all that is not marked safe is escaped."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    return Environment(
        loader=FileSystemLoader(folder / "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def _pictures(pictures: Mapping[str, Picture], links: Links) -> Iterator[tuple[str, bytes]]:
    """Yield a file for each picture; the page's picture links to it."""
    for graph, picture in pictures.items():
        if picture.svg is not None:
            path = drawing.path(graph)
            place = here(path, links)
            yield path, drawing.alone(picture.svg, place.href, drawing.style_alone(place.root))


@cache
def _assets(folder: Path) -> tuple[tuple[str, bytes], ...]:
    """Read the files that pages load: style, script and fonts, and the style of pictures."""
    own = (
        (path.relative_to(folder).as_posix(), path) for path in sorted((folder / "assets").rglob("*")) if path.is_file()
    )
    fonts = ((f"assets/fonts/{path.name.lower()}", path) for path in sorted(FONTS.iterdir()))
    # Lower case, as all paths that archgen makes.
    files = [(name.lower(), path.read_bytes()) for name, path in (*own, *fonts)]
    return (*files, ("assets/pictures.css", drawing.style_embedded().encode()))
