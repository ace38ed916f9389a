"""The functional level: groups, components, their ports, component types, and the connections.

What a type says to its instances is read off patterns (`archgen/link/project_linking.py`): components as an instance would
be that says nothing of its own. What is said of a part has a colon: `components.arm.motor:timing.wcet`,
`inputs.target:freshness`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from operator import attrgetter
from typing import Any

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.element_likeness import letter_pairs
from archgen.compare.kinds.key_readers import is_mapped
from archgen.compare.kinds.key_spec import (
    CO_OWNERS,
    Effect,
    KeySpec,
    ReadContext,
    Worsening,
    find_type_owner,
    key_values,
    read_owner,
)
from archgen.compare.kinds.kind_spec import (
    NAME_FEATURES,
    FeatureSpec,
    KindSpec,
    list_last_names,
    list_port_holders,
    mark_neighbours,
    mark_performance,
    mark_ports,
    mark_timing,
    mark_values,
    name_features,
    nodes_feature,
    reference_feature,
    text_feature,
)
from archgen.compare.kinds.ros_kinds import NODE
from archgen.compare.version_pair import MAPPED_KEY
from archgen.frozen import replace
from archgen.model.component import Component, ComponentType, Input, Output


def _port_parent(port: Input | Output, context: ReadContext) -> tuple[str, str]:
    return ("component", context.matched_ids.common_id("component", port.component))


_PORT_FEATURES = (
    FeatureSpec("name", 2, lambda _, port: letter_pairs(port.name)),
    FeatureSpec("type", 4, lambda _, port: mark_values(port.type)),
    FeatureSpec("topics", 3, lambda relations, port: frozenset(relations.topics_by_port[port.id])),
    text_feature(1, "description", "external"),
)


def _make_port_kind(
    name: str, elements: Callable[[ArchitectureVersion], Mapping[str, Any]], other_ends: FeatureSpec
) -> KindSpec:
    """Make the kind of a port: what inputs and outputs have in common, and what only one of the two has."""
    return KindSpec(
        name,
        None,
        elements=elements,
        features=(*_PORT_FEATURES, other_ends),
        has_path_id=True,
        parent_kind="component",
        stays_in_parent=True,
        parent=_port_parent,
        owner=lambda port, context: context.common_id("partner", context.architecture.components[port.component].owner),
        components=lambda port, context: (_port_parent(port, context)[1],),
        surroundings=lambda port, context: context.architecture.components[port.component],
    )


OUTPUT = _make_port_kind(
    "output",
    lambda version: version.architecture.outputs,
    FeatureSpec(
        "readers",
        5,
        lambda relations, port: relations.common_ids(
            "component", list_port_holders(relations.readers_by_output[port.id])
        ),
    ),
)
INPUT = _make_port_kind(
    "input",
    lambda version: version.architecture.inputs,
    FeatureSpec(
        "sources",
        5,
        lambda relations, port: relations.common_ids("output", relations.outputs_by_input[port.id]),
    ),
)
_OWN_WORDS = tuple(key for key in OUTPUT.keys if key.name in {"version", "promise.", "deprecated."})
"""What a composed component may say of its outputs itself."""


def read_own_output_words(shell: Component, context: ReadContext) -> Mapping[str, object]:
    """Return what a composed component says itself of its outputs, by `output:key`; what it passes on is told there."""
    return {
        f"{output.name}:{key}": value
        for output in shell.outputs.values()
        if output.promise or output.version or output.deprecated
        for key, value in _read_own_words(output, context).items()
    }


def _read_own_words(output: Output, context: ReadContext) -> Mapping[str, object]:
    targets = context.architecture.shell_ports.get(f"output {output.id}", ())
    component = context.architecture.find_component(targets[0].rpartition(".")[0]) if len(targets) == 1 else None
    given = component.outputs.get(targets[0].rpartition(".")[2]) if component else None
    given_words = _read_words(given, context) if given else {}
    return {key: value for key, value in _read_words(output, context).items() if given_words.get(key) != value}


def _read_words(output: Output, context: ReadContext) -> dict[str, object]:
    """Return what is said of an output that a composed component may say itself, too, by the keys of its kind."""
    return key_values(_OWN_WORDS, output, context)


GROUP = KindSpec(
    "group",
    None,
    (CO_OWNERS,),
    elements=lambda version: version.architecture.groups,
    features=(
        *NAME_FEATURES,
        # The names of its components outweigh all else: a group is what it holds.
        FeatureSpec("components", 8, lambda _, group: frozenset(group.components), is_decisive=True),
        text_feature(2, "description"),
        reference_feature("owner", 0.5, "partner", "owner"),
    ),
    owner=read_owner,
)
_LAST_NAME_FEATURES = name_features(attrgetter("name"))
COMPOSED = KindSpec(
    "composed",
    None,
    (CO_OWNERS, KeySpec("outputs.", read_own_output_words, Effect.SYSTEM)),
    Effect.SYSTEM,
    elements=lambda version: version.architecture.shells,
    features=(
        *_LAST_NAME_FEATURES,
        # What it holds and passes on. Instances of one type are alike in this: of these the name decides.
        FeatureSpec("components", 6, lambda _, shell: frozenset(list_last_names(shell.children))),
        FeatureSpec("ports", 2, mark_ports),
        text_feature(3, "functionality", "description"),
    ),
    word="composed component",
    has_path_id=True,
    parent_kind="group",
    parent=lambda shell, context: ("group", context.matched_ids.common_id("group", shell.group)),
    owner=read_owner,
    like="component",
    without=frozenset({"role", "inputs", "outputs"}),
)
COMPONENT = KindSpec(
    "component",
    None,
    # Whether a node implements it follows from the nodes.
    (CO_OWNERS, KeySpec(MAPPED_KEY, is_mapped, Effect.SYSTEM)),
    elements=lambda version: version.architecture.components,
    features=(
        *_LAST_NAME_FEATURES,
        FeatureSpec("ports", 4, mark_ports),
        text_feature(3, "functionality", "description"),
        FeatureSpec("near", 3, mark_neighbours),
        nodes_feature("component", 3),
        reference_feature("group", 0.5, "group", "group"),
        reference_feature("owner", 0.5, "partner", "owner"),
        FeatureSpec("requirements", 1, lambda _, component: mark_values(*(use.text for use in component.requirements))),
        FeatureSpec("performance", 1, mark_performance),
        FeatureSpec("timing", 1, mark_timing),
        FeatureSpec("tags", 0.5, lambda _, component: frozenset(component.tags)),
    ),
    has_path_id=True,
    parent_kind="group",
    parent=lambda component, context: ("group", context.matched_ids.common_id("group", component.group)),
    owner=read_owner,
    components=lambda component, context: (context.matched_ids.common_id("component", component.id),),
    surroundings=lambda component, context: context.nodes_by_component.get(component.id),
)


# Which outputs an input reads: compared by `version_pair`, since it has no keys.
CONNECTION = KindSpec("connection", None)
FUNCTIONAL_KINDS = (GROUP, COMPOSED, COMPONENT, OUTPUT, INPUT, CONNECTION)


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
