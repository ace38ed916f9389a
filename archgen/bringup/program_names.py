"""What nodes are called in programs that generators make: packages, programs, and the names that nodes of one program share.

Scripts, launch files and generated code ask here, so that what one of them writes fits what the others do.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from archgen.derivation.wire.remap_rules import ACTION_PARTS, NodeNames, list_written_remaps
from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.code_names import make_camel_name, make_identifier_in, make_ros_name, make_snake_name
from archgen.model.node import Endpoint, Node


def list_generated_nodes(architecture: Architecture) -> list[Node]:
    """Return the nodes whose programs generators make: none that exists already, since another node says so."""
    nodes = architecture.nodes.values()
    made_programs = {(each.package, each.executable) for each in nodes if not each.is_generated and each.executable}
    return [each for each in nodes if each.is_generated and (each.package, each.executable) not in made_programs]


def name_package(architecture: Architecture, node: Node) -> str:
    """Return the package of a node: what it says, else one for the nodes of its group."""
    if node.package:
        return node.package
    group = next((architecture.components[each].group for each in node.implements), None)
    return make_ros_name(f"{architecture.project.id}_{group or 'nodes'}")


def name_program(architecture: Architecture, node: Node) -> str:
    """Return the executable of a node: what it says, else that of its component's type, else its own id."""
    if node.executable:
        return node.executable
    only_component = architecture.components[node.implements[0]] if len(node.implements) == 1 else None
    return make_ros_name((only_component.component_type if only_component else None) or node.id)


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
    for node in nodes:
        groups.setdefault((name_package(architecture, node), name_program(architecture, node)), []).append(node)
    return groups


def index_endpoints(architecture: Architecture) -> dict[str, list[Endpoint]]:
    """Return what each node does over ROS, by the node's id."""
    index: dict[str, list[Endpoint]] = {}
    for endpoint in architecture.endpoints:
        if endpoint.medium == "ros":
            index.setdefault(endpoint.node, []).append(endpoint)
    return index


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
    these apart stands behind. Never their order: a line that moves in a partner's file must not give the messages of one
    arm to the method that was written for the other.
    """
    ports_of_nodes = [_name_ports(endpoints.get(node.id, ())) for node in nodes]
    words_by_place: dict[tuple[str, str, str], set[frozenset[str]]] = {}
    for ports in ports_of_nodes:
        for place, carried in ports.items():
            words_by_place.setdefault(place, set()).add(frozenset(_tell_apart([each.label for each in carried])))
    for ports in ports_of_nodes:
        for (use, flow, name), carried in ports.items():
            in_order = sorted(carried, key=lambda each: each.label)
            words = _tell_apart([each.label for each in in_order])
            # Nodes of one program on different topics share its methods: these are counted by the topics' names.
            has_words = len(words_by_place[use, flow, name]) == 1 and len(set(words)) == len(words) > 1
            for number, (endpoint, word) in enumerate(zip(in_order, words, strict=True), start=1):
                ending = f"_{word}" if has_words else f"_{number}" if number > 1 else ""
                yield endpoint, make_identifier_in("python", f"{name}{ending}")


def _name_ports(endpoints: Iterable[Endpoint]) -> dict[tuple[str, str, str], list[Endpoint]]:
    """Return what a node does by use, flow and name of the port, with its component's name where two ports have it."""
    listed = list(endpoints)
    own_names: dict[tuple[str, str, str], set[str]] = {}
    for endpoint in listed:
        own_names.setdefault(_place_name(endpoint), set()).add(endpoint.port or endpoint.label)
    ports: dict[tuple[str, str, str], list[Endpoint]] = {}
    for endpoint in listed:
        use, flow, name = _place_name(endpoint)
        if len(own_names[use, flow, name]) > 1:
            name = make_snake_name("_".join((endpoint.port or endpoint.label).replace("/", ".").split(".")[-2:]))
        ports.setdefault((use, flow, name), []).append(endpoint)
    return ports


def _tell_apart(topics: Sequence[str]) -> list[str]:
    """Return for each topic what tells it from the others, in few words: `left` and `right` for `/left/state` and `/right/state`."""
    parts = [topic.strip("/").split("/") for topic in topics]
    shortest = min(map(len, parts), default=0)
    # What all end with tells nothing; of what stands before it, as few words from the end as are not the same.
    same = next((i for i in range(shortest) if len({each[-1 - i] for each in parts}) > 1), max(shortest - 1, 0))
    heads = [each[: len(each) - same] for each in parts]
    words = ["_".join(each) for each in heads]
    for count in range(1, max(map(len, heads), default=1) + 1):
        words = ["_".join(each[-count:]) for each in heads]
        if len(set(words)) == len(words):
            break
    return list(map(make_snake_name, words))


def _place_name(endpoint: Endpoint) -> tuple[str, str, str]:
    short_name = make_snake_name((endpoint.port or endpoint.label.replace("/", ".")).rpartition(".")[2])
    return endpoint.use, endpoint.flow, short_name


def choose_own_name(key: str, endpoints: Sequence[Endpoint], *, is_shared: bool) -> str:
    """Return what a program itself calls a port: one that several nodes share cannot say where each of them has it."""
    first = endpoints[0]
    names = {each.name for each in endpoints}
    return first.own_name or (first.name if len(names) == 1 and not is_shared else None) or key


def find_common_message(endpoints: Sequence[Endpoint]) -> str | None:
    """Return the message that nodes of one program have at a port; None where they differ, or nobody says it."""
    messages = {each.message for each in endpoints}
    return endpoints[0].message if len(messages) == 1 else None


class ProgramNames:
    """Knows which names of a program become others at each of its nodes: of its ports, as generated or as it says, and others."""

    def __init__(self, architecture: Architecture, ros: int) -> None:
        self._ros, self._distro = ros, architecture.distro
        self._endpoints = index_endpoints(architecture)
        self._names: dict[str, list[tuple[str, str, str]]] = {}
        generated_nodes = list_generated_nodes(architecture)
        self._programs = {each.id: name_node_program(architecture, each, ros) for each in generated_nodes}
        for nodes in group_by_program(architecture, generated_nodes).values():
            if len(nodes) > 1:
                self._name_shared_ports(nodes)

    def _name_shared_ports(self, nodes: Sequence[Node]) -> None:
        for node in nodes:
            self._names[node.id] = []
        for (_, flow, key), endpoints in group_endpoints(nodes, self._endpoints).items():
            if find_common_message(endpoints) is None:
                continue
            own_name = choose_own_name(key, endpoints, is_shared=True)
            for endpoint in endpoints:
                if endpoint.name is not None:
                    self._names[endpoint.node].append((flow, own_name, endpoint.name))

    def find_program(self, node: Node) -> NodeProgram:
        """Return what runs a node: what it says, completed by what generators make for it."""
        return self._programs.get(node.id) or NodeProgram(node.package, node.executable, node.plugin)

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
        if node.id in self._programs:
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
