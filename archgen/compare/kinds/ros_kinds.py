"""What is written for ROS: conceptual types and message definitions (in modules of their own), nodes and their ports."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import NamedTuple

from archgen.compare.kinds.kind_spec import Effect, FeatureSpec, KeySpec, KindSpec, ReadContext, Worsening
from archgen.compare.kinds.message_kind import MESSAGE
from archgen.compare.kinds.shared_keys import (
    ANNOTATIONS,
    CO_OWNERS,
    DESCRIPTION,
    NAME_FEATURES,
    OWNER,
    TAGS,
    TIMING_KEYS,
    TITLE,
    URLS,
    key_values,
    mark_values,
    read_owner,
    text_feature,
    timing_key,
)
from archgen.compare.kinds.start_keys import START_KEYS, read_start
from archgen.compare.kinds.type_kind import TYPE
from archgen.compare.normal_values import freeze_value, parameter_leaves, unordered_values
from archgen.derivation import ros_names
from archgen.diagnostics.source_span import NO_SPAN
from archgen.model.node import Node, PortUse, Qos

_DEFAULT_QOS = Qos()
_QOS_NAMES = tuple(each.name for each in fields(Qos) if each.name not in {"profile", "written", "at"})
"""What counts of `qos`: a profile is only another way of writing the rest."""


def _read_co_owners(node: Node, context: ReadContext) -> frozenset[str]:
    """Return a node's further owners, unless they are exactly those of its components."""
    components = context.architecture.components
    inherited_owners = {owner for component in node.implements for owner in components[component].owners}
    return context.common_ids("partner", () if set(node.owners) == inherited_owners else node.co_owners)


def _read_host(node: Node, context: ReadContext) -> str | None:
    own_container = context.architecture.containers.get(node.container) if node.container else None
    # A host that is the container's own adds nothing, and would change with it.
    is_inherited = own_container is not None and own_container.host == node.host
    return None if is_inherited else context.common_id("host", node.host)


def _read_threads(node: Node, _context: ReadContext) -> int | None:
    """Return the threads of a node, None for one thread: that is what counts where nothing is written."""
    return None if node.threads == 1 else node.threads


def _read_callback_groups(node: Node, context: ReadContext) -> Mapping[str, object]:
    return {
        name: unordered_values(context.matched_ids.common_id("component", component) for component in members)
        for name, members in node.callback_groups.items()
    }


def _read_parameters(node: Node, _context: ReadContext) -> Mapping[str, object]:
    """Return what a node and its files set; that it stands in the one or the other is no difference."""
    values = {value.name: freeze_value(value.value) for value in node.file_values}
    return values | {
        key: value for name, parameter in node.parameters.items() for key, value in parameter_leaves(name, parameter)
    }


def _read_commands(node: Node, _context: ReadContext) -> Mapping[str, object]:
    return {name: " ".join(words) for name, words in node.parameter_commands.items()}


def _read_timing(node: Node, context: ReadContext) -> Mapping[str, object]:
    """Return the timing that no component reports: of components with several nodes, and of a node without any."""
    values: dict[str, object] = {}
    for component, timing in node.timing.items():
        if component not in context.told_components:
            prefix = f"{context.matched_ids.common_id('component', component)}." if len(node.implements) > 1 else ""
            timing_values = key_values(TIMING_KEYS, timing, context)
            values |= {f"{prefix}{key}": value for key, value in timing_values.items()}
    return values


