"""Write the files that make up an output: all of them, or none.

A folder that archgen writes holds the manifest `.archgen-files` (digest and name of each file). A file that is named
there and still has its digest is archgen's own: it may be replaced, and is removed when it is no longer written. Any
other file belongs to somebody: archgen says so and stops.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import shutil
import stat
import tempfile
import time
import weakref
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import IO, Literal

from archgen.emit.own_file_marks import explain_refusal
from archgen.emit.safe_names import is_safe_path
from archgen.frozen import dataclass
from archgen.regular_files import read_named_file

with contextlib.suppress(ImportError):  # Windows has none
    import fcntl

TREE_MANIFEST = ".archgen-files"
_MANIFEST_HEADER = "# archgen wrote these files. It removes those that it no longer writes, and touches no others."
_MAX_FILE_BYTES = 1_000_000_000
_MAX_READ_BYTES = 16_000_000
"""A larger file is not read at once."""
_MAX_HELD_BYTES = 64_000_000
"""What comes after so many bytes of files waits on disk until it is written: the pages of 10,000 components have 290 MB."""
_MAX_MANIFEST_BYTES = 64_000_000
"""More than the manifest of 500,000 files has."""
_FILE_MANAGER_DEBRIS = frozenset({".DS_Store", "Thumbs.db", "desktop.ini"})
"""What file managers leave behind. It is nobody's work, so it is no obstacle."""
_STAGING_PREFIX = ".archgen-new-"
_LOCK_TRIES = 600
_SECONDS_BETWEEN_TRIES = 0.1


class OutputError(Exception):
    """An output cannot be written. `message` says why, `help` what to do. The user sees both, without a traceback."""

    def __init__(self, message: str, help: str | None = None) -> None:  # noqa: A002 - as in a diagnostic
        super().__init__(message)
        self.message = message
        self.help = help


@dataclass(frozen=True, slots=True)
class FileTree:
    """Files to write, by their path relative to the output folder (`/` between parts)."""

    files: Mapping[str, bytes]


@dataclass(frozen=True, slots=True)
class WriteResult:
    """What writing a tree changed: files by their path."""

    written: tuple[str, ...]
    unchanged: tuple[str, ...]
    removed: tuple[str, ...]


def make_file_tree(files: Iterable[tuple[str, bytes]]) -> FileTree:
    """Make a tree of files, sorted by path.

    Raise ValueError for an unsafe path and for two paths that differ in case only (`assign_safe_paths` makes good
    ones).
    """
    held_files = _HeldFiles()
    folded_paths: set[str] = set()
    for path, data in files:
        if not is_safe_path(path) or path == TREE_MANIFEST:
            raise ValueError(f"{path!r} is no safe name for an output file")
        if path.casefold() in folded_paths:
            raise ValueError(f"two output files are called {path!r}")
        folded_paths.add(path.casefold())
        held_files.add_file(path, data)
    held_files.places = dict(sorted(held_files.places.items()))
    return FileTree(held_files)


class _HeldFiles(Mapping[str, bytes]):
    """Files by path: the first ones in memory, those behind them in a file without a name, which goes when they do."""

    def __init__(self) -> None:
        self.places: dict[str, bytes | tuple[IO[bytes], int, int]] = {}
        """The data, or the store where it is, where it begins there, and how many bytes it has."""
        self._held_bytes = 0
        self._store: IO[bytes] | None = None

    def add_file(self, path: str, data: bytes) -> None:
        self._held_bytes += len(data)
        if self._held_bytes <= _MAX_HELD_BYTES:
            self.places[path] = data
            return
        if self._store is None:
            self._store = tempfile.TemporaryFile()  # noqa: SIM115 - for as long as the files are held
            weakref.finalize(self, self._store.close)
        self.places[path] = self._store, self._store.tell(), len(data)
        self._store.write(data)

    def __getitem__(self, path: str) -> bytes:
        place = self.places[path]
        if isinstance(place, bytes):
            return place
        store, begin, size = place
        store.seek(begin)
        return store.read(size)

    def __iter__(self) -> Iterator[str]:
        return iter(self.places)

    def __len__(self) -> int:
        return len(self.places)


