"""The files of a package, what its package.xml says, and the programs that it installs: entry points of setup.py, and what
CMake makes.
"""

from __future__ import annotations

import ast
import os
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from archgen.plugin import dataclass
from archgen.plugin.importing import ForeignFileError, Span, XmlElement, parse_xml, read_bounded
from archgen.plugins.ros.launch.python_parsing import PythonRefusedError, parse_python
from archgen.plugins.ros.ros_package.cmake_calls import read_cmake_calls
from archgen.plugins.ros.ros_package.import_account import ImportAccount

MANIFEST = "package.xml"
_MAX_MANIFEST = 1_000_000
_MAX_PARTS = 100_000
_WEBSITE = re.compile(r"https?://[^\s<>\"]{1,1990}\Z")
_SKIPPED = frozenset({"build", "install", "log", "node_modules", "test", "tests"})


@dataclass(frozen=True, slots=True)
class PackageFile:
    """A file of a package: where it lies, and how messages name it."""

    path: Path
    shown: str


@dataclass(frozen=True, slots=True)
class PackageManifest:
    """What a package.xml says. `is_ros_1` is whether it is built by catkin."""

    folder: Path
    name: str
    version: str
    description: str
    licenses: tuple[str, ...]
    website: str
    is_ros_1: bool
    span: Span
    dependency_count: int


def find_manifests(paths: tuple[Path, ...]) -> list[Path]:
    """Return the package.xml of files and of folders, of a folder without one those of the packages below it."""
    found: list[Path] = []
    for path in paths:
        if path.is_dir():
            below = [path / MANIFEST] if (path / MANIFEST).is_file() else []
            found += below or sorted(file.path for file in walk_files(path) if file.path.name == MANIFEST)
        else:
            found.append(path)
    return list(dict.fromkeys(found))


def walk_files(folder: Path) -> Iterator[PackageFile]:
    """Yield the files below a folder; what is built, hidden or tested is left out, and no link is followed.

    Raise ForeignFileError where there are too many.
    """
    count = 0
    for top, folders, names in os.walk(folder):
        inner = Path(top).relative_to(folder)
        folders[:] = sorted(name for name in folders if not name.startswith(".") and name not in _SKIPPED)
        count += len(folders) + len(names)
        if count > _MAX_PARTS:
            words = f"more than {_MAX_PARTS:,} files and folders lie below it"
            raise ForeignFileError(words, Span.of_file(str(folder)), "give the folders of the packages instead")
        is_other = bool(inner.parts) and MANIFEST in names
        if is_other:
            # What is in another package is its own.
            folders.clear()
        for name in [MANIFEST] if is_other else sorted(names):
            path = Path(top) / name
            if not path.is_symlink():
                yield PackageFile(path, (Path(folder.name) / inner / name).as_posix())


def read_manifest(path: Path) -> PackageManifest:
    """Return what a package.xml says. Raise ForeignFileError."""
    shown = (Path(path.resolve().parent.name) / path.name).as_posix()
    root = parse_xml(shown, read_bounded(path, _MAX_MANIFEST))
    name = root.find("name")
    if root.tag != "package" or name is None or not name.text.strip():
        words = "it is no package.xml: there is no `name` in a `package`"
        raise ForeignFileError(words, root.span(shown), "give the package.xml of a package of ROS, or its folder")
    export = root.find("export")
    build_types = [each.text.strip() for each in export.find_all("build_type")] if export is not None else []
    tools = [*build_types, *(each.text.strip() for each in root.find_all("buildtool_depend"))]
    return PackageManifest(
        folder=path.resolve().parent,
        name=name.text.strip(),
        version=_read_child_text(root, "version"),
        description=" ".join(_read_child_text(root, "description").split()),
        licenses=tuple(text for each in root.find_all("license") if (text := each.text.strip())),
        website=next((each.text.strip() for each in root.find_all("url") if _is_website(each)), ""),
        # What is built by either is a package of both: then its messages are written as ROS 2 has them.
        is_ros_1="catkin" in tools and not any(tool.startswith("ament") for tool in tools),
        span=root.span(shown),
        dependency_count=sum(child.tag.endswith("depend") for child in root.children),
    )


def _read_child_text(root: XmlElement, tag: str) -> str:
    found = root.find(tag)
    return "" if found is None else found.text.strip()


def _is_website(url: XmlElement) -> bool:
    return url.attributes.get("type", "website") == "website" and _WEBSITE.match(url.text.strip()) is not None


