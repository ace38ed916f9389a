"""The controllers of ros2_control that spawners and commands of a launch file load: nodes in the process of their manager."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from archgen.plugin.importing import MappingNode, load_shipped_component_types, node_to_data
from archgen.plugin.ros import expand_name
from archgen.plugins.ros.launch.launch_actions import LaunchedNode, join_names
from archgen.plugins.ros.launch.launch_parameter_values import read_ros_arguments
from archgen.plugins.ros.launch.launch_run import LaunchRun
from archgen.plugins.ros.launch.launch_values import OPEN
from archgen.plugins.ros.launch.substitution_texts import split_words
from archgen.plugins.ros.workspace.program_reading import flatten_parameters

_MANAGER = "controller_manager"
_MANAGER_PROGRAMS = frozenset({"ros2_control_node"})
_MANAGER_OPTIONS = ("-c", "--controller-manager")
_FILE_OPTIONS = ("-p", "--param-file")
_TYPE_OPTIONS = ("-t", "--controller-type")
_OPTIONS_WITH_VALUE = frozenset(
    {*_MANAGER_OPTIONS, *_FILE_OPTIONS, *_TYPE_OPTIONS, "-n", "--namespace", "--controller-manager-timeout"}
    | {"--switch-timeout", "--service-call-timeout", "--controller-ros-args", "--set-state", "--state"}
)
_LOADING_COMMAND = ["ros2", "control", "load_controller"]
_CONTROLLER_NAME = re.compile(r"[A-Za-z_]\w*\Z")


def list_controllers(
    nodes: Sequence[LaunchedNode], run: LaunchRun
) -> Iterator[tuple[LaunchedNode, LaunchedNode, LaunchedNode]]:
    """Yield each controller as a node, with its manager and with what loads it. Those whose manager nothing here starts are left out."""
    managers = {each.known_name: each for each in nodes if each.executable in _MANAGER_PROGRAMS}
    found: set[str] = set()
    for node in nodes:
        is_spawner = node.package == _MANAGER and node.executable.partition(".")[0] == "spawner"
        words = node.arguments if is_spawner else node.command[3:] if node.command[:3] == _LOADING_COMMAND else []
        names, options = _split_words(words)
        wanted = next((options[each][-1] for each in _MANAGER_OPTIONS if each in options), _MANAGER)
        manager = managers.get(join_names(node.namespace, wanted))
        for name in names:
            made = None if manager is None else _make_controller(name, manager, node, options, run)
            if made is not None and manager is not None and made.full_name not in found:
                found.add(made.full_name)
                yield made, manager, node
        if is_spawner and names:
            # As the spawner calls itself.
            node.program_name = f"spawner_{names[0]}"


def _split_words(words: Sequence[str]) -> tuple[list[str], dict[str, list[str]]]:
    """Return the names among the words of a command, and its options with their values."""
    names: list[str] = []
    options: dict[str, list[str]] = {}
    open_option = ""
    for word in words:
        if word == "--ros-args":
            break
        if open_option:
            options.setdefault(open_option, []).append(word)
            open_option = ""
        elif word in _OPTIONS_WITH_VALUE:
            open_option = word
        elif _CONTROLLER_NAME.match(word):
            names.append(word)
    return names, options


def _make_controller(
    name: str, manager: LaunchedNode, loader: LaunchedNode, options: Mapping[str, list[str]], run: LaunchRun
) -> LaunchedNode:
    made = LaunchedNode("node", loader.word, loader.span, loader.file, name=name, namespace=manager.namespace)
    given = flatten_parameters(manager.parameters)
    files = [*manager.parameter_files, *(file for each in _FILE_OPTIONS for file in options.get(each, ()))]
    for text in files:
        path = run.files.find_file(text)
        values = None if path is None else run.parameter_reader.read_for_node(path, made.full_name)
        if values is None:
            made.unclear_parameters["*"] = f"the parameter file {text}"
        for key, value in (values or {}).items():
            made.parameters[key] = value
            made.file_parameters.add(key)
    told = next((options[each][-1] for each in _TYPE_OPTIONS if each in options), None)
    kind = given.get(f"{name}.type", made.parameters.get("type", told))
    if isinstance(kind, str) and OPEN not in kind:
        made.package, _, last = kind.replace("::", "/").partition("/")
        made.plugin = f"{made.package}::{last.replace('/', '::')}"
    made.parameter_files = [text for text in files if text.startswith(OPEN)]
    words = [word for text in options.get("--controller-ros-args", ()) for word in split_words(text)]
    made.arguments = ["--ros-args", *words]
    read_ros_arguments(made, made.parameter_files.append)
    made.remaps = {**made.remaps, **manager.remaps}
    made.unclear_remaps = set(manager.unclear_remaps)
    made.conditions = list(dict.fromkeys([*manager.conditions, *loader.conditions]))
    made.is_on = manager.is_on and loader.is_on
    made.host = manager.host
    return made


def find_controller_type(controller: LaunchedNode, distro: str) -> str:
    """Return the type of the library that ships which a controller is: of its package, called as its class where there are several."""
    wanted = re.sub(
        r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", controller.plugin.rpartition("::")[2]
    ).lower()
    fitting = []
    for name in load_shipped_component_types(distro):
        facts = _read_node_facts(name, distro)
        if facts.get("package") and not {"executable", "plugin"} & set(facts):
            is_own = facts["package"] == controller.package
            fitting += [name] if name == wanted and (is_own or controller.package.endswith("_controllers")) else []
    return next(iter(fitting), "")


def keep_own_remaps(controller: LaunchedNode, library_type: str, distro: str) -> None:
    """Leave out the remaps of its process that are for other nodes in it."""
    namespace = controller.namespace or "/"
    facts = _read_node_facts(library_type, distro) if library_type else {}
    uses = [use for kind in ("publishes", "subscribes", "serves", "calls") for use in facts.get(kind, {}).values()]
    values = [use.get("own_name", use.get("topic", "")) if isinstance(use, Mapping) else use for use in uses]
    names = [name for value in values for name in (value if isinstance(value, list) else [value])]
    full_names = {expand_name(name, namespace, controller.name, ros_1=False) for name in names if name}
    controller.remaps = {
        own_name: name
        for own_name, name in controller.remaps.items()
        if (full := expand_name(own_name, namespace, controller.name, ros_1=False)) in full_names
        or (full or "").startswith(f"{controller.full_name}/")
    }


def _read_node_facts(library_type: str, distro: str) -> Mapping[str, Any]:
    body = load_shipped_component_types(distro)[library_type].value
    facts = body.entries.get("node") if isinstance(body, MappingNode) else None
    found = None if facts is None else node_to_data(facts.value)
    return found if isinstance(found, dict) else {}
