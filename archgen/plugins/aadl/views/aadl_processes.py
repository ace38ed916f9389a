"""A node as a process of AADL: what it sends and reads as features, and a thread for each component that it implements."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from archgen.plugin.generating import title_from_id, write_place
from archgen.plugin.model import Architecture, Component, Endpoint, Node, Timing
from archgen.plugins.aadl.views.aadl_behaviours import Behaviour
from archgen.plugins.aadl.views.aadl_hints import (
    find_thread_name,
    has_tf_access,
    list_function_properties,
    list_source_properties,
    read_aadl_hints,
)
from archgen.plugins.aadl.views.aadl_ports import PortPart, find_outer_port
from archgen.plugins.aadl.views.aadl_system_part import SystemPart
from archgen.plugins.aadl.views.aadl_types import TypeBook
from archgen.plugins.aadl.views.aadl_words import (
    AadlProperty,
    FlowBook,
    NameSpace,
    list_component_words,
    make_classifier,
    make_item,
    make_named_properties,
    make_property,
    make_text_properties,
    write_aadl_string,
)

_TF_TOPICS = frozenset({"/tf", "/tf_static"})
_LONGEST_QUEUE = 512
"""What the standard's own project file lets readers take."""
_NO_TIMING = Timing()
_INTERNAL_KINDS = {
    "publishes": "out data port",
    "subscribes": "in event data port",
    "serves": "provides subprogram access",
    "calls": "requires subprogram access",
}
"""What a node has that is no port of a component, by its use."""


def _find_whole(architecture: Architecture, node: Node) -> Component | None:
    """Return the composed component that a node is the only process of."""
    for each in node.wholes:
        shell = architecture.shells.get(each)
        if shell and set(architecture.leaves_of(each)) == set(node.implements):
            return shell
    return None


