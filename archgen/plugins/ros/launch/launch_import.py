"""`archgen import launch`: nodes that exist, as launch files of ROS 1 and ROS 2 start them, become slices: nodes,
containers, hosts.
"""

from __future__ import annotations

import posixpath
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from archgen.plugin import dataclass
from archgen.plugin.importing import (
    ForeignFileError,
    ForeignImport,
    ImportNote,
    Span,
    make_id,
    make_unique_id,
    title_from_id,
)
from archgen.plugin.model import ProcessScheduling
from archgen.plugin.ros import expand_name, find_name_fault, find_node_name_fault
from archgen.plugins.ros.launch.entity_actions import Ros1EntityReader, Ros2EntityReader, is_ros_1_launch
from archgen.plugins.ros.launch.launch_entities import LaunchAction, LaunchedNode, read_xml_entities, read_yaml_entities
from archgen.plugins.ros.launch.launch_files import LaunchFiles
from archgen.plugins.ros.launch.launch_run import LaunchRun, give_server_parameters
from archgen.plugins.ros.launch.launch_values import OPEN
from archgen.plugins.ros.launch.python_launch import read_python_launch
from archgen.plugins.ros.launch.python_parsing import decode_text

HINT = "launch"
_MAX_COMMENT = 120


class SliceMaker:
    """Makes the sections of one run. Ids are unique in all of its slices."""

    def __init__(self, run: LaunchRun) -> None:
        self._run = run
        self._ids_of_nodes: dict[int, str] = {}
        self._container_ids: dict[str, str] = {}
        self._containers: dict[int, str] = {}
        self._used: set[str] = set()
        self._used_containers: set[str] = set()
        self.comments: dict[tuple[str | int, ...], str] = {}

    def make_sections(self, nodes: Sequence[LaunchedNode]) -> dict[str, Any]:
        """Return the sections of a slice that holds some of the nodes."""
        self.comments = {}
        containers: dict[str, Any] = {}
        for node in nodes:
            if node.form == "container":
                container_id = self._name_container(node)
                containers[container_id] = self._write_container(node, container_id)
        for node in nodes:
            if node.form == "loaded" and node.container is None and node.container_name:
                self._add_far_container(node, containers)
        written = {self._make_node_id(node): node for node in nodes if node.form != "container"}
        hosts: dict[str, None] = {make_id(node.host, "host"): None for node in nodes if node.host in self._run.hosts}
        sections = {
            "hosts": {host: self._write_host(host) for host in hosts},
            "containers": containers,
            "nodes": {node_id: self._write_node(node, node_id) for node_id, node in written.items()},
        }
        return {name: section for name, section in sections.items() if section}

    def find_node_id(self, node: LaunchedNode) -> str:
        """Return the id of a node that was written; empty for a container."""
        return self._ids_of_nodes.get(id(node), "")

    def _write_host(self, host_id: str) -> dict[str, Any]:
        name, address = next(item for item in self._run.hosts.items() if make_id(item[0], "host") == host_id)
        return {"title": name, **({"description": f"Address: {address}"} if address else {})}

    def _name_container(self, node: LaunchedNode) -> str:
        wanted = make_id(node.name or node.executable or "container", "container")
        container_id = make_unique_id(wanted, self._used_containers)
        self._used_containers.add(container_id)
        self._containers[id(node)] = container_id
        if node.full_name:
            self._container_ids.setdefault(node.full_name, container_id)
        return container_id

    def _add_far_container(self, node: LaunchedNode, containers: dict[str, Any]) -> None:
        """Declare a container that another file starts: all that is known of it is its name."""
        full_name = node.container_name
        if full_name in self._container_ids:
            return
        namespace, _, name = full_name.rpartition("/")
        fault = find_node_name_fault(name) or (find_name_fault(namespace) if namespace else None)
        if fault:
            self._run.add_note(node.word, f"the container `{full_name}` is no name of ROS: {fault}", node.span)
            return
        container_id = make_unique_id(make_id(name, "container"), self._used_containers)
        self._used_containers.add(container_id)
        self._container_ids[full_name] = container_id
        containers[container_id] = {
            **({} if name == container_id else {"name": name}),
            **({"namespace": namespace} if namespace else {}),
            "hints": {HINT: {"file": node.file}},
        }
        message = f"the container `{full_name}` is started elsewhere: only its name is known"
        self._run.add_note(node.word, message, node.span, fate="noted")

    def _make_node_id(self, node: LaunchedNode) -> str:
        namespace = node.namespace.strip("/").replace("/", "_")
        name = (
            node.name
            or node.executable
            or node.plugin.rpartition(":")[2]
            or (node.command or ["node"])[0].rpartition("/")[2]
        )
        wanted = make_id(name, "node")
        if wanted in self._used and namespace:
            wanted = make_id(f"{namespace}_{name}", "node")
        node_id = make_unique_id(wanted, self._used)
        self._used.add(node_id)
        self._ids_of_nodes[id(node)] = node_id
        return node_id

    def _write_container(self, node: LaunchedNode, container_id: str) -> dict[str, Any]:
        is_usual = node.package == "rclcpp_components" and node.executable in {"component_container", ""}
        is_threaded = node.package == "rclcpp_components" and node.executable == "component_container_mt"
        data: dict[str, Any] = {
            **self._write_names(node, container_id),
            "package": "" if is_usual else node.package,
            "executable": "" if is_usual else node.executable,
            "parameters": nest_parameters(node.parameters),
            "host": make_id(node.host, "host") if node.host in self._run.hosts else "",
            "hints": {HINT: self._write_hint(node, keeps_rest=True)},
        }
        if is_usual:
            data["threads"] = 1
        elif is_threaded:
            data |= {"package": node.package, "executable": node.executable}
        self._comment(("containers", container_id), node)
        return {key: value for key, value in data.items() if value not in ("", {}, [], None)}

    def _write_node(self, node: LaunchedNode, node_id: str) -> dict[str, Any]:
        is_program = node.form == "program"
        kinds = ["lifecycle"] if node.is_lifecycle else []
        kinds += ["nodelet"] if node.is_nodelet else ["composable"] if node.form == "loaded" else []
        kinds += ["program"] if is_program else []
        data: dict[str, Any] = {
            "kind": kinds[0] if len(kinds) == 1 else kinds,
            **({} if is_program else self._write_names(node, node_id)),
            "package": node.package,
            "executable": node.executable,
            "plugin": node.plugin,
            "command": node.command,
            "status": "existing",
            "container": self._find_container(node),
            "host": make_id(node.host, "host") if node.host in self._run.hosts else "",
            "arguments": node.arguments,
            "remaps": self._write_remaps(node),
            "parameter_files": node.parameter_files,
            "parameters": nest_parameters(node.parameters),
            "parameter_commands": node.parameter_commands,
            "timing": _write_scheduling(node.scheduling),
            "start": self._write_start(node),
            "hints": {HINT: self._write_hint(node, keeps_rest=False)},
        }
        self._comment(("nodes", node_id), node)
        return {key: value for key, value in data.items() if value not in ("", {}, [], None)}

    def _find_container(self, node: LaunchedNode) -> str:
        if node.container is not None:
            return self._containers.get(id(node.container), "")
        return self._container_ids.get(node.container_name, "")

    def _write_names(self, node: LaunchedNode, element_id: str) -> dict[str, str]:
        names: dict[str, str] = {}
        name = node.name or node.program_name
        if name and name != element_id:
            fault = find_node_name_fault(name)
            if fault:
                self._run.add_note(node.word, f"`{name}` is no name of a node: {fault}", node.span)
            else:
                names["name"] = name
        if node.namespace.strip("/"):
            fault = find_name_fault(node.namespace)
            if fault:
                self._run.add_note(node.word, f"`{node.namespace}` is no namespace: {fault}", node.span)
            else:
                names["namespace"] = node.namespace
        return names

    def _write_remaps(self, node: LaunchedNode) -> dict[str, str]:
        remaps: dict[str, str] = {}
        first_names: dict[str | None, str] = {}
        for own_name, name in [(_write_private(each), _write_private(other)) for each, other in node.remaps.items()]:
            fault = next(
                (fault for each in (own_name, name) if (fault := find_name_fault(each) or _find_bare(each))),
                None,
            )
            if fault:
                is_open = OPEN in own_name + name
                words = "is known at the launch only" if is_open else f"is not taken: {fault}"
                message = f"the remap from `{own_name}` to `{name}` {words}"
                self._run.add_note(node.word, message, node.span, fate="noted" if is_open else "not taken")
                if is_open:
                    node.written[f"remaps.{own_name}"] = name
                    node.unclear_remaps.add("*" if OPEN in own_name else own_name)
                continue
            # ROS 2 takes the first rule for a name, however it is spelled; ROS 1 takes different ones, which `check` tells.
            full_name = expand_name(own_name, f"/{node.namespace.strip('/')}", node.name or "node", ros_1=False)
            first = own_name if self._run.context.is_ros_1 else first_names.setdefault(full_name, own_name)
            if first != own_name:
                message = f"the remap from `{own_name}` says nothing: the one from `{first}` counts"
                self._run.add_note(node.word, message, node.span, fate="noted")
            else:
                remaps[own_name] = name
        return remaps

    def _write_start(self, node: LaunchedNode) -> dict[str, Any]:
        start: dict[str, Any] = {}
        if node.respawn:
            start["respawn"] = True
            try:
                seconds = float(node.respawn_delay or 0)
            except ValueError:
                seconds = 0
            if 0 < seconds < 1e6:  # noqa: PLR2004 - longer than any robot waits
                start["respawn_delay"] = f"{seconds:g} s"
        kept = {"environment": node.environment, "directory": node.directory, "user": node.user}
        return start | {key: value for key, value in kept.items() if value}

    def _write_hint(self, node: LaunchedNode, *, keeps_rest: bool) -> dict[str, Any]:
        hint: dict[str, Any] = {"file": node.file}
        if node.conditions:
            hint["conditions"] = list(dict.fromkeys(node.conditions))
            if not node.is_on:
                hint["by_default"] = "off"
        kept: dict[str, Any] = {
            "arguments": node.launch_arguments,
            "other_ways": node.other_ways,
            "written": node.written,
        }
        if keeps_rest:
            kept |= {
                "arguments_of_program": node.arguments,
                "remaps": node.remaps,
                "parameter_files": node.parameter_files,
                "respawn": node.respawn,
                "environment": node.environment,
                "directory": node.directory,
                "parameter_commands": node.parameter_commands,
            }
        return hint | {key: value for key, value in kept.items() if value}

    def _comment(self, path: tuple[str | int, ...], node: LaunchedNode) -> None:
        if node.conditions:
            words = " and ".join(dict.fromkeys(node.conditions))
            text = " ".join(f"{'' if node.is_on else 'off by default: '}only {words}".split())
            self.comments[path] = text if len(text) <= _MAX_COMMENT else f"{text[:_MAX_COMMENT]}..."


