"""The ports of components: outputs and inputs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.element_likeness import letter_pairs
from archgen.compare.kinds.component_keys import list_port_holders
from archgen.compare.kinds.frame_kind import frame_reference
from archgen.compare.kinds.kind_spec import Effect, FeatureSpec, KeySpec, KindSpec, ReadContext, Worsening
from archgen.compare.kinds.promise_keys import OUTPUT_KEYS
from archgen.compare.kinds.shared_keys import (
    ANNOTATIONS,
    DESCRIPTION,
    URLS,
    mark_values,
    prose_key,
    text_feature,
)
from archgen.model.component import Input, Output


def _port_owner(port: Input | Output, context: ReadContext) -> str | None:
    return context.common_id("partner", context.architecture.components[port.component].owner)


def _port_parent(port: Input | Output, context: ReadContext) -> tuple[str, str]:
    return ("component", context.matched_ids.common_id("component", port.component))


_PORT_KEYS = (
    KeySpec("medium", lambda port, _: port.medium if port.medium_written else None),
    prose_key("external"),
    DESCRIPTION,
    URLS,
)
_PORT_FEATURES = (
    FeatureSpec("name", 2, lambda _, port: letter_pairs(port.name)),
    FeatureSpec("type", 4, lambda _, port: mark_values(port.type)),
    FeatureSpec("topics", 3, lambda relations, port: frozenset(relations.topics_by_port[port.id])),
    text_feature(1, "description", "external"),
)


def _make_port_kind(
    name: str,
    elements: Callable[[ArchitectureVersion], Mapping[str, Any]],
    type_verb: str,
    own_keys: Iterable[KeySpec],
    other_ends: FeatureSpec,
) -> KindSpec:
    """Make the kind of a port: what inputs and outputs have in common, and what only one of the two has."""
    return KindSpec(
        name,
        None,
        (
            KeySpec(
                "type", lambda port, context: context.common_id("type", port.type), refers_to="type", verb=type_verb
            ),
            *_PORT_KEYS,
            *own_keys,
            *ANNOTATIONS,
        ),
        elements=elements,
        features=(*_PORT_FEATURES, other_ends),
        has_path_id=True,
        parent_kind="component",
        stays_in_parent=True,
        parent=_port_parent,
        owner=_port_owner,
        components=lambda port, context: (_port_parent(port, context)[1],),
    )


OUTPUT = _make_port_kind(
    "output",
    lambda version: version.architecture.outputs,
    "carries",
    (frame_reference("is given in"), *OUTPUT_KEYS),
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
    "expects",
    (
        KeySpec("optional", lambda port, _: port.optional or None, Effect.SYSTEM),
        KeySpec("freshness", worsening=Worsening.LESS, verb="must be no older than"),
        frame_reference("is expected in"),
    ),
    FeatureSpec(
        "sources",
        5,
        lambda relations, port: relations.common_ids("output", relations.outputs_by_input[port.id]),
    ),
)