class NodeProcess:
    """A node in AADL: its type and implementation, which grow as connections and flows are found."""

    category = "process"
    reserved_names: tuple[str, ...] = ("tf", "internal_state", "main_thread", "main_state")
    """What it has from the library `ros`."""
    may_use_tf = True

    def __init__(
        self,
        architecture: Architecture,
        types: TypeBook,
        node: Node,
        endpoints: Sequence[Endpoint],
        package_names: NameSpace,
    ) -> None:
        """Write a node; `package_names` are those of the package in which its classifiers stand."""
        self.node = node
        self.name = package_names.take_name(node.id)
        self.name_in_system = self.name
        self.item: dict[str, Any] = {}
        """Its subcomponent in the system that it stands in."""
        self.home: SystemPart
        """The system that it stands in; known when it is placed."""
        self.names = NameSpace(self.reserved_names)
        self.features: dict[tuple[bool, str, str], str] = {}
        """The names of its features by the keys of the parts of its ports."""
        self.threads: dict[str, str] = {}
        """The names of its threads by the complete ids of the components."""
        self.connections: list[dict[str, Any]] = []
        self.flows: list[dict[str, Any]] = []
        self.flow_book = FlowBook()
        """Instances of one component type have it in common, for the type has the flows of all."""
        self.thread_classifiers: list[dict[str, Any]] = []
        self._architecture = architecture
        self._endpoints = endpoints
        self.subcomponents: list[dict[str, Any]] = []
        self.properties: list[AadlProperty] = []
        components = [found for each in node.implements if (found := architecture.find_component(each)) is not None]
        self.whole = _find_whole(architecture, node)
        """The composed component that it is the only process of."""
        self._hints = read_aadl_hints(*components, *([self.whole] if self.whole else []))
        self.behaviours = {
            each.id: Behaviour(architecture, types, each, node.timing.get(each.id) or node.timing.get("") or _NO_TIMING)
            for each in components
        }
        self.uses_tf = self.may_use_tf and (
            any(each.port is None and each.name in _TF_TOPICS for each in endpoints) or has_tf_access(self._hints)
        )
        # Ports come before threads: it is they that others see.
        self.feature_items = [
            self._make_feature(part)
            for behaviour in self.behaviours.values()
            for part in behaviour.parts
            if not self._is_inside_only(part)
        ]
        self.feature_items += [
            self._make_internal_feature(types, each)
            for each in endpoints
            if each.port is None and each.name not in _TF_TOPICS
        ]
        for behaviour in self.behaviours.values():
            self._add_thread(behaviour, package_names, is_only=len(self.behaviours) == 1)
        self.properties += list_source_properties(self._hints)

    @property
    def classifier(self) -> str:
        """What its subcomponent is made from, within its package."""
        return f"{self.name}.impl"

    def find_endpoints(self, part: PortPart, source_id: str = "") -> Iterable[Endpoint]:
        """Yield what a part of a port uses; with a source only what it arrives on."""
        uses = {"publishes", "serves"} if part.is_output else {"subscribes", "calls"}
        for endpoint in self._endpoints:
            if endpoint.port != part.port.id or endpoint.use not in uses:
                continue
            if (
                part.is_output
                or not endpoint.sources
                or any(part.reads(each) and source_id in {"", each} for each in endpoint.sources)
            ):
                yield endpoint

    def _make_feature(self, part: PortPart) -> dict[str, Any]:
        port = part.port
        shell_port = self._find_shell_port(part)
        name = self.features[part.key] = self.names.take_name(shell_port or part.name)
        properties = make_named_properties(name, shell_port or port.name)
        endpoint = next(iter(self.find_endpoints(part)), None)
        own_name = (endpoint.own_name or endpoint.name) if endpoint and endpoint.medium == "ros" else None
        if own_name is not None:
            properties.append(make_property("topic_properties::Default_Name", write_aadl_string(own_name)))
        properties += make_text_properties(
            medium=port.medium if port.medium != "ros" else None,
            external_end=port.external,
            description=port.description,
            frame=port.frame,
        )
        return make_item(name, part.text, properties)

    def _find_shell_port(self, part: PortPart) -> str | None:
        """Return the port of the composed component that it is the process of, if that passes a port inside on."""
        if self.whole is None:
            return None
        return find_outer_port(self._architecture, self.whole, part)

    def _is_inside_only(self, part: PortPart) -> bool:
        """Whether nothing outside of a composed component that is one process sees a port inside."""
        if self.whole is None or self._find_shell_port(part):
            return False
        edges = [
            edge for edge in self._architecture.edges if part.port.id == (edge.output if part.is_output else edge.input)
        ]
        peers = {(edge.input if part.is_output else edge.output).rpartition(".")[0] for edge in edges}
        return bool(peers) and peers <= set(self.node.implements)

    def _make_internal_feature(self, types: TypeBook, endpoint: Endpoint) -> dict[str, Any]:
        classifier = types.name_type(endpoint.type or endpoint.message, endpoint.flow)
        name = self.names.take_name(endpoint.label.strip("/").replace("/", "_") or "internal")
        properties = [
            make_property("topic_properties::Default_Name", write_aadl_string(endpoint.own_name or endpoint.label)),
            make_property("archgen::Is_Internal", "true"),
        ]
        return make_item(name, f"{_INTERNAL_KINDS[endpoint.use]} {classifier}", properties)

    def _add_thread(self, behaviour: Behaviour, package_names: NameSpace, *, is_only: bool) -> None:
        component, hints = behaviour.component, read_aadl_hints(behaviour.component)
        kind = behaviour.pattern.partition("::")[2].replace("component_behaviour", "behaviour")
        own_words = self.node.id if is_only else f"{self.node.id}_{component.name}"
        classifier = package_names.take_name(f"{kind}_{own_words}")
        self.thread_classifiers += behaviour.make_classifiers(classifier)
        name = self.threads[component.id] = self.names.take_name(
            find_thread_name(hints) or component.type_name or component.name
        )
        properties = make_text_properties(component=None if is_only else component.id)
        self.subcomponents.append(make_item(name, f"thread {classifier}.impl", properties))
        for part in behaviour.parts:
            if part.key not in self.features:
                continue
            feature, own_port = self.features[part.key], f"{name}.{behaviour.port_names[part.key]}"
            ends = (own_port, feature) if part.is_output else (feature, own_port)
            self._connect(f"{feature}_link", f"{part.connection_kind} {ends[0]} -> {ends[1]}")
        self._connect(f"{name}_state", f"data access internal_state -> {name}.ist")
        if behaviour.uses_tf and self.uses_tf:
            self._connect(f"{name}_tf", f"data access tf -> {name}.tf")
        own = behaviour.list_properties() + self._list_queue_sizes(behaviour)
        own += list_function_properties(hints, component.name)
        self.properties += [
            {**each, "applies_to": f"{name}.{each['applies_to']}" if each["applies_to"] else name} for each in own
        ]

    def _list_queue_sizes(self, behaviour: Behaviour) -> list[AadlProperty]:
        found = []
        for part in behaviour.parts:
            endpoint = next(iter(self.find_endpoints(part)), None)
            depth = endpoint.qos.depth if endpoint and endpoint.qos.written else None
            if depth and depth <= _LONGEST_QUEUE and part.kind == "in event data port":
                found.append(make_property("Queue_Size", str(depth), behaviour.port_names[part.key]))
        return found

    def _connect(self, name: str, text: str, properties: Iterable[AadlProperty] = ()) -> None:
        self.connections.append(make_item(self.names.take_name(name), text, properties))

    def find_part(self, port_id: str, *, is_output: bool, source_id: str = "") -> PortPart | None:
        """Return the part of a port that this node has; None where another one has it."""
        behaviour = self.behaviours.get(port_id.rpartition(".")[0])
        return behaviour.find_part(port_id, is_output=is_output, source_id=source_id) if behaviour else None

    def add_call_feature(self, part: PortPart) -> None:
        """Add the port for the request or the answer of a call, if it is not there yet."""
        if part.key not in self.features:
            name = self.features[part.key] = self.names.take_name(part.name)
            self.feature_items.append(make_item(name, part.text, [make_property("archgen::Is_Call", "true")]))

    def add_flow(self, wanted_name: str, text: str, properties: list[AadlProperty]) -> str:
        """Add a flow, if it is not there yet; return its name. One with other properties is another flow."""
        key = (text, str(properties))
        if key not in self.flow_book.names:
            name = self.flow_book.space.take_name(wanted_name)
            self.flow_book.names[key] = self.names.take_name(name)
        name = self.flow_book.names[key]
        if not any(each["name"] == name for each in self.flows):
            self.flows.append(make_item(name, text, properties))
        return name

    def join_inside(self, output: PortPart, reader: PortPart, properties: Iterable[AadlProperty]) -> None:
        """Join the ports of two components that this node implements."""
        ends = []
        for part in (output, reader):
            component = part.port.component
            ends.append(f"{self.threads[component]}.{self.behaviours[component].port_names[part.key]}")
        name = f"{ends[0]}_to_{ends[1]}".replace(".", "_")
        self._connect(name, f"{output.connection_kind} {ends[0]} -> {ends[1]}", properties)

    def find_own_owner(self, component: Component | None) -> str | None:
        """Return who owns its component, where that is not who owns the group."""
        owner = component.owner if component else self.node.owner
        group = self._architecture.groups.get(component.group) if component else None
        return owner if group is None or group.owner != owner else None

    def list_words(self) -> list[AadlProperty]:
        """Return what it says of itself beside its ports and its threads."""
        node = self.node
        behaviours = tuple(self.behaviours.values())
        component = behaviours[0].component if len(behaviours) == 1 else self.whole
        element = component or node
        properties = make_named_properties(element.id, element.id, element.title)
        if component is not None and node.title != title_from_id(node.id):
            properties += make_text_properties(node_title=node.title)
        role = behaviours[0].further_role if len(behaviours) == 1 else None
        properties += list_component_words(component or node, role, self.find_own_owner(component))
        return properties + make_text_properties(
            package_name=node.package,
            executable_name=node.executable,
            node_kind=", ".join(node.kinds) if node.kinds != ("node",) else None,
        )

    def make_classifiers(self) -> list[dict[str, Any]]:
        """Return its threads, its type and its implementation."""
        properties = self.list_words()
        own_type = make_classifier("process", self.name, extends="ros::node", properties=properties)
        implementation = make_classifier("process", f"{self.name}.impl", extends="ros::node.impl")
        own_type.update(features=self.feature_items, flows=self.flows, place=write_place(self.node.at))
        implementation.update(
            subcomponents=self.subcomponents, connections=self.connections, properties=self.properties
        )
        return [*self.thread_classifiers, own_type, implementation]
