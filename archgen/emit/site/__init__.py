"""Build the static site: pages and pictures in, a tree of files out. It opens from the disk and loads nothing from
elsewhere.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from archgen.emit import backend_manifests
from archgen.emit.file_tree import FileTree, make_file_tree
from archgen.emit.picture import Picture
from archgen.emit.site import page_pictures as drawing
from archgen.emit.site.chapter_html import ChapterFiles, ChapterWriter
from archgen.emit.site.html_blocks import PageWriter
from archgen.emit.site.html_text import replace_forbidden
from archgen.emit.site.matrix_files import build_matrix_files
from archgen.emit.site.matrix_html import write_matrix
from archgen.emit.site.page_links import SiteLinks, collect_links, open_page
from archgen.emit.site.page_policy import PAGE_POLICY
from archgen.emit.site.search_files import build_search_files
from archgen.emit.site.site_navigation import SiteNavigation, build_navigation
from archgen.views.search.search_entry import SearchEntry
from archgen.views.shapes import Page, Paragraph

if TYPE_CHECKING:
    from jinja2 import Environment, Template

FONT_FOLDER = Path(__file__).resolve().parent.parent / "fonts"
"""The font that pictures are laid out with. Pages load the same, so that text fits its boxes in every browser."""


def build_site(  # noqa: PLR0913 - what a site is made of
    pages: Sequence[Page],
    pictures: Mapping[str, Picture],
    *,
    title: str,
    revision: str,
    notices: Sequence[Paragraph],
    chapter_files: ChapterFiles,
    search_entries: Sequence[SearchEntry] = (),
) -> FileTree:
    """Build the site. The first page is the start page; `chapter_files` returns the pictures that chapters show.

    Links in the pictures must be `#` and the anchor that they lead to.
    """
    backend = backend_manifests.read_shipped_backend("site")
    links = collect_links(pages)
    navigation = build_navigation(pages, links, _navigation_kinds(backend))
    chapter_writer = ChapterWriter(chapter_files)
    template = _page_template(backend.folder)
    files = [
        *_read_assets(backend.folder),
        *_picture_files(pictures, links),
        *build_search_files(search_entries, links),
    ]
    for page in pages:
        path = links.files[page.path]
        writer = PageWriter(open_page(path, links), pictures, chapter_writer)
        variables = _page_variables(page, writer, navigation, notices)
        if page.matrix:
            files += build_matrix_files(page.matrix, writer.current_page)
        # The writer fills `chapters.files` while it writes, so these files are added only when all pages are done.
        files.append(
            (
                path,
                template.render(
                    variables, title=replace_forbidden(title), revision=replace_forbidden(revision)
                ).encode(),
            )
        )
    return make_file_tree((*files, *chapter_writer.files.items()))


def _page_variables(
    page: Page, writer: PageWriter, navigation: SiteNavigation, notices: Sequence[Paragraph]
) -> dict[str, object]:
    """Return the variables of a page's template."""
    current_page = writer.current_page
    return {
        "policy": PAGE_POLICY,
        "heading": replace_forbidden(page.title),
        "lead": replace_forbidden(page.lead),
        "place": writer.write_inlines((page.place,)) if page.place else "",
        "verdict": writer.write_inlines(page.verdict),
        "root": current_page.root,
        "start": current_page.root + navigation.start,
        "crumbs": [(replace_forbidden(text), href) for text, href in navigation.page_crumbs(page, current_page.root)],
        "navigation": navigation.write_tree(page, current_page.root),
        "notices": [writer.write_paragraph(notice) for notice in notices],
        "contents": [
            (replace_forbidden(section.title), current_page.id_for(section.anchor)) for section in page.section.sections
        ],
        "matrix": write_matrix(page.matrix, current_page) if page.matrix else "",
        "dashboard": writer.write_dashboard(page.dashboard) if page.dashboard else "",
        "content": writer.write_content(page.section),
    }


def _navigation_kinds(backend: backend_manifests.Backend) -> tuple[tuple[str, str], ...]:
    return tuple((entry["kind"], entry["title"]) for entry in backend.options["navigation"])


@cache
def _page_template(folder: Path) -> Template:
    """Compile the template of pages, once for all pages and all runs of a process."""
    return page_environment(folder).get_template("page.html.j2")


def page_environment(folder: Path) -> Environment:
    """Create Jinja's environment for the site's own templates: all that is not marked safe is escaped."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    return Environment(
        loader=FileSystemLoader(folder / "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def _picture_files(pictures: Mapping[str, Picture], links: SiteLinks) -> Iterator[tuple[str, bytes]]:
    """Yield a file for each picture; the page's picture links to it."""
    for picture_id, picture in pictures.items():
        if picture.svg is not None:
            path = drawing.picture_path(picture_id)
            current_page = open_page(path, links)
            svg = drawing.standalone_svg(picture.svg, current_page.href, drawing.standalone_style(current_page.root))
            yield path, drawing.write_signs(svg.decode()).encode()


@cache
def _read_assets(folder: Path) -> tuple[tuple[str, bytes], ...]:
    """Read the files that pages load: style, script and fonts, and the style of pictures."""
    asset_paths = (
        (path.relative_to(folder).as_posix(), path) for path in sorted((folder / "assets").rglob("*")) if path.is_file()
    )
    font_paths = ((f"assets/fonts/{path.name.lower()}", path) for path in sorted(FONT_FOLDER.iterdir()))
    # Lower case, as all paths that archgen makes.
    files = [(name.lower(), path.read_bytes()) for name, path in (*asset_paths, *font_paths)]
    return (*files, ("assets/pictures.css", drawing.embedded_style().encode()))
