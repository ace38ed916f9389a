"""The parameters of a leaf with the values that the components around it hand in."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.diagnostics.source_span import Span
from archgen.model.parameter import Parameter
from archgen.passes.project_tree import make_node
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, YamlNode

_DECLARING_KEYS = frozenset({"value", "type", "choices", "from"})


def fill_in_parameters(written: MappingNode, parameters: Mapping[str, Parameter], prefix: str = "") -> MappingNode:
    """Return declarations of parameters without `from` and `$(self.x)`: with the values that these stand for."""
    entries: dict[str, MappingEntry] = {}
    for entry in written:
        name = f"{prefix}{entry.key}"
        value = entry.value
        if name in parameters:
            value = _fill_in_declaration(value, parameters[name], entry.key_span)
        elif isinstance(value, MappingNode):
            value = fill_in_parameters(value, parameters, f"{name}.")
        entries[entry.key] = MappingEntry(entry.key, entry.key_span, value)
    return MappingNode(entries, written.span)


def _fill_in_declaration(node: YamlNode, parameter: Parameter, place: Span) -> YamlNode:
    if not isinstance(node, MappingNode) or _DECLARING_KEYS.isdisjoint(node.entries):
        return _fill_in_value(node, parameter)
    if "from" not in node.entries:
        entries = dict(node.entries)
        if (written := entries.get("value")) is not None:
            entries["value"] = MappingEntry("value", written.key_span, _fill_in_value(written.value, parameter))
        return MappingNode(entries, node.span)
    entries = {key: each for key, each in node.entries.items() if key != "from"}
    handed: dict[str, object] = {
        "type": parameter.type,
        "value": parameter.value,
        "unit": parameter.unit,
        "range": list(parameter.range) if parameter.range else None,
        "choices": list(parameter.choices) if parameter.choices else None,
    }
    for key, value in handed.items():
        if value is not None and key not in entries:
            value_place = parameter.value_at if key == "value" else place
            entries[key] = MappingEntry(key, place, make_node(value, value_place))  # type: ignore[arg-type]
    return MappingNode(entries, node.span)


def _fill_in_value(node: YamlNode, parameter: Parameter) -> YamlNode:
    if (
        isinstance(node, ScalarNode)
        and isinstance(node.value, str)
        and "$(" in node.value
        and parameter.value is not None
    ):
        return make_node(parameter.value, node.span)  # type: ignore[arg-type]
    return node
