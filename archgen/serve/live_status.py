"""What readers of the live site are told: which version there is to see, and what is wrong in the files."""

from __future__ import annotations

import json
from dataclasses import dataclass

from archgen.serve.error_notes import ErrorNote


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
