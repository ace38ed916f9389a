"""What an import and the other files of a project both say of a node's endpoints: known by their names on the wire, however each writes them.

A launch file says `scan` and a remap, the running robot `/front/scan`: that is one endpoint, and its name is written once.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from archgen import pipeline
from archgen.edit.earlier_import import copy_mapping, put_value
from archgen.edit.import_identity import USES, Slices, find_place, read_mapping, read_section
from archgen.frozen import NamedTuple, dataclass, field
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint, Node
from archgen.project import PROJECT_FILE
from archgen.project.project_loading import load_from_files
from archgen.syntax.project_files import OverlaidFiles
from archgen.syntax.yaml_tree import YamlDocument, list_entries
from archgen.syntax.yaml_writer import write_yaml

_NAME_KEYS = frozenset({"topic", "name", "own_name", "named_by"})
_EndpointKey = tuple[str, str, str | None]
"""Node, use, and the name on the wire."""


@dataclass(slots=True)
class JoinedEndpoints:
    """Slices that say only once what other files say of their endpoints, and the ports that are called otherwise there."""

    slices: dict[str, dict[str, Any]]
    ports: dict[str, dict[str, str]] = field(default_factory=dict)
    """By the components' places: their ids in other files, by those that they come with."""


def join_endpoints(
    slices: Slices, others: Architecture, documents: Sequence[YamlDocument], node_ids: Mapping[str, str]
) -> JoinedEndpoints:
    """Join what an import says of nodes with what other files say, whose `documents` are given.

    `node_ids` are the ids of the import's nodes by those that they come with.
    """
    joined = JoinedEndpoints({name: dict(data) for name, data in slices.items()})
    if not read_section(slices, "nodes").keys() & others.nodes.keys():
        return joined
    own_names: dict[tuple[str, str, str], str] = {
        (each.node, each.use, key): each.name for key, each in _link_alone(slices) if each.name
    }
    known: dict[_EndpointKey, tuple[str, Endpoint]] = {}
    for key, each in _list_keyed(others, documents):
        known.setdefault((each.node, each.use, each.name), (key, each))
    for data in joined.slices.values():
        for node_id, body in read_mapping(data.get("nodes")).items():
            if isinstance(body, Mapping) and node_id in others.nodes:
                new_body = _join_node(node_id, body, own_names, known, joined.ports)
                if not body.get("implements") and not _takes_ports(node_id, others):
                    new_body = _make_internal(new_body, others.nodes[node_id], others)
                data["nodes"] = {**data["nodes"], node_id: new_body}
                _add_ports(data, _list_new_ports(node_id, new_body, others, own_names, known), others)
        _drop_types(data, others, node_ids)
    return joined


def _link_alone(slices: Slices) -> Iterator[tuple[str, Endpoint]]:
    """Yield the endpoints of an import alone, with their keys."""
    sections: dict[str, Any] = {"project": {"id": "import"}}
    for data in slices.values():
        for section, elements in data.items():
            sections[section] = {**sections.get(section, {}), **elements} if isinstance(elements, Mapping) else elements
    text = write_yaml(sections).encode()
    loaded_project = load_from_files(OverlaidFiles(Path(), {PROJECT_FILE: text}), PROJECT_FILE)
    return _list_keyed(pipeline.judge_project(loaded_project).architecture, loaded_project.documents)


def _list_keyed(architecture: Architecture, documents: Iterable[YamlDocument]) -> Iterator[tuple[str, Endpoint]]:
    """Yield endpoints with the keys below which nodes say them; it is empty where they follow from something else."""
    keys = {
        entry.key_span: entry.key
        for document in documents
        for node in list_entries(document.root, "nodes")
        for use in USES
        for entry in (*list_entries(node.value, use), *list_entries(node.value, "internal", use))
    }
    for each in architecture.endpoints:
        yield each.port.rpartition(".")[2] if each.port else keys.get(each.at, ""), each


