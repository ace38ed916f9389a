"""Where the slices of an import come from, and what was there: so that a project is told whose source changed since then.

Kept below `.archgen/imported_from`, a file for each slice. Nothing of the source is read by what it means: its bytes are.
"""

from __future__ import annotations

import hashlib
import os
import stat
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from archgen.diagnostics import Diagnostic, Span
from archgen.edit.earlier_import import read_plain_mapping
from archgen.merge.file_merge import SOURCE_FOLDER
from archgen.pipeline import CheckedProject
from archgen.project.project_search import name_path_from
from archgen.regular_files import read_named_file
from archgen.syntax.project_files import read_text_file
from archgen.syntax.yaml_writer import write_yaml

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
        data = read_plain_mapping(record, read_text_file(files, record).text)
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
