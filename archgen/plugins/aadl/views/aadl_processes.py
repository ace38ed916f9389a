"""A node as a process of AADL: what it sends and reads as features, and a thread for each component that it implements; a
group or a composed component as a system, with what grows in it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Any

from archgen.plugin.generating import title_from_id, write_place
from archgen.plugin.model import Architecture, Component, Endpoint, Group, Node, Timing, uses_ros
from archgen.plugins.aadl.views.aadl_ports import PortPart, find_outer_port, list_port_parts
from archgen.plugins.aadl.views.aadl_types import TypeBook
from archgen.plugins.aadl.views.aadl_words import (
    AadlProperty,
    FlowBook,
    NameSpace,
    can_be_written,
    find_thread_name,
    has_tf_access,
    list_component_words,
    list_function_properties,
    list_source_properties,
    list_tags,
    make_classifier,
    make_duration_property,
    make_item,
    make_named_properties,
    make_property,
    make_text_properties,
    read_aadl_hints,
    write_aadl_duration,
    write_aadl_string,
    write_range,
)

_Place = tuple[str, object]
"""A port of a composed component with what it carries, or a node with the key of its port."""


class SystemPart:
    """A system: the launch of everything, a group, or a composed component; it grows as connections and flows are found."""

    def __init__(
        self, name: str, classifier: str, parent: SystemPart | None, element: Group | Component | None
    ) -> None:
        """Begin with nothing inside; `name` is what it is called in the system around it."""
        self.name, self.classifier, self.parent, self.element = name, classifier, parent, element
        self.names = NameSpace()
        self.features: dict[_Place, str] = {}
        self.feature_items: list[dict[str, Any]] = []
        self.subcomponents: list[dict[str, Any]] = []
        self.connections: list[dict[str, Any]] = []
        self.flow_specs: list[dict[str, Any]] = []
        self.flows: list[dict[str, Any]] = []
        self.properties: list[AadlProperty] = []
        self._joined: dict[tuple[str, str], str] = {}
        self.accesses: dict[str, str] = {}
        """The names of its accesses to what something inside needs of the outermost system."""

    @property
    def path(self) -> tuple[SystemPart, ...]:
        """The systems that lead here, from the outermost on."""
        return (*(self.parent.path if self.parent else ()), self)

    def name_inside(self, scope: SystemPart, name: str) -> str:
        """Return how something of this system is named from a system around it: `group.arm.motor`."""
        steps = self.path[len(scope.path) :]
        return ".".join((*(each.name for each in steps), name))

    def connect(self, name: str, text: str, properties: list[AadlProperty]) -> str:
        """Add a connection; return its name."""
        own_name = self.names.take_name(name)
        self.connections.append(make_item(own_name, text, properties))
        return own_name

    def join_ends(self, name: str, kind: str, ends: tuple[str, str], properties: list[AadlProperty]) -> str:
        """Join two ends that may be joined already; return the connection's name."""
        if ends not in self._joined:
            self._joined[ends] = self.connect(name, f"{kind} {ends[0]} -> {ends[1]}", properties)
        return self._joined[ends]

    def make_classifiers(self, properties: list[AadlProperty]) -> list[dict[str, Any]]:
        """Return its type, with further properties, and its implementation."""
        own_type = make_classifier("system", self.classifier, features=self.feature_items, flows=self.flow_specs)
        own_type.update(properties=properties, place=write_place(self.element.at) if self.element else "")
        implementation = make_classifier("system", f"{self.classifier}.impl")
        implementation.update(
            subcomponents=self.subcomponents,
            connections=self.connections,
            flows=self.flows,
            properties=self.properties,
        )
        return [own_type, implementation]


def list_system_properties(element: Group | Component) -> list[AadlProperty]:
    """Return what a group or a composed component says of itself."""
    own_id = element.id.rpartition(".")[2]
    texts: Mapping[str, str | None] = {
        "description": element.description,
        "functionality": getattr(element, "functionality", None),
        "owner": element.owner,
    }
    return [
        *(each for each in make_named_properties(own_id, own_id, element.title)),
        *make_text_properties(**texts),
        *list_tags(element),
    ]


_DISPATCH = {"periodic": "Periodic", "event": "Aperiodic", "on_demand": "Aperiodic", "once": "Background"}
_ROLES = {
    "ros::publisher": "source",
    "ros::callback": "sink",
    "ros::call_pub": "filter",
    "ros::service_provider": "reactive",
}
"""What the patterns say of the role."""
_INHERITED_NAMES = ("ist", "tf", "function", "pc")
"""What a thread has from the library: no port of its own is called so."""
_PROTOTYPES = {"msg": "message", "srv": "service", "msg_in": "message_in", "msg_out": "message_out"}
"""What the types of the ports of the library's threads are called."""