def nest_parameters(parameters: Mapping[str, Any]) -> dict[str, Any]:
    """Return parameters by the parts of their names, as parameter files nest them; as they are where that is no tree."""
    given = {name: value for name, value in parameters.items() if value is not None}
    tree: dict[str, Any] = {}
    for name, value in given.items():
        *folders, leaf = name.split(".")
        place = tree
        for folder in folders:
            inner = place.setdefault(folder, {})
            if not isinstance(inner, dict):
                return given
            place = inner
        are_both_trees = leaf in place and isinstance(place[leaf], dict) and isinstance(value, dict)
        if not all(name.split(".")) or (leaf in place and not are_both_trees):
            return given
        place[leaf] = {**place[leaf], **value} if are_both_trees else value
    return tree


def _write_private(name: str) -> str:
    """Return a name; a private one of ROS 1 (`~map`) as both generations write it."""
    return f"~/{name[1:]}" if name.startswith("~") and name[1:2] not in {"", "/"} else name


def _find_bare(name: str) -> str | None:
    return "it is only a `/`" if name == "/" else None


def _write_scheduling(scheduling: ProcessScheduling) -> dict[str, Any]:
    priority = {} if scheduling.priority is None else {"priority": scheduling.priority}
    cores = list(scheduling.cores)
    return {**priority, **({"core": cores[0]} if len(cores) == 1 else {"cores": cores} if cores else {})}


