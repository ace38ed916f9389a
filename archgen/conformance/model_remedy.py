"""What to write into the design so that it says what the robot does: for each difference that the design can follow."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from archgen.conformance.observed_robot import ObservedEndpoint
from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import NamedTuple
from archgen.model.node import Endpoint, Node
from archgen.model.parameter_values import EffectiveParameter


class ModelRemedy(NamedTuple):
    """Values below a key of a node's description, or one that stands where it is written (`at`).

    `rule` and `message` are those of the finding that it ends; where the design says nothing there is none, and the message says what it
    will say. `path` begins behind the node. An entry in short form holds what its `short_key` does.
    """

    rule: str
    message: str
    element: str
    node: str
    path: tuple[str, ...]
    values: Mapping[str, Any]
    short_key: str = ""
    at: Span = NO_SPAN
    is_gap: bool = False
    """Whether the design says nothing of it yet, so that nothing of it is taken back."""


def name_endpoint(rule: str, message: str, node: Node, endpoint: Endpoint, seen: ObservedEndpoint) -> ModelRemedy:
    """Give an end of the design the name that it has on the robot."""
    path, short_key = _find_entry(node, endpoint)
    element = endpoint.port or node.id
    is_gap = endpoint.name is None
    return ModelRemedy(
        rule, message, element, node.id, path, {short_key: seen.name}, short_key=short_key, is_gap=is_gap
    )


def type_endpoint(rule: str, message: str, node: Node, endpoint: Endpoint, seen: ObservedEndpoint) -> ModelRemedy:
    """Give an end of the design the type that it has on the robot: where its type is written, else at the node."""
    path, short_key = _find_entry(node, endpoint)
    return ModelRemedy(
        *(rule, message, endpoint.port or node.id, node.id, path, {"message": seen.message}, short_key),
        at=endpoint.message_at if endpoint.message is not None else NO_SPAN,
        is_gap=endpoint.message is None,
    )


def qualify_endpoint(
    rule: str, message: str, node: Node, endpoint: Endpoint, policies: Mapping[str, Any]
) -> ModelRemedy:
    """Give an end of the design policies of its quality of service."""
    path, short_key = _find_entry(node, endpoint)
    # A policy without a limit is one that is not written.
    values = {policy: show_policy(value) for policy, value in policies.items() if value is not None}
    is_gap = not endpoint.qos.written
    return ModelRemedy(
        rule, message, endpoint.port or node.id, node.id, path, {"qos": values}, short_key, is_gap=is_gap
    )


def add_internal(rule: str, message: str, node: Node, key: str, seen: ObservedEndpoint) -> ModelRemedy:
    """Give a node an end that no component of it knows."""
    values = {_name_key(seen.use): seen.name, **({"message": seen.message} if seen.message else {})}
    return ModelRemedy(rule, message, node.id, node.id, ("internal", seen.use, key), values)


def set_parameter(rule: str, message: str, node: Node, designed: EffectiveParameter, value: object) -> ModelRemedy:
    """Give a parameter the value that it has on the robot: at the node, whose values count most."""
    at = designed.at if designed.origin == "node" else NO_SPAN
    return ModelRemedy(rule, message, node.id, node.id, ("parameters",), {designed.name: value}, at=at)


def rename_node(rule: str, message: str, node: Node, full_name: str) -> ModelRemedy:
    """Give a node the name and the namespace that it has on the robot."""
    namespace, _, name = full_name.rpartition("/")
    old_namespace, _, old_name = node.full_name.rpartition("/")
    values = {"name": name} if name != old_name else {}
    values |= {"namespace": namespace or "/"} if namespace != old_namespace else {}
    return ModelRemedy(rule, message, node.id, node.id, (), values)


def _find_entry(node: Node, endpoint: Endpoint) -> tuple[tuple[str, ...], str]:
    """Return where a node says what an end is, and what its short form holds."""
    used = [
        each.key
        for each in node.uses
        if each.use == endpoint.use and (each.port == endpoint.port if endpoint.port else each.at == endpoint.at)
    ]
    port = endpoint.port or ""
    component, _, name = port.rpartition(".")
    key = used[0] if used else name if len(node.implements) == 1 else f"{component.rpartition('.')[2]}.{name}"
    return (*(("internal",) if endpoint.internal else ()), endpoint.use, key), _name_key(endpoint.use)


def _name_key(use: str) -> str:
    return "topic" if use in {"publishes", "subscribes"} else "name"


def show_policy(value: object) -> object:
    """Return the value of a policy as the language writes it."""
    return "unlimited" if value is None else value if isinstance(value, int) else str(value)
