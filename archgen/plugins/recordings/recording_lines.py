"""Read the lines of a recording one at a time, however long it is, and collect what is odd about it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import BinaryIO, NamedTuple

from archgen.plugin import dataclass
from archgen.plugin.findings import Diagnostic, Severity
from archgen.plugin.importing import Span

MAX_LINE_BYTES = 65_536
"""A line that is longer is no event and no row; its end is skipped without being kept."""

_COLOUR_PATTERN = re.compile(r"\x1b\[[0-9;]*[mK]")
"""How terminals are told colours, which `script` records too."""


class RecordingError(Exception):
    """A recording cannot be used: nothing of its file counts."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


@dataclass(frozen=True, slots=True)
class RecordingSource:
    """The file of a recording, as people named it, opened."""

    name: str
    stream: BinaryIO

    def span_of(self, line: int) -> Span:
        """Return the place of a line."""
        return Span(self.name, line, 1, line, 1)

    def refuse(self, line: int, message: str, help_line: str, rule: str = "wrong-value") -> RecordingError:
        """Return the error that ends the reading of this file."""
        return RecordingError(Diagnostic(rule, message, self.span_of(line), Severity.ERROR, help=help_line))

    def read_lines(self) -> Iterator[tuple[int, str]]:
        """Yield each line with its number, without its end and colours. Bytes that are no UTF-8 become `\ufffd`."""
        self.stream.seek(0)
        number = 0
        while line := self.stream.readline(MAX_LINE_BYTES):
            number += 1
            is_whole = line.endswith(b"\n")
            while not is_whole and (more := self.stream.readline(MAX_LINE_BYTES)):
                is_whole, line = more.endswith(b"\n"), b""
            text = line.decode("utf-8", "replace").rstrip("\r\n")
            if "\x1b" in text:
                text = _COLOUR_PATTERN.sub("", text)
            yield number, text.removeprefix("\ufeff") if number == 1 else text


class OddityText(NamedTuple):
    """How a kind of oddity is reported; the message may hold `{count}`, and `{s}` for the plural."""

    message: str
    help: str | None = None
    severity: Severity = Severity.WARNING
    rule: str = "wrong-value"


class Oddities:
    """What is odd about a recording: one finding for each kind, however often it occurs."""

    def __init__(self, source: RecordingSource) -> None:
        self._source = source
        self._first_lines: dict[str, int] = {}
        self._counts: dict[str, int] = {}

    def note(self, kind: str, line: int, count: int = 1) -> None:
        """Count an oddity of a kind; the first line of each kind is kept."""
        self._first_lines.setdefault(kind, line)
        self._counts[kind] = self._counts.get(kind, 0) + count

    def diagnose(self, texts: Mapping[str, OddityText]) -> Iterator[Diagnostic]:
        """Yield the findings, in the order of the texts by kind."""
        for kind, text in texts.items():
            if kind in self._counts:
                count = self._counts[kind]
                message = text.message.format(count=f"{count:,}", s="" if count == 1 else "s")
                yield Diagnostic(
                    text.rule, message, self._source.span_of(self._first_lines[kind]), text.severity, help=text.help
                )
