"""Where something is written: spans in files, and the texts of these files for excerpts."""

from __future__ import annotations

from archgen.frozen import NamedTuple


class Span(NamedTuple):
    """A stretch of one file.

    Lines and columns count from 1, columns in characters; the end is exclusive. `file` is relative to the project's
    folder, with `/` as separator.
    """

    file: str
    line: int
    column: int
    end_line: int
    end_column: int

    @classmethod
    def of_file(cls, file: str) -> Span:
        """Return the span that stands for a whole file: its very beginning."""
        return cls(file, 1, 1, 1, 1)

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


NO_SPAN = Span("", 0, 0, 0, 0)
"""The span of elements that are not written anywhere, such as planned nodes."""


class SourceTexts:
    """The texts of the files that were read, by their project-relative path; diagnostics quote their lines."""

    # `_lines` caches the lines of the files that are quoted: most files never are.
    __slots__ = ("_lines", "_texts")

    def __init__(self) -> None:
        """Start without any file."""
        self._texts: dict[str, str] = {}
        self._lines: dict[str, list[str]] = {}

    def add_text(self, file: str, text: str) -> None:
        """Add or replace the text of a file."""
        self._texts[file] = text
        self._lines.pop(file, None)

    def text_of(self, file: str) -> str | None:
        """Return the whole text of a file, or None if it was never read."""
        return self._texts.get(file)

    def file_names(self) -> tuple[str, ...]:
        """Return the paths of all files in the order in which they were read."""
        return tuple(self._texts)

    def line_of(self, file: str, number: int) -> str | None:
        """Return a line by its number (from 1) without its line end, or None if there is no such line."""
        lines = self._lines.get(file)
        if lines is None:
            text = self._texts.get(file)
            if text is None:
                return None
            # Not splitlines(): it also splits at NEL and Unicode's separators, which are no line breaks in YAML 1.2.
            # Spans do not count them, and would point to the wrong line.
            lines = self._lines[file] = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
        return lines[number - 1] if 0 < number <= len(lines) else None


def first_written_span(*spans: Span) -> Span:
    """Return the first span that is not `NO_SPAN`, or `NO_SPAN`."""
    return next((span for span in spans if span != NO_SPAN), NO_SPAN)
