"""Read a launch file in Python from its syntax tree. No line of it is run.

What calls in launch files in Python make: actions and substitutions of ROS, paths, and plain functions of Python.
"""

from __future__ import annotations

import ast
import posixpath
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from archgen.plugin.importing import ForeignFileError, Span
from archgen.plugins.ros.launch.launch_entities import LaunchAction, LaunchCondition
from archgen.plugins.ros.launch.launch_parameter_values import FILE_KIND, FileRewrites
from archgen.plugins.ros.launch.launch_values import MAX_TEXT, LaunchValue, Substitution, UnknownValue
from archgen.plugins.ros.launch.opened_files import OpenedFileReader
from archgen.plugins.ros.launch.python_actions import CONDITIONS, LAUNCH_MODULES, make_action, make_condition
from archgen.plugins.ros.launch.python_parsing import parse_launch_module
from archgen.plugins.ros.launch.python_values import BoundMethod, CallArguments, FunctionValue, ImportedName, NameScope

if TYPE_CHECKING:
    from archgen.plugins.ros.launch.launch_run import LaunchRun

_SUBSTITUTIONS: dict[str, tuple[str, tuple[str, ...]]] = {
    "LaunchConfiguration": ("var", ("variable_name", "default")),
    "LaunchConfigAsBool": ("var", ("name",)),
    "FindPackageShare": ("share", ("package",)),
    "FindPackagePrefix": ("prefix", ("package",)),
    "FindPackage": ("prefix", ("package",)),
    "get_package_share_directory": ("share", ("package_name",)),
    "get_package_share_path": ("share", ("package_name",)),
    "get_package_prefix": ("prefix", ("package_name",)),
    "EnvironmentVariable": ("env", ("name", "default_value")),
    "Command": ("command", ("command",)),
    "PythonExpression": ("eval", ("expression",)),
    "EqualsSubstitution": ("equals", ("left", "right")),
    "NotEqualsSubstitution": ("differs", ("left", "right")),
    "NotSubstitution": ("not", ("value",)),
    "AndSubstitution": ("and", ("left", "right")),
    "OrSubstitution": ("or", ("left", "right")),
    "AnonName": ("anon", ("name",)),
    "FileContent": ("file-content", ("path",)),
}
_FIRST_ARGUMENT = {
    "FindExecutable": "name",
    "PathSubstitution": "path",
    "TextSubstitution": "text",
    "ParameterFile": "param_file",
    "abspath": "path",
    "realpath": "path",
    "expanduser": "path",
    "deepcopy": "x",
    "normalize_to_list_of_substitutions": "subs",
    "perform_substitutions": "subs",
}
"""Calls that stand for what is given to them."""
_MAX_RANGE = 10**9
_BUILTINS = frozenset({"range", "list", "dict", "enumerate", "zip", "len", "int", "float", "open", "str"})
_MODULES = {
    "get": "os.environ",
    "getenv": "os",
    "join": "path",
    "dirname": "path",
    "process": "xacro",
    "process_file": "xacro",
    "process_doc": "xacro",
    "parse": "xacro",
    "safe_load": "yaml",
    "full_load": "yaml",
    "load": "yaml",
    "exists": "path",
    "isfile": "path",
}