_ENDINGS = (".launch.py", ".launch.xml", ".launch.yaml", ".launch.yml", ".launch", ".py", ".xml", ".yaml", ".yml")


def read_launch(
    files: Sequence[Path], arguments: Mapping[str, str] | None = None, environment: Mapping[str, str] | None = None
) -> ForeignImport:
    """Read launch files, or all that lie in folders and that no other one includes. Raise ForeignFileError.

    `arguments` are values of launch arguments by their names, as `ros2 launch` takes them; `environment` are variables
    that are set where it is called.
    """
    return _make_import(run_launch_files(files, arguments, environment))


@dataclass(frozen=True, slots=True)
class LaunchedFiles:
    """What launch files start: by file the nodes, and how many of each construct were taken."""

    run: LaunchRun
    by_file: Mapping[Path, tuple[list[LaunchedNode], Counter[str]]]

    def choose_nodes(self) -> list[LaunchedNode]:
        """Return the nodes that count: of several ways to start one node the one of the defaults."""
        kept = _drop_twins(self.run, {path: nodes for path, (nodes, _) in self.by_file.items()})
        return [node for nodes, _ in self.by_file.values() for node in nodes if id(node) in kept]


def run_launch_files(
    files: Sequence[Path], arguments: Mapping[str, str] | None = None, environment: Mapping[str, str] | None = None
) -> LaunchedFiles:
    """Walk through launch files, or through all that lie in folders and that no other one includes. Raise ForeignFileError."""
    launch_files = LaunchFiles(files)
    given = [path.resolve() for path in files if not path.is_dir()]

    def load(path: Path, run: LaunchRun) -> list[LaunchAction]:
        # What is given by name must be readable; what lies in a folder or is included is only noted.
        is_given = path in given and len(run.open_files) == 1
        return load_actions(path, run) if is_given else load_noted(path, run)

    run = LaunchRun(launch_files, load, arguments)
    run.context.environment = dict(environment or {})
    entries = given or launch_files.list_launch_files()
    if not entries:
        words = "there is no launch file in it"
        raise ForeignFileError(
            words, Span.of_file(str(files[0]) if files else "."), "name a launch file, or a folder with some"
        )
    launched: dict[Path, tuple[list[LaunchedNode], Counter[str]]] = {}
    notes: dict[Path, list[ImportNote]] = {}
    for path in dict.fromkeys(entries):
        run.nodes, run.taken = [], Counter()
        run.run_file(path)
        launched[path] = (run.nodes, run.taken)
        notes[path] = run.take_notes()
    if not given:
        launched = {path: each for path, each in launched.items() if path not in run.included} or launched
    # What another file includes was run alone, too, without the arguments that it gets there.
    for note in (each for path in launched for each in notes[path]):
        run.add_note(note.kind, note.message, note.span, note.help_line, note.fate)
    run.arguments.refuse_unknown(run.context.asked, launch_files.show_path(entries[0]))
    for root, count in launch_files.cut_roots.items():
        words = f"only the first {count:,} folders in it were looked through: packages that lie in others are not found"
        run.add_note("folder", words, Span.of_file(root.name or "/"), "give folders that hold less", fate="noted")
    return LaunchedFiles(run, launched)


