"""Go through all instances of a root system: programs, topics, hosts, links; end to end flows become chains."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.plugin import dataclass
from archgen.plugin.importing import make_id, make_unique_id
from archgen.plugins.aadl.aadl_tree import AadlFlow, Path
from archgen.plugins.aadl.archgen_words import find_own_text, find_own_texts, read_node_words
from archgen.plugins.aadl.component_bodies import Body, map_node_ports, name_use_section
from archgen.plugins.aadl.element_hints import keep_sources
from archgen.plugins.aadl.import_notes import NoteList
from archgen.plugins.aadl.property_values import PropertyScope, read_first_text, read_time_range
from archgen.plugins.aadl.robot_groups import (
    LaunchedSystem,
    ModelRoots,
    PortPlace,
    ProcessInstance,
    list_ports_behind_end,
)
from archgen.plugins.aadl.structures import ClassifierStructure, MappedPort, StructuredPart, WireEnd

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


@dataclass(frozen=True, slots=True)
class _FlowPlace:
    """Where end to end flows stand: the ids from the group on, and what archgen says of the flows there, by their names."""

    structure: ClassifierStructure
    scope: PropertyScope
    ids: tuple[str, ...]
    own_words: Mapping[str, Mapping[str, str]]


class ChainMapper:
    """Makes the chains of all roots."""

    def __init__(self, notes: NoteList) -> None:
        self.chains: dict[str, Body] = {}
        self._notes = notes

    def add_chains(self, system: LaunchedSystem) -> None:
        """Add the end to end flows of a root, of its groups, and of the components in them."""
        group_of_root = next((frame.group_id for frame in system.frames if not frame.path), "")
        places: list[tuple[ClassifierStructure, PropertyScope, tuple[str, ...]]] = [
            (system.structure, system.scope, (group_of_root,))
        ]
        places += [(frame.structure, frame.scope, (frame.group_id,)) for frame in system.frames if frame.path]
        places += [(inst.structure, inst.scope, inst.ids) for inst in system.instances.values() if inst.structure.parts]
        for structure, scope, ids in places:
            own_words = {key: find_own_texts(scope, (), key) for key in ("flow_ways", "flow_ids", "flow_titles")}
            for flow in structure.resolved.flows.values():
                if flow.kind == "end to end":
                    self._add_chain(system, _FlowPlace(structure, scope, ids, own_words), flow)

    def _add_chain(self, system: LaunchedSystem, place: _FlowPlace, flow: AadlFlow) -> None:
        own_way = place.own_words["flow_ways"].get(flow.name, "")
        through = own_way.split(", ") if own_way else []
        known = {".".join(instance.ids) for instance in system.instances.values()} if own_way else set()
        if gone := next((each for each in through if "." in each and each not in known), None):
            words = f"`{gone}` of archgen::Flow_Ways is no component any more: flow {flow.name} leads as its steps do"
            self._notes.add_contradiction("end to end flow", words, flow.span)
            through = []
        for step in () if through else flow.steps:
            if _leads_nowhere(place.structure, step):
                words = f"step {'.'.join(step)} of flow {flow.name} is neither a part nor a connection; it is left out"
                self._notes.add_contradiction("end to end flow", words, flow.span)
            for reference in _name_step(system, place.structure, place.ids, step):
                if not through or through[-1] != reference:
                    through.append(reference)
        if len(through) <= 1:
            words = f"flow {flow.name} leads through fewer than two components"
            self._notes.add("end to end flow", words, flow.span)
            return
        own_id = place.own_words["flow_ids"].get(flow.name, "")
        chain_id = make_unique_id(make_id(own_id or flow.name, "chain"), self.chains.keys())
        body: Body = {"through": through}
        if title := place.own_words["flow_titles"].get(flow.name):
            body["title"] = title
        lowest, highest = read_time_range(place.scope.value((flow.name.lower(),), "latency"))
        body |= {"deadline": highest} if highest else {}
        hints = {"name": flow.name} if flow.name != chain_id and not own_id else {}
        if lowest and lowest != highest and not lowest.startswith("0 "):
            hints["shortest"] = lowest
        self.chains[chain_id] = {**body, "hints": {"aadl": hints}} if hints else body


def _leads_nowhere(structure: ClassifierStructure, step: Path) -> bool:
    """Whether a step of a flow names nothing that stands there."""
    name, resolved = step[0].lower(), structure.resolved
    return not any(name in known for known in (resolved.parts, resolved.connections, resolved.ports)) and not any(
        (name, is_inner) in resolved.flows for is_inner in (False, True)
    )


def _name_step(
    system: LaunchedSystem, structure: ClassifierStructure, ids: tuple[str, ...], step: Path
) -> Iterator[str]:
    """Yield the components that a step of a flow leads through; a connection is none."""
    names = tuple(name.lower() for name in step)
    part = structure.parts.get(names[0])
    if part is None:
        return
    group_id = system.groups.get(part.name) if structure is system.structure else None
    if group_id is None:
        yield ".".join((*ids, part.id))
        return
    if part.structure is not None and len(names) > 1:
        yield from _go_through(part.structure, group_id, names[1])


def _go_through(structure: ClassifierStructure, group_id: str, flow_name: str) -> Iterator[str]:
    """Yield the components of a group through which its own flow leads."""
    flow = structure.resolved.flows.get((flow_name, True))
    for step in flow.steps if flow else ():
        if part := structure.parts.get(step[0].lower()):
            yield f"{group_id}.{part.id}"
