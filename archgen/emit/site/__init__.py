"""Build the static site: pages and pictures in, a tree of files out. It opens from the disk and loads nothing from
elsewhere.
"""

from __future__ import annotations

import json
import re
from base64 import b64encode
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path

from archgen.emit import backend_manifests
from archgen.emit.file_tree import FileTree, make_file_tree
from archgen.emit.picture import Picture
from archgen.emit.site import page_pictures as drawing
from archgen.emit.site.chapter_html import ChapterFiles, ChapterWriter
from archgen.emit.site.html_blocks import PageWriter
from archgen.emit.site.matrix_files import build_matrix_files, write_matrix
from archgen.emit.site.page_frame import LIVE_PAGE_POLICY, PAGE_POLICY, PageFrame, write_frame
from archgen.emit.site.page_links import SiteLinks, collect_links, open_page
from archgen.emit.site.script_files import (
    EXPLORER_ANCHOR,
    EXPLORER_STYLE,
    build_explorer_files,
    build_search_files,
    find_explorer_address,
    list_explorer_scripts,
)
from archgen.emit.site.site_navigation import SiteNavigation, build_navigation
from archgen.frozen import dataclass, replace
from archgen.views.explorer.map_shapes import ExplorerMap
from archgen.views.search.search_entry import SearchEntry
from archgen.views.shapes import Page, Paragraph

_PAGE_FACE = re.compile(r"url\((fonts/inter[^)]*)\)[^}]*?unicode-range: ([^;]*);")
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
    explorer_map: ExplorerMap | None = None,
    report: str = "",
) -> FileTree:
    """Build the site. The first page is the start page; `chapter_files` returns the pictures that chapters show.

    Without an `explorer_map` the explorer's page stays what it is without scripts.

    `report` is the path of the report from the site's folder, where there is one.

    Links in the pictures must be `#` and the anchor that they lead to.
    """
    chapter_writer = ChapterWriter(chapter_files)
    frame = make_frame(pages, title=title, revision=revision, notices=notices)
    map_files = build_explorer_files(explorer_map, frame.links) if explorer_map else {}
    frame = replace(frame, map_parts=tuple(map_files), report=report)

    def yield_files() -> Iterator[tuple[str, bytes]]:
        yield from read_assets()
        yield from _picture_files(pictures, frame.links)
        yield from build_search_files(search_entries, frame.links)
        yield from map_files.items()
        for page in pages:
            path = frame.links.files[page.path]
            if page.matrix:
                yield from build_matrix_files(page.matrix, open_page(path, frame.links))
            yield path, write_page(path, page, pictures, frame, chapter_writer)
        # The writer fills these while it writes: they are there only when all pages are done.
        yield from chapter_writer.files.items()

    return make_file_tree(yield_files())


@dataclass(frozen=True, slots=True)
class SiteFrame:
    """What all pages of a site have in common. `version` is empty but in a site that is served: then it tells one state
    of the project from another, and pages may ask their server for the next.
    """

    title: str
    revision: str
    notices: Sequence[Paragraph]
    links: SiteLinks
    navigation: SiteNavigation
    map_parts: tuple[str, ...] = ()
    """The paths of the scripts with what the explorer shows."""
    version: str = ""
    report: str = ""
    """The path of the report from the site's folder, where there is one."""


def make_frame(pages: Sequence[Page], *, title: str, revision: str, notices: Sequence[Paragraph]) -> SiteFrame:
    """Make what the pages of a site have in common: titles, links and navigation."""
    links = collect_links(pages)
    navigation = build_navigation(
        pages, links, tuple((entry["kind"], entry["title"]) for entry in _read_backend().options["navigation"])
    )
    return SiteFrame(title, revision, notices, links, navigation)


def write_page(
    path: str, page: Page, pictures: Mapping[str, Picture], frame: SiteFrame, chapter_writer: ChapterWriter
) -> bytes:
    """Write one page, which is at this path of the site."""
    writer = PageWriter(open_page(path, frame.links), pictures, chapter_writer)
    framed_page = _frame_page(page, writer, frame)
    return write_frame(_add_explorer(framed_page, page, writer, frame.map_parts)).encode()


