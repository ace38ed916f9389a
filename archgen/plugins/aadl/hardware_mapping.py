"""Processors become hosts, buses become links; what is bound to them runs and travels there.

Find the processors and buses of a system wherever they stand, what has access to them, and what is bound to them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from archgen.plugin.importing import make_id, make_unique_id
from archgen.plugin.model import MEDIUM_NAMES
from archgen.plugins.aadl.aadl_tree import AadlNumber, AadlProperty, AadlRange, AadlRecord, AadlValue, Path
from archgen.plugins.aadl.archgen_words import find_own_count, find_own_text, read_own_words
from archgen.plugins.aadl.classifier_names import fold_property_name
from archgen.plugins.aadl.component_bodies import Body, name_bus_medium, read_bound_path
from archgen.plugins.aadl.element_hints import keep_sources
from archgen.plugins.aadl.property_values import (
    PropertyScope,
    read_bandwidth,
    read_references,
    read_time_range,
    read_word,
    write_number,
)
from archgen.plugins.aadl.resolved_classifiers import ClassifierResolver, ResolvedClassifier, ResolvedPart
from archgen.plugins.aadl.robot_groups import LaunchedSystem, list_ports_behind_end
from archgen.plugins.aadl.structures import HARDWARE_CATEGORIES, ClassifierStructure, fold_part_path
from archgen.plugins.aadl.system_walk import MAX_INSTANCES, TooManyInstancesError

PROCESSORS = frozenset({"processor", "virtual processor"})
_BUS_ACCESSES = frozenset({"bus access", "virtual bus access"})
_FLAT_CATEGORIES = frozenset({"data", "subprogram", "subprogram group", "thread", "memory"})
_MAX_DEPTH = 40


@dataclass(slots=True)
class HardwarePart:
    """A processor or bus where it stands."""

    part: ResolvedPart
    resolved: ResolvedClassifier | None
    scope: PropertyScope


@dataclass(slots=True)
class HardwareTree:
    """All hardware of a root, what is joined by bus accesses, and what is bound to what."""

    parts: dict[Path, HardwarePart] = field(default_factory=dict)
    joined: dict[Path, Path] = field(default_factory=dict)
    """A forest: paths of accesses and buses, each with another one that it is joined to."""
    devices: dict[Path, Path] = field(default_factory=dict)
    """Accesses of processors and devices, with who has them."""
    device_ids: dict[Path, str] = field(default_factory=dict)
    """The components that devices are of, where an export of archgen's says it, by complete id."""
    bindings: dict[Path, Path] = field(default_factory=dict)
    """What is bound to processors, with the processor."""
    bound_connections: dict[Path, dict[tuple[Path, str], None]] = field(default_factory=dict)
    """By bus: the connections bound to it, as where they stand and what they are called."""
    count: int = 0
    _owners_by_root: dict[Path, list[Path]] | None = None

    def find_root(self, path: Path) -> Path:
        """Return what all paths joined to this one have in common."""
        root = path
        while (above := self.joined.get(root, root)) != root:
            root = above
        while path != root:
            # Long ways are cut short, else a daisy chain takes the square of its length.
            self.joined[path], path = root, self.joined[path]
        return root

    def list_joined_devices(self, path: Path) -> list[Path]:
        """Return who has access to what is joined to a path."""
        if self._owners_by_root is None:
            self._owners_by_root = {}
            for access, owner in self.devices.items():
                self._owners_by_root.setdefault(self.find_root(access), []).append(owner)
        return self._owners_by_root.get(self.find_root(path), [])

    def join(self, one: Path, other: Path) -> None:
        """Join two paths."""
        self.joined[self.find_root(one)] = self.find_root(other)


