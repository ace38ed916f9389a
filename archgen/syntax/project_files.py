"""Read one file of a project safely: in bounded time and memory, as text or as a diagnostic, whatever the file is.

A project lies in a folder on disk (`FolderFiles`), in a commit of git (`CommittedFiles`), or in either with some files
replaced (`OverlaidFiles`).
"""

from __future__ import annotations

import posixpath
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple, Protocol

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import Span
from archgen.frozen import dataclass

MAX_BYTES = 16 * 1024 * 1024
"""The largest file that is read. A project of 10,000 components in one file has about 6 MB."""
_BOM = b"\xef\xbb\xbf"
_OTHER_ENCODINGS = ((b"\xff\xfe", "UTF-16"), (b"\xfe\xff", "UTF-16"))


class FileRefusal(NamedTuple):
    """Why a file cannot be used, what to do about it, and the rule that reports it."""

    message: str
    help: str | None = None
    rule: str = "syntax-error"


TOO_LARGE = FileRefusal(f"the file is larger than {MAX_BYTES // (1024 * 1024)} MiB", "split it", "too-large")


class ProjectFiles(Protocol):
    """The files of a project. Paths are relative to its folder and use `/` on every platform."""

    @property
    def root(self) -> Path:
        """The project's folder; for files of a commit the folder that holds, or once held, them on disk."""
        ...

    @property
    def commit(self) -> str:
        """The full hash of the commit that holds the files; empty for files on disk."""
        ...

    def has_path(self, path: str) -> bool:
        """Whether there is anything at a path, even a broken link."""
        ...

    def is_behind_link(self, path: str) -> bool:
        """Whether a path leads to a file through a symbolic link, at its end or on its way."""
        ...

    def walk_folders(self, top: str) -> Iterator[tuple[str, list[str], list[str]]]:
        """Walk down from a folder as `os.walk` does: yield (folder relative to `top`, its folders, its files).

        A caller that removes folders from the second list keeps them from being entered. Links to folders never are.
        """
        ...

    def fetch_bytes(self, path: str) -> bytes | FileRefusal:
        """Return the bytes of a regular file inside the project of at most `MAX_BYTES`, or why it cannot be used."""
        ...

    def open_folder(self, path: str) -> ProjectFiles | FileRefusal:
        """Return the files of another folder of the repository, or why they cannot be used.

        `path` starts at the project's folder and may climb out of it, never out of the repository; without one it stays
        in the project's folder. No link is followed on the way, and a folder around the project is refused.
        """
        ...


@dataclass(frozen=True, slots=True)
class FileText:
    """A file's text. Where `problem` says why the file is not used, `text` is what could be decoded, for excerpts."""

    text: str
    problem: Diagnostic | None = None


def read_text_file(files: ProjectFiles, file: str) -> FileText:
    """Read a file as UTF-8 text; anything else becomes the `problem`."""
    data = files.fetch_bytes(file)
    if isinstance(data, FileRefusal):
        return FileText("", Diagnostic(data.rule, data.message, Span.of_file(file), help=data.help))
    return _decode_text(file, data)


def read_binary_file(files: ProjectFiles, file: str) -> bytes | None:
    """Read a binary file such as a picture; None where it is absent, too large or no regular file."""
    try:
        data = files.fetch_bytes(file)
    except ValueError:  # a NUL or a lone surrogate in the path: the operating system refuses such names
        return None
    return data if isinstance(data, bytes) else None


def _decode_text(file: str, data: bytes) -> FileText:
    for byte_order_mark, encoding_name in _OTHER_ENCODINGS:
        if data.startswith(byte_order_mark):
            message = f"the file is encoded as {encoding_name}"
            return FileText("", Diagnostic("syntax-error", message, Span.of_file(file), help="save it as UTF-8"))
    data = data.removeprefix(_BOM)
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        readable_text = data.decode("utf-8", "replace")
        text_before = data[: error.start].decode("utf-8")  # what precedes the first bad byte is sound
        message = f"the byte 0x{data[error.start]:02X} is not UTF-8"
        return FileText(
            readable_text,
            Diagnostic("syntax-error", message, span_after(file, text_before), help="save the file as UTF-8"),
        )
    # A NUL is legal UTF-8, but it is the surest sign of a binary file, and YAML forbids it.
    nul_offset = text.find("\0")
    if nul_offset >= 0:
        nul_span = span_after(file, text[:nul_offset])
        return FileText(text, Diagnostic("syntax-error", "a NUL character cannot stand in a text file", nul_span))
    return FileText(text)


def span_after(file: str, text_before: str) -> Span:
    """Return the span of the one character that follows `text_before`, the file's text up to there."""
    lines = text_before.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    return Span(file, len(lines), len(lines[-1]) + 1, len(lines), len(lines[-1]) + 2)


NO_SUCH_FOLDER = FileRefusal("there is no such folder", "write the path from the project's folder, with `/`")


def find_path_refusal(path: str) -> FileRefusal | None:
    """Return why a path cannot be the path of a folder on any machine; None where it can."""
    if not path.isprintable() or "\\" in path or path.startswith("/") or not path.strip():
        return FileRefusal("this is no path", "write the path from the project's folder, with `/`")
    return None


def find_place_refusal(own_folder: str, path: str, *, has_repository: bool = True) -> FileRefusal | None:
    """Return why a folder at a path from a project's folder may not be read; None where it may.

    `own_folder` is the project's folder from the top of its repository, "" where it is the top itself.
    """
    target = posixpath.normpath(posixpath.join(own_folder, path))
    if target == ".." or target.startswith("../"):
        top = "the repository" if has_repository else "the project's folder, which is in no repository"
        return FileRefusal(f"this leads out of {top}", "name a folder in the same repository")
    if target == "." or f"{own_folder}/".startswith(f"{target}/"):
        return FileRefusal("this folder holds the project itself", "name a folder of its own")
    # Written so, what is none of the project's sources would not be recognised in the project's folder.
    if posixpath.normpath(path).startswith("../") and target.startswith(f"{own_folder}/"):
        inner_path = target.removeprefix(f"{own_folder}/")
        return FileRefusal("this leads out of the project's folder and back into it", f"write `{inner_path}`")
    return None
