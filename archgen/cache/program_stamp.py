"""Stamp the program itself: what decides an output's bytes beside its inputs. Every cache has this in its keys."""

from __future__ import annotations

import hashlib
import os
import re
import sys
import time
import zlib
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from operator import attrgetter
from pathlib import Path

from archgen import resources
from archgen.cache import SETTLED_NANOSECONDS, find_cache_path
from archgen.cache.file_store import FileStore, digest_text
from archgen.installed_plugins import list_all_entries, list_module_files

WRITER_LIBRARIES = (
    "jinja2",
    "jsonschema-rs",
    "lxml",
    "markupsafe",
    "markdown-it-py",
    "py-svg-hush",
    "pygraphviz",
    "python-docx",
    "pyyaml",
)
"""The libraries that decide what is written. The command line uses click beside them."""
_FOLDER_SUFFIXES = (".dist-info", ".egg-info")
_MOST_DIGESTS = 16
_IDENTITY = attrgetter("st_dev", "st_ino", "st_size", "st_mtime_ns", "st_ctime_ns")
_EMIT_FOLDER = Path(__file__).resolve().parents[1] / "emit"


@cache
def stamp_writers() -> str:
    """Stamp what writes and draws: the emitters with their fonts, the backends that ship, and all libraries."""
    return f"{recall_digest((_EMIT_FOLDER, resources.resource_path('backends')))} {_describe_libraries()}"


@cache
def stamp_program() -> str:
    """Stamp all of archgen: its code and data, what ships beside it, all libraries, and the plug-ins of others."""
    shipped_data = (
        resources.resource_path(name)
        for name in ("backends", "schemas", "passes", "docs/rules", "ros_library", "ros_type_mapper.yaml")
    )
    return f"{recall_digest((_EMIT_FOLDER.parent, *shipped_data))} {_describe_libraries()}{_describe_plugins()}"


def _describe_plugins() -> str:
    """Describe the plug-ins of others: who brings them, and their code, which changes without a new version while it is edited."""
    origins = dict.fromkeys(entry.origin for entry in list_all_entries())
    return f" {list(origins)} {digest_files(map(Path, list_module_files()))}" if origins else ""


def recall_digest(tops: Sequence[Path]) -> str:
    """Digest files and folders, or return what was found before, where all of them are the files that they were then.

    As in kept runs: no file is written without a change of its second date, and what changed just now may change again unseen.
    """
    settled_before = time.time_ns() - SETTLED_NANOSECONDS
    facts = [(file, *_IDENTITY(os.stat(file))) for _, file in _list_files(tops)]  # noqa: PTH116 - as below
    folder = find_cache_path()
    # On Windows the second date is that on which a file was made.
    if folder is None or os.name == "nt" or any(changed >= settled_before for *_, changed in facts):
        return digest_files(tops)
    store, key = FileStore(Path(folder), ".stamp", _MOST_DIGESTS), digest_text(repr(facts))
    digest = (store.load(key) or b"").decode("ascii", "replace")
    if not re.fullmatch("[0-9a-f]{64}", digest):
        digest = digest_files(tops)
        store.store(key, digest.encode())
    return digest


def digest_files(tops: Iterable[Path]) -> str:
    """Digest files and folders: names and contents, but for what Python leaves there (`__pycache__`)."""
    checksum = hashlib.sha256()
    for name, file in _list_files(tops):
        with open(file, "rb", buffering=0) as stream:  # noqa: PTH123
            data = stream.read()
        checksum.update(f"{name} {len(data)}\n".encode("utf-8", "surrogatepass") + data)
    return checksum.hexdigest()


def _list_files(tops: Iterable[Path]) -> Iterator[tuple[str, str]]:
    """Yield files, in a fixed order, with their names from the top: two installations of the same archgen share what they keep."""
    for top in tops:
        # By names as text: of a thousand files, paths as objects took more than half of the time.
        prefix = len(os.path.join(top.parent, ""))  # noqa: PTH118
        for file in sorted(_walk_files(top)):
            yield file[prefix:].replace(os.sep, "/"), file


def _walk_files(top: Path) -> Iterator[str]:
    name = os.fspath(top)
    if top.is_file():
        yield name
    for folder, subfolders, names in os.walk(name):
        # In place: os.walk goes on with this list. `_data` holds copies that a wheel forces in; `resources.path` reads
        # them.
        subfolders[:] = [name for name in subfolders if name not in {"__pycache__", "_data"}]
        yield from (os.path.join(folder, each) for each in names)  # noqa: PTH118


@cache
def _describe_libraries() -> str:
    """Describe the libraries: their versions, and for Graphviz's shared objects their sizes and dates."""
    folder_versions = _read_folder_versions()
    versions = [f"{name} {_choose_version(name, folder_versions.get(name, ()))}" for name in WRITER_LIBRARIES]
    # zlib decides the bytes of all that Python compresses, docx files above all.
    return f"{sys.version} {zlib.ZLIB_RUNTIME_VERSION} {versions} {sorted(_describe_graphviz())}"


def _read_folder_versions() -> dict[str, list[str]]:
    """Return the versions of installed libraries by their names, as the folders that installers leave tell them.

    Of a library that is installed twice, all of them: a stamp may change too often, but never too seldom. "" stands for one
    that is not told.
    """
    versions: dict[str, list[str]] = {}
    for place in dict.fromkeys(sys.path):
        try:
            entries = os.listdir(place or ".")  # noqa: PTH208 - names are enough
        except OSError:
            continue
        # Sorted: a stamp must not hang on the order of the disk.
        for entry in sorted(entries):
            stem, suffix = os.path.splitext(entry)  # noqa: PTH122 - thousands of names
            if suffix in _FOLDER_SUFFIXES:
                name, _, version = stem.partition("-")
                versions.setdefault(re.sub("[-_.]+", "-", name).lower(), []).append(version)
    return versions


def _choose_version(name: str, folder_versions: Sequence[str]) -> str:
    """Return what folders tell of a library's version, or, where they do not, what Python finds out."""
    return " ".join(folder_versions) if folder_versions and all(folder_versions) else _read_metadata_version(name)


def _read_metadata_version(name: str) -> str:
    # Imported here, and below: it takes long to load (it parses mails), and few installations lack such folders.
    from importlib import metadata

    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return ""


def _describe_graphviz() -> Iterator[str]:
    """Yield name, size and date of pygraphviz's shared libraries.

    One that was built again may hold another Graphviz under the same version of pygraphviz.
    """
    from importlib import util

    module_spec = util.find_spec("pygraphviz")
    if module_spec is None or module_spec.origin is None:
        return
    package = Path(module_spec.origin).parent
    for folder in (package, package.with_name("pygraphviz.libs")):
        for file in folder.glob("*") if folder.is_dir() else ():
            if ".so" in file.suffixes or file.suffix in {".pyd", ".dll", ".dylib"}:
                status = file.stat()
                yield f"{file.name} {status.st_size} {status.st_mtime_ns}"
