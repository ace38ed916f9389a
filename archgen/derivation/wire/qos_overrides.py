"""What parameters named `qos_overrides.TOPIC.publisher.POLICY` do to the quality of service of a node's ends.

A program takes them only where its code says so, and says nothing where it does not. TOPIC is the full name on the wire.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction
from itertools import chain
from typing import Any

from archgen.derivation.wire.wire_names import list_parameter_words
from archgen.diagnostics import Span, join_words
from archgen.frozen import dataclass, replace
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint, Evidence, Node, OverrideEffect, UseKind
from archgen.model.parameter_values import (
    EffectiveParameter,
    ValueOrigin,
    find_declarations,
    find_effective_parameters,
)
from archgen.model.quantity import Quantity

PREFIX = "qos_overrides."
END_WORDS: Mapping[str, UseKind] = {"publisher": "publishes", "subscription": "subscribes"}
"""What an override says of the end that it is for."""
_INFINITE_NS = 2**63 - 1
"""What ROS calls a duration without an end."""


_WORDS: Mapping[str, Mapping[str, str]] = {
    "reliability": {"reliable": "reliable", "best_effort": "best_effort", "system_default": "reliable"},
    "durability": {"volatile": "volatile", "transient_local": "transient_local", "system_default": "volatile"},
    "history": {"keep_last": "keep_last", "keep_all": "keep_all", "system_default": "keep_last"},
    "liveliness": {"automatic": "automatic", "manual_by_topic": "manual_by_topic", "system_default": "automatic"},
}
"""What the words of each policy mean."""
_DURATIONS = {"deadline": "deadline", "lifespan": "lifespan", "liveliness_lease_duration": "lease_duration"}
"""The fields of `Qos` by the policies that are durations."""
POLICIES = (*_WORDS, "depth", *_DURATIONS, "avoid_ros_namespace_conventions")
_OTHER_SIDES_WORD = "best_available"


@dataclass(frozen=True, slots=True)
class QosOverride:
    """One parameter that is to set one policy of the ends of a topic. `end_id` is the id that the program gave an end."""

    parameter: str
    topic: str
    end: str
    end_id: str
    policy: str
    value: object
    effect: OverrideEffect
    """What the program makes of it, as far as it is known who makes the program."""
    origin: ValueOrigin
    at: Span

    @property
    def wire_end(self) -> tuple[str, UseKind | None]:
        """The name on the wire and the use of the ends that it names; an id is the program's own, and may be that of any."""
        return self.topic, END_WORDS.get(self.end)


def list_overrides(architecture: Architecture, node: Node) -> tuple[QosOverride, ...]:
    """Return the overrides that a node is given, in the order in which they are written."""
    declarations = find_declarations(architecture, node)
    words = {each.name: each for each in list_parameter_words(node)} if node.arguments else {}
    given = (each.name for part in (architecture.ros_parameters, node.file_values, node.own_values) for each in part)
    if not any(name.startswith(PREFIX) for name in chain(declarations, given, words)):
        return ()  # of nearly all nodes
    overrides = []
    declared_ends = {name.rpartition(".")[0] for name in declarations if name.startswith(PREFIX)}
    parameters = {name: EffectiveParameter(name, each.value, "node", each.at) for name, each in words.items()}
    # What a launch gives stands behind the node's own words, and wins.
    given_later = find_effective_parameters(architecture, node)
    parameters |= {name: each for name, each in given_later.items() if each.origin != "none"}
    for name, parameter in parameters.items():
        parts = name.removeprefix(PREFIX).rsplit(".", 2)
        if not name.startswith(PREFIX) or len(parts) < 3:  # noqa: PLR2004 - topic, end, policy
            continue
        topic, end, policy = parts
        end_word, _, end_id = end.partition("_")
        value = parameter.value if parameter.is_known else None
        # rclcpp and rclpy declare a parameter for each policy that a program takes.
        is_declared, is_end_declared = name in declarations, name.rpartition(".")[0] in declared_ends
        effect = "obeyed" if is_declared else "ignored" if is_end_declared else _guess_effect(node, end_id)
        overrides.append(
            QosOverride(name, topic, end_word, end_id, policy, value, effect, parameter.origin, parameter.at)
        )
    return tuple(overrides)


def _guess_effect(node: Node, end_id: str) -> OverrideEffect:
    """Return what a program makes of an override of which it declares nothing.

    One that is generated has the values in its code, and gives its ends no ids.
    """
    return "unknown" if not node.is_generated else "ignored" if end_id else "obeyed"


def read_policy(policy: str, value: object) -> Mapping[str, Any] | None:
    """Return the fields of a `Qos` that a value sets; none where that cannot be told, or the policy is not one of `Qos`.

    None for a value with which a program that takes it ends as it starts.
    """
    if value is None or (isinstance(value, str) and "$(" in value):
        return {}
    if policy in _WORDS:
        word = _WORDS[policy].get(value) if isinstance(value, str) else None
        return {policy: word} if word else {} if value == _OTHER_SIDES_WORD else None
    if policy == "avoid_ros_namespace_conventions":
        return {} if isinstance(value, bool) else None
    if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value <= _INFINITE_NS:
        return None
    if policy == "depth":
        return {"depth": value}
    return {_DURATIONS[policy]: Quantity(Fraction(value), f"{value} ns") if 0 < value < _INFINITE_NS else None}


def describe_values(policy: str) -> str:
    """Return what a policy may be set to."""
    if policy in _WORDS:
        return join_words([f"`{word}`" for word in _WORDS[policy]], "or")
    if policy in _DURATIONS:
        return "a whole number of nanoseconds"
    return "a whole number, 0 or more" if policy == "depth" else "`true` or `false`"


def override_qos(endpoint: Endpoint, overrides: Iterable[QosOverride]) -> Endpoint:
    """Return an end with the quality of service that its overrides give it, and where each policy comes from."""
    qos, effects, evidence = endpoint.qos, set[OverrideEffect](), dict(endpoint.evidence)
    for override in overrides:
        changes = _list_changes(override)
        effects.add(override.effect)
        if changes:
            qos = replace(qos, **changes, written=True, at=override.at)
            evidence[f"qos.{override.policy}"] = Evidence("written", override.parameter, override.at)
        elif override.effect != "ignored":
            evidence[f"qos.{override.policy}"] = Evidence("unknown", override.parameter, override.at)
    effect: OverrideEffect = "unknown" if "unknown" in effects else "obeyed" if "obeyed" in effects else "ignored"
    qos_if_ignored = endpoint.qos if effect == "unknown" and qos != endpoint.qos else None
    return replace(endpoint, qos=qos, qos_override=effect, qos_if_ignored=qos_if_ignored, evidence=evidence)


def _list_changes(override: QosOverride) -> Mapping[str, Any]:
    """Return what an override sets: nothing where it is ignored, or where ROS has no such policy, or no such value."""
    has_policy = override.policy in POLICIES and (override.policy, override.end) != ("lifespan", "subscription")
    if override.effect == "ignored" or not has_policy:
        return {}
    return read_policy(override.policy, override.value) or {}
