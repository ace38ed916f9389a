"""Read dumps line by line, within bounds; a line `$ COMMAND` says which command printed what follows."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from archgen.plugin.importing import ForeignFileError, Span, read_bounded

MAX_DUMP_BYTES = 64_000_000
_MAX_LINE = 20_000
_COLOURS = re.compile(r"\x1b\[[0-9;]*m")
_PROMPT = re.compile(r"\$ +(\S.*)")
FULL_NAME = re.compile(r"(?:/[A-Za-z_]\w*)+\Z", re.ASCII)
"""A name of ROS from the root."""


class DumpLine(NamedTuple):
    """A line without its end. `command` is what printed it, as far as a line in front says so."""

    text: str
    span: Span
    command: str


def _split_lines(text: str) -> list[str]:
    # Not `splitlines`: a form feed or a line separator in a value ends no line of the file.
    return text.removeprefix("\ufeff").removesuffix("\n").replace("\r\n", "\n").split("\n")


def read_dump_lines(files: Sequence[Path]) -> Iterator[DumpLine]:
    """Yield the lines of dumps. Raise ForeignFileError for a file that cannot be read, or is no text."""
    for path in files:
        data = read_bounded(path, MAX_DUMP_BYTES)
        if b"\0" in data:
            words = "it is no text"
            raise ForeignFileError(words, Span.of_file(path.name), "give what the commands print, as text")
        command = ""
        for number, raw_line in enumerate(_split_lines(data.decode("utf-8", "replace")), 1):
            line = _COLOURS.sub("", raw_line[:_MAX_LINE]).rstrip()
            match = _PROMPT.fullmatch(line)
            if match:
                command = match[1].strip()
                continue
            yield DumpLine(line, Span(path.name, number, 1, number, len(line) + 1), command)
