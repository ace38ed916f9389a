"""Which sources each program of a workspace is made of: targets of CMake with their libraries, scripts, entry points, plug-ins."""

from __future__ import annotations

import ast
import os
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from archgen.plugin.importing import ForeignFileError, Span, read_bounded
from archgen.plugins.ros.launch.python_parsing import PythonRefusedError, parse_python
from archgen.plugins.ros.ros_package.cmake_calls import CMAKE_FILE, CmakeCall, read_cmake_calls
from archgen.plugins.ros.ros_package.import_account import ImportAccount
from archgen.plugins.ros.ros_package.package_programs import MANIFEST, PackageManifest, read_manifest
from archgen.plugins.ros.sources.source_index import CPP_HEADERS, CPP_SOURCES

_MAX_PARTS = 200_000
_MAX_TEXT = 1_000_000
_SKIPPED = frozenset({"build", "install", "log", "devel", "node_modules", "__pycache__"})
_IGNORING = frozenset({"COLCON_IGNORE", "CATKIN_IGNORE", "AMENT_IGNORE"})
_TESTS = frozenset({"test", "tests"})
_ENTRY_POINT = re.compile(r"\s*([\w.\-]+)\s*=\s*([\w.]+)\s*:\s*([\w.]+)\s*")
_LIBRARY_WORDS = frozenset(
    {
        *("STATIC", "SHARED", "MODULE", "OBJECT", "INTERFACE", "EXCLUDE_FROM_ALL", "PUBLIC", "PRIVATE"),
        "NO_TARGET_LINK_LIBRARIES",
    }
)


@dataclass(slots=True, eq=False)
class ProgramSources:
    """A program, or a plug-in, and what it is made of."""

    language: str
    sources: tuple[Path, ...] = ()
    function: str = ""
    """The function of an entry point of Python; empty for a script."""
    plugin: str = ""
    """The class of a component that the program holds alone."""


@dataclass(slots=True, eq=False)
class WorkspacePackage:
    """A package with its files and programs."""

    manifest: PackageManifest
    manifest_name: str
    """The path of its package.xml, as messages name it."""
    files: list[Path] = field(default_factory=list)
    programs: dict[str, ProgramSources] = field(default_factory=dict)
    libraries: dict[str, tuple[Path, ...]] = field(default_factory=dict)
    """The sources of its libraries, by the names of targets."""
    links: dict[str, list[str]] = field(default_factory=dict)
    output_names: dict[str, str] = field(default_factory=dict)
    """What programs are called that have another name than their target."""