def write_tree(files: FileTree, folder: Path) -> WriteResult:
    """Write a tree into its folder. Files that have their contents already are not touched.

    Raise OutputError, before anything was changed, where the folder holds what archgen did not write.
    """
    # Everything is read and compared first. Only `_replace_files` changes what is there.
    with _explain_os_errors(folder), lock_folder(folder := folder.resolve()):
        _remove_leftovers(folder)
        old_manifest = _read_tree_manifest(folder)
        own_digests = _find_own_files(folder, old_manifest)
        new_digests = {path: hashlib.sha256(data).hexdigest() for path, data in files.files.items()}
        changed = tuple(path for path, digest in new_digests.items() if own_digests.get(path) != digest)
        stale = tuple(path for path in own_digests if path not in new_digests)
        if changed or stale or old_manifest != {(digest, path) for path, digest in new_digests.items()}:
            _replace_files(folder, files, changed, stale, old_manifest=old_manifest, new_digests=new_digests)
        unchanged = tuple(path for path, digest in new_digests.items() if own_digests.get(path) == digest)
        return WriteResult(changed, unchanged, stale)


def write_file(path: Path, data: bytes) -> None:
    """Write one file: afterwards it is complete, or as it was. A link in its place is replaced, not followed.

    Raise OutputError where it would replace what archgen did not write in this format.
    """
    with _explain_os_errors(path):
        if path.exists() and not path.is_file():
            raise OutputError(f"{path} is not a regular file", "give the name of a file with `-o`")
        refusal = explain_refusal(path, data) if path.exists() else ""
        if refusal:
            raise OutputError(refusal, "nothing was changed; give another name with `-o`, or move that file away")
        path.parent.mkdir(parents=True, exist_ok=True)
        replace_file(path, data)


def replace_file(path: Path, data: bytes) -> None:
    """Put a file in the place of another one, whatever that holds: afterwards it is complete, or as it was.

    It has the permissions of the one that was there.
    """
    with open_staging_folder(path.parent) as staging_folder:
        # A file in a new folder gets the permissions that the user's umask asks for; mkstemp's own files have 0600.
        staged_file = staging_folder / "new"
        staged_file.write_bytes(data)
        if path.is_file() and not path.is_symlink():
            staged_file.chmod(stat.S_IMODE(path.stat().st_mode))
        os.replace(staged_file, path)  # noqa: PTH105 - says what it does on every system


@contextlib.contextmanager
def lock_folder(folder: Path) -> Iterator[None]:
    """Keep other runs of archgen out of a folder: they wait. One that is made for that goes again if it stays empty.

    Raise OutputError where another run does not come to its end, and for a file.
    """
    refuse_file(folder)
    new_folders = [each for each in (folder, *folder.parents) if not each.exists()]
    try:
        for _ in range(_LOCK_TRIES):
            folder.mkdir(parents=True, exist_ok=True)
            with _try_lock(folder) as lock:
                if lock != "held":
                    yield
                    return
            time.sleep(_SECONDS_BETWEEN_TRIES)
        raise OutputError(f"another archgen is writing into {folder}", "wait until it is done, and run this again")
    finally:
        with contextlib.suppress(OSError):
            for each in new_folders:
                each.rmdir()


def refuse_file(folder: Path) -> None:
    """Raise OutputError where a file stands in the place of a folder."""
    if folder.exists() and not folder.is_dir():
        raise OutputError(f"{folder} is a file, not a folder", "give another folder with `-o`")


@contextlib.contextmanager
def open_staging_folder(parent: Path) -> Iterator[Path]:
    """Give a folder in which files are made until they are whole, on the file system that they are for."""
    _remove_leftovers(parent)
    while True:
        staging_folder = Path(tempfile.mkdtemp(prefix=_STAGING_PREFIX, dir=parent))
        try:
            with _try_lock(staging_folder) as lock:
                if lock != "held":  # else another run takes it for a leftover
                    yield staging_folder
                    return
        finally:
            shutil.rmtree(staging_folder, ignore_errors=True)


