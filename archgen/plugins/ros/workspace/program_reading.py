"""What the programs of a workspace say to ROS: each launched node with the walk through its sources, or its type of the
library; and the controllers of ros2_control that a launch file loads, which are nodes in the process of their manager.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from archgen.plugin import dataclass
from archgen.plugin.importing import MappingNode, Span, load_shipped_component_types, node_to_data
from archgen.plugin.ros import expand_name
from archgen.plugins.ros.launch.launch_entities import LaunchedNode, join_names
from archgen.plugins.ros.launch.launch_parameter_values import read_ros_arguments
from archgen.plugins.ros.launch.launch_run import LaunchRun
from archgen.plugins.ros.launch.launch_values import OPEN
from archgen.plugins.ros.launch.substitution_texts import split_words
from archgen.plugins.ros.ros_package.import_account import ImportAccount
from archgen.plugins.ros.sources.program_walk import ProgramWalk
from archgen.plugins.ros.sources.source_index import CppCode, SourceIndex
from archgen.plugins.ros.sources.walk_values import FoundNode, UnknownText, settle, show_value
from archgen.plugins.ros.workspace.program_sources import WorkspaceFiles, WorkspacePackage

CPP_EXTRA = "pip install 'archgen[sources]'"
_MAX_DEPTH = 20


@dataclass(frozen=True, slots=True)
class ReadProgram:
    """The nodes of a program. The first is the one that the launch file means."""

    nodes: tuple[FoundNode, ...]
    is_ros_1: bool
    strange_base: str = ""
    """A base of its classes that lies elsewhere, and may say more to ROS than what was read; empty where there is none."""


class ProgramReader:
    """Reads programs. What they have in common is read once."""

    def __init__(self, files: WorkspaceFiles, account: ImportAccount, run: LaunchRun) -> None:
        self._files = files
        self._run = run
        self._account = account
        self._index = SourceIndex(
            files.list_sources(), [(p.manifest.name, p.manifest.folder) for p in files.packages.values()]
        )
        self._codes: dict[tuple[str, str], CppCode] = {}

    def read_node(self, node: LaunchedNode) -> ReadProgram | None:
        """Return what a launched node says to ROS; None where its sources do not lie in the workspace, or cannot be read."""
        walk = self._walk_node(node, {})
        names = (
            {name for each in walk.nodes if isinstance(name := settle(each.name), str)} if walk is not None else set()
        )
        # What a file gives to a node by a name that only the program knows is known when that is.
        by_name = {name: self._read_files(node, name) for name in sorted(names - {node.name})}
        if any(by_name.values()):
            walk = self._walk_node(node, by_name)
        if walk is None or not walk.nodes:
            if walk is not None:
                words = f"no node was found in the sources of `{node.executable or node.plugin}`: it is not known what it says"
                self._account.add_note("program", words, node.span, fate="noted")
            return None
        main = next((each for each in walk.nodes if settle(each.name) == node.name), None)
        main = main or next((each for each in walk.nodes if each.endpoints), walk.nodes[0])
        # What is made twice at one place by one name, as by a module that runs when it is imported, is one after the other.
        made = {(each.span, show_value(each.name), show_value(each.namespace)): each for each in (*walk.nodes, main)}
        others = tuple(each for each in made.values() if each is not main and each.endpoints)
        if walk.is_cut:
            words = "it takes more steps than archgen walks: what comes later is not read"
            self._account.add_note("program", words, main.span)
        return ReadProgram((main, *others), walk.is_ros_1, next(iter(walk.strange_bases), ""))

    def _read_files(self, node: LaunchedNode, name: str) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for text in node.parameter_files:
            path, full_name = self._run.files.find_file(text), join_names(node.namespace, name)
            values = None if path is None else self._run.parameter_reader.read_for_node(path, full_name)
            found |= flatten_parameters(values or {})
        return found

    def _walk_node(self, node: LaunchedNode, by_name: Mapping[str, Mapping[str, Any]]) -> ProgramWalk | None:
        package = self._files.packages.get(node.package)
        if package is None:
            return None
        program = package.programs.get(node.executable)
        plugin = node.plugin or (program.plugin if program is not None else "")
        if program is None and not plugin:
            words = f"the sources of the program `{node.executable}` of `{node.package}` were not found: it is not known what it says"
            self._account.add_note("program", words, node.span, fate="noted")
            return None
        is_python = not plugin and program is not None and program.language == "python"
        if not is_python and not self._has_cpp(node):
            return None
        code = None if is_python else self._gather(package, "" if plugin else node.executable)
        given = _mark_unknown(flatten_parameters(node.parameters), node)
        walk = ProgramWalk(self._index, code, given, self._account.budget, is_ros_1=package.manifest.is_ros_1)
        names = {"name": node.name, "namespace": node.namespace}
        walk.node_names = {key: name for key, name in names.items() if name}
        walk.node_parameters = dict(by_name)
        if plugin:
            if not walk.walk_class(plugin.replace("/", "::")) and not walk.walk_class(plugin.rpartition("/")[2]):
                words = f"the class `{plugin}` was not found in the libraries of `{node.package}`: it is not known what it says"
                self._account.add_note("program", words, node.span, fate="noted")
        elif program is not None and is_python:
            file = self._index.read_file(program.sources[0])
            if file is not None:
                walk.walk_script(file, program.function)
        else:
            walk.walk_main()
        return walk

    def _has_cpp(self, node: LaunchedNode) -> bool:
        if not self._index.has_cpp_reader:
            words = f"sources in C++ are not read, those of `{node.executable or node.plugin}` for one"
            place = Span.of_file(node.package)
            if not any(note.kind == "C++" for note in self._account.notes):
                self._account.add_note("C++", words, place, f"`{CPP_EXTRA}` installs what reads them")
        return self._index.has_cpp_reader

    def _gather(self, package: WorkspacePackage, target: str) -> CppCode:
        key = (package.manifest.name, target)
        if key not in self._codes:
            if target:
                sources = self._files.list_linked_sources(package, target)
            else:
                sources = [
                    path for library in package.libraries for path in self._files.list_linked_sources(package, library)
                ]
            self._codes[key] = self._index.gather_cpp(sources)
        return self._codes[key]

    def tell_unread(self) -> None:
        """Note each file that was looked into and could not be read."""
        for file in self._index.list_read_files():
            for line, column, reason in file.unread:
                self._account.add_note("sources", reason, Span(file.shown, line, column, line, column + 1))


def flatten_parameters(parameters: Mapping[str, Any], outer: str = "", depth: int = 0) -> dict[str, Any]:
    """Return parameters by their dotted names."""
    found: dict[str, Any] = {}
    for name, value in parameters.items():
        full_name = f"{outer}{name}".replace("/", ".")
        if isinstance(value, Mapping) and depth < _MAX_DEPTH:
            found |= flatten_parameters(value, f"{full_name}.", depth + 1)
        else:
            found[full_name] = list(value) if isinstance(value, tuple) else value
    return found


def _mark_unknown(given: Mapping[str, Any], node: LaunchedNode) -> dict[str, Any]:
    """Return the parameters of a node as its program sees them: those that only the launch knows are not what the program has by default."""
    found = {
        name: UnknownText(value, node.span) if isinstance(value, str) and OPEN in value else value
        for name, value in given.items()
    }
    unclear = {**node.unclear_parameters, **dict.fromkeys(node.parameter_commands, "what a command prints")}
    return {**{name.replace("/", "."): UnknownText(why, node.span) for name, why in unclear.items()}, **found}


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
