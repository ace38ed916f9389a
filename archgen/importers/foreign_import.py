"""What an importer of another tool's model returns: slices of the language, and an account of what was not taken.

What a reader of tables of components and connections returns, for `archgen init --from`. What a reader of recordings
returns: observations of a design's elements, and what has no place in it. What a reader of another tool's requirements
returns: requirements as data of the language, and what became of each object.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any, Literal

from archgen.diagnostics import Diagnostic, SourceTexts, Span
from archgen.frozen import dataclass, field
from archgen.timing.chains.measured_comparison import Observation
from archgen.timing.chains.sample_statistics import UnmappedSamples


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
    uses_shipped_library: bool = False
    """Whether components are of types of the library that ships, as `ros.NAME`."""


class ForeignFileError(Exception):
    """A file cannot be read at all. Carries why, where, and what to do."""

    def __init__(self, message: str, span: Span, help_line: str) -> None:
        super().__init__(message)
        self.message, self.span, self.help_line = message, span, help_line


@dataclass(frozen=True, slots=True)
class ObjectAccount:
    """What became of an object of the file: taken as `id`, left out on purpose, or not taken, and why."""

    fate: Literal["taken", "left out", "not taken"]
    name: str
    place: str
    id: str = ""
    reason: str = ""


@dataclass(slots=True)
class ImportedRequirements:
    """Requirements and use cases as data of the language by id, and the accounts of all objects, attributes, relations."""

    requirements: dict[str, dict[str, Any]] = field(default_factory=dict)
    use_cases: dict[str, dict[str, Any]] = field(default_factory=dict)
    accounts: list[ObjectAccount] = field(default_factory=list)
    unread_attributes: Counter[str] = field(default_factory=Counter)
    """How many objects have each attribute that is not taken."""
    unread_relations: Counter[str] = field(default_factory=Counter)
    closing_relations: tuple[tuple[str, str], ...] = ()
    """What is not taken, as (part, parent), since it would make a requirement a part of itself."""


class RecordingRefusedError(Exception):
    """What was named is no recording that can be read; the text says what to do."""


@dataclass(frozen=True, slots=True)
class ReadRecordings:
    """What recordings say of a design's elements, and what of them has no place in it.

    `texts` holds the files that people wrote, for excerpts in findings; recordings may be far too large for that.
    """

    observations: tuple[Observation, ...]
    unmapped: tuple[UnmappedSamples, ...]
    diagnostics: tuple[Diagnostic, ...]
    texts: tuple[tuple[str, str], ...]


MAX_OFFICE_BYTES = 64 * 1024 * 1024
"""The most bytes that a workbook or document may have, and each of its parts unpacked: a sheet of 300,000 cells has 20 MiB."""


@dataclass(frozen=True, slots=True)
class ImportedTables:
    """Sections of the language as plain data, none where nothing could be imported, and what is to be said of it."""

    data: Mapping[str, Any]
    diagnostics: tuple[Diagnostic, ...]
    sources: SourceTexts
    """The texts of the tables, for excerpts in findings."""
    summary: tuple[str, ...]
    """Lines that say of each table what its headings were taken for, and which cells were not taken."""