class HardwareFinder:
    """Goes through all parts of a system."""

    def __init__(self, resolver: ClassifierResolver) -> None:
        self.tree = HardwareTree()
        self._resolver = resolver

    def walk(self, resolved: ResolvedClassifier, scope: PropertyScope, path: Path = ()) -> None:
        """Add all that stands in a classifier at a path."""
        tree = self.tree
        tree.count += 1
        if tree.count > MAX_INSTANCES:
            raise TooManyInstancesError
        self._add_bindings(resolved, scope, path)
        for connection in resolved.connections.values():
            if connection.kind in _BUS_ACCESSES and connection.source:
                tree.join(fold_part_path((*path, *connection.source)), fold_part_path((*path, *connection.target)))
        for name, part in resolved.parts.items():
            inner = self._resolver.resolve(part.use)
            inner_path, inner_scope = (*path, name), scope.go_into(part, inner)
            if part.category in HARDWARE_CATEGORIES and part.category != "memory":
                tree.parts[inner_path] = HardwarePart(part, inner, inner_scope)
            if inner is None or part.category in _FLAT_CATEGORIES:
                continue
            if part.category in PROCESSORS or part.category == "device":
                accesses = (key for key, port in inner.ports.items() if port.kind in _BUS_ACCESSES)
                tree.devices |= {(*inner_path, access): inner_path for access in accesses}
                if component_id := find_own_text(inner_scope, (), "component"):
                    tree.device_ids[inner_path] = component_id
            if len(path) < _MAX_DEPTH:
                self.walk(inner, inner_scope, inner_path)

    def _add_bindings(self, resolved: ResolvedClassifier, scope: PropertyScope, path: Path) -> None:
        # What is written farther out was found before, and counts.
        for (target, name), association in _list_bindings(resolved):
            if name == "actual_processor_binding":
                self._resolver.mark_used(association)
                references = read_references(association.value)
                if references:
                    self.tree.bindings.setdefault((*path, *target), (*path, *references[0]))
                if len(references) > 1:
                    words = "of several processors the first is taken"
                    self._resolver.notes.add("Actual_Processor_Binding", words, association.span, fate="noted")
            elif name == "actual_connection_binding" and target:
                self._resolver.mark_used(association)
                for reference in read_references(association.value)[:1]:
                    self.tree.bound_connections.setdefault((*path, *reference), {})[path, target[-1]] = None
        for connection in resolved.connections.values():
            if connection.properties and (bus := read_bound_path(scope, connection.name)):
                self.tree.bound_connections.setdefault((*path, *bus), {})[path, connection.name.lower()] = None


def _list_bindings(resolved: ResolvedClassifier) -> Iterator[tuple[tuple[Path, str], AadlProperty]]:
    """Yield what is bound in a classifier, in braces of its parts as well; references there begin at the classifier, too."""
    yield from resolved.properties.items()
    for name, part in resolved.parts.items():
        for association in part.written.properties:
            key = fold_property_name(association.name)
            if key in {"actual_processor_binding", "actual_connection_binding"}:
                for path in association.paths or ((),):
                    yield ((name, *fold_part_path(path)), key), association


_LIBRARY_BUSES = frozenset({"ros::topics", "ros::services"})
"""The buses of the library to which all topics and services are bound."""
_BUSES = frozenset({"bus", "virtual bus"})
_HOST_KEYS = {"title": "title", "description": "description", "scheduling": "scheduling"}
_SCHEDULING = {
    "edf": "edf",
    "earliest_deadline_first_protocol": "edf",
    "round_robin_protocol": "round_robin",
    "roundrobin": "round_robin",
    "rms": "fixed_priority",
    "rate_monotonic_protocol": "fixed_priority",
    "deadline_monotonic_protocol": "fixed_priority",
    "fixedpriority": "fixed_priority",
    "posix_1003_highest_priority_first_protocol": "fixed_priority",
    "highest_priority_first_protocol": "fixed_priority",
    "hpf": "fixed_priority",
}


