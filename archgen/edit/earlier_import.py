"""What an earlier import of the same files left in a folder: its slices, the ids that people know, places, and the bytes of
its source.

Bring a slice up to date with data from elsewhere: what people wrote around it stays, comments in particular.

What an import brings that the project says already: nothing stands in two files, and what differs is told.
"""

from __future__ import annotations

import hashlib
import os
import stat
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from archgen.diagnostics import NO_SPAN, Diagnostic, Severity, Span, make_visible
from archgen.frozen import NamedTuple, dataclass
from archgen.merge.change_transfer import to_texts
from archgen.merge.file_merge import SOURCE_FOLDER
from archgen.merge.slice_merge import SliceVersions, merge_slices
from archgen.pipeline import CheckedProject
from archgen.project.project_search import name_path_from
from archgen.project.slice_parsing import parse_slice
from archgen.regular_files import read_named_file
from archgen.syntax.file_patterns import YAML_ENDINGS
from archgen.syntax.folder_files import FolderFiles
from archgen.syntax.project_files import read_text_file
from archgen.syntax.yaml_parser import list_comments, parse_yaml
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, YamlDocument, node_to_data
from archgen.syntax.yaml_writer import FlowMapping, write_yaml

_BY = " by `archgen import "
_TOOLS = {"xmi": "uml"}
"""What `hints` call the tools whose ids an import leaves there, by format where it has another name."""


@dataclass(frozen=True, slots=True)
class ImportOrigin:
    """Where slices come from: the format, and the names of the files, as a comment at the top of each slice says."""

    format_name: str
    file_names: tuple[str, ...]
    arguments: tuple[str, ...] = ()
    """Launch arguments as they were given, `NAME:=VALUE`: with others the same file is another model."""
    has_dated_files: bool = False
    """Whether the names of the files say nothing: each one is the same robot at another time."""

    @property
    def tool(self) -> str:
        """Return what `hints` call the tool."""
        return _TOOLS.get(self.format_name, self.format_name)

    @property
    def header(self) -> str:
        """Return the first line of each slice."""
        names = make_visible(" ".join(" ".join(word.split()) for word in (*self.file_names, *self.arguments)))
        return f"# From {names}{_BY}{self.format_name}`; with --merge it is brought up to date.\n"

    def is_of(self, text: str) -> bool:
        """Whether a slice says that it comes from these files, in any order, among the comments at its top."""
        wanted = self._read_origin(self.header)
        for line in text.splitlines():
            if line.strip() and not line.startswith("#"):
                return False
            if self._read_origin(line) == wanted:
                return True
        return False

    def _read_origin(self, line: str) -> list[str]:
        return sorted(line[line.find(_BY) if self.has_dated_files and _BY in line else 0 :].split())


def read_earlier_import(folder: Path, origin: ImportOrigin) -> dict[str, Mapping[str, Any]]:
    """Return the slices in a folder that come from these files, by their names. What cannot be read is left out."""
    if not folder.is_dir():
        return {}
    files = FolderFiles(folder)
    slices: dict[str, Mapping[str, Any]] = {}
    for path in sorted(path for ending in YAML_ENDINGS for path in folder.glob(f"*{ending}")):
        text = read_text_file(files, path.name).text if path.is_file() else ""
        if origin.is_of(text):
            slices[path.name] = read_slice_content(path.name, text).data
    return slices


@dataclass(frozen=True, slots=True)
class SliceContent:
    """What a slice says, as texts in normal form, and why it cannot be read: then it says nothing."""

    data: dict[str, Any]
    diagnostics: tuple[Diagnostic, ...] = ()
    entries: tuple[MappingEntry, ...] = ()
    """Its sections as they are written."""

    @property
    def root(self) -> MappingNode:
        """Return all of it as a mapping."""
        return MappingNode({entry.key: entry for entry in self.entries}, NO_SPAN)


def read_slice_content(file: str, text: str) -> SliceContent:
    """Return what the text of a slice says."""
    if not text.strip():
        return SliceContent({})
    parsed_slice = parse_slice(file, text)
    document = parsed_slice.document
    diagnostics = (*parsed_slice.diagnostics, *parsed_slice.validate_once().diagnostics)
    if document is None or any(each.severity in {None, Severity.ERROR} for each in diagnostics):
        return SliceContent({}, diagnostics)
    return SliceContent({entry.key: to_texts(entry.value) for entry in document.root}, (), tuple(document.root))


