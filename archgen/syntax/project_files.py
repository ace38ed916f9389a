"""Read one file of a project safely: in bounded time and memory, as text or as a diagnostic, whatever the file is.

A project lies in a folder on disk (`FolderFiles`), in a commit of git (`CommittedFiles`), or in either with some files
replaced (`OverlaidFiles`).

The files of a library, by their paths from the folder of the project that names it. A project's files of which each is
read once: its variants name the same interfaces, chapters and parameters.

A project's files with some contents replaced, so that what is about to be written can be checked before it is.
"""

from __future__ import annotations

import posixpath
from collections.abc import Iterator, Mapping
from pathlib import Path, PurePosixPath
from typing import Protocol

from archgen.diagnostics import Diagnostic, Span
from archgen.frozen import NamedTuple, dataclass

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


_MAX_KEPT_BYTES = 256 * 1024
"""A larger file, such as a picture, is read again: there are few of them, and memory is for the model."""


class RememberedFiles:
    """The files of a project as they were when each was read first. Implements `ProjectFiles`."""

    def __init__(self, files: ProjectFiles) -> None:
        """Remember nothing yet."""
        self._files = files
        self._contents: dict[str, bytes | FileRefusal] = {}

    @property
    def root(self) -> Path:
        """The project's folder."""
        return self._files.root

    @property
    def commit(self) -> str:
        """The hash of the commit that holds the files; empty for files on disk."""
        return self._files.commit

    def has_path(self, path: str) -> bool:
        """Whether there is anything at a path."""
        return self._files.has_path(path)

    def is_behind_link(self, path: str) -> bool:
        """Whether a path leads to a file through a symbolic link."""
        return self._files.is_behind_link(path)

    def walk_folders(self, top: str) -> Iterator[tuple[str, list[str], list[str]]]:
        """Walk down from a folder; callers may remove folders from the list to skip them."""
        return self._files.walk_folders(top)

    def fetch_bytes(self, path: str) -> bytes | FileRefusal:
        """Return a file's bytes, or why it cannot be used."""
        content = self._contents.get(path)
        if content is None:
            content = self._files.fetch_bytes(path)
            if isinstance(content, FileRefusal) or len(content) <= _MAX_KEPT_BYTES:
                self._contents[path] = content
        return content

    def open_folder(self, path: str) -> ProjectFiles | FileRefusal:
        """Return the files of another folder of the repository, or why they cannot be used."""
        return self._files.open_folder(path)


@dataclass(frozen=True, slots=True)
class LibraryFiles:
    """The files of another folder by paths such as `../common/laser.yaml`. Implements `ProjectFiles`.

    So a finding in a library names its file as people at the project would. `folder` is in its shortest form.
    """

    folder: str
    folder_files: ProjectFiles

    @property
    def root(self) -> Path:
        """The library's folder."""
        return self.folder_files.root

    @property
    def commit(self) -> str:
        """The full hash of the commit that holds the files; empty for files on disk."""
        return self.folder_files.commit

    def has_path(self, path: str) -> bool:
        """Whether there is anything at a path, even a broken link."""
        return self.folder_files.has_path(self._to_inner(path))

    def is_behind_link(self, path: str) -> bool:
        """Whether a path leads to a file through a symbolic link."""
        return self.folder_files.is_behind_link(self._to_inner(path))

    def walk_folders(self, top: str) -> Iterator[tuple[str, list[str], list[str]]]:
        """Walk down from a folder, as the library's files do."""
        return self.folder_files.walk_folders(self._to_inner(top))

    def fetch_bytes(self, path: str) -> bytes | FileRefusal:
        """Return a file's bytes, or why it cannot be used."""
        return self.folder_files.fetch_bytes(self._to_inner(path))

    def open_folder(self, path: str) -> ProjectFiles | FileRefusal:
        """Return no files: a library has no libraries of its own."""
        return FileRefusal(f"a library has no libraries of its own: `{path}`", "name it in the project")

    def _to_inner(self, path: str) -> str:
        return path.removeprefix(self.folder).removeprefix("/")


