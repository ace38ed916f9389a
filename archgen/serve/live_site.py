"""The site of a project in memory: a page is made when somebody asks for it, from the files as they are now.

All pages of one state of a project: which there are, what leads where, and what their scripts read.

What is wrong in the files, for a page: place, words and line of each error.
"""

from __future__ import annotations

import gc
import json
import secrets
import threading
import time
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

from archgen.diagnostics import Severity, make_visible, sort_gravest_first
from archgen.emit import site
from archgen.emit.site import page_pictures
from archgen.emit.site.chapter_html import ChapterWriter
from archgen.emit.site.matrix_files import build_matrix_files
from archgen.emit.site.page_links import open_page, renew_ids
from archgen.emit.site.script_files import EXPLORER_ANCHOR, build_explorer_files, build_search_files
from archgen.frozen import dataclass, field, replace
from archgen.live.file_watch import WatchedPlaces, join_paths
from archgen.live.warm_project import WarmProject
from archgen.pipeline import CheckedProject, UnknownVariantError
from archgen.products.compared_versions import ProjectVersion
from archgen.products.comparison_documents import read_version_before
from archgen.products.output_options import OutputOptions
from archgen.project import ProjectNotFoundError
from archgen.project.project_search import PROJECT_FILE
from archgen.resources import resource_path
from archgen.serve.live_pictures import LivePictures
from archgen.serve.project_state import (
    ProjectState,
    SelectionError,
    make_state,
    read_project,
    renew_changes,
    renew_history,
)
from archgen.views.explorer import make_explorer_map
from archgen.views.pages.report_outline import make_notices
from archgen.views.pages.single_page import make_page_at
from archgen.views.pages.site_pages import make_pages
from archgen.views.search import make_search_entries
from archgen.views.shapes import Block, Figure, Page, Section


@dataclass(frozen=True, slots=True)
class LiveStatus:
    """What readers are told: which version there is to see, and what is wrong in the files."""

    version: str = ""
    shown_since: str = ""
    """The time of day (`14:02:11`) of the state that is shown."""
    errors: tuple[ErrorNote, ...] = ()
    further_errors: int = 0
    is_outdated: bool = False
    """Whether the files as they are cannot be shown, so that an older state is."""

    def to_json(self) -> str:
        """Return the status as one line."""
        fields = {
            "version": self.version,
            "since": self.shown_since,
            "errors": self.errors,
            "further": self.further_errors,
            "outdated": self.is_outdated,
        }
        return json.dumps(fields, ensure_ascii=True)


ErrorNote = Mapping[str, Any]
_MAX_NOTES = 20
"""A page shows so many errors, and says how many more there are."""


def list_error_notes(checked_project: CheckedProject) -> tuple[tuple[ErrorNote, ...], int]:
    """Return the first errors of a project as plain data, and how many there are beside them."""
    errors = [
        finding
        for finding in sort_gravest_first(checked_project.findings)
        if finding.effective_severity is Severity.ERROR
    ]
    notes = tuple(
        {
            "place": make_visible(str(error.span)) if error.span.file else "",
            "message": make_visible(error.message),
            "help": make_visible(error.help or ""),
            "rule": error.rule,
            "line": make_visible(checked_project.sources.line_of(error.span.file, error.span.line) or ""),
            "column": error.span.column,
        }
        for error in errors[:_MAX_NOTES]
    )
    return notes, len(errors) - len(notes)


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


_IDLE_TIME = 0.4
"""Seconds without a change after which the whole site is made anew: until then a reader's page comes first. Where that took
long the last time, as long again: it would hold up the next change.
"""


@dataclass(slots=True)
class _Shared:
    """What threads share, under one lock. A state and its index are never changed, only exchanged."""

    changed: threading.Condition = field(default_factory=threading.Condition)
    state: ProjectState | None = None
    index: SiteIndex | None = None
    status: LiveStatus = field(default_factory=LiveStatus)
    last_change: float = 0.0
    is_stopped: bool = False


