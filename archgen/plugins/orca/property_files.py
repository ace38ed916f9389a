"""Read files of properties as Ice writes them: `key=value` line by line, `#` begins a comment, a backslash keeps a character."""

from __future__ import annotations

from pathlib import Path

from archgen.plugin import dataclass
from archgen.plugin.importing import ForeignFileError, Span, read_bounded

_MAX_BYTES = 4_000_000
_KEPT = frozenset("\\=# ")


@dataclass(frozen=True, slots=True)
class OrcaProperty:
    """A property with its place."""

    key: str
    value: str
    span: Span


def read_properties(path: Path) -> list[OrcaProperty]:
    """Return the properties of a file in its order. Raise ForeignFileError for what is no such file."""
    data = read_bounded(path, _MAX_BYTES)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        # Files of that time are of western encodings; comments alone hold such letters.
        text = data.decode("latin-1")
    if "\0" in text:
        words = "it is no text"
        raise ForeignFileError(
            words, Span.of_file(path.name), "give a definition file: lines such as `Config.Rate.Default=5`"
        )
    found: list[OrcaProperty] = []
    for number, line in enumerate(text.replace("\r\n", "\n").split("\n"), 1):
        code = _take_comment(line.rstrip("\r"))
        if code.strip():
            key, value = _split_pair(code)
            found.append(OrcaProperty(key, value, Span(path.name, number, 1, number, len(line) + 1)))
    return found


def _take_comment(line: str) -> str:
    """Return a line up to its comment."""
    position = 0
    while position < len(line) and line[position] != "#":
        position += 2 if line[position] == "\\" else 1
    return line[:position]


def _split_pair(code: str) -> tuple[str, str]:
    position = 0
    while position < len(code) and code[position] != "=":
        position += 2 if code[position] == "\\" else 1
    return _unescape(code[:position].strip()), _unescape(code[position + 1 :].strip())


def _unescape(text: str) -> str:
    kept: list[str] = []
    position = 0
    while position < len(text):
        is_escape = text[position] == "\\" and position + 1 < len(text) and text[position + 1] in _KEPT
        position += is_escape
        kept.append(text[position])
        position += 1
    return "".join(kept)
