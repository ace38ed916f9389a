"""`archgen import workspace`: one architecture of a workspace's launch files, packages, sources and the library that ships.

The messages, services and actions that the nodes of a workspace use, from the interface files in it.

What RViz shows and what programs of Gazebo say: their configurations and arguments name the topics, as sources do of others.
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

from archgen.plugin import dataclass
from archgen.plugin.importing import (
    DesignedStart,
    ForeignFileError,
    ForeignImport,
    MappingNode,
    ObservationOptions,
    ScalarNode,
    SequenceNode,
    Span,
    index_shipped_programs,
    make_id,
    make_unique_id,
    parse_yaml,
    read_bounded,
    title_from_id,
)
from archgen.plugin.ros import is_ros_1
from archgen.plugins.ros.launch.launch_entities import LaunchedNode
from archgen.plugins.ros.launch.launch_files import LaunchFiles
from archgen.plugins.ros.launch.launch_import import LaunchedFiles, SliceMaker, find_stem, load_noted, run_launch_files
from archgen.plugins.ros.launch.launch_run import LaunchRun
from archgen.plugins.ros.ros_package.import_account import ImportAccount
from archgen.plugins.ros.ros_package.package_import import make_type_name, read_message_definition
from archgen.plugins.ros.sources.ros_calls import FIXED_ENDPOINTS, IMAGE_TYPES, read_message_name
from archgen.plugins.ros.sources.walk_values import FoundEndpoint, FoundNode
from archgen.plugins.ros.workspace.node_components import NodeKnowledge
from archgen.plugins.ros.workspace.program_reading import (
    ProgramReader,
    ReadProgram,
    find_controller_type,
    keep_own_remaps,
    list_controllers,
)
from archgen.plugins.ros.workspace.program_sources import WorkspaceFiles
from archgen.plugins.ros.workspace.workspace_slices import make_slices

_MAX_BYTES = 1_000_000
_TOPIC = re.compile(r"([^@\s]++)@([\w/]++)([@\[\]])[\w.]++\Z")
_SERVICE = re.compile(r"([^@\s]++)@(\w++/srv/\w++)(?:@|\Z)")
_DIRECTIONS = {"[": "GZ_TO_ROS", "]": "ROS_TO_GZ", "@": "BIDIRECTIONAL"}
_USES = {"GZ_TO_ROS": ("publishes",), "ROS_TO_GZ": ("subscribes",), "BIDIRECTIONAL": ("publishes", "subscribes")}
_IMAGE = "sensor_msgs/msg/Image"
_TEXT = "std_msgs/msg/String"
_LATCHED = {"depth": 1, "durability": "transient_local"}


def read_gazebo_program(node: LaunchedNode, library_type: str, run: LaunchRun) -> ReadProgram | None:
    """Return what a bridge or the spawner of Gazebo says to ROS; None for other programs, or where nothing names a topic."""
    found: list[FoundEndpoint] = []
    # ROS takes out what is meant for itself.
    arguments = (
        node.arguments[: node.arguments.index("--ros-args")] if "--ros-args" in node.arguments else node.arguments
    )
    if library_type == "gz_bridge":
        found = [each for word in arguments for each in _read_bridge(word, node.span)]
        file = node.parameters.get("config_file")
        path = run.files.find_file(file) if isinstance(file, str) else None
        found += [] if path is None else _read_bridge_file(path, run.files.show_path(path))
    elif library_type == "gz_image_bridge":
        found = [FoundEndpoint("publishes", "topic", word, _IMAGE, node.span) for word in arguments]
    elif library_type == "gz_spawner":
        given = node.parameters.get("topic")
        flags = [text for flag, text in pairwise(arguments) if flag in {"-topic", "--topic"}]
        names = [given] if isinstance(given, str) and given else flags[:1]
        found = [FoundEndpoint("subscribes", "topic", name, _TEXT, node.span, dict(_LATCHED)) for name in names]
    if not found:
        return None
    return ReadProgram((FoundNode(node.span, node.program_name or None, None, found),), is_ros_1=False)


def _read_bridge(word: str, span: Span) -> Iterator[FoundEndpoint]:
    """Yield what one argument of the bridge stands for: `/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan`."""
    if service := _SERVICE.match(word):
        yield FoundEndpoint("serves", "service", service[1], service[2], span)
    elif topic := _TOPIC.match(word):
        message = read_message_name(topic[2].replace("/", "."), "topic")
        for use in _USES[_DIRECTIONS[topic[3]]]:
            yield FoundEndpoint(use, "topic", topic[1], message, span)


def _read_bridge_file(path: Path, shown: str) -> Iterator[FoundEndpoint]:
    """Yield what a file of the bridge lists; a file that cannot be read lists nothing."""
    try:
        text = read_bounded(path, _MAX_BYTES).decode("utf-8", "replace").removeprefix("\ufeff")
    except ForeignFileError:
        return
    # The file is a list; what archgen parses has keys.
    document, _ = parse_yaml(shown, "list:\n" + re.sub(r"^---[ \t]*+$", "", text, count=1, flags=re.MULTILINE))
    listed = document.root.entries.get("list") if document is not None else None
    for item in listed.value.items if listed is not None and isinstance(listed.value, SequenceNode) else ():
        if isinstance(item, MappingNode):
            said = {entry.key: entry.value.text for entry in item if isinstance(entry.value, ScalarNode)}
            span = Span(shown, item.span.line - 1, item.span.column, item.span.end_line - 1, item.span.end_column)
            yield from _read_entry(said, span)


def _read_entry(said: dict[str, str], span: Span) -> Iterator[FoundEndpoint]:
    message = said.get("ros_type_name", "")
    if said.get("service_name"):
        yield FoundEndpoint("serves", "service", said["service_name"], message, span)
        return
    name = said.get("ros_topic_name") or said.get("topic_name") or said.get("gz_topic_name")
    for use in _USES.get(said.get("direction", "BIDIRECTIONAL"), ()) if name else ():
        yield FoundEndpoint(use, "topic", name, message, span)


_RVIZ_PACKAGES = frozenset({"rviz", "rviz2"})
_RVIZ_FILE_OPTIONS = frozenset({"-d", "--display-config"})
_MAX_DISPLAY_DEPTH = 20
_DISPLAY_MESSAGES = {
    **{name: f"sensor_msgs/msg/{name}" for name in ("FluidPressure", "Illuminance", "Image", "Imu", "LaserScan")},
    **{name: f"sensor_msgs/msg/{name}" for name in ("PointCloud", "PointCloud2", "Range", "RelativeHumidity")},
    **{name: f"geometry_msgs/msg/{name}" for name in ("AccelStamped", "PointStamped", "PoseArray", "TwistStamped")},
    **{name: f"geometry_msgs/msg/{name}Stamped" for name in ("Polygon", "Pose", "PoseWithCovariance", "Wrench")},
    **{name: f"nav_msgs/msg/{name}" for name in ("GridCells", "Odometry", "Path")},
    **{name: f"visualization_msgs/msg/{name}" for name in ("Marker", "MarkerArray")},
    "Camera": IMAGE_TYPES[0],
    "Effort": "sensor_msgs/msg/JointState",
    "Map": "nav_msgs/msg/OccupancyGrid",
    "RobotModel": "std_msgs/msg/String",
    "Temperature": "sensor_msgs/msg/Temperature",
    "WrenchStamped": "geometry_msgs/msg/WrenchStamped",
}
_TOOL_MESSAGES = {
    "PublishPoint": "geometry_msgs/msg/PointStamped",
    "SetGoal": "geometry_msgs/msg/PoseStamped",
    "SetInitialPose": "geometry_msgs/msg/PoseWithCovarianceStamped",
}
_DISPLAY_TOPIC_KEYS = ("Topic", "Image Topic", "Marker Topic", "Description Topic")


def read_rviz(node: LaunchedNode, run: LaunchRun) -> ReadProgram | None:
    """Return what RViz reads and sends by its configuration; None for other programs, or where that is not at hand."""
    files = [text for flag, text in pairwise(node.arguments) if flag in _RVIZ_FILE_OPTIONS]
    path = run.files.find_file(files[0]) if files and node.package in _RVIZ_PACKAGES else None
    said = None if path is None else run.parameter_reader.read_mapping(path)
    manager = said.get("Visualization Manager") if said is not None else None
    if not isinstance(manager, Mapping):
        return None
    found = [
        FoundEndpoint(use, "topic", name, message, node.span)
        for use, name, message in (*_read_displays(manager, 0), *_read_tools(manager))
    ]
    unique = {(each.use, each.name): each for each in found}
    known_node = FoundNode(node.span, node.program_name or None, None, [*unique.values()])
    return ReadProgram((known_node,), is_ros_1=node.package == "rviz")


def _list_enabled(holder: Mapping[str, Any], key: str) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield displays or tools, each with the last word of its class; what is switched off does nothing."""
    members = holder.get(key)
    for member in members if isinstance(members, list) else ():
        if isinstance(member, Mapping) and member.get("Enabled", True) is True:
            yield str(member.get("Class", "")).rpartition("/")[2], member


