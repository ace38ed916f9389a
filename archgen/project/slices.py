"""One file of a project, understood by itself: parsed, validated, in normal form. The same text is understood once."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

from archgen.diagnostic import Diagnostic
from archgen.schema import better_keys, normalise, validate
from archgen.syntax import yaml
from archgen.syntax.tree import Document, Listing, Table, Value


@dataclass(frozen=True, slots=True)
class Understood:
    """What validating a slice came to. `lost` are the keys that were taken out of it, and what those that cannot be ids may
    have been meant to be; with `partial` a whole section is among them.
    """

    diagnostics: tuple[Diagnostic, ...]
    lost: tuple[str, ...] = ()
    partial: bool = False


@dataclass(slots=True)
class Slice:
    """A file's document, None where it cannot be parsed, and the sections that it writes."""

    file: str
    text: str
    document: Document | None
    diagnostics: tuple[Diagnostic, ...]
    sections: tuple[str, ...] = ()
    _understood: Understood | None = None

    def understood(self) -> Understood:
        """Validate the document and bring it into normal form, the first time that somebody asks."""
        if self._understood is None:
            self._understood = _understand(self)
        return self._understood


Slices = dict[tuple[str, str], Slice]
"""Slices by file and text, for who reads a project at many revisions: most files are the same in most of them."""


def parse(file: str, text: str, known: Slices | None = None) -> Slice:
    """Parse a file, or take it from those that are known."""
    found = known.get((file, text)) if known is not None else None
    if found is None:
        document, diagnostics = yaml.parse(file, text)
        sections = tuple(document.root.entries) if document is not None else ()
        found = Slice(file, text, document, diagnostics, sections)
        if known is not None:
            known[file, text] = found
    return found


def _understand(one: Slice) -> Understood:
    if one.document is None:
        return Understood(one.diagnostics, tuple(_written(one.text)), partial=True)
    wrong = validate(one.document)
    lost = tuple(_lost(one, one.document, wrong)) if wrong else ()
    partial = len(one.document.root.entries) < len(one.sections)
    return Understood((*one.diagnostics, *wrong, *normalise(one.document)), lost, partial)


_KEY = re.compile(r"(?<![A-Za-z0-9_.-])([A-Za-z0-9][A-Za-z0-9_.-]*+)[\"']?[ \t]*+:")
"""Begins at a word's first letter and never goes back: a long word without a colon is looked at once."""


def _written(text: str) -> list[str]:
    """Give the keys in a file, read or not, as its text shows them."""
    return _KEY.findall(text)


def _lost(one: Slice, document: Document, wrong: tuple[Diagnostic, ...]) -> Iterator[str]:
    """Give the keys that were taken out of a document, and the ids that were meant by those that cannot be one."""
    yield from Counter(_written(one.text)) - Counter(_keys(document.root))
    lines = one.text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    for diagnostic in wrong:
        at = diagnostic.span
        line = lines[at.line - 1] if 0 < at.line <= len(lines) else ""
        yield from better_keys(line[at.column - 1 : at.end_column - 1])


def _keys(value: Value) -> Iterator[str]:
    if isinstance(value, Table):
        for entry in value:
            yield entry.key
            yield from _keys(entry.value)
    elif isinstance(value, Listing):
        for item in value.items:
            yield from _keys(item)