def _make_import(files: LaunchedFiles) -> ForeignImport:
    run, launched = files.run, files.by_file
    kept = {id(node) for node in files.choose_nodes()}
    for_all = give_server_parameters(
        run, run.server_parameters, [node for nodes in launched.values() for node in nodes[0] if id(node) in kept]
    )
    maker = SliceMaker(run)
    slices: dict[str, Mapping[str, Any]] = {}
    comments: dict[str, Mapping[tuple[str | int, ...], str]] = {}
    names: set[str] = set()
    for path, (nodes, _) in launched.items():
        name = make_unique_id(
            f"{make_id(find_stem(path), 'launch')}_launch".replace("_launch_launch", "_launch"), names
        )
        names.add(name)
        sections = maker.make_sections([node for node in nodes if id(node) in kept])
        if for_all:
            sections = {"ros": {"parameters": for_all}, **sections}
            for_all = {}
        if sections:
            slices[f"{name}.yaml"] = sections
            comments[f"{name}.yaml"] = maker.comments
    taken = sum((counts for _, counts in launched.values()), Counter[str]())
    title = title_from_id(make_id(find_stem(next(iter(launched))), "robot"))
    return ForeignImport(slices, dict(sorted((+taken).items())), tuple(run.notes), title, comments=comments)


def find_stem(path: Path) -> str:
    """Return the name of a launch file without what says that it is one."""
    name = path.name
    return next((name[: -len(ending)] for ending in _ENDINGS if name.lower().endswith(ending)), path.stem) or "robot"


