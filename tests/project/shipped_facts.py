"""What a component type that ships states about its package: for each of these facts there has to be a source."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, YamlNode, find_value, list_entries

_PROGRAM_KEYS = ("executable", "plugin", "own_name", "inner_nodes")
_USE_KINDS = ("publishes", "subscribes", "serves", "calls")
_NAMING_KEYS = ("named_by", "when")
"""What says which parameters name a port of the node, and whether it has the port. Its name itself is at the port's line."""


def list_type_facts(body: MappingNode) -> Iterator[str]:
    """Yield the paths of all that a type states about its package: its program, ports, operations, parameters.

    What is said of the world outside, such as who presses keys, is nothing that a package could say.
    """
    for entry in list_entries(body, "node"):
        if entry.key in _PROGRAM_KEYS:
            yield entry.key
        elif entry.key in _USE_KINDS and isinstance(entry.value, MappingNode):
            for use in entry.value:
                yield from (f"{key}.{use.key}" for key in _NAMING_KEYS if _has_key(use.value, key))
    for section in ("inputs", "outputs", "operations"):
        for entry in list_entries(body, section):
            medium = find_value(entry.value, "medium")
            if not (isinstance(medium, ScalarNode) and medium.text == "physical"):
                yield f"{section}.{entry.key}"
    yield from _list_parameters(list_entries(body, "parameters"), "parameters")


def _has_key(node: YamlNode, key: str) -> bool:
    return isinstance(node, MappingNode) and key in node.entries


def _list_parameters(parameters: Iterable[MappingEntry], path: str) -> Iterator[str]:
    for entry in parameters:
        name, value = f"{path}.{entry.key}", entry.value
        if isinstance(value, MappingNode) and not {"type", "value"} & value.entries.keys():
            yield from _list_parameters(value, name)
        else:
            yield name
