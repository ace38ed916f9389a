"""The functional level: groups, components, their ports, and the connections between these."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from operator import attrgetter
from typing import Any

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.element_likeness import letter_pairs
from archgen.compare.kinds.key_readers import is_mapped
from archgen.compare.kinds.key_spec import CO_OWNERS, Effect, KeySpec, ReadContext, key_values, read_owner
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
from archgen.compare.version_pair import MAPPED_KEY
from archgen.model.component import Component, Input, Output


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


# Which outputs an input reads: compared by `connection_maps`, since it has no keys.
CONNECTION = KindSpec("connection", None)
FUNCTIONAL_KINDS = (GROUP, COMPOSED, COMPONENT, OUTPUT, INPUT, CONNECTION)
