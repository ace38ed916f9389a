"""What nodes are called in programs that generators make: packages, programs, and the names that nodes of one program share.

Scripts, launch files and generated code ask here, so that what one of them writes fits what the others do.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence

from archgen.derivation.ros_names import shared_topic_names
from archgen.derivation.wire.wire_names import ACTION_PARTS, NodeNames, list_written_remaps
from archgen.frozen import dataclass
from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture
from archgen.model.code_names import make_camel_name, make_identifier_in, make_ros_name, make_snake_name
from archgen.model.node import Endpoint, Node


def list_generated_nodes(architecture: Architecture) -> list[Node]:
    """Return the nodes whose programs generators make: none that exists already, since another node says so."""
    nodes = architecture.nodes.values()
    made_programs = {(each.package, each.executable) for each in nodes if not each.is_generated and each.executable}
    return [each for each in nodes if each.is_generated and (each.package, each.executable) not in made_programs]


def find_node_language(node: Node) -> str:
    """Return the language that a node is generated in: what it says, C++ for what a container loads, else Python."""
    return node.language or ("cpp" if is_loadable(node) else "python")


def is_loadable(node: Node) -> bool:
    """Whether a node is a class that a container loads: it stands in one, has a `plugin`, or says so by its kind."""
    return node.container is not None or node.plugin is not None or not {"composable", "nodelet"}.isdisjoint(node.kinds)


def name_package(architecture: Architecture, node: Node) -> str:
    """Return the package of a node: what it says, else one for the nodes of its group.

    One build makes no package of two languages: beside nodes in Python, those in C++ have a package of their own.
    """
    if node.package:
        return node.package
    group = _find_group(architecture, node)
    is_second = find_node_language(node) == "cpp" and any(
        each.is_generated
        and not each.package
        and find_node_language(each) == "python"
        and _find_group(architecture, each) == group
        for each in architecture.nodes.values()
    )
    return make_ros_name(f"{architecture.project.id}_{group or 'nodes'}{'_cpp' if is_second else ''}")


def _find_group(architecture: Architecture, node: Node) -> str | None:
    return architecture.components[node.implements[0]].group if node.implements else None


def name_program(architecture: Architecture, node: Node) -> str:
    """Return the executable of a node: what it says, else that of its component's type, else its own id.

    Of a generic type there is a program for each of its uses: their messages differ.
    """
    only_component = architecture.components[node.implements[0]] if len(node.implements) == 1 else None
    component_type = (only_component.component_type if only_component else None) or ""
    arguments = component_type.partition("<")[2]
    if node.executable:
        return make_ros_name(f"{node.executable}_{arguments}") if arguments and node.is_generated else node.executable
    return make_ros_name(component_type or node.id)


@dataclass(frozen=True, slots=True)
class NodeProgram:
    """What runs a node: an executable of a package, or a class (`plugin`) that its package has for containers."""

    package: str | None
    executable: str | None
    plugin: str | None


def name_node_program(architecture: Architecture, node: Node, ros: int) -> NodeProgram:
    """Return what generators make for a node. `ros` is the generation of ROS."""
    package, executable = name_package(architecture, node), name_program(architecture, node)
    plugin = f"{package}/{make_camel_name(executable)}" if ros == 1 else name_plugin(node, package, executable)
    return NodeProgram(package, executable, node.plugin or plugin)


def name_plugin(node: Node, package_name: str, program_name: str) -> str:
    """Return the class of a generated node, with its namespace: what `plugin` says, else one after package and program."""
    return node.plugin or f"{make_identifier_in('cpp', package_name)}::{make_camel_name(program_name)}"


def group_by_program(architecture: Architecture, nodes: Iterable[Node]) -> dict[tuple[str, str], list[Node]]:
    """Return nodes by the package and the program that is generated for them."""
    groups: dict[tuple[str, str], list[Node]] = {}
    # By their ids: which is the first one must not hang on the order of lines.
    for node in sorted(nodes, key=lambda each: each.id):
        groups.setdefault((name_package(architecture, node), name_program(architecture, node)), []).append(node)
    return groups


def index_endpoints(architecture: Architecture) -> dict[str, list[Endpoint]]:
    """Return what each node does over ROS, by the node's id."""
    # A plain dictionary: plug-ins have it, and to look for an id that no node has is a mistake.
    return dict(group_pairs((each.node, each) for each in architecture.endpoints if each.medium == "ros"))


def group_endpoints(
    nodes: Iterable[Node], endpoints: Mapping[str, Sequence[Endpoint]]
) -> dict[tuple[str, str, str], list[Endpoint]]:
    """Return what nodes of one program do, by use, flow, and name of the port in the program."""
    groups: dict[tuple[str, str, str], list[Endpoint]] = {}
    for endpoint, key in name_endpoints(nodes, endpoints):
        groups.setdefault((endpoint.use, endpoint.flow, key), []).append(endpoint)
    return groups


