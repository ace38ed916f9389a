"""The programs that a package installs: entry points of setup.py, and what CMake makes."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence
from typing import Any

from archgen.plugin.importing import ForeignFileError, Span, read_bounded
from archgen.plugins.ros.launch.python_parsing import PythonRefusedError, parse_python
from archgen.plugins.ros.ros_package.cmake_calls import read_cmake_calls
from archgen.plugins.ros.ros_package.import_account import ImportAccount
from archgen.plugins.ros.ros_package.package_files import PackageFile, PackageManifest

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
