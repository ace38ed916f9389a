"""Leave out what an error in reading explains: what is not understood is not read, and would then seem to be missing."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from archgen.diagnostic import Diagnostic
    from archgen.source import Sources, Span

_LACKS = frozenset(
    {
        "disconnected-component",
        "incompatible-qos",
        "missing-detail",
        "role-mismatch",
        "unfed-input",
        "unjustified-component",
        "unjustified-node",
        "unknown-message",
        "unmapped-type",
    }
)
"""Rules that say what an element lacks (or that rest on a default or a `status: planned`): nothing is said of one in which
something could not be read.
"""
_UNUSED = frozenset(
    {
        "disconnected-component",
        "uncovered-requirement",
        "unmapped-component",
        "unpublished-output",
        "unread-output",
        "unsubscribed-input",
        "unused-type",
    }
)
"""Rules that say that nobody uses something: nothing is said of what is named where something could not be read."""
_WORD = re.compile(r"[^\s.,:#\"'{}\[\]]+")
_FURTHEST = 200
"""Lines below an error that are looked at: an element's worth."""


def quiet(found: Iterable[Diagnostic], errors: Iterable[Diagnostic], sources: Sources) -> Iterator[Diagnostic]:
    """Give the findings of analyses that the errors of reading do not explain. Mended errors bring the others back."""
    errors = tuple(errors)
    damaged = {error.element for error in errors if error.element}
    words = {word for error in errors for word in _words_at(error.span, sources)}
    for diagnostic in found:
        lacks = diagnostic.rule in _LACKS and diagnostic.element in damaged
        unused = diagnostic.rule in _UNUSED and not words.isdisjoint(_names(diagnostic, sources))
        if not lacks and not unused:
            yield diagnostic


def _words_at(span: Span, sources: Sources) -> Iterator[str]:
    """Give the words of the line with the error, and of those below that are indented more."""
    first = sources.line(span.file, span.line) or ""
    yield from _WORD.findall(first)
    depth = len(first) - len(first.lstrip())
    for number in range(span.line + 1, span.line + _FURTHEST):
        line = sources.line(span.file, number)
        if line is None or (line.strip() and len(line) - len(line.lstrip()) <= depth):
            return
        yield from _WORD.findall(line)


def _names(diagnostic: Diagnostic, sources: Sources) -> Iterator[str]:
    """Give what a finding is about: the word that it points at, and the last part of its element's id."""
    span = diagnostic.span
    yield (sources.line(span.file, span.line) or "")[span.column - 1 : span.end_column - 1]
    yield (diagnostic.element or "").rpartition(".")[2]
