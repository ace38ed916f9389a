"""Systems that are part of no other become groups: their components, who feeds whom, and which programs there are."""

from __future__ import annotations

from dataclasses import dataclass, field

from archgen.plugin.importing import make_id, make_unique_id
from archgen.plugins.aadl.aadl_tree import Path
from archgen.plugins.aadl.archgen_words import find_own_text, read_component_words
from archgen.plugins.aadl.component_bodies import Body, ComponentBuilder, join_input, reach_port, set_media
from archgen.plugins.aadl.element_hints import keep_sources, keep_structure
from archgen.plugins.aadl.model_roots import ModelRoots
from archgen.plugins.aadl.port_mapping import MappedPort
from archgen.plugins.aadl.property_values import PropertyScope
from archgen.plugins.aadl.resolved_classifiers import ClassifierResolver
from archgen.plugins.aadl.structures import ClassifierStructure, StructuredPart, WireEnd

PortPlace = tuple[Path, bool, str]
"""A port of a process or device: where that stands, whether it is an input, and the port's id."""


@dataclass(slots=True)
class GroupFrame:
    """A system whose parts are components of a group: `path` leads to it from its root."""

    group_id: str
    structure: ClassifierStructure
    scope: PropertyScope
    path: Path
    bodies: dict[str, Body] = field(default_factory=dict)


@dataclass(slots=True)
class ProcessInstance:
    """A process or device where it stands: its ids from the group on, and its names in AADL from the root on."""

    ids: tuple[str, ...]
    path: Path
    structure: ClassifierStructure
    scope: PropertyScope
    is_of_type: bool


@dataclass(slots=True)
class LaunchedSystem:
    """A root: what stands in it, for hosts, links and chains."""

    name: str
    structure: ClassifierStructure
    scope: PropertyScope
    frames: list[GroupFrame]
    instances: dict[Path, ProcessInstance] = field(default_factory=dict)
    topics: dict[PortPlace, list[str]] = field(default_factory=dict)
    senders: dict[PortPlace, list[PortPlace]] = field(default_factory=dict)
    """Who sends what an input reads, by connections that name a topic."""
    containers: dict[Path, str] = field(default_factory=dict)
    """Virtual processors that are containers, by id."""
    contained: dict[Path, str] = field(default_factory=dict)
    """In which container a program runs."""
    lone_buses: dict[str, Body] = field(default_factory=dict)
    """What is kept of buses that join fewer than two."""
    groups: dict[str, str] = field(default_factory=dict)
    """Groups by the names of the parts of the root that they are."""
    frames_by_path: dict[Path, GroupFrame] = field(default_factory=dict)

    def find_frame(self, path: Path) -> GroupFrame | None:
        """Return the group that stands at a path."""
        if not self.frames_by_path:
            self.frames_by_path = {frame.path: frame for frame in self.frames}
        return self.frames_by_path.get(path)