_FolderNames = dict[str, tuple[set[str], set[str]]]
"""The names of subfolders and of files, by folder."""


@dataclass(frozen=True, slots=True)
class OverlaidFiles:
    """New contents by path, laid over the files of a project (`base_files` None: an empty folder).

    Implements `ProjectFiles`.
    """

    root: Path
    contents: Mapping[str, bytes]
    base_files: ProjectFiles | None = None
    commit: str = ""

    def has_path(self, path: str) -> bool:
        """Whether there is anything at a path."""
        return path in self.contents or (self.base_files is not None and self.base_files.has_path(path))

    def is_behind_link(self, path: str) -> bool:
        """Whether a path of the base files leads to a file through a symbolic link."""
        return path not in self.contents and self.base_files is not None and self.base_files.is_behind_link(path)

    def walk_folders(self, top: str) -> Iterator[tuple[str, list[str], list[str]]]:
        """Walk down from a folder, as the base files do: callers may remove folders from the list to skip them."""
        overlay_folders = self._list_overlay_folders(top)
        is_walked = False
        for relative_folder, folders, file_names in (
            self.base_files.walk_folders(top) if self.base_files is not None else ()
        ):
            is_walked = True
            own_folders, own_names = overlay_folders.get(relative_folder, (set(), set()))
            base_folders = frozenset(folders)
            all_folders = [*folders, *sorted(own_folders - base_folders)]
            yield relative_folder, all_folders, sorted({*file_names, *own_names})
            # In place: what the caller skipped, the walk of the base files must skip as well.
            folders[:] = [name for name in all_folders if name in base_folders]
            for name in all_folders:
                if name not in base_folders:
                    yield from _walk_overlay(overlay_folders, _join_path(relative_folder, name))
        if not is_walked and overlay_folders:
            yield from _walk_overlay(overlay_folders, "")

    def fetch_bytes(self, path: str) -> bytes | FileRefusal:
        """Return a file's bytes, from the overlay where it has the file; the size limit holds for both."""
        if path in self.contents:
            data = self.contents[path]
            return data if len(data) <= MAX_BYTES else TOO_LARGE
        return (
            self.base_files.fetch_bytes(path) if self.base_files is not None else FileRefusal("the file does not exist")
        )

    def open_folder(self, path: str) -> OverlaidFiles | FileRefusal:
        """Return the files of another folder, with the contents of the overlay that lie in it."""
        base_files = self.base_files.open_folder(path) if self.base_files is not None else NO_SUCH_FOLDER
        if isinstance(base_files, FileRefusal):
            return base_files
        prefix = f"{posixpath.normpath(path)}/"
        contents = {name.removeprefix(prefix): data for name, data in self.contents.items() if name.startswith(prefix)}
        return OverlaidFiles(base_files.root, contents, base_files, self.commit)

    def _list_overlay_folders(self, top: str) -> _FolderNames:
        """Return the folders of the overlay below a folder, the empty ones between them included."""
        folder_names: _FolderNames = {}
        for path in self.contents:
            if not top or (path != top and PurePosixPath(path).is_relative_to(top)):
                folder, _, name = (path[len(top) + 1 :] if top else path).rpartition("/")
                folder_names.setdefault(folder, (set(), set()))[1].add(name)
                while folder:
                    parent, _, folder_name = folder.rpartition("/")
                    folder_names.setdefault(parent, (set(), set()))[0].add(folder_name)
                    folder = parent
        return folder_names


def _walk_overlay(folder_names: _FolderNames, relative_folder: str) -> Iterator[tuple[str, list[str], list[str]]]:
    """Walk down from a folder that only the overlay has."""
    subfolders, names = folder_names[relative_folder]
    folders = sorted(subfolders)
    yield relative_folder, folders, sorted(names)
    for name in folders:
        yield from _walk_overlay(folder_names, _join_path(relative_folder, name))


def _join_path(folder: str, name: str) -> str:
    return f"{folder}/{name}" if folder else name
