"""Do publishers offer the quality of service that subscribers ask for, do overrides reach an end, do queues hold what is sent?"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cache
from itertools import product

from archgen.derivation.wire.qos_overrides import (
    END_WORDS,
    POLICIES,
    QosOverride,
    describe_values,
    list_overrides,
    read_policy,
)
from archgen.derivation.wire.running_state import domain_of
from archgen.diagnostics import NO_SPAN, Diagnostic, Label, Severity, Span, did_you_mean, join_words
from archgen.frozen import NamedTuple
from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint, Qos, Topic, UseKind
from archgen.model.parameter import format_parameter
from archgen.model.quantity import Quantity
from archgen.model.ros_distro import is_ros_1

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


def _index_names(architecture: Architecture) -> Mapping[str, _KnownNames]:
    known_names: dict[str, _KnownNames] = {node: _KnownNames() for node in architecture.nodes}
    for endpoint in architecture.endpoints:
        if endpoint.flow == "topic":
            known_names[endpoint.node].add(endpoint)
    return known_names


def ineffective_override(architecture: Architecture) -> Iterator[Diagnostic]:
    """A parameter that is to override the quality of service does nothing, or ends the node as it starts."""
    if is_ros_1(architecture.distro):
        return
    known_names: Mapping[str, _KnownNames] = {}
    seen_places = set[Span]()
    compared_count = 0
    for node in architecture.nodes.values():
        for override in list_overrides(architecture, node) if not node.is_program else ():
            known_names = known_names or _index_names(architecture)
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


class QosConflict(NamedTuple):
    """A QoS policy whose offered value does not satisfy the requested one; all parts are phrases for a message."""

    policy: str
    requested: str
    offered: str
    remedy: str


def find_qos_conflicts(offered: Qos, requested: Qos) -> Iterator[QosConflict]:
    """Yield the conflicts between offered and requested reliability, durability, deadline, liveliness, lease duration.

    History, depth and lifespan never conflict. A duration of zero means "not given", as in ROS. The rules are those of
    https://docs.ros.org/en/jazzy/Concepts/Intermediate/About-Quality-of-Service-Settings.html#qos-compatibilities.
    """
    if (offered.reliability, requested.reliability) == ("best_effort", "reliable"):
        yield QosConflict(
            "reliability",
            "reliable delivery",
            "best effort only",
            "`reliability: reliable` or `best_effort` on both sides",
        )
    if (offered.durability, requested.durability) == ("volatile", "transient_local"):
        yield QosConflict(
            "durability",
            "what was sent before it started (transient_local)",
            "no message kept for late comers (volatile)",
            "`durability: transient_local` at the publisher",
        )
    if _is_longer(offered.deadline, requested.deadline):
        yield QosConflict(
            "deadline",
            f"a message every {requested.deadline}",
            f"one every {offered.deadline}" if _is_given(offered.deadline) else "no deadline",
            f"a `deadline` of {requested.deadline} or less at the publisher",
        )
    if (offered.liveliness, requested.liveliness) == ("automatic", "manual_by_topic"):
        yield QosConflict(
            "liveliness",
            "a publisher that asserts by itself that it is alive (manual_by_topic)",
            "automatic signs of life",
            "`liveliness: manual_by_topic` at the publisher",
        )
    if _is_longer(offered.lease_duration, requested.lease_duration):
        yield QosConflict(
            "lease duration",
            f"a sign of life every {requested.lease_duration}",
            f"one every {offered.lease_duration}" if _is_given(offered.lease_duration) else "none in any set time",
            f"a `lease_duration` of {requested.lease_duration} or less at the publisher",
        )


def incompatible_qos(architecture: Architecture) -> Iterator[Diagnostic]:
    """A subscriber asks for a quality of service that a publisher on its topic does not offer."""
    if is_ros_1(architecture.distro):
        return  # has no quality of service to agree on
    for topic in architecture.topics.values():
        if topic.flow != "topic":
            continue
        # Planned nodes that archgen adds have no decided QoS that could conflict.
        writers, readers = (
            [each for each in ends if architecture.nodes[each.node].written] for ends in (topic.writers, topic.readers)
        )
        # Many ends of one topic have few different settings, and most of these agree.
        readers_by_qos = group_pairs((_list_qos(reader), reader) for reader in readers)
        judge_pair = cache(
            lambda offers, requests: [tuple(find_qos_conflicts(*pair)) for pair in product(offers, requests)]
        )
        for writer in writers:
            for requested, asking in readers_by_qos.items():
                verdicts = judge_pair(_list_qos(writer), requested)
                for reader in asking if any(verdicts) else ():
                    yield _report_qos_conflicts(architecture, topic, writer, reader, verdicts)


def _report_qos_conflicts(
    architecture: Architecture,
    topic: Topic,
    writer: Endpoint,
    reader: Endpoint,
    verdicts: Sequence[tuple[QosConflict, ...]],
) -> Diagnostic:
    """Report all conflicts between a publisher and a subscriber in one diagnostic."""
    conflicts = next(filter(None, verdicts), ())
    requests = " and ".join(conflict.requested for conflict in conflicts)
    offers = " and ".join(conflict.offered for conflict in conflicts)
    assumption = next(filter(None, map(_describe_assumption, (writer, reader))), "")
    if not all(verdicts):
        unsure = writer if writer.qos_if_ignored else reader
        assumption = f" (where `{unsure.node}` {'obeys' if verdicts[0] else 'ignores'} the overrides that it is given)"
    # Of a program that exists, and that only the library describes, the usual profile is no more than a guess.
    is_guess = any(
        _describe_assumption(each)
        and architecture.nodes[each.node].status == "existing"
        and any(architecture.list_libraries_of(architecture.components[each.component or ""]))
        for each in (writer, reader)
        if each.component in architecture.components
    )
    return Diagnostic(
        "incompatible-qos",
        f"`{reader.node}` receives nothing from `{writer.node}` on `{topic.name}`: it asks for {requests}, and is offered {offers}{assumption}",
        _qos_span(architecture, reader),
        severity=Severity.NOTE if is_guess else Severity.WARNING if assumption else None,
        labels=(Label(_qos_span(architecture, writer), "offered here"),),
        help=f"needed: {'; '.join(conflict.remedy for conflict in conflicts)}",
        element=reader.node,
    )


def _list_qos(endpoint: Endpoint) -> tuple[Qos, ...]:
    """Return what one side may have: both where it is unknown whether its program takes overrides."""
    return (endpoint.qos, endpoint.qos_if_ignored) if endpoint.qos_if_ignored else (endpoint.qos,)


def _describe_assumption(endpoint: Endpoint) -> str:
    """Describe what is assumed about one side's settings; empty if all of it is written."""
    if not endpoint.qos.written:
        return f" (`{endpoint.node}` leaves `qos` out, so the profile `default` counts)"
    if endpoint.qos.profile == "system_default":
        return f" (`{endpoint.node}` leaves it to the middleware, whose usual values count)"
    return ""