class GroupBuilder:
    """Builds the groups of all roots."""

    def __init__(self, resolver: ClassifierResolver, roots: ModelRoots, builder: ComponentBuilder) -> None:
        self.groups: dict[str, Body] = {}
        self.systems: list[LaunchedSystem] = []
        self._resolver, self._roots, self._builder = resolver, roots, builder

    def add_root(self, root: ClassifierStructure) -> None:
        """Build the groups of a root."""
        scope = PropertyScope(self._resolver, root.resolved)
        system = LaunchedSystem(root.resolved.known.full_name, root, scope, [])
        parts = list(root.parts.values())
        grouped = {part.name: part for part in parts if self._is_group(part)}
        for part in grouped.values():
            if part.structure:
                inner_scope = scope.go_into(part.part, part.structure.resolved)
                group_id = self._open_group(part.id, part.part.written.name, part.structure, inner_scope)
                frame = GroupFrame(group_id, part.structure, inner_scope, (part.name,))
                system.groups[part.name] = frame.group_id
                self._add_components(frame, list(part.structure.parts.values()))
                system.frames.append(frame)
        if loose := [part for part in parts if part.name not in grouped]:
            name = root.resolved.known.classifier.name.partition(".")[0]
            wanted = make_id(find_own_text(scope, (), "id") or name, "group")
            frame = GroupFrame(
                self._open_group(wanted, root.resolved.known.classifier.name, root, scope), root, scope, ()
            )
            self._add_components(frame, loose)
            system.frames.append(frame)
        for frame in system.frames:
            self._wire_frame(system, frame)
        if grouped:
            self._wire_groups(system)
        self.systems.append(system)

    def _is_group(self, part: StructuredPart) -> bool:
        structure = part.structure
        return (
            part.part.category == "system"
            and structure is not None
            and bool(structure.parts)
            and self._roots.is_single(structure)
        )

    def _open_group(self, wanted_id: str, name: str, structure: ClassifierStructure, scope: PropertyScope) -> str:
        group_id = make_unique_id(wanted_id, self.groups.keys())
        hints: Body = {}
        if not self._resolver.names.is_own:
            hints = {"name": name} if name != group_id else {}
            hints["classifier"] = structure.resolved.known.full_name
        own_scope = PropertyScope(self._resolver, structure.resolved)
        hints |= keep_sources(own_scope, ()) | keep_structure(structure, scope)
        kept = {"hints": {"aadl": hints}} if hints else {}
        # What archgen says of the launch as a whole is the project's.
        words = read_component_words(scope) if scope.layers else {}
        self.groups[group_id] = {**words, **kept, "components": {}}
        return group_id

    def _add_components(self, frame: GroupFrame, parts: list[StructuredPart]) -> None:
        for part in parts:
            frame.bodies[part.id] = self._builder.build_instance(part, frame.scope)
        self.groups[frame.group_id]["components"].update(frame.bodies)

    def _wire_frame(self, system: LaunchedSystem, frame: GroupFrame) -> None:
        """Join the parts of a frame; what leads out of the robot is external."""
        is_root = frame.structure is system.structure
        for wire in frame.structure.wires:
            producer, consumer = wire.producer, wire.consumer
            from_here = producer.part is not None and producer.part.id in frame.bodies
            to_here = consumer.part is not None and consumer.part.id in frame.bodies
            if from_here and to_here and producer.part and consumer.part:
                reference = f"{frame.group_id}.{producer.part.id}.{producer.port.id}"
                body = reach_port(frame.bodies[consumer.part.id], "inputs", consumer.port.id)
                join_input(body, reference, producer.port, consumer.port)
            elif is_root and to_here and producer.part is None and consumer.part:
                body = reach_port(frame.bodies[consumer.part.id], "inputs", consumer.port.id)
                body["external"] = producer.port.written_name
            elif is_root and from_here and consumer.part is None and producer.part:
                body = reach_port(frame.bodies[producer.part.id], "outputs", producer.port.id)
                body["external"] = consumer.port.written_name
        set_media(frame.structure, frame.bodies, frame.scope)

    def _wire_groups(self, system: LaunchedSystem) -> None:
        frames = {frame.path[0]: frame for frame in system.frames if frame.path}
        root_frame = next((frame for frame in system.frames if not frame.path), None)
        for wire in system.structure.wires:
            references = _list_references(wire.producer, frames, root_frame)
            bodies = _list_bodies(wire.consumer, frames, root_frame, is_input=True)
            for body in bodies:
                for reference in references:
                    join_input(body, reference, wire.producer.port, wire.consumer.port)
                if wire.producer.part is None:
                    body["external"] = wire.producer.port.written_name
            if wire.consumer.part is None:
                for body in _list_bodies(wire.producer, frames, root_frame, is_input=False):
                    body["external"] = wire.consumer.port.written_name


def _list_references(end: WireEnd, frames: dict[str, GroupFrame], root_frame: GroupFrame | None) -> list[str]:
    """Return the outputs of components that stand behind an output of a part of a root."""
    if end.part is None:
        return []
    frame = frames.get(end.part.name)
    if frame is None:
        return [f"{root_frame.group_id}.{end.part.id}.{end.port.id}"] if root_frame else []
    return [
        f"{frame.group_id}.{inner.part.id}.{inner.port.id}"
        for inner in frame.structure.find_inner_ends(end.port)
        if inner.part
    ]


def _list_bodies(
    end: WireEnd, frames: dict[str, GroupFrame], root_frame: GroupFrame | None, *, is_input: bool
) -> list[Body]:
    """Return the ports of components that stand behind a port of a part of a root."""
    if end.part is None:
        return []
    section = "inputs" if is_input else "outputs"
    frame = frames.get(end.part.name)
    if frame is None:
        return [reach_port(root_frame.bodies[end.part.id], section, end.port.id)] if root_frame else []
    return [
        reach_port(frame.bodies[inner.part.id], section, inner.port.id)
        for inner in frame.structure.find_inner_ends(end.port)
        if inner.part
    ]


def list_ports_behind_end(end: WireEnd, place: Path) -> list[tuple[Path, MappedPort]]:
    """Return the ports of processes and devices that stand behind an end of a wire, with their paths; `place` is the wire's."""
    leaves: list[tuple[Path, MappedPort]] = []
    waiting, seen = [(place, end)], set[tuple[Path, MappedPort]]()
    while waiting:
        around, inner = waiting.pop()
        if inner.part is None:
            continue
        path, structure = (*around, inner.part.name), inner.part.structure
        if (path, inner.port) in seen:
            # Several ways may lead to it: each level may double them.
            continue
        seen.add((path, inner.port))
        if structure is None or structure.is_node or not structure.parts:
            leaves.append((path, inner.port))
        else:
            waiting += [(path, each) for each in reversed(structure.find_inner_ends(inner.port))]
    return leaves
