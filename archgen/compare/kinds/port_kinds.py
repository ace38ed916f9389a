"""The ports of components: outputs and inputs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.element_likeness import letter_pairs
from archgen.compare.kinds.key_spec import ReadContext, key_values
from archgen.compare.kinds.kind_spec import FeatureSpec, KindSpec, list_port_holders, mark_values, text_feature
from archgen.compare.normal_values import drop_unset_values
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
    return drop_unset_values(key_values(_OWN_WORDS, output, context))