class CallReader(OpenedFileReader):
    """Reads calls, and so whole files."""

    def __init__(self, path: Path, text: str, run: LaunchRun) -> None:
        super().__init__(path, text, run)
        self._callers |= {
            "LaunchDescription": self._call_launch_description,
            "PathJoinSubstitution": self._call_path_join,
            "join": self._call_join,
            "joinpath": self._call_join,
            "Path": self._call_join,
            "PurePath": self._call_join,
            "dirname": self._call_dirname,
            "ThisLaunchFileDir": lambda *_: posixpath.dirname(self.own_name),
            "ThisLaunchFile": lambda *_: self.own_name,
            "ParameterValue": self._call_parameter_value,
            "RewrittenYaml": self._call_rewritten_yaml,
            "ReplaceString": self._call_replace_string,
            "getenv": self._call_getenv,
            "get": self._call_getenv,
            "range": self._call_range,
            "list": self._call_list,
            "str": self._call_str,
            "dict": self._call_dict,
            "enumerate": self._call_enumerate,
            "zip": self._call_zip,
            "len": self._call_len,
            "int": partial(self._convert, int),
            "float": partial(self._convert, float),
        }

    def call(self, function: LaunchValue, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        """Return what a call gives."""
        if isinstance(function, FunctionValue):
            return self.call_function(function, arguments, node)
        if isinstance(function, BoundMethod):
            return self.call_method(function, arguments, node)
        if isinstance(function, ImportedName):
            return self._call_imported(function, arguments, node)
        return self.quote(node)

    def _call_imported(  # noqa: PLR0911 - a kind of name each
        self, function: ImportedName, arguments: CallArguments, node: ast.Call
    ) -> LaunchValue:
        name = function.last
        if name in _SUBSTITUTIONS:
            return self._make_substitution(name, arguments, node)
        if name in CONDITIONS:
            return make_condition(self, name, arguments)
        # By a table and not by the name of a method: the name comes from the file, and may be that of any method here.
        caller = self._callers.get(name)
        if caller is not None and _is_meant(function):
            return caller(arguments, node)
        if name in _FIRST_ARGUMENT and (arguments.positional or arguments.named):
            return arguments.get(0, _FIRST_ARGUMENT[name], *arguments.named)
        # Packages of launch files often add their own folder, and import from it in the next line.
        if function.name in {"sys.path.append", "sys.path.insert"} and arguments.positional:
            self.add_module_folder(arguments.positional[-1])
            return None
        action = make_action(self, name, arguments, node)
        if action is not None:
            return action
        if function.name.partition(".")[0] in LAUNCH_MODULES and ".actions" in function.name:
            return LaunchAction("unread", name, self.place(node), conditions=[*self.conditions])
        return self.quote(node)

    def _make_substitution(self, name: str, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        kind, names = _SUBSTITUTIONS[name]
        parts = [arguments.get(position, each) for position, each in enumerate(names)]
        while parts and parts[-1] is None:
            parts.pop()
        if not parts:
            return self.quote(node)
        made = self.copy(Substitution(kind, tuple(parts)))
        return made if not isinstance(made, UnknownValue) else self.quote(node)

    def _call_launch_description(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        action = LaunchAction("description", "LaunchDescription", self.place(node))
        self.add_children(action, arguments.get(0, "initial_entities"))
        return action

    def _call_path_join(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        parts = arguments.get(0, "substitutions")
        return Substitution("path", tuple(parts)) if isinstance(parts, list | tuple) else self.quote(node)

    def _call_join(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        parts = arguments.positional
        if any(isinstance(part, UnknownValue) for part in parts) or not parts:
            return self.quote(node)
        if len(parts) == 1:
            return parts[0]
        if all(isinstance(part, str) for part in parts):
            return posixpath.join(*parts) if sum(map(len, parts)) <= MAX_TEXT else self.quote(node)
        return Substitution("path", tuple(parts))

    def _call_dirname(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        path = arguments.get(0)
        if isinstance(path, Substitution) and path.kind == "path" and len(path.parts) > 1:
            return Substitution("path", path.parts[:-1])
        return posixpath.dirname(path) if isinstance(path, str) else self.quote(node)

    def _call_parameter_value(self, arguments: CallArguments, _node: ast.Call) -> LaunchValue:
        kind = arguments.get(1, "value_type")
        word = kind.last if isinstance(kind, ImportedName) else "yaml"
        return Substitution("typed", (arguments.get(0, "value"), {"float": "double"}.get(word, word)))

    def _call_rewritten_yaml(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        rewrites = arguments.get(1, "param_rewrites")
        changes = self.copy(rewrites) if isinstance(rewrites, Mapping) else {}
        root = arguments.get(2, "root_key")
        self.tell_noted(
            "RewrittenYaml", "values written over a parameter file are taken where the file can be read", node
        )
        source = arguments.get(0, "source_file")
        if isinstance(source, Substitution) and source.kind == FILE_KIND and isinstance(source.parts[2], FileRewrites):
            source, _, earlier = source.parts
            made = FileRewrites(changes, earlier.texts, earlier.condition)
        else:
            made = FileRewrites(changes)
        return Substitution(FILE_KIND, (source, "" if root is None else root, made))

    def _call_replace_string(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        texts, condition = arguments.get(1, "replacements"), arguments.get(2, "condition")
        if not isinstance(texts, Mapping):
            return self.quote(node)
        made = FileRewrites({}, self.copy(texts), condition if isinstance(condition, LaunchCondition) else None)
        return Substitution(FILE_KIND, (arguments.get(0, "source_file"), "", made))

    def _call_getenv(self, arguments: CallArguments, _node: ast.Call) -> LaunchValue:
        default = arguments.get(1, "default")
        return self.find_variable(arguments.get(0, "key"), *([] if default is None else [default]))

    def _call_range(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        ends = [self.force(each) for each in arguments.positional]
        if not ends or not all(isinstance(end, int) and abs(end) <= _MAX_RANGE for end in ends):
            return self.quote(node)
        try:
            numbers = range(*ends)
        except (ValueError, TypeError):
            return self.quote(node)
        return list(numbers) if self.pay_to_repeat(node, len(numbers)) else self.quote(node)

    def _call_list(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        value = arguments.get(0)
        if value is None:
            return []
        return list(value) if isinstance(value, list | tuple | Mapping) else self.quote(node)

    def _call_str(self, arguments: CallArguments, _node: ast.Call) -> LaunchValue:
        value = arguments.get(0)
        return "" if value is None else str(value) if isinstance(value, bool | int | float) else value

    def _call_dict(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        value = arguments.get(0)
        if value is None:
            return dict(arguments.named)
        if isinstance(value, list | tuple):
            pairs = [
                pair
                for pair in value
                if isinstance(pair, list | tuple) and len(pair) == 2 and isinstance(pair[0], str)  # noqa: PLR2004 - a name and a value
            ]
            return {pair[0]: pair[1] for pair in pairs} if len(pairs) == len(value) else self.quote(node)
        return {**value, **arguments.named} if isinstance(value, Mapping) else self.quote(node)

    def _call_enumerate(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        value = arguments.get(0)
        is_known = isinstance(value, list | tuple) and self.pay_to_repeat(node, 2 * len(value))
        return [list(pair) for pair in enumerate(value)] if is_known else self.quote(node)

    def _call_zip(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        if not all(isinstance(each, list | tuple) for each in arguments.positional):
            return self.quote(node)
        length = min(map(len, arguments.positional), default=0)
        if not self.pay_to_repeat(node, length * (1 + len(arguments.positional))):
            return self.quote(node)
        return [list(each) for each in zip(*arguments.positional, strict=False)]

    def _call_len(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        value = arguments.get(0)
        return len(value) if isinstance(value, list | tuple | str | Mapping) else self.quote(node)

    def _convert(self, kind: type[int | float], arguments: CallArguments, node: ast.Call) -> LaunchValue:
        value = self.force(arguments.get(0))
        is_short = isinstance(value, str) and len(value) < 30  # noqa: PLR2004 - no number is longer
        try:
            return kind(value) if is_short or isinstance(value, int | float) else self.quote(node)
        except (ValueError, OverflowError):
            return self.quote(node)


def _is_meant(function: ImportedName) -> bool:
    """Whether a function of this name is the one that archgen knows: others may be called so, too."""
    module, _, name = function.name.rpartition(".")
    if name in _BUILTINS:
        return not module
    return _MODULES.get(name, "") in module or not module


_ENTRY = "generate_launch_description"


def read_python_launch(path: Path, data: bytes, run: LaunchRun) -> list[LaunchAction]:
    """Return the actions of a file. Raise ForeignFileError for what is no Python, or no launch file."""
    text, tree = parse_launch_module(run.files.show_path(path), data)
    reader = CallReader(path, text, run)
    scope = NameScope(values={"__file__": reader.own_name, "__name__": "launch_file"})
    reader.run_block(tree.body, scope)
    is_known, function = scope.find(_ENTRY)
    if not is_known or not isinstance(function, FunctionValue):
        raise ForeignFileError(f"it has no function `{_ENTRY}`", Span.of_file(reader.file), "give a launch file")
    holder = LaunchAction("description", "LaunchDescription", reader.place(function.definition))
    result = reader.call_function(function, CallArguments([], {}), function.definition)
    if isinstance(result, LaunchAction):
        return [result]
    reader.add_children(holder, result)
    if result is None or isinstance(result, UnknownValue):
        run.add_note("launch file", "what it starts is computed", reader.place(function.definition))
    return holder.children
