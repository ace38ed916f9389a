"""Programs that the library that ships knows, held against the names that the design has for what they read and send.

A program that exists stays on its own names: where the design has another one, somebody must say what it is called in the program,
so that it is remapped when it starts.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence

from archgen.derivation.wire.wire_names import NodeNames
from archgen.diagnostics import Diagnostic, first_written_span, join_words
from archgen.frozen import NamedTuple
from archgen.model.architecture import Architecture
from archgen.model.message_types import flow_of, full_message_name
from archgen.model.node import Endpoint, Node
from archgen.project.library_reading import (
    choose_distro,
    index_programs,
    list_shipped_packages,
    load_package_types,
)
from archgen.syntax.yaml_tree import node_to_data

_VERBS = {"publishes": "publishes", "subscribes": "subscribes to", "serves": "serves", "calls": "calls"}


class ProgramEnd(NamedTuple):
    """What a program reads, sends, serves or calls, by the library: under which name of its own, and the full name of the message."""

    use: str
    own_name: str
    message: str
    is_certain: bool
    """Whether no parameter that is given may name it otherwise, or leave it out."""


def find_unlike_programs(architecture: Architecture) -> Iterator[Diagnostic]:
    """Yield where a program that the library knows stays on a name of its own, and the design has it on another one."""
    nodes = [
        node for node in architecture.nodes.values() if node.package and not node.observed and node.status != "adapted"
    ]
    distro = choose_distro(architecture.distro)
    packages = list_shipped_packages(distro) & {node.package for node in nodes} if nodes else None
    if not packages:
        return
    types = load_package_types(distro, packages)
    types_by_program = index_programs(types)
    endpoints: dict[str, list[Endpoint]] = defaultdict(list)
    for endpoint in architecture.endpoints:
        if endpoint.medium == "ros" and not endpoint.internal and endpoint.name is not None:
            endpoints[endpoint.node].append(endpoint)
    for node in nodes:
        type_names = types_by_program.get((node.package or "", node.plugin or node.executable or ""), ())
        if len(type_names) == 1 and endpoints[node.id]:
            component_type = _as_mapping(node_to_data(types[type_names[0]].value))
            ends = list(_list_ends(component_type, node))
            yield from _find_other_names(node, ends, endpoints[node.id], architecture.distro)


def find_shadowed_packages(architecture: Architecture) -> Iterator[Diagnostic]:
    """Yield nodes for which a package would be generated that hides the one of this name that the library knows."""
    distro = choose_distro(architecture.distro)
    for node in architecture.nodes.values():
        is_open = node.status is None and node.is_generated and node.package is not None
        if is_open and node.package in list_shipped_packages(distro):
            message = (
                f"`archgen generate` would make the package `{node.package}` for `{node.id}`, and hide the one that ROS users "
                "install under this name"
            )
            help_line = (
                f"write `status: existing` at the node, and which program of `{node.package}` it runs (`executable`); "
                "`status: planned` if you do write a package of this name"
            )
            yield Diagnostic("shadowed-package", message, node.at, help=help_line, element=node.id)


def _find_other_names(
    node: Node, ends: Sequence[ProgramEnd], endpoints: Sequence[Endpoint], distro: str | None
) -> Iterator[Diagnostic]:
    names = NodeNames(node, distro)
    wires = {(end.use, names.resolve(end.own_name, flow_of(end.message))): end for end in ends}
    used = {(endpoint.use, endpoint.name) for endpoint in endpoints}
    free = [end for wire, end in wires.items() if wire not in used]
    lost = [each for each in endpoints if each.own_name is None and (each.use, each.name) not in wires]
    candidates = [[end for end in free if end.use == each.use and _may_be(end, each)] for each in lost]
    likely = [_choose_alike(fitting, each) for fitting, each in zip(candidates, lost, strict=True)]
    for endpoint, fitting, end in zip(lost, candidates, likely, strict=True):
        if fitting and all(each.is_certain for each in fitting):
            # One that several may be is a guess for none of them.
            is_guess = end is not None and likely.count(end) == 1
            yield _report_other_name(
                node, endpoint, [end.own_name] if end and is_guess else [each.own_name for each in fitting]
            )


def _choose_alike(ends: Sequence[ProgramEnd], endpoint: Endpoint) -> ProgramEnd | None:
    """Return the only one, or the only one whose name ends as the design's."""
    alike = [end for end in ends if _last_word(end.own_name) == _last_word(endpoint.name or "")]
    return next((each[0] for each in (ends, alike) if len(each) == 1), None)


def _may_be(end: ProgramEnd, endpoint: Endpoint) -> bool:
    """Whether both have one message; where the design has none, one last word."""
    if endpoint.message is None:
        return _last_word(end.own_name) == _last_word(endpoint.name or "")
    return end.message == endpoint.message


def _last_word(name: str) -> str:
    return name.rpartition("/")[2]


def _report_other_name(node: Node, endpoint: Endpoint, own_names: Sequence[str]) -> Diagnostic:
    quoted = [f"`{name}`" for name in own_names]
    message = (
        f"`{node.plugin or node.executable}` of `{node.package}` {_VERBS[endpoint.use]} {join_words(quoted, 'or')}, "
        f"and not `{endpoint.name}`: nothing remaps it"
    )
    port = (endpoint.port or "").rpartition(".")[2]
    key = "topic" if endpoint.flow == "topic" else "name"
    written = f"{key}: {endpoint.name}, " if endpoint.name_written else ""
    entry = f"`{endpoint.use}: {{{port}: {{{written}own_name: {own_names[0] if len(own_names) == 1 else '...'}}}}}`"
    help_line = (
        f"write {entry} at the node, so that it is remapped when it starts; or let the design have the program's name"
    )
    span = first_written_span(endpoint.at, node.at)
    return Diagnostic("unlike-program", message, span, help=help_line, element=endpoint.port or node.id)


def _list_ends(component_type: Mapping[str, object], node: Node) -> Iterator[ProgramEnd]:
    facts = _as_mapping(component_type.get("node"))
    ports = {**_as_mapping(component_type.get("inputs")), **_as_mapping(component_type.get("outputs"))}
    for use in _VERBS:
        for key, entry in _as_mapping(facts.get(use)).items():
            said = _as_mapping(entry) or {"topic": entry}
            topics = said.get("topic")
            own_name = said.get("own_name") or said.get("name") or (topics[0] if isinstance(topics, list) else topics)
            port = ports.get(key)
            message = said.get("message") or _as_mapping(port).get("type") or port
            full_name = full_message_name(message) if isinstance(message, str) else None
            if isinstance(own_name, str) and full_name:
                yield ProgramEnd(use, own_name, full_name, _is_certain(said, node))


def _is_certain(said: Mapping[str, object], node: Node) -> bool:
    naming = said.get("named_by")
    is_given = bool(node.parameter_files) or str(naming) in node.parameters
    return "when" not in said and (naming is None or not (is_given or set("*{") & set(str(naming))))


def _as_mapping(data: object) -> Mapping[str, object]:
    return data if isinstance(data, Mapping) else {}
