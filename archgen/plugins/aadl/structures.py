"""How a classifier is built: parts that are components, their inputs and outputs, hardware, and who sends to whom among
them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from archgen.plugin.importing import make_id, make_unique_id
from archgen.plugins.aadl.aadl_data_types import AadlDataTypes
from archgen.plugins.aadl.aadl_tree import AadlConnection, Path
from archgen.plugins.aadl.archgen_words import find_own_text, is_marked, read_port_words
from archgen.plugins.aadl.property_values import PropertyScope
from archgen.plugins.aadl.resolved_classifiers import ClassifierResolver, ResolvedClassifier, ResolvedPart, ResolvedPort

_PORT_KINDS = frozenset({"data port", "event data port", "event port", "feature", "subprogram access"})
_KEPT_ACCESSES = frozenset({"data access", "bus access", "virtual bus access", "subprogram group access"})
_MAX_GROUP_DEPTH = 10
_MAX_PORTS = 20_000
_OPPOSITE = {"in": "out", "out": "in", "requires": "provides", "provides": "requires"}


@dataclass(slots=True, eq=False)
class MappedPort:
    """An input or output that a feature became; `path` is the feature's name, below those of its groups."""

    id: str
    path: Path
    written_name: str
    is_input: bool
    is_call: bool
    kind: str
    type_name: str


@dataclass(slots=True)
class MappedPorts:
    """The ports of a classifier, and the accesses that are kept as hints."""

    scope: PropertyScope
    ports: list[MappedPort] = field(default_factory=list)
    accesses: dict[str, dict[str, str]] = field(default_factory=dict)
    internal: list[ResolvedPort] = field(default_factory=list)
    """What a node has that is no port of a component."""
    call_paths: set[Path] = field(default_factory=set)
    """What an export of archgen's wrote for flows through calls."""
    by_path: dict[Path, list[MappedPort]] = field(default_factory=dict)
    groups: dict[Path, list[MappedPort]] = field(default_factory=dict)
    """All ports in a feature group, by the group's path."""

    def make_section(self, *, is_input: bool) -> dict[str, dict[str, Any]]:
        """Return the inputs or the outputs as data of the language."""
        section: dict[str, dict[str, Any]] = {}
        for port in self.ports:
            if port.is_input == is_input:
                own_id = find_own_text(self.scope, port.path, "id")
                hints = {"name": port.written_name} if port.written_name != port.id and not own_id else {}
                body: dict[str, Any] = {"type": port.type_name} if port.type_name else {}
                body |= read_port_words(self.scope, port.path)
                if section.get(port.id, body).get("type") != body.get("type"):
                    # One input of several types: its sources tell them.
                    body.pop("type", None)
                    section[port.id].pop("type", None)
                section[port.id] = section.get(port.id, {}) | body
                if hints:
                    section[port.id]["hints"] = {"aadl": hints}
        return section


