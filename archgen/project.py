"""Find a project and read its files: archgen.yaml first, then what `sources` names, each normalised by itself."""

from __future__ import annotations

import gc
import os
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from archgen.diagnostic import Diagnostic, Rule, Severity
from archgen.schema import normalise, sections, validate
from archgen.source import Sources, Span
from archgen.suggest import closest
from archgen.syntax import files, globs, yaml
from archgen.syntax.tree import Ignore, Listing, Scalar, Table

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from archgen.syntax.tree import Document, Value

MARKER = "archgen.yaml"
_NO_SOURCES = frozenset({"backends"})
"""Folders that hold no slices unless `sources` names them."""


class ProjectNotFoundError(Exception):
    """There is no project where one was looked for. The text says what to do."""


@dataclass(frozen=True, slots=True)
class Loaded:
    """A project, read. `documents` are in normal form, in the order in which they are merged.

    `id` and `title` are what the project is called where it does not say so itself. `rules` are the settings as they
    stand in `rules:` (names not checked), `rule_places` where. `interfaces` are the interface files, relative to `root`.
    `chapters` are the entries of `report.chapters`, None where nobody wrote them.
    """

    root: Path
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


@dataclass(slots=True)
class _Reading:
    """What has been read so far."""

    root: Path
    sources: Sources = field(default_factory=Sources)
    documents: list[Document] = field(default_factory=list)
    diagnostics: list[Diagnostic] = field(default_factory=list)
    seen: set[str] = field(default_factory=set)


def load(path: Path | None = None) -> Loaded:
    """Read the project in a folder, in a file, or (with nothing given) around the current folder."""
    root, first = find(path)
    reading = _Reading(root)
    collecting = gc.isenabled()
    gc.disable()  # trees hold no circles, and looking for them while they grow takes as long again as reading
    try:
        _take(reading, first)
        if first == MARKER:
            _read_sources(reading)
        return _finish(reading, first)
    finally:
        if collecting:
            gc.enable()


def find(path: Path | None) -> tuple[Path, str]:
    """Give the project's folder, and the name of the file in it that is read first."""
    if path is None:
        here = Path.cwd()
        for folder in (here, *here.parents):
            if os.path.lexists(folder / MARKER):
                return folder, MARKER
        msg = f"no {MARKER} here or in a folder above: `archgen init` makes one, or name a file"
        raise ProjectNotFoundError(msg)
    if path.is_dir():
        if os.path.lexists(path / MARKER):
            return path.resolve(), MARKER
        msg = f"{path} holds no {MARKER}: `archgen init` makes one, or name a file"
        raise ProjectNotFoundError(msg)
    if not os.path.lexists(path):
        msg = f"{path} does not exist"
        raise ProjectNotFoundError(msg)
    return path.parent.resolve(), path.name


def _read(reading: _Reading, file: str) -> tuple[Document | None, tuple[Diagnostic, ...]]:
    """Read and parse one file; nothing is kept of it yet but its text."""
    text = files.read(reading.root, file)
    reading.sources.add(file, text.text)
    return (None, (text.problem,)) if text.problem else yaml.parse(file, text.text)


def _take(reading: _Reading, file: str) -> None:
    """Read one file, whatever it holds, as a slice."""
    reading.seen.add(file)
    _keep(reading, *_read(reading, file))


def _keep(reading: _Reading, document: Document | None, found: tuple[Diagnostic, ...]) -> None:
    reading.diagnostics.extend(found)
    if document is not None:
        reading.diagnostics.extend(validate(document))
        reading.diagnostics.extend(normalise(document))
        reading.documents.append(document)


def _read_sources(reading: _Reading) -> None:
    listed = reading.documents[0].root.entries.get("sources") if reading.documents else None
    if listed is None:
        _read_all(reading)
    elif isinstance(listed.value, Listing):
        for pattern in listed.value.items:
            for file in _matches(reading, pattern):
                if file not in reading.seen:
                    _take_slice(reading, file, named=isinstance(pattern, Scalar) and pattern.text == file)


def _take_slice(reading: _Reading, file: str, *, named: bool) -> None:
    """Read a file; what a wildcard found is left out if it is a project of its own (a packed one, for instance)."""
    reading.seen.add(file)
    document, found = _read(reading, file)
    if named or document is None or "archgen" not in document.root.entries:
        _keep(reading, document, found)


