"""The actions of `launch` and `launch_ros`, made from their calls in Python."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import NamedTuple

from archgen.plugins.ros.launch.launch_actions import ActionKind, LaunchAction, LaunchCondition
from archgen.plugins.ros.launch.launch_context import LaunchContext
from archgen.plugins.ros.launch.launch_values import LaunchValue, Substitution, UnknownValue
from archgen.plugins.ros.launch.python_methods import MethodReader
from archgen.plugins.ros.launch.python_values import CallArguments, FunctionValue

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
