"""What launch files start, as slices of the language: nodes and containers by id, and hosts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from archgen.plugin.importing import make_id, make_unique_id
from archgen.plugin.model import ProcessScheduling
from archgen.plugin.ros import expand_name, find_name_fault, find_node_name_fault
from archgen.plugins.ros.launch.launch_actions import LaunchedNode
from archgen.plugins.ros.launch.launch_run import LaunchRun
from archgen.plugins.ros.launch.launch_values import OPEN

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
                (
                    fault
                    for each in (own_name, name)
                    if (fault := find_name_fault(each) or ("it is only a `/`" if each == "/" else ""))
                ),
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


def _write_scheduling(scheduling: ProcessScheduling) -> dict[str, Any]:
    priority = {} if scheduling.priority is None else {"priority": scheduling.priority}
    cores = list(scheduling.cores)
    return {**priority, **({"core": cores[0]} if len(cores) == 1 else {"cores": cores} if cores else {})}