class PortMapper:
    """Maps the features of classifiers, each classifier once."""

    def __init__(self, resolver: ClassifierResolver, types: AadlDataTypes) -> None:
        self._resolver, self._types, self._notes = resolver, types, resolver.notes
        self._mapped: dict[int, MappedPorts] = {}

    def map_ports(self, resolved: ResolvedClassifier) -> MappedPorts:
        """Return the ports of a classifier."""
        if id(resolved) not in self._mapped:
            mapped = MappedPorts(PropertyScope(self._resolver, resolved))
            used: tuple[set[str], set[str]] = (set(), set())
            for port in resolved.ports.values():
                self._add_port(mapped, port, (), used, is_inverse=False)
            self._mapped[id(resolved)] = mapped
        return self._mapped[id(resolved)]

    def _add_port(
        self,
        mapped: MappedPorts,
        port: ResolvedPort,
        prefix: Path,
        used: tuple[set[str], set[str]],
        *,
        is_inverse: bool,
    ) -> list[MappedPort]:
        written = port.written
        path = (*prefix, written.name.lower())
        if port.kind == "feature group":
            mapped.groups[path] = self._add_group(mapped, port, path, used, is_inverse=is_inverse != written.inverse)
            return mapped.groups[path]
        if port.kind in _KEPT_ACCESSES:
            access = {"kind": f"{port.direction} {port.kind}"}
            mapped.accesses[".".join(path)] = {**access, **({"type": port.use.full_name} if port.use.name else {})}
            return []
        if port.kind not in _PORT_KINDS or not port.direction:
            words = (
                f"feature {written.name} has no direction" if port.kind in _PORT_KINDS else f"{written.name} is no port"
            )
            self._notes.add_counted(port.kind, words, written.span)
            return []
        is_call = port.kind == "subprogram access"
        if is_marked(mapped.scope, path, "is_call"):
            # The request or the answer of a call, which has a port of its own.
            mapped.call_paths.add(path)
            return []
        if is_marked(mapped.scope, path, "is_internal"):
            mapped.internal.append(port)
            return []
        directions = port.direction.split()
        added = []
        for word in [_OPPOSITE[word] for word in directions] if is_inverse else directions:
            is_input = word in {"in", "requires"}
            own_id = find_own_text(mapped.scope, path, "id")
            # Features with one id of archgen's are one input, which reads several types.
            wanted = make_id(own_id or "_".join((*prefix, written.name)), "port")
            port_id = wanted if own_id else make_unique_id(wanted, used[is_input])
            used[is_input].add(port_id)
            type_name = self._types.name_use(port.use, "srv" if is_call else "msg")
            added.append(
                MappedPort(port_id, path, ".".join((*prefix, written.name)), is_input, is_call, port.kind, type_name)
            )
        if written.dimensions:
            self._notes.add_counted("array of ports", "an array of ports is taken as one", written.span, fate="noted")
        mapped.ports += added
        mapped.by_path.setdefault(path, []).extend(added)
        return added

    def _add_group(
        self, mapped: MappedPorts, port: ResolvedPort, path: Path, used: tuple[set[str], set[str]], *, is_inverse: bool
    ) -> list[MappedPort]:
        resolved = self._resolver.resolve(port.use)
        if resolved is None or len(path) > _MAX_GROUP_DEPTH:
            words = f"what is in feature group {port.written.name} is not known"
            self._notes.add("feature group", words, port.written.span)
            return []
        inner_ports = resolved.ports
        if not inner_ports and resolved.known.classifier.inverse_of:
            use = self._resolver.find_use(resolved.known.classifier.inverse_of, {}, resolved.known, {})
            inverse = self._resolver.resolve(use)
            inner_ports, is_inverse = (inverse.ports if inverse else {}), not is_inverse
        added: list[MappedPort] = []
        for inner in inner_ports.values():
            if len(mapped.ports) > _MAX_PORTS:
                self._notes.add(
                    "feature group",
                    f"feature groups in one another are more than {_MAX_PORTS:,} ports",
                    port.written.span,
                )
                break
            added += self._add_port(mapped, inner, path, used, is_inverse=is_inverse)
        return added


COMPONENT_CATEGORIES = frozenset({"system", "process", "device", "abstract", "thread", "thread group"})
HARDWARE_CATEGORIES = frozenset({"processor", "virtual processor", "memory", "bus", "virtual bus"})
_MAX_LEVELS = 40
WIRE_KINDS = frozenset(
    [
        *("port", "data port", "event port", "event data port", "feature group", "port group", "feature"),
        "subprogram access",
    ]
)


@dataclass(slots=True, eq=False)
class StructuredPart:
    """A part that is a component: the id that it gets, and how it is built (None where its classifier is in no file)."""

    id: str
    part: ResolvedPart
    structure: ClassifierStructure | None

    @property
    def name(self) -> str:
        """Return its name in lower case."""
        return self.part.written.name.lower()


@dataclass(frozen=True, slots=True)
class WireEnd:
    """An end of a wire: a port of a part, or of the classifier itself where `part` is None."""

    part: StructuredPart | None
    port: MappedPort


@dataclass(frozen=True, slots=True)
class Wire:
    """Data that flows from an end to another, by a connection."""

    producer: WireEnd
    consumer: WireEnd
    connection: AadlConnection