NODE = KindSpec(
    "node",
    "Nodes",
    (
        TITLE,
        KeySpec(
            "implements",
            lambda node, context: context.common_ids("component", node.implements),
            worsening=Worsening.ALWAYS,
            refers_to="component",
            list_verbs=("now implements", "no longer implements"),
            new_verb="implements",
        ),
        DESCRIPTION,
        OWNER,
        KeySpec("co_owners", _read_co_owners, Effect.SYSTEM, refers_to="partner", noun=CO_OWNERS.noun),
        # Topics that follow a node's name or namespace are keys of its ports.
        KeySpec("name", lambda node, _: None if node.name == node.id else node.name, Effect.SYSTEM),
        KeySpec("namespace", lambda node, _: None if node.namespace == "/" else node.namespace, Effect.SYSTEM),
        KeySpec(
            "kind",
            lambda node, _: unordered_values(() if node.kinds == ("node",) else node.kinds),
            worsening=Worsening.ALWAYS,
            list_verbs=("is now", "is no longer"),
        ),
        KeySpec("package", effect=Effect.SYSTEM),
        KeySpec("executable", effect=Effect.SYSTEM),
        KeySpec("plugin", effect=Effect.SYSTEM),
        KeySpec("language", effect=Effect.SYSTEM),
        KeySpec("command", lambda node, _: " ".join(map(shlex.quote, node.command)) or None, Effect.SYSTEM),
        KeySpec("arguments", lambda node, _: " ".join(map(shlex.quote, node.arguments)) or None, Effect.SYSTEM),
        KeySpec("remaps.", lambda node, _: node.remaps, Effect.SYSTEM),
        KeySpec(
            "container",
            lambda node, context: context.common_id("container", node.container),
            worsening=Worsening.ALWAYS,
            refers_to="container",
            verb="runs in the container",
            new_verb="runs in the container",
        ),
        KeySpec(
            "host",
            _read_host,
            worsening=Worsening.ALWAYS,
            refers_to="host",
            verb="runs on",
            new_verb="runs on",
        ),
        KeySpec("threads", _read_threads, worsening=Worsening.ALWAYS),
        KeySpec("scheduling", worsening=Worsening.ALWAYS),
        KeySpec("reentrant", lambda node, _: node.reentrant or None, worsening=Worsening.ALWAYS),
        KeySpec("callback_groups.", _read_callback_groups, worsening=Worsening.ALWAYS),
        KeySpec("start.", read_start, Effect.SYSTEM, inner=START_KEYS),
        KeySpec("status", effect=Effect.SYSTEM, verb="is"),
        KeySpec("parameter_files", effect=Effect.SYSTEM),
        TAGS,
        URLS,
        KeySpec("parameters.", _read_parameters, Effect.SYSTEM),
        KeySpec("parameter_commands.", _read_commands, Effect.SYSTEM),
        timing_key(_read_timing),
        *ANNOTATIONS,
    ),
    # Of a node that is planned since its component says where it will run, that is written: it has a place in the files.
    elements=lambda version: {
        name: node for name, node in version.architecture.nodes.items() if node.written or node.at != NO_SPAN
    },
    features=(
        *NAME_FEATURES,
        FeatureSpec("implements", 4, lambda relations, node: relations.common_ids("component", node.implements)),
        FeatureSpec("package", 2, lambda _, node: mark_values(node.package)),
        FeatureSpec("program", 2, lambda _, node: mark_values(node.executable, node.plugin)),
        FeatureSpec("ports", 2, lambda _, node: mark_values(*(f"{use.use} {use.key}" for use in node.uses))),
        FeatureSpec("topics", 1, lambda _, node: mark_values(*(topic for use in node.uses for topic in use.topics))),
        FeatureSpec("place", 1, lambda _, node: mark_values(node.host, node.container)),
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


def _resolve_topics(port: NodePort, _context: ReadContext) -> frozenset[str]:
    return unordered_values(ros_names.resolve_ros_name(topic, port.node) for topic in port.use.topics)


PORT = KindSpec(
    "port",
    "Nodes",
    (
        KeySpec("carried", lambda port, _: port.is_stated or None),
        KeySpec("topic", _resolve_topics),
        KeySpec("own_name", lambda port, _: port.use.own_name, Effect.SYSTEM, noun="name in the program"),
        KeySpec("message", lambda port, _: port.use.message, worsening=Worsening.ALWAYS, verb="is"),
        KeySpec("qos.", _read_qos, worsening=Worsening.ALWAYS, noun="QoS"),
    ),
    has_path_id=True,
)
ROS_KINDS: Sequence[KindSpec] = (TYPE, MESSAGE, NODE, PORT)