class HardwareMapper:
    """Makes hosts and links of all roots."""

    def __init__(self, resolver: ClassifierResolver) -> None:
        self.hosts: dict[str, Body] = {}
        self.containers: dict[str, Body] = {}
        self.links: dict[str, Body] = {}
        self._resolver = resolver

    def map_system(self, system: LaunchedSystem) -> dict[Path, str]:
        """Add the hosts and links of a root; return the hosts of its programs."""
        finder = HardwareFinder(self._resolver)
        finder.walk(system.structure.resolved, system.scope)
        tree = finder.tree
        host_ids: dict[Path, str] = {}
        for path, hardware in tree.parts.items():
            category = hardware.part.category
            if find_own_text(hardware.scope, (), "container"):
                continue
            if category == "processor" or (category == "virtual processor" and path not in tree.bindings):
                host_ids[path] = self._add_host(path, hardware)
        for path, hardware in tree.parts.items():
            if container := find_own_text(hardware.scope, (), "container"):
                self._add_container(container, hardware, host_ids.get(tree.bindings.get(path, ()), ""))
                system.containers[path] = container
        self._bind_containers(tree, system)
        finder_of_hosts = HostFinder(tree, host_ids)
        hosts = {
            path: host
            for path, instance in system.instances.items()
            if (host := finder_of_hosts.find_host(path, is_node=instance.structure.is_node))
        }
        for path, hardware in tree.parts.items():
            if hardware.part.category in _BUSES:
                ends = _list_ends(tree, path, system, host_ids, hosts)
                names = [name for _, name in tree.bound_connections.get(path, ())]
                if len(ends) > 1:
                    self._add_link(hardware, ends, names)
                elif hardware.part.use.full_name.lower() not in _LIBRARY_BUSES:
                    # A link is between two; what joins less is kept as a hint of the group.
                    system.lone_buses[hardware.part.written.name] = _keep_bus(hardware, names)
        return hosts

    def _add_container(self, container: str, hardware: HardwarePart, host: str) -> None:
        body: Body = {"host": host} if host else {}
        body |= read_own_words(hardware.scope, (), {"title": "title", "scheduling": "scheduling"})
        threads = find_own_count(hardware.scope, (), "threads")
        self.containers[container] = body if threads is None else {**body, "threads": threads}

    @staticmethod
    def _bind_containers(tree: HardwareTree, system: LaunchedSystem) -> None:
        """Remember which programs run in containers: these say on which host."""
        for path in system.instances:
            if container := system.containers.get(tree.bindings.get(path, ())):
                system.contained[path] = container

    def _add_host(self, path: Path, hardware: HardwarePart) -> str:
        name = hardware.part.written.name
        own_id = find_own_text(hardware.scope, (), "id")
        wanted = make_id(own_id or name, "host")
        host_id = make_unique_id(
            wanted if wanted not in self.hosts else make_id("_".join(path), "host"), self.hosts.keys()
        )
        hints: Body = {"name": name} if name != host_id and not own_id else {}
        if hardware.part.use.name and not self._resolver.names.is_own:
            hints["classifier"] = hardware.part.use.full_name
        if hardware.part.category != "processor":
            hints["category"] = hardware.part.category
        hints |= keep_sources(hardware.scope, ())
        body: Body = read_own_words(hardware.scope, (), _HOST_KEYS)
        cores = find_own_count(hardware.scope, (), "cores")
        if cores is not None:
            body["cores"] = cores
        protocol = hardware.scope.find((), "scheduling_protocol")
        word = read_word(hardware.scope.value((), "scheduling_protocol"))
        if word in _SCHEDULING:
            body["scheduling"] = _SCHEDULING[word]
        elif protocol:
            words = f"the scheduling `{word or 'written here'}` has no word here"
            self._resolver.notes.add_counted("Scheduling_Protocol", words, protocol.span)
        self.hosts[host_id] = {**body, "hints": {"aadl": hints}} if hints else body
        return host_id

    def _add_link(self, hardware: HardwarePart, ends: list[str], connection_names: list[str]) -> None:
        part, scope = hardware.part, hardware.scope
        own_id = find_own_text(scope, (), "id")
        link_id = make_unique_id(make_id(own_id or part.written.name, "link"), self.links.keys())
        body: Body = {"connects": ends} if ends else {}
        body |= read_own_words(scope, (), {"title": "title"})
        medium = find_own_text(scope, (), "protocol") or name_bus_medium(part)
        is_known = medium in MEDIUM_NAMES and not self._resolver.names.is_own
        body |= {"protocol": medium} if is_known or find_own_text(scope, (), "protocol") else {}
        body |= _read_speed(scope)
        hints = {} if self._resolver.names.is_own else _keep_bus(hardware, connection_names)
        if part.written.name != link_id and not own_id:
            hints = {"name": part.written.name, **hints}
        self.links[link_id] = {**body, "hints": {"aadl": hints}} if hints else body


