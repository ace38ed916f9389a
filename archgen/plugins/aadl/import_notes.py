"""What an import of AADL did not take, told once for each thing."""

from __future__ import annotations

from archgen.plugin.importing import ImportNote, Span


class NoteList:
    """Notes in the order in which they were found; what is the same in many places is one note with a count."""

    def __init__(self) -> None:
        self._notes: dict[object, tuple[ImportNote, int]] = {}

    def add(self, kind: str, message: str, span: Span, help_line: str = "", fate: str = "not taken") -> None:
        """Add a note about one place."""
        self._notes.setdefault((kind, message, span), (ImportNote(kind, message, span, help_line, fate), 1))

    def add_counted(self, kind: str, message: str, span: Span, help_line: str = "", fate: str = "not taken") -> None:
        """Add a note that stands for all of its kind; the first place is shown, with how many there are."""
        key = kind.lower()
        note, count = self._notes.get(key, (ImportNote(kind, message, span, help_line, fate), 0))
        self._notes[key] = (note, count + 1)

    def add_contradiction(self, kind: str, message: str, span: Span) -> None:
        """Add a note about what the model itself says wrongly."""
        self.add(kind, message, span, "mend it in the model")

    def add_unknown_classifier(self, name: str, span: Span) -> None:
        """Add a note about a classifier that is in no file, once for each name."""
        if name.lower().startswith("base_types::"):
            # Every tool has this package of the standard.
            return
        words = f"`{name}` is in none of the files; what is written of it here counts all the same"
        self.add_counted(f"classifier {name}", words, span, "give its file as well, if there is one", fate="noted")

    def list_notes(self) -> tuple[ImportNote, ...]:
        """Return all notes."""
        return tuple(
            note
            if count == 1
            else ImportNote(
                note.kind, f"{note.message} ({count} places, this is the first)", note.span, note.help_line, note.fate
            )
            for note, count in self._notes.values()
        )