@dataclass(slots=True, eq=False)
class ClassifierStructure:
    """How a classifier is built."""

    resolved: ResolvedClassifier
    ports: MappedPorts
    parts: dict[str, StructuredPart] = field(default_factory=dict)
    wires: list[Wire] = field(default_factory=list)
    thread: ResolvedPart | None = None
    """The only thread of a process, which is one component with it."""
    thread_ports: dict[tuple[str, bool], str] = field(default_factory=dict)
    """The ports of that thread behind those of the process, by id and whether they are inputs."""
    access_connections: dict[str, AadlConnection] = field(default_factory=dict)

    _inner_ends: dict[int, list[WireEnd]] | None = None
    _wires_by_name: dict[str, list[Wire]] | None = None

    def find_inner_ends(self, port: MappedPort) -> list[WireEnd]:
        """Return the ports of its parts that stand behind one of its own, each once."""
        if self._inner_ends is None:
            ends: dict[int, dict[WireEnd, None]] = {}
            for wire in self.wires:
                for outer, inner in ((wire.producer, wire.consumer), (wire.consumer, wire.producer)):
                    if outer.part is None and inner.part is not None:
                        ends.setdefault(id(outer.port), {})[inner] = None
            self._inner_ends = {key: list(inner_ends) for key, inner_ends in ends.items()}
        return self._inner_ends.get(id(port), [])

    def find_wires(self, connection_name: str) -> list[Wire]:
        """Return the wires of a connection, by its name in lower case."""
        if self._wires_by_name is None:
            self._wires_by_name = {}
            for wire in self.wires:
                self._wires_by_name.setdefault(wire.connection.name.lower(), []).append(wire)
        return self._wires_by_name.get(connection_name, [])

    @property
    def is_node(self) -> bool:
        """Whether it is one program: a process."""
        return self.resolved.category == "process"