_MAX_BYTES = 1_000_000
_MAX_NODES = 100_000
_ENTRY_POINT = re.compile(r"\s*([A-Za-z0-9_.\-]+)\s*=\s*[A-Za-z_][\w.]*:[A-Za-z_][\w.]*\s*")
_PROGRAM_NAME = re.compile(r"[A-Za-z0-9_.\-]+\Z")
_CLASS_NAME = re.compile(r"[A-Za-z_]\w*(?:::[A-Za-z_]\w*)+\Z")
_NO_NODES = frozenset({"IMPORTED", "ALIAS"})
_TEST_WORDS = frozenset({"test", "tests", "gtest", "benchmark", "benchmarks", "example", "examples"})
_WORD_ENDS = re.compile(r"[_.\-]+|(?<=[a-z])(?=[A-Z])")


def find_programs(
    manifest: PackageManifest, files: Sequence[PackageFile], account: ImportAccount
) -> dict[str, dict[str, Any]]:
    """Return what a `node` says of each program of a package, by the program's name."""
    programs: dict[str, dict[str, Any]] = {}
    for file in files:
        if file.path.parent != manifest.folder or file.path.name not in {"setup.py", "CMakeLists.txt"}:
            continue
        if file.path.name == "setup.py":
            found = _read_setup(file, account)
        else:
            found = _read_cmake(file, manifest.name, files, account)
        for name, more in found:
            if name not in programs:
                account.count("plug-in" if "plugin" in more else "program")
            programs[name] = {**programs.get(name, {}), "package": manifest.name, **more}
    return programs


def _read_setup(file: PackageFile, account: ImportAccount) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the console scripts of a setup.py, read by its syntax tree and never run."""
    place = Span.of_file(file.shown)
    try:
        tree = parse_python(read_bounded(file.path, _MAX_BYTES).decode("utf-8", "replace"))
    except ForeignFileError:
        return
    except PythonRefusedError as error:
        span = Span(place.file, error.line, error.column, error.line, error.column + 1)
        account.add_note("setup.py", f"it cannot be read: {error.message}", span)
        return
    nodes = [tree]
    seen = 0
    pending: list[ast.AST] = list(nodes)
    while pending and seen < _MAX_NODES:
        node = pending.pop()
        seen += 1
        pending += list(ast.iter_child_nodes(node))
        if isinstance(node, ast.Dict):
            for key, value in zip(node.keys, node.values, strict=True):
                if isinstance(key, ast.Constant) and key.value == "console_scripts":
                    yield from _read_scripts(value, place, account)


def _read_scripts(value: ast.expr, place: Span, account: ImportAccount) -> Iterator[tuple[str, dict[str, Any]]]:
    for item in value.elts if isinstance(value, ast.List | ast.Tuple) else [value]:
        text = item.value if isinstance(item, ast.Constant) and isinstance(item.value, str) else ""
        match = _ENTRY_POINT.fullmatch(text)
        if match:
            yield match[1], {"executable": match[1], "language": "python"}
        else:
            words = f"`{text}` is no entry point" if text else "which programs there are is computed"
            span = Span(place.file, item.lineno, 1, item.lineno, 2)
            account.add_note("console_scripts", words, span)


def _read_cmake(
    file: PackageFile, package: str, files: Sequence[PackageFile], account: ImportAccount
) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the programs that a CMakeLists.txt makes."""
    calls = [*read_cmake_calls(file.path, package, {each.path: each.shown for each in files}, account)]
    output_names = {call.words[0]: name for call in calls if (name := call.output_name)}
    for call in calls:
        words = list(call.words)
        if call.name.endswith("add_executable") and words:
            words[0] = output_names.get(words[0], words[0])
        if call.name in {"add_executable", "ament_auto_add_executable"} and words and not _NO_NODES & set(words):
            if not _PROGRAM_NAME.match(words[0]):
                span = Span(file.shown, call.line, 1, call.line, 2)
                account.add_note(call.name, f"the name of a program is computed: `{words[0]}`", span)
            elif not _TEST_WORDS & {word.lower() for word in _WORD_ENDS.split(words[0])}:
                yield words[0], {"executable": words[0], "language": "cpp"}
        elif call.name in {"rclcpp_components_register_node", "rclcpp_components_register_nodes"}:
            yield from _read_registration(words)


def _read_registration(words: list[str]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the plug-ins that a call registers, with the program that holds one alone."""
    executable = ""
    if "EXECUTABLE" in words[:-1]:
        executable = words[words.index("EXECUTABLE") + 1]
    for word in words[1:]:
        if _CLASS_NAME.match(word):
            name = executable if _PROGRAM_NAME.match(executable) else word.rpartition("::")[2]
            more = {"executable": executable} if _PROGRAM_NAME.match(executable) else {}
            yield name, {"plugin": word, "kind": "composable", "language": "cpp", **more}
