"""Do parameters that are to override the quality of service reach an end of their node?"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from archgen.derivation.wire.qos_overrides import (
    END_WORDS,
    POLICIES,
    QosOverride,
    describe_values,
    list_overrides,
    read_policy,
)
from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.source_span import Span
from archgen.diagnostics.suggestions import did_you_mean
from archgen.model.parameter import format_parameter
from archgen.model.ros_distro import is_ros_1

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from archgen.model.architecture import Architecture
    from archgen.model.node import Endpoint


class _Fault(NamedTuple):
    """What is wrong with an override, as the end of a sentence, and what to do about it."""

    text: str
    help: str | None
    severity: Severity | None = None


def ineffective_override(architecture: Architecture) -> Iterator[Diagnostic]:
    """A parameter that is to override the quality of service does nothing, or ends the node as it starts."""
    if is_ros_1(architecture.distro):
        return
    endpoints: dict[str, list[Endpoint]] = defaultdict(list)
    for endpoint in architecture.endpoints:
        if endpoint.flow == "topic":
            endpoints[endpoint.node].append(endpoint)
    seen_places = set[Span]()
    for node in architecture.nodes.values():
        for override in list_overrides(architecture, node) if not node.is_program else ():
            fault = _find_bad_word(override) or _find_other_name(override, endpoints[node.id])
            if fault is not None and override.at not in seen_places:
                seen_places.add(override.at)  # what a file or the project says to several nodes is one slip
                message = f"`{override.parameter}` {fault.text}"
                yield Diagnostic(
                    "ineffective-override", message, override.at, fault.severity, help=fault.help, element=node.id
                )


def _find_bad_word(override: QosOverride) -> _Fault | None:
    if override.end not in END_WORDS:
        guess = did_you_mean(override.end, END_WORDS) or "write `publisher` or `subscription`"
        return _Fault(f"does nothing: no end is called `{override.end}`", guess)
    if override.policy not in POLICIES:
        return _Fault(f"does nothing: there is no policy `{override.policy}`", did_you_mean(override.policy, POLICIES))
    if (override.policy, override.end) == ("lifespan", "subscription"):
        return _Fault("does nothing: a lifespan is the publisher's", "write it at the node that publishes")
    return None


def _find_other_name(override: QosOverride, endpoints: Sequence[Endpoint]) -> _Fault | None:
    """Return what is wrong where it names no end of the node; what a node has that is not known may be what it names."""
    if any(map(override.is_for, endpoints)):
        return _find_bad_effect(override)
    if any(each.name == override.topic for each in endpoints):
        verb = "publishes" if override.end == "publisher" else "subscribes to"
        other_end = next(word for word in END_WORDS if word != override.end)
        return _Fault(f"does nothing: the node {verb} no `{override.topic}`", f"write `{other_end}`")
    ends = [(each, each.name) for each in endpoints if each.use == END_WORDS[override.end] and each.name]
    for each, name in ends:
        if override.topic in {each.program_name, each.own_name, name[1:], name.rpartition("/")[2]}:
            text = f"does nothing: nothing is called `{override.topic}` once the node runs"
            return _Fault(text, f"write the full name on the wire, `{name}`")
    # What stands in a file, or holds for all nodes, may be meant for another one.
    guess = did_you_mean(override.topic, [name for _, name in ends]) if override.origin == "node" else None
    return _Fault("does nothing: the node has no such topic", guess) if guess else None


def _find_bad_effect(override: QosOverride) -> _Fault | None:
    if override.effect == "ignored":
        if override.end_id:
            help_line = f"leave `_{override.end_id}` out: only an end that the program gives an id has one"
            return _Fault("does nothing: the program gives its ends no ids", help_line)
        return _Fault(
            f"does nothing: the program takes no `{override.policy}`", "have its code take it, or set it there"
        )
    if read_policy(override.policy, override.value) is not None:
        return None
    value = f"cannot be `{format_parameter(override.value)}`"
    help_line = f"write {describe_values(override.policy)}"
    if override.effect == "obeyed":
        return _Fault(f"{value}: the node ends as it starts", help_line, Severity.ERROR)
    return _Fault(f"{value}: the node ends as it starts, if it takes overrides", help_line)


RULES = ((ineffective_override, Severity.WARNING),)