class WorkspaceFiles:
    """The packages below folders, with their files. What is built, hidden, ignored or behind a link is left out."""

    def __init__(self, roots: Iterable[Path], account: ImportAccount) -> None:
        self.packages: dict[str, WorkspacePackage] = {}
        self.shown: dict[Path, str] = {}
        self.account = account
        self.roots = tuple(root.resolve() for root in roots)
        for root in self.roots:
            self._walk(root)
        for package in self.packages.values():
            self._find_programs(package)

    def _walk(self, root: Path) -> None:
        count = 0
        owners: dict[Path, WorkspacePackage] = {}
        for top, folders, names in os.walk(root):
            folder = Path(top)
            if _IGNORING & set(names):
                folders.clear()
                continue
            folders[:] = sorted(name for name in folders if not name.startswith(".") and name not in _SKIPPED)
            count += len(names)
            if count > _MAX_PARTS:
                words = f"more than {_MAX_PARTS:,} files lie below it: what comes later is not read"
                self.account.add_note("folder", words, Span.of_file(root.name), "give folders that hold less", "noted")
                break
            owner = self._open_package(folder, root) if MANIFEST in names else owners.get(folder.parent)
            if owner is None:
                continue
            owners[folder] = owner
            if owner.manifest.folder != folder and folder.name in _TESTS:
                folders.clear()
                continue
            for name in sorted(names):
                path = folder / name
                if not path.is_symlink():
                    owner.files.append(path)
                    self.shown[path] = path.relative_to(root).as_posix()

    def _open_package(self, folder: Path, root: Path) -> WorkspacePackage | None:
        try:
            manifest = read_manifest(folder / MANIFEST)
        except ForeignFileError as error:
            self.account.add_note("package.xml", error.message, error.span, error.help_line)
            return None
        package = WorkspacePackage(manifest, (folder / MANIFEST).relative_to(root).as_posix())
        known = self.packages.setdefault(manifest.name, package)
        if known is not package:
            words = f"there is another package `{manifest.name}`, {known.manifest_name}: that one counts"
            self.account.add_note("package.xml", words, Span.of_file(package.manifest_name))
            return None
        return package

    def list_sources(self) -> Iterator[tuple[Path, str]]:
        """Yield the files that may be sources, with how messages name them."""
        for path, shown in self.shown.items():
            if (
                path.suffix in {".py", *CPP_SOURCES, *CPP_HEADERS}
                or not path.suffix
                or path.parent.name in {"scripts", "nodes", "bin"}
            ):
                yield path, shown

    def list_linked_sources(self, package: WorkspacePackage, target: str) -> list[Path]:
        """Return the sources of a target and of the libraries of the workspace that it is linked with, however far."""
        found: list[Path] = []
        pending, seen = [(package, target)], set[tuple[str, str]]()
        while pending:
            owner, name = pending.pop(0)
            key = (owner.manifest.name, name)
            if key in seen:
                continue
            seen.add(key)
            program = owner.programs.get(name)
            found += (
                program.sources if program is not None and program.language == "cpp" else owner.libraries.get(name, ())
            )
            for linked in owner.links.get(name, ()):
                scope, _, last = linked.rpartition("::")
                other = self.packages.get(scope or linked)
                if last in owner.libraries or last in owner.programs:
                    pending.append((owner, last))
                elif other is not None:
                    pending += [
                        (other, library) for library in ([last] if last in other.libraries else other.libraries)
                    ]
        return list(dict.fromkeys(found))

    def _find_programs(self, package: WorkspacePackage) -> None:
        folder, files = package.manifest.folder, frozenset(package.files)
        for name in ("setup.py", "setup.cfg"):
            if folder / name in files:
                self._read_setup(package, folder / name)
        if folder / CMAKE_FILE in files:
            shown = {path: self.shown[path] for path in package.files}
            for call in read_cmake_calls(folder / CMAKE_FILE, package.manifest.name, shown, self.account):
                self._read_cmake_call(package, call, files)
            for target, name in package.output_names.items():
                if target in package.programs:
                    package.programs[name] = package.programs.pop(target)
                    package.links[name] = package.links.pop(target, [])
        for path in package.files:
            # What a launch file starts by its file name, installed or not: scripts of ROS 1, above all.
            is_beside_modules = package.manifest.is_ros_1 and path.parent == folder / "src" and path.suffix == ".py"
            is_script = path.parent.name in {"scripts", "nodes", "bin", "script"} and path.suffix in {".py", ""}
            if is_script or is_beside_modules:
                package.programs.setdefault(path.name, ProgramSources("python", (path,)))

    def _read_text(self, path: Path) -> str:
        try:
            return read_bounded(path, _MAX_TEXT).decode("utf-8", "replace")
        except ForeignFileError as error:
            self.account.add_note("file", error.message, Span.of_file(self.shown[path]))
            return ""

    def _read_setup(self, package: WorkspacePackage, path: Path) -> None:
        text = self._read_text(path)
        items: list[str] = []
        if path.suffix == ".cfg":
            _, _, rest = text.partition("console_scripts")
            items = re.split(r"\n[^\S\n]*\[", rest)[0].split("\n")
        else:
            try:
                tree = parse_python(text)
            except PythonRefusedError as error:
                span = Span(self.shown[path], error.line, error.column, error.line, error.column + 1)
                self.account.add_note("setup.py", f"it cannot be read: {error.message}", span)
                return
            items = [n.value for n in ast.walk(tree) if isinstance(n, ast.Constant) and isinstance(n.value, str)]
        for item in items:
            match = _ENTRY_POINT.fullmatch(item)
            if match:
                source = self._find_module(package, match[2])
                if source is not None:
                    package.programs[match[1]] = ProgramSources("python", (source,), match[3])

    def _find_module(self, package: WorkspacePackage, module: str) -> Path | None:
        files = frozenset(package.files)
        inner = Path(*module.split("."))
        folders = (package.manifest.folder, package.manifest.folder / "src")
        paths = [folder / end for folder in folders for end in (inner.with_suffix(".py"), inner / "__init__.py")]
        return next((path for path in paths if path in files), None)

    def _read_cmake_call(  # noqa: C901 - a command each
        self, package: WorkspacePackage, call: CmakeCall, files: frozenset[Path]
    ) -> None:
        name, words = call.name.removeprefix("ament_auto_").removeprefix("cuda_"), list(call.words)
        if not words:
            return
        if name in {"add_executable", "add_library", "target_sources"} and not {"IMPORTED", "ALIAS"} & set(words):
            sources = _find_sources([each for each in words[1:] if each not in _LIBRARY_WORDS], call.folder, files)
            if "DIRECTORY" in words:
                top = call.folder / words[words.index("DIRECTORY") + 1]
                sources = tuple(
                    path for path in package.files if path.parent == top and path.name.endswith(CPP_SOURCES)
                )
            if name == "target_sources" and words[0] in package.libraries:
                package.libraries[words[0]] += sources
            elif name == "add_library":
                package.libraries[words[0]] = sources
            else:
                known = package.programs.get(words[0])
                package.programs[words[0]] = ProgramSources("cpp", (*(known.sources if known else ()), *sources))
        elif name in {"target_link_libraries", "ament_target_dependencies"}:
            package.links.setdefault(words[0], []).extend(each for each in words[1:] if each not in _LIBRARY_WORDS)
        elif call.output_name:
            package.output_names[words[0]] = call.output_name
        elif name == "rclcpp_components_register_node" and {"PLUGIN", "EXECUTABLE"} <= set(words[:-1]):
            plugin, executable = (words[words.index(word) + 1] for word in ("PLUGIN", "EXECUTABLE"))
            package.programs[executable] = ProgramSources("cpp", plugin=plugin)
            package.links.setdefault(executable, []).append(words[0])
        elif name in {"catkin_install_python", "install"} and "PROGRAMS" in words:
            for word in words[words.index("PROGRAMS") + 1 :]:
                path = (call.folder / word).resolve()
                if path in files:
                    package.programs[path.name] = ProgramSources("python", (path,))


def _find_sources(words: Iterable[str], folder: Path, files: frozenset[Path]) -> tuple[Path, ...]:
    paths = (Path(os.path.normpath(folder / word)) for word in words if word.endswith(CPP_SOURCES))
    return tuple(path for path in paths if path in files)
