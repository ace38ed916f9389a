"""One step of a start-up as a launch file says it: a node, a container, what a container loads, or another program."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from archgen.plugin.findings import Diagnostic, join_words
from archgen.plugin.generating import ProgramNames, make_ros_name, write_place
from archgen.plugin.model import Architecture, Node
from archgen.plugin.starting import (
    RosLaunch,
    StartStep,
    describe_lifecycle,
    describe_ready,
    describe_unknown,
    format_seconds,
)
from archgen.plugins.ros_code.launch_parameters import (
    read_simulated_time,
    record_container_parameters,
    record_node_parameters,
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
    launch = replace(step.ros, earlier_values={**_fill_manager(node, step.ros, managed), **step.ros.earlier_values})
    parameters, findings = record_node_parameters(architecture, node, launch, step.file_name, ros)
    return {
        **entry,
        **parameters,
        **program,
        "arguments": [*program["arguments"], *node.arguments],
        "remaps": [{"own_name": own_name, "name": name} for own_name, name in program_names.find_remaps(node).items()],
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
        "simulated_time": None,
        "environment": [{"name": name, "value": value} for name, value in step.environment.items()],
        "directory": step.directory,
        "user": step.user,
        "respawn": step.respawn,
        "respawn_delay": delay if delay is None or "." in delay else f"{delay}.0",
        "remarks": _list_remarks(step, "container"),
    }


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
