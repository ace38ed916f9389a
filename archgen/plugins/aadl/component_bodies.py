"""Classifiers become components and component types: ports, timing, parts, wiring, hints.

Properties of a thread become timing; what the library's threads are called tells the role.

What a bus is called as a medium, and which bus something is bound to.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from archgen.plugin.importing import make_id
from archgen.plugin.model import MEDIUM_NAMES, parse_quantity
from archgen.plugins.aadl.aadl_tree import Path
from archgen.plugins.aadl.archgen_words import find_own_text, read_component_words, read_port_words
from archgen.plugins.aadl.element_hints import keep_sources, keep_structure, keep_thread
from archgen.plugins.aadl.property_values import (
    PropertyScope,
    read_count,
    read_duration,
    read_first_text,
    read_references,
    read_time_range,
    read_word,
)
from archgen.plugins.aadl.resolved_classifiers import ClassifierResolver, ResolvedClassifier, ResolvedPart
from archgen.plugins.aadl.structures import ClassifierStructure, MappedPort, MappedPorts, StructuredPart, Wire


def name_bus_medium(part: ResolvedPart) -> str:
    """Return a medium that the name of a bus or of its classifier holds, else the classifier's own name as a word."""
    classifier = part.use.full_name.rpartition("::")[2].partition(".")[0]
    names: tuple[str, str] = (classifier, part.written.name)
    for name in names:
        words: list[str] = re.findall(r"[a-z0-9]+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).lower())
        for word in words:
            if word in MEDIUM_NAMES and word not in {"ros", "memory", "file"}:
                return word
    return make_id(classifier or part.written.name, "bus")[:40].strip("_")


def read_bound_path(scope: PropertyScope, connection_name: str) -> Path:
    """Return the path of the bus that a connection is bound to, the first of several; empty where it is bound to none."""
    if not connection_name:
        return ()
    paths = read_references(scope.value((connection_name.lower(),), "actual_connection_binding"))
    return paths[0] if paths else ()


_ROLES = {"message_source": "source", "filter": "filter", "message_sink": "sink", "reactive": "reactive"}
_BEHAVIOURS = {"periodic": "periodic", "sporadic": "event", "aperiodic": "event"}


def find_role(thread: ResolvedClassifier) -> str:
    """Return the role of what is made from a thread of the component-connector library, or nothing."""
    return next((role for name, role in _ROLES.items() if thread.is_made_from(name)), "")


def fits_role(role: str, ports: MappedPorts) -> bool:
    """Whether a component with these ports can have a role: its thread's need not be that of the whole process."""
    has_input = any(port.is_input and not port.is_call for port in ports.ports)
    has_output = any(not port.is_input and not port.is_call for port in ports.ports)
    has_service = any(not port.is_input and port.is_call for port in ports.ports)
    return {
        "source": has_output and not has_input,
        "filter": has_input and has_output,
        "sink": has_input and not has_output,
        "reactive": has_service,
    }[role]


def map_timing(scope: PropertyScope, path: Path) -> dict[str, Any]:
    """Return what the properties of a thread say: all but its trigger."""
    timing = _map_dispatch(scope, path)
    for name, key in (("deadline", "deadline"), ("dispatch_jitter", "jitter")):
        if text := read_duration(scope.value(path, name)):
            timing[key] = text
    if own_jitter := find_own_text(scope, path, "jitter"):
        timing["jitter"] = own_jitter
    lowest, highest = read_time_range(scope.value(path, "compute_execution_time"))
    timing |= {"wcet": highest} if highest else {}
    # From 0 on says no more than up to.
    timing |= {"bcet": lowest} if lowest and lowest != highest and not lowest.startswith("0 ") else {}
    priority = read_count(scope.inherited_value(path, "priority"))
    return timing if priority is None else {**timing, "priority": priority}


def _map_dispatch(scope: PropertyScope, path: Path) -> dict[str, Any]:
    """Return behaviour and period."""
    timing: dict[str, Any] = {}
    protocol_property = scope.find(path, "dispatch_protocol")
    protocol = read_word(scope.value(path, "dispatch_protocol"))
    if protocol_property is None and scope.hidden:
        # What the component type says need not be said again, but counts.
        own_property = scope.find_hidden(path, "dispatch_protocol")
        protocol = read_word(own_property.value if own_property else None)
    elif protocol in _BEHAVIOURS:
        timing["behaviour"] = _BEHAVIOURS[protocol]
    elif protocol == "background" and scope.resolver.names.is_own:
        timing["behaviour"] = "once"
    elif protocol_property is not None:
        words = f"a thread that is dispatched as `{protocol or 'this'}` has no behaviour here"
        scope.resolver.notes.add_counted(f"Dispatch_Protocol {protocol}", words, protocol_property.span)
    period = read_duration(scope.inherited_value(path, "period"))
    if rate := _find_rate(scope, path):
        timing["rate"] = rate
    elif period and protocol in {"periodic", ""}:
        timing["period"] = period
    elif period:
        found = scope.find_inherited(path, "period")
        words = f"the period of a thread that is dispatched as `{protocol}` is not taken"
        if protocol == "sporadic":
            words = "the smallest distance of a sporadic thread's dispatches is no period here"
        if found:
            scope.resolver.notes.add_counted(f"Period of a {protocol} thread", words, found.span)
    return timing


def _find_rate(scope: PropertyScope, path: Path) -> str:
    """Return the rate that archgen wrote, empty for none and for what is no rate."""
    rate, said = find_own_text(scope, path, "rate"), scope.find(path, "archgen::rate")
    if rate and said and not parse_quantity(rate, "frequency"):
        scope.resolver.notes.add_contradiction("Rate", "this is no rate", said.span)
        return ""
    return rate


def add_trigger(timing: dict[str, Any], ports: MappedPorts, triggering_ids: set[str], *, is_own: bool) -> None:
    """Say what fires a thread that an event fires, where not all of its inputs do; `is_own`: archgen wrote the model."""
    if timing.get("behaviour") != "event" and not (is_own and "behaviour" not in timing and triggering_ids):
        return
    inputs = list(dict.fromkeys(port.id for port in ports.ports if port.is_input and not port.is_call))
    if not triggering_ids and any(port.is_call and not port.is_input for port in ports.ports):
        timing["behaviour"] = "on_demand"
    elif triggering_ids and len(triggering_ids) < len(inputs):
        timing["trigger"] = [port_id for port_id in inputs if port_id in triggering_ids]


def add_port_hints(body: dict[str, Any], ports: MappedPorts, timing: dict[str, Any], *, is_own: bool) -> None:
    """Keep the kind of each port where it is not the usual one (docs/aadl.md, Hints)."""
    behaviour, trigger = timing.get("behaviour"), timing.get("trigger")
    for port in ports.ports:
        # Of a model that archgen wrote, what triggers tells the kinds of inputs.
        if port.is_call or (is_own and port.is_input and port.kind != "event port"):
            continue
        triggers = behaviour is None or (behaviour == "event" and (trigger is None or port.id in trigger))
        usual = "event data port" if port.is_input and triggers else "data port"
        if port.kind != usual:
            section = body["inputs" if port.is_input else "outputs"][port.id]
            section.setdefault("hints", {}).setdefault("aadl", {})["port"] = port.kind.removesuffix(" port")


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