def _read_topic(member: Mapping[str, Any]) -> str:
    for key in _DISPLAY_TOPIC_KEYS:
        given = member.get(key)
        name = given.get("Value") if isinstance(given, Mapping) else given
        if isinstance(name, str) and name:
            return name
    return ""


def _read_displays(holder: Mapping[str, Any], depth: int) -> Iterator[tuple[str, str, str]]:
    for kind, display in _list_enabled(holder, "Displays"):
        if kind == "Group" and depth < _MAX_DISPLAY_DEPTH:
            yield from _read_displays(display, depth + 1)
        elif kind == "TF":
            yield from FIXED_ENDPOINTS["TransformListener"]
        elif (name := _read_topic(display)) and (kind != "RobotModel" or display.get("Description Source") == "Topic"):
            message = _DISPLAY_MESSAGES.get(kind, "")
            yield "subscribes", name, "sensor_msgs/msg/CompressedImage" if name.endswith("/compressed") else message
            if kind == "Camera":
                folder, joint, _ = name.rpartition("/")
                yield "subscribes", f"{folder}{joint}camera_info", IMAGE_TYPES[1]
            elif kind == "Map":
                updates = _read_topic({"Topic": display.get("Update Topic")}) or f"{name}_updates"
                yield "subscribes", updates, "map_msgs/msg/OccupancyGridUpdate"


