"""Go through all instances of a root system: programs, topics, hosts, links."""

from __future__ import annotations

from archgen.plugin.importing import make_id, make_unique_id
from archgen.plugins.aadl.aadl_tree import Path
from archgen.plugins.aadl.archgen_words import find_own_text, read_node_words
from archgen.plugins.aadl.component_bodies import Body, map_node_ports, name_use_section
from archgen.plugins.aadl.element_hints import keep_sources
from archgen.plugins.aadl.port_mapping import MappedPort
from archgen.plugins.aadl.property_values import PropertyScope, read_first_text
from archgen.plugins.aadl.robot_groups import (
    LaunchedSystem,
    ModelRoots,
    PortPlace,
    ProcessInstance,
    list_ports_behind_end,
)
from archgen.plugins.aadl.structures import ClassifierStructure, StructuredPart, WireEnd

MAX_INSTANCES = 50_000


class TooManyInstancesError(Exception):
    """A root has more instances than anybody wants to read."""


def find_instances(system: LaunchedSystem, roots: ModelRoots) -> None:
    """Find the processes and devices of a root, and the names of their topics. Raise TooManyInstancesError."""
    if _count_instances(system.structure, {}) > MAX_INSTANCES:
        raise TooManyInstancesError
    _find_topics(system, system.structure, system.scope, ())
    for frame in system.frames:
        if frame.path:
            _find_topics(system, frame.structure, frame.scope, frame.path)
        group = ProcessInstance((frame.group_id,), frame.path, frame.structure, frame.scope, is_of_type=False)
        for part in frame.structure.parts.values():
            if part.id in frame.bodies:
                _walk_part(system, roots, part, group)


def _count_instances(structure: ClassifierStructure, counts_by_id: dict[int, int]) -> int:
    """Return how many parts a structure has, to any depth; `counts_by_id` has those that were counted."""
    if id(structure) not in counts_by_id:
        inner = (part.structure for part in structure.parts.values() if part.structure and not structure.is_node)
        counts_by_id[id(structure)] = sum(1 + _count_instances(each, counts_by_id) for each in inner)
    return counts_by_id[id(structure)]


def _walk_part(system: LaunchedSystem, roots: ModelRoots, part: StructuredPart, around: ProcessInstance) -> None:
    structure = part.structure
    if structure is None:
        return
    scope = around.scope.go_into(part.part, structure.resolved)
    is_of_type = around.is_of_type or bool(roots.find_type_id(structure))
    instance = ProcessInstance((*around.ids, part.id), (*around.path, part.name), structure, scope, is_of_type)
    system.instances[instance.path] = instance
    if structure.is_node:
        return
    _find_topics(system, structure, scope, instance.path)
    for inner in structure.parts.values():
        _walk_part(system, roots, inner, instance)


def _find_topics(system: LaunchedSystem, structure: ClassifierStructure, scope: PropertyScope, path: Path) -> None:
    for wire in structure.wires:
        if not wire.connection.name:
            continue
        name = read_first_text(scope.value((wire.connection.name.lower(),), "topic_properties::name"))
        if not name:
            continue
        producers, consumers = _list_leaves(wire.producer, path), _list_leaves(wire.consumer, path)
        for leaf in (*producers, *consumers):
            topics = system.topics.setdefault(leaf, [])
            if name not in topics:
                topics.append(name)
        for leaf in consumers:
            system.senders.setdefault(leaf, []).extend(producers)


def _list_leaves(end: WireEnd, path: Path) -> list[PortPlace]:
    """Return the ports of processes and devices behind an end of a wire."""
    return [(leaf_path, port.is_input, port.id) for leaf_path, port in list_ports_behind_end(end, path)]


class NodeWriter:
    """Writes a node for each process where it stands."""

    def __init__(self) -> None:
        self.nodes: dict[str, Body] = {}

    def add_nodes(self, system: LaunchedSystem, hosts: dict[Path, str]) -> None:
        """Write the programs of a root; `hosts` are those of its instances."""
        fed = _find_fed_ports(system)
        for instance in system.instances.values():
            if not instance.structure.is_node:
                continue
            body = self._describe_node(system, instance, fed)
            if container := system.contained.get(instance.path):
                body["container"] = container
            elif host := hosts.get(instance.path):
                body["host"] = host
            wanted = find_own_text(instance.scope, (), "node") or instance.ids[-1]
            if wanted in self.nodes:
                wanted = "_".join(instance.ids)
            node_id = make_unique_id(make_id(wanted, "node"), self.nodes.keys())
            self.nodes[node_id] = {"implements": ".".join(instance.ids), **body}

    def _describe_node(self, system: LaunchedSystem, instance: ProcessInstance, fed: set[PortPlace]) -> Body:
        scope = instance.scope
        default_uses = map_node_ports(instance.structure, scope, is_type=False)
        written_uses = default_uses
        if instance.is_of_type:
            written_uses = map_node_ports(instance.structure, scope.only_around(), is_type=False)
        body: Body = {}
        for port in instance.structure.ports.ports:
            section = name_use_section(is_input=port.is_input, is_call=port.is_call)
            use = dict(written_uses.get(section, {}).get(port.id, {}))
            use.pop("own_name", None)
            default_name = default_uses.get(section, {}).get(port.id, {}).get("own_name", "")
            use |= _name_topic(
                system, instance, port, default_name, is_fed=(instance.path, port.is_input, port.id) in fed
            )
            if use:
                body.setdefault(section, {})[port.id] = use
        body |= read_node_words(scope)
        around = keep_sources(scope.only_around(), ())
        return {**body, "hints": {"aadl": around}} if around else body


def _name_topic(
    system: LaunchedSystem, instance: ProcessInstance, port: MappedPort, default_name: str, *, is_fed: bool
) -> Body:
    """Return the topic or name of a port, and what the program itself calls it."""
    key = "name" if port.is_call else "topic"
    place = (instance.path, port.is_input, port.id)
    topics = system.topics.get(place, [])
    has_choice = any(len(system.topics.get(sender, [])) > 1 for sender in system.senders.get(place, []))
    # A reader's topic is its producer's, unless that has several.
    if is_fed and not has_choice:
        return {"own_name": default_name} if default_name and default_name not in topics else {}
    if not topics and not default_name:
        return {}
    use: Body = {key: topics if len(topics) > 1 and not port.is_call else (topics or [default_name])[0]}
    if default_name and len(topics) == 1 and topics != [default_name]:
        use["own_name"] = default_name
    if use[key] == "/" + "/".join((*instance.ids, port.id)):
        # It is so where nothing is written.
        del use[key]
    return use


def _find_fed_ports(system: LaunchedSystem) -> set[PortPlace]:
    """Return the inputs of programs that a wire feeds."""
    fed: set[PortPlace] = set()
    containers: list[tuple[ClassifierStructure, Path]] = [(system.structure, ())]
    containers += [(frame.structure, frame.path) for frame in system.frames if frame.path]
    containers += [(inst.structure, inst.path) for inst in system.instances.values() if not inst.structure.is_node]
    for structure, path in containers:
        for wire in structure.wires:
            fed.update(_list_leaves(wire.consumer, path) if wire.producer.part else ())
    return fed