class Behaviour:
    """A component's thread: its classifiers, and how its ports are called there."""

    def __init__(self, architecture: Architecture, types: TypeBook, component: Component, timing: Timing) -> None:
        """Choose the pattern of a component that a node implements."""
        self.component = component
        self.timing = timing
        self.parts = list_port_parts(architecture, types, component, frozenset(self._list_triggers()))
        self.pattern, fixed_names = self._choose_pattern()
        names = NameSpace(_INHERITED_NAMES)
        self.port_names = {part.key: fixed_names.get(part.key) or names.take_name(part.name) for part in self.parts}
        """The names of its ports in the thread."""
        self.is_refined = bool(fixed_names)

    @property
    def further_role(self) -> str | None:
        """The role of the component where the pattern does not say it."""
        return self.component.role if _ROLES.get(self.pattern) != self.component.role else None

    @property
    def uses_tf(self) -> bool:
        """Whether it has access to the transformations, as all patterns of ROS have."""
        return self.pattern.startswith("ros::")

    @property
    def behaviour(self) -> str | None:
        """What activates it, as far as it is written."""
        timing = self.timing
        return timing.behaviour or ("periodic" if timing.period or timing.rate else "event" if timing.trigger else None)

    def _list_triggers(self) -> tuple[str, ...]:
        if self.behaviour == "periodic":
            return ()
        trigger = self.timing.trigger
        known = tuple(port.id for port in self.component.inputs.values())
        return known if trigger is None or trigger.inputs is None else trigger.inputs

    def _choose_pattern(self) -> tuple[str, dict[tuple[bool, str, str], str]]:
        """Return the library's thread, and the names that ports have there."""
        role, is_periodic = self.component.role, self.behaviour == "periodic"
        kinds = [part.kind for part in self.parts]
        keys = [part.key for part in self.parts]
        if all(uses_ros(part.port) for part in self.parts):
            if kinds == ["out data port"] and is_periodic and role in {None, "source"}:
                return "ros::publisher", {keys[0]: "msg"}
            if kinds == ["in event data port"] and role in {None, "sink"}:
                return "ros::callback", {keys[0]: "msg"}
            if kinds == ["provides subprogram access"] and not is_periodic and role in {None, "reactive"}:
                return "ros::service_provider", {keys[0]: "srv"}
            if kinds == ["in event data port", "out data port"] and role in {None, "filter"}:
                return "ros::call_pub", {keys[0]: "msg_in", keys[1]: "msg_out"}
        return ("ros::timer", {}) if is_periodic else ("cnc::component_behaviour", {})

    def make_classifiers(self, name: str) -> list[dict[str, Any]]:
        """Return the thread's type and its implementation, made from the pattern."""
        features = []
        for part in self.parts:
            own_name = self.port_names[part.key]
            text = f"refined to {part.text}" if self.is_refined else part.text
            features.append(make_item(own_name, text))
        bindings = self._list_bindings() if self.is_refined else []
        extends = f"{self.pattern} ({', '.join(bindings)})" if bindings else self.pattern
        return [
            make_classifier("thread", name, extends=extends, features=features),
            make_classifier("thread", f"{name}.impl", extends=f"{self.pattern}.impl"),
        ]

    def _list_bindings(self) -> list[str]:
        """Return what the prototypes of the pattern stand for."""
        return [
            f"{_PROTOTYPES[self.port_names[part.key]]} => "
            f"{'data' if part.flow == 'topic' else 'subprogram'} {part.classifier}"
            for part in self.parts
        ]

    def list_properties(self) -> list[AadlProperty]:
        """Return how the thread is dispatched, and what of its timing AADL has a word for."""
        timing, found = self.timing, list[AadlProperty]()
        if self.behaviour:
            found.append(make_property("Dispatch_Protocol", _DISPATCH[self.behaviour]))
        if timing.period:
            found += make_duration_property("Period", timing.period)
        elif timing.rate and timing.rate.value:
            period = Fraction(10**9) / timing.rate.value
            if can_be_written(period):
                found.append(make_property("Period", write_aadl_duration(period)))
            found += make_text_properties(rate=str(timing.rate))
        found += make_duration_property("Deadline", timing.deadline)
        found += make_duration_property("Dispatch_Jitter", timing.jitter)
        if timing.wcet and can_be_written(timing.wcet.value):
            lowest = timing.bcet.value if timing.bcet else Fraction(0)
            found.append(make_property("Compute_Execution_Time", write_range(lowest, timing.wcet.value)))
        if timing.priority is not None:
            found.append(make_property("Priority", str(timing.priority)))
        return found

    def find_part(self, port_id: str, *, is_output: bool, source_id: str = "") -> PortPart | None:
        """Return the part of a port; of an input that on which an output arrives."""
        return next(
            (
                part
                for part in self.parts
                if part.port.id == port_id and part.is_output is is_output and (is_output or part.reads(source_id))
            ),
            None,
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
