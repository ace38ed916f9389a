"""All pages of one state of a project: which there are, what leads where, and what their scripts read."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property

from archgen.emit import site
from archgen.emit.site.matrix_files import build_matrix_files
from archgen.emit.site.page_links import open_page
from archgen.emit.site.script_files import build_explorer_files, build_search_files
from archgen.frozen import dataclass
from archgen.serve.project_state import ProjectState
from archgen.views.explorer import make_explorer_map
from archgen.views.pages.site_pages import make_pages
from archgen.views.search import make_search_entries
from archgen.views.shapes import Block, Figure, Page, Section


@dataclass(frozen=True)
class SiteIndex:
    """All pages of one state: which there are, what leads where, and what the search finds."""

    state: ProjectState
    frame: site.SiteFrame
    pages: Mapping[str, Page]
    """By their paths."""

    @cached_property
    def search_files(self) -> Mapping[str, bytes]:
        """The files of the search, by their paths."""
        entries = make_search_entries(self.state.lookup, tuple(self.pages.values()))
        return dict(build_search_files(entries, self.frame.links))

    @cached_property
    def map_files(self) -> Mapping[str, bytes]:
        """The files with what the explorer shows, by their paths."""
        return build_explorer_files(make_explorer_map(self.state.lookup), self.frame.links)

    @cached_property
    def matrix_files(self) -> Mapping[str, bytes]:
        """The files of all matrices, by their paths."""
        links = self.frame.links
        return {
            name: data
            for path, page in self.pages.items()
            if page.matrix
            for name, data in build_matrix_files(page.matrix, open_page(path, links))
        }

    def find_data_file(self, path: str) -> bytes | None:
        """Return a file that the scripts of pages read, None where there is none of this path."""
        if path.startswith("assets/search/"):
            return self.search_files.get(path)
        return self.map_files.get(path) if path.startswith("assets/explorer/") else self.matrix_files.get(path)


def make_index(state: ProjectState) -> SiteIndex:
    """Make all pages of a state."""
    pages = make_pages(state.lookup, state.edition)
    frame = site.make_frame(
        pages, title=state.checked_project.architecture.project.title, revision=state.edition.revision, notices=()
    )
    return SiteIndex(state, frame, {frame.links.files[page.path]: page for page in pages})


def list_page_drawings(page: Page) -> Iterator[str]:
    """Yield the ids of the drawings that a page shows."""
    for card in page.dashboard.cards if page.dashboard else ():
        yield from _list_graphs(card.blocks)
    pending_sections: list[Section] = [page.section]
    while pending_sections:
        section = pending_sections.pop()
        yield from _list_graphs(section.blocks)
        pending_sections += section.sections


def _list_graphs(blocks: Iterable[Block]) -> Iterator[str]:
    for block in blocks:
        if isinstance(block, Figure):
            yield from filter(None, (block.graph, block.narrow))
