"""Drop findings that a read error explains: what could not be understood was not read, and then seems to be missing."""

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
"""Rules that report what an element lacks (or that depend on a default or a `status: planned`): dropped for an element
in which something could not be read.
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
"""Rules that report that something is not used: dropped for names that occur where something could not be read."""
_WORD = re.compile(r"[^\s.,:#\"'{}\[\]]+")
_FURTHEST = 200
"""The lines below an error that are looked at: about one element's worth."""


def quiet(found: Iterable[Diagnostic], errors: Iterable[Diagnostic], sources: Sources) -> Iterator[Diagnostic]:
    """Yield the findings that read errors do not explain. The others return once the errors are fixed."""
    errors = tuple(errors)
    damaged = {error.element for error in errors if error.element}
    # Where reading failed there is no tree to look at: words of the text stand in for it.
    words = {word for error in errors for word in _words_at(error.span, sources)}
    for diagnostic in found:
        lacks = diagnostic.rule in _LACKS and diagnostic.element in damaged
        unused = diagnostic.rule in _UNUSED and not words.isdisjoint(_names(diagnostic, sources))
        if not lacks and not unused:
            yield diagnostic


def _words_at(span: Span, sources: Sources) -> Iterator[str]:
    """Yield the words of the line with the error, and of the lines below it that are indented more."""
    first = sources.line(span.file, span.line) or ""
    yield from _WORD.findall(first)
    depth = len(first) - len(first.lstrip())
    for number in range(span.line + 1, span.line + _FURTHEST):
        line = sources.line(span.file, number)
        if line is None or (line.strip() and len(line) - len(line.lstrip()) <= depth):
            return
        yield from _WORD.findall(line)


def _names(diagnostic: Diagnostic, sources: Sources) -> Iterator[str]:
    """Yield what a finding is about: the word that it points at, and the last part of its element's id."""
    span = diagnostic.span
    yield (sources.line(span.file, span.line) or "")[span.column - 1 : span.end_column - 1]
    yield (diagnostic.element or "").rpartition(".")[2]