def _join_node(
    node_id: str,
    body: Mapping[str, Any],
    own_names: Mapping[tuple[str, str, str], str],
    known: Mapping[_EndpointKey, tuple[str, Endpoint]],
    ports: dict[str, dict[str, str]],
) -> dict[str, Any]:
    """Return a node without the names and messages that other files say, by the keys that they have there."""
    changed = dict(body)
    for use in USES:
        entries = read_mapping(body.get(use))
        new_entries: dict[str, Any] = {}
        for key, entry in entries.items():
            name = own_names.get((node_id, use, key))
            new_key, endpoint = known.get((node_id, use, name), (key, None))
            # What is called so already is another endpoint.
            is_taken = new_key != key and any(new_key in read_mapping(body.get(each)) for each in USES)
            if endpoint is None or name is None or is_taken:
                new_entries[key] = entry
                continue
            if new_key != key and (place := find_place(body)):
                ports.setdefault(place, {})[key] = new_key
            target = new_entries
            if endpoint.internal:
                target = changed.setdefault("internal", {}).setdefault(use, {})
            said = {*_NAME_KEYS, *(("message",) if read_mapping(entry).get("message") == endpoint.message else ())}
            rest = {inner: value for inner, value in read_mapping(entry).items() if inner not in said}
            if rest and new_key:
                target[new_key] = rest
        if entries:
            changed[use] = copy_mapping(entries, new_entries)
    internal = {use: entries for use, entries in read_mapping(changed.pop("internal", None)).items() if entries}
    changed |= {"internal": internal} if internal else {}
    return {key: value for key, value in changed.items() if value or key not in USES}


def _takes_ports(node_id: str, others: Architecture) -> bool:
    """Whether a node has one component of its own in other files, or none: what a type says is closed."""
    implemented = others.nodes[node_id].implements
    components = [others.components[each] for each in implemented if each in others.components]
    return not implemented or (
        len(implemented) == 1 == len(components)
        and components[0].component_type is None
        and components[0].id.count(".") == 1
    )


def _make_internal(body: Mapping[str, Any], node: Node, others: Architecture) -> dict[str, Any]:
    """Return a node whose endpoints are internal where none of its components has them as ports."""
    ports = {
        port.name for each in node.implements if each in others.components for port in others.components[each].ports
    }
    changed = dict(body)
    for use in USES:
        entries = read_mapping(body.get(use))
        if new := {key: entry for key, entry in entries.items() if key not in ports}:
            changed["internal"] = {
                **changed.get("internal", {}),
                use: {**changed.get("internal", {}).get(use, {}), **new},
            }
            changed[use] = {key: entry for key, entry in entries.items() if key in ports}
    return {key: value for key, value in changed.items() if value or key not in USES}


class _NewPort(NamedTuple):
    """A port for what only one side says of a node, at the component that only the other side has."""

    place: str
    use: str
    key: str
    name: str
    message: object


def _list_new_ports(
    node_id: str,
    body: Mapping[str, Any],
    others: Architecture,
    own_names: Mapping[tuple[str, str, str], str],
    known: Mapping[_EndpointKey, tuple[str, Endpoint]],
) -> Iterator[_NewPort]:
    implemented = others.nodes[node_id].implements
    if implemented and _takes_ports(node_id, others) and not body.get("implements"):
        for use in USES:
            for key, entry in read_mapping(body.get(use)).items():
                name, port_id = own_names.get((node_id, use, key)), f"{implemented[0]}.{key}"
                if name and port_id not in others.inputs and port_id not in others.outputs:
                    yield _NewPort(implemented[0], use, key, name, read_mapping(entry).get("message"))
    if not implemented and (place := find_place(body)):
        said = {(each_node, use, name) for (each_node, use, _), name in own_names.items()}
        for (each_node, use, name), (key, endpoint) in known.items():
            is_port = bool(name and key) and not endpoint.internal
            if is_port and each_node == node_id and (each_node, use, name) not in said:
                yield _NewPort(place, use, key, name or "", endpoint.message)


def _add_ports(data: dict[str, Any], ports: Iterable[_NewPort], others: Architecture) -> None:
    for each in ports:
        group, _, component = each.place.partition(".")
        path = ("groups", group, "components", component)
        if each.use in {"publishes", "serves"}:
            put_value(data, (*path, "outputs", each.key), each.message)
            continue
        writers = [
            end.port
            for end in others.endpoints
            if end.use in {"publishes", "serves"} and end.port and end.name == each.name and end.component != each.place
        ]
        source = {"from": writers} if writers else {"external": f"Nobody here has {each.name}"}
        put_value(data, (*path, "inputs", each.key), {**source, **({"type": each.message} if each.message else {})})


def _drop_types(data: dict[str, Any], others: Architecture, node_ids: Mapping[str, str]) -> None:
    """Leave out the types that come with nodes for whom other files have components."""
    types = {
        key: value
        for key, value in read_mapping(data.get("component_types")).items()
        if key not in node_ids or node_ids[key] not in others.nodes or not others.nodes[node_ids[key]].implements
    }
    data.pop("component_types", None)
    if types:
        data["component_types"] = types
