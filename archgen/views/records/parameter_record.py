"""Parameters and operations in the resolved record."""

from __future__ import annotations

from collections.abc import Iterable

from archgen.model.architecture import Architecture
from archgen.model.node import Node
from archgen.model.parameter import Operation, Parameter, ParameterValue
from archgen.model.parameter_values import find_effective_parameters
from archgen.views.records.record_values import drop_unknown, pick_fields, to_plain


def record_parameter(parameter: Parameter) -> dict[str, object]:
    """Return what a component declares of a parameter."""
    fields = pick_fields(parameter, "type", "unit", "description", "visibility", "range", "choices")
    values = {
        "value": to_plain(parameter.value),
        "read_only": parameter.read_only or None,
        "from": parameter.handed_from,
        "hints": to_plain(parameter.hints),
    }
    return fields | {key: value for key, value in values.items() if value is not None and value != {}}


def record_operation(operation: Operation) -> dict[str, object]:
    """Return an operation."""
    fields = pick_fields(operation, "title", "call", "visibility", "description")
    return fields | drop_unknown({"request": to_plain(operation.request), "response": to_plain(operation.response)})


def record_values(values: Iterable[ParameterValue]) -> dict[str, object]:
    """Return values by name; of one name the last counts."""
    return {value.name: to_plain(value.value) for value in values}


def record_effective(architecture: Architecture, node: Node) -> dict[str, object]:
    """Return the values that count at a node, each with where it comes from; nothing where all are the node's own."""
    parameters = find_effective_parameters(architecture, node)
    if all(each.origin == "node" for each in parameters.values()):
        return {}
    return {
        name: {"origin": each.origin, **({"value": to_plain(each.value)} if each.is_known else {})}
        for name, each in parameters.items()
    }
