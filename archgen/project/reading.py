"""Read the files of a project, in the order of `sources`, each normalised by itself."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from archgen.diagnostic import Diagnostic
from archgen.project.find import MARKER
from archgen.schema import better_keys, normalise, sections, validate
from archgen.source import Sources, Span
from archgen.suggest import closest
from archgen.syntax import globs, yaml
from archgen.syntax.files import Files, read
from archgen.syntax.tree import Listing, Scalar, Table

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from archgen.syntax.tree import Document, Value

_NO_SOURCES = frozenset({"backends"})
"""Folders that hold no slices unless `sources` names them."""


@dataclass(slots=True)
class Reading:
    """What has been read so far."""

    files: Files
    sources: Sources = field(default_factory=Sources)
    documents: list[Document] = field(default_factory=list)
    diagnostics: list[Diagnostic] = field(default_factory=list)
    seen: set[str] = field(default_factory=set)
    broken: list[str] = field(default_factory=list)
    lost: set[str] = field(default_factory=set)
    """The keys of what was not understood, and what those that cannot be ids may have been meant to be."""
    partial: bool = False
    """Whether a whole file or section was not understood."""


def _read(reading: Reading, file: str) -> tuple[Document | None, tuple[Diagnostic, ...]]:
    """Read and parse one file; nothing is kept of it yet but its text."""
    if not file.isprintable():
        message = f"a file's name cannot be read as text: {file!a}"
        return None, (Diagnostic("syntax-error", message, Span.of_file(MARKER), help="rename the file"),)
    text = read(reading.files, file)
    reading.sources.add(file, text.text)
    return (None, (text.problem,)) if text.problem else yaml.parse(file, text.text)


def take(reading: Reading, file: str) -> None:
    """Read one file, whatever it holds, as a slice."""
    reading.seen.add(file)
    _keep(reading, file, *_read(reading, file))


def _keep(reading: Reading, file: str, document: Document | None, found: tuple[Diagnostic, ...]) -> None:
    reading.diagnostics.extend(found)
    if document is None:
        reading.broken.append(file)
        reading.partial = True
        reading.lost.update(_written(reading, file))
    else:
        written = len(document.root.entries)
        wrong = validate(document)
        if wrong:
            reading.partial |= len(document.root.entries) < written
            reading.lost.update(_lost(reading, document, wrong))
        reading.diagnostics.extend(wrong)
        reading.diagnostics.extend(normalise(document))
        reading.documents.append(document)


_KEY = re.compile(r"(?<![A-Za-z0-9_.-])([A-Za-z0-9][A-Za-z0-9_.-]*+)[\"']?[ \t]*+:")
"""Begins at a word's first letter and never goes back: a long word without a colon is looked at once."""


def _written(reading: Reading, file: str) -> list[str]:
    """Give the keys in a file, read or not, as its text shows them."""
    return _KEY.findall(reading.sources.text(file) or "")


def _lost(reading: Reading, document: Document, wrong: Sequence[Diagnostic]) -> Iterator[str]:
    """Give the keys that were taken out of a document, and the ids that were meant by those that cannot be one."""
    yield from Counter(_written(reading, document.file)) - Counter(_keys(document.root))
    for diagnostic in wrong:
        at = diagnostic.span
        line = reading.sources.line(at.file, at.line) or ""
        yield from better_keys(line[at.column - 1 : at.end_column - 1])


def _keys(value: Value) -> Iterator[str]:
    if isinstance(value, Table):
        for entry in value:
            yield entry.key
            yield from _keys(entry.value)
    elif isinstance(value, Listing):
        for item in value.items:
            yield from _keys(item)


def read_sources(reading: Reading) -> None:
    """Read the files that `sources` names, or all below where nothing is written."""
    listed = reading.documents[0].root.entries.get("sources") if reading.documents else None
    if listed is None:
        _read_all(reading)
    elif isinstance(listed.value, Listing):
        for pattern in listed.value.items:
            for file in matches(reading, pattern):
                if file not in reading.seen:
                    _take_slice(reading, file, named=isinstance(pattern, Scalar) and pattern.text == file)


def _take_slice(reading: Reading, file: str, *, named: bool) -> None:
    """Read a file; what a wildcard found is left out if it is a project of its own (a packed one, for instance)."""
    reading.seen.add(file)
    document, found = _read(reading, file)
    if named or document is None or "archgen" not in document.root.entries:
        _keep(reading, file, document, found)


def _read_all(reading: Reading) -> None:
    """Read every *.yaml below that holds a section, and say which do not."""
    known, ignored = sections(), list[tuple[str, str | None]]()
    for file in globs.expand(reading.files, "**/*.yaml", skip=_NO_SOURCES):
        if file in reading.seen:
            continue
        reading.seen.add(file)
        document, found = _read(reading, file)
        if document is None and found[0].rule != "too-large" and not _looks_like_slice(reading, file, known):
            ignored.append((file, None))
        elif document is None:
            _keep(reading, file, None, found)
        elif not known.isdisjoint(document.root.entries):
            if "archgen" not in document.root.entries:
                _keep(reading, file, document, found)
        elif document.root.entries:
            ignored.append((file, next(filter(None, (closest(key, known) for key in document.root.entries)), None)))
    if ignored and MARKER not in reading.broken:
        reading.diagnostics.append(_ignored(ignored))


def _looks_like_slice(reading: Reading, file: str, known: frozenset[str]) -> bool:
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


def matches(reading: Reading, pattern: Value) -> Iterator[str]:
    """Give the files of one pattern; say where it leads out of the project or to nothing."""
    if not isinstance(pattern, Scalar):
        return
    if not globs.is_inside(pattern.text):
        message = f"`{pattern.text}` leads out of the project's folder"
        help_line = "write paths relative to the folder of archgen.yaml, with `/`"
        reading.diagnostics.append(Diagnostic("wrong-value", message, pattern.at, help=help_line))
        return
    found = globs.expand(reading.files, pattern.text)
    if not found:
        reading.diagnostics.append(Diagnostic("missing-source", f"`{pattern.text}` matches no file", pattern.at))
    yield from found
