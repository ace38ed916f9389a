"""Read a launch file in Python from its syntax tree. No line of it is run."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from archgen.diagnostics.source_span import Span
from archgen.importers.foreign.foreign_import import ForeignFileError
from archgen.importers.launch.launch_actions import LaunchAction
from archgen.importers.launch.launch_values import UnknownValue
from archgen.importers.launch.python_calls import CallReader
from archgen.importers.launch.python_parsing import PythonRefusedError, parse_python
from archgen.importers.launch.python_values import CallArguments, FunctionValue, NameScope

if TYPE_CHECKING:
    from archgen.importers.launch.launch_run import LaunchRun

_ENTRY = "generate_launch_description"


def read_python_launch(file: str, own_name: str, text: str, run: LaunchRun) -> list[LaunchAction]:
    """Return the actions of a file. Raise ForeignFileError for what is no Python, or no launch file."""
    try:
        tree = parse_python(text)
    except PythonRefusedError as error:
        span = Span(file, error.line, error.column, error.line, error.column + 1)
        raise ForeignFileError(error.message, span, "archgen reads launch files as Python 3 does") from None
    reader = _FileReader(file, own_name, text, run)
    return reader.read_file(tree)


class _FileReader(CallReader):
    """Reads one file."""

    def __init__(self, file: str, own_name: str, text: str, run: LaunchRun) -> None:
        super().__init__(file, own_name, text.splitlines())
        self._run = run
        self._made: list[LaunchAction] = []

    def place(self, node: ast.AST) -> Span:
        """Return where a part of the file stands."""
        line, column = getattr(node, "lineno", 1), getattr(node, "col_offset", 0) + 1
        return Span(self.file, line, column, line, column + 1)

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
