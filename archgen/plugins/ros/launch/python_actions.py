"""The actions of `launch` and `launch_ros`, made from their calls in Python, and what methods of values do there."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import NamedTuple

from archgen.plugin.importing import Span
from archgen.plugins.ros.launch.launch_context import LaunchContext
from archgen.plugins.ros.launch.launch_entities import ActionKind, LaunchAction, LaunchCondition
from archgen.plugins.ros.launch.launch_values import (
    MAX_TEXT,
    OPEN_FILE,
    LaunchValue,
    Substitution,
    UnknownValue,
    join_values,
)
from archgen.plugins.ros.launch.python_statements import StatementReader
from archgen.plugins.ros.launch.python_values import BoundMethod, CallArguments, FunctionValue, fill_text

_TEXT_METHODS = frozenset(
    {"lower", "upper", "strip", "lstrip", "rstrip", "replace", "split", "startswith", "endswith", "title"}
)
_MAX_GROWTH = 100
_SAME_METHODS = frozenset(
    {"perform", "as_posix", "resolve", "absolute", "toxml", "toprettyxml", "expanduser", "copy", "string", "__str__"}
)


class MethodReader(StatementReader):
    """Reads calls of methods."""

    def add_children(self, action: LaunchAction, value: LaunchValue, depth: int = 0) -> None:
        """Put what a value holds into an action, list by list."""
        if value is None or depth > 20:  # noqa: PLR2004 - lists in lists
            return
        if not self.budget.pay():
            self._run.tell_excess(action.word, action.span)
            return
        if isinstance(value, LaunchAction):
            action.children.append(value)
        elif isinstance(value, list | tuple):
            # However long it is, something is left for the lines behind it.
            followed = value[: self.budget.left // 4]
            if len(followed) < len(value):
                self._run.tell_excess(action.word, action.span)
            for item in followed:
                self.add_children(action, item, depth + 1)
        elif isinstance(value, UnknownValue):
            line = value.line or action.span.line
            span = Span(value.file or action.span.file, line, 1, line, 2)
            reason = f"what it gives is computed: `{value.reason}`"
            action.children.append(LaunchAction("unread", _name_call(value.reason), span, {"reason": reason}))

    def call_method(self, method: BoundMethod, arguments: CallArguments, node: ast.Call) -> LaunchValue:  # noqa: C901, PLR0911, PLR0912
        """Return what a method gives; what it changes is changed."""
        owner, name = method.owner, method.name
        if name == "perform_substitution":
            return arguments.get(0, "substitution")
        if name == "get" and isinstance(owner, BoundMethod) and owner.name == "launch_configurations":
            return Substitution("var", tuple(arguments.positional[:2]))
        if isinstance(owner, LaunchAction) and name in {"add_action", "add_entity"}:
            self.add_children(owner, arguments.get(0, "action", "entity"))
            if owner.children and self.conditions and not owner.children[-1].conditions:
                owner.children[-1].conditions += self.conditions
            return None
        if name == "read" and isinstance(owner, Substitution) and owner.kind == OPEN_FILE:
            # What a file holds is what printing it gives.
            return Substitution("command", (["cat ", owner.parts[0]],))
        if name == "find" and isinstance(owner, Substitution) and owner.kind in {"share", "prefix"}:
            return Substitution(owner.kind, (arguments.get(0, "package_name"),))
        if name in _SAME_METHODS and isinstance(owner, str | Substitution):
            return owner
        if isinstance(owner, list):
            return self._call_list_method(owner, name, arguments, node)
        if isinstance(owner, dict):
            return self._call_dict_method(owner, name, arguments, node)
        if name == "join" and isinstance(owner, str):
            return self._join_texts(owner, arguments.get(0), node)
        if name == "joinpath" and isinstance(owner, str | Substitution):
            return Substitution("path", (owner, *arguments.positional))
        if name == "format" and isinstance(owner, str):
            return self._format_text(owner, arguments, node)
        text = self.force(owner)
        if (
            name in _TEXT_METHODS
            and isinstance(text, str)
            and all(isinstance(each, str) for each in arguments.positional)
        ):
            # A text in the place of each letter, or a list of all letters.
            grown = (len(text) + 1) * max((len(each) for each in arguments.positional[1:]), default=1)
            if not self.pay_to_repeat(node, len(text)) or grown > MAX_TEXT * _MAX_GROWTH:
                return self.quote(node)
            try:
                found: LaunchValue = getattr(text, name)(*arguments.positional)
            except (
                TypeError,
                ValueError,
            ):  # as it would be when the file is run: an empty separator, an argument too few
                return self.quote(node)
            return found if not isinstance(found, str) or len(found) <= MAX_TEXT else self.quote(node)
        return self.quote(node)

    def _call_list_method(
        self, owner: list[LaunchValue], name: str, arguments: CallArguments, node: ast.Call
    ) -> LaunchValue:
        value = arguments.get(0)
        if name == "append":
            owner.append(self._with_conditions(value))
        elif name == "extend":
            if self.pay_for(value, node):
                items = list(value) if isinstance(value, list | tuple) else [value]
                owner += map(self._with_conditions, items)
        elif (
            name == "insert" and len(arguments.positional) > 1 and isinstance(value, int) and self.pay_for(owner, node)
        ):
            owner.insert(value, self._with_conditions(arguments.positional[1]))
        elif name == "copy":
            return list(owner)
        else:
            return self.quote(node)
        return None

    def _with_conditions(self, value: LaunchValue) -> LaunchValue:
        """Return an action that is added only if the conditions around hold."""
        if isinstance(value, LaunchAction):
            known = set(map(id, value.conditions))
            value.conditions += [each for each in self.conditions if id(each) not in known]
        return value

    def _call_dict_method(  # noqa: C901, PLR0911 - a method each
        self, owner: dict[LaunchValue, LaunchValue], name: str, arguments: CallArguments, node: ast.Call
    ) -> LaunchValue:
        value = arguments.get(0)
        match name:
            case "update":
                if isinstance(value, Mapping):
                    owner |= value if self.pay_for(value, node) else {}
                elif value is not None:
                    self.tell_lost("update", f"what it adds is computed: `{self.quote(node).reason}`", node)
                owner |= arguments.named
                return None
            case "items" if self.pay_for(owner, node):
                return [[key, each] for key, each in owner.items()]
            case "keys":
                return list(owner)
            case "values":
                return list(owner.values())
            case "copy":
                return dict(owner)
            case "get" if isinstance(value, str | int):
                return owner.get(value, arguments.get(1, "default"))
            case "pop" if isinstance(value, str | int):
                return owner.pop(value, arguments.get(1))
            case "setdefault" if isinstance(value, str | int):
                return owner.setdefault(value, arguments.get(1))
        return self.quote(node)

    def _join_texts(self, separator: str, items: LaunchValue, node: ast.Call) -> LaunchValue:
        if not isinstance(items, list | tuple) or not all(isinstance(item, str | Substitution) for item in items):
            return self.quote(node)
        parts: list[LaunchValue] = []
        for item in items:
            parts += [separator, item] if parts and separator else [item]
        return join_values(parts) if parts else ""

    def _format_text(self, text: str, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        made = None if arguments.named else fill_text(text.split("{}"), arguments.positional, "{")
        return self.quote(node) if made is None else made


def _name_call(text: str) -> str:
    """Return the name of what is called, for the kind of a note."""
    name = text.partition("(")[0].strip()
    return name.rpartition(".")[2] if name.replace(".", "").replace("_", "").isalnum() else "expression"


_STEPS_OF_AN_ACTION = 30
LAUNCH_MODULES = frozenset({"launch", "launch_ros"})
CONDITIONS = frozenset({"IfCondition", "UnlessCondition", "LaunchConfigurationEquals", "LaunchConfigurationNotEquals"})
_Argument = tuple[int | None, *tuple[str, ...]]
"""Where a call has something: at a place, where it has one, or by one of these names."""
_NODES = {"Node": "node", "LifecycleNode": "node", "ComposableNode": "node", "ComposableNodeContainer": "container"}
_PROGRAM_KEYS: Mapping[str, _Argument] = {
    "name": (None, "name", "node_name"),
    "respawn": (None, "respawn"),
    "respawn_delay": (None, "respawn_delay"),
    "directory": (None, "cwd"),
    "prefix": (None, "prefix"),
}
_NODE_KEYS: Mapping[str, _Argument] = {
    **_PROGRAM_KEYS,
    "package": (None, "package"),
    "executable": (None, "executable", "node_executable"),
    "plugin": (None, "plugin", "node_plugin"),
    "namespace": (None, "namespace", "node_namespace"),
    "remaps": (None, "remappings"),
    "parameters": (None, "parameters"),
    "arguments": (None, "arguments"),
    "ros_arguments": (None, "ros_arguments"),
}


class _ActionShape(NamedTuple):
    """What an action takes from the arguments of its call, which of these are actions in it, and what it always says."""

    kind: ActionKind
    taken: Mapping[str, _Argument] = MappingProxyType({})
    children: _Argument | None = None
    said: Mapping[str, LaunchValue] = MappingProxyType({})


_ARGUMENT = _ActionShape(
    "argument", {"name": (0, "name"), "default": (None, "default_value"), "choices": (None, "choices")}
)
_NAMESPACE = _ActionShape("namespace", {"namespace": (0, "namespace")})
_LOADED_NODES: _Argument = (None, "composable_node_descriptions")
_ACTIONS: Mapping[str, _ActionShape] = {
    "DeclareLaunchArgument": _ARGUMENT,
    # MoveIt's own: one that is true or false.
    "DeclareBooleanLaunchArg": _ARGUMENT,
    "GroupAction": _ActionShape(
        "group",
        {
            "scoped": (None, "scoped"),
            "forwards": (None, "forwarding"),
            "configurations": (None, "launch_configurations"),
        },
        (0, "actions"),
    ),
    "LoadComposableNodes": _ActionShape("load", {"target": (None, "target_container")}, _LOADED_NODES),
    "PushROSNamespace": _NAMESPACE,
    "PushRosNamespace": _NAMESPACE,
    "RegisterEventHandler": _ActionShape("group", {}, (0, "event_handler"), {"scoped": False}),
    "SetEnvironmentVariable": _ActionShape("environment", {"name": (0, "name"), "value": (1, "value")}),
    "SetLaunchConfiguration": _ActionShape("configure", {"name": (0, "name"), "value": (1, "value")}),
    "SetParameter": _ActionShape("parameter", {"name": (0, "name"), "value": (1, "value")}),
    "SetParametersFromFile": _ActionShape("parameter_file", {"file": (0, "filename")}),
    "SetRemap": _ActionShape("remap", {"from": (0, "src"), "to": (1, "dst")}),
    "SetUseSimTime": _ActionShape("parameter", {"value": (0, "value")}, None, {"name": "use_sim_time"}),
    **dict.fromkeys(
        (
            *("LogInfo", "SetROSLogDir", "Shutdown", "PushEnvironment", "PopEnvironment"),
            *("PushLaunchConfigurations", "PopLaunchConfigurations"),
        ),
        _ActionShape("ignored"),
    ),
}
_EVENTS = {
    "OnProcessExit": ("on_exit", "what is in it starts when another process has ended"),
    "OnProcessStart": ("on_start", "what is in it starts once another process runs"),
    "OnProcessIO": ("on_stdout", "what is in it starts when another process has printed something"),
    "OnExecutionComplete": ("on_completion", "what is in it starts when another action is complete"),
    "OnStateTransition": ("entities", "what is in it starts when a lifecycle node changes its state"),
    "OnShutdown": ("on_shutdown", "what is in it starts when the launch ends"),
}
_INCLUDED = frozenset(
    {
        *("PythonLaunchDescriptionSource", "XMLLaunchDescriptionSource", "YAMLLaunchDescriptionSource"),
        *("AnyLaunchDescriptionSource", "FrontendLaunchDescriptionSource", "LaunchDescriptionSource"),
    }
)


def make_condition(reader: MethodReader, name: str, arguments: CallArguments) -> LaunchCondition:
    """Return what `IfCondition` and its like say."""
    value = reader.copy(arguments.get(0, "predicate_expression", "launch_configuration_name"))
    if name.startswith("LaunchConfiguration"):
        expected = reader.copy(arguments.get(1, "expected_value"))
        value = Substitution("equals", (Substitution("var", (value,)), expected))
    return LaunchCondition(value, name in {"UnlessCondition", "LaunchConfigurationNotEquals"})


def make_action(
    reader: MethodReader, name: str, arguments: CallArguments, node: ast.Call
) -> LaunchAction | LaunchValue | None:
    """Return the action that a call makes; None where it makes none that archgen knows."""
    if name in _INCLUDED:
        return Substitution("join", (arguments.get(0, "launch_file_path", "location"),))
    maker = _MAKERS.get(name)
    if maker is None:
        return None
    if not reader.pay_to_repeat(node, _STEPS_OF_AN_ACTION):
        return reader.quote(node)
    action = maker(reader, name, arguments, node)
    condition = arguments.get(None, "condition")
    if isinstance(condition, LaunchCondition):
        action.conditions.append(condition)
    elif condition is not None:
        action.conditions.append(
            LaunchCondition(condition if isinstance(condition, UnknownValue) else reader.quote(node))
        )
    action.conditions += reader.conditions
    return action


def _make_node(reader: MethodReader, name: str, arguments: CallArguments, node: ast.Call) -> LaunchAction:
    values = _take_arguments(reader, arguments, _NODE_KEYS)
    environment = arguments.get(None, "additional_env") or arguments.get(None, "env")
    if isinstance(environment, Mapping):
        values["environment"] = reader.copy(environment)
    values["is_lifecycle"] = name == "LifecycleNode"
    action = LaunchAction(_NODES[name], name, reader.place(node), values)
    reader.add_children(action, arguments.get(*_LOADED_NODES))
    return action


def _make_listed(reader: MethodReader, name: str, arguments: CallArguments, node: ast.Call) -> LaunchAction:
    kind, taken, children, said = _ACTIONS[name]
    values = {**said, **_take_arguments(reader, arguments, taken)}
    action = LaunchAction(kind, name, reader.place(node), values)
    if children:
        reader.add_children(action, arguments.get(*children))
    return action


def _take_arguments(
    reader: MethodReader, arguments: CallArguments, taken: Mapping[str, _Argument]
) -> dict[str, LaunchValue]:
    """Return the arguments that are there, by archgen's names for them."""
    found = {key: arguments.get(place, *names) for key, (place, *names) in taken.items()}
    return {key: reader.copy(value) for key, value in found.items() if value is not None}