def name_endpoints(
    nodes: Iterable[Node], endpoints: Mapping[str, Sequence[Endpoint]]
) -> Iterator[tuple[Endpoint, str]]:
    """Yield each endpoint of the nodes of one program with its name in the program: that of the port.

    Where two ports have it, their components' names stand in front; where one port stands on several topics, what tells
    their sources apart stands behind. Never their order: a line that moves in a partner's file must not give the messages
    of one arm to the method that was written for the other.
    """
    ports_of_nodes = [_name_ports(endpoints.get(node.id, ())) for node in nodes]
    words_by_place: dict[tuple[str, str, str], list[tuple[str, ...]]] = {}
    for ports in ports_of_nodes:
        for place, carried in ports.items():
            if len(carried) > 1:
                carried.sort(key=_write_origin)
            words_by_place.setdefault(place, []).append(_tell_apart(carried))
    shared_words = {place: iter(_share_words(words)) for place, words in words_by_place.items()}
    for ports in ports_of_nodes:
        for place, carried in ports.items():
            for endpoint, word in zip(carried, next(shared_words[place]), strict=True):
                yield endpoint, make_identifier_in("python", f"{place[2]}_{word}" if word else place[2])


def _name_ports(endpoints: Iterable[Endpoint]) -> dict[tuple[str, str, str], list[Endpoint]]:
    """Return what a node does by use, flow and name of the port, with its component's name where two ports have it."""
    carried_by_place = group_pairs((_place_name(endpoint), endpoint) for endpoint in endpoints)
    ports: dict[tuple[str, str, str], list[Endpoint]] = {}
    for (use, flow, short_name), carried in carried_by_place.items():
        has_several_ports = len(carried) > 1 and len({each.port or each.label for each in carried}) > 1
        for endpoint in carried:
            name = short_name
            if has_several_ports:
                name = make_snake_name("_".join((endpoint.port or endpoint.label).replace("/", ".").split(".")[-2:]))
            ports.setdefault((use, flow, name), []).append(endpoint)
    return ports


def _write_origin(endpoint: Endpoint) -> str:
    """Return where what an end carries comes from, as a path: the output that it hears, else what is on the wire."""
    return endpoint.sources[0].replace(".", "/") if len(endpoint.sources) == 1 else endpoint.label


def _tell_apart(endpoints: Sequence[Endpoint]) -> tuple[str, ...]:
    """Return for each endpoint what tells its origin from the others, in few words: `left` and `right` for `left/state` and `right/state`."""
    if len(endpoints) == 1:
        return ("",)
    parts = [_write_origin(each).strip("/").split("/") for each in endpoints]
    shortest = min(map(len, parts))
    # What all end with tells nothing; of what stands before it, as few words from the end as are not the same.
    same = next((i for i in range(shortest) if len({each[-1 - i] for each in parts}) > 1), shortest - 1)
    heads = [each[: len(each) - same] for each in parts]
    words = ["_".join(each) for each in heads]
    for count in range(1, max(map(len, heads)) + 1):
        words = ["_".join(each[-count:]) for each in heads]
        if len(set(words)) == len(words):
            break
    return tuple(map(make_snake_name, words))


def _share_words(words_of_nodes: Sequence[tuple[str, ...]]) -> Sequence[tuple[str, ...]]:
    """Return words that all nodes of one program have: theirs, else without what each repeats (`lidar` of `lidar_front`
    beside `camera_front`), else numbers in the order of the origins.
    """
    if words_of_nodes[0] == ("",) and len({*words_of_nodes}) == 1:
        return words_of_nodes
    for choice in (words_of_nodes, list(map(_drop_repeated_words, words_of_nodes))):
        if len({frozenset(words) for words in choice}) == 1 and all(len({*words}) == len(words) for words in choice):
            return choice
    return [tuple(f"{i}" if i > 1 else "" for i in range(1, len(words) + 1)) for words in words_of_nodes]


def _drop_repeated_words(words: Sequence[str]) -> tuple[str, ...]:
    parts = [word.split("_") for word in words]
    repeated = set(parts[0]).intersection(*parts[1:]) if len(parts) > 1 else set[str]()
    return tuple("_".join(part for part in each if part not in repeated) for each in parts)


def _place_name(endpoint: Endpoint) -> tuple[str, str, str]:
    short_name = make_snake_name((endpoint.port or endpoint.label.replace("/", ".")).rpartition(".")[2])
    return endpoint.use, endpoint.flow, short_name