_WAY_KEYS = ("package", "executable", "plugin", "arguments", "remaps", "parameters", "environment")


def _drop_twins(run: LaunchRun, nodes_by_file: Mapping[Path, Sequence[LaunchedNode]]) -> set[int]:
    """Return which nodes are taken, by identity: of those with one full name the one that runs by the defaults.

    Two that one file starts without any condition both run, and are both taken: that they share a name is the robot's fault.
    """
    kept: dict[str, LaunchedNode] = {}
    nodes = [node for nodes in nodes_by_file.values() for node in nodes]
    files = {id(node): path for path, nodes in nodes_by_file.items() for node in nodes}
    # What is no node may be called as another one.
    free = [node for node in nodes if not node.known_name or node.form == "program"]
    for node in nodes:
        if not node.known_name or node.form == "program":
            continue
        other = kept.get(node.known_name)
        if other is None:
            kept[node.known_name] = node
            continue
        if not node.conditions and not other.conditions and node.form == "node" and files[id(node)] == files[id(other)]:
            free.append(node)
            continue
        winner, loser = (node, other) if node.is_on and not other.is_on else (other, node)
        kept[node.known_name] = winner
        differing = [key for key in _WAY_KEYS if getattr(winner, key) != getattr(loser, key)]
        if differing or winner.form != loser.form:
            conditions = list(dict.fromkeys(loser.conditions))
            words = f" (only {' and '.join(conditions)})" if conditions else ""
            message = f"another action starts `{loser.known_name}`, too: this one{words} is kept as a hint"
            run.add_note(loser.word, message, loser.span, fate="noted")
            keys = {*differing, "package", "executable", "plugin"}
            way = {key: getattr(loser, key) for key in _WAY_KEYS if key in keys}
            way |= {"container": loser.container_name, "conditions": conditions}
            winner.other_ways += [{key: value for key, value in way.items() if value}, *loser.other_ways]
    for node in nodes:
        # What a container that is left out would load is loaded by the one of its name.
        if node.container is not None:
            node.container = kept.get(node.container.full_name, node.container)
    return {id(node) for node in [*free, *kept.values()]}


def load_noted(path: Path, run: LaunchRun) -> list[LaunchAction]:
    """Return the actions of a file; of one that cannot be read none, with a note."""
    try:
        return load_actions(path, run)
    except ForeignFileError as error:
        run.add_note("launch file", error.message, error.span, error.help_line)
        return []


def load_actions(path: Path, run: LaunchRun) -> list[LaunchAction]:
    """Return the actions of a file. Raise ForeignFileError."""
    name = run.files.show_path(path)
    data = run.read_file(path)
    if data is None:
        return []
    folder = posixpath.dirname(run.files.name_file(path))
    run.context.is_ros_1 = False
    if path.name.lower().endswith(".py"):
        return read_python_launch(path, data, run)
    if path.name.lower().endswith((".yaml", ".yml")):
        return Ros2EntityReader(folder).read_launch(read_yaml_entities(name, decode_text(name, data)))
    root = read_xml_entities(name, data)
    if is_ros_1_launch(root, path.name):
        run.context.is_ros_1 = True
        return Ros1EntityReader(folder).read_launch(root)
    return Ros2EntityReader(folder).read_launch(root)
