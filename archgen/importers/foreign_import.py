"""What an importer of another tool's model returns: slices of the language, and an account of what was not taken."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from archgen.diagnostics.source_span import Span


@dataclass(frozen=True, slots=True)
class ImportNote:
    """A construct that was not taken, or taken otherwise than it is written."""

    kind: str
    """The construct in the format's own word: `uml:StateMachine`, `annex EMV2`, `IncludeLaunchDescription`."""
    message: str
    span: Span
    help_line: str = ""
    fate: str = "not taken"
    """`not taken`, or `noted` where it is kept in another form, as a hint for instance."""
    count: int = 1
    """How many constructs of its kind it is about."""


@dataclass(frozen=True, slots=True)
class ForeignImport:
    """The slices that a model becomes. Nothing in them is invented: what the model does not say is absent."""

    slices: Mapping[str, Mapping[str, Any]]
    """Sections of the language as plain data, by the name of the file that they go to."""
    taken: Mapping[str, int] = field(default_factory=dict)
    """How many of each construct were taken, by the format's own word for it."""
    notes: tuple[ImportNote, ...] = ()
    title: str = ""
    """The title of a project that is made of the model alone."""
    distro: str = ""
    comments: Mapping[str, Mapping[tuple[str | int, ...], str]] = field(default_factory=dict)
    """Comments behind the lines of elements, by file and by the element's path in it."""


class ForeignFileError(Exception):
    """A file cannot be read at all. Carries why, where, and what to do."""

    def __init__(self, message: str, span: Span, help_line: str) -> None:
        super().__init__(message)
        self.message, self.span, self.help_line = message, span, help_line
