"""Guess the element whose title stands where its id is asked: `owner: LogTech GmbH` means the partner `logtech`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import chain
from typing import NamedTuple

from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.diagnostics.source_span import SourceTexts, Span
from archgen.diagnostics.suggestions import find_closest
from archgen.language.language_tables import PLAIN_SECTIONS
from archgen.model.architecture import Architecture

_MAX_COMPARISONS = 300_000
"""How many titles may be compared in one run, as for misspelt ids. What comes later is reported without a guess."""


class _TitledElement(NamedTuple):
    """An element that a title means: its complete id, and where it is declared."""

    id: str
    at: Span


def add_title_guesses(
    diagnostics: Iterable[Diagnostic], architecture: Architecture, sources: SourceTexts
) -> Iterator[Diagnostic]:
    """Yield the diagnostics; one about a word that is the title of an element says which id was meant."""
    indexes: dict[str, dict[str, _TitledElement]] = {}
    comparisons_left = _MAX_COMPARISONS
    for diagnostic in diagnostics:
        asked_name = diagnostic.asked_name
        if asked_name is None:
            yield diagnostic
            continue
        if asked_name.kind not in indexes:  # built once, and only where something is wrong
            indexes[asked_name.kind] = _index_titles(architecture, asked_name.kind)
        index = indexes[asked_name.kind]
        written_text = _quoted_text(diagnostic, sources)
        element = index.get(written_text.casefold())
        if element is None and not asked_name.is_list and len(index) <= comparisons_left:
            comparisons_left -= len(index)
            element = index.get(find_closest(written_text.casefold(), index) or "")
        if element is None or element.id == written_text:  # the element itself is of the wrong kind there
            yield diagnostic
        else:
            label = Label(element.at, "declared here")
            yield replace(diagnostic, help=f"did you mean `{element.id}`?", labels=(label,))


def _index_titles(architecture: Architecture, kind: str) -> dict[str, _TitledElement]:
    """Return the elements of a kind by title, in one case, and by id. Of several with one title the first counts."""
    # Components first: most references are to them.
    parts = (architecture.components.values(), architecture.groups.values())
    plain = PLAIN_SECTIONS.get(kind.replace(" ", "_"))
    tables: Iterable[Iterable[object]] = (getattr(architecture, plain).values(),) if plain else parts
    index: dict[str, _TitledElement] = {}
    for element in chain.from_iterable(tables):
        titled_element = _TitledElement(element.id, element.at)  # type: ignore[attr-defined]
        index.setdefault(element.title.casefold(), titled_element)  # type: ignore[attr-defined]
        index.setdefault(element.id, titled_element)  # type: ignore[attr-defined]
    return index


def _quoted_text(diagnostic: Diagnostic, sources: SourceTexts) -> str:
    span = diagnostic.span
    line = sources.line_of(span.file, span.line) or ""
    return line[span.column - 1 : span.end_column - 1].strip("\"'") if span.line == span.end_line else ""