def write_picture(picture_id: str, picture: Picture, links: SiteLinks) -> bytes | None:
    """Write a picture as a file of its own; None where it could not be drawn."""
    if picture.svg is None:
        return None
    current_page = open_page(drawing.picture_path(picture_id), links)
    svg = drawing.standalone_svg(picture.svg, current_page.href, drawing.standalone_style(current_page.root))
    return drawing.write_picture_signs(svg.decode()).encode()


@cache
def _read_backend() -> backend_manifests.Backend:
    return backend_manifests.read_shipped_backend("site")


def _frame_page(page: Page, writer: PageWriter, frame: SiteFrame) -> PageFrame:
    """Write a page's parts, and put them into its frame."""
    current_page, navigation = writer.current_page, frame.navigation
    root = current_page.root
    return PageFrame(
        site_title=frame.title,
        revision=frame.revision,
        version=frame.version,
        policy=LIVE_PAGE_POLICY if frame.version else PAGE_POLICY,
        root=root,
        start=root + navigation.start,
        report=root + frame.report if frame.report else "",
        heading=page.title,
        lead=page.lead,
        crumbs=navigation.page_crumbs(page, root),
        contents=[(section.title, current_page.id_for(section.anchor)) for section in page.section.sections],
        navigation=navigation.write_tree(page, root),
        verdict=writer.write_inlines(page.verdict),
        place=writer.write_inlines((page.place,)) if page.place else "",
        notices=[writer.write_paragraph(notice) for notice in frame.notices],
        matrix=write_matrix(page.matrix, current_page) if page.matrix else "",
        dashboard=writer.write_dashboard(page.dashboard) if page.dashboard else "",
        waterfall=writer.write_waterfall(page.waterfall) if page.waterfall else "",
        content=writer.write_content(page.section),
    )


def _add_explorer(framed_page: PageFrame, page: Page, writer: PageWriter, map_parts: Sequence[str]) -> PageFrame:
    """Add what the explorer adds to a page: its scripts to its own, a link to those of elements on the map."""
    root = writer.current_page.root
    if page.anchor != EXPLORER_ANCHOR:
        address = find_explorer_address(page, writer.current_page.links)
        return replace(framed_page, explorer_link=root + address) if address else framed_page
    if not map_parts:
        return framed_page
    begin_script, scripts = list_explorer_scripts(map_parts)
    return replace(
        framed_page,
        explorer_style=root + EXPLORER_STYLE,
        explorer_begin=root + begin_script,
        explorer_scripts=[root + script for script in scripts],
    )


def _picture_files(pictures: Mapping[str, Picture], links: SiteLinks) -> Iterator[tuple[str, bytes]]:
    """Yield a file for each picture; the page's picture links to it."""
    for picture_id, picture in pictures.items():
        data = write_picture(picture_id, picture, links)
        if data is not None:
            yield drawing.picture_path(picture_id), data


@cache
def read_assets() -> tuple[tuple[str, bytes], ...]:
    """Read the files that pages load: style, script and fonts, and the style of pictures."""
    folder = _read_backend().folder
    asset_paths = (
        (path.relative_to(folder).as_posix(), path) for path in sorted((folder / "assets").rglob("*")) if path.is_file()
    )
    font_paths = ((f"assets/fonts/{path.name.lower()}", path) for path in sorted(FONT_FOLDER.iterdir()))
    # Lower case, as all paths that archgen makes.
    files = [(name.lower(), path.read_bytes()) for name, path in (*asset_paths, *font_paths)]
    contents = dict(files)
    return (
        *files,
        ("assets/pictures.css", drawing.embedded_style().encode()),
        ("assets/fonts.js", _write_saved_faces(contents).encode()),
    )


def _write_saved_faces(files: Mapping[str, bytes]) -> str:
    """Write the script with the faces of the pages, which a picture that is saved takes along: ranges of letters, and the face."""
    faces = [
        (
            letters.replace("U+", "").split(", "),
            f'@font-face{{font-family:Inter;font-weight:100 900;src:url(data:font/woff2;base64,{b64encode(files[f"assets/{file}"]).decode()}) format("woff2")}}',
        )
        for file, letters in _PAGE_FACE.findall(files["assets/site.css"].decode())
    ]
    return f"globalThis.archgenFaces = {json.dumps(faces)};\n"