class HostFinder:
    """Finds on which host something runs."""

    def __init__(self, tree: HardwareTree, host_ids: Mapping[Path, str]) -> None:
        """Look at all bindings and hosts once."""
        self._bindings, self._host_ids = tree.bindings, host_ids
        self._targets_below: dict[Path, set[Path]] = {}
        self._hosts_below: dict[Path, list[Path]] = {}
        for source, target in tree.bindings.items():
            for size in range(len(source) + 1):
                self._targets_below.setdefault(source[:size], set()).add(target)
        for path in host_ids:
            for size in range(len(path) + 1):
                self._hosts_below.setdefault(path[:size], []).append(path)

    def find_host(self, path: Path, *, is_node: bool) -> str:
        """Return the host of an instance: what it, what is around it, or all threads of a program are bound to."""
        ways = (path[:size] for size in range(len(path), -1, -1))
        bound = next((self._bindings[way] for way in ways if way in self._bindings), None)
        if bound is None and is_node:
            inner = self._targets_below.get(path, set())
            bound = min(inner) if len(inner) == 1 else None
        for _ in range(5):
            if bound is None or bound in self._host_ids:
                break
            # A virtual processor is bound to a processor; a system stands for its only one.
            below = self._hosts_below.get(bound, [])
            bound = self._bindings.get(bound) or (below[0] if len(below) == 1 else None)
        return self._host_ids.get(bound, "") if bound else ""


def _keep_bus(hardware: HardwarePart, connection_names: list[str]) -> Body:
    """Return what is kept of a bus beside what a link says."""
    part = hardware.part
    kept: Body = {"classifier": part.use.full_name} if part.use.name else {}
    if part.category != "bus":
        kept["category"] = part.category
    if carrier := next(iter(read_references(hardware.scope.value((), "actual_connection_binding"))), None):
        kept["bound_to"] = ".".join(carrier)
    return {**kept, "connections": connection_names} if connection_names else kept


def _list_ends(
    tree: HardwareTree, path: Path, system: LaunchedSystem, host_ids: Mapping[Path, str], hosts: Mapping[Path, str]
) -> list[str]:
    """Return the hosts and devices that have access to a bus, or whose connections are bound to it."""
    owners = tree.list_joined_devices(path)
    ends: dict[str, None] = {host_ids[owner]: None for owner in owners if owner in host_ids}
    for owner in owners:
        ends |= _name_device(tree, owner, system)
    if len(ends) > 1:
        return list(ends)
    for place, connection_name in tree.bound_connections.get(path, ()):
        for leaf_path in _list_wired(system, place, connection_name):
            ends |= {hosts[leaf_path]: None} if leaf_path in hosts else {}
    return list(ends)


def _name_device(tree: HardwareTree, owner: Path, system: LaunchedSystem) -> dict[str, None]:
    if component_id := tree.device_ids.get(owner):
        return {component_id: None}
    instance = system.instances.get(owner)
    return {".".join(instance.ids): None} if instance else {}


def _list_wired(system: LaunchedSystem, place: Path, connection_name: str) -> list[Path]:
    """Return the processes and devices that a connection joins."""
    structure: ClassifierStructure | None = system.structure if not place else None
    if place:
        instance, frame = system.instances.get(place), system.find_frame(place)
        structure = instance.structure if instance else frame.structure if frame else None
    ends = (
        (end for wire in structure.find_wires(connection_name) for end in (wire.producer, wire.consumer))
        if structure
        else ()
    )
    return [path for end in ends for path, _ in list_ports_behind_end(end, place)]


def _read_speed(scope: PropertyScope) -> Body:
    """Return latency and bandwidth of a bus."""
    body: Body = {}
    lowest, highest = read_time_range(scope.value((), "latency"))
    if highest:
        body["latency"] = {"best": lowest or highest, "worst": highest}
    bandwidth = find_own_text(scope, (), "bandwidth") or read_bandwidth(
        scope.value((), "sei::bandwidthcapacity", "bus_properties::bandwidth")
    )
    transmission = scope.value((), "transmission_time")
    if isinstance(transmission, AadlRecord):
        parts = {name.lower(): value for name, value in transmission.fields.items()}
        bandwidth = bandwidth or _read_byte_time(parts.get("perbyte"))
        lowest, highest = read_time_range(parts.get("fixed"))
        if highest and not highest.startswith("0 ") and "latency" not in body:
            # What each message takes, whatever its size.
            body["latency"] = {"best": lowest or highest, "worst": highest}
    return {**body, "bandwidth": bandwidth} if bandwidth else body


def _read_byte_time(value: AadlValue | None) -> str | None:
    """Return the bytes a second of the time that a byte takes, the longest of a range."""
    longest = value.high if isinstance(value, AadlRange) else value
    factors = {"ps": 10**12, "ns": 10**9, "us": 10**6, "ms": 10**3, "sec": 1}
    if isinstance(longest, AadlNumber) and longest.value > 0 and longest.unit.lower() in factors:
        return write_number(factors[longest.unit.lower()] / longest.value, "B/s")
    return None
