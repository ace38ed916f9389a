"""Drop findings that a read error explains: what could not be understood was not read, and then seems to be missing."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from archgen.diagnostics.diagnostic import Diagnostic
    from archgen.diagnostics.source_span import SourceTexts

_LACK_RULES = frozenset(
    {
        "disconnected-component",
        "half-written",
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
_UNUSED_RULES = frozenset(
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
_WORD_PATTERN = re.compile(r"[^\s.,:#\"'{}\[\]]+")
_MAX_LINES = 200
"""The lines below an error that are looked at: about one element's worth."""


def drop_aftermath(
    diagnostics: Iterable[Diagnostic], errors: Iterable[Diagnostic], sources: SourceTexts
) -> Iterator[Diagnostic]:
    """Yield the findings that read errors do not explain. The others return once the errors are fixed."""
    errors = tuple(errors)
    damaged_elements = {error.element for error in errors if error.element}
    # Where reading failed there is no tree to look at: words of the text stand in for it.
    damaged_words = {
        word
        for file, number in _list_damaged_lines(errors, sources)
        for word in _WORD_PATTERN.findall(sources.line_of(file, number) or "")
    }
    for diagnostic in diagnostics:
        is_explained_lack = diagnostic.rule in _LACK_RULES and diagnostic.element in damaged_elements
        is_explained_unused = diagnostic.rule in _UNUSED_RULES and not damaged_words.isdisjoint(
            _names_in_finding(diagnostic, sources)
        )
        if not is_explained_lack and not is_explained_unused:
            yield diagnostic


def _list_damaged_lines(errors: Iterable[Diagnostic], sources: SourceTexts) -> dict[tuple[str, int], None]:
    """Return the lines with an error, and those below each that are indented more, by file and number.

    Each line once: thousands of errors may lie in one line of megabytes.
    """
    damaged_lines: dict[tuple[str, int], None] = {}
    for file, first_number in dict.fromkeys((error.span.file, error.span.line) for error in errors):
        damaged_lines[file, first_number] = None
        first_line = sources.line_of(file, first_number) or ""
        depth = len(first_line) - len(first_line.lstrip())
        for number in range(first_number + 1, first_number + _MAX_LINES):
            line = sources.line_of(file, number)
            if line is None or (line.strip() and len(line) - len(line.lstrip()) <= depth):
                break
            damaged_lines[file, number] = None
    return damaged_lines


def _names_in_finding(diagnostic: Diagnostic, sources: SourceTexts) -> Iterator[str]:
    """Yield what a finding is about: the word that it points at, and the last part of its element's id."""
    span = diagnostic.span
    yield (sources.line_of(span.file, span.line) or "")[span.column - 1 : span.end_column - 1]
    yield (diagnostic.element or "").rpartition(".")[2]
