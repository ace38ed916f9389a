"""The account of an import: what was taken, what was not, and what of its budget is left."""

from __future__ import annotations

from collections import Counter

from archgen.plugin.importing import ImportNote, Span, WorkBudget

_MAX_STEPS = 1_500_000
"""For all build files and programs together; a step through a program takes some microseconds."""


class ImportAccount:
    """Counts what is taken, by the format's own words, and keeps notes."""

    def __init__(self) -> None:
        self.budget = WorkBudget(_MAX_STEPS)
        self.taken: Counter[str] = Counter()
        self.notes: list[ImportNote] = []
        self._seen_notes: set[ImportNote] = set()

    def count(self, word: str, number: int = 1) -> None:
        """Count something that is taken."""
        self.taken[word] += number

    def pay_to_repeat(self, steps: int, kind: str, span: Span) -> bool:
        """Whether the budget has so many steps more; the first time that it has not is noted."""
        is_paid = self.budget.pay_to_repeat(steps)
        if not is_paid and (words := self.budget.tell_excess()):
            self.add_note(kind, words, span)
        return is_paid

    def add_note(self, kind: str, message: str, span: Span, help_line: str = "", fate: str = "not taken") -> None:
        """Add a note, once: a program that several nodes run is read for each of them."""
        note = ImportNote(kind, message, span, help_line, fate)
        if note not in self._seen_notes:
            self._seen_notes.add(note)
            self.notes.append(note)
