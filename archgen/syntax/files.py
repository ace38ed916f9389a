"""Read one file of a project safely: whatever stands there, in bounded time and memory, as text or as a diagnostic.

A project lies in a folder on disk (`folder.py`) or in a commit of git (`committed.py`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, Protocol

from archgen.diagnostic import Diagnostic
from archgen.source import Span

MAX_BYTES = 16 * 1024 * 1024
"""The largest file that is read. A project of 10,000 components in one file has about 6 MB."""
_BOM = b"\xef\xbb\xbf"
_OTHER_ENCODINGS = ((b"\xff\xfe", "UTF-16"), (b"\xfe\xff", "UTF-16"))


class Refusal(NamedTuple):
    """Why a file is not used, and what to do."""

    message: str
    help: str | None = None
    rule: str = "syntax-error"


TOO_LARGE = Refusal(f"the file is larger than {MAX_BYTES // (1024 * 1024)} MiB", "split it", "too-large")


class Files(Protocol):
    """The files of a project. Paths are relative to its folder and use `/`."""

    @property
    def root(self) -> Path:
        """Give the project's folder; where the files come from a commit, the folder that holds or held them on disk."""
        ...

    @property
    def commit(self) -> str:
        """Give the full hash of the commit that holds the files, empty for those on disk."""
        ...

    def exists(self, path: str) -> bool:
        """Say whether anything stands there, be it a broken link."""
        ...

    def walk(self, top: str) -> Iterator[tuple[str, list[str], list[str]]]:
        """Walk down from a folder, as `os.walk` does, with folders given relative to `top`; folders taken out of the list
        are not entered, links to folders never.
        """
        ...

    def fetch(self, path: str) -> bytes | Refusal:
        """Give the bytes of a regular file of a sane size inside the project."""
        ...


@dataclass(frozen=True, slots=True)
class Text:
    """A file's text. `text` is what could be decoded for excerpts even where `problem` says why it is not used."""

    text: str
    problem: Diagnostic | None = None


def read(files: Files, file: str) -> Text:
    """Read a file, refusing all that is not a UTF-8 text of the project."""
    data = files.fetch(file)
    if isinstance(data, Refusal):
        return Text("", Diagnostic(data.rule, data.message, Span.of_file(file), help=data.help))
    return _decode(file, data)


def read_bytes(files: Files, file: str) -> bytes | None:
    """Read a picture or the like; None where no regular file of a sane size stands there."""
    try:
        data = files.fetch(file)
    except ValueError:
        return None
    return data if isinstance(data, bytes) else None


def _decode(file: str, data: bytes) -> Text:
    for mark, name in _OTHER_ENCODINGS:
        if data.startswith(mark):
            message = f"the file is encoded as {name}"
            return Text("", Diagnostic("syntax-error", message, Span.of_file(file), help="save it as UTF-8"))
    data = data.removeprefix(_BOM)
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        shown = data.decode("utf-8", "replace")
        before = data[: error.start].decode("utf-8")
        message = f"the byte 0x{data[error.start]:02X} is not UTF-8"
        return Text(shown, Diagnostic("syntax-error", message, place(file, before), help="save the file as UTF-8"))
    nul = text.find("\0")
    if nul >= 0:
        at = place(file, text[:nul])
        return Text(text, Diagnostic("syntax-error", "a NUL character cannot stand in a text file", at))
    return Text(text)


def place(file: str, before: str) -> Span:
    """Give the place of the one character that follows `before`, the file's text up to there."""
    lines = before.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    return Span(file, len(lines), len(lines[-1]) + 1, len(lines), len(lines[-1]) + 2)
