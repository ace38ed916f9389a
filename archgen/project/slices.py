"""One file of a project by itself: parsed, validated and normalised. The same text is processed only once."""

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
    """The result of validating a slice.

    `lost_keys` are the keys that were taken out of it, and the ids that malformed ones may have been meant to be.
    `partial` is whether a whole section is among them.
    """

    diagnostics: tuple[Diagnostic, ...]
    lost: tuple[str, ...] = ()
    partial: bool = False


@dataclass(slots=True)
class Slice:
    """A file's document, None where it cannot be parsed, and the sections that it writes.

    `sections` are those of the text: validation may take some of them out of the document.
    """

    file: str
    text: str
    document: Document | None
    diagnostics: tuple[Diagnostic, ...]
    sections: tuple[str, ...] = ()
    _understood: Understood | None = None

    def understood(self) -> Understood:
        """Validate and normalise the document, in place, on the first call; later calls return the same result."""
        if self._understood is None:
            self._understood = _understand(self)
        return self._understood


Slices = dict[tuple[str, str], Slice]
"""Cache of slices by file and text, for reading a project at many revisions, most of whose files are the same.

The documents are shared by all revisions, so no tree may change after `Slice.validate_once`.
"""


def parse(file: str, text: str, known: Slices | None = None) -> Slice:
    """Parse a file, or take it from the cache; a newly parsed slice is added to the cache."""
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
    # Both before normalise: it removes empty sections, which are not lost but simply not written.
    partial = len(one.document.root.entries) < len(one.sections)
    return Understood((*one.diagnostics, *wrong, *normalise(one.document)), lost, partial)


_KEY = re.compile(r"(?<![A-Za-z0-9_.-])([A-Za-z0-9][A-Za-z0-9_.-]*+)[\"']?[ \t]*+:")
"""A word before a colon. It starts only at a word's beginning, and possessive quantifiers (`*+`) never backtrack: a
long word without a colon is scanned once, not once for each of its letters.
"""


def _written(text: str) -> list[str]:
    """Return everything in a text that looks like a key; works on text that cannot be parsed."""
    return _KEY.findall(text)


def _lost(one: Slice, document: Document, wrong: tuple[Diagnostic, ...]) -> Iterator[str]:
    """Yield the keys that were taken out of a document, and the ids that malformed keys may have been meant to be."""
    # Counted, not a set: of two elements with the same id in different sections one may be lost and the other not.
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