class LiveSite:
    """The site of the project at a path. Call `start`, then `refresh` whenever files have changed, and `stop` at the end."""

    def __init__(
        self, path: Path | None, options: OutputOptions, since: str | None = None, variants: tuple[str, ...] = ()
    ) -> None:
        """Read nothing yet. Raise `ProjectNotFoundError` if there is no project.

        `since` is a version: the site shows what changed since. It is read once, by `start`. `variants` are those in
        which the project is shown; none is the project with all of them.
        """
        self._project = WarmProject(path)
        self._root, self._first_file = self._project.root, self._project.first_file
        self._path, self._options, self._since, self._variants = path, options, since, variants
        self._old_version: ProjectVersion | None = None
        self._shared = _Shared()
        self._index_lock = threading.Lock()
        self._counter = 0
        self._index_seconds = 0.0
        # Another run counts from one as well, and open pages must notice that it is another one.
        self._run = secrets.token_hex(4)
        self._pictures = LivePictures(self._announce)
        self._chapter_files: dict[str, bytes] = {}
        self._picture_ids: dict[str, str] = {}
        self._assets = {**dict(site.read_assets()), **_read_live_assets()}
        self.checked_project: CheckedProject | None = None
        """The project as it was read last, sound or not."""

    def start(self) -> None:
        """Read the project, and start to draw and to keep the whole site up to date.

        Raise `SelectionError`, and for a version before `git.GitError` and `ProjectNotFoundError`.
        """
        self._pictures.start()
        self.refresh()
        state = self._shared.state
        if self._since and state is not None:
            self._old_version = read_version_before(self._since, self._path, state.checked_project)
            self._shared.state = renew_changes(state, self._options, self._old_version)
        threading.Thread(target=self._keep_index, daemon=True).start()

    def stop(self) -> None:
        """Let all who wait go on, and end the drawing."""
        with self._shared.changed:
            self._shared.is_stopped = True
            self._shared.changed.notify_all()
        self._pictures.stop()

    @property
    def title(self) -> str:
        """What people call the project."""
        return self.checked_project.architecture.project.title if self.checked_project else self._root.name

    @property
    def state(self) -> ProjectState | None:
        """The state that is shown."""
        return self._shared.state

    @property
    def status(self) -> LiveStatus:
        """What readers are told."""
        return self._shared.status

    def list_watched_places(self) -> WatchedPlaces:
        """Return what may change the site: the folders of the project and its libraries, or a project's one file."""
        names = self.checked_project.input_files if self.checked_project else ()
        libraries = self.checked_project.loaded_project.libraries if self.checked_project else ()
        files = join_paths(self._root, dict.fromkeys((self._first_file, *names)))
        # A library in the project's folder is watched twice, which costs less than to find out.
        library_folders = join_paths(self._root, [library.folder for library in libraries if library.folder])
        return WatchedPlaces((self._root, *library_folders) if self._first_file == PROJECT_FILE else (), files)

    def refresh(self) -> None:
        """Read the files as they are now. What is not sound is not shown: the last sound state stays."""
        try:
            checked_project = read_project(self._project, self._variants)
        except (ProjectNotFoundError, UnknownVariantError) as error:
            # At the start a variant that is not there is a slip; later somebody takes it out, or renames it.
            if isinstance(error, UnknownVariantError) and self._shared.state is None:
                raise
            self._tell_failure(str(error))
            return
        self.checked_project = checked_project
        is_sound = not checked_project.structural_errors
        last_state = self._shared.state
        try:
            # Without any sound state before, what is sound of this one is better than nothing.
            is_new = is_sound or last_state is None
            state = make_state(checked_project, self._options, last_state) if is_new else last_state
        except SelectionError as error:
            if last_state is None:
                raise
            self._tell_failure(str(error))
            return
        errors, further_errors = list_error_notes(checked_project)
        with self._shared.changed:
            self._shared.last_change = time.monotonic()
            since = time.strftime("%H:%M:%S") if state is not last_state else self._shared.status.shown_since
            self._shared.state = state
            self._shared.status = LiveStatus("", since, errors, further_errors, state is last_state)
        self._announce()

    def _tell_failure(self, message: str) -> None:
        with self._shared.changed:
            note = {"place": "", "message": message, "help": "", "rule": "", "line": "", "column": 0}
            self._shared.status = replace(self._shared.status, errors=(note,), further_errors=0, is_outdated=True)
        self._announce()

    def _announce(self) -> None:
        """Tell all readers that there is something new to see."""
        with self._shared.changed:
            self._counter += 1
            self._shared.status = replace(self._shared.status, version=f"{self._run}.{self._counter}")
            self._shared.changed.notify_all()

    def wait_for_news(self, known_version: str, seconds: float) -> LiveStatus | None:
        """Wait until there is another version than this one, and return the status; None if there is none by then.

        Raise `StoppedError` when all ends.
        """
        with self._shared.changed:
            self._shared.changed.wait_for(
                lambda: self._shared.is_stopped or self._shared.status.version != known_version, seconds
            )
            if self._shared.is_stopped:
                raise StoppedError
            return self._shared.status if self._shared.status.version != known_version else None

    def read_file(self, path: str) -> bytes | None:
        """Return a file of the site, None where it has none of this path. Nothing is read from the disk by this name."""
        if path in self._assets:
            return self._assets[path]
        if path.endswith(".html"):
            return self._write_page(path)
        if path.startswith("figures/"):
            return self._write_picture(path)
        if path.startswith(("assets/", "matrix/")):
            return self._current_index().find_data_file(path)
        if path.startswith("pictures/") and path not in self._chapter_files:
            # Pages that show pictures of chapters say which there are, when they are written.
            for page_path in self._current_index().pages:
                self._write_page(page_path)
        return self._chapter_files.get(path)

    def _write_page(self, path: str) -> bytes | None:
        """Write a page of the current state. Where the index is older, only the page is made anew, not all of them."""
        state, index, version = self._shared.state, self._shared.index, self._shared.status.version
        if state is None:
            return None
        if index is None:
            index = self._current_index()
        page = index.pages.get(path)
        if page is not None and index.state is not state:
            page = make_page_at(state.lookup, state.edition, page.anchor)
        if page is None:
            # New, gone, or one that cannot be made by itself.
            index = self._current_index()
            state, page = index.state, index.pages.get(path)
        if page is None:
            return None
        map_parts = tuple(index.map_files) if page.anchor == EXPLORER_ANCHOR else ()
        return self._render(path, page, state, replace(index.frame, version=version, map_parts=map_parts))

    def _render(self, path: str, page: Page, state: ProjectState, frame: site.SiteFrame) -> bytes:
        frame = replace(
            frame,
            title=state.checked_project.architecture.project.title,
            notices=make_notices(state.lookup, state.edition),
            links=renew_ids(frame.links, path, page),
        )
        drawings = [state.edition.drawings[name] for name in list_page_drawings(page) if name in state.edition.drawings]
        self._picture_ids |= {page_pictures.picture_path(drawing.id): drawing.id for drawing in drawings}
        chapter_writer = ChapterWriter(state.checked_project.chapters.read_picture)
        data = site.write_page(path, page, self._pictures.find_pictures(drawings), frame, chapter_writer)
        self._chapter_files |= chapter_writer.files
        return data

    def _write_picture(self, path: str) -> bytes | None:
        index = self._shared.index or self._current_index()
        state = self._shared.state or index.state
        if path not in self._picture_ids:
            self._picture_ids |= {page_pictures.picture_path(name): name for name in state.edition.drawings}
        drawing = state.edition.drawings.get(self._picture_ids.get(path, ""))
        if drawing is None:
            return None
        picture = self._pictures.find_pictures((drawing,))[drawing.id]
        return site.write_picture(drawing.id, picture, index.frame.links)

    def _current_index(self) -> SiteIndex:
        """Return the index of the current state, made now if need be."""
        with self._index_lock:
            state, index = self._shared.state, self._shared.index
            if state is None:  # `start` has not come so far
                raise StoppedError
            if index is None or index.state is not state:
                self._shared.index = index = make_index(state)
            return index

    def _keep_index(self) -> None:
        """Make the whole site anew when no file has changed for a while, until all ends. Runs in a thread of its own."""
        while True:
            with self._shared.changed:
                self._shared.changed.wait_for(self._is_index_due, 1.0)
                if self._shared.is_stopped:
                    return
                state = self._shared.state
                is_due = self._is_index_due()
                left = max(_IDLE_TIME, self._index_seconds) - (time.monotonic() - self._shared.last_change)
            if not is_due or state is None:
                continue
            if left > 0:
                time.sleep(left)
                continue
            start = time.monotonic()
            newer_state = renew_history(state, self._options)
            if self._old_version:
                newer_state = renew_changes(newer_state, self._options, self._old_version)
            with self._shared.changed:
                if self._shared.state is state:
                    self._shared.state = newer_state
            self._current_index()
            # Archgen's command line collects no garbage, since a run is short; this one is not.
            gc.collect()
            self._index_seconds = time.monotonic() - start
            self._announce()

    def _is_index_due(self) -> bool:
        shared = self._shared
        return shared.is_stopped or (
            shared.state is not None and (shared.index is None or shared.index.state is not shared.state)
        )


class StoppedError(Exception):
    """The preview ends: nothing more comes."""


def _read_live_assets() -> dict[str, bytes]:
    """Read the script and the style that only served pages load."""
    folder = resource_path("backends", "site", "live")
    return {f"live/{file.name}": file.read_bytes() for file in sorted(folder.iterdir()) if file.is_file()}
