"""Systems that are part of no other become groups: their components, who feeds whom, and which programs there are.

Which systems are launch files, which classifiers become component types, and what is written in place.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from archgen.plugin.importing import make_id, make_unique_id
from archgen.plugins.aadl.aadl_tree import Path
from archgen.plugins.aadl.archgen_words import find_own_text, read_component_words
from archgen.plugins.aadl.classifier_names import KnownClassifier, find_only_implementations
from archgen.plugins.aadl.component_bodies import Body, ComponentBuilder, join_input, reach_port, set_media
from archgen.plugins.aadl.element_hints import keep_sources, keep_structure
from archgen.plugins.aadl.property_values import PropertyScope, fold_value, read_first_text
from archgen.plugins.aadl.resolved_classifiers import ClassifierResolver
from archgen.plugins.aadl.structures import ClassifierStructure, MappedPort, StructuredPart, StructureFinder, WireEnd

_TYPE_CATEGORIES = frozenset({"system", "process", "device", "abstract"})


class ModelRoots:
    """The systems that are part of no other, and the component types by id."""

    def __init__(self, resolver: ClassifierResolver, finder: StructureFinder) -> None:
        self.roots: list[ClassifierStructure] = []
        self.types: dict[str, ClassifierStructure] = {}
        self._resolver, self._finder = resolver, finder
        self._uses: dict[int, int] = {}
        self._used_structures: dict[int, ClassifierStructure] = {}
        self._extended: set[int] = set()
        self._part_keys: set[str] = set()
        self._type_ids: dict[int, str] = {}
        self._only: dict[str, KnownClassifier] = {}
        self._root_ids: set[int] = set()
        self._find_all()

    def find_type_id(self, structure: ClassifierStructure) -> str:
        """Return the id of the component type that a structure is, or nothing."""
        return self._type_ids.get(id(structure), "")

    def find_base_id(self, structure: ClassifierStructure) -> str:
        """Return the component type from which another one is made, or nothing."""
        known = structure.resolved.known
        name = known.classifier.extends
        if not name and known.classifier.is_implementation:
            own_type = self._resolver.names.find(known.classifier.name.partition(".")[0], known.package)
            name, known = (own_type.classifier.extends, own_type) if own_type else ("", known)
        base = self._resolver.names.find(name, known.package) if name else None
        # Where more extend one another than are followed, it is none of the ancestors.
        if base is None or base is structure.resolved.known or base not in structure.resolved.ancestors:
            return ""
        return self._type_ids.get(id(self._find_structure(base)), "")

    def is_single(self, structure: ClassifierStructure) -> bool:
        """Whether something stands in one place alone, and is no component type."""
        return self._uses.get(id(structure), 0) == 1 and id(structure) not in self._type_ids

    def _find_all(self) -> None:
        known_classifiers = list(self._resolver.names.known.values())
        self._only = find_only_implementations(self._resolver.names)
        implemented = {entry.key.partition(".")[0] for entry in known_classifiers if entry.classifier.is_implementation}
        extended_keys = self._list_named(known_classifiers)
        for known in known_classifiers:
            if known.classifier.category != "system" or not known.classifier.is_implementation:
                continue
            # What is neither a part nor extended stands for itself: AADL does not say which systems are instantiated.
            if known.key not in self._part_keys and known.key not in extended_keys:
                self.roots.append(self._find_structure(known))
        self._root_ids = {id(root) for root in self.roots}
        for root in self.roots:
            self._count_uses(root)
        for known in known_classifiers:
            if known.classifier.category in _TYPE_CATEGORIES and not known.is_of_library:
                self._add_unused(known, implemented, extended_keys)
        for structure in list(self._used_structures.values()):
            self._name_type(structure)

    def _add_unused(self, known_classifier: KnownClassifier, implemented: set[str], extended_keys: set[str]) -> None:
        """Count what stands in no system: it becomes a component type, too."""
        structure = self._find_structure(known_classifier)
        is_told_otherwise = known_classifier.key in implemented and known_classifier.key not in self._part_keys
        if is_told_otherwise or id(structure) in self._root_ids or not _has_content(structure):
            return
        if known_classifier.key in extended_keys and known_classifier.key not in self._only:
            self._extended.add(id(structure))
        if id(structure) not in self._uses:
            self._uses[id(structure)] = 0
            self._count_uses(structure)
            self._used_structures[id(structure)] = structure

    def _find_structure(self, known_classifier: KnownClassifier) -> ClassifierStructure:
        return self._finder.find(self._resolver.resolve_known(known_classifier))

    def _list_named(self, known_classifiers: list[KnownClassifier]) -> set[str]:
        """Return the keys of what is extended; remember those of what is a part."""
        extended: set[str] = set()
        names = self._resolver.names
        for known in known_classifiers:
            classifier = known.classifier
            if classifier.extends and (base := names.find(classifier.extends, known.package)):
                extended.add(base.key)
            for part in classifier.subcomponents:
                if part.classifier and (found := names.find(part.classifier, known.package)):
                    self._part_keys.add(found.key)
        return extended

    def _count_uses(self, structure: ClassifierStructure) -> None:
        # Without recursion: parts may nest as deep as the file likes, and many stand in the same structure.
        waiting = [structure]
        while waiting:
            for part in waiting.pop().parts.values():
                inner = part.structure
                if inner is None:
                    continue
                self._uses[id(inner)] = self._uses.get(id(inner), 0) + 1
                # Each structure is entered once: doubled parts, twenty levels deep, would be a million ways.
                if id(inner) not in self._used_structures:
                    self._used_structures[id(inner)] = inner
                    waiting.append(inner)

    def _name_type(self, structure: ClassifierStructure) -> None:
        """Give a structure an id as a component type, if it is one."""
        category = structure.resolved.category
        if category not in _TYPE_CATEGORIES and category != "thread group":
            return
        written = structure.resolved.properties.get(((), "archgen::component_type"))
        wanted = read_first_text(fold_value(written.value, self._resolver.names)) if written else ""
        is_reused = self._uses.get(id(structure), 0) != 1 or id(structure) in self._extended
        if not (wanted or is_reused or self._has_reused_base(structure)):
            return
        known = structure.resolved.known
        type_key = known.key.partition(".")[0]
        name = known.classifier.name
        if self._only.get(type_key) is known and type_key not in self._part_keys:
            name = name.partition(".")[0]
        self._type_ids[id(structure)] = make_unique_id(make_id(wanted or name, "type"), self.types.keys())
        self.types[self._type_ids[id(structure)]] = structure

    def _has_reused_base(self, structure: ClassifierStructure) -> bool:
        """Whether it extends what is a component type: then it is one, made from that."""
        return any(
            entry.classifier.category in _TYPE_CATEGORIES and id(self._find_structure(entry)) in self._extended
            for entry in structure.resolved.ancestors
        )


def _has_content(structure: ClassifierStructure) -> bool:
    """Whether a classifier says anything that a component type can have; bases of a library often do not."""
    return bool(structure.ports.ports or structure.parts or structure.thread)


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
