"""Read one file of a project safely: whatever lies there, in bounded time and memory, as text or as a diagnostic."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from archgen.diagnostic import Diagnostic
from archgen.frozen import dataclass
from archgen.source import Span

MAX_BYTES = 16 * 1024 * 1024
"""The largest file that is read. A project of 10,000 components in one file has about 6 MB."""
_BOM = b"\xef\xbb\xbf"
_OTHER_ENCODINGS = ((b"\xff\xfe", "UTF-16"), (b"\xfe\xff", "UTF-16"))
_KINDS = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a named pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)


@dataclass(frozen=True, slots=True)
class Text:
    """A file's text. `text` is what could be decoded for excerpts even where `problem` says why it is not used."""

    text: str
    problem: Diagnostic | None = None


def read(root: Path, file: str) -> Text:
    """Read `file` (relative to `root`, with `/`), refusing all that is not a UTF-8 text inside `root`."""
    path = root / file
    if not _inside(root, path):
        return _refuse(file, "this link leads out of the project's folder", "copy the file into the project")
    try:
        data = _bytes(path)
    except OSError as error:
        return _refuse(file, _reason(path, error))
    if isinstance(data, str):
        return _refuse(file, data)
    if len(data) > MAX_BYTES:
        size = f"{MAX_BYTES // (1024 * 1024)} MiB"
        return Text("", Diagnostic("too-large", f"the file is larger than {size}", Span.of_file(file), help="split it"))
    return _decode(file, data)


def read_bytes(root: Path, file: str) -> bytes | None:
    """Read a picture or the like from inside `root`; None where no regular file of a sane size lies there."""
    path = root / file
    try:
        data = _bytes(path) if _inside(root, path) else ""
    except (OSError, ValueError):
        return None
    return data if isinstance(data, bytes) and len(data) <= MAX_BYTES else None


def _inside(root: Path, path: Path) -> bool:
    return Path(os.path.realpath(path)).is_relative_to(os.path.realpath(root))


def _bytes(path: Path) -> bytes | str:
    """Give the first bytes of a regular file, or say what stands there instead. Never waits for a pipe's other end."""
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with os.fdopen(handle, "rb") as stream:
        mode = os.fstat(handle).st_mode
        if not stat.S_ISREG(mode):
            return _not_a_file(mode)
        return stream.read(MAX_BYTES + 1)


def _not_a_file(mode: int) -> str:
    kind = next((name for test, name in _KINDS if test(mode)), "no regular file")
    return f"this is {kind}, not a file"


def _reason(path: Path, error: OSError) -> str:
    try:
        mode = path.lstat().st_mode
    except OSError:
        return f"the file cannot be read: {_words(error)}"
    if stat.S_ISLNK(mode) and not path.exists():
        return "this is a broken link: what it points to does not exist"
    if not (stat.S_ISREG(mode) or stat.S_ISLNK(mode)):
        return _not_a_file(mode)
    return f"the file cannot be read: {_words(error)}"


def _words(error: OSError) -> str:
    return (error.strerror or "unknown reason").lower()


def _decode(file: str, data: bytes) -> Text:
    for mark, name in _OTHER_ENCODINGS:
        if data.startswith(mark):
            return _refuse(file, f"the file is encoded as {name}", "save it as UTF-8")
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


def _refuse(file: str, message: str, help_line: str | None = None) -> Text:
    return Text("", Diagnostic("syntax-error", message, Span.of_file(file), help=help_line))
