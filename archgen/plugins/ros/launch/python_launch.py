"""Read a launch file in Python from its syntax tree. No line of it is run."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from archgen.plugin.importing import ForeignFileError, Span
from archgen.plugins.ros.launch.launch_actions import LaunchAction
from archgen.plugins.ros.launch.launch_values import UnknownValue
from archgen.plugins.ros.launch.python_calls import CallReader
from archgen.plugins.ros.launch.python_parsing import parse_launch_module
from archgen.plugins.ros.launch.python_values import CallArguments, FunctionValue, NameScope

if TYPE_CHECKING:
    from archgen.plugins.ros.launch.launch_run import LaunchRun

_ENTRY = "generate_launch_description"


def read_python_launch(path: Path, data: bytes, run: LaunchRun) -> list[LaunchAction]:
    """Return the actions of a file. Raise ForeignFileError for what is no Python, or no launch file."""
    text, tree = parse_launch_module(run.files.show_path(path), data)
    reader = CallReader(path, text, run)
    scope = NameScope(values={"__file__": reader.own_name, "__name__": "launch_file"})
    reader.run_block(tree.body, scope)
    is_known, function = scope.find(_ENTRY)
    if not is_known or not isinstance(function, FunctionValue):
        words = f"it has no function `{_ENTRY}`"
        raise ForeignFileError(words, Span.of_file(reader.file), "give a launch file")
    holder = LaunchAction("description", "LaunchDescription", reader.place(function.definition))
    result = reader.call_function(function, CallArguments([], {}), function.definition)
    if isinstance(result, LaunchAction):
        return [result]
    reader.add_children(holder, result)
    if result is None or isinstance(result, UnknownValue):
        run.add_note("launch file", "what it starts is computed", reader.place(function.definition))
    return holder.children
