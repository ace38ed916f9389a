"""The architecture that a workspace becomes, as slices: a component for each node, wired as its topics are, and the nodes."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Any

from archgen.plugin import dataclass
from archgen.plugin.importing import (
    FlowMapping,
    MappingNode,
    ScalarNode,
    YamlNode,
    link_slices,
    load_shipped_component_types,
    make_id,
    make_unique_id,
)
from archgen.plugin.model import Architecture, Endpoint
from archgen.plugin.ros import find_name_fault, find_node_name_fault
from archgen.plugins.ros.launch.launch_actions import LaunchedNode
from archgen.plugins.ros.launch.launch_slices import SliceMaker, nest_parameters
from archgen.plugins.ros.ros_package.import_account import ImportAccount
from archgen.plugins.ros.sources.walk_values import (
    FoundEndpoint,
    FoundNode,
    ParameterValue,
    find_unknown,
    settle,
    show_value,
)
from archgen.plugins.ros.workspace.program_reading import ReadProgram
from archgen.plugins.ros.workspace.program_sources import WorkspaceFiles

LIBRARY = "ros"
_SHARED = frozenset({"/tf", "/tf_static", "/clock", "/diagnostics", "/rosout", "/parameter_events"})
_POOR_WORDS = frozenset(
    {"pose", "state", "global", "local", "data", "raw", "status", "image", "command", "cmd", "info"}
)
_USUAL_QOS = {"depth": 10}
"""What ROS takes where nothing else is said."""
_HINT = "launch"
_KEPT_HINTS = frozenset({"conditions", "by_default", "other_ways"})
_VERBS = {"topic": "publishes", "service": "serves", "action": "serves"}
_OUT_USES, _IN_USES = ("publishes", "serves"), ("subscribes", "calls")


@dataclass(frozen=True, slots=True)
class NodeKnowledge:
    """A launched node with what is known of it: by its sources, or as a type of the library."""

    node: LaunchedNode
    program: ReadProgram | None
    library_type: str


class WorkspaceSlices:
    """Writes the slices of one workspace."""

    def __init__(
        self,
        maker: SliceMaker,
        knowledge: Sequence[NodeKnowledge],
        workspace: WorkspaceFiles,
        account: ImportAccount,
        distro: str,
    ) -> None:
        self._maker = maker
        self._knowledge = {id(each.node): each for each in knowledge}
        self._workspace = workspace
        self._account = account
        self._distro = distro
        self.uses_library = any(each.library_type for each in knowledge)
        self._groups: dict[str, dict[str, Any]] = {}
        self._nodes: dict[str, dict[str, Any]] = {}
        self._places: dict[str, str] = {}
        """The group of each node."""
        self._comments: dict[tuple[str | int, ...], str] = {}

    def make_slices(
        self, nodes: Sequence[LaunchedNode]
    ) -> tuple[dict[str, Mapping[str, Any]], dict[str, Mapping[tuple[str | int, ...], str]]]:
        """Return the slices, one for each group, and the comments behind their lines."""
        sections = self._maker.make_sections(nodes)
        self._comments |= self._maker.comments
        launched = {node_id: node for node in nodes if (node_id := self._maker.find_node_id(node))}
        group_names = self._choose_groups(launched)
        for node_id, data in sections.get("nodes", {}).items():
            self._nodes[node_id] = data
            self._add_node(node_id, data, self._knowledge[id(launched[node_id])], group_names[node_id])
        self._wire(self._link(sections))
        return self._divide(sections)

    def _choose_groups(self, launched: Mapping[str, LaunchedNode]) -> dict[str, str]:
        """Return the group of each node: by the folder of its package, else by its namespace, else one for all."""
        folders, namespaces = {}, {}
        for node_id, node in launched.items():
            package = self._workspace.packages.get(node.package)
            manifest = (
                next((self._workspace.shown[path] for path in package.files if path.name == "package.xml"), "")
                if package
                else ""
            )
            parts = manifest.split("/")
            folders[node_id] = parts[0] if len(parts) > 2 else ""  # noqa: PLR2004 - folder, package, package.xml
            namespaces[node_id] = node.namespace.strip("/").partition("/")[0]
        for places in (folders, namespaces):
            if len({place for place in places.values() if place}) > 1:
                return {node_id: make_id(place or "others", "group") for node_id, place in places.items()}
        return dict.fromkeys(launched, "robot")

    # Nodes and their components

    def _add_node(self, node_id: str, data: dict[str, Any], known: NodeKnowledge, group: str) -> None:
        hints = data.get("hints", {}).get(_HINT, {})
        kept = {key: value for key, value in hints.items() if key in _KEPT_HINTS}
        data.pop("hints", None)
        if kept:
            data["hints"] = {_HINT: kept}
        self._account.count("node")
        self._places[node_id] = group
        components = self._groups.setdefault(group, {})
        data_before = dict(data)
        data.clear()
        data["implements"] = f"{group}.{node_id}"
        data |= data_before
        self._leave_out_filed(data, known)
        if known.library_type:
            components[node_id] = {"is": f"{LIBRARY}.{known.library_type}"}
            self._account.count("node of the library")
        elif known.program is not None:
            self._name_node(node_id, data, known, known.program.nodes[0])
            components[node_id] = self._write_found(node_id, data, known, known.program)
            self._account.count("node with sources")
        else:
            components[node_id] = {}
            if known.node.form != "program":
                text = "what it says is not known: neither its sources nor a type of the library are at hand"
                self._comments.setdefault(("nodes", node_id), text)
                self._account.count("node without sources")

    def _leave_out_filed(self, data: dict[str, Any], known: NodeKnowledge) -> None:
        """Leave out the parameters that stand in a file that the node reads, but those that name its topics."""
        node = known.node
        kept = list_naming_parameters(known.library_type, self._distro) if known.library_type else []
        for found in known.program.nodes if known.program else ():
            kept += [re.escape(each.name.name) for each in found.endpoints if isinstance(each.name, ParameterValue)]
        naming = re.compile("|".join(kept) or "(?!)")
        if (node.parameter_files and not known.program) or (known.program and not known.program.is_ros_1):
            left_out = {name for name in node.file_parameters if not naming.fullmatch(name)}
            parameters = {name: value for name, value in node.parameters.items() if name not in left_out}
            data.pop("parameters", None)
            if parameters:
                data["parameters"] = nest_parameters(parameters)

    def _name_node(self, node_id: str, data: dict[str, Any], known: NodeKnowledge, found: FoundNode) -> None:
        name = settle(found.name)
        if not known.node.name and isinstance(name, str) and not find_node_name_fault(name):
            data.pop("name", None)
            if name != node_id:
                data["name"] = name
        namespace = settle(found.namespace)
        if (
            not known.node.namespace
            and isinstance(namespace, str)
            and namespace.strip("/")
            and not find_name_fault(namespace)
        ):
            data["namespace"] = f"/{namespace.strip('/')}"
        if found.is_lifecycle:
            data["kind"] = "lifecycle" if "kind" not in data else data["kind"]

    def _write_found(
        self, node_id: str, data: dict[str, Any], known: NodeKnowledge, program: ReadProgram
    ) -> dict[str, Any]:
        ports: dict[str, dict[str, Any]] = {"inputs": FlowMapping(), "outputs": FlowMapping()}
        for number, found in enumerate(program.nodes):
            if number:
                words = f"the program makes another node, `{show_value(found.name)}`, too: what it says is taken as said by the first"
                self._account.add_note("node", words, found.span, fate="noted")
            for endpoint in found.endpoints:
                self._write_endpoint(node_id, data, endpoint, ports, program)
        first = program.nodes[0]
        periods = [period for period in first.periods if period]
        if len(first.periods) == 1 and periods and not ports["inputs"] and not data.get("serves"):
            data["timing"] = {"period": f"{periods[0] * 1000:.6g} ms"}
        return {side: written for side, written in ports.items() if written}

    def _write_endpoint(
        self,
        node_id: str,
        data: dict[str, Any],
        endpoint: FoundEndpoint,
        ports: dict[str, dict[str, Any]],
        program: ReadProgram,
    ) -> None:
        name = settle(endpoint.name)
        if name == "" or name is None:
            return
        text = name if isinstance(name, str) and not find_name_fault(name, ros_1=program.is_ros_1) else ""
        self._account.count("endpoint")
        key = "own_name" if _may_be_moved(text, data) else "topic" if endpoint.flow == "topic" else "name"
        use: dict[str, Any] = {key: text} if text else {}
        if (
            text
            and isinstance(endpoint.name, ParameterValue)
            and endpoint.name.name
            and endpoint.name.value is not endpoint.name.default
        ):
            default = settle(endpoint.name.default)
            use = {"named_by": endpoint.name.name}
            if isinstance(default, str) and default and not find_name_fault(default, ros_1=program.is_ros_1):
                use = {"own_name": default, **use}
        if endpoint.qos not in ({}, _USUAL_QOS) and endpoint.flow == "topic":
            qos = dict(endpoint.qos)
            use["qos"] = qos["profile"] if list(qos) == ["profile"] else qos
        if text in _SHARED and endpoint.flow == "topic":
            internal = data.setdefault("internal", FlowMapping()).setdefault(endpoint.use, FlowMapping())
            message = {"message": endpoint.message} if endpoint.message else {}
            internal[make_id(text, "topic")] = FlowMapping({"topic": text, **message})
            return
        side = "outputs" if endpoint.use in _OUT_USES else "inputs"
        port = self._name_port(text or show_value(endpoint.name).replace("*", "_"), endpoint, ports[side])
        ports[side][port] = (
            endpoint.message or None if side == "outputs" else FlowMapping({"type": endpoint.message or None})
        )
        data.setdefault(endpoint.use, FlowMapping())[port] = (
            use[key] if list(use) == [key] and key != "own_name" else FlowMapping(use)
        )
        path = ("groups", self._places[node_id], "components", node_id, side, port)
        place = f"{endpoint.span.file}:{endpoint.span.line}"
        if not text:
            expression = find_unknown(endpoint.name) or show_value(endpoint.name)
            shown = show_value(endpoint.name)
            pattern = f"`{shown}`, " if shown.strip("*/") else ""
            self._comments[path] = f"name unknown: {pattern}`{expression[:60]}`, {place}"
            words = f"the name of what it {endpoint.use} is computed: {pattern}`{expression}`"
            self._account.add_note("name", words, endpoint.span, fate="noted")
            self._account.count("endpoint without a name")
        elif endpoint.is_conditional:
            self._comments[path] = f"made under a condition, {place}"

    def _name_port(self, name: str, endpoint: FoundEndpoint, taken: Mapping[str, Any]) -> str:
        """Return a port's id: the last word of its topic, two words where one is poor or taken."""
        words = [word for word in name.replace("~", "").split("/") if word.strip("_")]
        short = make_id(words[-1] if words else endpoint.message.rpartition("/")[2] or endpoint.flow, "port")
        if len(words) > 1 and (short in _POOR_WORDS or short in taken):
            short = make_id("_".join(words[-2:]), "port")
        return make_unique_id(short, taken.keys())

    # Wiring

    def _link(self, sections: Mapping[str, Any]) -> Architecture:
        project: dict[str, Any] = {"project": {"id": "workspace"}, "ros": {"distro": self._distro}}
        if self.uses_library:
            project["libraries"] = {LIBRARY: "builtin"}
        groups = {name: {"components": components} for name, components in self._groups.items()}
        return link_slices({**project, **sections, "groups": groups, "nodes": self._nodes})

    def _wire(self, architecture: Architecture) -> None:
        """Connect who reads a name with all that write it; what nobody here writes comes from outside."""
        writers: dict[tuple[str, str], list[str]] = defaultdict(list)
        for endpoint in architecture.endpoints:
            if endpoint.use in _OUT_USES and endpoint.name is not None and endpoint.port is not None:
                writers[endpoint.flow, endpoint.name].append(endpoint.port)
        readers: dict[str, list[Endpoint]] = defaultdict(list)
        for endpoint in architecture.endpoints:
            if endpoint.use in _IN_USES and endpoint.port is not None and not endpoint.internal:
                readers[endpoint.port].append(endpoint)
        for port, endpoints in readers.items():
            group, component, name = port.split(".")
            body = self._groups[group][component]
            names = [endpoint.name for endpoint in endpoints if endpoint.name is not None]
            sources = [
                source for endpoint in endpoints for source in writers.get((endpoint.flow, endpoint.name or ""), ())
            ]
            sources = [
                source.removeprefix(f"{group}.")
                for source in dict.fromkeys(sources)
                if not source.startswith(f"{group}.{component}.")
            ]
            inputs = body.setdefault("inputs", FlowMapping())
            own = inputs.get(name)
            typed = {"type": own["type"]} if own and own["type"] else {}
            if sources:
                self._account.count("connection", len(sources))
                given: Any = sources[0] if len(sources) == 1 else sources
                full_names = [source if source.count(".") == 2 else f"{group}.{source}" for source in sources]  # noqa: PLR2004 - group, component, port
                is_same = all(architecture.outputs[each].type == typed.get("type") for each in full_names)
                inputs[name] = given if is_same or not typed else FlowMapping({"from": given, **typed})
            elif own is not None:
                where = f"Nobody here {_VERBS[endpoints[0].flow]} {names[0]}" if names else "Its name is not known"
                inputs[name] = FlowMapping({"external": where, **typed})
            elif names and not architecture.inputs[port].optional:
                inputs[name] = FlowMapping({"external": f"Nobody here {_VERBS[endpoints[0].flow]} {names[0]}"})
        for group_components in self._groups.values():
            for body in group_components.values():
                if body.get("inputs") == {}:
                    del body["inputs"]

    # Slices

    def _divide(
        self, sections: Mapping[str, Any]
    ) -> tuple[dict[str, Mapping[str, Any]], dict[str, Mapping[tuple[str | int, ...], str]]]:
        """Return a slice for each group; containers and hosts stand in the first."""
        slices: dict[str, Mapping[str, Any]] = {}
        comments: dict[str, Mapping[tuple[str | int, ...], str]] = {}
        others = {name: section for name, section in sections.items() if name != "nodes"}
        for group, components in self._groups.items():
            nodes = {node_id: data for node_id, data in self._nodes.items() if self._places[node_id] == group}
            written = {component: body or None for component, body in components.items()}
            file = f"{group}.yaml"
            slices[file] = {"groups": {group: {"components": written}}, **others, "nodes": nodes}
            comments[file] = {
                path: text
                for path, text in self._comments.items()
                if (path[0] == "groups" and path[1] == group)
                or (path[0] == "nodes" and path[1] in nodes)
                or (path[0] == "containers" and others)
            }
            others = {}
        return slices, comments


def _may_be_moved(name: str, data: Mapping[str, Any]) -> bool:
    """Whether what a node is started with may give one of its names another one."""
    is_ruled = any(":=" in str(word) for word in data.get("arguments", ()))
    last = name.rpartition("/")[2]
    return is_ruled or any(str(own_name).rpartition("/")[2].strip("~") == last for own_name in data.get("remaps", ()))


def list_naming_parameters(library_type: str, distro: str) -> list[str]:
    """Return the parameters by which a type of the library is told what its topics are called, as regular expressions."""
    found: list[str] = []
    pending: list[YamlNode] = [load_shipped_component_types(distro)[library_type].value]
    while pending:
        mapping = pending.pop()
        for entry in mapping if isinstance(mapping, MappingNode) else ():
            if entry.key == "named_by" and isinstance(entry.value, ScalarNode):
                found += [re.escape(name) for name in re.findall(r"\{(\w+)\}", entry.value.text)]
                found.append(".+".join(map(re.escape, re.split(r"\{\w+\}|\*", entry.value.text))))
            elif entry.key == "when" and isinstance(entry.value, MappingNode):
                found += [re.escape(inner.key) for inner in entry.value]
            pending.append(entry.value)
    return found
