"""What a reader of tables of components and connections returns, for `archgen init --from`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import SourceTexts
from archgen.frozen import dataclass

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
