"""`archgen import launch`: nodes that exist, as launch files of ROS 1 and ROS 2 start them."""

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
from archgen.plugins.ros.launch.entity_actions import Ros1EntityReader, Ros2EntityReader, is_ros_1_launch
from archgen.plugins.ros.launch.launch_actions import LaunchAction, LaunchedNode
from archgen.plugins.ros.launch.launch_entities import read_xml_entities, read_yaml_entities
from archgen.plugins.ros.launch.launch_files import LaunchFiles
from archgen.plugins.ros.launch.launch_run import LaunchRun, give_server_parameters
from archgen.plugins.ros.launch.launch_slices import SliceMaker
from archgen.plugins.ros.launch.python_launch import read_python_launch
from archgen.plugins.ros.launch.python_parsing import decode_text

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
