"""Load a project: everything that later stages need to know about its files."""

from __future__ import annotations

import re
from dataclasses import field
from pathlib import Path
from typing import TYPE_CHECKING

from archgen.diagnostic import Diagnostic, Severity
from archgen.frozen import dataclass
from archgen.project.find import MARKER, find
from archgen.project.reading import Reading, matches, read_sources, take
from archgen.project.slices import Slices
from archgen.source import Sources, Span
from archgen.syntax.files import Files
from archgen.syntax.folder import Folder
from archgen.syntax.tree import Document, Ignore, Listing, Scalar, Table

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from archgen.syntax.tree import Value


@dataclass(frozen=True, slots=True)
class Loaded:
    """A project whose files have been read. `documents` are in normal form, in the order in which they are merged.

    `first_file` was read first. `id` and `title` are the defaults for a project that states neither. `rule_settings`
    are the severities in `rules:` by name (names not checked), `rule_spans` where they are written. `interface_files`
    are relative to the project's folder. `chapter_entries` are those of `report.chapters`, None if it is not written.

    Nothing is used of the files in `broken_files`. `lost_keys` are the keys in them, and in whatever else was not
    understood: what they may declare is never reported as missing. `partial` is whether that was a whole file or
    section.
    """

    files: Files
    first: str
    id: str
    title: str
    documents: tuple[Document, ...]
    sources: Sources
    diagnostics: tuple[Diagnostic, ...]
    ignores: Mapping[str, tuple[Ignore, ...]] = field(default_factory=dict)
    rules: Mapping[str, Severity] = field(default_factory=dict)
    rule_places: Mapping[str, Span] = field(default_factory=dict)
    distro: str | None = None
    interfaces: tuple[str, ...] = ()
    chapters: tuple[Scalar, ...] | None = None
    layout: Table | None = None
    broken: tuple[str, ...] = ()
    lost: frozenset[str] = frozenset()
    partial: bool = False

    @property
    def root(self) -> Path:
        """The project's folder."""
        return self.files.root


def load(path: Path | None = None, known: Slices | None = None) -> Loaded:
    """Read the project in a folder, in a file, or (None) around the current folder."""
    root, first = find(path)
    return load_from(Folder(root), first, known)


def load_from(files: Files, first: str, known: Slices | None = None) -> Loaded:
    """Read a project, wherever its files are, beginning with `first_file`.

    Slices in `parsed_slices` are not parsed again, and new ones are added to it.
    """
    reading = Reading(files, known=known)
    take(reading, first)
    if first == MARKER:  # a file of any other name is the whole project: its `sources` are not followed
        read_sources(reading)
    return _finish(reading, first)


def _finish(reading: Reading, first: str) -> Loaded:
    # The default id and title come from the folder's name, or from the file's. A bare clone is called `robot.git`.
    stem = reading.files.root.name.removesuffix(".git") if first == MARKER else Path(first).stem
    words = re.findall(r"[a-z0-9]+", stem.lower())
    slug = "_".join(words) if words and words[0][0].isalpha() else "_".join(["project", *words])
    interfaces = [
        file
        for listing in _values(reading, "ros", "interfaces")
        if isinstance(listing, Listing)
        for pattern in listing.items
        for file in matches(reading, pattern)
    ]
    settings = dict(_settings(reading))
    # Read off the documents before they are merged, because shipped types and interfaces depend on the distribution.
    # In a conflict the first value wins, as it does in merging.
    distro = next((value.text for value in _values(reading, "ros", "distro") if isinstance(value, Scalar)), None)
    chapters = next((value for value in _values(reading, "report", "chapters") if isinstance(value, Listing)), None)
    return Loaded(
        files=reading.files,
        first=first,
        id=slug,
        title=" ".join(words).capitalize() or "Project",
        documents=tuple(reading.documents),
        sources=reading.sources,
        diagnostics=tuple(reading.diagnostics),
        ignores={document.file: document.ignores for document in reading.documents if document.ignores},
        rules={name: severity for name, (severity, _) in settings.items()},
        rule_places={name: place for name, (_, place) in settings.items()},
        distro=distro,
        interfaces=tuple(dict.fromkeys(interfaces)),
        chapters=tuple(item for item in chapters.items if isinstance(item, Scalar)) if chapters else None,
        broken=tuple(reading.broken),
        lost=frozenset(reading.lost),
        partial=reading.partial,
        layout=next((value for value in _values(reading, "layout") if isinstance(value, Table)), None),
    )


def _settings(reading: Reading) -> Iterator[tuple[str, tuple[Severity, Span]]]:
    for table in _values(reading, "rules"):
        for entry in table if isinstance(table, Table) else ():
            if isinstance(entry.value, Scalar):
                yield entry.key, (Severity(entry.value.text), entry.at)


def _values(reading: Reading, *path: str) -> Iterator[Value]:
    """Yield the nodes that the documents hold at a path of keys, in the order of the documents."""
    for document in reading.documents:
        value: Value | None = document.root
        for key in path:
            value = value.get(key) if isinstance(value, Table) else None
        if value is not None:
            yield value
