"""Classifiers become components and component types: ports, timing, parts, wiring, hints."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from archgen.plugins.aadl.aadl_tree import Path
from archgen.plugins.aadl.archgen_words import find_own_text, read_component_words, read_port_words
from archgen.plugins.aadl.bus_names import name_bus_medium, read_bound_path
from archgen.plugins.aadl.element_hints import keep_sources, keep_structure, keep_thread
from archgen.plugins.aadl.port_mapping import MappedPort
from archgen.plugins.aadl.property_values import PropertyScope, read_count, read_first_text
from archgen.plugins.aadl.resolved_classifiers import ClassifierResolver, ResolvedClassifier
from archgen.plugins.aadl.structures import ClassifierStructure, StructuredPart, Wire
from archgen.plugins.aadl.thread_timing import add_port_hints, add_trigger, find_role, fits_role, map_timing

Body = dict[str, Any]
MAX_COMPONENTS = 50_000
_TELLING_PROPERTIES = ("topic_properties::name", "actual_connection_binding")
"""What is said of a connection by its name."""
_USES = {(True, False): "subscribes", (False, False): "publishes", (True, True): "calls", (False, True): "serves"}


class TooManyPartsError(Exception):
    """The parts of a model are more than anybody wants to read."""


class ComponentBuilder:
    """Makes the bodies of components; what stands in several places is an instance of a component type."""

    def __init__(self, resolver: ClassifierResolver, find_type: Callable[[ClassifierStructure], str]) -> None:
        """Ask `find_type` for the component type that a structure is; it answers nothing for what is written in place."""
        self._resolver, self._find_type = resolver, find_type
        self._count = 0

    def build_body(self, structure: ClassifierStructure, scope: PropertyScope) -> Body:
        """Return the body of a component that has all of a classifier."""
        self._count += 1
        if self._count > MAX_COMPONENTS:
            raise TooManyPartsError
        resolved, ports = structure.resolved, structure.ports
        hints: Body = {} if self._resolver.names.is_own else {"classifier": resolved.known.full_name}
        body: Body = {}
        inputs, outputs = ports.make_section(is_input=True), ports.make_section(is_input=False)
        if structure.parts:
            body["components"] = {part.id: self.build_instance(part, scope) for part in structure.parts.values()}
            hints |= _keep_connection_names(structure, scope)
        else:
            body |= self._describe_leaf(structure, scope, hints)
        body |= {"inputs": inputs} if inputs else {}
        body |= {"outputs": outputs} if outputs else {}
        if not (inputs or outputs or structure.parts):
            # AADL says that it has none; without them nothing would declare it.
            body |= {"inputs": {}, "outputs": {}}
        if not structure.parts:
            add_port_hints(body, ports, body.get("timing", {}), is_own=self._resolver.names.is_own)
        if resolved.category == "device" and not self._resolver.names.is_own:
            body["tags"] = ["device"]
            for port_body in outputs.values():
                port_body.setdefault("medium", "physical")
        own_scope = PropertyScope(self._resolver, resolved)
        hints |= keep_sources(own_scope, ()) | keep_structure(structure, scope)
        body |= {"hints": {"aadl": hints}} if hints else {}
        self._wire_inside(structure, body, scope)
        return body | read_component_words(scope)

    def build_instance(self, part: StructuredPart, scope_around: PropertyScope) -> Body:
        """Return the body of a part: an instance of a component type, or all of it."""
        structure = part.structure
        scope = scope_around.go_into(part.part, structure.resolved if structure else None)
        name = part.part.written.name
        own_id = find_own_text(scope_around, (part.name,), "id")
        names = {"name": name} if name != part.id and not own_id else {}
        if structure is None:
            self._count += 1
            known = {"classifier": part.part.use.full_name} if part.part.use.name else {}
            tags = {"tags": ["device"]} if part.part.category == "device" else {}
            # Nothing is known of it but what it is called.
            stub: Body = {"title": name, **tags}
            return {**stub, "hints": {"aadl": {**names, **known}}} if names or known else stub
        if type_id := self._find_type(structure):
            hints = {"hints": {"aadl": names}} if names else {}
            return {"is": type_id, **self.build_overlay(structure, scope.only_around()), **hints}
        body = self.build_body(structure, scope)
        if names:
            body.setdefault("hints", {})["aadl"] = {**names, **body.get("hints", {}).get("aadl", {})}
        return body

    def build_overlay(self, structure: ClassifierStructure, scope: PropertyScope) -> Body:
        """Return what is written around an instance of its parts and threads."""
        if not scope.says_anything():
            return {}
        body: Body = read_component_words(scope)
        for part in structure.parts.values():
            if part.structure:
                inner = self.build_overlay(part.structure, scope.go_below(part.part))
                if inner:
                    body.setdefault("components", {})[part.id] = inner
        for port in structure.ports.ports:
            if words := read_port_words(scope, port.path):
                reach_port(body, "inputs" if port.is_input else "outputs", port.id).update(words)
        if not structure.parts and (timing := map_timing(scope, _find_thread_path(structure))):
            body["timing"] = timing
        return body

    def _describe_leaf(self, structure: ClassifierStructure, scope: PropertyScope, hints: Body) -> Body:
        resolved, body = structure.resolved, {}
        path = _find_thread_path(structure)
        thread = self._resolver.resolve(structure.thread.use) if structure.thread else None
        timing = map_timing(scope, path)
        if structure.thread:
            if kept := keep_thread(scope, path, thread):
                hints["threads"] = {structure.thread.written.name: kept}
            triggering = {port.id for port in structure.ports.ports if _is_triggered(structure, thread, port.id)}
        else:
            triggering = {p.id for p in structure.ports.ports if p.is_input and p.kind.startswith("event")}
        if resolved.category == "thread":
            thread = resolved
            hints |= keep_thread(scope, (), resolved)
        add_trigger(timing, structure.ports, triggering, is_own=self._resolver.names.is_own)
        if thread and (role := find_role(thread)) and fits_role(role, structure.ports):
            body["role"] = role
        return {**body, "timing": timing} if timing else body

    def _wire_inside(self, structure: ClassifierStructure, body: Body, scope: PropertyScope) -> None:
        for wire in structure.wires:
            producer, consumer = wire.producer, wire.consumer
            reference = f"{producer.part.id if producer.part else 'self'}.{producer.port.id}"
            if consumer.part is None:
                add_source(body["outputs"][consumer.port.id], reference)
            else:
                port_body = reach_port(body["components"][consumer.part.id], "inputs", consumer.port.id)
                join_input(port_body, reference, producer.port, consumer.port)
        set_media(structure, body.get("components", {}), scope)


def add_source(port_body: Body, reference: str) -> None:
    """Add a source to a port."""
    sources = port_body.setdefault("from", [])
    if reference not in sources:
        sources.append(reference)


def join_input(port_body: Body, reference: str, producer: MappedPort, consumer: MappedPort) -> None:
    """Add a source to an input; a type that its sources have as well need not be written."""
    add_source(port_body, reference)
    if producer.type_name != consumer.type_name:
        port_body |= {"type": consumer.type_name} if consumer.type_name else {}
    elif len(port_body["from"]) == 1:
        port_body.pop("type", None)


def reach_port(body: Body, section: str, port_id: str) -> Body:
    """Return the body of a port, made if it is not written yet."""
    port_body: Body = body.setdefault(section, {}).setdefault(port_id, {})
    return port_body


def set_media(structure: ClassifierStructure, bodies: dict[str, Body], scope: PropertyScope) -> None:
    """Say what the ports of devices travel over: the bus that a connection is bound to.

    Of a model that archgen wrote, the ports say it.
    """
    if scope.resolver.names.is_own:
        return
    readers: dict[tuple[str, str], list[Wire]] = {}
    for wire in structure.wires:
        if wire.producer.part:
            readers.setdefault((wire.producer.part.id, wire.producer.port.id), []).append(wire)
    for (part_id, port_id), wires in readers.items():
        part = wires[0].producer.part
        from_device = part is not None and part.part.category == "device"
        to_devices = [bool(wire.consumer.part and wire.consumer.part.part.category == "device") for wire in wires]
        if not (from_device or any(to_devices)) or part_id not in bodies:
            continue
        if not from_device and not all(to_devices):
            words = "what a device and programs read alike has no medium of its own"
            scope.resolver.notes.add("connection", words, wires[0].connection.span)
            continue
        media = {find_medium(wire, structure, scope) for wire in wires}
        medium = min(media) if len(media) == 1 else "physical"
        reach_port(bodies[part_id], "outputs", port_id)["medium"] = medium
        for consumer in (wire.consumer for wire in wires):
            if consumer.part and consumer.part.part.category == "device" and consumer.part.id in bodies:
                reach_port(bodies[consumer.part.id], "inputs", consumer.port.id)["medium"] = medium


def find_medium(wire: Wire, structure: ClassifierStructure, scope: PropertyScope) -> str:
    """Return the word for the bus that a connection is bound to; physical where it is bound to none."""
    path = read_bound_path(scope, wire.connection.name)
    part = structure.resolved.parts.get(path[0]) if path else None
    return name_bus_medium(part) if part else "physical"


def map_node_ports(structure: ClassifierStructure, scope: PropertyScope, *, is_type: bool) -> Body:
    """Return what a node calls its topics, and how long its queues are."""
    node: Body = {}
    for port in structure.ports.ports:
        path = port.path
        use: Body = {}
        default_name = read_first_text(scope.value(path, "topic_properties::default_name"))
        if default_name:
            key = "name" if port.is_call else "topic"
            use["own_name" if port.is_input or not is_type else key] = default_name
        depth = read_count(scope.value(path, "queue_size"))
        if depth is None and structure.thread and (inner := structure.thread_ports.get((port.id, port.is_input))):
            thread_path = (structure.thread.written.name.lower(), *inner.split("."))
            depth = read_count(scope.value(thread_path, "queue_size"))
        if depth and not port.is_call:
            use["qos"] = {"depth": depth}
        if use:
            node.setdefault(_USES[port.is_input, port.is_call], {})[port.id] = use
    return node


def name_use_section(*, is_input: bool, is_call: bool) -> str:
    """Return the key of a node below which a port stands."""
    return _USES[is_input, is_call]


def _find_thread_path(structure: ClassifierStructure) -> Path:
    return (structure.thread.written.name.lower(),) if structure.thread else ()


def _is_triggered(structure: ClassifierStructure, thread: ResolvedClassifier | None, port_id: str) -> bool:
    inner = structure.thread_ports.get((port_id, True))
    port = thread.ports.get(inner) if thread and inner else None
    return port is not None and port.kind.startswith("event")


def _keep_connection_names(structure: ClassifierStructure, scope: PropertyScope) -> Body:
    if scope.resolver.names.is_own:
        return {}
    names = {
        connection.name: f"{'.'.join(connection.source)} -> {'.'.join(connection.target)}"
        for connection in {id(wire.connection): wire.connection for wire in structure.wires}.values()
        if connection.name and any(scope.find((connection.name.lower(),), key) for key in _TELLING_PROPERTIES)
    }
    return {"connections": names} if names else {}