def _make_include(reader: MethodReader, name: str, arguments: CallArguments, node: ast.Call) -> LaunchAction:
    given = arguments.get(None, "launch_arguments")
    pairs = list(given.items()) if isinstance(given, Mapping) else given
    if pairs is not None and not isinstance(pairs, list | tuple):
        reader.tell_noted(name, "the arguments that it hands on are computed", node)
    values = {"file": reader.copy(arguments.get(0, "launch_description_source")), "arguments": reader.copy(pairs)}
    return LaunchAction("include", name, reader.place(node), values)


def _make_process(reader: MethodReader, name: str, arguments: CallArguments, node: ast.Call) -> LaunchAction:
    command = arguments.get(None, "cmd")
    values = {
        **_take_arguments(reader, arguments, {**_PROGRAM_KEYS, "environment": (None, "additional_env")}),
        "command": reader.copy(command if isinstance(command, list | tuple) else [command]),
        "splits_words": arguments.get(None, "shell") is True,
    }
    return LaunchAction("process", name, reader.place(node), values)


def _make_timer(reader: MethodReader, name: str, arguments: CallArguments, node: ast.Call) -> LaunchAction:
    period = arguments.get(None, "period")
    shown = period if isinstance(period, int | float | str) else "some"
    action = LaunchAction("later", name, reader.place(node), {"reason": f"what is in it starts after {shown} s"})
    reader.add_children(action, arguments.get(None, "actions"))
    return action


