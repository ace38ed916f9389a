"""Read a launch file in Python from its syntax tree. No line of it is run."""

from __future__ import annotations

import ast
from pathlib import Path
from typing import TYPE_CHECKING

from archgen.plugin.importing import ForeignFileError, Span, read_bounded
from archgen.plugins.ros.launch.launch_actions import LaunchAction
from archgen.plugins.ros.launch.launch_files import MAX_LAUNCH_BYTES
from archgen.plugins.ros.launch.launch_values import LaunchValue, UnknownValue
from archgen.plugins.ros.launch.python_calls import CallReader
from archgen.plugins.ros.launch.python_parsing import PythonRefusedError, parse_python
from archgen.plugins.ros.launch.python_values import CallArguments, FunctionValue, ModuleValue, NameScope

if TYPE_CHECKING:
    from archgen.plugins.ros.launch.launch_run import LaunchRun

_ENTRY = "generate_launch_description"


def read_python_launch(path: Path, run: LaunchRun) -> list[LaunchAction]:
    """Return the actions of a file. Raise ForeignFileError for what is no Python, or no launch file."""
    file, text = run.files.show_path(path), read_python_text(run.files.show_path(path), path)
    return _PythonFileReader(path, text, run, {}).read_file(_parse_file(file, text))


def read_python_text(file: str, path: Path) -> str:
    """Return the text of a file. Raise ForeignFileError."""
    data = read_bounded(path, MAX_LAUNCH_BYTES)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        words = "it is no UTF-8"
        raise ForeignFileError(words, Span(file, line, 1, line, 2), "save it as UTF-8") from None


def _parse_file(file: str, text: str) -> ast.Module:
    try:
        return parse_python(text)
    except PythonRefusedError as error:
        span = Span(file, error.line, error.column, error.line, error.column + 1)
        raise ForeignFileError(error.message, span, "archgen reads launch files as Python 3 does") from None


class _PythonFileReader(CallReader):
    """Reads one file."""

    def __init__(self, path: Path, text: str, run: LaunchRun, modules: dict[Path, NameScope]) -> None:
        super().__init__(
            run.files.show_path(path),
            run.files.name_file(path),
            text.replace("\r\n", "\n").replace("\r", "\n").split("\n"),
        )
        self._path = path
        self._run = run
        self.environment = run.context.environment
        self._folders: list[str] = []
        self._modules = modules
        """The modules beside the file that were read, for all of them together."""

    def add_module_folder(self, folder: LaunchValue) -> None:
        """Look for modules in a folder, too."""
        text = self._run.context.resolve(folder)
        if isinstance(text, str):
            self._folders.append(text)

    def load_module(self, name: str) -> ModuleValue | None:
        """Return a module that lies beside the file, or in a package of the workspace as it installs them."""
        parts = name.split(".")
        if not all(part.isidentifier() for part in parts):
            return None
        folders = [self._path.parent.as_posix(), *self._folders]
        # `my_setup.arguments` lies in `my_setup/my_setup/arguments.py`.
        folders += [f"$(find-pkg-share {parts[0]}){inner}" for inner in ("", "/src")]
        texts = [f"{folder}/{'/'.join(parts)}{end}" for folder in folders for end in (".py", "/__init__.py")]
        path = next((found for text in texts if (found := self._run.files.find_file(text)) is not None), None)
        if path is None:
            return None
        if path not in self._modules:
            self._modules[path] = scope = NameScope(values={"__file__": path.as_posix(), "__name__": name})
            try:
                text = read_python_text(self._run.files.show_path(path), path)
                tree = _parse_file(self._run.files.show_path(path), text)
            except ForeignFileError as error:
                self._run.add_note("import", error.message, error.span)
            else:
                _PythonFileReader(path, text, self._run, self._modules).run_block(tree.body, scope)
        return ModuleValue(name, self._modules[path])

    def read_yaml(self, path: LaunchValue, node: ast.AST) -> LaunchValue:
        """Return what a file says, as a mapping; an UnknownValue where it cannot be read."""
        text = self._run.context.resolve(path)
        if isinstance(text, UnknownValue):
            return self.quote(node)
        file = self._run.files.find_file(text)
        values = None if file is None else self._run.parameter_reader.read_mapping(file)
        if values is None:
            is_far = file is None
            near_words = "it is no mapping in YAML, or more is opened than archgen reads"
            words = "it does not lie in the folders that were given" if is_far else near_words
            help_line = "give the folder of its package, too" if is_far else ""
            self._run.add_note("open", f"`{text}` is not read: {words}", self.place(node), help_line)
            return UnknownValue(text, getattr(node, "lineno", 0), self.file)
        return values

    def has_file(self, path: LaunchValue) -> bool:
        """Whether a file lies in the folders that were given."""
        text = self._run.context.resolve(path)
        return isinstance(text, str) and self._run.files.find_file(text) is not None

    def list_names(self, folder: LaunchValue) -> list[str]:
        """Return the names of the files in a folder."""
        text = self._run.context.resolve(folder)
        return self._run.files.list_names(text) if isinstance(text, str) else []

    def place(self, node: ast.AST) -> Span:
        """Return where a part of the file stands."""
        line, byte_offset = getattr(node, "lineno", 1), getattr(node, "col_offset", 0)
        text = self._lines[line - 1] if line <= len(self._lines) else ""
        column = len(text.encode("utf-8", "replace")[:byte_offset].decode("utf-8", "replace")) + 1
        return Span(self.file, line, column, line, column + 1)

    def tell_lost(self, word: str, message: str, node: ast.AST) -> None:
        """Note what is left out because only running it would tell."""
        self._run.add_note(word, message, self.place(node))

    def tell_noted(self, word: str, message: str, node: ast.AST) -> None:
        """Note what is taken otherwise than it is written."""
        self._run.add_note(word, message, self.place(node), fate="noted")

    def read_file(self, tree: ast.Module) -> list[LaunchAction]:
        """Return the actions of the file."""
        scope = NameScope(values={"__file__": self.own_name, "__name__": "launch_file"})
        self.run_block(tree.body, scope)
        is_known, function = scope.find(_ENTRY)
        if not is_known or not isinstance(function, FunctionValue):
            words = f"it has no function `{_ENTRY}`"
            raise ForeignFileError(words, Span.of_file(self.file), "give a launch file")
        holder = LaunchAction("description", "LaunchDescription", self.place(function.definition))
        result = self.call_function(function, CallArguments([], {}), function.definition)
        self.add_children(holder, result)
        if not self.count_step():
            words = "it takes more steps than archgen follows: what comes later is not read"
            self._run.add_note("launch file", words, Span.of_file(self.file))
        if result is None or isinstance(result, UnknownValue):
            self._run.add_note("launch file", "what it starts is computed", self.place(function.definition))
        return holder.children