def _read_plain_mapping(file: str, text: str) -> Mapping[str, Any]:
    """Return the mapping that a text of YAML is; an empty one for anything else."""
    document, _ = parse_yaml(file, text)
    data = node_to_data(document.root) if document is not None else None
    return data if isinstance(data, dict) else {}


@dataclass(frozen=True, slots=True)
class UpdatedText:
    """The new text of a slice. `is_rewritten`: comments could not stay in their places, and stand at its beginning."""

    text: str
    is_rewritten: bool = False


def update_slice_text(old_text: str, base: str, new: str) -> UpdatedText:
    """Return a slice with what is new in it. `base` and `new` are its content before and now, as archgen writes it."""
    if base == new:
        return UpdatedText(old_text)
    merged = merge_slices(SliceVersions(base, ours=old_text, theirs=new))
    if isinstance(merged, str):
        return UpdatedText(merged)
    return UpdatedText("".join(f"{comment}\n" for comment in list_comments(old_text)) + new, is_rewritten=True)


KeyPath = tuple[str, ...]


class SaidValue(NamedTuple):
    """A value of the project, and the file that says it."""

    value: object
    file: str


class LeftOut(NamedTuple):
    """A slice without what other files say, and that apart; `differences` are what they say otherwise: by the path a line that tells it."""

    data: dict[str, Any]
    left_out: dict[str, Any]
    differences: dict[KeyPath, str]


def list_said_values(documents: Iterable[YamlDocument], own_files: frozenset[str]) -> dict[KeyPath, SaidValue]:
    """Return the values of a project by their paths, but for those of some files."""
    return {
        path: SaidValue(value, entry.key_span.file)
        for document in documents
        for entry in document.root
        if entry.key_span.file not in own_files
        for path, value in list_leaves(to_texts(entry.value), (entry.key,))
    }


def leave_out_said(
    data: Mapping[str, Any], normal_data: Mapping[str, Any], said: Mapping[KeyPath, SaidValue]
) -> LeftOut:
    """Return a slice without the values that other files say. `normal_data` is what it says in normal form."""
    leaves_below: dict[KeyPath, list[tuple[KeyPath, object]]] = defaultdict(list)
    for path, value in list_leaves(normal_data, ()):
        for end in range(1, len(path) + 1):
            leaves_below[path[:end]].append((path, value))
    differences: dict[KeyPath, str] = {}
    left_out: dict[str, Any] = {}

    def leave_out(part: Mapping[str, Any], place: KeyPath) -> dict[str, Any]:
        kept: dict[str, Any] = {}
        for key, value in part.items():
            path = (*place, key)
            leaves = leaves_below[path]
            if isinstance(value, Mapping) and value:
                if inner := leave_out(value, path):
                    kept[key] = inner
            elif not leaves or any(leaf not in said for leaf, _ in leaves):
                kept[key] = value
            else:
                for leaf, leaf_value in leaves:
                    put_value(left_out, leaf, leaf_value)
                    if str(said[leaf].value) != str(leaf_value):
                        words = f"`{said[leaf].value}` in {said[leaf].file}, `{leaf_value}` here"
                        differences[leaf] = f"{'.'.join(leaf)}: {words}"
        return copy_mapping(part, kept)

    return LeftOut(leave_out(data, ()), left_out, differences)


def copy_mapping(like: Mapping[str, Any], entries: Mapping[str, Any]) -> dict[str, Any]:
    """Return entries as a mapping that is written in the same style as another one."""
    return FlowMapping(entries) if isinstance(like, FlowMapping) else dict(entries)


def put_value(data: dict[str, Any], path: KeyPath, value: object) -> None:
    """Put a value at a path, with the mappings that lead to it."""
    for key in path[:-1]:
        inner = data.get(key)
        if not isinstance(inner, dict):
            inner = data[key] = {}
        data = inner
    data[path[-1]] = value


