"""What is written for ROS: conceptual types and message definitions (in modules of their own), nodes and their ports."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import NamedTuple

from archgen.compare.kinds.element_owners import CO_OWNERS, read_owner
from archgen.compare.kinds.key_spec import Effect, KeySpec, ReadContext, Worsening
from archgen.compare.kinds.kind_spec import FeatureSpec, KindSpec
from archgen.compare.kinds.message_kind import MESSAGE
from archgen.compare.kinds.shared_features import (
    NAME_FEATURES,
    mark_values,
    reference_feature,
    text_feature,
    value_feature,
)
from archgen.compare.kinds.type_kind import TYPE
from archgen.compare.normal_values import unordered_values
from archgen.derivation.wire.remap_rules import NodeNames
from archgen.derivation.writing_endpoints import flow_of_use
from archgen.diagnostics.source_span import NO_SPAN
from archgen.model.node import Node, PortUse, Qos
from archgen.model.parameter import format_parameter

_DEFAULT_QOS = Qos()
_QOS_NAMES = tuple(each.name for each in fields(Qos) if each.name not in {"profile", "written", "at"})
"""What counts of `qos`: a profile is only another way of writing the rest."""


def _read_co_owners(node: Node, context: ReadContext) -> frozenset[str]:
    """Return a node's further owners, unless they are exactly those of its components."""
    components = context.architecture.components
    inherited_owners = {owner for component in node.implements for owner in components[component].owners}
    return context.common_ids("partner", () if set(node.owners) == inherited_owners else node.co_owners)


NODE = KindSpec(
    "node",
    "Nodes",
    (KeySpec("co_owners", _read_co_owners, Effect.SYSTEM, refers_to="partner", noun=CO_OWNERS.noun),),
    # Of a node that is planned since its component says where it will run, that is written: it has a place in the files.
    elements=lambda version: {
        name: node for name, node in version.architecture.nodes.items() if node.written or node.at != NO_SPAN
    },
    features=(
        *NAME_FEATURES,
        reference_feature("implements", 4, "component", "implements"),
        value_feature("package", 2, "package"),
        value_feature("program", 2, "executable", "plugin"),
        FeatureSpec("ports", 2, lambda _, node: mark_values(*(f"{use.use} {use.key}" for use in node.uses))),
        FeatureSpec("topics", 1, lambda _, node: mark_values(*(topic for use in node.uses for topic in use.topics))),
        value_feature("place", 1, "host", "container"),
        FeatureSpec("parameters", 1, lambda _, node: frozenset(node.parameters)),
        text_feature(1, "description"),
    ),
    owner=read_owner,
    components=lambda node, context: tuple(
        context.matched_ids.common_id("component", component) for component in node.implements
    ),
)


class NodePort(NamedTuple):
    """What a node says of a port; `is_stated` if it must say that it has the port, because it is not the only node of
    the component.
    """

    use: PortUse
    node: Node
    is_stated: bool


def _read_qos(port: NodePort, _context: ReadContext) -> Mapping[str, object]:
    qos = port.use.qos or _DEFAULT_QOS
    return {name: getattr(qos, name) for name in _QOS_NAMES if getattr(qos, name) != default_qos(name)}


def default_qos(name: str) -> object:
    """Return the value of a key of `qos` that nobody wrote."""
    return getattr(_DEFAULT_QOS, name)


def _resolve_topics(port: NodePort, context: ReadContext) -> frozenset[str]:
    """Return the names on the wire: a remap is told as it is written, and here as what comes of it."""
    if not port.use.topics:
        return frozenset()
    names = NodeNames(port.node, context.architecture.distro)
    flow = flow_of_use(port.use.message, port.use)
    wires = zip(names.name_use(port.use, flow, None), port.use.topics, strict=True)
    return unordered_values(wire.name or topic for wire, topic in wires)


def _read_conditions(port: NodePort, _context: ReadContext) -> Mapping[str, object]:
    return {name: format_parameter(wanted) or "no value" for name, wanted in port.use.when.items()}


PORT = KindSpec(
    "port",
    "Nodes",
    (
        KeySpec("carried", lambda port, _: port.is_stated or None),
        KeySpec("topic", _resolve_topics),
        KeySpec("own_name", lambda port, _: port.use.own_name, Effect.SYSTEM, noun="name in the program"),
        KeySpec("named_by", lambda port, _: port.use.named_by, Effect.SYSTEM, noun="parameter with its name"),
        KeySpec("when.", _read_conditions, Effect.SYSTEM, noun="condition"),
        KeySpec("message", lambda port, _: port.use.message, worsening=Worsening.ALWAYS, verb="is"),
        KeySpec("qos.", _read_qos, worsening=Worsening.ALWAYS, noun="QoS"),
    ),
    has_path_id=True,
)
ROS_KINDS: Sequence[KindSpec] = (TYPE, MESSAGE, NODE, PORT)
