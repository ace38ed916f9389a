"""One step of a start-up as a launch file says it: a node, a container, what a container loads, or another program.

The parameters that launch files give to a node: files that are written beside them, and files of other packages.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from archgen.plugin.findings import Diagnostic, Span, join_words
from archgen.plugin.generating import ProgramNames, make_ros_name, tell_left_out, write_place
from archgen.plugin.model import Architecture, Node, canonical_name, find_declarations
from archgen.plugin.ros import shared_topic_names
from archgen.plugin.starting import (
    SUBSTITUTION,
    RosLaunch,
    StartStep,
    describe_lifecycle,
    describe_ready,
    describe_unknown,
    format_seconds,
    has_substitution,
)

_MANAGER_PACKAGE = "nav2_lifecycle_manager"
_NO_PARAMETERS: Mapping[str, Any] = {"files": [], "written": [], "filled": []}


def record_container_entry(
    architecture: Architecture, step: StartStep, ros: int
) -> tuple[dict[str, Any], list[Diagnostic]]:
    """Return the entry of a container, and what is left out of it."""
    container = architecture.containers[step.container or ""]
    entry = _record_entry(step, step.container or "", write_place(container.at))
    if step.ros is None:
        return entry, []
    parameters, findings = record_container_parameters(step.ros, step.file_name, ros, container.at)
    is_manager = ros == 1 and container.package is None
    return {
        **entry,
        **parameters,
        "form": "container",
        "package": step.ros.package,
        "executable": step.ros.executable,
        "arguments": ["manager"] if is_manager else [],
    }, findings


def record_node_entry(
    architecture: Architecture, step: StartStep, program_names: ProgramNames, managed: Sequence[StartStep], ros: int
) -> tuple[dict[str, Any], list[Diagnostic]]:
    """Return the entry of a node or of another program, and what is left out of it.

    `managed` are the lifecycle nodes that it brings into their states, in their order.
    """
    node = architecture.nodes[step.id]
    entry = _record_entry(step, node.id, write_place(node.at))
    if step.ros is None:
        words = [*step.command, *node.arguments] if step.command else []
        form = "program" if words else "nobody"
        return {**entry, "form": form, "words": words, "remarks": _list_remarks(step, form)}, []
    program = _find_program(program_names, node, step, ros)
    if program["form"] in {"program", "nobody"}:
        return {**entry, **program, "remarks": _list_remarks(step, str(program["form"]))}, []
    shared_topics = shared_topic_names(architecture.shared_topics)
    launch = replace(step.ros, earlier_values={**_fill_manager(node, step.ros, managed), **step.ros.earlier_values})
    parameters, findings = record_node_parameters(architecture, node, launch, step.file_name, ros)
    return {
        **entry,
        **parameters,
        **program,
        "arguments": [*program["arguments"], *node.arguments],
        "remaps": [
            {"own_name": own_name, "name": name, "is_prefixed": name.startswith("/") and name not in shared_topics}
            for own_name, name in program_names.find_remaps(node).items()
        ],
        "shares_memory": step.ros.shares_memory,
        "simulated_time": read_simulated_time(step.ros),
        "remarks": _list_remarks(step, str(program["form"])),
    }, findings


def _record_entry(step: StartStep, element: str, place: str) -> dict[str, Any]:
    delay = format_seconds(step.respawn_delay) if step.respawn_delay is not None else None
    return {
        "step": step.id,
        "element": element,
        "form": "nobody",
        "title": step.title or element,
        "place": place,
        "phase": step.phase,
        "name": step.ros.name if step.ros else step.file_name,
        "ros_name": make_ros_name(step.file_name),
        "namespace": step.ros.namespace if step.ros else "/",
        "full_name": step.ros.full_name if step.ros else "",
        "container": (step.ros.container or "") if step.ros else "",
        "package": None,
        "executable": None,
        "plugin": None,
        "words": [],
        "arguments": [],
        "remaps": [],
        **_NO_PARAMETERS,
        "shares_memory": False,
        "simulated_time": None,
        "environment": [{"name": name, "value": value} for name, value in step.environment.items()],
        "directory": step.directory,
        "user": step.user,
        "scheduling": _record_scheduling(step),
        "respawn": step.respawn,
        "respawn_delay": delay if delay is None or "." in delay else f"{delay}.0",
        "remarks": _list_remarks(step, "container"),
    }


def _record_scheduling(step: StartStep) -> dict[str, str]:
    """Return the words that give a process its priority and cores, and the name under which a launch file holds them.

    A script stands in front of them, and leaves out what a computer does not allow.
    """
    words = step.scheduling.words
    return {"words": " ".join(words), "name": re.sub(r"[^a-z0-9]+", "_", "_".join(words))}


def _find_program(program_names: ProgramNames, node: Node, step: StartStep, ros: int) -> dict[str, Any]:
    """Return what runs a node of ROS: its own program or that of its generated package, or the container that loads it."""
    program = program_names.find_program(node)
    package, executable, plugin = program.package, program.executable, program.plugin
    record: dict[str, Any] = {"package": package, "executable": executable, "plugin": plugin, "arguments": []}
    if ros == 1:
        return _find_ros_1_program(node, step, record)
    if node.container is not None:
        return {**record, "form": "loaded" if package and plugin else "nobody"}
    if package and executable:
        return {**record, "form": "node"}
    # A plugin without a program of its own: ROS loads it into a process of its own.
    return {**record, "form": "program", "words": list(step.command)} if step.command else {**record, "form": "nobody"}


def _fill_manager(node: Node, launch: RosLaunch, managed: Sequence[StartStep]) -> dict[str, object]:
    """Return what the usual lifecycle manager is told where nobody says otherwise: its list copies the architecture."""
    names = [
        each.ros.name if each.ros.namespace == launch.namespace else each.ros.full_name for each in managed if each.ros
    ]
    return {"autostart": True, "node_names": names} if names and node.package == _MANAGER_PACKAGE else {}


def _find_ros_1_program(node: Node, step: StartStep, record: dict[str, Any]) -> dict[str, Any]:
    plugin = record["plugin"]
    if "nodelet" in node.kinds and plugin:
        container = step.ros.container if step.ros else None
        words = ["load", plugin, container] if container else ["standalone", plugin]
        return {**record, "form": "node", "package": "nodelet", "executable": "nodelet", "arguments": words}
    return {**record, "form": "node" if record["package"] and record["executable"] else "nobody"}


def _list_remarks(step: StartStep, form: str) -> list[str]:
    """Return what stands in the plan and launch cannot do, a line each."""
    remarks = []
    if form == "nobody":
        remarks.append("not started here: " + describe_unknown(step))
    if step.awaited:
        remarks.append(f"after {join_words([each.awaited for each in step.awaited])}")
    up_when = describe_ready(step)
    if up_when:
        remarks.append(f"up when {up_when}")
    state = describe_lifecycle(step)
    if state:
        remarks.append(f"brought into the state {state}")
    remarks += [f"needs rights {each}" for each in step.needs_rights]
    return remarks


_PACKAGE_PATH = re.compile(
    r"(?:\$\((?:find|find-pkg-share)\s+(?P<found>[A-Za-z0-9_]+)\)|package://(?P<named>[A-Za-z0-9_]+))/+(?P<path>.+)",
    re.DOTALL,
)
"""A file of a package, as launch files and URLs of ROS write it."""
_PACKAGE_NAME = re.compile(r"[A-Za-z0-9_-]+")
_HOME = "~/"
_GLOBAL_IN_ROS_1 = "use_sim_time"
"""In ROS 1 it is one parameter of all nodes."""


def record_node_parameters(
    architecture: Architecture, node: Node, launch: RosLaunch, file_name: str, ros: int
) -> tuple[dict[str, Any], list[Diagnostic]]:
    """Return the parameters of a node, and what is left out.

    `files` are those to load, of which the last one wins, `written` those to write, `filled` the values that only the
    launch file can fill in: by the output of a command, or by a substitution.
    """
    elsewhere = [_find_file(path, node) for path in launch.parameter_files if path in node.unread_files]
    read_values = {**launch.file_values, **launch.own_values}
    parts: list[tuple[str, Mapping[str, object]]] = [("", {**launch.earlier_values, **read_values})]
    if elsewhere:
        # What nobody could read counts more than defaults, and less than what the node says.
        parts = [("_defaults", launch.earlier_values), ("", read_values)]
    all_values = {**launch.earlier_values, **read_values}
    filled_names = {name for name, value in all_values.items() if has_substitution(value)} | set(launch.value_commands)
    parts = [
        (suffix, {name: value for name, value in values.items() if name not in filled_names})
        for suffix, values in parts
    ]
    # A file of others says the whole name, which counts more than one in any namespace; who loads a node reads no other pattern.
    reader = launch.full_name if elsewhere else "/**" if launch.container else None
    written, unfit_names = _write_parts(parts, launch, file_name, ros, reader)
    own_files = [_place_file("own", str(each["path"])) for each in written]
    count = 1 if elsewhere and written and written[0]["name"] != file_name else 0
    return {
        "files": [*own_files[:count], *elsewhere, *own_files[count:]],
        "written": written,
        "filled": _record_filled(architecture, node, launch, all_values, ros),
    }, [_tell_unfit(name, node.at, node.id) for name in unfit_names]


def record_container_parameters(
    launch: RosLaunch, file_name: str, ros: int, span: Span
) -> tuple[dict[str, Any], list[Diagnostic]]:
    """Return the same for a container."""
    written, unfit_names = _write_parts([("", launch.own_values)], launch, file_name, ros)
    parameters = {
        "files": [_place_file("own", str(each["path"])) for each in written],
        "written": written,
        "filled": [],
    }
    return parameters, [_tell_unfit(name, span, file_name) for name in unfit_names]


def read_simulated_time(launch: RosLaunch) -> object:
    """Return what a node of ROS 1 says of `use_sim_time`; None where it says nothing."""
    values = {**launch.earlier_values, **launch.file_values, **launch.own_values}
    return values.get(_GLOBAL_IN_ROS_1)


def _write_parts(
    parts: list[tuple[str, Mapping[str, object]]],
    launch: RosLaunch,
    file_name: str,
    ros: int,
    reader: str | None = None,
) -> tuple[list[dict[str, Any]], list[str]]:
    """Return the files to write, each with its lines and whom they are for, and the names of what they cannot hold.

    Each is loaded for its node alone, which may be in the namespace of a second robot.
    """
    node = launch.full_name if ros == 1 else reader or f"/**/{launch.name}"
    written: list[dict[str, Any]] = []
    unfit_names: list[str] = []
    for suffix, values in parts:
        given = {name: value for name, value in values.items() if ros != 1 or name != _GLOBAL_IN_ROS_1}
        if ros != 1:
            unfit_names += [name for name, value in given.items() if not _fits_ros_2(value)]
        fitting = {name: value for name, value in given.items() if name not in unfit_names}
        lines = _list_tree(_make_tree(fitting) if ros == 1 else fitting, 0)
        if lines:
            name = f"{file_name}{suffix}"
            written.append({"name": name, "path": f"config/{name}.yaml", "node": node, "lines": lines})
    return written, unfit_names


def _tell_unfit(name: str, span: Span, element: str) -> Diagnostic:
    return tell_left_out(
        f"the parameter `{name}` of `{element}` is left out: no parameter of ROS can be what it is",
        span,
        element=element,
        help_line="ROS has booleans, whole numbers, numbers, texts, and lists of one of these",
    )


def _fits_ros_2(value: object) -> bool:
    """Whether a parameter of ROS 2 can have a value: one of its plain types, or a list of one of them."""
    if isinstance(value, list | tuple):
        kinds = {type(item) for item in value}
        return len(kinds) <= 1 and kinds <= {bool, int, float, str}
    return isinstance(value, bool | int | float | str)


def _make_tree(values: Mapping[str, object]) -> dict[str, Any]:
    """Return values by the parts of their names, as the parameter server holds them. Of `a` and `a.b` the later one stays."""
    tree: dict[str, Any] = {}
    for name, value in values.items():
        *folders, leaf = [part for part in name.replace(".", "/").split("/") if part] or [name]
        place = tree
        for folder in folders:
            inner = place.get(folder)
            if not isinstance(inner, dict):
                inner = place[folder] = {}
            place = inner
        place[leaf] = value
    return tree


def _list_tree(tree: Mapping[str, Any], depth: int) -> list[dict[str, Any]]:
    """Return a tree line by line, each with how deep it stands."""
    lines: list[dict[str, Any]] = []
    for name, value in tree.items():
        if isinstance(value, Mapping) and value:
            lines.append({"depth": depth, "name": str(name), "value": None, "has_value": False})
            lines += _list_tree(value, depth + 1)
        else:
            lines.append({"depth": depth, "name": str(name), "value": value, "has_value": True})
    return lines


def _place_file(place: str, path: str, package: str = "") -> dict[str, str]:
    """Return a file to load. `place` is `own`, `package`, `home` or `robot`."""
    return {"place": place, "package": package, "path": path}


def _find_file(path: str, node: Node) -> dict[str, str]:
    """Return where a file that no project holds lies: in a package, in the user's home, or somewhere on the robot."""
    found = _PACKAGE_PATH.match(path)
    if found:
        return _place_file("package", found["path"], found["found"] or found["named"])
    if path.startswith(_HOME):
        return _place_file("home", path.removeprefix(_HOME))
    if path.startswith("/"):
        return _place_file("robot", path)
    if node.package and _PACKAGE_NAME.fullmatch(node.package):
        return _place_file("package", path, node.package)
    return _place_file("own", path)


