"""What a card consists of, and what cards of all kinds have in common."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from archgen.diagnostics.source_span import Span
from archgen.views.lookup import Lookup


@dataclass(frozen=True, slots=True)
class ElementCard:
    """Kind, id and title of an element, where it is defined, its facts, and lists below subheadings."""

    kind: str
    id: str
    title: str
    span: Span
    facts: tuple[tuple[str, str], ...]
    lists: tuple[tuple[str, tuple[str, ...]], ...] = ()


def known_facts(facts: list[tuple[str, str]]) -> tuple[tuple[str, str], ...]:
    """Drop facts without a value."""
    return tuple((name, value) for name, value in facts if value)


def format_fact(value: object) -> str:
    """Format a field's value on one line."""
    if value is None:
        return ""
    return ", ".join(map(str, value)) if isinstance(value, tuple) else " ".join(str(value).split())


def drop_empty_lists(*lists: tuple[str, tuple[str, ...]]) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the lists that hold something: of most elements these say nothing, and that is no news."""
    return (each for each in lists if each[1])


def list_finding_lines(lookup: Lookup, element_id: str) -> Iterator[str]:
    """Format the findings about an element."""
    for finding in lookup.findings_of.get(element_id, ()):
        yield f"{finding.severity}[{finding.rule}]: {finding.message}"
