"""Where something was written: spans in files, and the text of those files for excerpts."""

from __future__ import annotations

from typing import NamedTuple


class Span(NamedTuple):
    """A stretch of one file.

    Lines and columns count from 1, columns in characters; the end is exclusive. `file` is relative to the project's
    folder and uses `/`.
    """

    file: str
    line: int
    column: int
    end_line: int
    end_column: int

    @classmethod
    def of_file(cls, file: str) -> Span:
        """Give the place that stands for a file as a whole."""
        return cls(file, 1, 1, 1, 1)

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


NOWHERE = Span("", 0, 0, 0, 0)
"""The place of elements that nobody wrote (derived nodes, for instance)."""


class Sources:
    """The texts of the files that were read, by their project-relative path; diagnostics quote lines from here."""

    __slots__ = ("_lines", "_texts")

    def __init__(self) -> None:
        """Start with no file."""
        self._texts: dict[str, str] = {}
        self._lines: dict[str, list[str]] = {}

    def add(self, file: str, text: str) -> None:
        """Keep the text of a file."""
        self._texts[file] = text
        self._lines.pop(file, None)

    def text(self, file: str) -> str | None:
        """Give a file's whole text, or None if it was never read."""
        return self._texts.get(file)

    def files(self) -> tuple[str, ...]:
        """Name the files held, in the order in which they were read."""
        return tuple(self._texts)

    def line(self, file: str, number: int) -> str | None:
        """Give one line without its end (from 1), or None where there is none."""
        lines = self._lines.get(file)
        if lines is None:
            text = self._texts.get(file)
            if text is None:
                return None
            lines = self._lines[file] = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
        return lines[number - 1] if 0 < number <= len(lines) else None
