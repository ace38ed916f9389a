"""`archgen import ros2` and `archgen import ros1`: the nodes of a running robot, from what command-line tools print.

A running graph as slices: component types with ports, and the nodes with what they publish, read, serve and call.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from archgen.plugin.importing import ForeignFileError, ForeignImport, Span, make_id, make_unique_id, title_from_id
from archgen.plugin.ros import find_name_fault, find_node_name_fault, is_common_callback
from archgen.plugins.ros.ros_package.package_import import make_type_name
from archgen.plugins.ros.running_graph.dump_lines import USES, DumpLine, RunningGraph, RunningNode, read_dump_lines
from archgen.plugins.ros.running_graph.ros_1_dump import read_ros_1_dump
from archgen.plugins.ros.running_graph.ros_2_dump import read_ros_2_dump


def read_ros_2_graph(files: Sequence[Path]) -> ForeignImport:
    """Read dumps of ROS 2. Raise ForeignFileError."""
    return _read_graph(files, read_ros_2_dump, "`ros2 node info NAME` of each node")


def read_ros_1_graph(files: Sequence[Path]) -> ForeignImport:
    """Read dumps of ROS 1. Raise ForeignFileError."""
    return _read_graph(files, read_ros_1_dump, "`rosnode info NAME` of each node")


def _read_graph(
    files: Sequence[Path], read: Callable[[Iterable[DumpLine], RunningGraph], None], wanted_format: str
) -> ForeignImport:
    graph = RunningGraph(is_ros_1=read is read_ros_1_dump)
    read(read_dump_lines(files), graph)
    slices = write_graph(graph)
    if not slices:
        words = "there is no node in it"
        raise ForeignFileError(
            words, Span.of_file(files[0].name if files else "."), f"give what these print: {wanted_format}"
        )
    taken = {word: count for word, count in sorted(graph.taken.items()) if count}
    title = title_from_id(make_id(files[0].stem, "robot"))
    return ForeignImport(slices, taken, tuple(graph.notes), title, graph.distro)


_COMMON_ENDINGS = ("/get_loggers", "/set_logger_level", "/get_type_description", "/transition_event")
_STATE_SERVICE = "/change_state"
_LOADING_SERVICE = "/_container/load_node"
_HIDDEN = ("/_", "/parameter_events", "/rosout", "/rosout_agg")
_NO_NODES = frozenset({"/rosout"})


def write_graph(graph: RunningGraph) -> dict[str, dict[str, Any]]:
    """Return the slices: one of component types, one of nodes; of messages alone one of types."""
    maker = _SliceMaker(graph)
    for node in graph.nodes.values():
        namespace, _, name = node.full_name.rpartition("/")
        fault = find_node_name_fault(name) or (namespace and find_name_fault(namespace, ros_1=graph.is_ros_1))
        if fault:
            graph.add_note("node", f"`{node.full_name}` is no name of ROS: {fault}", node.span)
            graph.taken["node"] -= 1
        elif node.full_name not in _NO_NODES and not name.startswith("_"):
            maker.add_node(node, namespace, name)
    slices = maker.finish()
    if not slices and any(graph.messages.values()):
        types = {make_type_name(message): {"message": message} for message in graph.messages.values() if message}
        return {"recorded_types.yaml": {"types": types}}
    return slices


class _SliceMaker:
    """Collects sections."""

    def __init__(self, graph: RunningGraph) -> None:
        self._graph = graph
        self._nodes: dict[str, Any] = {}
        self._containers: dict[str, Any] = {}
        self._container_ids: dict[str, str] = {}
        self._ports: dict[str, dict[str, Any]] = {}
        self._name_uses = Counter(each.full_name.rpartition("/")[2] for each in graph.nodes.values())
        self._loaded: dict[str, str] = {}

    def add_node(self, node: RunningNode, namespace: str, name: str) -> None:
        """Write one node, whose full name is given in its parts, too."""
        if node.is_container or any(each.endswith(_LOADING_SERVICE) for each in node.uses["serves"]):
            self._add_container(node, namespace, name)
            return
        wanted = make_id(name, "node")
        if self._name_uses[name] > 1 and namespace.strip("/"):
            wanted = make_id(f"{namespace.strip('/').replace('/', '_')}_{name}", "node")
        node_id = make_unique_id(wanted, self._nodes.keys())
        is_lifecycle = any(
            each.endswith(_STATE_SERVICE) and message.startswith("lifecycle_msgs/")
            for each, message in node.uses["serves"].items()
        )
        uses, ports = self._write_uses(node, namespace)
        if node.container:
            self._loaded[node_id] = node.container
        data: dict[str, Any] = {
            "kind": "lifecycle" if is_lifecycle else "",
            "name": "" if name == node_id else name,
            "namespace": namespace,
            "status": "existing",
            "observed": bool(uses),
            **uses,
            "parameters": node.parameters,
        }
        self._nodes[node_id] = {key: value for key, value in data.items() if value not in ("", {}, False)}
        if any(ports.values()):
            self._ports[node_id] = {key: ports[key] for key in ("inputs", "outputs")}

    def _add_container(self, node: RunningNode, namespace: str, name: str) -> None:
        container_id = make_unique_id(make_id(name, "container"), self._containers.keys())
        data = {"name": "" if name == container_id else name, "namespace": namespace, "parameters": node.parameters}
        self._containers[container_id] = {key: value for key, value in data.items() if value not in ("", {})}
        self._container_ids[node.full_name] = container_id

    def _write_uses(self, node: RunningNode, namespace: str) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
        """Return what a node uses, and the ports of a component that it would implement."""
        uses: dict[str, dict[str, Any]] = {}
        ports: dict[str, dict[str, Any]] = {"inputs": {}, "outputs": {}}
        for use in USES:
            side = "outputs" if use in {"publishes", "serves"} else "inputs"
            for name, own_message in node.uses[use].items():
                message = own_message or self._graph.messages.get(name, "")
                if _is_common(use, name):
                    continue
                key = make_unique_id(make_id(_shorten_name(name, node, namespace), "port"), ports[side].keys())
                entry: dict[str, Any] = {"topic" if use in {"publishes", "subscribes"} else "name": name}
                if message:
                    entry["message"] = message
                said = node.qos.get((use, name), {})
                qos = {policy: value for policy, value in said.items() if value not in {None, "automatic"}}
                if qos:
                    entry["qos"] = qos
                uses.setdefault(use, {})[key] = entry
                ports[side][key] = message or None
                if not message:
                    words = f"the type of `{name}` of `{node.full_name}` is not known"
                    self._graph.add_note("type", words, node.span, fate="noted")
        return uses, ports

    def finish(self) -> dict[str, dict[str, Any]]:
        """Return the slices."""
        for node_id, container in self._loaded.items():
            if container in self._container_ids:
                self._nodes[node_id] = {"kind": "composable", **self._nodes[node_id]}
                self._nodes[node_id]["container"] = self._container_ids[container]
        sections = {"containers": self._containers, "nodes": self._nodes}
        slices = {
            "running_types.yaml": {"component_types": self._make_component_types()},
            "running_nodes.yaml": {name: section for name, section in sections.items() if section},
        }
        return {name: parts for name, parts in slices.items() if any(parts.values())}

    def _make_component_types(self) -> dict[str, Any]:
        """Return a type for each node; one for all nodes of a name whose ports are the same, as of two equal sensors."""
        alike: dict[str, list[str]] = {}
        for node_id in self._ports:
            alike.setdefault(self._nodes[node_id].get("name", node_id), []).append(node_id)
        types: dict[str, Any] = {}
        for name, node_ids in alike.items():
            shared_id = make_id(name, "node")
            ports = [self._ports[each] for each in node_ids]
            if ports.count(ports[0]) == len(ports) > 1 and shared_id not in {*self._nodes} - {*node_ids}:
                types[shared_id] = ports[0]
            else:
                types.update((each, self._ports[each]) for each in node_ids)
        return types


def _shorten_name(name: str, node: RunningNode, namespace: str) -> str:
    """Return a name as seen from its node."""
    for outer in (node.full_name, namespace):
        if outer and name.startswith(f"{outer}/"):
            return name[len(outer) + 1 :].replace("/", "_")
    return name.strip("/").replace("/", "_")


def _is_common(use: str, name: str) -> bool:
    """Whether every node has it, without anybody writing it."""
    if any(part.startswith("_") for part in name.split("/")) or name in _HIDDEN or name.endswith(_COMMON_ENDINGS):
        return True
    kind = "subscription" if use in {"publishes", "subscribes"} else "service"
    return name != "/clock" and is_common_callback(kind, name)
