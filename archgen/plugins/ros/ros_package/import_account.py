"""The account of an import: what was taken, and what was not."""

from __future__ import annotations

from collections import Counter

from archgen.plugin.importing import ImportNote, Span


class ImportAccount:
    """Counts what is taken, by the format's own words, and keeps notes."""

    def __init__(self) -> None:
        self.taken: Counter[str] = Counter()
        self.notes: list[ImportNote] = []
        self._seen_notes: set[ImportNote] = set()

    def count(self, word: str, number: int = 1) -> None:
        """Count something that is taken."""
        self.taken[word] += number

    def add_note(self, kind: str, message: str, span: Span, help_line: str = "", fate: str = "not taken") -> None:
        """Add a note, once: a program that several nodes run is read for each of them."""
        note = ImportNote(kind, message, span, help_line, fate)
        if note not in self._seen_notes:
            self._seen_notes.add(note)
            self.notes.append(note)