def _make_event(reader: MethodReader, name: str, arguments: CallArguments, node: ast.Call) -> LaunchAction:
    key, reason = _EVENTS[name]
    action = LaunchAction("later", name, reader.place(node), {"reason": reason})
    started = arguments.get(None, key)
    if isinstance(started, FunctionValue):
        started = reader.quote(node)
    reader.add_children(action, started)
    if name == "OnProcessExit" and not action.children:
        reader.add_children(action, arguments.get(1, key))
    return action


def _make_call(reader: MethodReader, name: str, arguments: CallArguments, node: ast.Call) -> LaunchAction:
    function = arguments.get(None, "function")
    given = arguments.get(None, "args")
    named = arguments.get(None, "kwargs")
    if not isinstance(function, FunctionValue):
        reason = f"what it gives is computed: `{reader.quote(node).reason}`"
        return LaunchAction("unread", name, reader.place(node), {"reason": reason})

    def call(context: LaunchContext) -> list[LaunchAction]:
        before, reader.context = reader.context, context
        try:
            holder = LaunchAction("group", name, reader.place(node))
            positional = list(given) if isinstance(given, list | tuple) else []
            call_arguments = CallArguments(
                [UnknownValue("context"), *positional], dict(named) if isinstance(named, Mapping) else {}
            )
            call_arguments.positional[0] = Substitution("context")
            reader.add_children(holder, reader.call_function(function, call_arguments, node))
            return holder.children
        finally:
            reader.context = before

    return LaunchAction("call", name, reader.place(node), {"call": call})


_MAKERS: dict[str, Callable[[MethodReader, str, CallArguments, ast.Call], LaunchAction]] = {
    "IncludeLaunchDescription": _make_include,
    "ExecuteProcess": _make_process,
    "ExecuteLocal": _make_process,
    "TimerAction": _make_timer,
    "RosTimer": _make_timer,
    "OpaqueFunction": _make_call,
    **dict.fromkeys(_ACTIONS, _make_listed),
    **dict.fromkeys(_EVENTS, _make_event),
    **dict.fromkeys(_NODES, _make_node),
}
