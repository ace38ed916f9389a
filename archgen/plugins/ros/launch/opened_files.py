"""Files that a launch file in Python opens itself: YAML in them is read where they lie in the folders that were given."""

from __future__ import annotations

import ast
from collections.abc import Callable

from archgen.plugins.ros.launch.launch_values import OPEN_FILE, LaunchValue, Substitution, UnknownValue
from archgen.plugins.ros.launch.moveit_configs import MoveItBuilder, call_builder, make_builder
from archgen.plugins.ros.launch.python_methods import MethodReader
from archgen.plugins.ros.launch.python_values import BoundMethod, CallArguments, RecordValue
from archgen.plugins.ros.launch.xacro_commands import make_xacro_command, write_mappings

_COMMAND_WORDS = 2


class OpenedFileReader(MethodReader):
    """Reads calls that open files."""

    def __init__(self, file: str, lines: list[str]) -> None:
        super().__init__(file, lines)
        self._callers: dict[str, Callable[[CallArguments, ast.Call], LaunchValue]] = {
            "MoveItConfigsBuilder": self._call_moveit_builder,
            "open": self._call_open,
            "exists": self._call_exists,
            "isfile": self._call_exists,
            "safe_load": self._call_safe_load,
            "load": self._call_safe_load,
            "full_load": self._call_safe_load,
            "process_file": self._call_process_file,
            "process": self._call_process_file,
            "parse": self._call_parse,
            "process_doc": self._call_process_doc,
        }
        """Who reads the calls of imported functions and classes, by the last part of their names."""

    def call_method(self, method: BoundMethod, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        """Return what a method gives; what it changes is changed."""
        if isinstance(method.owner, MoveItBuilder):
            return call_builder(self, method.owner, method.name, arguments, node)
        if isinstance(method.owner, RecordValue):
            return method.owner.values[method.name]
        if method.name in {"exists", "is_file"} and isinstance(method.owner, str | Substitution):
            return True if self.has_file(method.owner) else self.quote(node)
        return super().call_method(method, arguments, node)

    def _call_moveit_builder(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        return make_builder(arguments) or self.quote(node)

    def _call_open(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        path = arguments.get(0, "file")
        return Substitution(OPEN_FILE, (path,)) if isinstance(path, str | Substitution) else self.quote(node)

    def _call_exists(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        # That a file is not at hand says nothing about the robot.
        return True if self.has_file(arguments.get(0, "path")) else self.quote(node)

    def _call_safe_load(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        path = _find_path(arguments.get(0, "stream"))
        return self.quote(node) if path is None else self.read_yaml(path, node)

    def _call_process_file(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        path, mappings = arguments.get(0), arguments.get(None, "mappings")
        if isinstance(path, UnknownValue) or path is None or not (mappings is None or isinstance(mappings, dict)):
            return self.quote(node)
        return make_xacro_command(path, mappings)

    def _call_parse(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        path = _find_path(arguments.get(0))
        return self.quote(node) if path is None else make_xacro_command(path)

    def _call_process_doc(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        """Add what is given for the arguments of a document that `xacro.parse` gave: the document itself is changed."""
        document, mappings = arguments.get(0, "doc"), arguments.get(None, "mappings")
        words = document.parts[0] if isinstance(document, Substitution) and document.kind == "command" else None
        if not isinstance(words, list) or words[:1] != ["xacro "]:
            return self.quote(node)
        if isinstance(mappings, dict):
            words += write_mappings(mappings)
        elif mappings is not None:
            words.append(self.quote(node))
        return None


def _find_path(value: LaunchValue) -> LaunchValue | None:
    """Return the path of an open file, or of one whose text was read; None for anything else."""
    if not isinstance(value, Substitution):
        return None
    if value.kind == OPEN_FILE:
        return value.parts[0]
    words = value.parts[0] if value.kind == "command" else None
    is_text = isinstance(words, list) and len(words) == _COMMAND_WORDS and words[0] == "cat "
    return words[1] if is_text and words is not None else None
