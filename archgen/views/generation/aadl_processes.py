"""A node as a process of AADL: what it sends and reads as features, and a thread for each component that it implements."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from archgen.model.architecture import Architecture
from archgen.model.component import Input, Output
from archgen.model.declared_timing import Timing
from archgen.model.node import Endpoint, Node
from archgen.views.generation.aadl_behaviours import Behaviour
from archgen.views.generation.aadl_hints import list_function_properties, list_source_properties, read_aadl_hints
from archgen.views.generation.aadl_types import TypeBook
from archgen.views.generation.aadl_words import (
    AadlProperty,
    NameSpace,
    make_classifier,
    make_item,
    make_named_properties,
    make_property,
    make_text_properties,
    write_text,
)
from archgen.views.generation.generation_context import write_place

_RESERVED_NAMES = ("tf", "internal_state", "main_thread", "main_state")
"""What a process has from the library `ros`."""
_TF_TOPICS = frozenset({"/tf", "/tf_static"})
_LONGEST_QUEUE = 512
"""What the standard's own project file lets readers take."""
_NO_TIMING = Timing()


class Process:
    """A node in AADL: its type and implementation, which grow as connections and flows are found."""

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
        self.names = NameSpace(_RESERVED_NAMES)
        self.features: dict[str, str] = {}
        """The names of its features by the complete ids of the ports."""
        self.connections: list[dict[str, Any]] = []
        self.flows: list[dict[str, Any]] = []
        self.name = package_names.take_name(node.id)
        self.name_in_system = self.name
        self._ports = _group_by_port(endpoints)
        self._architecture = architecture
        self._types = types
        # Ports come before threads: it is they that others see.
        components = [
            component for each in node.implements if (component := architecture.find_component(each)) is not None
        ]
        behaviours = [
            Behaviour(architecture, types, each, node.timing.get(each.id) or node.timing.get("") or _NO_TIMING)
            for each in components
        ]
        self._feature_items = [
            self._make_feature(port, behaviour) for behaviour in behaviours for port in behaviour.component.ports
        ]
        self._feature_items += [
            self._make_internal_feature(each)
            for each in endpoints
            if each.port is None and each.name not in _TF_TOPICS
        ]
        self.uses_tf = any(each.port is None and each.name in _TF_TOPICS for each in endpoints) or "tf" in (
            read_aadl_hints(node, *components).get("access") or ()
        )
        self.threads: dict[str, str] = {}
        """The names of its threads by the complete ids of the components."""
        self._properties: list[AadlProperty] = []
        self._subcomponents: list[dict[str, Any]] = []
        self.thread_classifiers: list[dict[str, Any]] = []
        self._behaviours = {each.component.id: each for each in behaviours}
        for behaviour in behaviours:
            self._add_thread(behaviour, package_names, is_only=len(behaviours) == 1)
        self._properties += list_source_properties(read_aadl_hints(node, *components))

    def _make_feature(self, port: Input | Output, behaviour: Behaviour) -> dict[str, Any]:
        endpoints = self._ports.get(port.id, ())
        name = self.features[port.id] = self.names.take_name(port.name)
        properties = make_named_properties(name, port.name)
        if endpoints and endpoints[0].medium == "ros":
            own_name = endpoints[0].own_name or endpoints[0].name
            properties.append(make_property("topic_properties::Default_Name", write_text(own_name)))
        properties += make_text_properties(
            medium=port.medium if port.medium != "ros" else None,
            external_end=port.external,
            description=port.description,
            frame=port.frame,
        )
        return make_item(name, behaviour.describe_port(port), properties)

    def _make_internal_feature(self, endpoint: Endpoint) -> dict[str, Any]:
        flow = endpoint.flow
        classifier = self._types.name_type(endpoint.type or endpoint.message, flow)
        kinds = {
            "publishes": "out data port",
            "subscribes": "in event data port",
            "serves": "provides subprogram access",
            "calls": "requires subprogram access",
        }
        name = self.names.take_name(endpoint.name.strip("/").replace("/", "_") or "internal")
        properties = [
            make_property("topic_properties::Default_Name", write_text(endpoint.own_name or endpoint.name)),
            make_property("archgen::Is_Internal", "true"),
        ]
        return make_item(name, f"{kinds[endpoint.use]} {classifier}", properties)

    def _add_thread(self, behaviour: Behaviour, package_names: NameSpace, *, is_only: bool) -> None:
        component, hints = behaviour.component, read_aadl_hints(behaviour.component)
        kind = behaviour.pattern.partition("::")[2].replace("component_behaviour", "behaviour")
        own_words = self.node.id if is_only else f"{self.node.id}_{component.name}"
        classifier = package_names.take_name(f"{kind}_{own_words}")
        self.thread_classifiers += behaviour.make_classifiers(classifier)
        # The process and its only thread may be called alike: they stand in different namespaces.
        name = self.threads[component.id] = self.names.take_name(component.name)
        properties = make_text_properties(component=None if is_only else component.id)
        self._subcomponents.append(make_item(name, f"thread {classifier}.impl", properties))
        for port in component.ports:
            feature, own_port = self.features[port.id], f"{name}.{behaviour.port_names[port.id]}"
            text = behaviour.describe_port(port)
            ends = (own_port, feature) if text.startswith(("out", "provides")) else (feature, own_port)
            kind = "subprogram access" if "subprogram" in text else "port"
            self.connections.append(
                make_item(self.names.take_name(f"{feature}_link"), f"{kind} {ends[0]} -> {ends[1]}")
            )
        self._add_access(f"{name}_state", "internal_state", f"{name}.ist")
        if behaviour.uses_tf and self.uses_tf:
            self._add_access(f"{name}_tf", "tf", f"{name}.tf")
        own = behaviour.list_properties()
        own += self._list_queue_sizes(behaviour, name)
        own += list_function_properties(hints, component.name)
        self._properties += [
            {**each, "applies_to": f"{name}.{each['applies_to']}" if each["applies_to"] else name} for each in own
        ]

    def _list_queue_sizes(self, behaviour: Behaviour, thread: str) -> list[AadlProperty]:
        found = []
        for port in behaviour.component.inputs.values():
            endpoint = next(iter(self._ports.get(port.id, ())), None)
            depth = endpoint.qos.depth if endpoint and endpoint.qos.written else None
            if depth and depth <= _LONGEST_QUEUE and "in event data" in behaviour.describe_port(port):
                found.append(make_property("Queue_Size", str(depth), behaviour.port_names[port.id]))
        return found

    def _add_access(self, name: str, provider: str, user: str) -> None:
        self.connections.append(make_item(self.names.take_name(name), f"data access {provider} -> {user}"))

    def join_inside(self, output_id: str, input_id: str, name: str, properties: list[AadlProperty]) -> str:
        """Join the ports of two components that this node implements; return the connection's name."""
        source, reader = self._find_port(output_id), self._find_port(input_id)
        if "subprogram" in self.describe(output_id):
            text = f"subprogram access {source} -> {reader}"
        else:
            text = f"port {source} -> {reader}"
        own_name = self.names.take_name(name)
        self.connections.append(make_item(own_name, text, properties))
        return own_name

    def _find_port(self, port_id: str) -> str:
        component_id = port_id.rpartition(".")[0]
        return f"{self.threads[component_id]}.{self._behaviours[component_id].port_names[port_id]}"

    def describe(self, port_id: str) -> str:
        """Return the feature of a port as AADL writes it."""
        name = self.features[port_id]
        return str(next(each["text"] for each in self._feature_items if each["name"] == name))

    def find_endpoint(self, port_id: str, source_id: str = "") -> Endpoint | None:
        """Return what a port uses; of an input that has several topics the one on which a source arrives."""
        endpoints = self._ports.get(port_id, ())
        return next((each for each in endpoints if source_id in each.sources), next(iter(endpoints), None))

    def make_classifiers(self) -> list[dict[str, Any]]:
        """Return its threads, its type and its implementation."""
        node = self.node
        only_component = node.implements[0] if len(node.implements) == 1 else None
        properties = [
            *make_named_properties(self.name, node.id, node.title),
            *make_text_properties(
                component=only_component,
                description=node.description,
                package_name=node.package,
                executable_name=node.executable,
                node_kind=", ".join(node.kinds) if node.kinds != ("node",) else None,
            ),
        ]
        return [
            *self.thread_classifiers,
            make_classifier(
                "process",
                self.name,
                extends="ros::node",
                features=self._feature_items,
                flows=self.flows,
                properties=properties,
                place=write_place(node.at),
            ),
            make_classifier(
                "process",
                f"{self.name}.impl",
                extends="ros::node.impl",
                subcomponents=self._subcomponents,
                connections=self.connections,
                properties=self._properties,
            ),
        ]


def _group_by_port(endpoints: Sequence[Endpoint]) -> Mapping[str, list[Endpoint]]:
    grouped: dict[str, list[Endpoint]] = {}
    for endpoint in endpoints:
        if endpoint.port is not None:
            grouped.setdefault(endpoint.port, []).append(endpoint)
    return grouped