def _read_all(reading: _Reading) -> None:
    """Read every *.yaml below that holds a section, and say which do not."""
    known, ignored = sections(), list[tuple[str, str | None]]()
    for file in globs.expand(reading.root, "**/*.yaml", skip=_NO_SOURCES):
        if file in reading.seen:
            continue
        reading.seen.add(file)
        document, found = _read(reading, file)
        if document is None and found[0].rule != "too-large" and not _looks_like_slice(reading, file, known):
            ignored.append((file, None))
        elif document is None:
            _keep(reading, None, found)
        elif not known.isdisjoint(document.root.entries):
            if "archgen" not in document.root.entries:
                _keep(reading, document, found)
        elif document.root.entries:
            ignored.append((file, next(filter(None, (closest(key, known) for key in document.root.entries)), None)))
    if ignored:
        reading.diagnostics.append(_ignored(ignored))


def _looks_like_slice(reading: _Reading, file: str, known: frozenset[str]) -> bool:
    """Say whether a file that cannot be parsed was meant as a slice: one that cannot be read at all, or has a section."""
    text = reading.sources.text(file) or ""
    return not text or re.search(rf"^\W*(?:{'|'.join(sorted(known))})\W*:", text, re.MULTILINE) is not None


def _ignored(ignored: list[tuple[str, str | None]]) -> Diagnostic:
    names = ", ".join(f"`{file}`" for file, _ in ignored)
    many = len(ignored) > 1
    message = f"{names} {'hold' if many else 'holds'} no section of the language and {'are' if many else 'is'} not read"
    guesses = [f"did you mean `{guess}:` in `{file}`?" for file, guess in ignored if guess]
    help_line = guesses[0] if guesses else f"name the project's files in `sources` of {MARKER}, and this note goes away"
    return Diagnostic("ignored-file", message, Span.of_file(MARKER), help=help_line)


def _matches(reading: _Reading, pattern: Value) -> Iterator[str]:
    """Give the files of one pattern; say where it leads out of the project or to nothing."""
    if not isinstance(pattern, Scalar):
        return
    if not globs.is_inside(pattern.text):
        message = f"`{pattern.text}` leads out of the project's folder"
        help_line = "write paths relative to the folder of archgen.yaml, with `/`"
        reading.diagnostics.append(Diagnostic("wrong-value", message, pattern.at, help=help_line))
        return
    found = globs.expand(reading.root, pattern.text)
    if not found:
        reading.diagnostics.append(Diagnostic("missing-source", f"`{pattern.text}` matches no file", pattern.at))
    yield from found


def _finish(reading: _Reading, first: str) -> Loaded:
    stem = reading.root.name if first == MARKER else Path(first).stem
    words = re.findall(r"[a-z0-9]+", stem.lower())
    slug = "_".join(words) if words and words[0][0].isalpha() else "_".join(["project", *words])
    interfaces = [
        file
        for listing in _values(reading, "ros", "interfaces")
        if isinstance(listing, Listing)
        for pattern in listing.items
        for file in _matches(reading, pattern)
    ]
    settings = dict(_settings(reading))
    distro = next((value.text for value in _values(reading, "ros", "distro") if isinstance(value, Scalar)), None)
    chapters = next((value for value in _values(reading, "report", "chapters") if isinstance(value, Listing)), None)
    return Loaded(
        root=reading.root,
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
        layout=next((value for value in _values(reading, "layout") if isinstance(value, Table)), None),
    )


def _settings(reading: _Reading) -> Iterator[tuple[str, tuple[Severity, Span]]]:
    for table in _values(reading, "rules"):
        for entry in table if isinstance(table, Table) else ():
            if isinstance(entry.value, Scalar):
                yield entry.key, (Severity(entry.value.text), entry.at)


def _values(reading: _Reading, *path: str) -> Iterator[Value]:
    """Give what the documents hold at a path, in their order."""
    for document in reading.documents:
        value: Value | None = document.root
        for key in path:
            value = value.get(key) if isinstance(value, Table) else None
        if value is not None:
            yield value


RULES: tuple[Rule, ...] = (
    Rule(
        "ignored-file",
        Severity.NOTE,
        """A YAML file below the project's folder holds no section of the language and is not read.

Why: where `sources` is left out, every YAML file below is looked at. Parameter files and workflows are not meant, a file
with a slip in its only section is; the note lists both.

Bad:

    # file: archgen.yaml
    archgen: 1
    # file: params.yaml
    max_speed: 0.4

Good:

    # file: archgen.yaml
    archgen: 1
    sources: []
    # file: params.yaml
    max_speed: 0.4
""",
    ),
    Rule(
        "missing-source",
        Severity.WARNING,
        """A pattern in `sources` or `ros.interfaces` matches no file.

Why: a slip in a pattern would leave out files without a word.

Bad:

    # file: archgen.yaml
    archgen: 1
    sources: ["gruops/*.yaml"]
    # file: groups/sensing.yaml
    groups: {sensing: Sensing}

Good:

    # file: archgen.yaml
    archgen: 1
    sources: ["groups/*.yaml"]
    # file: groups/sensing.yaml
    groups: {sensing: Sensing}
""",
    ),
)