def _qos_span(architecture: Architecture, endpoint: Endpoint) -> Span:
    """Return the span of an endpoint's QoS settings, else of its entry, else of its node."""
    written_spans = (endpoint.qos.at, endpoint.at)
    return next((span for span in written_spans if span != NO_SPAN), architecture.nodes[endpoint.node].at)


def _is_given(duration: Quantity | None) -> bool:
    return duration is not None and duration.value > 0


def _is_longer(offered: Quantity | None, requested: Quantity | None) -> bool:
    """Whether an offered duration is longer than the requested one; a duration that is not given is infinite."""
    if requested is None or not _is_given(requested):
        return False
    offered_value: Fraction | None = offered.value if offered and _is_given(offered) else None
    return offered_value is None or offered_value > requested.value


_TAKEN_TURNS = frozenset({"/tf", "/tf_static", "/diagnostics", "/cmd_vel"})
"""Topics on which many send: whoever reads them knows."""
_MAX_SHOWN = 3


def shared_memory(architecture: Architecture) -> Iterator[Diagnostic]:
    """A subscription keeps fewer messages than there are publishers on its topic: they push out one another's."""
    if is_ros_1(architecture.distro):
        return
    for topic in architecture.topics.values():
        if topic.flow == "topic" and len(topic.writers) > 1:
            for reader in topic.readers:
                yield from _judge_queue(architecture, topic, reader)


def _judge_queue(architecture: Architecture, topic: Topic, reader: Endpoint) -> Iterator[Diagnostic]:
    depth = reader.qos.depth
    if not reader.qos.written or reader.qos.history == "keep_all" or depth is None:
        return
    nodes = architecture.nodes
    writers = {
        each.node: each
        for each in topic.writers
        if domain_of(each) == domain_of(reader) and each.runs != "off" and nodes[each.node].written
    }
    latched = [each for each in writers.values() if each.qos.durability == "transient_local"]
    is_latched = reader.qos.durability == "transient_local" and len(latched) > max(depth, 1)
    if len(writers) <= max(depth, 1) or not nodes[reader.node].written:
        return
    names = [f"`{name}`" for name in writers]
    shown_names = join_words(
        names if len(names) <= _MAX_SHOWN else [*names[:_MAX_SHOWN], f"{len(names) - _MAX_SHOWN} more"]
    )
    kept = "one message" if depth <= 1 else f"{depth} messages"
    loss = "what others sent before it started is lost to it" if is_latched else "one may push out what another sent"
    yield Diagnostic(
        "shared-memory",
        f"`{reader.node}` keeps {kept} of `{topic.name}` in all, on which {shown_names} publish: {loss}",
        next((span for span in (reader.qos.at, reader.at) if span.file), nodes[reader.node].at),
        severity=Severity.WARNING if is_latched and topic.name not in _TAKEN_TURNS else None,
        labels=tuple(Label(each.at, "published here") for each in list(writers.values())[:2] if each.at.file),
        help=f"give it a `depth` of {len(writers)} or more, or a topic of its own to each publisher",
        element=reader.node,
    )


RULES = (
    (incompatible_qos, Severity.ERROR),
    (ineffective_override, Severity.WARNING),
    (shared_memory, Severity.NOTE),
)
