"""`archgen import workspace`: one architecture of a workspace's launch files, packages, sources and the library that ships."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path

from archgen.plugin import dataclass
from archgen.plugin.importing import (
    ForeignFileError,
    ForeignImport,
    Span,
    index_shipped_programs,
    make_id,
    title_from_id,
)
from archgen.plugins.ros.launch.launch_actions import LaunchedNode
from archgen.plugins.ros.launch.launch_files import LaunchFiles
from archgen.plugins.ros.launch.launch_import import LaunchedFiles, find_stem, load_noted, run_launch_files
from archgen.plugins.ros.launch.launch_run import LaunchRun
from archgen.plugins.ros.launch.launch_slices import SliceMaker
from archgen.plugins.ros.ros_package.import_account import ImportAccount
from archgen.plugins.ros.workspace.gazebo_programs import read_gazebo_program
from archgen.plugins.ros.workspace.loaded_controllers import find_controller_type, keep_own_remaps, list_controllers
from archgen.plugins.ros.workspace.node_components import NodeKnowledge
from archgen.plugins.ros.workspace.program_reading import ProgramReader
from archgen.plugins.ros.workspace.program_sources import WorkspaceFiles
from archgen.plugins.ros.workspace.rviz_displays import read_rviz
from archgen.plugins.ros.workspace.used_messages import read_used_messages
from archgen.plugins.ros.workspace.workspace_slices import make_slices

_MAX_SHOWN = 12
_FOLDER_HELP = "give the folder in which the packages lie, `src` as a rule"
_ASSUMED_DISTRO = "jazzy"
_NO_LAUNCH = "none"
_GENERATED_NAMES = ("bringup", "robot")


@dataclass(frozen=True, slots=True)
class JoinedWorkspace:
    """A workspace with the nodes that its launch files start, and what is known of each."""

    files: WorkspaceFiles
    launched: LaunchedFiles
    knowledge: tuple[NodeKnowledge, ...]
    account: ImportAccount
    distro: str
    is_distro_known: bool


def read_workspace(  # noqa: PLR0913 - one for each option
    files: Sequence[Path],
    arguments: Mapping[str, str] | None = None,
    *,
    environment: Mapping[str, str] | None = None,
    launch_files: Sequence[str] = (),
    distro: str = "",
    group_by: str | None = None,
) -> ForeignImport:
    """Read a workspace. Raise ForeignFileError.

    `files` are folders with packages. `launch_files` are those that start the robot, as `PACKAGE/FILE` or as paths, and may be left
    out where one alone is included by no other. What only some of several start stands in variants; `none` takes each program.
    `group_by` is what makes a group of nodes: `folder` or `package` of their programs, `namespace`, or `codeowners`.
    """
    workspace = join_workspace(files, arguments, environment, launch_files, distro)
    account, launched = workspace.account, workspace.launched
    uses_library = any(each.library_type for each in workspace.knowledge)
    maker = SliceMaker(launched.run)
    made = make_slices(maker, workspace.knowledge, workspace.files, account, workspace.distro, group_by=group_by)
    slices = dict(made.slices)
    types = read_used_messages(workspace.files, workspace.knowledge, account, workspace.distro)
    if types:
        slices["messages.yaml"] = {"types": types}
    if not workspace.is_distro_known and uses_library:
        words = f"the distribution of ROS is not known: types of the library are those of {workspace.distro}"
        account.add_note("library", words, Span.of_file("."), "`--distro NAME` says another", fate="noted")
    entry = next(iter(launched.by_file))
    title = title_from_id(make_id(find_stem(entry), "robot"))
    notes = (*account.notes, *launched.run.notes)
    taken = dict(sorted((+account.taken).items()))
    return ForeignImport(
        slices, taken, notes, title, workspace.distro, made.comments, uses_shipped_library=uses_library
    )


def join_workspace(
    files: Sequence[Path],
    arguments: Mapping[str, str] | None,
    environment: Mapping[str, str] | None,
    launch_files: Sequence[str],
    distro: str,
) -> JoinedWorkspace:
    """Read launch files, packages and sources, and find what each started node is. Raise ForeignFileError."""
    account = ImportAccount()
    for path in files:
        if not path.is_dir():
            words = "it is no folder"
            raise ForeignFileError(words, Span.of_file(str(path)), _FOLDER_HELP)
    workspace = WorkspaceFiles(files, account)
    if not workspace.packages:
        words = "there is no package.xml in it"
        raise ForeignFileError(words, Span.of_file(str(files[0])), _FOLDER_HELP)
    is_without_launch = tuple(launch_files) == (_NO_LAUNCH,)
    if is_without_launch:
        launched = _start_programs(workspace, files)
    else:
        entries = [_find_entry(workspace, files, text) for text in launch_files]
        launched = run_launch_files([*entries, *files] if entries else files, arguments, environment)
        launched = launched if entries else _choose_entry(launched)
    nodes = launched.choose_nodes()
    is_ros_1 = all(package.manifest.is_ros_1 for package in workspace.packages.values())
    known_distro = distro or ("noetic" if is_ros_1 else _ASSUMED_DISTRO)
    reader = ProgramReader(workspace, account, launched.run)
    starters = _list_starters(launched)
    knowledge = tuple(
        _read_knowledge(node, reader, launched.run, known_distro, starters[_identify(node)]) for node in nodes
    )
    for controller, manager, loader in list_controllers(nodes, launched.run):
        library_type = find_controller_type(controller, known_distro)
        program = None if library_type else reader.read_node(controller)
        keep_own_remaps(controller, library_type, known_distro)
        controller.plugin = ""
        started_by = starters[_identify(loader)]
        knowledge += (NodeKnowledge(controller, program, library_type, started_by, manager.known_name),)
    if is_without_launch:
        # Programs that are no nodes.
        knowledge = tuple(each for each in knowledge if each.program or each.library_type)
    reader.tell_unread()
    return JoinedWorkspace(
        workspace, launched, knowledge, account, known_distro, is_distro_known=bool(distro) or is_ros_1
    )


def _start_programs(workspace: WorkspaceFiles, folders: Sequence[Path]) -> LaunchedFiles:
    """Return each program of a workspace as if something started it once, without a name, remaps and parameters."""
    nodes = [
        LaunchedNode("node", "program", Span.of_file(package.manifest_name), "", package=name, executable=program)
        for name, package in workspace.packages.items()
        for program in package.programs
    ]
    run = LaunchRun(LaunchFiles(folders), load_noted)
    return LaunchedFiles(run, {folders[0].resolve(): (nodes, Counter())})


def _identify(node: LaunchedNode) -> tuple[str, ...]:
    """Return what a node is known by in several launch files: its name, else its program."""
    name = node.known_name
    return (name,) if name else (node.namespace, node.package, node.executable, node.plugin, *node.command)


def _list_starters(launched: LaunchedFiles) -> dict[tuple[str, ...], tuple[str, ...]]:
    """Return by what nodes are known by which launch files start them, nothing for what all start."""
    starters: dict[tuple[str, ...], dict[str, None]] = defaultdict(dict)
    for path, (nodes, _) in launched.by_file.items():
        for node in nodes:
            starters[_identify(node)][launched.run.files.show_path(path)] = None
    count = len(launched.by_file)
    return {key: () if len(files) == count else tuple(files) for key, files in starters.items()}


def _read_knowledge(
    node: LaunchedNode, reader: ProgramReader, run: LaunchRun, distro: str, launch_files: tuple[str, ...]
) -> NodeKnowledge:
    program = reader.read_node(node) if node.form in {"node", "loaded"} and (node.executable or node.plugin) else None
    library_type = "" if program is not None else _find_library_type(node, distro)
    program = program or read_gazebo_program(node, library_type, run) or read_rviz(node, run)
    library_type = "" if program is not None else library_type
    return NodeKnowledge(node, program, library_type, launch_files)


def _find_library_type(node: LaunchedNode, distro: str) -> str:
    """Return the type of the library that ships which a node runs: known by its package and its plug-in or executable."""
    return next(iter(index_shipped_programs(distro).get((node.package, node.plugin or node.executable), ())), "")


def _find_entry(workspace: WorkspaceFiles, folders: Sequence[Path], text: str) -> Path:
    """Return the launch file that `PACKAGE/FILE`, or a path below the workspace, means. Raise ForeignFileError."""
    package_name, _, name = text.partition("/")
    package = workspace.packages.get(package_name)
    if package is not None and name:
        fitting = [path for path in package.files if path.as_posix().endswith(f"/{name}")]
        if fitting:
            return min(fitting, key=lambda path: (len(path.parts), path.as_posix()))
    for path in (Path(text), *(folder / text for folder in folders)):
        if path.is_file() and path.resolve() in workspace.shown:
            return path
    launch_files = _list_launch_names(workspace)
    words = "there is no such launch file in the workspace"
    raise ForeignFileError(words, Span.of_file(text), f"there are {', '.join(launch_files[:_MAX_SHOWN]) or 'none'}")


def _list_launch_names(workspace: WorkspaceFiles) -> list[str]:
    names = []
    for package in workspace.packages.values():
        names += [f"{package.manifest.name}/{path.name}" for path in package.files if path.parent.name == "launch"]
    return names


def _choose_entry(launched: LaunchedFiles) -> LaunchedFiles:
    """Return the launch file that no other one includes. Raise ForeignFileError where there are several: they are other robots."""
    started = {path: each for path, each in launched.by_file.items() if each[0]}
    if len(started) == 1:
        return LaunchedFiles(launched.run, started)
    if not started:
        words = "its launch files start no node"
        raise ForeignFileError(words, Span.of_file("."), "name the one that starts the robot: `--launch PACKAGE/FILE`")
    files = launched.run.files

    def rank(path: Path) -> tuple[bool, int, str]:
        shown = files.show_path(path)
        return (not any(word in shown for word in _GENERATED_NAMES), -len(started[path][0]), shown)

    ranked = sorted(started, key=rank)
    counts = {path: len(started[path][0]) for path in ranked}
    lines = [f"{files.show_path(path)} ({number} node{'s' * (number > 1)})" for path, number in counts.items()]
    more = f" and {len(lines) - _MAX_SHOWN} more" if len(lines) > _MAX_SHOWN else ""
    words = f"{len(lines)} launch files start nodes, and none of them includes the others"
    raise ForeignFileError(
        words, Span.of_file("."), f"say which by `--launch`, likeliest first: {', '.join(lines[:_MAX_SHOWN])}{more}"
    )
