"""Find what launch files name: packages below the folders that were given, and files in these packages. Nothing else is read."""

from __future__ import annotations

import os
import posixpath
import re
from collections.abc import Sequence
from pathlib import Path

from archgen.plugin.importing import ForeignFileError, read_bounded

LAUNCH_ENDINGS = (".launch", ".launch.xml", ".launch.yaml", ".launch.yml", ".launch.py")
MAX_LAUNCH_BYTES = 16_000_000
_MAX_FOLDERS = 20_000
_PARENTS_TRIED = 4
_TEST_FOLDERS = frozenset({"test", "tests"})
_SKIPPED = frozenset({"build", "install", "log", "node_modules", "devel"})
_PACKAGE_FILE = re.compile(r"\$\((?:find|find-pkg-share)\s+([A-Za-z0-9_.\-]+)\)(?:/share/\1)?(?:/(.*))?\Z", re.DOTALL)
_NAME_IN_MANIFEST = re.compile(r"<name[^>]*>\s*([A-Za-z0-9_.\-]+)\s*</name>")


def is_launch_file(name: str) -> bool:
    """Whether a file is called as launch files are."""
    lower_name = name.lower()
    return lower_name.endswith(LAUNCH_ENDINGS) or lower_name.endswith(("_launch.py", "_launch.xml", "_launch.yaml"))


class LaunchFiles:
    """The packages of the folders in which the given files lie."""

    def __init__(self, paths: Sequence[Path]) -> None:
        self.roots = list(dict.fromkeys(_find_root(path) for path in paths))
        self._own_folders = [folder for path in paths if (folder := _find_package_folder(path.resolve())) is not None]
        self.cut_roots: dict[Path, int] = {}
        """The folders of which not all was looked through, since there is too much in them: how many folders in each were."""
        self._packages: dict[str, Path] | None = None
        self._walked: dict[Path, dict[Path, list[str]]] = {}
        self._by_name: dict[Path, dict[str, list[Path]]] = {}

    def list_launch_files(self) -> list[Path]:
        """Return the launch files of all packages and folders, by path."""
        found = [
            path / name
            for root in self.roots
            for path, names in self._walk(root).items()
            for name in names
            if is_launch_file(name)
        ]
        return sorted(dict.fromkeys(found))

    def name_file(self, path: Path) -> str:
        """Return how launch files name a file of a package: `$(find-pkg-share NAME)/launch/x.launch.py`, else its path."""
        for parent in list(path.parents)[:_PARENTS_TRIED]:
            if (parent / "package.xml").is_file():
                name = _read_package_name(parent)
                return f"$(find-pkg-share {name})/{path.relative_to(parent).as_posix()}"
            if parent in self.roots:
                break
        return path.as_posix()

    def show_path(self, path: Path) -> str:
        """Return a file's path as messages name it: from the folder that was given."""
        for root in self.roots:
            if path.is_relative_to(root):
                return path.relative_to(root).as_posix()
        return path.as_posix()

    def find_file(self, text: str) -> Path | None:
        """Return the file that a text with `$(find-pkg-share ...)`, or a path, means, if it lies below a root."""
        match = _PACKAGE_FILE.match(text)
        if match:
            folder = self._find_package(match[1])
            return self._find_in_package(folder, match[2] or "") if folder else None
        if "$(" in text or not text.strip() or "\0" in text:
            return None
        return self._check(Path(posixpath.normpath(text)))

    def list_names(self, text: str) -> list[str]:
        """Return the names of the files in a folder that a text means, if it lies below a root."""
        match = _PACKAGE_FILE.match(text)
        folder = self._find_package(match[1]) if match else None
        inner = posixpath.normpath(match[2] or ".") if match else ".."
        if folder is None or inner.startswith(("/", "..")):
            return []
        return self._walk(folder).get(folder / inner, [])

    def _find_in_package(self, folder: Path, inner_path: str) -> Path | None:
        inner = posixpath.normpath(inner_path)
        if inner.startswith(("/", "..")) or "$(" in inner or "\0" in inner:
            return None
        found = self._check(folder / inner)
        if found is not None:
            return found
        # What a package installs need not lie so in its sources: `launch/x.py` may come from `bringup/launch/x.py`.
        name = posixpath.basename(inner)
        others = self._index_names(folder).get(name, [])
        alike = [path for path in others if path.as_posix().endswith(f"/{inner}")] or others
        return self._check(alike[0]) if len(alike) == 1 else None

    def _index_names(self, folder: Path) -> dict[str, list[Path]]:
        """Return the files of a package by their names, without those of its tests."""
        if folder not in self._by_name:
            index: dict[str, list[Path]] = {}
            self._by_name[folder] = index
            for path, names in self._walk(folder).items():
                if not _TEST_FOLDERS & set(path.relative_to(folder).parts):
                    for name in names:
                        index.setdefault(name, []).append(path / name)
        return self._by_name[folder]

    def _check(self, path: Path) -> Path | None:
        """Return a path of a file below a root, to which no link leads outside."""
        try:
            real_path = path.resolve()
            if path.is_file() and any(real_path.is_relative_to(root) for root in self.roots):
                return real_path
        except (OSError, ValueError, RuntimeError):
            return None
        return None

    def _find_package(self, name: str) -> Path | None:
        if self._packages is None:
            # Of packages of one name that of a given file counts.
            self._packages = {_read_package_name(folder): folder for folder in reversed(self._own_folders)}
            for root in self.roots:
                for path, names in self._walk(root).items():
                    if "package.xml" in names:
                        self._packages.setdefault(_read_package_name(path), path)
        return self._packages.get(name)

    def _walk(self, root: Path) -> dict[Path, list[str]]:
        """Return the folders below one, each with the names of its files."""
        if root in self._walked:
            return self._walked[root]
        found: dict[Path, list[str]] = {}
        self._walked[root] = found
        for folder, folders, names in os.walk(root):
            path = Path(folder)
            folders[:] = sorted(name for name in folders if not name.startswith(".") and name not in _SKIPPED)
            if len(found) >= _MAX_FOLDERS:
                self.cut_roots[root] = len(found)
                break
            found[path] = sorted(names)
        return found


def _find_root(path: Path) -> Path:
    """Return the folder below which files are looked for: a folder as given, else the package of a file and those beside it."""
    resolved = path.resolve()
    if resolved.is_dir():
        return resolved
    parent = _find_package_folder(resolved)
    if parent is None:
        return resolved.parent
    # Packages of one repository stand beside one another; a folder of all packages of a workspace is too much.
    return parent.parent if (parent.parent / ".git").exists() or _holds_packages(parent.parent) else parent


def _find_package_folder(file: Path) -> Path | None:
    parents = list(file.parents)[:_PARENTS_TRIED]
    return next((parent for parent in parents if (parent / "package.xml").is_file()), None)


def _holds_packages(folder: Path) -> bool:
    try:
        return sum((inner / "package.xml").is_file() for inner in list(folder.iterdir())[:500]) > 1
    except OSError:
        return False


def _read_package_name(folder: Path) -> str:
    try:
        text = read_bounded(folder / "package.xml", 1_000_000).decode("utf-8", "replace")
    except ForeignFileError:
        return folder.name
    match = _NAME_IN_MANIFEST.search(text)
    return match[1] if match else folder.name