def list_leaves(value: object, path: KeyPath) -> Iterator[tuple[KeyPath, object]]:
    """Yield what is written once in a project: all that is no mapping, or an empty one."""
    if isinstance(value, Mapping) and value:
        for key, inner in value.items():
            yield from list_leaves(inner, (*path, key))
    elif value is not None:
        yield path, value


_MAX_FILES = 50_000
_MAX_FILE_BYTES = 1_000_000
_MAX_DIGESTED_BYTES = 500_000_000
_MADE_FOLDERS = frozenset({"build", "install", "log", "devel", "__pycache__", "node_modules", "archgen-out"})
"""Folders with what is made of sources; hidden ones are left out, too."""


def digest_sources(files: Iterable[Path], without: Path) -> str:
    """Return the digest of files and folders, but for a folder in them: names and contents. Links are not followed."""
    checksum = hashlib.sha256()
    left_files, left_bytes = _MAX_FILES, _MAX_DIGESTED_BYTES
    for top in sorted(files):
        for path, size in _walk(top, without):
            left_files, left_bytes = left_files - 1, left_bytes - min(size, _MAX_FILE_BYTES)
            if min(left_files, left_bytes) < 0:
                checksum.update(b"more")
                break
            name = path.relative_to(top).as_posix() if path != top else ""
            data = read_named_file(path, _MAX_FILE_BYTES) if size <= _MAX_FILE_BYTES else b""
            checksum.update(f"{name}\0{size}\0".encode("utf-8", "surrogatepass") + hashlib.sha256(data).digest())
    return checksum.hexdigest()


def _walk(top: Path, without: Path) -> Iterator[tuple[Path, int]]:
    """Yield regular files with their sizes, in the order of their names."""
    if not top.is_dir():
        yield top, top.stat().st_size
        return
    for folder, folders, names in os.walk(top):
        here = Path(folder)
        folders[:] = sorted(
            name
            for name in folders
            if name not in _MADE_FOLDERS and not name.startswith(".") and (here / name).resolve() != without
        )
        for name in sorted(names):
            found = (here / name).lstat()
            if stat.S_ISREG(found.st_mode) and not name.startswith("."):
                yield here / name, found.st_size


def write_source_records(root: Path, slices: Iterable[str], files: Sequence[Path]) -> dict[str, str]:
    """Return by their paths in a project the records that say from where its slices come, and what is there now."""
    paths = [file.resolve() for file in files]
    names = [name_path_from(root, path) for path in paths]
    text = write_yaml({"files": names, "digest": digest_sources(paths, root)})
    return {f"{SOURCE_FOLDER}/{file}": text for file in slices}


def list_stale_slices(checked_project: CheckedProject) -> Iterator[Diagnostic]:
    """Yield the slices whose sources changed since their import, as far as these are at hand.

    Only what lies in the folder around the project, or in its repository, is looked at: others may have written the record.
    """
    files, root = checked_project.loaded_project.files, checked_project.root.resolve()
    known: dict[tuple[str, ...], str] = {}
    for file in checked_project.yaml_files:
        record = f"{SOURCE_FOLDER}/{file}"
        if not files.has_path(record) or files.is_behind_link(record):
            continue
        data = _read_plain_mapping(record, read_text_file(files, record).text)
        names, digest = data.get("files"), data.get("digest")
        if not isinstance(names, list) or not all(isinstance(name, str) for name in names) or not names:
            continue
        key = tuple(names)
        if key not in known:
            known[key] = _digest_named(key, root) or ""
        if known[key] and known[key] != digest:
            shown = ", ".join(f"`{name}`" for name in names)
            message = f"{shown} changed since {file} was imported: the project may be older than its source"
            help_line = "`archgen import ... --check`, with the words of the import, says in what; `--merge` brings it up to date"
            yield Diagnostic("stale-import", message, Span(file, 1, 1, 1, 1), help=help_line)


def _digest_named(names: Sequence[str], root: Path) -> str | None:
    """Return the digest of sources by their paths from a project; None where one of them is not to be looked at."""
    top = next((each for each in (root, *root.parents) if os.path.lexists(each / ".git")), root.parent)
    try:
        paths = [(root / name).resolve() for name in names]
        if not all(path.is_relative_to(top) and path.exists() for path in paths):
            return None
        return digest_sources(paths, root)
    except (OSError, ValueError):  # not to be read, or no path at all
        return None