def _remove_leftovers(parent: Path) -> None:
    """Remove the staging folders of runs that were killed: nobody holds their locks any more."""
    for left_over in parent.glob(f"{_STAGING_PREFIX}{'?' * 8}"):
        with contextlib.suppress(OSError), _try_lock(left_over) as lock:
            if lock == "ours":
                shutil.rmtree(left_over)


@contextlib.contextmanager
def _try_lock(folder: Path) -> Iterator[Literal["ours", "held", "none"]]:
    """Hold the lock of a folder, unless another run has it or has removed the folder; `none` where the system has no locks."""
    descriptor = None
    try:
        try:
            descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY) if "fcntl" in globals() else None
            if descriptor is not None:
                fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            lock: Literal["ours", "held", "none"] = "none" if descriptor is None else "ours"
        except (BlockingIOError, FileNotFoundError):
            lock = "held"
        except OSError:
            if descriptor is None:
                raise
            lock = "none"
        yield lock if folder.exists() else "held"
    finally:
        if descriptor is not None:
            os.close(descriptor)


def digest_manifest(folder: Path, *, just_written: bool = False) -> str | None:
    """Digest the manifest of a folder that holds exactly what archgen wrote. Return None for any other folder.

    With `just_written` the caller has just written the folder, and its files are not read again.
    """
    if not just_written:
        _remove_leftovers(folder)  # nobody may write this folder again
        manifest, own_digests = _read_tree_manifest(folder), dict[str, str]()
        if (
            any(_find_foreign_files(folder, manifest, own_digests))
            or {(digest, path) for path, digest in own_digests.items()} != manifest
        ):
            return None
    manifest_path = folder / TREE_MANIFEST
    return hashlib.sha256(manifest_path.read_bytes()).hexdigest() if manifest_path.is_file() else None


def digest_named_file(name: str, size: int) -> str | None:
    """Digest a file of a size in bytes; None for one that is larger than any of archgen's, which a branch may put in their place."""
    # By its path as text, here and in what walks a folder: of 5,000 files, paths as objects took half of the time.
    if size > _MAX_FILE_BYTES:
        return None
    with open(name, "rb", buffering=0) as stream:  # noqa: PTH123 - see above
        if size > _MAX_READ_BYTES:
            return hashlib.file_digest(stream, "sha256").hexdigest()
        return hashlib.sha256(stream.read()).hexdigest()


def _replace_files(  # noqa: PLR0913 - what the folder holds, and what it shall hold
    folder: Path,
    files: FileTree,
    changed: Sequence[str],
    stale: Iterable[str],
    *,
    old_manifest: set[tuple[str, str]],
    new_digests: Mapping[str, str],
) -> None:
    """Write what changed aside, then move it in.

    While files are moved, the manifest names the old and the new digests, so a run that was cut off is no obstacle.
    """
    final_manifest = {(digest, path) for path, digest in new_digests.items()}
    with open_staging_folder(folder) as staging_folder:
        changed_folders = sorted({path.rpartition("/")[0] for path in changed})
        for name in changed_folders:
            (staging_folder / name).mkdir(parents=True, exist_ok=True)
        for path in changed:
            with open(f"{staging_folder}/{path}", "wb") as file:  # noqa: PTH123 - as in `digest_named_file`
                file.write(files.files[path])
        # From here on each step leaves a folder that the next run can take over: both digests of a changed file are
        # known.
        (staging_folder / TREE_MANIFEST).write_bytes(_format_manifest(final_manifest | old_manifest))
        os.replace(staging_folder / TREE_MANIFEST, folder / TREE_MANIFEST)  # noqa: PTH105
        for path in stale:
            _remove_file(folder, path)
        for name in changed_folders:
            (folder / name).mkdir(parents=True, exist_ok=True)
        for path in changed:
            os.replace(f"{staging_folder}/{path}", f"{folder}/{path}")  # noqa: PTH105
        (staging_folder / TREE_MANIFEST).write_bytes(_format_manifest(final_manifest))
        os.replace(staging_folder / TREE_MANIFEST, folder / TREE_MANIFEST)  # noqa: PTH105


def _remove_file(folder: Path, path: str) -> None:
    """Remove one of archgen's files, and the folders that are empty without it."""
    (folder / path).unlink(missing_ok=True)
    for parent in (folder / path).parents:
        if parent == folder or any(parent.iterdir()):
            return
        parent.rmdir()


