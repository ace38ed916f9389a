"""The sources of a workspace: files read once, modules of Python by their names, classes and functions of C++ by theirs."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path, PurePosixPath

from archgen.plugin.importing import ForeignFileError, read_bounded
from archgen.plugins.ros.sources.cpp_sources import make_cpp_parser, read_cpp_source
from archgen.plugins.ros.sources.python_sources import read_python_source
from archgen.plugins.ros.sources.source_code import MAX_SOURCE_BYTES, Function, SourceClass, SourceFile

CPP_SOURCES = (".cpp", ".cc", ".cxx", ".c++")
CPP_HEADERS = (".hpp", ".h", ".hh", ".hxx", ".tpp", ".inl", ".ipp")
_MAX_READ_FILES = 20_000
_MAX_OPENED_AT_ONCE = 2000


class SourceIndex:
    """Files are read when they are asked for. `files` are all of the workspace, by path, as messages name them."""

    def __init__(self, files: Iterable[tuple[Path, str]], package_folders: Iterable[tuple[str, Path]]) -> None:
        self._shown = dict(files)
        self._read: dict[Path, SourceFile | None] = {}
        self._parser = make_cpp_parser()
        self.has_cpp_reader = self._parser is not None
        self._headers: dict[str, list[Path]] = defaultdict(list)
        self._modules: dict[str, Path] = {}
        self._module_names: dict[Path, str] = {}
        roots = {folder / inner: name for name, folder in package_folders for inner in (name, f"src/{name}")}
        for path in self._shown:
            if path.name.endswith(CPP_HEADERS):
                self._headers[path.name].append(path)
            elif path.suffix == ".py":
                root = next((each for each in path.parents if each in roots), None)
                if root is not None:
                    self._add_module(path, root, roots[root])

    def _add_module(self, path: Path, root: Path, package: str) -> None:
        parts = [package, *path.relative_to(root).with_suffix("").parts]
        name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
        self._modules.setdefault(name, path)
        self._module_names[path] = name

    def find_module(self, name: str, beside: Path | None = None) -> SourceFile | None:
        """Return a module of Python by its dotted name: of a package of the workspace, or one beside a script."""
        path = self._modules.get(name)
        if path is None and beside is not None:
            inner = beside.parent.joinpath(*name.split("."))
            path = next((p for p in (inner.with_suffix(".py"), inner / "__init__.py") if p in self._shown), None)
        return None if path is None else self.read_file(path)

    def read_file(self, path: Path) -> SourceFile | None:
        """Return a file of the workspace; None for any other, and one in C++ where no reader is installed."""
        if path not in self._read:
            is_read = path in self._shown and len(self._read) < _MAX_READ_FILES
            self._read[path] = self._read_file(path) if is_read else None
        return self._read[path]

    def _read_file(self, path: Path) -> SourceFile | None:
        shown = self._shown[path]
        is_cpp = path.name.endswith((*CPP_SOURCES, *CPP_HEADERS))
        if is_cpp and self._parser is None:
            return None
        try:
            text = read_bounded(path, MAX_SOURCE_BYTES).decode("utf-8-sig", "replace")
        except ForeignFileError as error:
            return SourceFile(path, shown, "cpp" if is_cpp else "python", unread=[(1, 1, error.message)])
        if is_cpp and self._parser is not None:
            return read_cpp_source(self._parser, path, shown, text)
        module = self._module_names.get(path, "")
        package = module if path.name == "__init__.py" else module.rpartition(".")[0]
        return read_python_source(path, shown, text, package)

    def list_read_files(self) -> list[SourceFile]:
        """Return the files that were read, in the order of their paths."""
        return [file for _, file in sorted(self._read.items()) if file is not None]

    def gather_cpp(self, sources: Iterable[Path]) -> CppCode:
        """Return what files of C++ say, with the headers of the workspace that they include, level by level."""
        code = CppCode()
        pending, seen = list(sources), set[Path]()
        while pending and len(seen) < _MAX_OPENED_AT_ONCE:
            path = pending.pop(0)
            file = None if path in seen else self.read_file(path)
            seen.add(path)
            if file is not None:
                code.add_file(file)
                pending += [found for name in file.includes if (found := self._find_header(name, path)) is not None]
        code.join_files()
        return code

    def _find_header(self, name: str, includer: Path) -> Path | None:
        suffix = PurePosixPath(name).parts
        fitting = [
            path for path in self._headers.get(suffix[-1] if suffix else "", ()) if path.parts[-len(suffix) :] == suffix
        ]
        # Of several of one name that of the includer's own package counts: the one with the longest way in common.
        return max(fitting, key=lambda path: (_count_common(path, includer), path.as_posix()), default=None)


def _count_common(first: Path, second: Path) -> int:
    pairs = zip(first.parts, second.parts, strict=False)
    return next((place for place, (left, right) in enumerate(pairs) if left != right), 0)


class CppCode:
    """What the files of one program in C++ say together: a class is in its header, its methods elsewhere."""

    def __init__(self) -> None:
        self.files: list[SourceFile] = []
        self.classes: dict[str, SourceClass] = {}
        self.functions: dict[str, list[Function]] = defaultdict(list)
        self.aliases: dict[str, str] = {}
        self._by_last_name: dict[str, list[SourceClass]] = defaultdict(list)

    def add_file(self, file: SourceFile) -> None:
        """Add a file; of two classes of one name the one of the file that came first counts."""
        self.files.append(file)
        for name, found in file.classes.items():
            self.classes.setdefault(name, found)
        for alias, meaning in file.aliases.items():
            self.aliases.setdefault(alias, meaning)

    def join_files(self) -> None:
        """Give each class the methods that are defined outside of it."""
        for found in self.classes.values():
            self._by_last_name[found.name.rpartition("::")[2]].append(found)
        for file in self.files:
            for name, functions in file.functions.items():
                owner = self.find_class(functions[0].owner, "") if functions[0].owner else None
                if owner is None:
                    self.functions[name.rpartition("::")[2]] += functions
                else:
                    known = owner.functions.setdefault(functions[0].name, [])
                    known += [each for each in functions if each not in known]

    def find_class(self, name: str, around: str) -> SourceClass | None:
        """Return a class by the name that stands in a namespace or class; a name that fits two is none."""
        plain = name.removeprefix("::")
        outer = around.split("::") if around else []
        for length in range(len(outer), -1, -1):
            found = self.classes.get("::".join([*outer[:length], plain]))
            if found is not None:
                return found
        alike = [
            each
            for each in self._by_last_name.get(plain.rpartition("::")[2], ())
            if f"::{each.name}".endswith(f"::{plain}")
        ]
        return alike[0] if len(alike) == 1 else None