def _read_tools(manager: Mapping[str, Any]) -> Iterator[tuple[str, str, str]]:
    for kind, tool in _list_enabled(manager, "Tools"):
        if kind in _TOOL_MESSAGES and (name := _read_topic(tool)):
            yield "publishes", name, _TOOL_MESSAGES[kind]


_MAX_MESSAGE_BYTES = 1_000_000
_FIELD_TYPE = re.compile(r"(?:([a-z][a-z0-9_]*)/)?(?:msg/)?([A-Z]\w*)")


def read_used_messages(
    workspace: WorkspaceFiles, knowledge: Sequence[NodeKnowledge], account: ImportAccount, distro: str
) -> dict[str, Any]:
    """Return the types of the messages that are used, and of those in their fields; what archgen knows of ROS is left out."""
    pending = [
        endpoint.message
        for each in knowledge
        for node in (each.program.nodes if each.program is not None else ())
        for endpoint in node.endpoints
    ]
    found: dict[str, Any] = {}
    seen: set[str] = set()
    while pending:
        message = pending.pop(0)
        package = workspace.packages.get(message.partition("/")[0])
        if message in seen or package is None:
            continue
        seen.add(message)
        path = package.manifest.folder / f"{message.partition('/')[2]}.{message.split('/')[1]}"
        shown = workspace.shown.get(path)
        data = {} if shown is None else _read_message(path, shown, message, account, distro)
        if len(data) > 1:
            found[make_unique_id(make_type_name(message), found.keys())] = data
            pending += _list_inner(data, package.manifest.name)
    return found


def _read_message(path: Path, shown: str, message: str, account: ImportAccount, distro: str) -> dict[str, Any]:
    try:
        text = read_bounded(path, _MAX_MESSAGE_BYTES).decode("utf-8-sig", "replace")
    except ForeignFileError as error:
        account.add_note("file", error.message, Span.of_file(shown))
        return {}
    data, problems = read_message_definition(text, message, shown, is_ros_1=is_ros_1(distro), distro=distro)
    for problem in problems:
        account.add_note("message", problem.message, problem.span, problem.help or "")
    account.count("message")
    return data