class StructureFinder:
    """Finds how classifiers are built, each once."""

    def __init__(self, resolver: ClassifierResolver, mapper: PortMapper) -> None:
        self._resolver, self._mapper, self._notes = resolver, mapper, resolver.notes
        self._found: dict[int, ClassifierStructure] = {}
        self._open: list[ResolvedClassifier] = []

    def find(self, resolved: ResolvedClassifier) -> ClassifierStructure:
        """Return how a classifier is built."""
        if id(resolved) not in self._found:
            self._open.append(resolved)
            self._found[id(resolved)] = self._build(resolved)
            self._open.pop()
        return self._found[id(resolved)]

    def _build(self, resolved: ResolvedClassifier) -> ClassifierStructure:
        structure = ClassifierStructure(resolved, self._mapper.map_ports(resolved))
        # What each node has from the library, such as its main thread, is no behaviour of its own.
        parts = [
            part
            for part in resolved.parts.values()
            if part.category in COMPONENT_CATEGORIES
            and not part.owner.is_of_library
            # Else it is that of a component that is a program here: it tells what stands on a bus.
            and not (part.category == "device" and self._read_own_text(resolved, part, "component"))
        ]
        if resolved.category == "process" and len(parts) == 1 and parts[0].category == "thread":
            structure.thread = parts[0]
            self._join_thread(structure, parts[0])
            parts = []
        used_ids: set[str] = set()
        for part in parts:
            if structured := self._build_part(resolved, part, used_ids):
                structure.parts[structured.name] = structured
        self._add_wires(structure)
        return structure

    def _build_part(self, around: ResolvedClassifier, part: ResolvedPart, used_ids: set[str]) -> StructuredPart | None:
        inner = self._resolver.resolve(part.use)
        if inner is not None and (inner in self._open or len(self._open) > _MAX_LEVELS):
            words = (
                f"{part.written.name} is within itself in the end"
                if inner in self._open
                else f"more than {_MAX_LEVELS} levels of parts"
            )
            self._notes.add_contradiction("subcomponent", words, part.written.span)
            return None
        structure = self.find(inner) if inner else None
        if structure and part.category == "system" and _is_only_hardware(structure):
            return None
        if part.written.dimensions:
            self._notes.add_counted(
                "array of subcomponents", "an array of subcomponents is taken as one", part.written.span, fate="noted"
            )
        part_id = make_unique_id(
            make_id(self._read_own_text(around, part, "id") or part.written.name, "part"), used_ids
        )
        used_ids.add(part_id)
        return StructuredPart(part_id, part, structure)

    def _read_own_text(self, around: ResolvedClassifier, part: ResolvedPart, key: str) -> str:
        """Return what an export of archgen's wrote at a part, or nothing."""
        scope = PropertyScope(self._resolver, around)
        return find_own_text(scope, (part.written.name.lower(),), key)

    def _join_thread(self, structure: ClassifierStructure, thread: ResolvedPart) -> None:
        """Find which port of the thread stands behind which of the process."""
        name = thread.written.name.lower()
        for connection in structure.resolved.connections.values():
            ends = [fold_part_path(connection.source), fold_part_path(connection.target)]
            inside = next((end[1:] for end in ends if len(end) > 1 and end[0] == name), None)
            outside = next((end for end in ends if end and end[0] != name), None)
            if connection.kind not in WIRE_KINDS:
                structure.access_connections[connection.name] = connection
            elif inside and outside:
                for port in structure.ports.by_path.get(outside, ()):
                    structure.thread_ports[port.id, port.is_input] = ".".join(inside)

    def _add_wires(self, structure: ClassifierStructure) -> None:
        if structure.thread is not None:
            return
        for connection in structure.resolved.connections.values():
            if connection.kind not in WIRE_KINDS:
                structure.access_connections[connection.name] = connection
                continue
            sources, targets = (
                self._list_ends(structure, connection.source),
                self._list_ends(structure, connection.target),
            )
            wires = list(_join_ends(sources, targets, connection))
            if not wires and sources is not None and targets is not None:
                words = f"connection {connection.name} joins no output to an input".replace("  ", " ")
                self._notes.add("connection", words, connection.span, "are its ends called so, and in the right order?")
            structure.wires += wires

    def _list_ends(self, structure: ClassifierStructure, written_path: Path) -> list[tuple[Path, WireEnd]] | None:
        """Return the ports that an end of a connection means, with their paths below it; None if it is no component's."""
        path = fold_part_path(written_path)
        if not path:
            return []
        part = structure.parts.get(path[0]) if len(path) > 1 else None
        if part is None and len(path) > 1 and path[0] in structure.resolved.parts:
            return None
        if part is not None and part.structure is None:
            return None
        ports = part.structure.ports if part and part.structure else structure.ports
        port_path = path[1:] if part else path
        if port_path in ports.groups:
            return [(port.path[len(port_path) :], WireEnd(part, port)) for port in ports.groups[port_path]]
        if ".".join(port_path) in ports.accesses or port_path in ports.call_paths:
            return None
        return [((), WireEnd(part, port)) for port in ports.by_path.get(port_path, ())]


def _join_ends(
    sources: list[tuple[Path, WireEnd]] | None, targets: list[tuple[Path, WireEnd]] | None, connection: AadlConnection
) -> Iterator[Wire]:
    """Yield who sends to whom: ends of feature groups are joined by their names below the group."""
    targets_by_path: dict[Path, list[WireEnd]] = {}
    for path, end in targets or ():
        targets_by_path.setdefault(path, []).append(end)
    for path, source in sources or ():
        for target in targets_by_path.get(path, ()):
            if _is_sending(source) and not _is_sending(target):
                yield Wire(source, target, connection)
            elif _is_sending(target) and not _is_sending(source):
                yield Wire(target, source, connection)


def _is_sending(end: WireEnd) -> bool:
    """Whether data comes out of an end: out of a part's output, or into the classifier by its own input."""
    return end.port.is_input == (end.part is None)


def _is_only_hardware(structure: ClassifierStructure) -> bool:
    parts = structure.resolved.parts.values()
    return (
        not structure.parts
        and not structure.ports.ports
        and any(part.category in HARDWARE_CATEGORIES for part in parts)
    )


def fold_part_path(path: Path) -> Path:
    """Return a path as it is compared: in lower case, without `self`."""
    return tuple(step.lower() for step in path if step.lower() != "self")
