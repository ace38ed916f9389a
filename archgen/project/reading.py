"""Read the files of a project in the order of `sources`, each normalised by itself."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from archgen.diagnostic import Diagnostic
from archgen.project import baseline
from archgen.project.find import MARKER
from archgen.project.slices import Slice, Slices, parse
from archgen.schema import sections
from archgen.source import Sources, Span
from archgen.suggest import closest
from archgen.syntax import globs
from archgen.syntax.files import Files, read
from archgen.syntax.tree import Listing, Scalar

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.syntax.tree import Document, Value

_NO_SOURCES = frozenset({"backends"})
"""Folders that are not searched for slices unless `sources` names them."""
_NO_SLICE = frozenset({"archgen", baseline.MARK})
"""Keys of files that are not slices: projects of their own (a packed one, for instance) and baselines."""


@dataclass(slots=True)
class Reading:
    """What has been read so far; the functions below add to it."""

    files: Files
    sources: Sources = field(default_factory=Sources)
    documents: list[Document] = field(default_factory=list)
    diagnostics: list[Diagnostic] = field(default_factory=list)
    known: Slices | None = None
    seen: set[str] = field(default_factory=set)
    broken: list[str] = field(default_factory=list)
    lost: set[str] = field(default_factory=set)
    """The keys of what was not understood, and the ids that malformed ones may have been meant to be."""
    partial: bool = False
    """Whether a whole file or section was not understood."""


def _read(reading: Reading, file: str) -> Slice:
    """Read and parse one file; only its text is recorded, for excerpts."""
    # A lone surrogate or a line break in a name could not be written to a terminal or a report.
    if not file.isprintable():
        message = f"a file's name cannot be read as text: {file!a}"
        unnamed = Diagnostic("syntax-error", message, Span.of_file(MARKER), help="rename the file")
        return Slice(file, "", None, (unnamed,))
    text = read(reading.files, file)
    reading.sources.add(file, text.text)
    return Slice(file, text.text, None, (text.problem,)) if text.problem else parse(file, text.text, reading.known)


def take(reading: Reading, file: str) -> None:
    """Read one file as a slice, whatever it holds."""
    reading.seen.add(file)
    _keep(reading, _read(reading, file))


def _keep(reading: Reading, one: Slice) -> None:
    understood = one.understood()
    reading.diagnostics.extend(understood.diagnostics)
    reading.lost.update(understood.lost)
    reading.partial |= understood.partial
    if one.document is None:
        reading.broken.append(one.file)
    else:
        reading.documents.append(one.document)


def read_sources(reading: Reading) -> None:
    """Read the files that `sources` names, or all YAML files below where it is not written."""
    listed = reading.documents[0].root.entries.get("sources") if reading.documents else None
    if listed is None:
        _read_all(reading)
    elif isinstance(listed.value, Listing):
        for pattern in listed.value.items:
            for file in matches(reading, pattern):
                if file not in reading.seen:
                    _take_slice(reading, file, named=isinstance(pattern, Scalar) and pattern.text == file)


def _take_slice(reading: Reading, file: str, *, named: bool) -> None:
    """Read a file that `sources` names; one that only a wildcard found is left out if it is no slice."""
    reading.seen.add(file)
    one = _read(reading, file)
    if named or _NO_SLICE.isdisjoint(one.sections):
        _keep(reading, one)


def _read_all(reading: Reading) -> None:
    """Read every *.yaml below that holds a section, and list those that do not in one note."""
    known, ignored = sections(), list[tuple[str, str | None]]()
    for file in globs.expand(reading.files, "**/*.yaml", skip=_NO_SOURCES):
        if file in reading.seen:
            continue
        reading.seen.add(file)
        one = _read(reading, file)
        # Tested on the text, since a baseline that a merge broke cannot be parsed.
        if baseline.is_own(one.text):
            continue  # broken or not, it is judged where it is used
        # A repository holds other YAML as well, some of it templates that no parser reads. A broken file is an error
        # only if it seems to be meant as a slice.
        if one.document is None and one.diagnostics[0].rule != "too-large" and not _looks_like_slice(one, known):
            ignored.append((file, None))
        elif one.document is None:
            _keep(reading, one)
        elif not known.isdisjoint(one.sections):
            if _NO_SLICE.isdisjoint(one.sections):
                _keep(reading, one)
        elif one.sections:
            # With a guess from the first key that is nearly the name of a section, such as `group:`.
            ignored.append((file, next(filter(None, (closest(key, known) for key in one.sections)), None)))
    # With a broken archgen.yaml it is unknown whether it has `sources`: the note could be wrong.
    if ignored and MARKER not in reading.broken:
        reading.diagnostics.append(_ignored(ignored))


def _looks_like_slice(one: Slice, known: frozenset[str]) -> bool:
    """Whether a file that cannot be parsed was meant as a slice: a line begins a section, or its text is unknown."""
    return not one.text or re.search(rf"^\W*(?:{'|'.join(sorted(known))})\W*:", one.text, re.MULTILINE) is not None


def _ignored(ignored: list[tuple[str, str | None]]) -> Diagnostic:
    names = ", ".join(f"`{file}`" for file, _ in ignored)
    many = len(ignored) > 1
    message = f"{names} {'hold' if many else 'holds'} no section of the language and {'are' if many else 'is'} not read"
    guesses = [f"did you mean `{guess}:` in `{file}`?" for file, guess in ignored if guess]
    help_line = guesses[0] if guesses else f"name the project's files in `sources` of {MARKER}, and this note goes away"
    return Diagnostic("ignored-file", message, Span.of_file(MARKER), help=help_line)


def matches(reading: Reading, pattern: Value) -> Iterator[str]:
    """Yield the files that one pattern matches; report a pattern that leaves the project or matches nothing."""
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
