"""Nested parameters in YAML as values by their dotted names, each with its place."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from archgen.model.parameter import MAX_NAME_LENGTH, ParameterValue
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode

ScalarReader = Callable[[ScalarNode], object]


def _read_plain(scalar: ScalarNode) -> object:
    return scalar.value


def flatten_parameters(mapping: MappingNode, read_scalar: ScalarReader = _read_plain) -> Iterator[ParameterValue]:
    """Yield the values of nested parameters by their dotted names, as `ros2 param list` shows them.

    A set without anything in it has no value. Where names become too long, all that is below is one value.
    """
    # A stack taken from its end, filled in reverse, so that values come in the order of the file.
    pending: list[tuple[str, MappingEntry]] = [(entry.key, entry) for entry in mapping][::-1]
    while pending:
        name, entry = pending.pop()
        node = entry.value
        if isinstance(node, MappingNode) and len(name) <= MAX_NAME_LENGTH:
            pending += [(f"{name}.{inner.key}", inner) for inner in reversed(list(node))]
        else:
            short_name = name[: MAX_NAME_LENGTH + 1]
            yield ParameterValue(short_name, _read_value(node, read_scalar), node.span, entry.key_span)


def _read_value(node: YamlNode, read_scalar: ScalarReader) -> object:
    if isinstance(node, ScalarNode):
        return read_scalar(node)
    if isinstance(node, SequenceNode):
        return [_read_value(item, read_scalar) for item in node.items]
    return {entry.key: _read_value(entry.value, read_scalar) for entry in node}
