"""Component types: what stands at the type, and what it says to its instances.

The latter is read off patterns (`archgen/link/project_linking.py`): components as an instance would be that says nothing
of its own. What is said of a part has a colon: `components.arm.motor:timing.wcet`, `inputs.target:freshness`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from archgen.compare.kinds.functional_kinds import COMPONENT, INPUT, OUTPUT
from archgen.compare.kinds.key_spec import Effect, KeySpec, ReadContext, Worsening, find_type_owner, key_values
from archgen.compare.kinds.kind_spec import FeatureSpec, KindSpec, name_features, text_feature
from archgen.compare.kinds.ros_kinds import NODE
from archgen.frozen import replace
from archgen.model.component import Component, ComponentType, Input, Output

PART_MARK = ":"
"""Stands in a key between a part of a type and what is said of it."""
_INSTANCE_KEYS = frozenset({"owner", "co_owners", "layout", "urls", "inputs", "outputs", "mapped"})
"""Keys that belong to each instance, or to elements of their own."""
OWN_KEYS = frozenset({"title", "is", *_INSTANCE_KEYS})
"""Keys that neither an instance has from its type, nor a type from what it is made from."""
_WRITTEN_KEYS = frozenset({"functionality", "description"})
"""Keys that are read off the type itself."""
_NODE_KEYS = frozenset(
    {"kind", "package", "executable", "own_name", "plugin", "language", "command", "arguments", "inner_nodes."}
    | {"remaps.", "start.", "parameters."}
)
"""Keys of a node that a type says; the others depend on the instance."""
_PART_KEYS = tuple(key for key in COMPONENT.keys if key.name not in _INSTANCE_KEYS)
_RAN_KEYS = tuple(key for key in NODE.keys if key.name in _NODE_KEYS)


def _read_pattern(key: KeySpec) -> Callable[[ComponentType, ReadContext], object]:
    """Return what reads a key of components off the pattern of a type."""

    def read(component_type: ComponentType, context: ReadContext) -> object:
        pattern = context.version.type_patterns.components.get(component_type.id)
        if pattern is None:
            return {} if key.name.endswith(".") else None
        return key.value_of(pattern, context)

    return read


def _list_port_values(
    ports: Iterable[Input | Output], keys: tuple[KeySpec, ...], context: ReadContext
) -> Iterator[tuple[str, object]]:
    for port in ports:
        values = key_values(keys, port, context)
        yield port.name, values.pop("type", "?")
        yield from ((f"{port.name}{PART_MARK}{key}", value) for key, value in values.items())


def _read_ports(side: str, keys: tuple[KeySpec, ...]) -> Callable[[ComponentType, ReadContext], Mapping[str, object]]:
    """Return what reads the ports of a type: by their id what they carry, and what else is said of them."""

    def read(component_type: ComponentType, context: ReadContext) -> Mapping[str, object]:
        pattern = context.version.type_patterns.components.get(component_type.id)
        if pattern is None:
            return {name: kind or "?" for name, kind in getattr(component_type, side).items()}
        return dict(_list_port_values(getattr(pattern, side).values(), keys, context))

    return read


def _read_parts(component_type: ComponentType, context: ReadContext) -> Mapping[str, object]:
    """Return what a type says of the components inside, by their path."""
    patterns = context.version.type_patterns
    values: dict[str, object] = {}
    for path, pattern in patterns.list_parts(component_type.id):
        own_values = key_values(_PART_KEYS, pattern, context)
        own_values |= {f"node.{key}": value for key, value in _read_node_at(pattern, context).items()}
        for side, ports, keys in (
            ("inputs", pattern.inputs.values(), INPUT.keys),
            ("outputs", pattern.outputs.values(), OUTPUT.keys),
        ):
            for key, value in _list_port_values(ports, keys, context):
                own_values[f"{side}.{key}"] = value
        values |= {f"{path}{PART_MARK}{key}": value for key, value in own_values.items()}
    return values


def _read_node(component_type: ComponentType, context: ReadContext) -> Mapping[str, object]:
    pattern = context.version.type_patterns.components.get(component_type.id)
    return _read_node_at(pattern, context) if pattern else {}


def _read_node_at(pattern: Component, context: ReadContext) -> Mapping[str, object]:
    node: Any = context.version.type_patterns.nodes.get(pattern.id)
    return key_values(_RAN_KEYS, node, context) if node else {}


def _mark_ports(component_type: ComponentType) -> frozenset[str]:
    sides = (("input", component_type.inputs), ("output", component_type.outputs))
    return frozenset(f"{side} {name} {kind or '?'}" for side, ports in sides for name, kind in ports.items())


_PATTERN_KEYS = tuple(
    # What timing and partners lose is judged at the instances.
    replace(
        key, read=_read_pattern(key), effect=min(key.effect, Effect.SYSTEM), worsening=Worsening.NEVER, attribute=""
    )
    for key in COMPONENT.keys
    if key.name not in OWN_KEYS | _WRITTEN_KEYS
)
COMPONENT_TYPE = KindSpec(
    "component_type",
    "Component types",
    (
        KeySpec("inputs.", _read_ports("inputs", INPUT.keys), Effect.SYSTEM),
        KeySpec("outputs.", _read_ports("outputs", OUTPUT.keys), Effect.SYSTEM),
        KeySpec("components", lambda each, _: each.components or None, Effect.SYSTEM),
        KeySpec("components.", _read_parts, Effect.SYSTEM),
        KeySpec("node.", _read_node, Effect.SYSTEM),
        *_PATTERN_KEYS,
    ),
    elements=lambda version: version.architecture.component_types,
    features=(
        # The library is a part of the id: a type that moves into one is the same.
        *name_features(lambda each: each.id.rpartition(".")[2]),
        FeatureSpec("ports", 4, lambda _, each: _mark_ports(each)),
        FeatureSpec("components", 4, lambda _, each: frozenset(each.components)),
        FeatureSpec("parameters", 2, lambda _, each: frozenset(each.parameters)),
        text_feature(3, "functionality", "description"),
    ),
    word="component type",
    owner=find_type_owner,
    without=frozenset({"layout", "outputs", *(key.name for key in _PATTERN_KEYS)}),
)