def _record_filled(
    architecture: Architecture, node: Node, launch: RosLaunch, values: Mapping[str, object], ros: int
) -> list[dict[str, Any]]:
    """Return the parameters that the launch file fills in: texts, unless they are declared as something else."""
    ros_1 = ros == 1
    declarations = {
        canonical_name(name, ros_1=ros_1): each for name, each in find_declarations(architecture, node).items()
    }
    filled: list[dict[str, Any]] = [
        {"name": name, "words": list(words), "parts": []} for name, words in launch.value_commands.items()
    ]
    filled += [
        {"name": name, "words": [], "parts": _split_substitutions(str(value))}
        for name, value in values.items()
        if name not in launch.value_commands and has_substitution(value)
    ]
    for each in filled:
        declared_type = declarations[each["name"]].type if each["name"] in declarations else None
        each["is_text"] = declared_type in {None, "string"} and each["name"] not in launch.untyped_names
        each["name"] = each["name"].replace(".", "/") if ros_1 else each["name"]
    return filled


def _split_substitutions(text: str) -> list[dict[str, str]]:
    """Return the pieces of a text: `text`, the folder of a `package`, the value of a `variable` of the environment."""
    pieces: list[dict[str, str]] = []
    end = 0
    for found in SUBSTITUTION.finditer(text):
        if found.start() > end:
            pieces.append(_make_piece(text=text[end : found.start()]))
        pieces.append(_make_piece(package=found["package"] or "", variable=found["variable"] or ""))
        end = found.end()
    return [*pieces, _make_piece(text=text[end:])] if end < len(text) else pieces


def _make_piece(text: str = "", package: str = "", variable: str = "") -> dict[str, str]:
    return {"text": text, "package": package, "variable": variable}
