"""Guess the element whose title stands where its id is asked: `owner: LogTech GmbH` means the partner `logtech`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from itertools import chain
from typing import NamedTuple

from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.diagnostics.source_span import SourceTexts, Span
from archgen.diagnostics.suggestions import find_closest
from archgen.model.architecture import Architecture

_REFERENCE_HELPS = ("a reference is", "write `[")
"""How help begins where a reference was asked; the second takes several words for several references."""
_ID_HELP = "an id is"
_KINDS_BY_KEY = {"`owner`": "partner", "`host`": "host", "`connects`": "host", "`container`": "container"}
"""What an id at a key names, by how a message begins (after `an entry of`)."""


class _TitledElement(NamedTuple):
    """An element that a title means: its complete id, and where it is declared."""

    id: str
    at: Span


def add_title_guesses(
    diagnostics: Iterable[Diagnostic], architecture: Architecture, sources: SourceTexts
) -> Iterator[Diagnostic]:
    """Yield the diagnostics; one about a word that is the title of an element says which id was meant."""
    indexes: dict[str, dict[str, _TitledElement]] = {}
    for diagnostic in diagnostics:
        kind = _find_kind(diagnostic)
        if kind is None:
            yield diagnostic
            continue
        if kind not in indexes:  # built once, and only where something is wrong
            indexes[kind] = _index_titles(architecture, kind)
        written_text = _quoted_text(diagnostic, sources)
        text = written_text.casefold()
        # Several words may be several references: then only a whole title is a better guess.
        is_list = (diagnostic.help or "").startswith("write")
        element = indexes[kind].get(text if is_list else find_closest(text, indexes[kind]) or "")
        if element is None or element.id == written_text:  # the element itself is of the wrong kind there
            yield diagnostic
        else:
            label = Label(element.at, "declared here")
            yield replace(diagnostic, help=f"did you mean `{element.id}`?", labels=(label,))


def _find_kind(diagnostic: Diagnostic) -> str | None:
    """Return the kind of what a diagnostic finds to be no id; None if it is about something else, or has a guess."""
    help_line = diagnostic.help or ""
    if diagnostic.rule == "unknown-reference" and not help_line:
        return "part"
    if diagnostic.rule != "wrong-value":
        return None
    if help_line.startswith(_REFERENCE_HELPS):
        return "part"
    subject = diagnostic.message.removeprefix("an entry of ").split(" cannot be ", 1)[0]
    return _KINDS_BY_KEY.get(subject) if help_line.startswith(_ID_HELP) else None


def _index_titles(architecture: Architecture, kind: str) -> dict[str, _TitledElement]:
    """Return the elements of a kind by title, in one case, and by id. Of several with one title the first counts."""
    tables: Mapping[str, Iterable[Iterable[object]]] = {
        # Components first: most references are to them.
        "part": (architecture.components.values(), architecture.groups.values()),
        "partner": (architecture.partners.values(),),
        "host": (architecture.hosts.values(),),
        "container": (architecture.containers.values(),),
    }
    index: dict[str, _TitledElement] = {}
    for element in chain.from_iterable(tables[kind]):
        titled_element = _TitledElement(element.id, element.at)  # type: ignore[attr-defined]
        index.setdefault(element.title.casefold(), titled_element)  # type: ignore[attr-defined]
        index.setdefault(element.id, titled_element)  # type: ignore[attr-defined]
    return index


def _quoted_text(diagnostic: Diagnostic, sources: SourceTexts) -> str:
    span = diagnostic.span
    line = sources.line_of(span.file, span.line) or ""
    return line[span.column - 1 : span.end_column - 1].strip("\"'") if span.line == span.end_line else ""