def _list_inner(data: Any, package: str) -> Iterator[str]:  # noqa: ANN401 - data of YAML
    """Yield the messages in the fields of one."""
    for key, value in data.items() if isinstance(data, dict) else ():
        if isinstance(value, dict):
            yield from _list_inner(value, package)
        elif isinstance(value, str) and key not in {"message", "comment"} and (match := _FIELD_TYPE.match(value)):
            yield f"{match[1] or package}/msg/{match[2]}"


_MAX_SHOWN = 12
_FOLDER_HELP = "give the folder in which the packages lie, `src` as a rule"
_ASSUMED_DISTRO = "jazzy"
_NO_LAUNCH = "none"
_GENERATED_NAMES = frozenset({"bringup", "robot"})


@dataclass(frozen=True, slots=True)
class JoinedWorkspace:
    """A workspace with the nodes that its launch files start, and what is known of each."""

    files: WorkspaceFiles
    launched: LaunchedFiles
    knowledge: tuple[NodeKnowledge, ...]
    account: ImportAccount
    distro: str
    is_distro_known: bool
    is_without_launch: bool = False


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
    options = ObservationOptions(arguments or {}, environment or {}, tuple(launch_files), distro)
    workspace = join_workspace(files, options)
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


def join_workspace(files: Sequence[Path], options: ObservationOptions) -> JoinedWorkspace:
    """Read launch files, packages and sources, and find what each started node is. Raise ForeignFileError."""
    launch_files, distro = options.launch_files, options.distro
    account = ImportAccount()
    for path in files:
        if not path.is_dir():
            raise ForeignFileError("it is no folder", Span.of_file(str(path)), _FOLDER_HELP)
    workspace = WorkspaceFiles(files, account)
    if not workspace.packages:
        raise ForeignFileError("there is no package.xml in it", Span.of_file(str(files[0])), _FOLDER_HELP)
    is_without_launch = tuple(launch_files) == (_NO_LAUNCH,)
    if is_without_launch:
        launched = _start_programs(workspace, files, options.starts)
    elif not launch_files and not LaunchFiles(files).list_launch_files():
        help_line = f"with `--launch {_NO_LAUNCH}` each program is taken as if something started it once"
        raise ForeignFileError("there is no launch file in it", Span.of_file(str(files[0])), help_line)
    else:
        entries = [_find_entry(workspace, files, text) for text in launch_files]
        launched = run_launch_files([*entries, *files] if entries else files, options.arguments, options.environment)
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
    is_distro_known = bool(distro) or is_ros_1
    return JoinedWorkspace(workspace, launched, knowledge, account, known_distro, is_distro_known, is_without_launch)


def _start_programs(
    workspace: WorkspaceFiles, folders: Sequence[Path], designed_starts: Sequence[DesignedStart]
) -> LaunchedFiles:
    """Return each program of a workspace as the design starts it, else as if something started it once, without a name, remaps and
    parameters.
    """
    nodes = []
    for name, package in workspace.packages.items():
        place = Span.of_file(package.manifest_name)
        starts = [start for start in designed_starts if start.package == name]
        nodes += [
            LaunchedNode(
                *("loaded" if start.plugin else "node", "program", place, ""),
                **start._asdict() | {"remaps": dict(start.remaps), "parameters": dict(start.parameters)},
            )
            for start in starts
            if start.plugin or start.executable in package.programs
        ]
        known_programs = {start.executable for start in starts}
        nodes += [
            LaunchedNode("node", "program", place, "", package=name, executable=program)
            for program in package.programs
            if program not in known_programs
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
        return (_GENERATED_NAMES.isdisjoint(re.split(r"[^a-z0-9]", shown.lower())), -len(started[path][0]), shown)

    ranked = sorted(started, key=rank)
    counts = {path: len(started[path][0]) for path in ranked}
    lines = [f"{files.show_path(path)} ({number} node{'s' * (number > 1)})" for path, number in counts.items()]
    more = f" and {len(lines) - _MAX_SHOWN} more" if len(lines) > _MAX_SHOWN else ""
    words = f"{len(lines)} launch files start nodes, and none of them includes the others"
    raise ForeignFileError(
        words, Span.of_file("."), f"say which by `--launch`, likeliest first: {', '.join(lines[:_MAX_SHOWN])}{more}"
    )