def _find_own_files(folder: Path, manifest: set[tuple[str, str]]) -> dict[str, str]:
    """Return archgen's own files in the folder with their digests. Raise OutputError where there are others."""
    own_digests: dict[str, str] = {}
    foreign = list(islice(_find_foreign_files(folder, manifest, own_digests), 4))
    if not foreign:
        return own_digests
    # Four were asked for, three are named: the fourth only tells that there are more.
    names = ", ".join(f"`{name}`" for name in foreign[:3]) + (" and others" if len(foreign) > 3 else "")  # noqa: PLR2004
    manifest_paths = {path for _, path in manifest}
    if all(name in manifest_paths for name in foreign):
        msg = f"{folder} holds files that were changed after archgen wrote them: {names}"
        raise OutputError(msg, "move your changes away and remove these files, or give another folder with `-o`")
    msg = f"{folder} holds files that archgen did not write: {names}"
    raise OutputError(msg, "nothing was changed; give an empty or new folder with `-o`, or move these files away")


def _find_foreign_files(folder: Path, manifest: set[tuple[str, str]], own_digests: dict[str, str]) -> Iterator[str]:
    """Yield the paths of files that are not archgen's, in order, and fill `own_digests` with those that are.

    `own_digests` is complete only when the generator is exhausted. Links are never followed.
    """
    manifest_paths = {path for _, path in manifest}
    folder_name = os.fspath(folder)
    for path in list_files_below(folder):
        if path in manifest_paths:
            name = f"{folder_name}/{path}"
            # lstat: a link that is named in the manifest is not archgen's, since archgen writes none.
            status = os.lstat(name)
            digest = digest_named_file(name, status.st_size) if stat.S_ISREG(status.st_mode) else None
            if digest and (digest, path) in manifest:
                own_digests[path] = digest
                continue
        is_at_work = path == TREE_MANIFEST or path.startswith(_STAGING_PREFIX)
        if not is_at_work and path.rpartition("/")[2] not in _FILE_MANAGER_DEBRIS:
            yield path


def list_files_below(folder: Path) -> Iterator[str]:
    """Yield everything below that is not a folder, as relative paths in order. A link counts as a file."""
    # A stack, not a recursion: folders may nest deeper than Python calls.
    pending_paths = [""] if folder.is_dir() else []
    while pending_paths:
        path = pending_paths.pop()
        if path and not path.endswith("/"):
            yield path
            continue
        with os.scandir(f"{os.fspath(folder)}/{path}") as entries:
            sorted_entries = sorted(entries, key=lambda entry: entry.name, reverse=True)
        pending_paths += [
            f"{path}{entry.name}{'/' if entry.is_dir(follow_symlinks=False) else ''}" for entry in sorted_entries
        ]


def _read_tree_manifest(folder: Path) -> set[tuple[str, str]]:
    """Read the (digest, path) pairs of a manifest. Lines that are none are skipped: what they claim is then foreign."""
    manifest_path = folder / TREE_MANIFEST
    # One that is too large is none of archgen's.
    try:
        data = b"" if manifest_path.is_symlink() else read_named_file(manifest_path, _MAX_MANIFEST_BYTES)
    except OSError:
        return set()
    lines = data.decode("utf-8", "replace").splitlines()
    pairs = (line.partition("  ") for line in lines if not line.startswith("#"))
    # A manifest can be edited: a path such as `../x` would let the next run remove files outside of the folder.
    return {(digest, path) for digest, _, path in pairs if path and is_safe_path(path)}


def _format_manifest(pairs: Iterable[tuple[str, str]]) -> bytes:
    lines = (f"{digest}  {path}" for digest, path in sorted(pairs, key=lambda pair: (pair[1], pair[0])))
    return "\n".join((_MANIFEST_HEADER, *lines, "")).encode()


@contextlib.contextmanager
def _explain_os_errors(path: Path) -> Iterator[None]:
    """Turn an error of the operating system into an OutputError in words."""
    try:
        yield
    except OSError as error:
        raise OutputError(f"cannot write {path}: {error.strerror or error}") from error