def choose_own_names(
    architecture: Architecture, groups: Mapping[tuple[str, str, str], Sequence[Endpoint]]
) -> dict[tuple[str, str, str], str]:
    """Return what a program itself calls each of its ports: their names, which say nothing of where its nodes have them.

    Absolute is what the model says so (`own_name: /tf`), and the topics that all nodes share. Ports of one name have their
    use in front: `publishes/pose`.
    """
    shared_topics = shared_topic_names(architecture.shared_topics)
    own_names: dict[tuple[str, str, str], str] = {}
    for (use, flow, key), endpoints in groups.items():
        names = {each.name for each in endpoints}
        common_name = endpoints[0].name if len(names) == 1 and flow == "topic" else None
        own_names[use, flow, key] = (
            endpoints[0].own_name or (common_name if common_name in shared_topics else None) or key
        )
    counts = Counter(own_names.values())
    return {
        place: f"{place[0]}/{name}" if counts[name] > 1 and name == place[2] and not groups[place][0].own_name else name
        for place, name in own_names.items()
    }


ProgramPorts = tuple[Mapping[tuple[str, str, str], Sequence[Endpoint]], Mapping[tuple[str, str, str], str]]
"""The ports of a program by use, flow and name, with the ends of its nodes there, and what it calls each of them."""


def name_ports(
    architecture: Architecture, nodes: Sequence[Node], endpoints: Mapping[str, Sequence[Endpoint]]
) -> ProgramPorts:
    """Return the ports of the nodes of one program."""
    groups = group_endpoints(nodes, endpoints)
    return groups, choose_own_names(architecture, groups)


def find_common_message(endpoints: Sequence[Endpoint]) -> str | None:
    """Return the message that nodes of one program have at a port; None where they differ, or nobody says it."""
    messages = {each.message for each in endpoints}
    return endpoints[0].message if len(messages) == 1 else None


class ProgramNames:
    """Knows which names of a program become others at each of its nodes: of its ports, as generated or as it says, and others."""

    def __init__(self, architecture: Architecture, ros: int) -> None:
        self._ros, self._distro, self._architecture = ros, architecture.distro, architecture
        self._endpoints = index_endpoints(architecture)
        self._names: dict[str, list[tuple[str, str, str]]] = {}
        self._ports: dict[tuple[str, ...], ProgramPorts] = {}
        generated_nodes = list_generated_nodes(architecture)
        self._programs = {each.id: name_node_program(architecture, each, ros) for each in generated_nodes}
        for nodes in group_by_program(architecture, generated_nodes).values():
            self._name_ports(nodes)

    def _name_ports(self, nodes: Sequence[Node]) -> None:
        for node in nodes:
            self._names[node.id] = []
        ports = groups, own_names = name_ports(self._architecture, nodes, self._endpoints)
        self._ports[tuple(each.id for each in nodes)] = ports
        for place, own_name in own_names.items():
            if find_common_message(groups[place]) is None:
                continue
            for endpoint in groups[place]:
                if endpoint.name is not None:
                    self._names[endpoint.node].append((place[1], own_name, endpoint.name))

    def find_ports(self, nodes: Sequence[Node]) -> ProgramPorts:
        """Return the ports of the nodes of one program."""
        known = self._ports.get(tuple(each.id for each in nodes))
        return known or name_ports(self._architecture, nodes, self._endpoints)

    def find_program(self, node: Node) -> NodeProgram:
        """Return what runs a node: what it says, completed by what generators make for it."""
        return self._programs.get(node.id) or NodeProgram(node.package, node.executable, node.plugin)

    def is_generated(self, node: Node) -> bool:
        """Whether generators make a node's program."""
        return node.id in self._programs

    def find_remaps(self, node: Node) -> dict[str, str]:
        """Return what names of a node's program become, by what the program says. What resolves by itself is not there.

        All rules of a generated program are folded into one for each of its ends: what it calls them is the generator's
        choice, of which the node's own rules say nothing, and ROS applies no rule to the outcome of another.
        """
        node_names = NodeNames(node, self._distro)
        remaps: dict[str, str] = {}
        spoken: set[str | None] = set()
        for flow, own_name, name in self._list_names(node):
            full_name = node_names.expand(own_name)
            spoken.add(full_name)
            if full_name == name:
                continue
            for part in ACTION_PARTS[self._ros] if flow == "action" else ("",):
                remaps.setdefault(f"{own_name}{part}", f"{name}{part}")
        others = list_written_remaps(node)
        if others and node.id in self._programs:
            folded = [each for each in self._endpoints.get(node.id, ()) if each.port or each.written]
            spoken.update(name for each in folded for name in (each.name, each.program_name))
            spoken |= {f"{name}{part}" for name in spoken for part in ACTION_PARTS[self._ros]}
            others = {key: name for key, name in others.items() if node_names.expand(key) not in spoken}
        return remaps | {own_name: name for own_name, name in others.items() if own_name not in remaps}

    def _list_names(self, node: Node) -> Iterable[tuple[str, str, str]]:
        if node.id in self._names:
            return self._names[node.id]
        return [
            (each.flow, each.own_name, each.name)
            for each in self._endpoints.get(node.id, ())
            if each.own_name is not None and each.name is not None
        ]
