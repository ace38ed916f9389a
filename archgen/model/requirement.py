"""Requirements: what the system must do, what each is a part of, and what shows that it is met."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Literal

from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.frozen import dataclass
from archgen.model.element_annotations import NO_ANNOTATIONS, ElementAnnotations


@dataclass(frozen=True, slots=True)
class Verification:
    """What shows that a requirement is met: a use case or a chain by its id, the path of a file, or a sentence."""

    kind: Literal["use_case", "chain", "file", "text"]
    text: str
    at: Span = field(default=NO_SPAN, compare=False, repr=False)

    @property
    def file(self) -> str:
        """The path of the file, without the name of a test behind `::`."""
        return self.text.partition("::")[0]


@dataclass(frozen=True, slots=True)
class Requirement:
    """A declared requirement, with the ids of the requirements that it is a part of and of its use cases."""

    id: str
    title: str
    description: str | None = None
    parents: tuple[str, ...] = ()
    kind: str | None = None
    priority: str | None = None
    rationale: str | None = None
    source: str | None = None
    """The document, meeting or standard that it comes from, as people write it."""
    verified_by: tuple[Verification, ...] = ()
    use_cases: tuple[str, ...] = ()
    tags: tuple[str, ...] = ()
    urls: Mapping[str, str] = field(default_factory=dict)
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    parent_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    """Where its first parent is written."""
