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
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture
    from archgen.model.node import Endpoint, UseKind


_GUESS_BUDGET = 1_000_000
"""Names that topics are compared with, in all."""


class _Fault(NamedTuple):
    """What is wrong with an override, as the end of a sentence, and what to do about it."""

    text: str
    help: str | None
    severity: Severity | None = None


class _KnownNames:
    """The topics of one node: their names on the wire by use, and by what else one may call them."""

    def __init__(self) -> None:
        self.on_wire: dict[UseKind, dict[str, None]] = defaultdict(dict)
        self.by_alias: dict[tuple[str | None, UseKind], str] = {}

    def add(self, endpoint: Endpoint) -> None:
        name, use = endpoint.name, endpoint.use
        if name is not None:
            self.on_wire[use][name] = None
            for alias in (endpoint.program_name, endpoint.own_name, name[1:], name.rpartition("/")[2]):
                self.by_alias.setdefault((alias, use), name)


def ineffective_override(architecture: Architecture) -> Iterator[Diagnostic]:
    """A parameter that is to override the quality of service does nothing, or ends the node as it starts."""
    if is_ros_1(architecture.distro):
        return
    known_names: dict[str, _KnownNames] = defaultdict(_KnownNames)
    for endpoint in architecture.endpoints:
        if endpoint.flow == "topic":
            known_names[endpoint.node].add(endpoint)
    seen_places = set[Span]()
    compared_count = 0
    for node in architecture.nodes.values():
        for override in list_overrides(architecture, node) if not node.is_program else ():
            names = known_names[node.id]
            fault = _find_bad_word(override) or _find_other_name(override, names)
            # What stands in a file, or holds for all nodes, may be meant for another one.
            if fault is None and override.origin == "node" and compared_count < _GUESS_BUDGET:
                compared_count += len(names.by_alias)
                fault = _guess_name(override, names)
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


def _find_other_name(override: QosOverride, names: _KnownNames) -> _Fault | None:
    """Return what is wrong where it names no end of the node; what a node has that is not known may be what it names."""
    topic, use = override.topic, END_WORDS[override.end]
    if topic in names.on_wire[use]:
        return _find_bad_effect(override)
    other_end, other_use = next((word, other) for word, other in END_WORDS.items() if other != use)
    if topic in names.on_wire[other_use]:
        verb = "publishes" if use == "publishes" else "subscribes to"
        return _Fault(f"does nothing: the node {verb} no `{topic}`", f"write `{other_end}`")
    if name := names.by_alias.get((topic, use)):
        text = f"does nothing: nothing is called `{topic}` once the node runs"
        return _Fault(text, f"write the full name on the wire, `{name}`")
    return None


def _guess_name(override: QosOverride, names: _KnownNames) -> _Fault | None:
    on_wire = names.on_wire[END_WORDS[override.end]]
    guess = did_you_mean(override.topic, on_wire) if override.topic not in on_wire else None
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
