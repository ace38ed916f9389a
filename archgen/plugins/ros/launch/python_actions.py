"""The actions of `launch` and `launch_ros`, made from their calls in Python."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping

from archgen.plugins.ros.launch.launch_actions import LaunchAction, LaunchCondition
from archgen.plugins.ros.launch.launch_context import LaunchContext
from archgen.plugins.ros.launch.launch_values import LaunchValue, Substitution, UnknownValue, copy_value
from archgen.plugins.ros.launch.python_methods import MethodReader
from archgen.plugins.ros.launch.python_values import CallArguments, FunctionValue

LAUNCH_MODULES = frozenset({"launch", "launch_ros"})
CONDITIONS = frozenset({"IfCondition", "UnlessCondition", "LaunchConfigurationEquals", "LaunchConfigurationNotEquals"})
_NODES = {"Node": "node", "LifecycleNode": "node", "ComposableNode": "node", "ComposableNodeContainer": "container"}
_NODE_KEYS = {
    "package": ("package",),
    "executable": ("executable", "node_executable"),
    "plugin": ("plugin", "node_plugin"),
    "name": ("name", "node_name"),
    "namespace": ("namespace", "node_namespace"),
    "remaps": ("remappings",),
    "parameters": ("parameters",),
    "arguments": ("arguments",),
    "ros_arguments": ("ros_arguments",),
    "respawn": ("respawn",),
    "respawn_delay": ("respawn_delay",),
    "directory": ("cwd",),
    "prefix": ("prefix",),
}
_PAIRS: dict[str, tuple[str, tuple[str, str]]] = {
    "SetParameter": ("parameter", ("name", "value")),
    "SetRemap": ("remap", ("src", "dst")),
    "SetLaunchConfiguration": ("configure", ("name", "value")),
    "SetEnvironmentVariable": ("environment", ("name", "value")),
}
_PAIR_KEYS = {"remap": ("from", "to")}
_LISTS = (
    "LogInfo",
    "SetROSLogDir",
    "Shutdown",
    "PopLaunchConfigurations",
    "PushLaunchConfigurations",
    "PushEnvironment",
    "PopEnvironment",
)
_EVENTS = {
    "OnProcessExit": ("target_action", "on_exit", "what is in it starts when another process has ended"),
    "OnProcessStart": ("target_action", "on_start", "what is in it starts once another process runs"),
    "OnProcessIO": ("target_action", "on_stdout", "what is in it starts when another process has printed something"),
    "OnExecutionComplete": ("target_action", "on_completion", "what is in it starts when another action is complete"),
    "OnStateTransition": (
        "target_lifecycle_node",
        "entities",
        "what is in it starts when a lifecycle node changes its state",
    ),
    "OnShutdown": (None, "on_shutdown", "what is in it starts when the launch ends"),
}
_INCLUDED = frozenset(
    {
        *("PythonLaunchDescriptionSource", "XMLLaunchDescriptionSource", "YAMLLaunchDescriptionSource"),
        *("AnyLaunchDescriptionSource", "FrontendLaunchDescriptionSource", "LaunchDescriptionSource"),
    }
)


def make_condition(name: str, arguments: CallArguments) -> LaunchCondition:
    """Return what `IfCondition` and its like say."""
    value = copy_value(arguments.get(0, "predicate_expression", "launch_configuration_name"))
    if name.startswith("LaunchConfiguration"):
        value = Substitution("equals", (Substitution("var", (value,)), arguments.get(1, "expected_value")))
    return LaunchCondition(value, name in {"UnlessCondition", "LaunchConfigurationNotEquals"})


def make_action(
    reader: MethodReader, name: str, arguments: CallArguments, node: ast.Call
) -> LaunchAction | LaunchValue | None:
    """Return the action that a call makes; None where it makes none that archgen knows."""
    if name in _INCLUDED:
        return Substitution("join", (arguments.get(0, "launch_file_path", "location"),))
    if name in _NODES:
        action = _make_node(reader, name, arguments, node)
    elif name in _PAIRS:
        action = _make_pair(reader, name, arguments, node)
    elif name in _LISTS:
        action = LaunchAction("ignored", name, reader.place(node))
    else:
        maker = _MAKERS.get(name)
        if maker is None:
            return None
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
    values: dict[str, LaunchValue] = {}
    for key, names in _NODE_KEYS.items():
        value = arguments.get(None, *names)
        if value is not None:
            values[key] = copy_value(value)
    environment = arguments.get(None, "additional_env") or arguments.get(None, "env")
    if isinstance(environment, Mapping):
        values["environment"] = copy_value(environment)
    values["is_lifecycle"] = name == "LifecycleNode"
    action = LaunchAction(_NODES[name], name, reader.place(node), values)
    reader.add_children(action, arguments.get(None, "composable_node_descriptions"))
    return action


def _make_pair(reader: MethodReader, name: str, arguments: CallArguments, node: ast.Call) -> LaunchAction:
    kind, names = _PAIRS[name]
    keys = _PAIR_KEYS.get(kind, names)
    values = {
        key: copy_value(arguments.get(place, each)) for place, (key, each) in enumerate(zip(keys, names, strict=True))
    }
    return LaunchAction(kind, name, reader.place(node), values)


def _make_argument(reader: MethodReader, name: str, arguments: CallArguments, node: ast.Call) -> LaunchAction:
    values = {
        "name": arguments.get(0, "name"),
        "default": copy_value(arguments.get(None, "default_value")),
        "choices": copy_value(arguments.get(None, "choices")),
    }
    return LaunchAction("argument", name, reader.place(node), values)


def _make_load(reader: MethodReader, name: str, arguments: CallArguments, node: ast.Call) -> LaunchAction:
    target = arguments.get(None, "target_container")
    action = LaunchAction("load", name, reader.place(node), {"target": copy_value(target)})
    reader.add_children(action, arguments.get(None, "composable_node_descriptions"))
    return action


def _make_include(reader: MethodReader, name: str, arguments: CallArguments, node: ast.Call) -> LaunchAction:
    given = arguments.get(None, "launch_arguments")
    pairs = list(given.items()) if isinstance(given, Mapping) else given
    if pairs is not None and not isinstance(pairs, list | tuple):
        reader.tell_noted(name, "the arguments that it hands on are computed", node)
    values = {"file": copy_value(arguments.get(0, "launch_description_source")), "arguments": copy_value(pairs)}
    return LaunchAction("include", name, reader.place(node), values)


def _make_group(reader: MethodReader, name: str, arguments: CallArguments, node: ast.Call) -> LaunchAction:
    scoped = arguments.get(None, "scoped")
    values = {
        "scoped": True if scoped is None else copy_value(scoped),
        "forwards": copy_value(arguments.get(None, "forwarding")),
        "configurations": copy_value(arguments.get(None, "launch_configurations")),
    }
    action = LaunchAction("group", name, reader.place(node), values)
    reader.add_children(action, arguments.get(0, "actions"))
    return action


def _make_simulated_time(reader: MethodReader, name: str, arguments: CallArguments, node: ast.Call) -> LaunchAction:
    values = {"name": "use_sim_time", "value": copy_value(arguments.get(0, "value"))}
    return LaunchAction("parameter", name, reader.place(node), values)


def _make_namespace(reader: MethodReader, name: str, arguments: CallArguments, node: ast.Call) -> LaunchAction:
    return LaunchAction("namespace", name, reader.place(node), {"namespace": copy_value(arguments.get(0, "namespace"))})


def _make_parameter_file(reader: MethodReader, name: str, arguments: CallArguments, node: ast.Call) -> LaunchAction:
    return LaunchAction("parameter_file", name, reader.place(node), {"file": copy_value(arguments.get(0, "filename"))})


def _make_process(reader: MethodReader, name: str, arguments: CallArguments, node: ast.Call) -> LaunchAction:
    command = arguments.get(None, "cmd")
    values = {
        "command": copy_value(command if isinstance(command, list | tuple) else [command]),
        "name": copy_value(arguments.get(None, "name")),
        "environment": copy_value(arguments.get(None, "additional_env")),
        "directory": copy_value(arguments.get(None, "cwd")),
        "prefix": copy_value(arguments.get(None, "prefix")),
        "respawn": copy_value(arguments.get(None, "respawn")),
        "respawn_delay": copy_value(arguments.get(None, "respawn_delay")),
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
    target, key, reason = _EVENTS[name]
    action = LaunchAction("later", name, reader.place(node), {"reason": reason})
    started = arguments.get(None, key)
    if isinstance(started, FunctionValue):
        started = reader.quote(node)
    reader.add_children(action, started)
    if target and name == "OnProcessExit" and not action.children:
        reader.add_children(action, arguments.get(1, key))
    return action


def _make_handler(reader: MethodReader, name: str, arguments: CallArguments, node: ast.Call) -> LaunchAction:
    action = LaunchAction("group", name, reader.place(node), {"scoped": False})
    reader.add_children(action, arguments.get(0, "event_handler"))
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
    "DeclareLaunchArgument": _make_argument,
    # MoveIt's own: one that is true or false.
    "DeclareBooleanLaunchArg": _make_argument,
    "LoadComposableNodes": _make_load,
    "IncludeLaunchDescription": _make_include,
    "GroupAction": _make_group,
    "PushRosNamespace": _make_namespace,
    "PushROSNamespace": _make_namespace,
    "SetParametersFromFile": _make_parameter_file,
    "ExecuteProcess": _make_process,
    "ExecuteLocal": _make_process,
    "TimerAction": _make_timer,
    "RegisterEventHandler": _make_handler,
    "OpaqueFunction": _make_call,
    "RosTimer": _make_timer,
    "SetUseSimTime": _make_simulated_time,
    **dict.fromkeys(_EVENTS, _make_event),
}
