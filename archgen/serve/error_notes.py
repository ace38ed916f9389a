"""What is wrong in the files, for a page: place, words and line of each error."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from archgen.diagnostics.diagnostic import Severity, sort_gravest_first
from archgen.diagnostics.safe_text import make_visible
from archgen.frozen import dataclass
from archgen.pipeline import CheckedProject


@dataclass(frozen=True, slots=True)
class LiveStatus:
    """What readers are told: which version there is to see, and what is wrong in the files."""

    version: str = ""
    shown_since: str = ""
    """The time of day (`14:02:11`) of the state that is shown."""
    errors: tuple[ErrorNote, ...] = ()
    further_errors: int = 0
    is_outdated: bool = False
    """Whether the files as they are cannot be shown, so that an older state is."""

    def to_json(self) -> str:
        """Return the status as one line."""
        fields = {
            "version": self.version,
            "since": self.shown_since,
            "errors": self.errors,
            "further": self.further_errors,
            "outdated": self.is_outdated,
        }
        return json.dumps(fields, ensure_ascii=True)


ErrorNote = Mapping[str, Any]
_MAX_NOTES = 20
"""A page shows so many errors, and says how many more there are."""


def list_error_notes(checked_project: CheckedProject) -> tuple[tuple[ErrorNote, ...], int]:
    """Return the first errors of a project as plain data, and how many there are beside them."""
    errors = [
        finding
        for finding in sort_gravest_first(checked_project.findings)
        if finding.effective_severity is Severity.ERROR
    ]
    notes = tuple(
        {
            "place": make_visible(str(error.span)) if error.span.file else "",
            "message": make_visible(error.message),
            "help": make_visible(error.help or ""),
            "rule": error.rule,
            "line": make_visible(checked_project.sources.line_of(error.span.file, error.span.line) or ""),
            "column": error.span.column,
        }
        for error in errors[:_MAX_NOTES]
    )
    return notes, len(errors) - len(notes)
