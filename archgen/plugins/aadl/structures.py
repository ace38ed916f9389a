"""How a classifier is built: its parts that are components, its hardware, and who sends to whom among them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from archgen.plugin.importing import make_id, make_unique_id
from archgen.plugins.aadl.aadl_tree import AadlConnection, Path
from archgen.plugins.aadl.archgen_words import find_own_text
from archgen.plugins.aadl.port_mapping import MappedPort, MappedPorts, PortMapper
from archgen.plugins.aadl.property_values import PropertyScope
from archgen.plugins.aadl.resolved_classifiers import ClassifierResolver, ResolvedClassifier, ResolvedPart

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
